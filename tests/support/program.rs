//! The program as a process of its own, and folders for it to work in.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use escargot::format::Message;

use super::{bytes_of, workspace};

/// The program, built once.
pub(crate) fn program() -> &'static Path {
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    PATH.get_or_init(|| {
        // With the tests of the workspace, as they were just built: alone, the
        // program would need its dependencies once more with fewer features.
        let build = escargot::CargoBuild::new()
            .manifest_path(workspace().join("Cargo.toml"))
            .bin("tessgraph")
            .arg("--workspace")
            .arg("--tests");
        let messages = build.exec().expect("the program builds");
        let programs = messages.filter_map(|message| {
            let message = message.expect("the program builds");
            let Ok(Message::CompilerArtifact(artifact)) = message.decode() else {
                return None;
            };
            let is_program = artifact.target.name == "tessgraph" && !artifact.profile.test;
            artifact.executable.filter(|_| is_program).map(Into::into)
        });
        programs.last().expect("the program builds")
    })
}

/// Runs the program with a cache of its own: never the user's, and empty.
pub(crate) fn run(arguments: &[&str], folder: &Path) -> Output {
    let cache = tempfile::tempdir().expect("a folder");
    Command::new(program())
        .args(arguments)
        .current_dir(folder)
        .env("TESSGRAPH_CACHE", cache.path())
        .output()
        .expect("the program runs")
}

/// What a process printed.
pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("output is UTF-8")
}

/// A folder of its own with the shipped graphs.
pub(crate) fn with_graphs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    copy(&workspace().join("graphs"), folder.path());
    folder
}

/// Copies a folder, without what was made in it.
pub(crate) fn copy(from: &Path, to: &Path) {
    for entry in std::fs::read_dir(from).expect("a folder") {
        let entry = entry.expect("an entry");
        let target = to.join(entry.file_name());
        if entry.file_name() == "out" {
            continue;
        }
        if entry.path().is_dir() {
            std::fs::create_dir(&target).expect("a folder");
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).expect("a file");
        }
    }
}

/// All files under a folder with their bytes, by relative path.
pub(crate) fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let bytes = bytes_of(&path);
                found.push((path.strip_prefix(folder).expect("below").to_owned(), bytes));
            }
        }
    }
    found.sort();
    found
}
