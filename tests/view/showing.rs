//! What is shown of a graph.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::{GRAPH, folder_with, write};
use crate::support::page::{Page, Server};
use crate::support::program::with_graphs;

fn number(value: &Value) -> usize {
    value.as_u64().expect("a number") as usize
}

fn words(bytes: &[u8]) -> Vec<u32> {
    let words = bytes.chunks_exact(4);
    words
        .map(|word| u32::from_le_bytes(word.try_into().expect("four bytes")))
        .collect()
}

fn floats(bytes: &[u8]) -> Vec<f64> {
    words(bytes)
        .into_iter()
        .map(|bits| f32::from_bits(bits).into())
        .collect()
}

/// Holds every buffer of a picture against its counts.
fn check_buffers(server: &Server, shown: &Value) {
    let mesh = &shown["mesh"];
    let (vertices, faces) = (number(&mesh["vertices"]), number(&mesh["faces"]));
    let triangles = number(&mesh["triangles"]);
    let positions = floats(&server.buffer(&mesh["positions"]));
    assert_eq!(positions.len(), 3 * vertices);
    for (axis, (low, high)) in [0, 1, 2].map(|axis| {
        let bound = |end: usize| mesh["bounds"][end][axis].as_f64().expect("a number");
        (axis, (bound(0), bound(1)))
    }) {
        let origin = mesh["origin"][axis].as_f64().expect("a number");
        let places = positions.iter().skip(axis).step_by(3);
        let (least, most) = places.fold((f64::MAX, f64::MIN), |(least, most), &place| {
            (least.min(place + origin), most.max(place + origin))
        });
        let near = 1e-6 * (high - low).max(1.0);
        assert!((least - low).abs() < near && (most - high).abs() < near);
    }
    let corners = words(&server.buffer(&mesh["triangles_buffer"]));
    assert_eq!(corners.len(), 3 * triangles);
    assert!(corners.iter().all(|&vertex| (vertex as usize) < vertices));
    let of_face = words(&server.buffer(&mesh["triangle_faces"]));
    assert_eq!(of_face.len(), triangles);
    assert!(of_face.is_sorted() && of_face.last().is_none_or(|&face| (face as usize) < faces));
    assert_eq!(server.buffer(&mesh["edges"]).len(), triangles);
    for field in shown["fields"].as_array().expect("fields") {
        let values = floats(&server.buffer(&field["values"]));
        let expected = if field["on"] == "vertex" {
            vertices
        } else {
            faces
        };
        assert_eq!(values.len(), expected, "{}", field["name"]);
        let (min, max) = (field["min"].as_f64(), field["max"].as_f64());
        let least = values.iter().copied().fold(f64::MAX, f64::min);
        let most = values.iter().copied().fold(f64::MIN, f64::max);
        let is_near = |one: f64, two: Option<f64>| {
            two.is_some_and(|two| (one - two).abs() <= 1e-6 * two.abs().max(1e-3))
        };
        assert!(is_near(least, min) && is_near(most, max), "{field}");
    }
}

#[test]
fn every_shipped_graph_is_shown() {
    let folder = with_graphs();
    let mut seen = 0;
    for entry in std::fs::read_dir(folder.path()).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "ron") {
            continue;
        }
        let graph = path.file_name().expect("a name").to_string_lossy();
        let server = Server::start(folder.path(), &graph, &["--port", "0"]);
        let mut page = server.open();
        let hello = page.any("hello");
        assert_eq!(
            (&hello["file"], &hello["read_only"]),
            (&json!(graph), &json!(false))
        );
        let document = page.until("document", |document| {
            document["nodes"]
                .as_array()
                .is_some_and(|nodes| !nodes.is_empty())
        });
        let source = document["source"].as_str().expect("a text");
        for parameter in document["parameters"].as_array().expect("parameters") {
            let span = |end: usize| number(&parameter["span"][end]);
            let written = &source[span(0)..span(1)];
            let told = &parameter["in_file"];
            let is_same = match (written.parse::<f64>(), told.as_f64()) {
                (Ok(one), Some(other)) => one.total_cmp(&other).is_eq(),
                _ => written.trim_matches('"') == told.as_str().unwrap_or(&told.to_string()),
            };
            assert!(is_same, "{written} is told as {told}");
        }
        let shown = page.any("shown");
        assert!(shown["empty"].is_null(), "{graph}: {}", shown["empty"]);
        if !shown["mesh"].is_null() {
            check_buffers(&server, &shown);
        }
        // The first messages of a page that comes later, in their order.
        let mut late = server.open();
        let types: Vec<Value> = (0..7)
            .map(|_| late.next().expect("a message")["type"].take())
            .collect();
        let order = [
            "hello",
            "document",
            "status",
            "outcomes",
            "diagnostics",
            "checks",
            "shown",
        ];
        assert_eq!(types, order.map(Value::from));
        seen += 1;
    }
    assert!(seen >= 6, "{seen} graphs");
}

