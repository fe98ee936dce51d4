//! What every fuzz target holds: an answer or an error that helps, and nothing
//! else. A panic, also one that the engine would catch, ends the target.

mod graphs;

use tessgraph_geometry::Unmonitored;
use tessgraph_graph::{
    Diagnostic, Engine, LoadOptions, Observer, Plan, Value, load_with, world::MemoryWorld,
};
use tessgraph_io::{
    Format, GlbOptions, ObjOptions, ReadOptions, no_files, read, read_luminance, write_glb,
    write_obj,
};

pub use graphs::random_graph;

/// Bytes that a reader or a graph may take.
const MEMORY: u64 = 64 << 20;

/// Polls after which an evaluation is stopped, so that a graph that asks for a
/// thousand million passes counts as what it is, and not as a hang.
const POLLS: u64 = 1_000;

/// Reads a mesh. What is read must be finite, and come back as it was from an OBJ
/// file; what is refused must say why and what to do.
pub fn read_mesh(format: Format, bytes: &[u8]) {
    let options = ReadOptions {
        memory_limit: MEMORY,
        ..ReadOptions::default()
    };
    let mesh = match read(format, "x", bytes, &mut no_files, &options, &Unmonitored) {
        Ok(loaded) => loaded.mesh,
        Err(error) => {
            let text = error.to_string();
            assert!(
                !text.is_empty() && !text.chars().any(char::is_control),
                "{text}"
            );
            if let Some(fault) = error.fault() {
                assert!(!fault.cause.is_empty() && !fault.help.is_empty());
            }
            return;
        }
    };
    assert!(mesh.positions().iter().all(|place| place.is_finite()));
    let monitor = &Unmonitored;
    if let Ok(written) = write_obj(&mesh, &ObjOptions::default(), monitor)
        && mesh.vertex_count() > 0
    {
        let again = read(
            Format::Obj,
            "x",
            &written.bytes,
            &mut no_files,
            &options,
            monitor,
        );
        let again = again.expect("what was written is read").mesh;
        assert_eq!(again.positions(), mesh.positions());
        assert!(again.topology().is_same(mesh.topology()));
    }
    if let Ok(written) = write_glb(&mesh, &GlbOptions::default(), monitor)
        && mesh.face_count() > 0
    {
        let again = read(
            Format::Glb,
            "x",
            &written.bytes,
            &mut no_files,
            &options,
            monitor,
        );
        again.expect("what was written is read");
    }
}

/// Reads a picture. Every pixel must be a number from 0 to 1.
pub fn read_image(bytes: &[u8]) {
    if let Ok(picture) = read_luminance(bytes, "x") {
        for (u, v) in [(0.0, 0.0), (0.5, 0.25), (1.0, 1.0), (-7.3, 1e18)] {
            assert!((0.0..=1.0).contains(&picture.at(u, v)));
        }
    }
}

/// Reads and checks a graph. Problems must have a place within the text.
pub fn check_graph(bytes: &[u8]) -> Option<Plan> {
    let loaded = load_with(
        "graph.ron",
        bytes,
        tessgraph_nodes::NODES,
        &LoadOptions::default(),
        &graphs::files(),
    );
    match loaded.plan {
        Ok(plan) => Some(plan),
        Err(problems) => {
            assert!(!problems.is_empty());
            problems.iter().for_each(check_problem);
            None
        }
    }
}

fn check_problem(problem: &Diagnostic) {
    assert!(!problem.message.is_empty() && !problem.code.is_empty());
    for label in &problem.labels {
        assert!(problem.source.text().get(label.span.clone()).is_some());
    }
}

/// Stops what takes too long, and lets nothing large be made.
struct Bounded(std::sync::atomic::AtomicU64);

impl Observer for Bounded {
    fn memory_left(&self) -> Option<u64> {
        Some(MEMORY)
    }

    fn cancelled(&self) -> bool {
        self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed) > POLLS
    }
}

/// Evaluates a graph. Every number of a result must be finite.
pub fn evaluate_graph(text: &str) {
    let Some(plan) = check_graph(text.as_bytes()) else {
        return;
    };
    let wanted: Vec<_> = plan.outputs.iter().map(|output| output.result).collect();
    let bounded = Bounded(Default::default());
    let world: MemoryWorld = graphs::files();
    let evaluation = Engine::without_cache().evaluate(&plan, &wanted, &world, &bounded);
    for result in wanted {
        if let Some(value) = evaluation.value(result) {
            check_value(value, text);
        }
    }
}

fn check_value(value: &Value, text: &str) {
    match value {
        Value::Mesh(mesh) => {
            assert!(
                mesh.positions().iter().all(|place| place.is_finite()),
                "{text}"
            );
        }
        Value::Directions(directions) => {
            let mut both = directions.outward().iter().chain(directions.inward().iter());
            assert!(both.all(|direction| direction.is_finite()), "{text}");
        }
        Value::Field(field) => {
            assert!(
                field.values().iter().all(|value| value.is_finite()),
                "{text}"
            );
        }
        Value::Number(number) => assert!(number.is_finite(), "{text}"),
        Value::List(items) => items.iter().for_each(|item| check_value(item, text)),
        _ => {}
    }
}
