//! `--timings` and the memory of each node.

use std::path::Path;

use serde_json::Value;

use crate::support::program::{run, text, with_graphs};

/// The events of one kind in a trace.
fn events<'t>(trace: &'t Value, phase: &str) -> Vec<&'t Value> {
    let all = trace["traceEvents"].as_array().expect("events");
    all.iter().filter(|event| event["ph"] == phase).collect()
}

/// Where an event begins and ends, in microseconds.
fn span(event: &Value) -> (f64, f64) {
    let begin = event["ts"].as_f64().expect("a time");
    (begin, begin + event["dur"].as_f64().expect("a length"))
}

/// Runs a graph of six nodes, and reads the trace.
fn traced(folder: &Path) -> Value {
    let arguments = [
        "run",
        "torus.ron",
        "--timings",
        "new/trace.json",
        "--cache",
        "kept",
    ];
    let done = run(&arguments, folder);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let file = std::fs::File::open(folder.join("new/trace.json")).expect("a trace");
    serde_json::from_reader(file).expect("JSON")
}

#[test]
fn a_trace_holds_every_node_that_ran_on_its_threads_lane() {
    let folder = with_graphs();
    let trace = traced(folder.path());
    assert_eq!(trace["displayTimeUnit"], "ms");
    let slices = events(&trace, "X");
    let (nodes, phases): (Vec<&Value>, Vec<&Value>) =
        slices.into_iter().partition(|event| event["tid"] != 0);
    let names: Vec<_> = phases.iter().map(|event| event["name"].as_str()).collect();
    assert_eq!(
        names,
        [Some("check"), Some("evaluate"), Some("write outputs")]
    );
    let (begin, end) = span(phases[1]);
    assert_eq!(nodes.len(), 6);
    let lanes = events(&trace, "M");
    for node in nodes {
        let (from, to) = span(node);
        assert!(begin <= from && from <= to && to <= end + 1.0, "{node}");
        assert_eq!(node["cat"], "computed");
        let arguments = &node["args"];
        assert!(arguments["kind"].is_string(), "{node}");
        assert!(
            arguments["bytes"].is_u64() && arguments["peak_bytes"].is_u64(),
            "{node}"
        );
        let mut lanes = lanes.iter().filter(|lane| lane["tid"] == node["tid"]);
        let lane = lanes.next().expect("each lane has a name");
        let name = lane["args"]["name"].as_str();
        assert!(
            name.is_some_and(|name| name.starts_with("thread ")),
            "{lane}"
        );
    }
}

#[test]
fn what_was_found_takes_no_time_but_is_named() {
    let folder = with_graphs();
    traced(folder.path());
    let trace = traced(folder.path());
    assert_eq!(events(&trace, "X").len(), 3);
    let cached = trace["otherData"]["nodes"]["cached"].as_array();
    assert_eq!(cached.map(Vec::len), Some(6));
}

#[test]
fn a_trace_replaces_nothing_that_the_run_reads_or_writes() {
    let folder = with_graphs();
    let at = |name: &str| folder.path().join(name);
    let made = run(&["run", "facade.ron", "--no-cache"], folder.path());
    assert!(made.status.success(), "{}", text(&made.stderr));
    for name in ["facade.ron", "meshes/roof.obj", "out/facade.glb"] {
        let before = std::fs::metadata(at(name)).and_then(|found| found.modified());
        let arguments = ["run", "facade.ron", "--no-cache", "--timings", name];
        let done = run(&arguments, folder.path());
        assert_eq!(done.status.code(), Some(1), "{name}");
        let told = text(&done.stderr);
        assert!(
            told.contains("error[timings_failed]") && told.contains(name),
            "{told}"
        );
        let after = std::fs::metadata(at(name)).and_then(|found| found.modified());
        assert_eq!(before.expect("a time"), after.expect("a time"), "{name}");
    }
}

#[test]
fn a_node_takes_at_least_the_memory_of_its_result() {
    let folder = tempfile::tempdir().expect("a folder");
    // 90 000 vertices: each buffer of the result is far above what is counted.
    let graph = r#"Graph(version: 1, nodes: {
        "small": Grid(cells: [2, 2]),
        "large": Grid(cells: [299, 299]),
        "moved": Transform(mesh: "large", translate: (0, 0, 1)),
    }, outputs: {"small.obj": "small", "moved.stl": "moved"})"#;
    std::fs::write(folder.path().join("g.ron"), graph).expect("a file");
    let arguments = ["run", "g.ron", "--threads", "1", "--report", "json"];
    let done = run(&arguments, folder.path());
    assert!(done.status.success(), "{}", text(&done.stderr));
    let report: Value = serde_json::from_slice(&done.stdout).expect("JSON");
    let node = |name: &str, key: &str| {
        let nodes = report["nodes"].as_array().expect("nodes");
        let node = nodes.iter().find(|node| node["name"] == name);
        node.and_then(|node| node[key].as_u64()).expect("a number")
    };
    let positions = 90_000 * 24;
    assert_eq!(node("small", "peak_bytes"), 0);
    let large = node("large", "peak_bytes");
    assert!(
        large >= node("large", "bytes"),
        "{large} of {}",
        node("large", "bytes")
    );
    // The topology is shared with the grid: only positions are new.
    let moved = node("moved", "peak_bytes");
    assert!((positions..2 * positions).contains(&moved), "{moved}");
    assert!(moved < node("moved", "bytes"), "{moved}");
}
