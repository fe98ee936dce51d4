//! The recomputation contract: after each edit of a facade exactly these nodes
//! are computed, exactly these outputs written, and undoing it costs nothing.

mod edits;
mod memory;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::support::program::{copy, files};
use crate::support::{text_of, workspace};
use edits::{EDITS, Edit};

/// A copy of the facade with everything computed and written.
struct Project {
    folder: tempfile::TempDir,
}

impl Project {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let from = workspace().join("tests/recomputation");
        for name in ["whole", "before"] {
            std::fs::create_dir(folder.path().join(name)).expect("a folder");
        }
        let project = Self { folder };
        let whole = project.path("");
        copy(&from.join("meshes"), &made(&whole.join("meshes")));
        std::fs::copy(from.join("facade.ron"), whole.join("facade.ron")).expect("copied");
        project
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("whole").join(name)
    }

    fn text(&self, name: &str) -> String {
        text_of(&self.path(name))
    }

    fn write(&self, name: &str, content: &str) {
        std::fs::write(self.path(name), content).expect("written");
    }

    /// Puts by everything there is, to be put back by [`Project::restore`].
    fn remember(&self) {
        replace(&self.path(""), &self.folder.path().join("before"));
    }

    fn restore(&self) {
        replace(&self.folder.path().join("before"), &self.path(""));
    }

    /// Takes back what was edited, and leaves the cache and the outputs.
    fn undo(&self) {
        let before = self.folder.path().join("before");
        std::fs::copy(before.join("facade.ron"), self.path("facade.ron")).expect("copied");
        std::fs::remove_dir_all(self.path("meshes")).expect("removed");
        copy(&before.join("meshes"), &made(&self.path("meshes")));
    }

    /// The report of a run with further arguments.
    fn run(&self, more: &[&str]) -> Value {
        let [graph, cache] = ["facade.ron", "cache"].map(|name| {
            let path = self.path(name);
            path.to_string_lossy().into_owned()
        });
        let args = [
            "tessgraph",
            "run",
            &graph,
            "--cache",
            &cache,
            "--report",
            "json",
        ];
        let (mut out, mut err) = (Vec::new(), Vec::new());
        tessgraph::run([&args[..], more].concat(), &mut out, &mut err);
        let said = String::from_utf8_lossy(&err);
        serde_json::from_slice(&out).unwrap_or_else(|_| panic!("{said}"))
    }

    /// The outputs of a run without any cache.
    fn cold(&self, more: &[&str]) -> Vec<(PathBuf, Vec<u8>)> {
        let [graph, out] = ["facade.ron", "../cold"].map(|name| {
            let path = self.path(name);
            path.to_string_lossy().into_owned()
        });
        let folder = self.folder.path().join("cold");
        let _ = std::fs::remove_dir_all(&folder);
        let args = ["tessgraph", "run", &graph, "--no-cache", "--out", &out];
        tessgraph::run([&args[..], more].concat(), &mut Vec::new(), &mut Vec::new());
        if folder.exists() {
            files(&folder)
        } else {
            Vec::new()
        }
    }

    /// Whether every one of these files is below the graph's folder.
    fn has(&self, wanted: &[(PathBuf, Vec<u8>)]) {
        let found = files(&self.path(""));
        for (path, bytes) in wanted {
            let same = found
                .iter()
                .any(|(name, other)| name == path && other == bytes);
            assert!(same, "{} is not what a cold run gives", path.display());
        }
    }
}

fn made(folder: &Path) -> PathBuf {
    std::fs::create_dir_all(folder).expect("a folder");
    folder.to_owned()
}

fn replace(from: &Path, to: &Path) {
    std::fs::remove_dir_all(to).expect("removed");
    std::fs::create_dir(to).expect("a folder");
    copy_all(from, to);
}

/// [`copy`], with what was made too.
fn copy_all(from: &Path, to: &Path) {
    copy(from, to);
    let out = from.join("out");
    if out.exists() {
        copy(&out, &made(&to.join("out")));
    }
}

fn items<'a>(report: &'a Value, name: &str) -> &'a [Value] {
    report[name].as_array().expect("a list")
}

/// Names of the nodes with that outcome, in the order of the alphabet.
fn nodes<'a>(report: &'a Value, outcome: &str) -> Vec<&'a str> {
    let nodes = items(report, "nodes").iter();
    let nodes = nodes.filter(|node| node["outcome"] == outcome);
    let mut names: Vec<&str> = nodes.filter_map(|node| node["name"].as_str()).collect();
    names.sort_unstable();
    names
}

fn written(report: &Value) -> Vec<&str> {
    let outputs = items(report, "outputs").iter();
    let written = outputs.filter(|output| output["changed"] == true);
    written
        .filter_map(|output| output["path"].as_str())
        .collect()
}

/// What a person reads in the snapshot.
fn told(edit: &Edit, report: &Value) -> String {
    let mut text = format!("== {}\n", edit.name);
    for outcome in [
        "computed", "cut_off", "cached", "failed", "blocked", "skipped",
    ] {
        let names = nodes(report, outcome);
        if !names.is_empty() || outcome == "computed" {
            let _ = writeln!(text, "{outcome}: {}", listed(&names));
        }
    }
    let _ = writeln!(text, "written: {}", listed(&written(report)));
    text
}

fn listed(names: &[&str]) -> String {
    if names.is_empty() {
        return "nothing".to_owned();
    }
    names.join(", ")
}

#[test]
fn each_edit_computes_exactly_what_it_reaches() {
    let project = Project::new();
    let first = project.run(&[]);
    assert_eq!(nodes(&first, "computed").len(), 11, "{first}");
    assert_eq!(nodes(&first, "skipped"), ["spare"]);
    project.remember();
    let base = project.cold(&[]);
    assert_eq!(base.len(), 6, "five outputs and the materials of one");
    let mut log = String::new();
    for edit in EDITS {
        (edit.make)(&project);
        let report = project.run(edit.arguments);
        log += &told(edit, &report);
        log.push('\n');
        if edit.costs_nothing {
            let none: [&str; 0] = [];
            assert_eq!(nodes(&report, "computed"), none, "{}", edit.name);
        }
        project.has(&project.cold(edit.arguments));
        project.undo();
        let undone = project.run(&[]);
        let cached = nodes(&undone, "cached");
        assert_eq!(
            cached.len(),
            11,
            "{} cannot be undone for nothing",
            edit.name
        );
        project.has(&base);
        project.restore();
    }
    insta::with_settings!({omit_expression => true}, {
        insta::assert_snapshot!("contract", log);
    });
}
