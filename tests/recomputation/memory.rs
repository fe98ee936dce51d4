//! An engine that keeps results in memory only: what it finds again, and what
//! it must not keep.

use tessgraph_graph::world::MemoryWorld;
use tessgraph_graph::{Engine, Outcome, Silent};

use crate::support;

const GRAPH: &str = r#"Graph(
    version: 1,
    params: {"levels": 1, "t": 0.1},
    nodes: {
        "cage": ReadMesh(path: "cage.obj"),
        "surface": SubdivideQuad(mesh: "cage", levels: "levels"),
        "normals": VertexNormals(mesh: "surface"),
        "shell": OffsetMesh(mesh: "surface", directions: "normals", outward: "t"),
        "size": MeasureMesh(mesh: "shell"),
        "base_size": MeasureMesh(mesh: "surface"),
    },
    outputs: {"size.json": "size", "base.json": "base_size"},
)"#;

const CAGE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0.2\nv 0 1 0\nf 1 2 3 4\n";

/// One engine, one set of files, and the log of each run.
struct Session {
    engine: Engine,
    world: MemoryWorld,
}

impl Session {
    fn new() -> Self {
        let mut world = MemoryWorld::default();
        world.insert("cage.obj", CAGE.as_bytes());
        Self {
            engine: Engine::new(1 << 30),
            world,
        }
    }

    /// The outcome of each node, as "node outcome", sorted by name.
    fn run(&self, text: &str) -> Vec<String> {
        let plan = support::load("edit.ron", text);
        let wanted: Vec<_> = plan.outputs.iter().map(|output| output.result).collect();
        let evaluation = self.engine.evaluate(&plan, &wanted, &self.world, &Silent);
        let mut log: Vec<_> = evaluation
            .nodes
            .iter()
            .map(|node| format!("{} {}", node.name, node.outcome))
            .collect();
        log.sort();
        log
    }

    /// The nodes whose outcome is not `cached`.
    fn changes(&self, text: &str) -> Vec<String> {
        let cached = Outcome::Cached.name();
        self.run(text)
            .into_iter()
            .filter(|line| !line.ends_with(cached))
            .collect()
    }
}

#[test]
fn the_first_run_computes_everything_and_the_second_nothing() {
    let session = Session::new();
    let first = session.run(GRAPH);
    assert!(
        first.iter().all(|line| line.ends_with(" computed")),
        "{first:?}"
    );
    assert_eq!(session.changes(GRAPH), [""; 0]);
}

#[test]
fn a_failure_is_not_cached_and_blocks_only_what_needs_it() {
    let mut session = Session::new();
    session.world = MemoryWorld::default();
    let without = session.run(GRAPH);
    let expected = [
        "base_size blocked",
        "cage failed",
        "normals blocked",
        "shell blocked",
    ];
    assert_eq!(without[..4], expected);
    session.world.insert("cage.obj", CAGE.as_bytes());
    assert!(
        session
            .run(GRAPH)
            .iter()
            .all(|line| line.ends_with(" computed"))
    );
}

#[test]
fn equal_nodes_are_computed_once() {
    let session = Session::new();
    let twice = GRAPH.replace(
        "\"size\": MeasureMesh(mesh: \"shell\"),",
        "\"size\": MeasureMesh(mesh: \"shell\"), \"again\": MeasureMesh(mesh: \"shell\"),",
    );
    let twice = twice.replace("outputs: {", "outputs: {\"again.json\": \"again\", ");
    let log = session.run(&twice);
    let computed = |name: &str| log.contains(&format!("{name} computed"));
    assert!(computed("size") != computed("again"), "{log:?}");
}
