//! What other devices see, and the page that needs no server.

use std::net::{IpAddr, Ipv4Addr, UdpSocket};

use serde_json::{Value, json};

use super::{GRAPH, folder_with, graph_in};
use crate::support::page::{Page, Server};

/// This machine's address in a network, if it is in one; nothing is sent.
fn network() -> Option<IpAddr> {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
    socket.connect((Ipv4Addr::new(203, 0, 113, 1), 9)).ok()?;
    let address = socket.local_addr().ok()?.ip();
    (!address.is_loopback()).then_some(address)
}

/// The devices that the owner's page is told of after it asked for something.
fn shares(owner: &mut Page, request: &Value) -> Value {
    owner.ask(request);
    owner.any("shares")
}

fn url_of(shares: &Value, index: usize) -> String {
    let url = &shares["pairings"][index]["url"];
    url.as_str().expect("an address").to_owned()
}

/// Holds that a device is refused whatever is not looking.
fn can_only_look(device: &mut Page) {
    for request in [
        json!({"type": "set", "name": "n", "value": 5}),
        json!({"type": "write", "name": "n", "value": 5}),
        json!({"type": "reset", "name": "n"}),
        json!({"type": "undo"}),
        json!({"type": "redo"}),
        json!({"type": "cancel"}),
        json!({"type": "run"}),
    ] {
        device.ask(&request);
        let told = device.any("notice");
        let text = told["text"].as_str().expect("a text");
        assert!(text.contains("can only look"), "{request}: {text}");
    }
    // Nor does it learn who else is there, or let others in.
    for request in [
        json!({"type": "shares"}),
        json!({"type": "pair"}),
        json!({"type": "unpair", "id": 1}),
    ] {
        device.ask(&request);
        assert_eq!(device.any("notice")["level"], "error", "{request}");
    }
}

#[test]
fn devices_look_and_change_nothing_until_their_address_is_taken_back() {
    let Some(address) = network() else {
        return;
    };
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0", "--lan"]);
    let mut owner = server.open();
    owner.until_up_to_date();
    let host = format!("{address}:{}", server.address.port());
    let none = shares(&mut owner, &json!({"type": "shares"}));
    assert_eq!(
        none["lan"],
        json!({"address": format!("http://{host}/"), "edit": false})
    );
    assert_eq!(none["pairings"], json!([]));
    // The owner's secret is none out there, and nobody is let in without a pairing.
    assert_eq!(Server::get_at(&host, &server.token, "").status, 401);
    let paired = shares(&mut owner, &json!({"type": "pair"}));
    let url = url_of(&paired, 0);
    let token = url
        .trim_end_matches('/')
        .rsplit('/')
        .next()
        .expect("a secret")
        .to_owned();
    assert_eq!(Server::get_at(&host, &token, "").status, 200);
    assert_eq!(server.request("GET", &format!("/{token}/"), "").status, 401);
    let mut device = Server::open_at(&url);
    assert_eq!(device.any("access")["may_edit"], false);
    assert_eq!(
        device.any("hello")["folder"],
        "",
        "where it lies is told to nobody"
    );
    assert_eq!(device.any("shown")["mesh"]["faces"], 6);
    can_only_look(&mut device);
    assert_eq!(graph_in(&folder), GRAPH);
    // It sees what the owner does, and is counted.
    owner.ask(&json!({"type": "set", "name": "n", "value": 4}));
    device.until("shown", |shown| shown["mesh"]["faces"] == 8);
    let counted = shares(&mut owner, &json!({"type": "shares"}));
    assert_eq!(counted["pairings"][0]["connected"], 1);
    let gone = shares(&mut owner, &json!({"type": "unpair", "id": 1}));
    assert_eq!(gone["pairings"], json!([]));
    while device.next().is_ok() {}
    assert_eq!(Server::get_at(&host, &token, "").status, 401);
}

