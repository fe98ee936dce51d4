//! Files that come and go, and files that only seem to change.

use std::fs;
use std::time::Duration;

use super::{LULL, Watch, faces_in, graph, write};
use crate::support::text_of;

#[test]
fn a_graph_that_is_removed_and_restored_recovers() {
    let (_folder, watch) = Watch::on_grid(3, &[]);
    let text = text_of(&watch.path("g.ron"));
    fs::remove_file(watch.path("g.ron")).expect("removed");
    assert_eq!(watch.next()["ok"], false);
    assert_eq!(watch.faces(), 3, "the last good output stays");
    std::thread::sleep(LULL);
    write(&watch.path("g.ron"), &text);
    let again = watch.next();
    assert_eq!(again["ok"], true);
    assert!(outcomes(&again).iter().all(|outcome| outcome == "cached"));
}

fn outcomes(report: &serde_json::Value) -> Vec<String> {
    let nodes = report["nodes"].as_array().expect("nodes").iter();
    nodes
        .filter_map(|node| node["outcome"].as_str())
        .map(str::to_owned)
        .collect()
}

#[test]
fn what_is_missing_at_the_start_is_awaited() {
    let folder = tempfile::tempdir().expect("a folder");
    let project = folder.path().join("not/there/yet");
    let cache = folder.path().join("cache");
    let cache = cache.to_str().expect("UTF-8");
    let watch = Watch::start_on(folder.path(), "not/there/yet/g.ron", &["--cache", cache]);
    assert_eq!(watch.next()["ok"], false);
    fs::create_dir(folder.path().join("not")).expect("a folder");
    std::thread::sleep(Duration::from_millis(100));
    fs::create_dir_all(&project).expect("a folder");
    write(&project.join("g.ron"), "Graph(");
    assert_eq!(watch.next()["ok"], false);
    write(&project.join("g.ron"), &graph(4));
    while watch.next()["ok"] != true {}
    assert_eq!(faces_in(&project.join("size.json")), 4);
}

#[test]
fn a_folder_that_is_removed_and_made_again_is_followed() {
    let folder = tempfile::tempdir().expect("a folder");
    let project = folder.path().join("project");
    fs::create_dir(&project).expect("a folder");
    write(&project.join("g.ron"), &graph(2));
    let watch = Watch::start_on(folder.path(), "project/g.ron", &[]);
    assert_eq!(watch.next()["ok"], true);
    for round in 0..3 {
        fs::remove_dir_all(&project).expect("removed");
        while watch.next()["ok"] == true {}
        fs::create_dir(&project).expect("a folder");
        write(&project.join("g.ron"), &graph(3 + round));
        while watch.next()["ok"] != true {}
        assert_eq!(faces_in(&project.join("size.json")), 3 + round);
    }
    // Moved away with everything in it, and back.
    fs::rename(&project, folder.path().join("away")).expect("renamed");
    while watch.next()["ok"] == true {}
    fs::rename(folder.path().join("away"), &project).expect("renamed");
    while watch.next()["ok"] != true {}
}

#[test]
fn what_only_seems_to_change_starts_nothing() {
    let (folder, watch) = Watch::on_grid(3, &[]);
    let path = watch.path("g.ron");
    // The same bytes, another time, other files beside it, and reading it.
    write(&path, &text_of(&path));
    let file = fs::File::options()
        .append(true)
        .open(&path)
        .expect("a file");
    file.set_modified(std::time::UNIX_EPOCH).expect("a time");
    write(&folder.path().join("notes.txt"), "x");
    fs::create_dir(folder.path().join("sub")).expect("a folder");
    fs::rename(&path, watch.path("g.bak")).expect("renamed");
    fs::rename(watch.path("g.bak"), &path).expect("renamed");
    assert_eq!(text_of(&path), graph(3));
    assert_eq!(watch.until_quiet().len(), 0);
}

#[test]
fn outputs_start_nothing_wherever_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    // Beside the graph, in a folder of its own, and beside the mesh it reads.
    let text = r#"Graph(version: 1, params: {"n": 2}, nodes: {
        "mesh": ReadMesh(path: "meshes/strip.obj"),
        "grid": Grid(cells: ["n", 1]),
        "size": MeasureMesh(mesh: "grid"),
    }, outputs: {
        "size.json": "size", "a.obj": "mesh", "out/b.obj": "grid", "meshes/c.obj": "mesh",
        "meshes/strip2.obj": "grid",
    })"#;
    fs::create_dir(folder.path().join("meshes")).expect("a folder");
    write(&folder.path().join("meshes/strip.obj"), &super::strip(2));
    write(&folder.path().join("g.ron"), text);
    let watch = Watch::start(folder.path(), &["--timings", "trace.json"]);
    assert_eq!(watch.next()["ok"], true);
    assert_eq!(watch.until_quiet().len(), 0);
    for faces in 3..6 {
        let edited = text.replace("\"n\": 2", &format!("\"n\": {faces}"));
        write(&folder.path().join("g.ron"), &edited);
        let reports = watch.until_quiet();
        assert_eq!(reports.len(), 1);
        assert_eq!(watch.faces(), faces);
    }
    assert!(folder.path().join("trace.json").is_file());
}
