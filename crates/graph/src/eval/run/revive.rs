//! Values on demand: loading them, and computing again those that are lost.
//!
//! A node whose key is known has digests only. Its values are loaded when a
//! node that is computed, or an output, needs them. A value that is neither in
//! memory nor whole on disk is computed again, and with it whatever that needs.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::Run;
use super::state::{Done, Revival, Task, Unready, lock};
use crate::eval::outcome::Outcome;
use crate::plan::ResultRef;
use crate::value::Value;

impl Run<'_> {
    /// A value that has been loaded.
    pub(super) fn value(&self, result: ResultRef) -> Value {
        let value = self.find(result);
        // Every value is loaded before it is used, and kept until the last user
        // has finished.
        value.expect("values outlive their users")
    }

    /// The value if it is in memory.
    fn find(&self, result: ResultRef) -> Option<Value> {
        let held = lock(&self.nodes[result.node].values)[result.result].clone();
        held.or_else(|| self.done(result.node).results[result.result].small.clone())
    }

    /// Loads the values of these results.
    pub(super) fn load(&self, results: &[ResultRef]) -> Result<(), Unready> {
        let mut lost = Vec::new();
        for &result in results {
            let done = self.done(result.node);
            if !done.run.outcome.is_done() {
                return Err(Unready::Gone);
            }
            if self.find(result).is_some() {
                continue;
            }
            let identity = done.results[result.result].identity;
            let cost = self.costs(result.node);
            match self.cache.and_then(|cache| cache.value(identity, cost)) {
                Some(value) => {
                    lock(&self.nodes[result.node].values)[result.result] = Some(value);
                }
                None => lost.push(result.node),
            }
        }
        lost.dedup();
        if lost.is_empty() {
            Ok(())
        } else {
            lost.sort_unstable();
            lost.dedup();
            Err(Unready::Lost(lost))
        }
    }

    /// Computes the `lost` nodes again and then does `task`.
    pub(super) fn after_revival<'s>(
        &'s self,
        task: Task,
        lost: &[usize],
        scope: &rayon::Scope<'s>,
    ) {
        let awaited = &self.nodes[task.node()].awaited;
        // One more than there are, so that the task starts only when all are asked for.
        awaited.store(lost.len() + 1, Ordering::Release);
        for &node in lost {
            self.start_revival(node, Some(task), scope);
        }
        self.wake(task, scope);
    }

    /// Computes a node again, unless that has begun; `then` waits for it.
    pub(super) fn start_revival<'s>(
        &'s self,
        node: usize,
        then: Option<Task>,
        scope: &rayon::Scope<'s>,
    ) {
        let mut revival = lock(&self.nodes[node].revival);
        match &mut *revival {
            Revival::Running(waiting) => waiting.extend(then),
            Revival::Idle => {
                *revival = Revival::Running(then.into_iter().collect());
                self.hold_inputs(node);
                scope.spawn(move |scope| self.revive(node, scope));
            }
        }
    }

    /// Counts one awaited node less, and starts the task with the last.
    fn wake<'s>(&'s self, task: Task, scope: &rayon::Scope<'s>) {
        let awaited = &self.nodes[task.node()].awaited;
        if awaited.fetch_sub(1, Ordering::AcqRel) == 1 {
            scope.spawn(move |scope| match task {
                Task::Visit(node) => self.visit(node, scope),
                Task::Revive(node) => self.revive(node, scope),
            });
        }
    }

    /// Computes a node whose results were found.
    pub(super) fn revive<'s>(&'s self, node: usize, scope: &rayon::Scope<'s>) {
        if self.is_cancelled() {
            self.replace(node, Outcome::Skipped);
            return self.end_revival(node, scope);
        }
        let ready = self
            .prepare(node)
            .and_then(|prepared| Ok((prepared, self.arguments(node)?)));
        match ready {
            Err(Unready::Lost(lost)) => self.after_revival(Task::Revive(node), &lost, scope),
            // What it takes could be had once, and now cannot: a file of the
            // cache is gone, and computing its value again failed.
            Err(_) => {
                self.replace(node, Outcome::Blocked);
                self.end_revival(node, scope);
            }
            Ok((prepared, arguments)) => {
                let (done, values, to_store) = self.compute(node, prepared, arguments);
                let same = self.compare(node, &done);
                if let Some(values) = values {
                    *lock(&self.nodes[node].values) = values.iter().cloned().map(Some).collect();
                }
                let verified = same && self.is_verified(node);
                self.observer.finished(node, &done.run);
                if !verified {
                    *lock(&self.nodes[node].done) = Some(Arc::new(done));
                }
                self.end_revival(node, scope);
                self.store(to_store);
            }
        }
    }

    /// Notes if a node gave other results than the cache has for it.
    fn compare(&self, node: usize, done: &Done) -> bool {
        if !done.run.outcome.is_done() {
            return false;
        }
        let before = self.done(node);
        let pairs = before.results.iter().zip(&done.results);
        let different: Vec<usize> = pairs
            .enumerate()
            .filter(|(_, (before, now))| before.identity != now.identity)
            .map(|(index, _)| index)
            .collect();
        if different.is_empty() && before.results.len() == done.results.len() {
            return true;
        }
        lock(&self.mismatches).insert(node, different);
        false
    }

    /// Ends a node that could not be computed again.
    fn replace(&self, node: usize, outcome: Outcome) {
        let mut ended = self.ended(node, outcome, true);
        ended.provenance = self.done(node).provenance;
        self.observer.finished(node, &ended.run);
        *lock(&self.nodes[node].done) = Some(Arc::new(ended));
    }

    fn end_revival<'s>(&'s self, node: usize, scope: &rayon::Scope<'s>) {
        let revival = std::mem::take(&mut *lock(&self.nodes[node].revival));
        if let Revival::Running(waiting) = revival {
            waiting.into_iter().for_each(|task| self.wake(task, scope));
        }
        self.release_inputs(node);
        if self.nodes[node].open_users.load(Ordering::Acquire) == 0 {
            self.drop_values(node);
        }
    }

    /// Keeps the values of the node's inputs until [`Run::release_inputs`].
    fn hold_inputs(&self, node: usize) {
        for &input in &self.nodes[node].inputs {
            self.nodes[input].open_users.fetch_add(1, Ordering::AcqRel);
        }
    }

    /// One user less for each of the node's inputs; the last one lets go.
    pub(super) fn release_inputs(&self, node: usize) {
        for &input in &self.nodes[node].inputs {
            let open = &self.nodes[input].open_users;
            if open.fetch_sub(1, Ordering::AcqRel) == 1 {
                self.drop_values(input);
            }
        }
    }

    fn drop_values(&self, node: usize) {
        if !self.is_wanted(node) {
            lock(&self.nodes[node].values).fill(None);
        }
    }

    /// Loads those values of a finished node that outputs need.
    pub(super) fn load_wanted<'s>(&'s self, node: usize, scope: &rayon::Scope<'s>) {
        let needed: Vec<ResultRef> = self
            .wanted_of(node)
            .filter(|&result| {
                let (identity, provenance) = (self.identity(result), self.provenance(result));
                self.observer.needs(result, identity, provenance)
            })
            .collect();
        match self.load(&needed) {
            Ok(()) => {
                for &result in &needed {
                    self.observer.found(result, &self.value(result));
                }
            }
            Err(Unready::Lost(_)) => self.start_revival(node, None, scope),
            Err(_) => {}
        }
    }
}
