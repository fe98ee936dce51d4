//! What ends the watching, what does not, and what it shows.

use super::{Watch, graph, write};
use crate::support::program::{files, run, text};

#[test]
fn wrong_usage_ends_it_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder.path().join("g.ron"), &graph(1));
    for wrong in [
        &["--only", "nope.json"][..],
        &["--set", "n"],
        &["--allow", "/no/such/folder"],
        &["--watch"],
    ] {
        let done = run(
            &[&["run", "g.ron", "--watch"], wrong].concat(),
            folder.path(),
        );
        assert_eq!(done.status.code(), Some(2), "{}", text(&done.stderr));
    }
    let done = run(&["run", "g.ron", "--poll"], folder.path());
    assert_eq!(done.status.code(), Some(2), "{}", text(&done.stderr));
}

#[test]
fn no_input_ends_it() {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder.path().join("g.ron"), "Graph(version: 1");
    let watch = Watch::start(folder.path(), &["--only", "size.json", "--set", "n=5"]);
    assert_eq!(watch.next()["ok"], false);
    write(&watch.path("g.ron"), &graph(1));
    assert_eq!(watch.next()["ok"], true);
    assert_eq!(watch.faces(), 5, "what is set goes before what is written");
    let good = graph(1);
    for (bad, reason) in [
        (String::new(), "empty"),
        ("\u{0}".repeat(10), "error"),
        (good.replace("Grid", "Gird"), "Grid"),
        (good.replace("\"n\": 1", "\"m\": 1"), "`n`"),
        (
            good.replace("size.json\"", "size2.json\""),
            "no output `size.json`",
        ),
        (good.replace("\"grid\")", "\"size\")"), "error"),
        (good.replace("version: 1", "version: 99"), "99"),
        (good.replace("[\"n\", 1]", "[\"n\", 0]"), "error"),
        (
            good.replace("Grid(cells: [\"n\", 1])", "ReadMesh(path: \"no.obj\")"),
            "no.obj",
        ),
    ] {
        write(&watch.path("g.ron"), &bad);
        assert_eq!(watch.next()["ok"], false, "{bad}");
        assert_eq!(watch.faces(), 5, "the last good output stays");
        watch.line_with(reason);
        write(&watch.path("g.ron"), &good);
        assert_eq!(watch.next()["ok"], true);
    }
}

#[cfg(unix)]
#[test]
fn too_large_a_result_ends_only_its_run() {
    let (_folder, mut watch) = Watch::on_grid(2, &["--max-memory", "80MB"]);
    // A grid asks first, and fails; looking for crossings does not, and ends the
    // process, which starts again in its own place.
    let crossed = |text: String| {
        let nodes = "\"crossings\": CheckIntersections(mesh: \"grid\"), \
             \"moved\": Transform(mesh: \"grid\", translate: (0, 0, \"crossings.pairs\")), \
             \"size\": MeasureMesh(mesh: \"moved\")";
        text.replace("\"size\": MeasureMesh(mesh: \"grid\")", nodes)
    };
    for (faces, text, told) in [
        (3, graph(5_000_000), "it needs about"),
        (4, crossed(graph(450_000)), "out_of_memory"),
        (5, crossed(graph(500_000)), "out_of_memory"),
    ] {
        write(&watch.path("g.ron"), &text);
        assert_eq!(watch.next()["ok"], false);
        watch.line_with(told);
        assert_eq!(watch.faces(), faces - 1, "the last good output stays");
        write(&watch.path("g.ron"), &graph(faces));
        watch.until_faces(faces);
    }
    assert_eq!(watch.interrupt().code(), Some(130));
}

#[cfg(unix)]
#[test]
fn a_signal_ends_it_and_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder.path().join("g.ron"), &graph(2));
    let mut watch = Watch::start(folder.path(), &["--out", "out"]);
    assert_eq!(watch.next()["ok"], true);
    write(&watch.path("g.ron"), &graph(3));
    assert_eq!(watch.next()["ok"], true);
    assert_eq!(watch.interrupt().code(), Some(130));
    let names = files(folder.path()).into_iter().map(|(path, _)| path);
    let names: Vec<_> = names
        .map(|path| path.to_string_lossy().into_owned())
        .collect();
    assert_eq!(names, ["g.ron", "out/size.json"]);
}

#[test]
fn a_line_for_each_run_says_what_became_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder.path().join("g.ron"), &graph(2));
    let watch = Watch::start_for_people(folder.path(), &["--explain"]);
    let first = watch.line_with("2 nodes");
    assert!(
        first.starts_with("g.ron: 2 nodes: 2 computed in "),
        "{first}"
    );
    assert!(first.ends_with("; wrote size.json"), "{first}");
    let watching = watch.line_with("watching");
    assert_eq!(watching, "watching 1 file; Ctrl-C ends");
    write(&watch.path("g.ron"), &graph(3));
    let why = watch.line_with("grid.cells");
    assert!(why.contains("[2, 1] -> [3, 1]"), "{why}");
    let second = watch.line_with("2 nodes");
    assert!(second.contains("2 computed"), "{second}");
    write(&watch.path("g.ron"), &graph(2));
    let undone = watch.line_with("2 nodes");
    assert!(undone.contains("2 cached"), "{undone}");
    assert!(undone.ends_with("; wrote size.json"), "{undone}");
    write(&watch.path("g.ron"), "Graph");
    let broken = watch.line_with("1 error");
    assert!(broken.starts_with("g.ron: 1 error in "), "{broken}");
}
