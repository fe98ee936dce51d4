//! Faults 76 to 85 and 100: files and streams that fail.
#![cfg(unix)]

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use super::desk::{Desk, Done, graph};

const TWO: &str = "Graph(version: 1, params: {\"n\": 2}, nodes: {\"out\": Grid(cells: (\"n\", 2))},
    outputs: {\"out/a.obj\": \"out\", \"out/b.glb\": \"out\"})";

/// The library that makes calls fail, or `None`, aloud, where nothing compiles it.
#[allow(clippy::print_stdout, reason = "a test that is skipped says so")]
fn shim() -> Option<&'static Path> {
    static BUILT: OnceLock<Option<(tempfile::TempDir, PathBuf)>> = OnceLock::new();
    let built = BUILT.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let library = folder.path().join("shim.so");
        let source = crate::support::workspace().join("tests/faults/shim.c");
        let mut compiler = Command::new("cc");
        compiler
            .args(["-shared", "-fPIC", "-O1", "-o"])
            .arg(&library)
            .arg(source)
            .arg("-ldl");
        let made = compiler.status().is_ok_and(|status| status.success());
        if !made {
            println!("skipped: no C compiler `cc` to build the library that makes writes fail");
        }
        made.then_some((folder, library))
    });
    built.as_ref().map(|(_, library)| library.as_path())
}

/// Runs the graph with the n-th change of a file failing in this way; also says
/// how many changes there were.
fn failing(desk: &Desk, shim: &Path, arguments: &[&str], at: usize, errno: i32) -> (Done, usize) {
    let log = tempfile::NamedTempFile::new().expect("a file");
    let mut command = desk.command(arguments);
    let below = desk.path("").canonicalize().expect("a folder");
    command
        .env("LD_PRELOAD", shim)
        .env("FAULT_BELOW", below)
        .env("FAULT_LOG", log.path())
        .env("FAULT_AT", at.to_string())
        .env("FAULT_ERRNO", errno.to_string());
    let done = desk.wait(command);
    (done, crate::support::text_of(log.path()).lines().count())
}

/// The outputs are the old ones or the new ones, each whole, and nothing else
/// is left.
#[track_caller]
fn whole(desk: &Desk, old: &Desk, new: &Desk) {
    let known = ["g.ron", "out", "out/a.obj", "out/b.glb"];
    for name in desk.names() {
        assert!(known.contains(&name.as_str()), "left: {name}");
    }
    for name in ["out/a.obj", "out/b.glb"] {
        let there = desk.path(name).is_file();
        assert!(there || !old.path(name).exists(), "{name} is gone");
        if there {
            let content = desk.content(name);
            let is_old = old.path(name).is_file() && content == old.content(name);
            assert!(is_old || content == new.content(name), "{name} is torn");
        }
    }
}

/// Every change fails in turn until the run succeeds.
fn every_write_fails(errno: i32, first: bool) {
    let Some(shim) = shim() else { return };
    let (old, new) = (Desk::with(TWO), Desk::with(TWO));
    if !first {
        old.go().made();
    }
    new.run(&["run", "g.ron", "--set", "n=3"]).made();
    for at in 1.. {
        let desk = Desk::with(TWO);
        if !first {
            desk.go().made();
        }
        let arguments = ["run", "g.ron", "--set", "n=3"];
        let (done, changes) = failing(&desk, shim, &arguments, at, errno);
        done.sound();
        whole(&desk, &old, &new);
        if changes < at {
            assert!(changes > 6, "only {changes} changes were seen");
            done.made();
            break;
        }
        assert!(at < 100, "changes without end");
        // A folder that cannot be flushed may be no fault: some never can.
        if done.status != Some(0) {
            done.refused(&["out/"]);
        }
        // No clean-up by hand: the next run finds everything as it needs it.
        desk.run(&["run", "g.ron", "--set", "n=3"]).made();
        whole(&desk, &new, &new);
    }
}

#[test]
fn f076_a_disk_that_is_full_at_the_nth_write() {
    const ENOSPC: i32 = 28;
    every_write_fails(ENOSPC, true);
    every_write_fails(ENOSPC, false);
}

#[test]
fn f077_quota_and_errors_of_the_device() {
    const EIO: i32 = 5;
    const EDQUOT: i32 = 122;
    every_write_fails(EIO, false);
    every_write_fails(EDQUOT, false);
}

