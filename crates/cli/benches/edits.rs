//! What an edit costs besides the nodes it computes, by the clock.

use std::cell::Cell;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tessgraph_bench::{Bench, shapes};

/// A facade of 100 vertices on each of `size` by `size` faces, and its last node.
fn facade(height: usize) -> String {
    format!(
        r#"Graph(version: 1, units: M, nodes: {{
    "base": ReadMesh(path: "base.obj"),
    "ring": ReadMesh(path: "ring.obj"),
    "normals": VertexNormals(mesh: "base"),
    "facade": ArrayComponents(base: "base", component: "ring", directions: "normals"),
    "placed": Transform(mesh: "facade", translate: (0, 0, {height})),
    "size": MeasureMesh(mesh: "placed"),
}}, outputs: {{ "size.json": "size" }})
"#
    )
}

/// Fifty nodes in a row.
fn chain() -> String {
    let mut nodes = String::from("\"n0\": ReadMesh(path: \"base.obj\"),\n");
    for index in 1..50 {
        let before = index - 1;
        nodes +=
            &format!("\"n{index}\": Transform(mesh: \"n{before}\", translate: (0, 0, {index})),\n");
    }
    format!("Graph(version: 1, nodes: {{{nodes}}}, outputs: {{ \"chain.glb\": \"n49\" }})")
}

/// `tessgraph run --watch`, which ends with this.
struct Watch {
    child: Child,
    lines: BufReader<ChildStdout>,
}

impl Watch {
    fn start(folder: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_tessgraph"))
            .args(["run", "facade.ron", "--watch", "--report", "json"])
            .args(["--cache", "cache"])
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let lines = BufReader::new(child.stdout.take().expect("it was piped"));
        let mut watch = Self { child, lines };
        watch.nodes_time();
        watch
    }

    /// Waits for the end of a run that computed something: what its nodes took.
    fn nodes_time(&mut self) -> Duration {
        loop {
            let mut line = String::new();
            let read = self.lines.read_line(&mut line);
            assert!(
                read.expect("a line for each run") > 0,
                "it goes on watching"
            );
            let report: Value = serde_json::from_str(&line).expect("JSON");
            let nodes = report["nodes"].as_array().expect("the nodes");
            let computed = nodes.iter().filter(|node| node["outcome"] == "computed");
            let times: Vec<f64> = computed.filter_map(|node| node["ms"].as_f64()).collect();
            if !times.is_empty() {
                return Duration::from_secs_f64(times.iter().sum::<f64>() / 1e3);
            }
        }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn main() -> std::io::Result<()> {
    let bench = Bench::new("Edits while watching, and nothing to do; by the clock");
    let folder = tempfile::tempdir()?;
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("ring.obj"), shapes::obj(&shapes::ring(10)))?;
    for size in bench.sizes([25u32, 50, 100]) {
        std::fs::write(at("base.obj"), shapes::obj(&shapes::sheet(size, size)))?;
        std::fs::write(at("facade.ron"), facade(0))?;
        let mut watch = Watch::start(folder.path());
        let (mut height, nodes) = (0, Cell::new(Duration::ZERO));
        let vertices = (100 * size * size) as usize;
        bench
            .case("edit of the last node but one", vertices, "vertices")
            .clocked(|| {
                height += 1;
                let text = facade(height);
                let start = Instant::now();
                // In one step, as editors save: half a file would be a run, too.
                std::fs::write(at("new"), text).expect("a file");
                std::fs::rename(at("new"), at("facade.ron")).expect("a file");
                nodes.set(watch.nodes_time());
                start.elapsed()
            })
            .clocked_limit("the computed nodes alone", || nodes.get())
            .run();
    }
    std::fs::write(at("chain.ron"), chain())?;
    bench
        .case("50 nodes unchanged, new process", 50, "nodes")
        .program(|threads| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_tessgraph"));
            command.arg("run").arg(at("chain.ron"));
            command.args(["--threads", &threads.to_string(), "--cache"]);
            command.arg(at("cache"));
            command.stdout(Stdio::null()).stderr(Stdio::null());
            command
        })
        .run();
    Ok(())
}
