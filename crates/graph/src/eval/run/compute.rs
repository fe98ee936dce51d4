//! Evaluating one node.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use tessgraph_geometry::Monitor;
use tessgraph_geometry::digest::Digest;

use super::prepare::{Prepared, of_result};
use super::state::Done;
use super::{Run, provenance};
use crate::NodeError;
use crate::eval::cache::{Entry, Known, ToStore};
use crate::eval::outcome::{NodeTime, Outcome};
use crate::eval::{Values, guarded};
use crate::node::{Args, EvalCx};
use crate::value::Value;

impl Run<'_> {
    /// Evaluates the node.
    pub(super) fn compute(
        &self,
        node: usize,
        prepared: Prepared,
        arguments: Vec<Option<Value>>,
    ) -> (Done, Option<Values>, Option<ToStore>) {
        let planned = &self.plan.nodes[node];
        let spec = planned.spec;
        self.observer.started(node);
        let (start_ms, start) = (self.now(), Instant::now());
        let thread = rayon::current_thread_index().unwrap_or(0);
        let monitor = NodeMonitor { run: self, node };
        let cx = EvalCx::new(&self.files, &monitor, planned.units, prepared.paths);
        let fed_empty = arguments.iter().flatten().any(is_empty_mesh);
        let result = guarded(spec.name, || (spec.eval)(Args::new(arguments), &cx));
        let (warnings, files) = cx.finish();
        let mut run = self.node_run(node, Outcome::Computed);
        run.warnings = warnings;
        if let Ok(values) = &result
            && run.warnings.is_empty()
            && !fed_empty
            && values.iter().any(is_empty_mesh)
        {
            run.warnings
                .push("the result is a mesh without faces".to_owned());
        }
        let mut done = Done {
            run,
            error: None,
            results: Vec::new(),
            provenance: provenance(prepared.provenance, &files),
            files: files.clone(),
            fresh: true,
            parts: prepared.parts,
            key: prepared.key,
            time: None,
        };
        let (mut values, mut to_store) = (None, None);
        match result {
            Ok(computed) => {
                let computed: Values = match self.cache {
                    Some(cache) => computed.into_iter().map(|v| cache.shared(v)).collect(),
                    None => computed.into(),
                };
                done.run.bytes = Value::List(Arc::clone(&computed)).byte_size();
                done.results = self.known(&computed, done.provenance);
                let entry = Entry {
                    results: done.results.clone(),
                    files,
                    warnings: done.run.warnings.clone(),
                    ms: start.elapsed().as_secs_f64() * 1000.0,
                    bytes: done.run.bytes as u64,
                };
                to_store = self.keep(prepared.key, entry, &computed);
                values = Some(computed);
            }
            Err(error) => self.fail(&mut done, error),
        }
        done.run.ms = start.elapsed().as_secs_f64() * 1000.0;
        done.time = Some(NodeTime {
            start_ms,
            end_ms: self.now(),
            thread,
        });
        (done, values, to_store)
    }

    /// What is known about each result of a node with this provenance.
    fn known(&self, computed: &Values, provenance: Digest) -> Vec<Known> {
        let known = |(index, value)| match self.cache {
            Some(_) => Known::new(value),
            None => Known::unread(value, of_result(provenance, index)),
        };
        computed.iter().enumerate().map(known).collect()
    }

    fn fail(&self, done: &mut Done, error: NodeError) {
        if error.is_cancelled() {
            self.cancelled.store(true, Ordering::Relaxed);
            done.run.outcome = Outcome::Skipped;
        } else {
            done.run.outcome = Outcome::Failed;
            done.error = Some(error);
        }
    }

    /// Keeps results in memory, and says what is to be written to disk once
    /// those who wait for the node have been started.
    fn keep(&self, key: Option<Digest>, entry: Entry, values: &Values) -> Option<ToStore> {
        let (cache, key) = (self.cache?, key?);
        let entry = Arc::new(entry);
        cache.insert(key, &entry, values);
        Some(ToStore {
            key,
            entry,
            values: Arc::clone(values),
        })
    }

    /// Has results written to the cache's folder.
    pub(super) fn store(&self, work: Option<ToStore>) {
        if let (Some(work), Some(cache)) = (work, self.cache) {
            cache.store(work);
        }
    }
}

fn is_empty_mesh(value: &Value) -> bool {
    matches!(value, Value::Mesh(mesh) if mesh.face_count() == 0)
}

/// Lends a node the run's cancellation and passes its progress on.
struct NodeMonitor<'a> {
    run: &'a Run<'a>,
    node: usize,
}

impl Monitor for NodeMonitor<'_> {
    fn cancelled(&self) -> bool {
        self.run.is_cancelled()
    }

    fn progress(&self, done: u64, total: u64) {
        self.run.observer.progress(self.node, done, total);
    }

    fn memory_left(&self) -> Option<u64> {
        self.run.observer.memory_left()
    }
}