#[test]
fn f078_no_permission() {
    const EACCES: i32 = 13;
    const EROFS: i32 = 30;
    every_write_fails(EACCES, false);
    every_write_fails(EROFS, true);
    let desk = Desk::nodes("\"out\": ReadMesh(path: \"a.obj\")");
    let mesh = desk.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let mode = |bits| std::os::unix::fs::PermissionsExt::from_mode(bits);
    std::fs::set_permissions(mesh, mode(0o000)).expect("permissions");
    if std::fs::File::open(desk.path("a.obj")).is_ok() {
        println!("skipped: this user may read everything, so nothing can be kept from it");
    } else {
        desk.go().refused(&["a.obj", "permission denied"]);
    }
}

#[test]
fn f079_outputs_that_are_not_plain_files() {
    let desk = Desk::nodes("\"out\": Grid()");
    let out = desk.path("out");
    std::fs::create_dir_all(desk.path("out/o.obj")).expect("a folder");
    desk.go().refused(&["out/o.obj", "folder"]);
    std::fs::remove_dir(desk.path("out/o.obj")).expect("a folder");

    let pipe = Command::new("mkfifo").arg(out.join("o.obj")).status();
    assert!(pipe.expect("mkfifo").success());
    desk.go().refused(&["out/o.obj"]);
    std::fs::remove_file(out.join("o.obj")).expect("a pipe");

    symlink(out.join("o.obj"), out.join("o.obj")).expect("a link to itself");
    desk.go().refused(&["out/o.obj"]);
    std::fs::remove_file(out.join("o.obj")).expect("a link");

    // A link inside the folder is written through, and stays a link.
    desk.write("real.obj", "old");
    symlink(desk.path("real.obj"), out.join("o.obj")).expect("a link");
    desk.go().made();
    assert!(out.join("o.obj").is_symlink());
    assert_ne!(desk.content("real.obj"), b"old");

    // The other name of a hard link keeps the old content.
    std::fs::remove_file(out.join("o.obj")).expect("a link");
    desk.write("out/o.obj", "old");
    std::fs::hard_link(out.join("o.obj"), desk.path("other.obj")).expect("a link");
    desk.go().made();
    assert_eq!(desk.content("other.obj"), b"old");
    assert_ne!(desk.content("out/o.obj"), b"old");
}

#[test]
fn f080_an_input_that_goes_or_comes_while_it_is_read() {
    let desk = Desk::nodes("\"out\": ReadMesh(path: \"a.obj\")");
    let square = |size: u32| {
        let line = |k: u32| format!("v {} {} {size}\n", k % 2 * size, k / 2 * size);
        let places: String = (0..20_000).map(|k| line(k % 4)).collect();
        format!("{places}f 1 2 4 3\n")
    };
    let stop = std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            for size in (1..9).cycle() {
                if stop.load(std::sync::atomic::Ordering::Relaxed) {
                    break;
                }
                let _ = std::fs::remove_file(desk.path("a.obj"));
                desk.write("new", square(size));
                std::fs::rename(desk.path("new"), desk.path("a.obj")).expect("a file");
            }
        });
        for _ in 0..10 {
            let done = desk.go();
            done.sound();
            if done.status == Some(0) {
                let text = String::from_utf8(desk.content("out/o.obj")).expect("a text");
                let height = |line: &str| line.rsplit(' ').next().map(str::to_owned);
                let mut heights = text
                    .lines()
                    .filter(|line| line.starts_with("v "))
                    .map(height);
                let first = heights.next();
                assert!(heights.all(|other| Some(other) == first), "a mixture");
            }
        }
        stop.store(true, std::sync::atomic::Ordering::Relaxed);
    });
}

#[test]
fn f081_inputs_that_are_not_plain_files() {
    let desk = Desk::nodes("\"out\": ReadMesh(path: \"a.obj\")");
    let pipe = Command::new("mkfifo").arg(desk.path("a.obj")).status();
    assert!(pipe.expect("mkfifo").success());
    desk.go().refused(&["a.obj", "not a plain file"]);
    desk.run(&["info", "a.obj"]).refused(&["not a plain file"]);
    desk.run(&["run", "a.obj"]).refused(&["not a plain file"]);
    desk.run(&["run", "/dev/stdin"]).refused(&["/dev/stdin"]);
    std::fs::remove_file(desk.path("a.obj")).expect("a pipe");
    std::fs::create_dir(desk.path("a.obj")).expect("a folder");
    desk.go().refused(&["a.obj", "it is a folder"]);
    std::fs::remove_dir(desk.path("a.obj")).expect("a folder");
    let sparse = std::fs::File::create(desk.path("a.obj")).expect("a file");
    sparse.set_len(4 << 30).expect("a sparse file");
    desk.run(&["run", "g.ron", "--max-memory", "1GB"])
        .refused(&["a.obj", "it has 4294.97 MB", "at most 500 MB"]);
}

