//! Memory does not grow with the number of edits.

use std::path::Path;

use tessgraph_graph::world::MemoryWorld;
use tessgraph_graph::{Engine, Silent};

use super::{Watch, write};
use crate::support;
use crate::support::page::Server;

/// A graph whose grid takes about half a megabyte, and each edit another one.
fn edited(edit: usize) -> String {
    let size = 1.0 + edit as f64 * 0.001;
    format!(
        r#"Graph(version: 1, nodes: {{
        "grid": Grid(size: [{size}, 1], cells: [120, 100]),
        "normals": VertexNormals(mesh: "grid"),
        "shell": OffsetMesh(mesh: "grid", directions: "normals", outward: 0.1),
        "size": MeasureMesh(mesh: "shell"),
    }}, outputs: {{"size.json": "size"}})"#
    )
}

#[test]
fn an_engine_lets_go_of_what_edits_left_behind() {
    const BUDGET: u64 = 20_000_000;
    let engine = Engine::new(BUDGET);
    let mut most = 0;
    for edit in 0..1000 {
        let plan = support::load("g.ron", &edited(edit));
        let wanted: Vec<_> = plan.outputs.iter().map(|output| output.result).collect();
        let evaluation = engine.evaluate(&plan, &wanted, &MemoryWorld::default(), &Silent);
        assert!(evaluation.is_ok());
        most = most.max(engine.cache_stats().expect("a cache").bytes);
    }
    let stats = engine.cache_stats().expect("a cache");
    println!(
        "{most} bytes at most, {} values, {} entries",
        stats.values, stats.entries
    );
    assert!(most > BUDGET / 2 && most <= BUDGET, "{most}");
    // Some hundred bytes each, and themselves limited in number.
    assert_eq!(stats.entries, 4000);
}

/// Bytes of a process that are in memory.
fn resident(process: u32) -> Option<u64> {
    let statm = Path::new("/proc").join(process.to_string()).join("statm");
    let mut pages = String::new();
    std::io::Read::read_to_string(&mut std::fs::File::open(statm).ok()?, &mut pages).ok()?;
    let pages: u64 = pages.split_whitespace().nth(1)?.parse().ok()?;
    Some(pages * 4096)
}

#[test]
#[ignore = "waits for half a minute; run by .ci/run"]
fn memory_kept_for_edits_is_given_back_after_a_while() {
    let grid = |height: f64| {
        format!(
            r#"Graph(version: 1, nodes: {{
            "grid": Grid(size: [1, 1], cells: [1200, 1000]),
            "moved": Transform(mesh: "grid", translate: (0, 0, {height:?})),
        }}, outputs: {{"moved.stl": "moved"}})"#
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("g.ron");
    write(&path, &grid(0.0));
    let server = Server::start(folder.path(), "g.ron", &["--port", "0", "--no-cache"]);
    let mut page = server.open();
    for edit in 1..5 {
        page.until("shown", |shown| {
            shown["mesh"]["bounds"][1][2] == f64::from(edit - 1)
        });
        write(&path, &grid(f64::from(edit)));
    }
    let shown = page.until("shown", |shown| shown["mesh"]["bounds"][1][2] == 4.0);
    let before = resident(server.child.id()).expect("it runs");
    std::thread::sleep(std::time::Duration::from_secs(36));
    let after = resident(server.child.id()).expect("it runs");
    println!("{before} bytes after five edits, {after} half a minute later");
    // The positions of an edit take 29 MB, and 14 more as they are drawn.
    assert!(after + 40_000_000 < before, "{before}, then {after}");
    // What is shown is still there.
    let positions = server.buffer(&shown["mesh"]["positions"]);
    assert_eq!(positions.len(), 12 * 1201 * 1001);
}

#[test]
#[ignore = "a thousand edits take a minute and more; run by .ci/run"]
fn a_watching_process_stays_as_large_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("g.ron");
    write(&path, &edited(0));
    let watch = Watch::start(folder.path(), &["--max-memory", "200MB"]);
    watch.next();
    let mut sizes = Vec::new();
    for edit in 1..=1000 {
        // At once, so that every run finds a whole file.
        write(&folder.path().join("new"), &edited(edit));
        std::fs::rename(folder.path().join("new"), &path).expect("renamed");
        assert_eq!(watch.next()["ok"], true, "{}", watch.said());
        if edit % 100 == 0 {
            match resident(watch.child.id()) {
                Some(bytes) => sizes.push(bytes),
                None => return println!("skipped: this system does not say"),
            }
        }
    }
    println!("resident bytes after each hundred edits: {sizes:?}");
    // After two hundred the budget of 50 MB is full.
    let (early, late) = (sizes[1], sizes[9]);
    assert!(late < early + early / 5, "{sizes:?}");
}
