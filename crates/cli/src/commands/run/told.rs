//! What is shown of a run.

use tessgraph_graph::eval::KeyChange;

use super::session::{Finished, Ran, Stopped};
use super::{ReportFormat, RunArgs};
use crate::commands::{Context, FAILED, OK, status};
use crate::diagnostics::{print, without_place};
use crate::interrupt::INTERRUPTED;
use crate::report::{RunReport, human, json};
use crate::text::{Align, printable, table};

/// Shows everything a person has to know of a run, except its closing report,
/// and gives the exit status. `warning` is about the cache.
pub(crate) fn details(
    args: &RunArgs,
    ran: &Ran,
    warning: Option<String>,
    cx: &mut Context<'_, '_>,
) -> u8 {
    match &ran.result {
        Ok(finished) => notes(args, finished, warning, cx),
        Err(Stopped::Before {
            status,
            code,
            message,
            help,
        }) => cx.fail(*status, code, message, help.clone()),
        Err(Stopped::Graph(diagnostics)) => {
            print(cx.console, diagnostics);
            status(diagnostics)
        }
    }
}

fn notes(
    args: &RunArgs,
    finished: &Finished,
    warning: Option<String>,
    cx: &mut Context<'_, '_>,
) -> u8 {
    print(cx.console, &finished.evaluation.diagnostics);
    print(cx.console, &finished.diagnostics);
    if finished.stopped {
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
    if let Some(warning) = warning {
        cx.console.note(&printable(&format!("note: {warning}\n")));
    }
    if args.explain {
        cx.console.note(&printable(&explained(&finished.changes)));
    }
    if finished.is_ok() { OK } else { FAILED }
}

/// Shows the report of a run in the form that was asked for; people are told
/// nothing more of one that did not begin.
pub(crate) fn closing(args: &RunArgs, ran: &Ran, cx: &mut Context<'_, '_>) {
    let report = match &ran.result {
        Ok(finished) => RunReport {
            ok: finished.is_ok(),
            ms: ran.ms,
            nodes: &finished.evaluation.nodes,
            peaks: &finished.peaks,
            outputs: &finished.outputs,
        },
        Err(_) => RunReport {
            ok: false,
            ms: ran.ms,
            nodes: &[],
            peaks: &[],
            outputs: &[],
        },
    };
    match (args.report, &ran.result) {
        (ReportFormat::Json, _) => cx.console.data(&json(&report)),
        (ReportFormat::Human, Ok(_)) => cx.console.note(&human(&report)),
        (ReportFormat::Human, Err(_)) => {}
    }
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
