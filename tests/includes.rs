//! Graphs that include graphs, run as a whole.

use tessgraph_graph::world::MemoryWorld;
use tessgraph_graph::{Engine, Plan, Silent};

use crate::support;
use crate::support::program::{run, text, with_graphs};

const PART: &str = r#"Graph(
    version: 1,
    inputs: {"mesh": Mesh(), "t": Number(unit: Length)},
    nodes: {
        "normals": VertexNormals(mesh: "mesh"),
        "shell": OffsetMesh(mesh: "mesh", directions: "normals", outward: "t"),
        "size": MeasureMesh(mesh: "shell"),
    },
    results: {"shell": "shell", "area": "size.area", "size": "size"},
)"#;

fn graph(nodes: &str, output: &str) -> String {
    format!(
        "Graph(version: 1, params: {{\"t\": 0.1}}, nodes: {{\
         \"base\": Grid(cells: [3, 2], size: [3, 2]),\n{nodes}}},\
         outputs: {{\"out.json\": \"{output}\"}})"
    )
}

fn world() -> MemoryWorld {
    let mut world = MemoryWorld::default();
    world.insert("part.ron", PART.as_bytes());
    world.insert(
        "part_mm.ron",
        PART.replace("version: 1", "version: 1, units: Mm")
            .as_bytes(),
    );
    world
}

fn load(text: &str) -> Plan {
    support::load_in("main.ron", text, &world())
}

/// "name outcome" of every node.
fn outcomes(engine: &Engine, text: &str) -> Vec<String> {
    let plan = load(text);
    let wanted: Vec<_> = plan.outputs.iter().map(|output| output.result).collect();
    let evaluation = engine.evaluate(&plan, &wanted, &world(), &Silent);
    assert!(
        evaluation.is_ok(),
        "{}",
        support::shown(&evaluation.diagnostics)
    );
    let nodes = evaluation.nodes.iter();
    nodes
        .map(|node| format!("{} {}", node.name, node.outcome))
        .collect()
}

const INLINE: &str = r#""normals": VertexNormals(mesh: "base"),
    "shell": OffsetMesh(mesh: "base", directions: "normals", outward: "t"),
    "size": MeasureMesh(mesh: "shell"),"#;

#[test]
fn the_same_work_inline_or_included_has_the_same_keys() {
    let engine = Engine::new(1 << 30);
    let inline = outcomes(&engine, &graph(INLINE, "size"));
    assert!(
        inline.iter().all(|line| line.ends_with(" computed")),
        "{inline:?}"
    );
    let form = r#""s": Subgraph(path: "part.ron", with: {"mesh": "base", "t": "t"}),"#;
    let wanted = [
        "base cached",
        "s/normals cached",
        "s/shell cached",
        "s/size cached",
    ];
    assert_eq!(outcomes(&engine, &graph(form, "s.size")), wanted);
    // Of two more thicknesses, only what depends on them is computed.
    let form = r#""s": ForEach(path: "part.ron", with: {"mesh": "base"},
        over: {"t": Values(of: ["t", "2 * t"])}),"#;
    let each = outcomes(&engine, &graph(form, "s.size"));
    let computed: Vec<&String> = each
        .iter()
        .filter(|line| line.ends_with(" computed"))
        .collect();
    assert_eq!(
        computed,
        ["s/2/shell computed", "s/2/size computed", "s.size computed"]
    );
}

#[test]
fn an_edit_of_an_included_graph_reaches_only_what_uses_it() {
    let engine = Engine::new(1 << 30);
    let form = r#""s": Subgraph(path: "part.ron", with: {"mesh": "base", "t": "t"}),"#;
    outcomes(&engine, &graph(form, "s.size"));
    let thicker = graph(&form.replace("\"t\": \"t\"", "\"t\": \"t / 2\""), "s.size");
    let again = outcomes(&engine, &thicker);
    assert_eq!(again[..2], ["base cached", "s/normals cached"]);
    assert_eq!(again[2..], ["s/shell computed", "s/size computed"]);
}

#[test]
fn lengths_cross_into_other_units_and_back() {
    let area = |path: &str| {
        let form = format!(
            r#""one": Subgraph(path: "{path}", with: {{"mesh": "base", "t": "t"}}),
               "two": Subgraph(path: "{path}", with: {{"mesh": "base", "t": "one.area / 1000"}}),
               "size": MeasureMesh(mesh: "two"),"#
        );
        let ran = support::Ran::run(load(&graph(&form, "size")), &world());
        (
            ran.number("two/t"),
            ran.number("size.volume").to_bits(),
            ran.number("one/size.area").to_bits(),
        )
    };
    let (metres, volume, shell) = area("part.ron");
    assert_eq!(area("part_mm.ron").1, volume);
    assert_eq!(area("part_mm.ron").2, shell);
    // Top and bottom of 3 m by 2 m and a rim of 10 m, 0.1 m high.
    assert!((metres - 13.0 / 1000.0).abs() < 1e-12, "{metres}");
}