#[test]
fn fields_lie_on_the_mesh_they_belong_to() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    let shown = page.any("shown");
    assert_eq!(shown["node"], "grid");
    let fields = shown["fields"].as_array().expect("fields");
    let names: Vec<_> = fields.iter().map(|field| &field["name"]).collect();
    assert_eq!(names, ["flat.field"]);
    assert_eq!(
        (&fields[0]["on"], &fields[0]["unit"]),
        (&json!("face"), &json!("cm"))
    );
    check_buffers(&server, &shown);
    assert_eq!(shown["mesh"]["scale"], 100.0);
}

#[test]
fn fields_of_variants_side_by_side_are_not_mixed() {
    let folder = folder_with(
        r#"Graph(version: 1, nodes: {
            "base": Grid(cells: (3, 2)),
            "a": Transform(mesh: "base", translate: (0, 0, 1)),
            "b": Transform(mesh: "base", translate: (0, 0, 2)),
            "of_base": CheckPlanarity(mesh: "base"), "of_a": CheckPlanarity(mesh: "a"),
            "of_b": CheckPlanarity(mesh: "b"),
        }, outputs: {"a.obj": "a", "base.json": "of_base", "a.json": "of_a", "b.json": "of_b"})"#,
    );
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let shown = server.open().any("shown");
    assert_eq!(shown["node"], "a");
    let fields = shown["fields"].as_array().expect("fields");
    let nodes: BTreeSet<_> = fields
        .iter()
        .filter_map(|field| field["node"].as_str())
        .collect();
    // What `a` was made from has the same faces; so has `b`, but it is another roof.
    assert_eq!(nodes, BTreeSet::from(["of_a", "of_base"]));
}

/// Asks for a result, and gives the picture of it.
fn show(page: &mut Page, node: &str, result: Option<&str>) -> Value {
    page.ask(&json!({"type": "show", "node": node, "result": result}));
    page.until("shown", |shown| shown["node"] == node)
}

