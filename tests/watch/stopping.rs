//! A newer edit stops what is being computed.

use std::time::{Duration, Instant};

use super::{Watch, write};

/// A million vertices whose directions are smoothed for a long time.
fn heavy(iterations: usize) -> String {
    format!(
        r#"Graph(version: 1, nodes: {{
        "roof": ParametricSurface(x: "20 * u", y: "20 * v", z: "sin(9 * u) + cos(7 * v)", cells: [999, 999]),
        "normals": SmoothNormals(mesh: "roof", iterations: {iterations}),
        "shell": OffsetMesh(mesh: "roof", directions: "normals", outward: 0.1),
    }}, outputs: {{"size.stl": "shell"}})"#
    )
}

#[test]
#[ignore = "takes a million vertices; run by .ci/run with optimisation"]
fn an_edit_stops_a_node_of_a_million_vertices_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("g.ron");
    write(&path, &heavy(100_000));
    let watch = Watch::start_for_people(folder.path(), &[]);
    std::thread::sleep(Duration::from_secs(3));
    let mut times = Vec::new();
    for edit in 1..=10 {
        let saved = Instant::now();
        write(&path, &heavy(100_000 - edit));
        watch.line_with("changed, stopped after");
        times.push(saved.elapsed());
        std::thread::sleep(Duration::from_millis(900));
    }
    times.sort();
    println!("from saving to the end of the run: {times:?}");
    // The aim is 50 ms; a busy machine may give this process no time meanwhile.
    assert!(times[5] < Duration::from_millis(250), "{times:?}");
    write(&path, &heavy(1));
    let done = watch.line_with("3 nodes");
    assert!(done.contains("2 computed, 1 cached"), "{done}");
}
