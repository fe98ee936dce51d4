//! Following files: what is broken, missing, or started again.

use std::path::Path;
use std::time::Duration;

use serde_json::{Value, json};

use super::{GRAPH, folder_with, write};
use crate::support::page::{Page, Server};

fn status(page: &mut Page, state: &str) -> Value {
    page.until("status", |status| status["state"] == state)
}

#[test]
fn a_broken_file_keeps_the_last_picture_and_a_mended_one_goes_on() {
    let folder = folder_with(GRAPH);
    let path = folder.path().join("g.ron");
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    write(
        &path,
        &GRAPH.replace(
            "CheckPlanarity(mesh: \"grid\")",
            "CheckPlanarity(mesh: \"gird\")",
        ),
    );
    let stale = status(&mut page, "stale");
    assert_eq!((&stale["line"], &stale["errors"]), (&json!(12), &json!(1)));
    let diagnostics = page.until("diagnostics", |told| told["items"][0].is_object());
    let item = &diagnostics["items"][0];
    assert_eq!(
        (&item["line"], &item["severity"]),
        (&json!(12), &json!("error"))
    );
    let rendered = item["rendered"].as_str().expect("a text");
    assert!(
        rendered.contains("g.ron:12") && rendered.contains("grid"),
        "{rendered}"
    );
    // A page that comes now sees the picture and what is wrong.
    let mut late = server.open();
    assert!(late.any("diagnostics")["items"][0].is_object());
    assert_eq!(late.any("shown")["mesh"]["faces"], 6);
    // Not even RON.
    write(&path, "Graph(version: 1, nodes: {");
    page.until("document", |document| {
        document["source"] == "Graph(version: 1, nodes: {"
    });
    status(&mut page, "stale");
    write(&path, &GRAPH.replace("\"n\": 3", "\"n\": 4"));
    page.until_up_to_date();
    page.until("shown", |shown| shown["mesh"]["faces"] == 8);
}

#[test]
fn a_missing_mesh_is_awaited() {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let text = "Graph(version: 1, nodes: {\"roof\": ReadMesh(path: \"meshes/roof.obj\")}, \
                outputs: {\"a.obj\": \"roof\"})";
    let folder = folder_with(text);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    assert_eq!(
        status(&mut page, "waiting")["waiting_for"],
        "meshes/roof.obj"
    );
    std::fs::create_dir(folder.path().join("meshes")).expect("a folder");
    write(&folder.path().join("meshes/roof.obj"), mesh);
    assert_eq!(page.until_up_to_date()["cause"], "meshes/roof.obj");
    let shown = page.until("shown", |shown| shown["mesh"]["faces"] == 1);
    assert_eq!(shown["node"], "roof");
}

#[test]
fn a_node_that_fails_harms_only_what_needs_it() {
    let folder = folder_with(&GRAPH.replace("n < 100", "n > 100"));
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    status(&mut page, "stale");
    let checks = page.any("checks");
    let items = checks["items"].as_array().expect("checks");
    let rule = items.iter().find(|check| check["node"] == "few");
    let rule = rule.expect("the rule");
    assert_eq!(
        (&rule["ok"], &rule["sentence"]),
        (&json!(false), &json!("too many columns"))
    );
    let measured = items.iter().find(|check| check["node"] == "flat");
    assert!(measured.is_some_and(|check| check["ok"].is_null()));
    // With a limit the same measurement is a check.
    let strict = GRAPH.replace(
        "Planarity(mesh: \"grid\"",
        "Planarity(mesh: \"grid\", limit: 1",
    );
    write(&folder.path().join("g.ron"), &strict);
    page.until("checks", |checks| {
        let mut items = checks["items"].as_array().into_iter().flatten();
        items.any(|check| check["node"] == "flat" && check["ok"] == true)
    });
}

#[test]
fn a_run_can_be_cancelled_and_begun_again() {
    let text = GRAPH.replace(
        "\"flat\":",
        "\"dirs\": SmoothNormals(mesh: \"grid\", iterations: 100000), \"flat\":",
    );
    let text = text.replace("\"few.json\"", "\"dirs.json\": \"far\", \"few.json\"");
    let text = text.replace(
        "\"few\":",
        "\"moved\": OffsetMesh(mesh: \"grid\", directions: \"dirs\", outward: 1.0), \"far\": \
         MeasureMesh(mesh: \"moved\"), \"few\":",
    );
    let text = text
        .replace("\"n\": 3", "\"n\": 1000")
        .replace("n < 100", "n > 100");
    let folder = folder_with(&text);
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until("status", |status| status["node"] == "dirs");
    page.ask(&json!({"type": "cancel"}));
    status(&mut page, "cancelled");
    page.ask(&json!({"type": "set", "name": "n", "value": 2000}));
    page.until("status", |status| status["node"] == "dirs");
    // A newer value stops the run that is out of date.
    page.ask(&json!({"type": "set", "name": "n", "value": 101}));
    page.ask(&json!({"type": "cancel"}));
    status(&mut page, "cancelled");
}