#[test]
fn devices_may_change_values_where_that_was_asked_for() {
    if network().is_none() {
        return;
    }
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0", "--lan=edit"]);
    let mut owner = server.open();
    owner.until_up_to_date();
    let paired = shares(&mut owner, &json!({"type": "pair"}));
    let mut device = Server::open_at(&url_of(&paired, 0));
    assert_eq!(device.any("access")["may_edit"], true);
    device.ask(&json!({"type": "write", "name": "n", "value": 5}));
    owner.until("shown", |shown| shown["mesh"]["faces"] == 10);
    assert!(graph_in(&folder).contains("\"n\": 5,"));
    // Devices are the owner's to let in.
    device.ask(&json!({"type": "pair"}));
    assert_eq!(device.any("notice")["level"], "error");
}

#[test]
fn without_a_wish_nobody_else_is_let_in() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut owner = server.open();
    for request in [json!({"type": "shares"}), json!({"type": "pair"})] {
        let told = shares(&mut owner, &request);
        assert_eq!(told, json!({"type": "shares", "lan": null, "pairings": []}));
    }
    let refused = Server::try_start(folder.path(), "g.ron", &["--lan", "--host", "0.0.0.0"]);
    assert!(
        refused
            .err()
            .is_some_and(|told| told.contains("exit status: 2"))
    );
}

#[test]
fn the_page_that_needs_no_server_carries_every_buffer() {
    let folder = folder_with(GRAPH);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    let shown = page.any("shown");
    let version = &shown["version"];
    let answer = server.get(&format!("offline/{version}"));
    assert_eq!(answer.status, 200);
    assert!(
        answer
            .header("content-disposition")
            .starts_with("attachment")
    );
    let html = String::from_utf8(answer.body).expect("text");
    for name in ["positions", "triangles_buffer", "triangle_faces", "edges"] {
        let name = shown["mesh"][name].as_str().expect("a name");
        assert!(html.contains(&format!("\"{name}\":\"H4sI")), "{name}");
    }
    assert!(!html.contains(&server.token), "the secret stays here");
    let place = folder.path().canonicalize().expect("a folder");
    assert!(!html.contains(&*place.to_string_lossy()));
    for other in ["offline", "offline/", "offline/x", "offline/999"] {
        assert_eq!(server.get(other).status, 404, "{other}");
    }
}

#[test]
fn cuts_are_told_and_measured_on() {
    let folder = folder_with(
        &GRAPH
            .replace("Grid(size", "Cuboid(size")
            .replace("[\"width\", 100]", "[\"width\", 100, 50]")
            .replace("[\"n\", \"m\"]", "[\"n\", \"m\", 1]"),
    );
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    let plane = json!({"normal": [0, 0, 1], "at": 0.25});
    page.ask(&json!({"type": "section", "request": 4, "plane": plane}));
    let told = page.any("sectioned");
    assert_eq!(
        (&told["request"], &told["closed"], &told["open"]),
        (&json!(4), &json!(1), &json!(0))
    );
    assert_eq!(
        (&told["length"]["text"], &told["area"]["text"]),
        (&json!("400 cm"), &json!("10000 cm²"))
    );
    let count = told["count"].as_u64().expect("a count") as usize;
    assert_eq!(server.buffer(&told["segments"]).len(), 24 * count);
    assert_eq!(server.buffer(&told["panels"]).len(), 4 * count);
    let end = |x: f64| json!({"cut": {"plane": plane, "near": [x, 0.01, 0.25], "snap": 0.02}});
    page.ask(&json!({"type": "measure", "request": 5, "from": end(0.0), "to": end(1.0)}));
    assert_eq!(page.any("measured")["distance"]["text"], "100 cm");
    page.ask(&json!({"type": "render", "request": 6, "size": [200, 100], "towards": [1, -1, 1]}));
    let picture = server.buffer(&page.any("rendered")["picture"]);
    assert_eq!(&picture[1..4], b"PNG");
}
