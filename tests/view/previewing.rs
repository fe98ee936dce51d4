//! Pictures that follow a parameter before the graph is evaluated.

use std::path::Path;

use serde_json::{Value, json};

use super::folder_with;
use crate::support::page::{Page, Server};

/// Blocks on both sides of a wavy surface, higher where its faces are larger.
const ARRAY: &str = r#"Graph(
    version: 1,
    params: {
        "t": Number(default: 0.25, min: 0.05, max: 0.85),
        "width": Number(default: 6.0, min: 1, max: 9),
        "columns": Integer(default: 3, min: 1, max: 5),
        "bumps": Number(default: 0.5, min: 0, max: 1),
    },
    nodes: {
        "surface": ParametricSurface(
            x: "width * u", y: "4 * v", z: "bumps * sin(5 * u) * cos(4 * v)", cells: ["columns", 2],
        ),
        "normals": VertexNormals(mesh: "surface"),
        "even": CompensateThickness(
            mesh: "surface", directions: "normals", thickness: 0.2, mode: Global,
        ),
        "block": Cuboid(size: [1, 1, 3]),
        "fitted": FitComponent(component: "block", height: "2 * t", anchor: Centre),
        "array": ArrayComponents(
            base: "surface", component: "fitted", directions: "even",
            fit: Unit, height: Relative, join: Weld,
        ),
        "marked": SetAttribute(mesh: "array", name: "mark", on: Faces, value: 1),
    },
    outputs: {"array.obj": "array"},
)
"#;

fn ask(page: &mut Page, name: &str, from: f64, to: f64) -> Value {
    page.ask(&json!({"type": "preview", "request": 7, "name": name, "from": from, "to": to}));
    let answer = page.any("previewed");
    assert_eq!(answer["request"], 7);
    answer
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    let words = bytes.chunks_exact(4);
    words
        .map(|word| f32::from_le_bytes(word.try_into().expect("four bytes")))
        .collect()
}

fn ids(bytes: &[u8]) -> Vec<u32> {
    let words = bytes.chunks_exact(4);
    words
        .map(|word| u32::from_le_bytes(word.try_into().expect("four bytes")))
        .collect()
}

/// Positions of what is shown, and where they are relative to.
fn positions(server: &Server, shown: &Value) -> (Vec<f32>, Value) {
    let mesh = &shown["mesh"];
    (
        floats(&server.buffer(&mesh["positions"])),
        mesh["origin"].clone(),
    )
}

#[test]
fn the_page_gets_the_parts_of_an_array_and_what_a_parameter_does() {
    let folder = folder_with(ARRAY);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    let shown = page.any("shown");
    let answer = ask(&mut page, "t", 0.05, 0.85);
    assert_eq!(answer["version"], shown["version"]);
    assert_eq!(answer["is_exact"], true);
    let factors = answer["factors"].as_array().expect("samples");
    assert_eq!(factors.len(), 5);
    let first = factors[0][1].as_f64().expect("a number");
    assert!((first - 0.2).abs() < 1e-12, "{first}");
    let instances = &answer["instances"];
    let get = |name: &str| server.buffer(&instances[name]);
    let exact = |t: f64, shown: &Value| {
        let (positions, origin) = positions(&server, shown);
        json!({"value": t, "origin": origin, "positions": positions})
    };
    let mut expected = vec![exact(0.25, &shown)];
    for t in [0.85, 0.05] {
        page.ask(&json!({"type": "set", "name": "t", "value": t}));
        expected.push(exact(t, &page.any("shown")));
    }
    let fixture = json!({
        "about": "written by tests/view/previewing.rs: parts of an array, and its exact vertices",
        "origin": shown["mesh"]["origin"],
        "bounds": shown["mesh"]["bounds"],
        "is_unit": instances["is_unit"],
        "reach": instances["reach"],
        "samples": answer["factors"],
        "vertices": ids(&get("vertices")),
        "points": floats(&get("points")),
        "grids": ids(&get("grids")),
        "grid_starts": ids(&get("grid_starts")),
        "positions": floats(&get("positions")),
        "outward": floats(&get("outward")),
        "inward": floats(&get("inward")),
        "factors": [floats(&server.buffer(&instances["factors"][0]))],
        "expected": expected,
    });
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../web/tests/unit/instances.json");
    let text = serde_json::to_string(&fixture).expect("JSON") + "\n";
    if std::env::var("TESSGRAPH_FIGURES").is_ok_and(|wish| wish == "update") {
        super::write(&path, &text);
    }
    assert!(
        crate::support::text_of(&path) == text,
        "web/tests/unit/instances.json is out of date: run this test with TESSGRAPH_FIGURES=update"
    );
}

