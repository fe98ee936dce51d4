//! Why a node was computed, when, and whether what is kept can be trusted.

use std::path::Path;
use std::sync::atomic::{AtomicI64, Ordering};

use tessgraph_graph::check::LoadOptions;
use tessgraph_graph::world::MemoryWorld;
use tessgraph_graph::{Engine, Kind, NodeSpec, Observer, Outcome, Quantity, Silent, Value};

use super::{CAGE, GRAPH, MEMORY, Run, files_of};
use crate::support;

/// What changed against the last run in the folder, as lines.
fn explained(text: &str, folder: &Path, cage: &str) -> Vec<String> {
    let engine = Engine::with_disk(MEMORY, folder);
    let mut world = MemoryWorld::default();
    world.insert("cage.obj", cage.as_bytes());
    let plan = support::load("edit.ron", text);
    let wanted: Vec<_> = plan.outputs.iter().map(|output| output.result).collect();
    let evaluation = engine.evaluate(&plan, &wanted, &world, &Silent);
    let changes = engine.explain("/somewhere/edit.ron", &plan, &evaluation);
    let line = |change: tessgraph_graph::eval::KeyChange| {
        let from = match change.from.as_slice() {
            [] => String::new(),
            names => format!(" from {}", names.join(", ")),
        };
        let (node, input) = (change.node, change.input);
        // Digests are of no interest here.
        let plain = |text: String| text.split(" (").next().unwrap_or_default().to_owned();
        format!(
            "{node}.{input}: {} -> {}{from}",
            plain(change.old),
            plain(change.new)
        )
    };
    changes.into_iter().map(line).collect()
}

#[test]
fn changes_are_followed_down_to_the_edited_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = explained(GRAPH, folder.path(), CAGE);
    assert_eq!(first.len(), 6);
    assert_eq!(
        first[0],
        "cage.kind: not in the last run -> ReadMesh version 2"
    );
    assert_eq!(explained(GRAPH, folder.path(), CAGE), [""; 0]);
    let thicker = GRAPH.replace("\"t\": 0.1", "\"t\": 0.25");
    assert_eq!(
        explained(&thicker, folder.path(), CAGE),
        [
            "shell.outward: 0.1 -> 0.25",
            "size.mesh: shell -> shell from shell",
            "deep.outward: 0.243319 -> 0.303817 from size",
        ]
    );
    // Another name is no change, nor is another order.
    let renamed = thicker.replace("surface", "skin");
    assert_eq!(explained(&renamed, folder.path(), CAGE), [""; 0]);
    let cage = CAGE.replace("0.2", "0.3");
    let moved = explained(&renamed, folder.path(), &cage);
    assert_eq!(moved[0], "cage.path: cage.obj -> cage.obj");
    assert_eq!(moved[1], "skin.mesh: cage -> cage from cage");
}

#[test]
fn a_damaged_record_of_the_last_run_counts_as_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = explained(GRAPH, folder.path(), CAGE);
    let records = files_of(&folder.path().join("runs"));
    let [record] = records.as_slice() else {
        panic!("{records:?}");
    };
    #[allow(clippy::disallowed_methods, reason = "tests read their own files")]
    let whole = std::fs::read(record).expect("a record");
    for at in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x21;
        std::fs::write(record, &bytes).expect("written");
        assert_eq!(explained(GRAPH, folder.path(), CAGE), first, "byte {at}");
    }
    assert_eq!(explained(GRAPH, folder.path(), CAGE), [""; 0]);
}

#[test]
fn starts_and_threads_make_a_time_line() {
    let run = Run::with(&Engine::without_cache(), GRAPH, false);
    let of = |name: &str| {
        let node = run.plan.node_index(name).expect("a node");
        run.evaluation.times[node].expect("it was evaluated")
    };
    for (before, after) in [("cage", "surface"), ("surface", "shell"), ("shell", "size")] {
        let (before, after) = (of(before), of(after));
        assert!(before.start_ms <= before.end_ms);
        assert!(before.end_ms <= after.start_ms);
        assert!(after.thread < rayon::current_num_threads());
    }
}

/// Counts its evaluations, so that no two give the same.
static CALLS: AtomicI64 = AtomicI64::new(0);

/// A node that breaks the rule of purity.
static IMPURE: &[NodeSpec] = &[NodeSpec {
    name: "Count",
    doc: "Counts.",
    version: 1,
    inputs: &[],
    outputs: &[tessgraph_graph::node::OutputSpec {
        name: "result",
        doc: "The count.",
        kind: Kind::Integer,
        quantity: Quantity::Number,
        faults: None,
    }],
    preview: tessgraph_graph::node::Preview::NONE,
    eval: |_, _| Ok(vec![Value::Integer(CALLS.fetch_add(1, Ordering::Relaxed))]),
}];

#[test]
fn verification_finds_a_node_that_is_not_pure() {
    let text = b"Graph(version: 1, nodes: {\"n\": Count()}, outputs: {\"n.json\": \"n\"})";
    let plan = tessgraph_graph::load("count.ron", text, IMPURE, &LoadOptions::default());
    let plan = plan.unwrap_or_else(|diagnostics| panic!("{}", support::shown(&diagnostics)));
    let wanted = [plan.outputs[0].result];
    let folder = tempfile::tempdir().expect("a folder");
    let run = |percent: f64| {
        let engine = Engine::with_disk(MEMORY, folder.path()).verifying(percent);
        engine.evaluate(&plan, &wanted, &MemoryWorld::default(), &Silent)
    };
    assert!(run(0.0).is_ok());
    assert!(run(0.0).is_ok());
    let found = run(100.0);
    assert_eq!(found.diagnostics[0].code, "cache_mismatch");
    assert!(!found.is_ok());
}

#[test]
fn verification_of_pure_nodes_changes_no_outcome() {
    let folder = tempfile::tempdir().expect("a folder");
    Run::outputs(GRAPH, folder.path());
    let engine = Engine::with_disk(MEMORY, folder.path()).verifying(100.0);
    let plan = support::load("edit.ron", GRAPH);
    let wanted: Vec<_> = plan.outputs.iter().map(|output| output.result).collect();
    let started = Started::default();
    let evaluation = engine.evaluate(&plan, &wanted, &super::world(), &started);
    assert!(evaluation.is_ok());
    let mut nodes = evaluation.nodes.iter();
    assert!(nodes.all(|node| node.outcome == Outcome::Cached));
    assert_eq!(started.0.into_inner(), 6);
}

/// Counts evaluations.
#[derive(Default)]
struct Started(AtomicI64);

impl Observer for Started {
    fn started(&self, _: usize) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}