#[test]
fn a_failure_inside_shows_the_file_and_where_it_is_included() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        std::fs::create_dir_all(folder.path().join("parts")).expect("a folder");
        std::fs::write(folder.path().join(name), text).expect("a file");
    };
    write(
        "parts/guard.ron",
        "Graph(version: 1, inputs: {\"mesh\": Mesh(), \"least\": Number()}, nodes: {\n    \
         \"size\": MeasureMesh(mesh: \"mesh\"),\n    \
         \"large\": Require(condition: \"size.faces >= least\", message: \"too few faces\"),\n\
         }, results: {\"ok\": \"large\"})\n",
    );
    write(
        "main.ron",
        "Graph(version: 1, nodes: {\n    \"base\": Grid(cells: [3, 2]),\n    \
         \"guard\": Subgraph(path: \"parts/guard.ron\", with: {\"mesh\": \"base\", \"least\": 7}),\n\
         }, outputs: {\"ok.json\": \"guard\"})\n",
    );
    let done = run(&["run", "main.ron"], folder.path());
    assert_eq!(done.status.code(), Some(1));
    let told = text(&done.stderr);
    let told = told.split("\nnode ").next().unwrap_or_default().trim_end();
    insta::assert_snapshot!("failure_inside", told);
}

#[test]
fn parts_outside_the_folder_need_leave_and_are_never_overwritten() {
    let folder = with_graphs();
    let write =
        |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    std::fs::create_dir(folder.path().join("job")).expect("a folder");
    write(
        "parts/flat.ron",
        "Graph(version: 1, nodes: {\"g\": Grid()}, results: {\"g\": \"g\"})",
    );
    write(
        "job/main.ron",
        "Graph(version: 1, nodes: {\"p\": Subgraph(path: \"../parts/flat.ron\")}, outputs: {\"p.obj\": \"p\"})",
    );
    let refused = run(&["run", "job/main.ron"], folder.path());
    assert_eq!(refused.status.code(), Some(1));
    let told = text(&refused.stderr);
    assert!(
        told.contains("outside the graph's folder") && told.contains("--allow"),
        "{told}"
    );
    let allowed = run(&["run", "job/main.ron", "--allow", "parts"], folder.path());
    assert!(allowed.status.success(), "{}", text(&allowed.stderr));

    write(
        "own.ron",
        "Graph(version: 1, nodes: {\"p\": Subgraph(path: \"parts/flat.ron\"), \"m\": MeasureMesh(mesh: \"p\")},\
         outputs: {\"x.json\": \"m\"})",
    );
    std::fs::hard_link(
        folder.path().join("parts/flat.ron"),
        folder.path().join("x.json"),
    )
    .expect("a link");
    let refused = run(&["run", "own.ron"], folder.path());
    assert_eq!(refused.status.code(), Some(1));
    let told = text(&refused.stderr);
    assert!(told.contains("would overwrite an input"), "{told}");
}

#[test]
fn a_part_says_how_it_is_used() {
    let folder = with_graphs();
    let done = run(&["run", "parts/panels.ron"], folder.path());
    assert_eq!(done.status.code(), Some(1));
    let told = text(&done.stderr);
    assert!(
        told.contains("cannot run by itself: `mesh` and `thickness` must be given"),
        "{told}"
    );
    assert!(
        told.contains("Subgraph(path: \"panels.ron\", with: {\"mesh\": ...})"),
        "{told}"
    );
    let page = run(&["nodes", "Repeat"], folder.path());
    let told = text(&page.stdout);
    assert!(
        told.contains("carry: the name of an input in quotes; required"),
        "{told}"
    );
}

#[test]
fn a_parameter_says_how_often() {
    let folder = with_graphs();
    let count = |steps: &str| {
        let steps = format!("steps={steps}");
        let done = run(
            &["run", "relief.ron", "--set", &steps, "--report", "json"],
            folder.path(),
        );
        let report: serde_json::Value = serde_json::from_slice(&done.stdout).expect("JSON");
        report["nodes"].as_array().map(Vec::len)
    };
    assert_eq!((count("0"), count("3")), (Some(2), Some(2 + 3 * 6)));
}
