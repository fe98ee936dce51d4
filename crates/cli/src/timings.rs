//! When each node ran, as a trace that Perfetto and Chrome show.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};
use tessgraph_graph::{Evaluation, NodeRun};

use crate::json::{line, number};

/// The parts of a run, one after the other.
pub(crate) struct Phases {
    start: Instant,
    /// Name, and milliseconds from the start of the command to begin and end.
    done: Vec<(&'static str, f64, f64)>,
}

/// The phase from whose beginning the times of nodes are counted.
pub(crate) const EVALUATE: &str = "evaluate";

impl Phases {
    /// Of a run that began at `start`.
    pub(crate) fn starting(start: Instant) -> Self {
        let done = Vec::new();
        Self { start, done }
    }

    /// Carries a part out.
    pub(crate) fn during<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let now = |start: Instant| start.elapsed().as_secs_f64() * 1000.0;
        let begin = now(self.start);
        let result = work();
        self.done.push((name, begin, now(self.start)));
        result
    }
}

/// The trace of a run: a lane for its parts, and one for each thread with the
/// nodes that were evaluated on it.
pub(crate) fn trace(
    graph: &Path,
    phases: &Phases,
    evaluation: &Evaluation,
    peaks: &[Option<u64>],
) -> String {
    let graph = graph.to_string_lossy();
    let mut events = vec![named("process_name", 0, &format!("tessgraph {graph}"))];
    events.push(named("thread_name", 0, "run"));
    let evaluate = phases.done.iter().find(|(name, ..)| *name == EVALUATE);
    let offset = evaluate.map_or(0.0, |(_, begin, _)| *begin);
    for (name, begin, end) in &phases.done {
        events.push(slice(name, "run", 0, (*begin, *end), json!({})));
    }
    let mut lanes = BTreeSet::new();
    let mut outcomes: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    let peaks = peaks.iter().copied().chain(std::iter::repeat(None));
    for ((node, time), peak) in evaluation.nodes.iter().zip(&evaluation.times).zip(peaks) {
        let outcome = node.outcome.name();
        outcomes.entry(outcome).or_default().push(&node.name);
        if let Some(time) = time {
            lanes.insert(time.thread);
            let span = (offset + time.start_ms, offset + time.end_ms);
            let lane = time.thread + 1;
            events.push(slice(
                &node.name,
                outcome,
                lane,
                span,
                arguments(node, peak),
            ));
        }
    }
    for lane in lanes {
        let name = format!("thread {}", lane + 1);
        events.push(named("thread_name", lane + 1, &name));
    }
    let program = concat!("tessgraph ", env!("CARGO_PKG_VERSION"));
    let trace = json!({
        "displayTimeUnit": "ms",
        "otherData": { "program": program, "graph": graph, "nodes": outcomes },
        "traceEvents": events,
    });
    format!("{}\n", line(&trace))
}

fn arguments(node: &NodeRun, peak: Option<u64>) -> Value {
    json!({
        "kind": node.kind,
        "outcome": node.outcome.name(),
        "bytes": node.bytes,
        "peak_bytes": peak,
        "warnings": node.warnings.len(),
    })
}

/// A stretch of time on a lane, from and to milliseconds.
fn slice(name: &str, category: &str, lane: usize, (begin, end): (f64, f64), args: Value) -> Value {
    // The format wants microseconds.
    let [begin, length] = [begin, end - begin].map(|ms| number((ms * 1e6).round() / 1e3));
    json!({
        "name": name,
        "cat": category,
        "ph": "X",
        "ts": begin,
        "dur": length,
        "pid": 1,
        "tid": lane,
        "args": args,
    })
}

/// The name of the process or of a lane.
fn named(what: &str, lane: usize, name: &str) -> Value {
    json!({ "name": what, "ph": "M", "pid": 1, "tid": lane, "args": { "name": name } })
}
