//! What became of each node, and the values that were asked for.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, OnceLock};

use tessgraph_geometry::digest::Digest;

use super::cache::Cache;
use super::explain::KeyPart;
use super::inputs::{fitted, value_of};
use crate::diagnostic::{Diagnostic, Severity};
use crate::node::Args;
use crate::plan::{Plan, PlanMeasure, ResultRef};
use crate::value::Value;

/// What the evaluator did about a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// It was evaluated.
    Computed,
    /// Its results were found, and nothing above it was computed in this run.
    Cached,
    /// Its results were found although something above it was computed: the
    /// change did not reach it.
    CutOff,
    /// It reported an error.
    Failed,
    /// An input of it failed.
    Blocked,
    /// Not needed, or the run was cancelled before it finished.
    Skipped,
}

impl Outcome {
    /// Its name in reports: `computed`, `cut_off`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Computed => "computed",
            Self::Cached => "cached",
            Self::CutOff => "cut_off",
            Self::Failed => "failed",
            Self::Blocked => "blocked",
            Self::Skipped => "skipped",
        }
    }

    /// Whether the node's results are there.
    pub fn is_done(self) -> bool {
        matches!(self, Self::Computed | Self::Cached | Self::CutOff)
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What became of one node.
#[derive(Debug, Clone)]
pub struct NodeRun {
    /// Its name in the file.
    pub name: String,
    /// What kind of node it is.
    pub kind: &'static str,
    /// What the evaluator did.
    pub outcome: Outcome,
    /// Milliseconds its evaluation took; 0 unless it was computed or failed.
    pub ms: f64,
    /// Bytes of its results in memory, shared buffers counted once per node.
    pub bytes: usize,
    /// What it warned of, also when its result was reused.
    pub warnings: Vec<String>,
}

/// When and where a node was evaluated, for a time line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeTime {
    /// Milliseconds from the start of the run to the start of the evaluation.
    pub start_ms: f64,
    /// Milliseconds from the start of the run to its end.
    pub end_ms: f64,
    /// The thread of the pool it began on.
    pub thread: usize,
}

/// The result of an evaluation.
#[derive(Debug)]
pub struct Evaluation {
    /// One entry per node of the plan, in the plan's order.
    pub nodes: Vec<NodeRun>,
    /// When each node was evaluated, in the plan's order; `None` for those that
    /// were not.
    pub times: Vec<Option<NodeTime>>,
    /// Errors and warnings of nodes, in the plan's order.
    pub diagnostics: Vec<Diagnostic>,
    /// Whether the run was cancelled.
    pub cancelled: bool,
    pub(super) wanted: BTreeMap<ResultRef, Wanted>,
    /// Each node's key and what it was made of.
    pub(super) keys: Vec<Option<(Option<Digest>, Vec<KeyPart>)>>,
    pub(super) cache: Option<Arc<Cache>>,
}

/// A result that was asked for.
#[derive(Debug)]
pub(super) struct Wanted {
    identity: Digest,
    provenance: Digest,
    ms: f64,
    value: OnceLock<Option<Value>>,
}

impl Wanted {
    pub(super) fn new(identity: Digest, provenance: Digest, ms: f64, value: Option<Value>) -> Self {
        let value = value.map(Some).map_or_else(OnceLock::new, OnceLock::from);
        Self {
            identity,
            provenance,
            ms,
            value,
        }
    }
}

impl Evaluation {
    /// A result that was asked for; `None` if it could not be computed.
    ///
    /// If [`Observer::needs`] said that the value is not needed it is loaded
    /// from the cache now, and `None` too if it has been let go meanwhile.
    pub fn value(&self, result: ResultRef) -> Option<&Value> {
        let wanted = self.wanted.get(&result)?;
        if let Some(value) = wanted.value.get() {
            return value.as_ref();
        }
        // Not inside the cell: loading uses the thread pool, and a thread that waits
        // there may take up a task that asks for this value.
        let cache = self.cache.as_ref();
        let value = cache.and_then(|cache| cache.value(wanted.identity, wanted.ms));
        wanted.value.get_or_init(|| value).as_ref()
    }

