//! Faults 1 to 34: the graph file.

use std::time::Duration;

use super::desk::{Desk, graph};

const SECOND: Duration = Duration::from_secs(1);

/// A text that is no graph is refused with these words, and nothing is made.
#[track_caller]
fn refused(text: impl AsRef<[u8]>, says: &[&str]) {
    let desk = Desk::with(text);
    desk.go().refused(says);
    assert_eq!(desk.names(), ["g.ron"]);
}

/// Nodes that cannot stand so are refused with these words.
#[track_caller]
fn nodes_refused(nodes: &str, says: &[&str]) {
    refused(graph(nodes), says);
}

#[test]
fn f001_an_empty_file() {
    for text in ["", " \n\t\n", "\u{feff}"] {
        refused(text, &["[empty]", "the graph file is empty", "g.ron"]);
    }
}

#[test]
fn f002_invalid_utf8() {
    refused(b"Graph(version: 1, \xff)", &["byte 18", "g.ron:1:19"]);
}

#[test]
fn f003_utf16() {
    for order in [u16::to_le_bytes, u16::to_be_bytes] {
        let text = "\u{feff}Graph(version: 1)".encode_utf16().flat_map(order);
        refused(text.collect::<Vec<_>>(), &["UTF-16", "save it as UTF-8"]);
    }
}

#[test]
fn f004_a_nul_byte() {
    refused("Graph(\0version: 1)", &["NUL byte at byte 6", "g.ron:1:7"]);
}

#[test]
fn f005_nesting_without_end() {
    let deep = [
        "[".repeat(100_000),
        format!("Graph(version: 1, params: {}", "{\"a\":".repeat(50_000)),
        format!(
            "Graph(version: 1, nodes: {{\"a\": {}",
            "Some(".repeat(50_000)
        ),
        graph(&format!("\"out\": Grid(cells: {}", "(".repeat(100_000))),
        graph(&format!(
            "\"out\": Grid(cells: (\"{}1\", 2))",
            "(".repeat(100_000)
        )),
        graph(&format!(
            "\"out\": Grid(cells: (\"{}1\", 2))",
            "-".repeat(30_000)
        )),
        graph(&format!(
            "\"out\": Grid(cells: (\"{}1\", 2))",
            "2^".repeat(10_000)
        )),
    ];
    for text in deep {
        let desk = Desk::with(text);
        // A second is promised; the machine may be busy with other tests.
        desk.go().refused(&["g.ron:1:"]).within(20 * SECOND);
    }
}

#[test]
fn f006_a_file_of_100_mb() {
    let desk = Desk::with("/".repeat(100 << 20));
    desk.go().refused(&["g.ron", "it has 104.858 MB"]);
}

#[test]
fn f007_a_name_of_a_megabyte() {
    let name = "A".repeat(1 << 20);
    let desk = Desk::nodes(&format!("\"out\": {name}()"));
    let done = desk.go();
    done.refused(&["there is no node `AAAAAAAA", "g.ron:1:"]);
    assert!(done.err.len() < 4000, "{} bytes", done.err.len());
}

#[test]
fn f008_numbers_that_are_none() {
    let digits = "9".repeat(5000);
    for number in [
        "1e999",
        "NaN",
        "inf",
        "-inf",
        &digits,
        "\"0/0\"",
        "\"1e308*10\"",
    ] {
        nodes_refused(
            &format!("\"out\": Grid(size: ({number}, 1))"),
            &["finite number", "g.ron:1:"],
        );
    }
}

#[test]
fn f009_what_is_never_closed() {
    for (text, what) in [
        ("Graph(version: 1, nodes: {\"a", "text"),
        ("Graph(version: 1, nodes: {r#\"a", "text"),
        ("Graph(version: 1, /* /* */ nodes", "comment"),
        ("Graph(version: 1, nodes: {", "{"),
    ] {
        refused(text, &["never closed", what, "g.ron:1:"]);
    }
}

