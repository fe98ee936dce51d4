//! What is shown of a run.

use tessgraph_graph::eval::KeyChange;

use super::session::{Finished, Ran, Stopped};
use super::{ReportFormat, RunArgs};
use crate::commands::{Context, FAILED, OK, status};
use crate::diagnostics::{error_count, print, without_place};
use crate::interrupt::{self, INTERRUPTED};
use crate::report::{RunReport, human, json};
use crate::text::{Align, printable, table};

/// Shows what a run came to, and gives the exit status.
pub(super) fn tell(args: &RunArgs, ran: Ran, cx: &mut Context<'_, '_>) -> u8 {
    let Ran { result, ms } = ran;
    match result {
        Ok(finished) => finish(args, &finished, ms, cx),
        Err(Stopped::Before {
            status,
            code,
            message,
            help,
        }) => cx.fail(status, code, message, help),
        Err(Stopped::Graph(diagnostics)) => {
            print(cx.console, &diagnostics);
            if args.report == ReportFormat::Json {
                cx.console.data(&json(&RunReport {
                    ok: false,
                    ms,
                    nodes: &[],
                    peaks: &[],
                    outputs: &[],
                }));
            }
            status(&diagnostics)
        }
    }
}

fn finish(args: &RunArgs, finished: &Finished, ms: f64, cx: &mut Context<'_, '_>) -> u8 {
    let evaluation = &finished.evaluation;
    print(cx.console, &evaluation.diagnostics);
    print(cx.console, &finished.diagnostics);
    if evaluation.cancelled || interrupt::is_requested() {
        let stopped = without_place("interrupted", "", "interrupted; nothing more was written");
        print(cx.console, &[stopped]);
        return INTERRUPTED;
    }
    for output in &finished.outputs {
        for lost in &output.lost {
            let note = format!("note: {}: {lost}\n", output.shown);
            cx.console.note(&printable(&note));
        }
    }
    if let Some(warning) = &finished.cache_warning {
        cx.console.note(&printable(&format!("note: {warning}\n")));
    }
    if args.explain {
        cx.console.note(&printable(&explained(&finished.changes)));
    }
    let ok = evaluation.is_ok() && error_count(&finished.diagnostics) == 0;
    let report = RunReport {
        ok,
        ms,
        nodes: &evaluation.nodes,
        peaks: &finished.peaks,
        outputs: &finished.outputs,
    };
    match args.report {
        ReportFormat::Human => cx.console.note(&human(&report)),
        ReportFormat::Json => cx.console.data(&json(&report)),
    }
    if ok { OK } else { FAILED }
}

/// What has changed since the last run, a line for each input.
fn explained(changes: &[KeyChange]) -> String {
    if changes.is_empty() {
        return "nothing has changed since the last run\n\n".to_owned();
    }
    let row = |change: &KeyChange| {
        let from = match change.from.as_slice() {
            [] => String::new(),
            nodes => format!("from {}", nodes.join(", ")),
        };
        let place = format!("{}.{}", change.node, change.input);
        vec![place, format!("{} -> {}", change.old, change.new), from]
    };
    let rows: Vec<_> = changes.iter().map(row).collect();
    format!(
        "{}\n",
        table(&rows, &[Align::Left, Align::Left, Align::Left])
    )
}
