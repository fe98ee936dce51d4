//! Trying values out, and writing them.

use serde_json::{Value, json};

use super::{GRAPH, folder_with, graph_in, write};
use crate::support::page::{Page, Server};

fn faces(page: &mut Page, count: usize) -> Value {
    page.until("shown", |shown| shown["mesh"]["faces"] == count)
}

fn parameter(document: &Value, name: &str) -> Value {
    let parameters = document["parameters"].as_array().expect("parameters");
    let found = parameters
        .iter()
        .find(|parameter| parameter["name"] == name);
    found.expect("the parameter").clone()
}

#[test]
fn a_value_that_is_tried_out_changes_the_picture_and_not_the_file() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    faces(&mut page, 6);
    page.ask(&json!({"type": "set", "name": "n", "value": 7}));
    let document = page.until("document", |document| {
        parameter(document, "n")["value"] == 7
    });
    assert_eq!(parameter(&document, "n")["in_file"], 3);
    let status = page.until_up_to_date();
    assert_eq!(status["cause"], "slider n");
    faces(&mut page, 14);
    assert_eq!(graph_in(&folder), GRAPH);
    // Other pages see the same.
    faces(&mut server.open(), 14);
    for (name, value, told) in [
        ("m", json!(10), "must be 1 to 9"),
        ("m", json!("x"), "takes a whole number"),
        ("x", json!(1), "no parameter `x`"),
    ] {
        page.ask(&json!({"type": "set", "name": name, "value": value}));
        let notice = page.any("notice");
        let text = notice["text"].as_str().expect("a text");
        assert!(text.contains(told), "{text}");
    }
}

#[test]
fn a_written_value_is_the_only_change_and_can_be_undone() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    faces(&mut page, 6);
    let mut write = |name: &str, value: Value, changed: &str| {
        page.ask(&json!({"type": "write", "name": name, "value": value}));
        let document = page.until("document", |document| document["source"] == changed);
        assert_eq!(graph_in(&folder), changed);
        assert_eq!(parameter(&document, name)["in_file"], value);
        assert_eq!(document["can_undo"], true);
    };
    let one = GRAPH.replace("\"n\": 3,", "\"n\": 5,");
    write("n", json!(5), &one);
    let two = one.replace("default: 100.0,", "default: 120.5,");
    write("width", json!(120.5), &two);
    let mut step = |request: &str, expected: &str| {
        page.ask(&json!({"type": request}));
        page.until("document", |document| document["source"] == expected);
        assert_eq!(graph_in(&folder), expected);
    };
    step("undo", &one);
    step("undo", GRAPH);
    step("redo", &one);
    step("undo", GRAPH);
    page.until_up_to_date();
    page.ask(&json!({"type": "write", "name": "n", "value": 8}));
    faces(&mut page, 16);
    page.ask(&json!({"type": "reset", "name": "n"}));
    faces(&mut page, 6);
    assert_eq!(graph_in(&folder), GRAPH);
}

#[test]
fn dust_of_arithmetic_is_not_written() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    page.ask(&json!({"type": "write", "name": "width", "value": 0.1f64 + 0.2 + 120.0}));
    page.until("document", |document| {
        parameter(document, "width")["in_file"] == 120.3
    });
    let expected = GRAPH.replace("default: 100.0,", "default: 120.3,");
    assert_eq!(graph_in(&folder), expected);
}

#[test]
fn what_somebody_else_changed_is_kept_and_told() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    faces(&mut page, 6);
    page.ask(&json!({"type": "write", "name": "n", "value": 4}));
    faces(&mut page, 8);
    let theirs = GRAPH.replace("\"n\": 3, // columns", "\"n\": 9, // theirs");
    write(&folder.path().join("g.ron"), &theirs);
    // Whether the server has noticed by now or not.
    page.ask(&json!({"type": "undo"}));
    let notice = page.any("notice");
    let text = notice["text"].as_str().expect("a text");
    assert!(text.contains("g.ron was changed outside"), "{text}");
    assert_eq!(graph_in(&folder), theirs);
    faces(&mut page, 18);
    // From here on it can be edited again.
    page.ask(&json!({"type": "write", "name": "n", "value": 2}));
    faces(&mut page, 4);
    let expected = theirs.replace("\"n\": 9,", "\"n\": 2,");
    assert_eq!(graph_in(&folder), expected);
}

#[test]
fn what_the_command_line_holds_cannot_be_changed() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0", "--set", "n=10"]);
    let mut page = server.open();
    faces(&mut page, 20);
    for request in ["set", "write"] {
        page.ask(&json!({"type": request, "name": "n", "value": 4}));
        let notice = page.any("notice");
        assert!(
            notice["text"]
                .as_str()
                .is_some_and(|text| text.contains("`--set`"))
        );
    }
    assert_eq!(graph_in(&folder), GRAPH);
    let document = server.open().any("document");
    let held = parameter(&document, "n");
    assert_eq!(
        (&held["locked"], &held["value"]),
        (&json!(true), &json!(10))
    );
    let wrong = Server::try_start(folder.path(), "g.ron", &["--port", "0", "--set", "m=99"]);
    let told = wrong.err().expect("a refusal");
    assert!(
        told.contains("exit status: 2") && told.contains("1 to 9"),
        "{told}"
    );
}

#[test]
fn of_many_values_the_last_one_counts() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    faces(&mut page, 6);
    for value in 1..=200 {
        page.ask(&json!({"type": "set", "name": "width", "value": 100 + value}));
    }
    page.ask(&json!({"type": "set", "name": "n", "value": 11}));
    let shown = faces(&mut page, 22);
    let width = shown["mesh"]["bounds"][1][0].as_f64().expect("a number")
        - shown["mesh"]["bounds"][0][0].as_f64().expect("a number");
    assert!((width - 3.0).abs() < 1e-12, "{width}");
}