    /// What tells a result that was asked for from all others, known without its
    /// value: the digest of its content, or in a run without a cache, where none is
    /// found again by it, its provenance.
    pub fn identity(&self, result: ResultRef) -> Option<Digest> {
        self.wanted.get(&result).map(|wanted| wanted.identity)
    }

    /// Content digest of a result that was asked for; with a cache it is known
    /// without the value, else the value is read for it.
    pub fn digest(&self, result: ResultRef) -> Option<Digest> {
        match self.cache {
            Some(_) => self.identity(result),
            None => self.value(result).map(Value::digest),
        }
    }

    /// Digest of everything a wanted result was made from: kinds and versions
    /// of nodes, literals, and file contents, but no names and no layout. Equal
    /// digests mean equal results.
    pub fn provenance(&self, result: ResultRef) -> Option<Digest> {
        self.wanted.get(&result).map(|wanted| wanted.provenance)
    }

    /// What the node was given; `None` unless all results that it takes were asked
    /// for and are there.
    pub fn arguments(&self, plan: &Plan, node: usize) -> Option<Args> {
        let planned = plan.nodes.get(node)?;
        let mut results = planned
            .inputs
            .iter()
            .flat_map(|input| input.origin.results());
        if results.any(|result| self.value(result).is_none()) {
            return None;
        }
        let inputs = planned.spec.inputs.iter().zip(&planned.inputs);
        let values = inputs.map(|(spec, input)| {
            let value = value_of(&input.origin, &|result| self.present(result)).ok()?;
            let fitted = value.map(|value| fitted(spec, &input.origin, value, planned.units));
            fitted.transpose().ok()
        });
        values.collect::<Option<Vec<_>>>().map(Args::new)
    }

    /// A result that is known to be there.
    fn present(&self, result: ResultRef) -> Value {
        let value = self.value(result).cloned();
        value.unwrap_or(Value::Bool(false))
    }

    /// Whether no node failed and the run was not cancelled.
    pub fn is_ok(&self) -> bool {
        !self.cancelled
            && self
                .diagnostics
                .iter()
                .all(|d| d.severity != Severity::Error)
    }
}

impl PlanMeasure {
    /// Its value, a number in the graph's units or a condition; its
    /// [`Origin::results`](crate::plan::Origin::results) must have been asked for.
    ///
    /// # Errors
    /// In words, when something it needs could not be computed, or when it is no
    /// finite number.
    pub fn value(&self, evaluation: &Evaluation) -> Result<Value, String> {
        let results = self.origin.results();
        if results
            .iter()
            .any(|result| evaluation.value(*result).is_none())
        {
            return Err("what it needs could not be computed".to_owned());
        }
        let get = |result| evaluation.present(result);
        value_of(&self.origin, &get)?.ok_or_else(|| "it has none".to_owned())
    }
}

/// Is told what happens during an evaluation, and can stop it.
///
/// Called from several threads. Nodes are named by index into the plan.
pub trait Observer: Sync {
    /// Whether the value of a result that was asked for is needed, now that its
    /// identity and provenance are known (see [`Evaluation::identity`] and
    /// [`Evaluation::provenance`]). An output whose file is unchanged needs none,
    /// and then none is read from the cache. Not asked about what was computed
    /// anyhow.
    fn needs(&self, _result: ResultRef, _identity: Digest, _provenance: Digest) -> bool {
        true
    }

    /// A node's evaluation has begun. A node whose results were found begins
    /// after that if its values turn out to be lost.
    fn started(&self, _node: usize) {}

    /// A node has done `done` of `total` units of its work.
    fn progress(&self, _node: usize, _done: u64, _total: u64) {}

    /// A result that was asked for is there, while others may still be computed. Not
    /// called for values that are lost and computed again.
    fn found(&self, _result: ResultRef, _value: &Value) {}

    /// A node is dealt with.
    fn finished(&self, _node: usize, _run: &NodeRun) {}

    /// Bytes that the run may still take; `None` without a limit. Nodes ask
    /// before they make something large.
    fn memory_left(&self) -> Option<u64> {
        None
    }

    /// Whether the evaluation should stop; polled often.
    fn cancelled(&self) -> bool {
        false
    }
}

/// An observer that ignores everything and never stops.
pub struct Silent;

impl Observer for Silent {}
