//! How long it takes from saving a file to telling the page.

use std::time::{Duration, Instant};

use super::{folder_with, write};
use crate::support::page::Server;

/// A facade of a million vertices whose last node has `lift` for its height.
fn facade(lift: f64) -> String {
    format!(
        "Graph(version: 1, nodes: {{\n    \
         \"grid\": Grid(size: [100, 100], cells: [1000, 1000]),\n    \
         \"facade\": Transform(mesh: \"grid\", translate: (0, 0, {lift:?})),\n}},\n\
         outputs: {{\"facade.glb\": \"facade\"}})\n"
    )
}

#[test]
#[ignore = "a measurement: run it by itself, with --nocapture"]
fn from_saving_to_the_picture() {
    let folder = folder_with(&facade(0.0));
    let path = folder.path().join("g.ron");
    let server = Server::start(folder.path(), "g.ron", &["--port", "0"]);
    let mut page = server.open();
    page.until("shown", |shown| shown["mesh"]["vertices"] == 1_002_001);
    let mut times: Vec<(Duration, f64, Duration)> = Vec::new();
    for save in 1..=10 {
        std::thread::sleep(Duration::from_millis(500));
        let saved = Instant::now();
        write(&path, &facade(f64::from(save)));
        let status = page.until_up_to_date();
        let shown = page.any("shown");
        let told = saved.elapsed();
        let run = status["ms"].as_f64().expect("a number");
        assert_eq!(shown["mesh"]["bounds"][1][2], f64::from(save));
        assert_eq!(
            server.buffer(&shown["mesh"]["positions"]).len(),
            12 * 1_002_001
        );
        times.push((told, run, saved.elapsed()));
    }
    times.sort_by_key(|time| time.0);
    let (told, run, fetched) = times[times.len() / 2];
    println!(
        "1 002 001 vertices: {told:?} from saving to `shown`, of which the run {run:.0} ms; {fetched:?} with the positions fetched"
    );
}
