//! Folders that cannot be used: the run goes on without, and says so.

use std::path::Path;

use tessgraph_graph::{Engine, Outcome};

use super::{GRAPH, MEMORY, Run, files_of};

/// Checks that a run is right without the folder, and gives its warning.
fn warning(folder: &Path) -> String {
    let cold = Run::with(&Engine::without_cache(), GRAPH, false).digests();
    let run = Run::outputs(GRAPH, folder);
    assert_eq!(run.digests(), cold);
    let warning = run.stats.expect("a cache").warning;
    warning.expect("a warning")
}

#[test]
fn a_missing_folder_is_made() {
    let folder = tempfile::tempdir().expect("a folder");
    let deep = folder.path().join("a/b/c");
    let run = Run::outputs(GRAPH, &deep);
    assert_eq!(run.stats.expect("a cache").warning, None);
    assert!(deep.join("CACHEDIR.TAG").is_file());
    let warm = Run::outputs(GRAPH, &deep);
    assert_eq!(warm.nodes(Outcome::Cached).len(), 6);
}

#[test]
fn a_file_in_its_place_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("cache");
    std::fs::write(&file, "a file").expect("written");
    let warning = warning(&file);
    assert!(warning.starts_with("the cache folder "), "{warning}");
    assert!(warning.contains("cannot be used: "), "{warning}");
}

#[test]
fn a_folder_of_another_version_is_left_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    Run::outputs(GRAPH, folder.path());
    let tag = folder.path().join("CACHEDIR.TAG");
    let text = crate::support::text_of(&tag).replace("format 1", "format 999");
    std::fs::write(&tag, text).expect("written");
    let before = files_of(folder.path());
    let warning = warning(folder.path());
    assert!(
        warning.ends_with("another version of tessgraph made it"),
        "{warning}"
    );
    assert_eq!(files_of(folder.path()), before);
}

#[test]
fn a_folder_that_cannot_be_written_to_is_said_once_and_still_read() {
    let folder = tempfile::tempdir().expect("a folder");
    Run::outputs(GRAPH, folder.path());
    // A file where a folder must be stops even the user who may write anywhere.
    let values = folder.path().join("values");
    std::fs::rename(&values, folder.path().join("aside")).expect("renamed");
    std::fs::write(&values, "").expect("written");
    let warning = warning(folder.path());
    assert!(
        warning.starts_with("results are not kept for later: "),
        "{warning}"
    );
    // The entries are read all the same.
    let engine = Engine::with_disk(MEMORY, folder.path());
    let small = GRAPH.replace("\"shell.obj\": \"shell\", ", "");
    let small = small.replace(", \"deep.obj\": \"deep\"", "");
    let run = Run::with(&engine, &small, false);
    assert_eq!(run.nodes(Outcome::Computed), [""; 0]);
}

#[test]
fn a_folder_removed_in_the_middle_is_made_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let engine = Engine::with_disk(0, folder.path());
    let cold = Run::with(&engine, GRAPH, false);
    std::fs::remove_dir_all(folder.path()).expect("removed");
    let warm = Run::with(&engine, GRAPH, false);
    assert_eq!(warm.digests(), cold.digests());
    assert_eq!(warm.stats.expect("a cache").warning, None);
}

#[test]
fn failures_leave_nothing_behind() {
    let folder = tempfile::tempdir().expect("a folder");
    let engine = Engine::with_disk(MEMORY, folder.path());
    let plan = crate::support::load("edit.ron", GRAPH);
    let wanted: Vec<_> = plan.outputs.iter().map(|output| output.result).collect();
    let empty = tessgraph_graph::world::MemoryWorld::default();
    let failed = engine.evaluate(&plan, &wanted, &empty, &tessgraph_graph::Silent);
    assert!(!failed.is_ok());
    assert_eq!(files_of(folder.path()).len(), 1, "only the tag");
    let after = Run::outputs(GRAPH, folder.path());
    assert_eq!(after.nodes(Outcome::Computed).len(), 6);
}