#[test]
fn any_result_can_be_shown() {
    let folder = with_graphs();
    let server = Server::start(folder.path(), "facade.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    let shown = show(&mut page, "even", None);
    assert_eq!(
        (&shown["kind"], number(&shown["mesh"]["faces"])),
        (&json!("Directions"), 256)
    );
    let vectors = floats(&server.buffer(&shown["directions"]["outward"]));
    assert_eq!(vectors.len(), 3 * number(&shown["mesh"]["vertices"]));
    let shown = show(&mut page, "depth", Some("distances"));
    assert_eq!(shown["kind"], "Field");
    check_buffers(&server, &shown);
    let shown = show(&mut page, "size", None);
    assert_eq!(shown["report"][0]["name"], "vertices");
    // One that is not there leaves everything as it is, and is said.
    page.ask(&json!({"type": "show", "node": "nothing"}));
    let notice = page.any("notice");
    assert!(
        notice["text"]
            .as_str()
            .is_some_and(|text| text.contains("`nothing`")),
        "{notice}"
    );
}

#[test]
fn positions_are_told_before_the_picture_that_names_them() {
    let grid = |size: f64| {
        format!(
            "Graph(version: 1, nodes: {{\"grid\": Grid(size: [{size:?}, 1], cells: [2, 2])}}, \
             outputs: {{\"g.obj\": \"grid\"}})"
        )
    };
    let folder = folder_with(&grid(1.0));
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    let first = page.any("shown");
    write(&folder.path().join("g.ron"), &grid(2.0));
    let coming = page.any("coming");
    let shown = page.any("shown");
    assert_eq!(coming["positions"], shown["mesh"]["positions"]);
    assert_ne!(first["mesh"]["positions"], shown["mesh"]["positions"]);
    // Who comes later is told of the picture itself.
    let mut later = server.open();
    loop {
        let told = later.next().expect("a message");
        assert_ne!(told["type"], "coming");
        if told["type"] == "shown" {
            break;
        }
    }
}

#[test]
fn a_face_that_comes_to_be_cut_otherwise_is_shown_so() {
    let graph = "Graph(version: 1, nodes: {\"face\": ReadMesh(path: \"face.obj\")}, \
                 outputs: {\"g.obj\": \"face\"})";
    let face = |second: &str| format!("v 0 0 0\nv {second} 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\n");
    let folder = folder_with(graph);
    let path = folder.path().join("face.obj");
    write(&path, &face("2 0"));
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    let triangles = |shown: &Value| words(&server.buffer(&shown["mesh"]["triangles_buffer"]));
    let fan = [0, 1, 2, 0, 2, 3];
    assert_eq!(triangles(&page.any("shown")), fan);
    // The second corner sinks into the square: the first one does not see all any more.
    write(&path, &face("0.6 1.2"));
    let dart = page.until("shown", |shown| triangles(shown) != fan);
    assert_eq!(triangles(&dart), [1, 2, 3, 0, 1, 3]);
    write(&path, &face("1.9 0"));
    assert_eq!(triangles(&page.any("shown")), fan);
}

#[test]
fn nothing_to_draw_is_said() {
    let text = GRAPH.replace(
        "\"flat\":",
        "\"none\": DeleteFaces(mesh: \"grid\", faces: 1), \"flat\":",
    );
    let folder = folder_with(&text);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.any("shown");
    let shown = show(&mut page, "none", None);
    assert_eq!(shown["mesh"]["faces"], 0, "{shown}");
    assert!(shown["empty"].is_string(), "{shown}");
}

#[test]
fn elements_are_told_exactly_in_the_units_of_the_file() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    page.ask(&json!({"type": "pick", "request": 5, "face": 0}));
    let picked = page.any("picked");
    assert_eq!(
        (&picked["request"], &picked["face"]),
        (&json!(5), &json!(0))
    );
    let lines = picked["lines"].as_array().expect("lines");
    let told = |text: &str| json!({"text": text, "exact": text});
    assert!(lines.contains(&json!(["corners", told("4")])), "{picked}");
    assert!(lines.contains(&json!(["flat", told("0 cm")])), "{picked}");
    assert_eq!(picked["vertices"].as_array().map(Vec::len), Some(4));
    // Three columns and two rows over a square of 100 cm: far corners.
    let ends = (json!({"vertex": 0}), json!({"vertex": 11}));
    page.ask(&json!({"type": "measure", "request": 6, "from": ends.0, "to": ends.1}));
    let measured = page.any("measured");
    let delta = [told("100 cm"), told("100 cm"), told("0 cm")];
    assert_eq!(measured["delta"], json!(delta));
    let distance = json!({"text": "141.42 cm", "exact": "141.4213562373 cm"});
    assert_eq!(measured["distance"], distance);
    page.ask(&json!({"type": "measure", "request": 7, "from": {"face": 99}, "to": ends.1}));
    assert_eq!(page.any("notice")["level"], "warning");
}

#[test]
fn nodes_are_described() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    page.ask(&json!({"type": "describe", "node": "flat"}));
    let described = page.any("described");
    let markdown = described["markdown"].as_str().expect("a page");
    assert!(markdown.starts_with("## CheckPlanarity"), "{markdown}");
    assert_eq!(described["results"][0]["name"], "report");
}

#[test]
fn a_graph_without_a_mesh_shows_its_table_or_report() {
    let text = GRAPH.replace("\"grid.obj\": \"grid\", ", "");
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder.path().join("g.ron"), &text);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let shown = server.open().any("shown");
    assert_eq!(
        (&shown["node"], &shown["kind"]),
        (&json!("flat"), &json!("Report"))
    );
    assert!(
        shown["report"]
            .as_array()
            .is_some_and(|lines| lines.len() > 3)
    );
    // The page keeps the mesh it has, if it has one.
    assert!(shown["mesh"].is_null());
}
