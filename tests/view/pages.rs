//! Several pages of one graph: each sees what it has chosen.

use serde_json::{Value, json};

use super::{folder_with, write};
use crate::support::page::{Page, Server};

/// Two grids, of 4 and of 9 faces, `size` wide, and a report.
fn grids(size: f64) -> String {
    format!(
        "Graph(version: 1, nodes: {{
            \"small\": Grid(size: [{size:?}, 1], cells: [2, 2]),
            \"large\": Grid(size: [{size:?}, 1], cells: [3, 3]),
            \"flat\": CheckPlanarity(mesh: \"small\"),
        }}, outputs: {{\"small.obj\": \"small\", \"large.obj\": \"large\"}})"
    )
}

/// Whether this is a picture of so many faces, so wide.
fn is_picture(message: &Value, faces: usize, size: f64) -> bool {
    let mesh = &message["mesh"];
    let side = |end: usize| mesh["bounds"][end][0].as_f64().unwrap_or_default();
    message["type"] == "shown" && mesh["faces"] == faces && (side(1) - side(0) - size).abs() < 1e-9
}

/// Waits for such a picture.
fn picture(page: &mut Page, faces: usize, size: f64) -> Value {
    page.until("shown", |shown| is_picture(shown, faces, size))
}

fn show(page: &mut Page, node: &str) {
    page.ask(&json!({"type": "show", "node": node}));
}

/// How many faces a page hears of until it hears of the end of a run for that cause.
fn faces_until(page: &mut Page, cause: &str) -> Vec<Value> {
    let mut faces = Vec::new();
    loop {
        let message = page.next().expect("a message");
        if message["type"] == "shown" {
            faces.push(message["mesh"]["faces"].clone());
        }
        if message["type"] == "status"
            && message["state"] == "up_to_date"
            && message["cause"] == cause
        {
            return faces;
        }
    }
}

#[test]
fn each_page_sees_what_it_has_chosen() {
    let folder = folder_with(&grids(1.0));
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let [mut one, mut other] = [server.open(), server.open()];
    picture(&mut one, 4, 1.0);
    picture(&mut other, 4, 1.0);
    show(&mut one, "large");
    let large = picture(&mut one, 9, 1.0);
    // An edit reaches both, and neither sees the other's picture.
    write(&folder.path().join("g.ron"), &grids(2.0));
    let (wide, small) = (picture(&mut one, 9, 2.0), picture(&mut other, 4, 2.0));
    assert_ne!(large["version"], wide["version"]);
    assert_ne!(small["version"], wide["version"]);
    show(&mut one, "small");
    picture(&mut one, 4, 2.0);
    show(&mut one, "large");
    let wide = picture(&mut one, 9, 2.0);
    let heard = faces_until(&mut other, "showing large");
    assert!(heard.iter().all(|faces| faces == 4), "{heard:?}");
    // What is asked of a face is answered from one's own picture.
    for (page, is_there) in [(&mut one, true), (&mut other, false)] {
        page.ask(&json!({"type": "pick", "request": 1, "face": 8}));
        let picked = page.any("picked");
        assert_eq!(
            !picked["lines"].as_array().expect("lines").is_empty(),
            is_there,
            "{picked}"
        );
    }
    for (shown, faces) in [(&wide, 9), (&small, 4)] {
        let saved = server.get(&format!("offline/{}", shown["version"]));
        let html = String::from_utf8(saved.body).expect("text");
        assert!(html.contains(&format!("\"faces\":{faces}")), "{faces}");
        assert!(
            !html.contains(&format!("\"faces\":{}", 13 - faces)),
            "{faces}"
        );
    }
    // A report leaves the mesh where it was, for that page.
    show(&mut one, "flat");
    let report = one.until("shown", |shown| shown["node"] == "flat");
    assert!(report["report"].is_array());
    one.ask(&json!({"type": "pick", "request": 2, "face": 8}));
    assert_eq!(one.any("picked")["face"], 8);
    // Who comes sees the first mesh, and so does who comes back.
    drop(one);
    picture(&mut server.open(), 4, 2.0);
}

#[test]
fn a_page_whose_node_is_gone_is_told_and_sees_the_first_mesh() {
    let folder = folder_with(&grids(1.0));
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let [mut one, mut other] = [server.open(), server.open()];
    show(&mut one, "large");
    picture(&mut one, 9, 1.0);
    let text = grids(1.0).replace("\"large\": Grid", "\"huge\": Grid");
    write(
        &folder.path().join("g.ron"),
        &text.replace("\"large.obj\": \"large\"", ""),
    );
    let notice = one.any("notice");
    let told = notice["text"].as_str().expect("a text");
    assert!(
        told.contains("no node `large`") && told.contains("`small` is shown"),
        "{told}"
    );
    picture(&mut one, 4, 1.0);
    // It goes on seeing it, and nobody else was told.
    write(&folder.path().join("g.ron"), &grids(2.0));
    picture(&mut one, 4, 2.0);
    loop {
        let message = other.next().expect("a message");
        assert_ne!(message["type"], "notice");
        if is_picture(&message, 4, 2.0) {
            break;
        }
    }
}
