//! `run --watch`: makes the outputs again.

use super::{Cause, Job, Mailbox, Watched, Work, follow, resume, status};
use crate::commands::run::{
    Control, Ran, ReportFormat, RunArgs, Session, Stopped, closing, details,
};
use crate::commands::{Context, OK, USAGE};
use crate::text::{count, printable};

/// Runs the graph now and after every change, until the mailbox says to stop.
pub(crate) fn watch<'a>(
    args: &'a RunArgs,
    session: &'a Session<'a>,
    mailbox: &Mailbox,
    cx: &mut Context<'_, '_>,
) -> u8 {
    let live = cx.console.is_live() && args.report == ReportFormat::Human;
    let mut rerun = Rerun {
        args,
        session,
        live,
        is_first: args.resume.is_none(),
        warned: false,
        cx,
    };
    resume::arm(Vec::new(), Vec::new());
    if args.resume.is_some() {
        rerun.tell("waiting for a change of the graph\n");
        if args.report == ReportFormat::Json {
            // The report of the run that could not end by itself.
            closing(args, &Ran::never(Stopped::Graph(Vec::new())), rerun.cx);
        }
    }
    let watched = Watched {
        graph: &args.graph,
        allowed: &args.engine.allow,
        poll: args.poll,
    };
    // What was saved while the program began anew was told to nobody.
    let waits = || { args.resume }.is_some_and(|began| resume::waits(&args.graph, began));
    follow(&watched, waits, mailbox, rerun)
}

/// Making the outputs whenever something has changed.
struct Rerun<'a, 'x, 'y, 'z> {
    args: &'a RunArgs,
    session: &'a Session<'a>,
    /// Whether a bar shows progress.
    live: bool,
    is_first: bool,
    /// Whether the warning about the cache was shown.
    warned: bool,
    cx: &'x mut Context<'y, 'z>,
}

impl Rerun<'_, '_, '_, '_> {
    /// A line for people.
    fn tell(&mut self, line: &str) {
        if self.args.report == ReportFormat::Human {
            self.cx.console.note(line);
        }
    }
}

impl<'a> Work<'a> for Rerun<'a, '_, '_, '_> {
    type Ran = Ran;

    fn begin(&mut self, _: &Cause) -> Job<'a, Ran> {
        let (session, live) = (self.session, self.live);
        Box::new(move |control: &Control| session.run(live, control))
    }

    fn is_stopped(ran: &Ran) -> bool {
        matches!(&ran.result, Ok(finished) if finished.stopped)
    }

    fn stopped(&mut self, cause: &Cause, ran: Ran) -> bool {
        self.tell(&status::stopped(cause, &ran));
        true
    }

    fn ended(&mut self, cause: &Cause, ran: Ran, files: usize) -> Option<u8> {
        let warning = self.session.cache_warning().filter(|_| !self.warned);
        self.warned |= warning.is_some();
        let status = details(self.args, &ran, warning, self.cx);
        if status == USAGE && self.is_first {
            return Some(status);
        }
        self.tell(&status::status(cause, &ran));
        if self.args.report == ReportFormat::Json {
            closing(self.args, &ran, self.cx);
        }
        if self.is_first {
            let files = count(files, "file");
            self.tell(&format!("watching {files}; Ctrl-C ends\n"));
            self.is_first = false;
        }
        // Nobody reads the reports any more.
        self.cx.console.has_lost_out().then_some(OK)
    }

    fn deaf(&mut self, reason: &str) {
        let note = format!("note: changes are looked for, not told: {reason}\n");
        self.cx.console.note(&printable(&note));
    }
}
