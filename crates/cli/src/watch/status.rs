//! One line for each run.

use tessgraph_graph::Severity;

use super::Cause;
use crate::commands::run::{Finished, Ran, Stopped};
use crate::outputs::WrittenOutput;
use crate::report::{RunReport, summary};
use crate::text::{count, printable, time_text};

/// What became of a run that `cause` was the reason for: its outcomes, its
/// milliseconds, and which outputs are new.
pub(super) fn status(cause: &Cause, ran: &Ran) -> String {
    let cause = cause.text();
    match &ran.result {
        Ok(finished) => {
            let summary = summary(&RunReport {
                ok: finished.is_ok(),
                ms: ran.ms,
                nodes: &finished.evaluation.nodes,
                peaks: &[],
                outputs: &[],
            });
            format!("{cause}: {summary}; {}\n", written(finished))
        }
        Err(stopped) => {
            let errors = match stopped {
                Stopped::Graph(diagnostics) => diagnostics
                    .iter()
                    .filter(|diagnostic| diagnostic.severity == Severity::Error)
                    .count(),
                Stopped::Before { .. } => 1,
            };
            let (errors, time) = (count(errors, "error"), time_text(ran.ms));
            format!("{cause}: {errors} in {time}; the outputs stay as they are\n")
        }
    }
}

/// A run was stopped because `cause` changed.
pub(super) fn stopped(cause: &Cause, ran: &Ran) -> String {
    let time = time_text(ran.ms);
    format!("{}: changed, stopped after {time}\n", cause.text())
}

/// "wrote out/a.glb, out/a.json and 2 more".
fn written(finished: &Finished) -> String {
    let new = finished.outputs.iter().filter(|output| output.changed);
    let new: Vec<&WrittenOutput> = new.collect();
    let names: Vec<_> = new
        .iter()
        .take(2)
        .map(|output| printable(&output.shown))
        .collect();
    match (names.len(), new.len()) {
        (0, _) => "no output changed".to_owned(),
        (few, all) if few == all => format!("wrote {}", names.join(", ")),
        (few, all) => format!("wrote {} and {} more", names.join(", "), all - few),
    }
}