#[test]
fn f010_text_after_the_end() {
    let text = graph("\"out\": Grid()") + "\nmore";
    refused(text, &["the graph ends before this", "g.ron:2:1"]);
}

#[test]
fn f011_merge_markers() {
    let text = "Graph(version: 1,\n<<<<<<< ours\nnodes: {},\n=======\n>>>>>>> theirs\n)";
    refused(text, &["merge conflict", "g.ron:2:1"]);
}

#[test]
fn f012_other_kinds_of_file() {
    for (text, what) in [
        (
            "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n",
            "git-lfs",
        ),
        ("{\"version\": 1, \"nodes\": {}}", "JSON"),
        ("version: 1\nnodes:\n  a: b\n", "YAML"),
        ("<!DOCTYPE html><html></html>", "HTML"),
    ] {
        refused(text, &["[not_a_graph]", what, "g.ron"]);
    }
    refused(b"glTF\x02\0\0\0\xff\xfe\0\0\0\x80", &["g.ron"]);
}

#[test]
fn f013_a_half_written_file() {
    let whole = graph("\"out\": Grid(cells: (2, 2))");
    for end in 1..whole.len() {
        Desk::with(&whole[..end])
            .run(&["check", "g.ron"])
            .refused(&["g.ron"]);
        if end % 4 != 0 {
            continue;
        }
        refused(&whole[..end], &["g.ron"]);
    }
}

#[test]
fn f014_escape_codes_in_names() {
    // `refused` looks for the escape character in what was printed.
    nodes_refused("\"a\u{1b}[31m\": Grid()", &["is no name for a node"]);
    nodes_refused("\"a\\u{1b}[31m\": Grid()", &["is no name for a node"]);
    nodes_refused("\"out\": ReadMesh(path: \"\\u{1b}[2J.obj\")", &["g.ron:1:"]);
}

#[test]
fn f015_the_same_name_twice() {
    refused(
        graph("\n\"out\": Grid(),\n\"out\": Cuboid()"),
        &["`out`", "g.ron:3:", "2 |", "3 |"],
    );
}

#[test]
fn f016_an_unknown_node() {
    nodes_refused(
        "\"out\": SmothNormals(mesh: \"a\")",
        &["SmoothNormals", "g.ron:1:"],
    );
}

#[test]
fn f017_an_unknown_input() {
    nodes_refused(
        "\"out\": Grid(cell: (2, 2))",
        &["no input `cell`", "`cells`"],
    );
}

#[test]
fn f018_a_missing_input() {
    nodes_refused("\"out\": SubdivideQuad(levels: 1)", &["`mesh`", "g.ron:1:"]);
}

#[test]
fn f019_an_input_given_twice() {
    nodes_refused(
        "\"out\": Grid(cells: (2, 2), cells: (3, 3))",
        &["`cells`", "g.ron:1:"],
    );
}

#[test]
fn f020_one_for_a_list_and_a_list_for_one() {
    nodes_refused(
        "\"a\": Grid(), \"out\": SubdivideQuad(mesh: [\"a\", \"a\"])",
        &["mesh"],
    );
    nodes_refused("\"out\": Grid(cells: 2)", &["cells"]);
    nodes_refused("\"out\": Grid(cells: (2, 2, 2))", &["cells"]);
}

#[test]
fn f021_a_value_of_another_kind() {
    nodes_refused(
        "\"a\": Grid(), \"n\": VertexNormals(mesh: \"a\"), \"out\": SubdivideQuad(mesh: \"n\")",
        &["takes a mesh", "gives directions", "defined here"],
    );
}

#[test]
fn f022_cycles() {
    for length in [1, 2, 1000] {
        let node = |k: usize| {
            let next = if k + 1 == length {
                "out".to_owned()
            } else {
                format!("n{}", k + 1)
            };
            let name = if k == 0 {
                "out".to_owned()
            } else {
                format!("n{k}")
            };
            format!("\"{name}\": Transform(mesh: \"{next}\")")
        };
        let nodes: Vec<_> = (0..length).map(node).collect();
        let desk = Desk::nodes(&nodes.join(",\n"));
        let done = desk.go();
        done.refused(&["cycle", "`out`"]);
        for k in 1..length {
            assert!(
                done.err.contains(&format!("`n{k}`")),
                "node {k} of {length}"
            );
        }
    }
}

