//! Faults 98, 99 and 106: runs that are stopped, and runs that are repeated.

use std::time::{Duration, Instant};

use super::desk::{Desk, names};
use crate::support::program::{files, text, with_graphs};

/// A facade that takes a while, and another that gives other outputs.
const SLOW: &str = "Graph(version: 1, params: {\"t\": 0.1}, nodes: {
        \"flat\": Grid(cells: (40, 40), size: (40, 40)),
        \"n\": SmoothNormals(mesh: \"flat\", iterations: 50),
        \"part\": Cuboid(cells: (4, 4, 2)),
        \"fit\": FitComponent(component: \"part\", height: \"t\"),
        \"out\": ArrayComponents(base: \"flat\", component: \"fit\", directions: \"n\"),
    }, outputs: {\"out/a.obj\": \"out\", \"out/b.glb\": \"out\"})";

#[allow(clippy::print_stdout, reason = "the figure is what is promised")]
/// Kills runs at moments spread over the time one takes.
fn killed(times: u32) {
    let old = Desk::with(SLOW);
    old.go().made();
    // The quickest of some runs, so that most kills find one still at work.
    let runs = (0..5).map(|_| old.run(&["run", "g.ron", "--no-cache"]).took);
    let whole = runs.min().expect("five runs");
    let new = Desk::with(SLOW);
    new.run(&["run", "g.ron", "--set", "t=0.2"]).made();
    let desk = Desk::with(SLOW);
    desk.go().made();
    let mut cut = 0;
    for k in 0..times {
        let thickness = if k % 2 == 0 { "t=0.2" } else { "t=0.1" };
        let mut command = desk.command(&["run", "g.ron", "--no-cache", "--set", thickness]);
        command.stderr(std::process::Stdio::null());
        let mut child = command.spawn().expect("it starts");
        std::thread::sleep(whole.mul_f64(f64::from(k + 1) / f64::from(times)));
        child.kill().expect("a process");
        cut += u32::from(!child.wait().expect("an end").success());
        for name in ["out/a.obj", "out/b.glb"] {
            let content = desk.content(name);
            let known = content == old.content(name) || content == new.content(name);
            assert!(known, "{name} is torn after kill {k}");
        }
    }
    println!("killed {cut} of {times} runs: all outputs whole");
    assert!(cut > 0, "every run was over before it was killed");
    desk.go().made();
    assert_eq!(desk.names(), ["g.ron", "out", "out/a.obj", "out/b.glb"]);
}

#[test]
fn f098_killed_at_many_moments() {
    killed(12);
}

#[test]
#[ignore = "takes minutes; .ci/run has it"]
fn f098_killed_at_200_moments() {
    killed(200);
}

#[cfg(unix)]
#[test]
fn f099_interrupted() {
    // Work for minutes, so that every signal finds it busy.
    let text = SLOW
        .replace("iterations: 50", "iterations: 100000")
        .replace("(40, 40)", "(400, 400)");
    for (signal, status) in [("INT", 130), ("TERM", 130), ("HUP", 130)] {
        let desk = Desk::with(&text);
        desk.write("out/a.obj", "old");
        let mut command = desk.command(&["run", "g.ron", "--no-cache"]);
        let mut child = command
            .stderr(std::process::Stdio::null())
            .spawn()
            .expect("it starts");
        std::thread::sleep(Duration::from_millis(400));
        let start = Instant::now();
        let process = child.id().to_string();
        let sent = std::process::Command::new("kill")
            .args(["-s", signal, &process])
            .status();
        assert!(sent.expect("kill").success());
        let ended = child.wait().expect("an end");
        assert_eq!(ended.code(), Some(status), "{signal}");
        // A second is promised; the machine may be busy with other tests.
        assert!(
            start.elapsed() < Duration::from_secs(10),
            "{signal}: {:?}",
            start.elapsed()
        );
        assert_eq!(names(&desk.path("out")), ["a.obj"]);
        assert_eq!(desk.content("out/a.obj"), b"old");
    }
}

#[test]
fn f106_the_same_bytes_everywhere() {
    let run = |arguments: &[&str], settings: &[(&str, &str)]| {
        let folder = with_graphs();
        let mut command = std::process::Command::new(crate::support::program::program());
        command
            .args(["run", "vault.ron", "--no-cache", "--out", "made"])
            .args(arguments);
        command
            .current_dir(folder.path())
            .envs(settings.iter().copied());
        let done = command.output().expect("it runs");
        assert!(done.status.success(), "{}", text(&done.stderr));
        files(&folder.path().join("made"))
    };
    let first = run(&[], &[]);
    assert!(!first.is_empty());
    for threads in ["1", "2", "16"] {
        for _ in 0..3 {
            assert!(
                first == run(&["--threads", threads], &[]),
                "{threads} threads"
            );
        }
    }
    let german = [
        ("LC_ALL", "de_DE.UTF-8"),
        ("LANG", "de_DE.UTF-8"),
        ("TZ", "Asia/Tokyo"),
    ];
    assert!(first == run(&[], &german), "another locale");
}
