//! What is known about each node during a run.

use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tessgraph_geometry::digest::Digest;

use crate::NodeError;
use crate::eval::cache::Known;
use crate::eval::explain::KeyPart;
use crate::eval::outcome::{NodeRun, NodeTime};
use crate::node::FileUse;
use crate::plan::{Plan, ResultRef};
use crate::value::Value;

/// What is known about one node during a run.
pub(super) struct NodeState {
    pub(super) needed: bool,
    /// The nodes whose results it takes, without repetition.
    pub(super) inputs: Vec<usize>,
    /// The nodes that take its results.
    pub(super) users: Vec<usize>,
    pub(super) missing_inputs: AtomicUsize,
    /// Users that have not finished; at 0 the values are let go.
    pub(super) open_users: AtomicUsize,
    /// Nodes whose values this one waits for.
    pub(super) awaited: AtomicUsize,
    pub(super) done: Mutex<Option<Arc<Done>>>,
    /// The values that are in memory, one place per result.
    pub(super) values: Mutex<Vec<Option<Value>>>,
    pub(super) revival: Mutex<Revival>,
}

/// How a node ended.
pub(super) struct Done {
    pub(super) run: NodeRun,
    pub(super) error: Option<NodeError>,
    /// What is known about each result; nothing unless the node is done.
    pub(super) results: Vec<Known>,
    pub(super) provenance: Digest,
    /// Files that it found only while it was evaluated.
    pub(super) files: Vec<FileUse>,
    /// Whether it or anything above it was computed in this run.
    pub(super) fresh: bool,
    /// What its key was made of, one per input.
    pub(super) parts: Vec<KeyPart>,
    pub(super) key: Option<Digest>,
    /// When it was evaluated.
    pub(super) time: Option<NodeTime>,
}

/// Whether a node that was not computed is being computed after all.
#[derive(Default)]
pub(super) enum Revival {
    /// It is not.
    #[default]
    Idle,
    /// It is, and these wait for it.
    Running(Vec<Task>),
}

/// Something to do about a node.
#[derive(Debug, Clone, Copy)]
pub(super) enum Task {
    /// Deal with it: its inputs are all dealt with.
    Visit(usize),
    /// Compute it although its results were found: a value is lost, or is to
    /// be verified.
    Revive(usize),
}

impl Task {
    pub(super) fn node(self) -> usize {
        match self {
            Self::Visit(node) | Self::Revive(node) => node,
        }
    }
}

/// Why a node's arguments are not at hand.
pub(super) enum Unready {
    /// Values of these nodes must be computed first.
    Lost(Vec<usize>),
    /// A value could not be computed again.
    Gone,
    /// An argument is wrong.
    Wrong(NodeError),
}

impl From<NodeError> for Unready {
    fn from(error: NodeError) -> Self {
        Self::Wrong(error)
    }
}

/// The states of all nodes at the start, with who needs whom.
pub(super) fn wire(plan: &Plan, wanted: &[ResultRef]) -> Vec<NodeState> {
    let inputs: Vec<Vec<usize>> = plan
        .nodes
        .iter()
        .map(|node| {
            let results = node.inputs.iter().flat_map(|input| input.origin.results());
            let mut nodes: Vec<usize> = results.map(|result| result.node).collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes
        })
        .collect();
    let mut needed = vec![false; plan.nodes.len()];
    for result in wanted {
        needed[result.node] = true;
    }
    // Nodes stand after those they depend on, so one pass backwards suffices.
    for node in (0..plan.nodes.len()).rev() {
        if needed[node] {
            inputs[node].iter().for_each(|&input| needed[input] = true);
        }
    }
    let mut users = vec![Vec::new(); plan.nodes.len()];
    for (node, inputs) in inputs.iter().enumerate().filter(|(node, _)| needed[*node]) {
        inputs.iter().for_each(|&input| users[input].push(node));
    }
    let parts = inputs.into_iter().zip(users).zip(needed).zip(&plan.nodes);
    parts
        .map(|(((inputs, users), needed), planned)| NodeState {
            needed,
            missing_inputs: AtomicUsize::new(inputs.len()),
            open_users: AtomicUsize::new(users.len()),
            awaited: AtomicUsize::new(0),
            inputs,
            users,
            done: Mutex::default(),
            values: Mutex::new(vec![None; planned.spec.outputs.len()]),
            revival: Mutex::default(),
        })
        .collect()
}

pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