#[test]
fn f023_an_edge_from_no_node() {
    nodes_refused(
        "\"out\": Transform(mesh: \"grid\")",
        &["there is no node `grid`"],
    );
}

#[test]
fn f024_an_edge_from_no_result() {
    nodes_refused(
        "\"a\": Grid(), \"out\": Transform(mesh: \"a.meshes\")",
        &["`meshes`", "g.ron:1:"],
    );
}

#[test]
fn f025_a_chain_of_100_000_nodes() {
    use std::fmt::Write as _;
    let mut nodes = String::from("\"n0\": Grid()");
    for k in 1..100_000 {
        let _ = write!(nodes, ",\n\"n{k}\": FlipFaces(mesh: \"n{}\")", k - 1);
    }
    nodes += ", \"out\": FlipFaces(mesh: \"n99999\")";
    let desk = Desk::nodes(&nodes);
    desk.run(&["run", "g.ron", "--no-cache", "--report", "json"])
        .made();
    assert!(desk.path("out/o.obj").is_file());
}

#[test]
fn f026_a_node_with_100_000_inputs() {
    let list = vec!["\"a\""; 100_000].join(",");
    let desk = Desk::nodes(&format!(
        "\"a\": Grid(), \"out\": JoinMeshes(meshes: [{list}])"
    ));
    desk.go().made();
}

