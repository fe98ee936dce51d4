//! The program as a user meets it.

use std::process::Output;

use serde_json::Value;

use crate::support::program::{files, run, text, with_graphs};
use crate::support::{text_of, workspace};

#[test]
fn the_main_job_writes_the_outputs_and_says_so() {
    let folder = with_graphs();
    let done = run(&["run", "facade.ron"], folder.path());
    let told = text(&done.stdout) + &text(&done.stderr);
    assert!(done.status.success(), "{told}");
    for output in ["facade.glb", "facade.obj", "size.json", "depth.json"] {
        assert!(folder.path().join("out").join(output).is_file(), "{output}");
        assert!(told.contains(output), "{output} in {told}");
    }
    assert!(told.contains("9 nodes: 9 computed"), "{told}");
    assert!(!told.contains("warning"), "{told}");
    // A second run finds every file as it should be.
    let again = run(&["run", "facade.ron"], folder.path());
    assert!(text(&again.stderr).contains("unchanged") || text(&again.stdout).contains("unchanged"));
}

#[test]
fn every_output_has_the_same_bytes_on_one_and_two_threads() {
    let folder = with_graphs();
    for name in [
        "facade",
        "narrow_fold",
        "vault",
        "torus",
        "evaluate_normals",
        "wave",
    ] {
        for threads in ["1", "2"] {
            let graph = format!("{name}.ron");
            let out = format!("out{threads}");
            let arguments = [
                "run",
                &graph,
                "--threads",
                threads,
                "--out",
                &out,
                "--no-cache",
            ];
            let done = run(&arguments, folder.path());
            assert!(done.status.success(), "{name}: {}", text(&done.stderr));
        }
    }
    let one = files(&folder.path().join("out1"));
    assert!(one.len() >= 14, "{} files", one.len());
    assert!(one == files(&folder.path().join("out2")), "bytes differ");
}

/// "name outcome" of each node in a JSON report.
fn outcomes(done: &Output) -> Vec<String> {
    let report: Value = serde_json::from_slice(&done.stdout).expect("JSON");
    let nodes = report["nodes"].as_array().expect("nodes");
    let line = |node: &Value| format!("{} {}", node["name"], node["outcome"]).replace('"', "");
    nodes.iter().map(line).collect()
}

#[test]
fn a_second_process_computes_only_what_changed_and_says_why() {
    let folder = with_graphs();
    let again = |more: &[&str]| {
        let arguments = ["run", "torus.ron", "--cache", "kept", "--report", "json"];
        let done = run(&[&arguments, more].concat(), folder.path());
        assert!(done.status.success(), "{}", text(&done.stderr));
        done
    };
    assert!(
        outcomes(&again(&[]))
            .iter()
            .all(|line| line.ends_with(" computed"))
    );
    assert!(
        outcomes(&again(&[]))
            .iter()
            .all(|line| line.ends_with(" cached"))
    );
    let edited = again(&["--set", "depth=0.3", "--explain"]);
    let computed: Vec<_> = outcomes(&edited)
        .into_iter()
        .filter(|line| line.ends_with(" computed"))
        .collect();
    assert_eq!(
        computed,
        ["fitted computed", "lattice computed", "size computed"]
    );
    let undone = again(&["--explain", "--verify-cache", "100%"]);
    assert!(
        outcomes(&undone)
            .iter()
            .all(|line| line.ends_with(" cached"))
    );
    let told = text(&undone.stderr);
    assert!(
        told.contains("fitted.height") && told.contains(" 0.3 -> 0.25"),
        "{told}"
    );
    let stats = run(&["cache", "stats", "--cache", "kept"], folder.path());
    assert!(
        text(&stats.stdout).contains("results of 9 nodes"),
        "{}",
        text(&stats.stdout)
    );
    let verified = run(&["cache", "verify", "--cache", "kept"], folder.path());
    assert!(verified.status.success() && text(&verified.stdout).contains("all sound"));
    let emptied = run(
        &["cache", "gc", "--max-size", "1B", "--cache", "kept"],
        folder.path(),
    );
    assert!(
        text(&emptied.stdout).contains("0 B left"),
        "{}",
        text(&emptied.stdout)
    );
}

#[test]
fn the_json_report_has_its_documented_form() {
    let folder = with_graphs();
    let arguments = ["run", "torus.ron", "--report", "json", "--set", "depth=0.3"];
    let done = run(&arguments, folder.path());
    assert!(done.status.success(), "{}", text(&done.stderr));
    let report: Value = serde_json::from_slice(&done.stdout).expect("stdout is one JSON object");
    assert_eq!(report["ok"], true);
    assert!(report["ms"].is_number());
    let nodes = report["nodes"].as_array().expect("nodes");
    assert_eq!(nodes.len(), 6);
    for node in nodes {
        assert!(
            node["name"].is_string() && node["kind"].is_string(),
            "{node}"
        );
        assert_eq!(node["outcome"], "computed");
        assert!(
            node["ms"].is_number() && node["bytes"].is_number(),
            "{node}"
        );
        assert!(node["warnings"].is_array(), "{node}");
    }
    let outputs = report["outputs"].as_array().expect("outputs");
    assert_eq!(outputs.len(), 3);
    for output in outputs {
        assert!(
            output["path"].is_string() && output["bytes"].is_number(),
            "{output}"
        );
        assert_eq!(output["changed"], true);
    }
}

