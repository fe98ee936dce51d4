//! Many engines and many processes on one folder at once.

use std::path::Path;
use std::process::{Command, Stdio};

use tessgraph_graph::{Engine, Outcome};

use super::{GRAPH, Run, files_of};

/// Names the folder to the processes that the test starts.
const FOLDER: &str = "TESSGRAPH_TEST_CACHE_FOLDER";

/// Digests as text, of the graph as it is and of some variants.
fn variants(folder: &Path, first: u32) -> String {
    let mut text = String::new();
    for step in 0..4 {
        let thickness = (first + step) % 4;
        let graph = GRAPH.replace("\"t\": 0.1", &format!("\"t\": 0.{}", thickness + 1));
        for (name, digest) in Run::outputs(&graph, folder).digests() {
            text += &format!("{thickness} {name} {digest}\n");
        }
    }
    let mut lines: Vec<&str> = text.lines().collect();
    lines.sort_unstable();
    lines.join("\n")
}

fn alone() -> String {
    let folder = tempfile::tempdir().expect("a folder");
    variants(folder.path(), 0)
}

/// Nothing is half written and everything is found.
fn check_folder(folder: &Path) {
    let left = files_of(folder);
    let temporary = |path: &&std::path::PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy();
        name.starts_with(".new-")
    };
    assert_eq!(left.iter().find(temporary), None);
    let warm = Run::outputs(GRAPH, folder);
    assert_eq!(warm.nodes(Outcome::Cached).len(), 6);
}

#[test]
fn eight_threads_share_a_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let expected = alone();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..8)
            .map(|first| scope.spawn(move || first))
            .map(|thread| thread.join().expect("a number"))
            .map(|first| {
                let folder = folder.path();
                scope.spawn(move || variants(folder, first))
            })
            .collect();
        for thread in threads {
            assert_eq!(thread.join().expect("no panic"), expected);
        }
    });
    check_folder(folder.path());
}

#[test]
fn eight_threads_share_an_engine() {
    let expected = Run::with(&Engine::without_cache(), GRAPH, false).digests();
    let engine = Engine::new(4096);
    std::thread::scope(|scope| {
        let run = || Run::with(&engine, GRAPH, false).digests();
        let threads: Vec<_> = (0..8).map(|_| scope.spawn(run)).collect();
        for thread in threads {
            assert_eq!(thread.join().expect("no panic"), expected);
        }
    });
}

#[test]
fn eight_processes_share_a_folder_and_one_is_killed() {
    let folder = tempfile::tempdir().expect("a folder");
    let expected = alone();
    let program = std::env::current_exe().expect("this program");
    let start = |_| {
        Command::new(&program)
            .args(["cache::sharing::one_of_several_processes", "--exact"])
            .args(["--ignored", "--nocapture"])
            .env(FOLDER, folder.path())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a process")
    };
    let mut processes: Vec<_> = (0..8).map(start).collect();
    let mut killed = processes.remove(0);
    killed.kill().expect("killed");
    killed.wait().expect("ended");
    for process in processes {
        let output = process.wait_with_output().expect("it ends");
        let text = String::from_utf8_lossy(&output.stdout);
        let found = text
            .split("<<")
            .nth(1)
            .and_then(|rest| rest.split(">>").next());
        assert_eq!(found, Some(expected.as_str()), "{text}");
    }
    let warm = Run::outputs(GRAPH, folder.path());
    assert_eq!(warm.nodes(Outcome::Cached).len(), 6);
}

#[test]
#[ignore = "started by the test above, in processes of its own"]
fn one_of_several_processes() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        let first = std::process::id() % 4;
        println!("<<{}>>", variants(Path::new(&folder), first));
    }
}