/// A graph that does nothing but include another.
fn including(path: &str) -> String {
    format!(
        "Graph(version: 1, nodes: {{\"out\": Subgraph(path: \"{path}\")}},
         results: {{\"out\": \"out\"}}, outputs: {{\"o.obj\": \"out\"}})"
    )
}

#[test]
fn f027_graphs_that_include_themselves() {
    for path in ["g.ron", "./g.ron", "in/../g.ron"] {
        let desk = Desk::with(including(path));
        desk.write("in/x", "");
        desk.go().refused(&["g.ron -> ", "g.ron:1:"]);
    }
    let desk = Desk::with(including("b.ron"));
    desk.write("b.ron", including("g.ron"));
    desk.go().refused(&["g.ron -> ", "b.ron -> ", "g.ron:1:"]);
    #[cfg(unix)]
    {
        let desk = Desk::with(including("link.ron"));
        std::os::unix::fs::symlink(desk.path("g.ron"), desk.path("link.ron")).expect("a link");
        desk.go().refused(&["link.ron", "g.ron:1:"]);
    }
    // Where case does not count, this is the graph itself; elsewhere it is missing.
    Desk::with(including("G.ron")).go().refused(&["G.ron"]);
}

#[test]
fn f028_includes_that_multiply() {
    use std::fmt::Write as _;
    let desk = Desk::with(including("l0.ron"));
    for level in 0..10 {
        let mut nodes = String::from("\"out\": Grid()");
        for k in 0..10 {
            let _ = write!(nodes, ", \"n{k}\": Subgraph(path: \"l{}.ron\")", level + 1);
        }
        let text = format!("Graph(version: 1, nodes: {{{nodes}}}, results: {{\"out\": \"out\"}})");
        desk.write(&format!("l{level}.ron"), text);
    }
    desk.write(
        "l10.ron",
        "Graph(version: 1, nodes: {\"out\": Grid()}, results: {\"out\": \"out\"})",
    );
    // Seconds on an idle machine.
    desk.go()
        .refused(&["more than 10000 graphs"])
        .within(60 * SECOND);
}

#[test]
fn f029_includes_from_outside() {
    for path in ["../../etc/passwd", "/etc/passwd", "../x.ron"] {
        let desk = Desk::with(including(path));
        desk.go().refused(&[path, "g.ron:1:"]);
    }
}

#[test]
fn f030_outputs_that_must_not_be_written() {
    let node = "\"out\": Grid()";
    for path in [
        "../x.obj",
        "/tmp/x.obj",
        "/dev/sda",
        "out/",
        "",
        "g.ron/x.obj",
    ] {
        let text =
            format!("Graph(version: 1, nodes: {{{node}}}, outputs: {{\"{path}\": \"out\"}})");
        refused(text, &["g.ron:1:"]);
    }
    let text = format!(
        "Graph(version: 1, nodes: {{{node}}}, outputs: {{\"o.obj\": \"out\", \"./o.obj\": \"out\"}})"
    );
    refused(text, &["g.ron:1:", "o.obj"]);
    let desk = Desk::with(
        "Graph(version: 1, nodes: {\"out\": ReadMesh(path: \"in.obj\")}, outputs: {\"in.obj\": \"out\"})",
    );
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    desk.write("in.obj", mesh);
    desk.go().refused(&["in.obj", "g.ron:1:"]);
    assert_eq!(desk.content("in.obj"), mesh.as_bytes());
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(desk.path("in.obj"), desk.path("link.obj")).expect("a link");
        let text = desk.content("g.ron");
        let text = String::from_utf8(text).expect("a text");
        desk.write("g.ron", text.replace("{\"in.obj\"", "{\"link.obj\""));
        desk.go().refused(&["link.obj", "g.ron:1:"]);
        assert_eq!(desk.content("in.obj"), mesh.as_bytes());
    }
}

#[test]
fn f031_counts_that_are_none() {
    for count in [
        "-1",
        "2147483648",
        "9223372036854775808",
        "1e9",
        "99999999999999999999",
    ] {
        let levels = format!("\"a\": Grid(), \"out\": SubdivideQuad(mesh: \"a\", levels: {count})");
        nodes_refused(&levels, &["levels", "0 to 8"]);
        let cells = format!("\"out\": Grid(cells: ({count}, 2))");
        Desk::nodes(&cells).go().refused(&["g.ron:1:"]);
    }
    nodes_refused("\"out\": Grid(cells: (0, 2))", &["must be 1 to"]);
}

#[test]
fn f032_thickness_and_smoothing_out_of_range() {
    let offset = |thickness: &str| {
        format!(
            "\"g\": Grid(cells: (2, 2)), \"n\": VertexNormals(mesh: \"g\"),
             \"c\": CompensateThickness(mesh: \"g\", directions: \"n\", thickness: {thickness}, mode: Global),
             \"out\": OffsetMesh(mesh: \"g\", directions: \"c\", outward: 1)"
        )
    };
    for thickness in ["-1", "NaN", "1e400"] {
        nodes_refused(&offset(thickness), &["thickness", "at least 0 m"]);
    }
    for thickness in ["1e-300", "1e300"] {
        let desk = Desk::nodes(&offset(thickness));
        desk.go().sound();
        if desk.path("out/o.obj").is_file() {
            let text = String::from_utf8(desk.content("out/o.obj")).expect("a text");
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }
    for setting in ["iterations: 1000000000", "diffusion: -1", "diffusion: 2"] {
        let smooth = format!(
            "\"g\": Grid(), \"s\": SmoothNormals(mesh: \"g\", {setting}),
             \"out\": OffsetMesh(mesh: \"g\", directions: \"s\", outward: 1)"
        );
        nodes_refused(&smooth, &["must be 0 to"]);
    }
}

#[test]
fn f033_a_newer_version() {
    let text = graph("\"out\": Grid()").replace("version: 1", "version: 7");
    refused(text, &["version", "7", "g.ron:1:"]);
    let other = "Graph(version: 7, things: {\"a\": NewThing[1]}, outputs: {})";
    refused(other, &["version", "7"]);
}

#[test]
fn f034_a_graph_that_outputs_nothing() {
    let text = "Graph(version: 1, nodes: {\"a\": Grid()}, outputs: {})";
    refused(text, &["outputs nothing", "g.ron:1:1"]);
}
