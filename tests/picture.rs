//! The pictures of graphs, from outside.

use crate::support::program::with_graphs;

fn graph(arguments: &[&str]) -> String {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let arguments = [&["tessgraph", "graph"], arguments].concat();
    let status = tessgraph::run(arguments, &mut out, &mut err);
    assert_eq!(status, 0, "{}", String::from_utf8_lossy(&err));
    String::from_utf8(out).expect("UTF-8")
}

#[test]
fn a_facade_in_three_forms() {
    let folder = with_graphs();
    let path = folder
        .path()
        .join("facade.ron")
        .to_string_lossy()
        .into_owned();
    for format in ["svg", "dot", "mermaid"] {
        let text = graph(&[&path, "--format", format]);
        assert_eq!(text, graph(&[&path, "--format", format]), "{format}");
        insta::with_settings!({snapshot_suffix => format, omit_expression => true}, {
            insta::assert_snapshot!("facade", text);
        });
    }
}

#[test]
fn every_parameter_is_joined_to_what_uses_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("g.ron");
    let text = r#"Graph(version: 1,
    params: {
        "t": Number(default: 0.1, unit: Length), "n": 2, "file": Path(default: "a"),
        "way": Choice(default: Local, of: [Local, Global]), "idle": 1, "min": 3,
    },
    nodes: {
        "base": ReadMesh(path: "meshes/{file}.obj"),
        "literal": ReadMesh(path: "{{idle}}.obj"),
        "moved": Transform(mesh: "base", translate: ("t", 0, "2 * t + min(n, 1)")),
        "dirs": VertexNormals(mesh: "moved"),
        "even": CompensateThickness(mesh: "moved", directions: "dirs", thickness: "t", mode: "way"),
        "size": MeasureMesh(mesh: "moved"),
        "shell": OffsetMesh(mesh: "moved", directions: "even", outward: "size.area * 0.01"),
    },
    outputs: {"out/<shell> & more.obj": "shell"})"#;
    std::fs::write(&path, text).expect("written");
    insta::with_settings!({omit_expression => true}, {
        insta::assert_snapshot!("parameters", graph(&[&path.to_string_lossy(), "--format", "dot"]));
    });
}

#[test]
fn times_of_the_last_run_are_shown() {
    let folder = with_graphs();
    let path = folder
        .path()
        .join("torus.ron")
        .to_string_lossy()
        .into_owned();
    let cache = folder.path().join("kept").to_string_lossy().into_owned();
    let before = graph(&[&path, "--cache", &cache]);
    assert!(!before.contains(" ms, "), "nothing has run");
    assert!(
        !folder.path().join("kept").exists(),
        "drawing makes no folder"
    );
    let (mut out, mut err) = (Vec::new(), Vec::new());
    tessgraph::run(
        ["tessgraph", "run", &path, "--cache", &cache],
        &mut out,
        &mut err,
    );
    let after = graph(&[&path, "--cache", &cache]);
    assert_eq!(after.matches(" ms, ").count(), 6, "{after}");
}