#[test]
fn f082_names_of_files() {
    let long = format!("{}.obj", "n".repeat(251));
    for name in [
        "a b.obj",
        "caf\u{e9}.obj",
        "cafe\u{301}.obj",
        "-a.obj",
        "a'\"b.obj",
        &long,
    ] {
        let quoted = name.replace('"', "\\\"");
        let desk = Desk::with(format!(
            "Graph(version: 1, nodes: {{\"out\": Grid()}}, outputs: {{\"out/{quoted}\": \"out\"}})"
        ));
        desk.go().made();
        assert_eq!(desk.names(), ["g.ron", "out", &format!("out/{name}")]);
        desk.run(&["info", "--", &format!("out/{name}")]).made();
    }
    for name in [
        "a\\nb.obj",
        "a\\u{0}b.obj",
        &format!("{}.obj", "n".repeat(300)),
    ] {
        let desk = Desk::with(format!(
            "Graph(version: 1, nodes: {{\"out\": Grid()}}, outputs: {{\"{name}\": \"out\"}})"
        ));
        let done = desk.go();
        done.sound();
        if done.status != Some(0) {
            done.refused(&["g.ron:1:"]);
        }
    }
    use std::os::unix::ffi::OsStrExt as _;
    let desk = Desk::new();
    let name = std::ffi::OsStr::from_bytes(b"bad\xff.ron");
    if std::fs::write(desk.path("").join(name), graph("\"out\": Grid()")).is_ok() {
        let mut command = desk.command(&["run"]);
        command.arg(name);
        desk.wait(command).made();
    }
}

#[test]
fn f083_an_odd_environment() {
    let desk = Desk::nodes("\"out\": Grid()");
    let mut command = desk.command(&["run", "g.ron"]);
    command.env_clear();
    desk.wait(command).made();
    let mut command = desk.command(&["run", "g.ron"]);
    command
        .env("TMPDIR", "/nowhere")
        .env("HOME", "/nowhere")
        .env_remove("TESSGRAPH_CACHE");
    desk.wait(command).made();
    // Times in the future and in the past: only contents count.
    for seconds in [1, 4_000_000_000] {
        let file = std::fs::File::options()
            .write(true)
            .open(desk.path("g.ron"))
            .expect("a file");
        let time = std::time::UNIX_EPOCH + std::time::Duration::from_secs(seconds);
        file.set_modified(time).expect("a time");
        desk.go().made();
    }
}

#[test]
fn f084_f085_streams_that_are_closed() {
    let desk = Desk::nodes("\"out\": Grid()");
    for arguments in [
        &["run", "g.ron", "--report", "json"][..],
        &["nodes", "--markdown"],
        &["nodes"],
    ] {
        let mut child = desk.command(arguments);
        let mut child = child
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        drop(child.stdout.take());
        let done = child.wait_with_output().expect("it ends");
        let err = String::from_utf8_lossy(&done.stderr);
        assert!(!err.contains("panicked"), "{err}");
        let mut child = desk.command(arguments);
        let mut child = child
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        drop(child.stderr.take());
        let status = child.wait().expect("it ends");
        assert_eq!(status.code(), Some(0), "{arguments:?}");
    }
    // Closed before the program starts: no output goes into a file instead.
    let mut command = Command::new("sh");
    command.args(["-c", "exec \"$@\" >&- 2>&-", "sh"]);
    command
        .arg(crate::support::program::program())
        .args(["run", "g.ron", "--no-cache"]);
    let status = command.current_dir(desk.path("")).status().expect("sh");
    assert_eq!(status.code(), Some(0));
    let text = String::from_utf8(desk.content("out/o.obj")).expect("a text");
    assert!(
        text.starts_with("v 0 0 0\n") && text.contains("\nf "),
        "{text}"
    );
}

#[test]
fn f100_the_order_in_which_the_disk_is_told() {
    let Some(shim) = shim() else { return };
    let desk = Desk::nodes("\"out\": Grid()");
    let log = tempfile::NamedTempFile::new().expect("a file");
    let mut command = desk.command(&["run", "g.ron"]);
    let below = desk.path("").canonicalize().expect("a folder");
    command
        .env("LD_PRELOAD", shim)
        .env("FAULT_BELOW", below)
        .env("FAULT_LOG", log.path());
    desk.wait(command).made();
    let calls = crate::support::text_of(log.path());
    let calls: Vec<_> = calls.lines().collect();
    let expected = ["open", "write", "fsync", "rename", "fsync"];
    let at = calls.windows(5).any(|window| window == expected);
    assert!(at, "{calls:?}");
}