#[test]
fn what_cannot_be_followed_is_said() {
    let folder = folder_with(ARRAY);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    for (name, reason) in [
        ("width", "`surface.x` depends on it, too"),
        ("columns", "`surface.cells` depends on it, too"),
        ("nothing", "there are no values to compare"),
    ] {
        let answer = ask(&mut page, name, 1.0, 3.0);
        assert_eq!(answer["reason"], reason, "{name}");
        assert!(answer.get("instances").is_none());
    }
    page.ask(&json!({"type": "show", "node": "surface"}));
    page.until("shown", |shown| shown["node"] == "surface");
    let answer = ask(&mut page, "t", 0.05, 0.85);
    assert_eq!(answer["reason"], "what is shown is no array of components");
    // A node that leaves vertices and faces as they are shows the array, too.
    page.ask(&json!({"type": "show", "node": "marked"}));
    page.until("shown", |shown| shown["node"] == "marked");
    let answer = ask(&mut page, "t", 0.05, 0.85);
    assert!(answer["instances"].is_object(), "{answer}");
    // Directions that depend on the thickness are left as they are.
    let text = ARRAY.replace("thickness: 0.2", "thickness: \"t\"");
    super::write(&folder.path().join("g.ron"), &text);
    page.until("document", |document| document["source"] == text);
    page.until_up_to_date();
    let answer = ask(&mut page, "t", 0.05, 0.85);
    assert_eq!(answer["is_exact"], false);
    assert!(answer["instances"].is_object());
    // Every vertex by itself is no formula.
    let text = ARRAY.replace("directions: \"even\"", "directions: \"normals\"");
    let text = text.replace("fit: Unit,", "fit: Unit, compensate: PerVertex,");
    super::write(&folder.path().join("g.ron"), &text);
    page.until("document", |document| document["source"] == text);
    page.until_up_to_date();
    let answer = ask(&mut page, "t", 0.05, 0.85);
    let reason = answer["reason"].as_str().expect("a reason");
    assert!(reason.contains("by itself"), "{reason}");
}

#[test]
fn a_component_that_is_used_elsewhere_too_is_no_matter_of_heights() {
    // The block stands on blocks: its height moves what it stands on.
    let text = r#"Graph(
    version: 1,
    params: {"t": Number(default: 0.5, min: 0.1, max: 1)},
    nodes: {
        "block": Cuboid(size: [1, 1, 3]),
        "fitted": FitComponent(component: "block", height: "t"),
        "other": FitComponent(component: "block", height: 1),
        "normals": VertexNormals(mesh: "fitted"),
        "array": ArrayComponents(base: "fitted", component: "fitted", directions: "normals", fit: Unit),
        "flat": Grid(cells: [2, 2]),
        "up": VertexNormals(mesh: "flat"),
        "mixed": ArrayComponents(
            base: "flat", components: ["fitted", "other"], choose: Random, directions: "up", fit: Unit,
        ),
    },
    outputs: {"array.obj": "array", "mixed.obj": "mixed"},
)
"#;
    let folder = folder_with(text);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    page.any("shown");
    let answer = ask(&mut page, "t", 0.1, 1.0);
    assert_eq!(answer["reason"], "`fitted.height` depends on it, too");
    page.ask(&json!({"type": "show", "node": "mixed"}));
    page.until("shown", |shown| shown["node"] == "mixed");
    let answer = ask(&mut page, "t", 0.1, 1.0);
    assert_eq!(answer["reason"], "it changes some of the components only");
}
