//! A rule that does not hold fails the run, and harms nothing else.

use crate::support::program::{run, text};
use crate::support::text_of;

const GRAPH: &str = r#"Graph(
    version: 1,
    nodes: {
        "box": Cuboid(size: [1, 1, 0.8]),
        "size": MeasureMesh(mesh: "box"),
        "rule": Require(condition: "size.volume < LIMIT", message: "the box is too large"),
    },
    outputs: {"out/box.obj": "box", "out/rule.json": "rule"},
)"#;

#[test]
fn a_rule_that_does_not_hold_fails_the_run_and_keeps_its_output() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |limit: &str| {
        std::fs::write(folder.path().join("g.ron"), GRAPH.replace("LIMIT", limit))
            .expect("written");
    };
    write("1");
    let done = run(&["run", "g.ron"], folder.path());
    assert!(done.status.success(), "{}", text(&done.stderr));
    let kept = text_of(&folder.path().join("out/rule.json"));
    std::fs::remove_file(folder.path().join("out/box.obj")).expect("removed");

    write("0.5");
    let done = run(&["run", "g.ron"], folder.path());
    let told = text(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{told}");
    assert!(
        told.contains("the box is too large") && told.contains("g.ron:6"),
        "{told}"
    );
    // The rule's output is as it was; the other one was made all the same.
    assert_eq!(text_of(&folder.path().join("out/rule.json")), kept);
    assert!(
        text_of(&folder.path().join("out/box.obj")).contains("\nv "),
        "{told}"
    );
}
