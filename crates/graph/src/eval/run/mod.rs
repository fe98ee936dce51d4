//! One evaluation: a node starts when its inputs are there.

mod compute;
mod prepare;
mod report;
mod revive;
mod state;

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use tessgraph_geometry::digest::Digest;

use self::prepare::Prepared;
use self::state::{Done, NodeState, Task, Unready, lock, wire};
use super::cache::{Cache, Entry, key_with_files};
use super::files::RunFiles;
use super::outcome::{Evaluation, NodeRun, Observer, Outcome};
use super::{Engine, Values};
use crate::NodeError;
use crate::node::FileUse;
use crate::plan::{Plan, ResultRef};
use crate::value::Value;
use crate::world::World;

/// The state of one evaluation, shared by the threads that carry it out.
pub(super) struct Run<'a> {
    cache: Option<&'a Cache>,
    shared: Option<Arc<Cache>>,
    /// Of ten thousand results found, how many are computed again to compare.
    verified: u32,
    plan: &'a Plan,
    wanted: Vec<ResultRef>,
    files: RunFiles<'a>,
    observer: &'a dyn Observer,
    begin: Instant,
    nodes: Vec<NodeState>,
    /// Keys being computed, with the nodes that wait for the same key.
    in_flight: Mutex<BTreeMap<Digest, Vec<usize>>>,
    /// Nodes that gave other results than the cache had, and which.
    mismatches: Mutex<BTreeMap<usize, Vec<usize>>>,
    cancelled: AtomicBool,
}

/// How far a node came without being evaluated.
enum Attempt {
    /// It has ended; its values are at hand, or are loaded when needed.
    Ended(Done),
    /// An equal node is being evaluated and settles this one too.
    Waits,
    /// Values of these nodes must be computed again first.
    Needs(Vec<usize>),
    /// It has to be evaluated with these arguments.
    Compute(Prepared, Vec<Option<Value>>),
}

impl<'a> Run<'a> {
    pub(super) fn new(
        engine: &'a Engine,
        plan: &'a Plan,
        wanted: &[ResultRef],
        world: &'a dyn World,
        observer: &'a dyn Observer,
    ) -> Self {
        Self {
            cache: engine.cache.as_deref(),
            shared: engine.cache.clone(),
            verified: engine.verified,
            plan,
            wanted: wanted.to_vec(),
            files: RunFiles::new(world),
            observer,
            begin: Instant::now(),
            nodes: wire(plan, wanted),
            in_flight: Mutex::default(),
            mismatches: Mutex::default(),
            cancelled: AtomicBool::new(false),
        }
    }

    /// Carries the evaluation out.
    pub(super) fn finish(self) -> Evaluation {
        let ready = |&node: &usize| self.nodes[node].needed && self.nodes[node].inputs.is_empty();
        let ready: Vec<usize> = (0..self.nodes.len()).filter(ready).collect();
        let run = &self;
        rayon::scope(|scope| {
            for node in ready {
                scope.spawn(move |scope| run.visit(node, scope));
            }
        });
        self.into_evaluation()
    }