#[test]
fn check_gives_one_json_object_a_line_with_exact_places() {
    let folder = tempfile::tempdir().expect("a folder");
    let graph = "// façade — é\nGraph(version: 1, nodes: {\n  \"b\": Grid(),\n  /* é */ \"a\": \
                 SubdivideQuad(mesh: \"c\", levels: 99),\n}, outputs: {\"a.obj\": \"a\"})";
    std::fs::write(folder.path().join("g.ron"), graph).expect("a file");
    let done = run(
        &["check", "g.ron", "--message-format", "json"],
        folder.path(),
    );
    assert_eq!(done.status.code(), Some(1));
    let lines: Vec<Value> = text(&done.stdout)
        .lines()
        .map(|line| serde_json::from_str(line).expect("each line is JSON"))
        .collect();
    assert_eq!(lines.len(), 2, "{lines:?}");
    let unknown = &lines[0];
    assert_eq!(unknown["code"], "unknown_node");
    assert_eq!(unknown["severity"], "error");
    assert_eq!(unknown["file"], "g.ron");
    let at = graph.find("\"c\"").expect("it is there");
    let span = unknown["span"].as_array().expect("a span");
    assert_eq!(span[0].as_u64().map(|byte| byte as usize), Some(at));
    assert_eq!(unknown["line"], 4);
    let line_start = graph[..at].rfind('\n').expect("a line") + 1;
    let column = graph[line_start..at].chars().count() + 1;
    assert_eq!(unknown["column"].as_u64(), Some(column as u64));
    assert!(unknown["labels"].is_array() && unknown["message"].is_string());
    assert_eq!(lines[1]["code"], "out_of_range");
}

#[test]
fn info_measures_a_mesh_file() {
    let done = run(
        &["info", "meshes/roof.obj", "--json"],
        &workspace().join("graphs"),
    );
    let info: Value = serde_json::from_slice(&done.stdout).expect("JSON");
    for (key, value) in [
        ("vertices", 25),
        ("edges", 40),
        ("faces", 16),
        ("triangles", 32),
        ("euler", 1),
        ("components", 1),
        ("boundary_edges", 16),
        ("boundary_loops", 1),
        ("nonmanifold_edges", 0),
        ("isolated_vertices", 0),
        ("degenerate_faces", 0),
    ] {
        assert_eq!(info[key], value, "{key}");
    }
    assert_eq!(info["bounds"][0][0], -6.0);
    assert!(info["volume"].is_null() && info["intersections"].is_null());
}

#[test]
fn a_failing_node_leaves_every_other_output_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let graph = r#"Graph(version: 1, nodes: {
        "good": Grid(cells: [2, 2]),
        "bad": ReadMesh(path: "nothing.obj"),
        "worse": SubdivideQuad(mesh: "bad"),
    }, outputs: {"worse.obj": "worse", "good.obj": "good"})"#;
    std::fs::write(folder.path().join("g.ron"), graph).expect("a file");
    let done = run(&["run", "g.ron"], folder.path());
    assert_eq!(done.status.code(), Some(1));
    assert!(folder.path().join("good.obj").is_file());
    assert!(!folder.path().join("worse.obj").exists());
    let told = text(&done.stderr);
    assert!(
        told.contains("`bad`") && told.contains("nothing.obj"),
        "{told}"
    );
    assert!(!told.contains("panicked"), "{told}");
}

#[test]
fn a_new_folder_runs_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = run(&["new", "pavilion"], folder.path());
    assert!(made.status.success(), "{}", text(&made.stderr));
    let done = run(&["run", "pavilion/facade.ron"], folder.path());
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(files(&folder.path().join("pavilion/out")).len() >= 2);
    let again = run(&["new", "pavilion"], folder.path());
    assert!(
        !again.status.success(),
        "an existing folder is not overwritten"
    );
}

#[test]
fn wrong_usage_is_status_2() {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(run(&["run"], folder.path()).status.code(), Some(2));
    assert_eq!(
        run(&["fly", "facade.ron"], folder.path()).status.code(),
        Some(2)
    );
}

#[test]
fn the_readme_shows_a_graph_that_runs() {
    let readme = text_of(&workspace().join("README.md"));
    let start = readme.find("```ron\n").expect("a graph in the README") + "```ron\n".len();
    let graph = &readme[start..start + readme[start..].find("```").expect("its end")];
    let folder = with_graphs();
    std::fs::write(folder.path().join("readme.ron"), graph).expect("a file");
    let done = run(&["run", "readme.ron"], folder.path());
    assert!(done.status.success(), "{}", text(&done.stderr));
}
