//! `run --watch`: whatever happens to the files, the outputs come to agree
//! with them, and nothing ends the watching.

mod dependencies;
mod disturbances;
mod editors;
mod ending;
mod memory;
mod polling;
mod stopping;

use std::io::{BufRead as _, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::support::program::program;

/// Far more than anything takes, on the busiest machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Long enough that a run that is going to take place would have.
const LULL: Duration = Duration::from_millis(1500);

/// A graph whose report says how many `faces` its grid has.
fn graph(faces: usize) -> String {
    format!(
        "Graph(version: 1, params: {{\"n\": {faces}}}, nodes: {{\n    \
         \"grid\": Grid(cells: [\"n\", 1]),\n    \"size\": MeasureMesh(mesh: \"grid\"),\n}},\n\
         outputs: {{\"size.json\": \"size\"}})\n"
    )
}

/// A strip of quads as an OBJ file.
fn strip(faces: usize) -> String {
    let mut text = String::new();
    for column in 0..=faces {
        text += &format!("v {column} 0 0\nv {column} 1 0\n");
    }
    for face in 0..faces {
        let [a, b] = [2 * face + 1, 2 * face + 2];
        text += &format!("f {a} {} {} {b}\n", a + 2, b + 2);
    }
    text
}

/// A process that watches a graph, with its reports and a folder of its own.
struct Watch {
    child: Child,
    reports: Receiver<Value>,
    told: Receiver<String>,
    folder: PathBuf,
    _cache: tempfile::TempDir,
}

impl Watch {
    /// Watches `g.ron` in the folder.
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        Self::start_on(folder, "g.ron", arguments)
    }

    /// Watches a graph that is named from the folder.
    fn start_on(folder: &Path, graph: &str, arguments: &[&str]) -> Self {
        Self::spawn(
            folder,
            &[&["run", graph, "--watch", "--report", "json"], arguments].concat(),
        )
    }

    /// Watches `g.ron` in the folder, and tells it to people.
    fn start_for_people(folder: &Path, arguments: &[&str]) -> Self {
        Self::spawn(folder, &[&["run", "g.ron", "--watch"], arguments].concat())
    }

    fn spawn(folder: &Path, arguments: &[&str]) -> Self {
        let cache = tempfile::tempdir().expect("a folder");
        let mut child = Command::new(program())
            .args(arguments)
            .current_dir(folder)
            .env("TESSGRAPH_CACHE", cache.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let report = |line: String| serde_json::from_str(&line).expect("a report on each line");
        Self {
            reports: lines(child.stdout.take().expect("a pipe"), report),
            told: lines(child.stderr.take().expect("a pipe"), |line| line),
            child,
            folder: folder.to_owned(),
            _cache: cache,
        }
    }

    /// Watches the graph with so many faces in a new folder, after its first run.
    fn on_grid(faces: usize, arguments: &[&str]) -> (tempfile::TempDir, Self) {
        let folder = tempfile::tempdir().expect("a folder");
        write(&folder.path().join("g.ron"), &graph(faces));
        let watch = Self::start(folder.path(), arguments);
        assert_eq!(watch.next()["ok"], true);
        assert_eq!(watch.faces(), faces);
        (folder, watch)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The report of the next run.
    fn next(&self) -> Value {
        match self.reports.recv_timeout(PATIENCE) {
            Ok(report) => report,
            Err(error) => panic!("{error}; it said: {}", self.said()),
        }
    }

    /// The reports until nothing more happens for a while.
    fn until_quiet(&self) -> Vec<Value> {
        let mut reports = Vec::new();
        loop {
            match self.reports.recv_timeout(LULL) {
                Ok(report) => reports.push(report),
                Err(RecvTimeoutError::Timeout) => return reports,
                Err(error) => panic!("{error}; it said: {}", self.said()),
            }
        }
    }

    /// Waits until a run gives this many faces; wrong ones may come before.
    fn until_faces(&self, faces: usize) {
        self.until_faces_after("an edit", faces);
    }

    /// The same, and if it does not happen it says after what.
    fn until_faces_after(&self, what: &str, faces: usize) {
        let deadline = Instant::now() + PATIENCE;
        while Instant::now() < deadline {
            if self.next()["ok"] == true && self.faces() == faces {
                return;
            }
        }
        panic!("{what}: {faces} faces never came; it said: {}", self.said());
    }

    /// What the output says.
    fn faces(&self) -> usize {
        faces_in(&self.path("size.json"))
    }

    /// Everything on stderr up to now.
    fn said(&self) -> String {
        self.told.try_iter().map(|line| line + "\n").collect()
    }

    /// The next line for people that has `part` in it.
    fn line_with(&self, part: &str) -> String {
        loop {
            let line = self.told.recv_timeout(PATIENCE);
            let line = line.unwrap_or_else(|error| panic!("{error}: `{part}` never came"));
            if line.contains(part) {
                return line;
            }
        }
    }

    /// Sends a signal as Ctrl-C does, and waits for the end.
    #[cfg(unix)]
    fn interrupt(&mut self) -> ExitStatus {
        let id = self.child.id().to_string();
        let sent = Command::new("kill").args(["-INT", &id]).status();
        assert!(sent.expect("kill runs").success());
        self.child.wait().expect("it ends")
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The lines of a stream, as they come.
fn lines<T: Send + 'static>(
    stream: impl Read + Send + 'static,
    read: impl Fn(String) -> T + Send + 'static,
) -> Receiver<T> {
    let (post, lines) = mpsc::channel();
    std::thread::spawn(move || {
        for line in BufReader::new(stream).lines().map_while(Result::ok) {
            if post.send(read(line)).is_err() {
                return;
            }
        }
    });
    lines
}

fn faces_in(path: &Path) -> usize {
    let report: Value = serde_json::from_str(&crate::support::text_of(path)).expect("JSON");
    report["faces"].as_u64().expect("a number of faces") as usize
}

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}