#[test]
fn a_server_that_is_killed_comes_back_at_the_same_address() {
    let folder = folder_with(GRAPH);
    let mut server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    let first = page.any("hello");
    page.until_up_to_date();
    let (address, token) = (server.address, server.token.clone());
    server.child.kill().expect("killed");
    server.child.wait().expect("ended");
    assert!(
        std::iter::from_fn(|| page.next().ok()).count() < 100,
        "it hangs up"
    );
    let port = address.port().to_string();
    let again = Server::start(folder.path(), "g.ron", &["--port", &port]);
    assert_eq!((again.address, &again.token), (address, &token));
    let mut page = again.open();
    let second = page.any("hello");
    assert_ne!(first["session"], second["session"]);
    assert_eq!(page.any("shown")["mesh"]["faces"], 6);
}

/// Opens a page as soon as there is a server again. While a program begins anew its
/// old socket may still take connections, and drop them.
#[cfg(unix)]
fn reopened(server: &Server) -> Page {
    let deadline = std::time::Instant::now() + Duration::from_secs(60);
    loop {
        if let Some(page) = server.try_open() {
            return page;
        }
        assert!(std::time::Instant::now() < deadline, "no server any more");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
#[cfg(unix)]
fn too_large_a_result_ends_only_its_run() {
    // Looking for crossings does not ask for memory before it takes it.
    let text = r#"Graph(
    version: 1,
    params: {"n": Integer(default: 2, min: 1, max: 1000000)},
    nodes: {
        "grid": Grid(cells: ["n", 1]),
        "crossings": CheckIntersections(mesh: "grid"),
    },
    outputs: {"grid.obj": "grid", "crossings.json": "crossings"},
)
"#;
    let folder = folder_with(text);
    let limit = ["--port", "0", "--max-memory", "80MB"];
    let server = Server::start(folder.path(), "g.ron", &limit);
    let mut page = server.open();
    page.until_up_to_date();
    let hang_up = |mut page: Page| while page.next().is_ok() {};
    // A value that is tried out is forgotten, and what the file says shown again.
    page.ask(&json!({"type": "set", "name": "n", "value": 450_000}));
    hang_up(page);
    let mut page = reopened(&server);
    let notice = page.any("notice");
    let told = notice["text"].as_str().expect("a text");
    assert!(told.contains("memory"), "{told}");
    let mut page = server.open();
    page.until("shown", |shown| shown["mesh"]["faces"] == 2);
    // What stands in the file is not tried again before it is another.
    write(
        &folder.path().join("g.ron"),
        &text.replace("default: 2", "default: 450000"),
    );
    hang_up(page);
    let mut page = reopened(&server);
    let document = page.any("document");
    assert_eq!(document["nodes"][0]["name"], "grid");
    status(&mut page, "stale");
    let told = page.any("diagnostics");
    assert_eq!(told["items"][0]["code"], "out_of_memory");
    let help = told["items"][0]["help"].as_str().expect("a way out");
    assert!(help.contains("--max-memory"), "{help}");
    write(
        &folder.path().join("g.ron"),
        &text.replace("default: 2", "default: 3"),
    );
    page.until_up_to_date();
    assert_eq!(page.any("shown")["mesh"]["faces"], 3);
}

#[test]
#[cfg(unix)]
fn ctrl_c_ends_it_with_the_status_of_an_interruption() {
    let folder = folder_with(GRAPH);
    let mut server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until_up_to_date();
    let process = server.child.id().to_string();
    let sent = std::process::Command::new("kill")
        .args(["-INT", &process])
        .status();
    assert!(sent.expect("kill runs").success());
    assert_eq!(server.child.wait().expect("it ends").code(), Some(130));
}

/// Kilobytes of a process that are in memory.
fn resident(process: u32) -> u64 {
    let status = Path::new("/proc").join(process.to_string()).join("status");
    let text = crate::support::text_of(&status);
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let number = line.and_then(|line| line.split_whitespace().next());
    number
        .and_then(|number| number.parse().ok())
        .expect("a number")
}

#[test]
#[cfg(target_os = "linux")]
fn memory_stays_flat_over_two_hundred_updates() {
    let text = GRAPH
        .replace("\"n\": 3", "\"n\": 300")
        .replace("default: 2,", "default: 9,")
        .replace("n < 100", "n > 100");
    let folder = folder_with(&text);
    let limit = ["--port", "0", "--max-memory", "60MB"];
    let server = Server::start(folder.path(), "g.ron", &limit);
    let mut page = server.open();
    page.until_up_to_date();
    let mut after = Vec::new();
    for update in 1..=200 {
        let width = 100.0 + f64::from(update);
        page.ask(&json!({"type": "set", "name": "width", "value": width}));
        let expected = width / 200.0;
        let shown = page.until("shown", |shown| {
            let far = shown["mesh"]["bounds"][1][0].as_f64();
            far.is_some_and(|far| {
                (far - expected).abs() < 1e-9 || (far - 2.0 * expected).abs() < 1e-9
            })
        });
        server.buffer(&shown["mesh"]["positions"]);
        after.push(resident(server.child.id()));
        std::thread::sleep(Duration::from_millis(1));
    }
    let (middle, end) = (after[99], after[199]);
    println!(
        "{} kB after one update, {middle} kB after 100, {end} kB after 200",
        after[0]
    );
    assert!(end < middle + middle / 8, "{middle} kB, then {end} kB");
}
