//! The commands besides `run`.

use serde_json::{Value, json};

use super::Desk;

#[test]
fn check_tells_all_errors_or_that_there_are_none() {
    let desk = Desk::new();
    let good = "Graph(version: 1, nodes: {\"a\": Length(value: 1)}, outputs: {\"a.json\": \"a\"})";
    desk.write("g.ron", good);
    let given = desk.command("check", &[]);
    assert_eq!(
        (given.status, given.out.as_str()),
        (0, "ok: 1 node, 1 output\n")
    );
    let given = desk.command("check", &["--message-format", "json"]);
    assert_eq!(
        (given.status, given.out.as_str(), given.err.as_str()),
        (0, "", "")
    );

    desk.write(
        "g.ron",
        &good.replace("value: 1", "value: \"é + b\", side: 2"),
    );
    let given = desk.command("check", &["--message-format", "json"]);
    assert_eq!((given.status, given.err.as_str()), (1, ""));
    for line in given.out.lines() {
        let problem: Value = serde_json::from_str(line).unwrap();
        assert_eq!(problem["severity"], json!("error"));
        assert_eq!(problem["line"], json!(1));
        assert!(problem["column"].as_u64().unwrap() > 30, "{problem}");
    }
    assert!(given.out.lines().count() >= 2, "{}", given.out);
    let given = desk.command("check", &[]);
    assert!(
        given.status == 1 && given.err.contains(" errors in "),
        "{}",
        given.err
    );
    let nothing = desk.program(&["check", &desk.path("no.ron").to_string_lossy()]);
    assert!(
        nothing.status == 1 && nothing.err.contains("no such file"),
        "{}",
        nothing.err
    );
}

#[test]
fn nodes_are_listed_and_described() {
    let desk = Desk::new();
    let list = desk.program(&["nodes"]);
    assert_eq!(list.status, 0);
    let forms = tessgraph_graph::forms::FORMS.len();
    assert_eq!(
        list.out.lines().count(),
        tessgraph_nodes::NODES.len() + forms
    );
    let name = tessgraph_nodes::NODES[0].name;
    let page = desk.program(&["nodes", name]);
    assert!(
        page.status == 0 && page.out.starts_with(name),
        "{}",
        page.out
    );
    let markdown = desk.program(&["nodes", "--markdown"]);
    assert_eq!(
        markdown.out,
        tessgraph_graph::reference::markdown(tessgraph_nodes::NODES)
    );
    let specs: Value = serde_json::from_str(&desk.program(&["nodes", "--json"]).out).unwrap();
    assert_eq!(specs[0]["name"], json!(name));
    let wrong = desk.program(&["nodes", &name.to_lowercase()]);
    assert_eq!(wrong.status, 2);
    assert!(
        wrong.err.contains(&format!("did you mean `{name}`")),
        "{}",
        wrong.err
    );
}

#[test]
fn a_new_folder_has_a_graph_that_runs() {
    let desk = Desk::new();
    let villa = desk.path("villa").to_string_lossy().into_owned();
    let given = desk.program(&["new", &villa]);
    assert_eq!((given.status, given.out.as_str()), (0, ""), "{}", given.err);
    let graph = desk.path("villa/facade.ron").to_string_lossy().into_owned();
    let run = desk.program(&["run", &graph]);
    assert_eq!(run.status, 0, "{}", run.err);
    assert_eq!(desk.names("villa/out"), ["facade.glb", "figures.json"]);
    let before = desk.text("villa/facade.ron");
    let again = desk.program(&["new", &villa]);
    assert!(
        again.status == 1 && again.err.contains("is there already"),
        "{}",
        again.err
    );
    assert_eq!(desk.text("villa/facade.ron"), before);
}

/// A closed tetrahedron.
const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

#[test]
fn info_measures_a_mesh_file() {
    let desk = Desk::new();
    let path = desk
        .write("t.obj", TETRAHEDRON)
        .to_string_lossy()
        .into_owned();
    let given = desk.program(&["info", &path, "--json"]);
    let figures: Value = serde_json::from_str(&given.out).unwrap();
    let keys: Vec<_> = figures
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    let expected = [
        "vertices",
        "edges",
        "faces",
        "triangles",
        "euler",
        "components",
        "boundary_edges",
        "boundary_loops",
        "nonmanifold_edges",
        "isolated_vertices",
        "degenerate_faces",
        "bounds",
        "area",
        "volume",
        "intersections",
    ];
    assert_eq!(keys, expected);
    assert_eq!(figures["euler"], json!(2));
    assert_eq!(figures["bounds"], json!([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]));
    assert!((figures["volume"].as_f64().unwrap() - 1.0 / 6.0).abs() < 1e-15);
    assert!(figures["intersections"].is_null());
    assert!(desk.program(&["info", &path]).out.contains("\nclosed\n"));
    let open = desk.write("o.obj", &TETRAHEDRON.replace("f 3 1 4\n", ""));
    let open = desk.program(&["info", &open.to_string_lossy()]);
    assert!(
        open.out.contains("open: 1 boundary loop of 3 edges"),
        "{}",
        open.out
    );
}

#[test]
fn info_counts_faces_that_cross_when_asked() {
    let desk = Desk::new();
    let asked = |path: &std::path::Path, more: &[&str]| {
        let path = path.to_string_lossy();
        desk.program(&[&["info", &path, "--intersections"], more].concat())
    };
    let sound = desk.write("t.obj", TETRAHEDRON);
    assert!(asked(&sound, &[]).out.ends_with("no two faces cross\n"));
    let number = |path: &std::path::Path| -> Value {
        let out = asked(path, &["--json"]).out;
        serde_json::from_str::<Value>(&out).unwrap()["intersections"].clone()
    };
    assert_eq!(number(&sound), json!(0));
    // A triangle that cuts through the three faces at the corner (1, 0, 0).
    let cut = "v 0.8 -1 -1\nv 0.8 2 -1\nv 0.8 -1 2\nf 5 6 7\n";
    let crossed = desk.write("c.obj", &format!("{TETRAHEDRON}{cut}"));
    let given = asked(&crossed, &[]);
    assert!(
        given.status == 0 && given.out.ends_with("3 pairs of faces cross\n"),
        "{}",
        given.out
    );
    assert_eq!(number(&crossed), json!(3));
}

#[test]
fn info_shows_the_line_that_is_wrong() {
    let desk = Desk::new();
    let path = desk.write("bad.obj", &TETRAHEDRON.replace("f 2 3 4", "f 2 3 9"));
    let given = desk.program(&["info", &path.to_string_lossy()]);
    assert_eq!((given.status, given.out.as_str()), (1, ""));
    assert!(given.err.contains("bad.obj:7:"), "{}", given.err);
    assert!(given.err.contains("7 | f 2 3 9"), "{}", given.err);
    let other = desk.program(&["info", "mesh.dwg"]);
    assert!(
        other.status == 2 && other.err.contains(".obj"),
        "{}",
        other.err
    );
}

#[test]
fn help_and_version_go_to_stdout() {
    let desk = Desk::new();
    let help = desk.program(&["--help"]);
    assert!(help.status == 0 && help.out.contains("Usage") && help.err.is_empty());
    assert!(!help.out.contains('\x1b'));
    let none = desk.program(&[]);
    assert_eq!((none.status, none.out.as_str()), (2, ""));
}
