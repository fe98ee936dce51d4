//! From the states of all nodes to the evaluation's result.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::Run;
use super::state::{Done, lock};
use crate::diagnostic::{Diagnostic, Severity};
use crate::eval::outcome::{Evaluation, NodeRun, Outcome, Wanted};
use crate::plan::ResultRef;

impl Run<'_> {
    pub(super) fn into_evaluation(self) -> Evaluation {
        let (mut runs, mut keys, mut diagnostics) = (Vec::new(), Vec::new(), Vec::new());
        let mut times = Vec::new();
        for (node, state) in self.nodes.iter().enumerate() {
            let done = lock(&state.done).clone();
            diagnostics.extend(done.iter().flat_map(|done| self.diagnostics(node, done)));
            diagnostics.extend(self.mismatch(node));
            runs.push(match &done {
                Some(done) => done.run.clone(),
                None => self.node_run(node, Outcome::Skipped),
            });
            times.push(done.as_ref().and_then(|done| done.time));
            let keyed = done.filter(|done| !done.parts.is_empty());
            keys.push(keyed.map(|done| (done.key, done.parts.clone())));
        }
        self.settle_reuse(&mut runs);
        let wanted = self.wanted.iter().copied();
        let wanted: BTreeMap<ResultRef, Wanted> = wanted
            .filter(|result| runs[result.node].outcome.is_done())
            .map(|result| (result, self.wanted_result(result)))
            .collect();
        Evaluation {
            diagnostics,
            cancelled: self.cancelled.load(Ordering::Relaxed),
            wanted,
            keys,
            nodes: runs,
            times,
            cache: self.shared.clone(),
        }
    }

    fn wanted_result(&self, result: ResultRef) -> Wanted {
        let done = self.done(result.node);
        let known = &done.results[result.result];
        let held = lock(&self.nodes[result.node].values)[result.result].clone();
        let value = held.or_else(|| known.small.clone());
        Wanted::new(known.identity, self.provenance(result), done.run.ms, value)
    }

    /// Tells `cached` from `cut_off`: a value that was lost may have been
    /// computed again after users of it had been dealt with.
    fn settle_reuse(&self, runs: &mut [NodeRun]) {
        let mut fresh = vec![false; runs.len()];
        for node in 0..runs.len() {
            let below = self.nodes[node].inputs.iter().any(|&input| fresh[input]);
            fresh[node] = below || runs[node].outcome == Outcome::Computed;
            match runs[node].outcome {
                Outcome::Cached if below => runs[node].outcome = Outcome::CutOff,
                Outcome::CutOff if !below => runs[node].outcome = Outcome::Cached,
                _ => {}
            }
        }
    }

    /// A node whose results differ from those the cache has for it.
    fn mismatch(&self, node: usize) -> Option<Diagnostic> {
        let different = lock(&self.mismatches).get(&node)?.clone();
        let planned = &self.plan.nodes[node];
        let names = different
            .iter()
            .filter_map(|&result| planned.spec.outputs.get(result));
        let names: Vec<String> = names.map(|spec| format!("`{}`", spec.name)).collect();
        let message = format!(
            "`{}` gave another {} than the cache has for the same inputs",
            planned.name,
            names.join(", "),
        );
        let span = planned.span.clone();
        let mut diagnostic =
            Diagnostic::error("cache_mismatch", &planned.source, span, &message, "")
                .with_places(planned.included.iter().cloned())
                .with_node(&planned.name);
        diagnostic.help = Some(format!(
            "{} is not pure, or its version was not raised; please report it",
            planned.spec.name
        ));
        Some(diagnostic)
    }

    /// A node's error and warnings, shown at its place in the text.
    fn diagnostics(&self, node: usize, done: &Arc<Done>) -> Vec<Diagnostic> {
        let planned = &self.plan.nodes[node];
        let source = &planned.source;
        let at = |span, code, message: &str| {
            Diagnostic::error(code, source, span, message, "")
                .with_places(planned.included.iter().cloned())
                .with_node(&planned.name)
        };
        let warnings = done.run.warnings.iter().map(|message| {
            let mut warning = at(planned.span.clone(), "node_warning", message);
            warning.severity = Severity::Warning;
            warning
        });
        let error = done.error.as_ref().map(|error| {
            let input = planned
                .spec
                .inputs
                .iter()
                .position(|spec| Some(spec.name) == error.input());
            let span = input.and_then(|index| planned.inputs[index].span.clone());
            let message = format!("`{}`: {}", planned.name, error.message());
            let mut diagnostic = at(
                span.unwrap_or(planned.span.clone()),
                "node_failed",
                &message,
            );
            diagnostic.help = error.help().map(str::to_owned);
            diagnostic
        });
        warnings.chain(error).collect()
    }
}