    /// Deals with a node whose inputs are all dealt with, then with those users
    /// of it that became ready. A node that waits for an equal one is settled
    /// together with that one.
    fn visit<'s>(&'s self, node: usize, scope: &rayon::Scope<'s>) {
        let (prepared, arguments) = match self.attempt(node) {
            Attempt::Ended(done) => return self.settle_reused(node, done, scope),
            Attempt::Waits => return,
            Attempt::Needs(lost) => return self.after_revival(Task::Visit(node), &lost, scope),
            Attempt::Compute(prepared, arguments) => (prepared, arguments),
        };
        let (key, files) = (prepared.key, prepared.paths.clone());
        let (done, values, to_store) = self.compute(node, prepared, arguments);
        let waiting = key.and_then(|key| lock(&self.in_flight).remove(&key));
        for twin in waiting.into_iter().flatten() {
            match (&values, self.prepare(twin)) {
                // Only with the same paths are further files beside them the same.
                (Some(values), Ok(prepared)) if prepared.paths == files => {
                    let entry = Entry {
                        results: done.results.clone(),
                        files: done.files.clone(),
                        warnings: done.run.warnings.clone(),
                        ms: done.run.ms,
                        bytes: done.run.bytes as u64,
                    };
                    let reused = self.reused(twin, &entry, prepared);
                    self.settle(twin, reused, Some(values), scope);
                }
                _ => scope.spawn(move |scope| self.visit(twin, scope)),
            }
        }
        self.settle(node, done, values.as_ref(), scope);
        self.store(to_store);
    }

    /// Ends the node without evaluating it if that is possible.
    fn attempt(&self, node: usize) -> Attempt {
        let state = &self.nodes[node];
        let fresh = self.is_below_fresh(node);
        let ended = |outcome| Attempt::Ended(self.ended(node, outcome, fresh));
        let outcomes: Vec<Outcome> = state
            .inputs
            .iter()
            .map(|&input| self.done(input).run.outcome)
            .collect();
        if self.is_cancelled() || outcomes.contains(&Outcome::Skipped) {
            return ended(Outcome::Skipped);
        }
        if outcomes.iter().any(|outcome| !outcome.is_done()) {
            return ended(Outcome::Blocked);
        }
        let unready = |unready| match unready {
            Unready::Lost(lost) => Attempt::Needs(lost),
            Unready::Gone => ended(Outcome::Blocked),
            Unready::Wrong(error) => Attempt::Ended(self.refused(node, error, fresh)),
        };
        let prepared = match self.prepare(node) {
            Ok(prepared) => prepared,
            Err(error) => return unready(error),
        };
        if let Some(entry) = self.look_up(&prepared) {
            return Attempt::Ended(self.reused(node, &entry, prepared));
        }
        let arguments = match self.arguments(node) {
            Ok(arguments) => arguments,
            Err(error) => return unready(error),
        };
        let Some(key) = prepared.key else {
            return Attempt::Compute(prepared, arguments);
        };
        let mut in_flight = lock(&self.in_flight);
        match in_flight.get_mut(&key) {
            Some(waiting) => {
                waiting.push(node);
                Attempt::Waits
            }
            None => {
                in_flight.insert(key, Vec::new());
                Attempt::Compute(prepared, arguments)
            }
        }
    }

    /// Whether anything the node takes was computed in this run.
    fn is_below_fresh(&self, node: usize) -> bool {
        self.nodes[node]
            .inputs
            .iter()
            .any(|&input| self.done(input).fresh)
    }

    /// Records how a node ended that was not evaluated, and sees to the values
    /// that are wanted of it.
    fn settle_reused<'s>(&'s self, node: usize, done: Done, scope: &rayon::Scope<'s>) {
        let found = done.run.outcome.is_done();
        self.settle(node, done, None, scope);
        if found {
            self.load_wanted(node, scope);
            if self.is_verified(node) {
                self.start_revival(node, None, scope);
            }
        }
    }

    /// Records how a node ended and starts users that became ready.
    fn settle<'s>(
        &'s self,
        node: usize,
        done: Done,
        values: Option<&Values>,
        scope: &rayon::Scope<'s>,
    ) {
        let state = &self.nodes[node];
        self.observer.finished(node, &done.run);
        let kept = state.open_users.load(Ordering::Acquire) > 0 || self.is_wanted(node);
        if let Some(values) = values.filter(|_| kept) {
            *lock(&state.values) = values.iter().cloned().map(Some).collect();
            for result in self.wanted_of(node) {
                self.observer.found(result, &values[result.result]);
            }
        }
        *lock(&state.done) = Some(Arc::new(done));
        self.release_inputs(node);
        for &user in &state.users {
            if self.nodes[user]
                .missing_inputs
                .fetch_sub(1, Ordering::AcqRel)
                == 1
            {
                scope.spawn(move |scope| self.visit(user, scope));
            }
        }
    }

    fn is_wanted(&self, node: usize) -> bool {
        self.wanted_of(node).next().is_some()
    }

    /// The results of a node that were asked for.
    fn wanted_of(&self, node: usize) -> impl Iterator<Item = ResultRef> {
        let wanted = self.wanted.iter().copied();
        wanted.filter(move |result| result.node == node)
    }

    fn is_cancelled(&self) -> bool {
        if !self.cancelled.load(Ordering::Relaxed) && self.observer.cancelled() {
            self.cancelled.store(true, Ordering::Relaxed);
        }
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Whether the node is one of those that are computed to be compared. The
    /// choice is by key, and so the same in every run.
    fn is_verified(&self, node: usize) -> bool {
        let chosen = |key: Digest| {
            let [low, high, ..] = *key.as_bytes();
            u32::from(u16::from_le_bytes([low, high])) * 10_000 / (1 << 16) < self.verified
        };
        self.done(node).key.is_some_and(chosen)
    }

    /// A node that has no values.
    fn ended(&self, node: usize, outcome: Outcome, fresh: bool) -> Done {
        Done {
            run: self.node_run(node, outcome),
            error: None,
            results: Vec::new(),
            provenance: Digest::of(&[]),
            files: Vec::new(),
            fresh,
            parts: Vec::new(),
            key: None,
            time: None,
        }
    }

    /// A node whose inputs are wrong.
    fn refused(&self, node: usize, error: NodeError, fresh: bool) -> Done {
        let mut done = self.ended(node, Outcome::Failed, fresh);
        done.error = Some(error);
        done
    }

    fn node_run(&self, node: usize, outcome: Outcome) -> NodeRun {
        let planned = &self.plan.nodes[node];
        NodeRun {
            name: planned.name.clone(),
            kind: planned.spec.name,
            outcome,
            ms: 0.0,
            bytes: 0,
            warnings: Vec::new(),
        }
    }

    /// Milliseconds since the run began.
    fn now(&self) -> f64 {
        self.begin.elapsed().as_secs_f64() * 1000.0
    }

    fn done(&self, node: usize) -> Arc<Done> {
        // A node is visited only after all its inputs have settled.
        lock(&self.nodes[node].done)
            .clone()
            .expect("inputs settle before their users start")
    }

    /// Milliseconds it took to compute a node, now or when it was cached.
    fn costs(&self, node: usize) -> f64 {
        let done = self.done(node);
        let cached = || self.cache?.entry(done.key?).map(|entry| entry.ms);
        if done.run.outcome == Outcome::Computed {
            done.run.ms
        } else {
            cached().unwrap_or(0.0)
        }
    }

    /// What is known of the node's results; no value is loaded.
    fn look_up(&self, prepared: &Prepared) -> Option<Arc<Entry>> {
        let (cache, key) = (self.cache?, prepared.key?);
        let latest = cache.entry(key)?;
        let now = |file: &FileUse| {
            let path = prepared.paths.get(file.input).map(|path| file.beside(path));
            let content = path.and_then(|path| self.files.digest(&path));
            FileUse {
                content,
                ..file.clone()
            }
        };
        let files: Vec<FileUse> = latest.files.iter().map(now).collect();
        if files == latest.files {
            return Some(latest);
        }
        // They may have been as they are now before.
        let entry = cache.entry(key_with_files(key, &files))?;
        (entry.files == files).then_some(entry)
    }

    fn reused(&self, node: usize, entry: &Entry, prepared: Prepared) -> Done {
        let fresh = self.is_below_fresh(node);
        let outcome = if fresh {
            Outcome::CutOff
        } else {
            Outcome::Cached
        };
        let mut run = self.node_run(node, outcome);
        run.bytes = entry.bytes as usize;
        run.warnings.clone_from(&entry.warnings);
        Done {
            run,
            error: None,
            results: entry.results.clone(),
            provenance: provenance(prepared.provenance, &entry.files),
            files: entry.files.clone(),
            fresh,
            parts: prepared.parts,
            key: prepared.key,
            time: None,
        }
    }
}

/// What a node was made from, with the files that were found only while it was
/// evaluated.
fn provenance(prepared: Digest, files: &[FileUse]) -> Digest {
    if files.is_empty() {
        prepared
    } else {
        key_with_files(prepared, files)
    }
}
