//! The program on cache folders that fail it: a note is shown, and the outputs
//! are those of a run without a cache.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use super::files_of;
use crate::support::program::{files, program, text, with_graphs};

/// A folder with the shipped graphs, and the outputs of one without a cache.
struct Desk {
    folder: tempfile::TempDir,
    expected: Vec<(PathBuf, Vec<u8>)>,
}

const GRAPH: &str = "torus.ron";

impl Desk {
    fn new(more: &[&str]) -> Self {
        let folder = with_graphs();
        let done = Command::new(program())
            .args(["run", GRAPH, "--no-cache", "--out", "expected"])
            .args(more)
            .current_dir(folder.path())
            .output()
            .expect("the program runs");
        assert!(done.status.success(), "{}", text(&done.stderr));
        let expected = files(&folder.path().join("expected"));
        Self { folder, expected }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The program, told to keep results in `kept`.
    fn command(&self) -> Command {
        let mut command = Command::new(program());
        command.args(["run", GRAPH, "--cache", "kept", "--out", "found"]);
        command.current_dir(self.folder.path());
        command
    }

    /// A script in a name space of its own, where it may mount; `$0` is the
    /// program. Nothing where the system does not allow that.
    #[allow(clippy::print_stdout, reason = "a skipped test says so")]
    fn script(&self, script: &str) -> Option<Output> {
        std::fs::create_dir_all(self.path("kept")).expect("a folder");
        let done = Command::new("unshare")
            .args(["-rm", "sh", "-c", script])
            .arg(program())
            .current_dir(self.folder.path())
            .output();
        let done = done.ok()?;
        if text(&done.stdout).contains("mounted") {
            return Some(done);
        }
        println!(
            "skipped: nothing can be mounted here: {}",
            text(&done.stderr)
        );
        None
    }

    /// Checks that the outputs are right and that something was said.
    fn check(&self, done: &Output, note: &str) {
        let said = text(&done.stderr);
        assert!(done.status.success(), "{said}");
        assert!(said.contains(note), "{said}");
        assert!(self.is_right(), "outputs differ; {said}");
    }

    fn is_right(&self) -> bool {
        files(&self.path("found")) == self.expected
    }
}

const NOT_KEPT: &str = "note: results are not kept for later: cannot write to kept";

#[test]
fn a_full_disk() {
    let desk = Desk::new(&[]);
    let script = "mount -t tmpfs -o size=64k none kept && echo mounted && \
                  exec \"$0\" run torus.ron --cache kept --out found";
    if let Some(done) = desk.script(script) {
        desk.check(&done, NOT_KEPT);
    }
}

#[test]
fn a_folder_that_may_only_be_read() {
    let desk = Desk::new(&["--set", "depth=0.3"]);
    let script = "mount -t tmpfs -o size=64m none kept && echo mounted && \
                  \"$0\" run torus.ron --cache kept --out found 2>&1 && \
                  mount -o remount,ro kept && \
                  \"$0\" run torus.ron --cache kept --out found 2>&1 && \
                  exec \"$0\" run torus.ron --cache kept --out found --set depth=0.3";
    if let Some(done) = desk.script(script) {
        desk.check(&done, NOT_KEPT);
        let before = text(&done.stdout);
        assert!(before.contains("6 computed"), "{before}");
        // What is there is read, and nothing is said while nothing is to be written.
        assert!(
            before.contains("6 cached") && !before.contains("note"),
            "{before}"
        );
        let said = text(&done.stderr);
        assert!(said.contains("3 computed, 3 cached"), "{said}");
    }
}

#[cfg(unix)]
#[test]
fn files_that_may_not_grow() {
    let desk = Desk::new(&["--only", "out/torus.json"]);
    // Values are larger than the limit; the one small output is not.
    let done = Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\""])
        .arg(program())
        .args(["run", GRAPH, "--cache", "kept", "--out", "found"])
        .args(["--only", "out/torus.json"])
        .current_dir(desk.folder.path())
        .output()
        .expect("a shell");
    desk.check(&done, NOT_KEPT);
    // Nothing half-written stays behind, and the next run needs no help.
    for path in files_of(&desk.path("kept")) {
        let name = path.file_name().expect("a name").to_string_lossy();
        assert!(!name.starts_with(".new-"), "{name}");
    }
    let done = desk.command().args(["--only", "out/torus.json"]).output();
    let done = done.expect("the program runs");
    assert!(done.status.success() && !text(&done.stderr).contains("note"));
    assert!(desk.is_right());
}

#[test]
fn a_folder_of_another_version_or_a_file() {
    let desk = Desk::new(&[]);
    let kept = desk.path("kept");
    std::fs::create_dir(&kept).expect("a folder");
    let tag = "Signature: 8a477f597d28d172789f06886806bc55\n# tessgraph cache, format 999\n";
    std::fs::write(kept.join("CACHEDIR.TAG"), tag).expect("written");
    let done = desk.command().output().expect("the program runs");
    desk.check(
        &done,
        "note: the cache folder kept cannot be used: another version of tessgraph",
    );
    assert_eq!(files_of(&kept).len(), 1, "it is left alone");
    std::fs::remove_dir_all(&kept).expect("removed");
    std::fs::write(&kept, "mine").expect("written");
    let done = desk.command().output().expect("the program runs");
    desk.check(&done, "note: the cache folder kept cannot be used: ");
    assert_eq!(crate::support::text_of(&kept), "mine");
}

#[test]
fn eight_processes_write_one_output_and_one_is_killed() {
    let desk = Desk::new(&[]);
    let quiet = |mut command: Command| {
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command.spawn().expect("a process")
    };
    let mut processes: Vec<_> = (0..8).map(|_| quiet(desk.command())).collect();
    let mut killed = processes.swap_remove(3);
    killed.kill().expect("killed");
    killed.wait().expect("ended");
    for process in processes {
        let done = process.wait_with_output().expect("it ends");
        let said = text(&done.stderr);
        assert!(done.status.success() && !said.contains("note"), "{said}");
    }
    // The killed one may have left a temporary file, which the next run removes.
    let done = desk.command().output().expect("the program runs");
    let said = text(&done.stderr);
    assert!(done.status.success() && said.contains("6 cached"), "{said}");
    for (path, bytes) in &desk.expected {
        let found = files(&desk.path("found"));
        assert!(
            found.contains(&(path.clone(), bytes.clone())),
            "{}",
            path.display()
        );
    }
    let verified = Command::new(program())
        .args(["cache", "verify", "--cache", "kept"])
        .current_dir(desk.folder.path())
        .output()
        .expect("the program runs");
    assert!(text(&verified.stdout).contains("all sound"));
}

#[test]
fn a_cache_that_is_damaged_everywhere_is_as_none() {
    let desk = Desk::new(&[]);
    let done = desk.command().output().expect("the program runs");
    assert!(done.status.success() && desk.is_right());
    for path in files_of(&desk.path("kept")) {
        if !path.ends_with("CACHEDIR.TAG") {
            spoil(&path);
        }
    }
    let done = desk.command().output().expect("the program runs");
    desk.check(&done, "6 computed");
    let done = desk.command().output().expect("the program runs");
    desk.check(&done, "6 cached");
}

/// Flips the last byte of a file.
fn spoil(path: &Path) {
    #[allow(clippy::disallowed_methods, reason = "tests read their own files")]
    let mut bytes = std::fs::read(path).expect("a file");
    *bytes.last_mut().expect("not empty") ^= 1;
    std::fs::write(path, bytes).expect("written");
}
