//! `run`: makes the outputs of a graph.

mod args;
mod session;
mod told;

pub(crate) use args::{ReportFormat, RunArgs};
pub(crate) use session::{Control, Finished, Ran, Session, Stopped};
pub(crate) use told::{closing, details};

use super::Context;
use crate::interrupt::{self, INTERRUPTED};
use crate::watch::{Mailbox, Message, watch};

/// Carries the command out.
pub(crate) fn run(args: &RunArgs, cx: &mut Context<'_, '_>) -> u8 {
    let mailbox = Mailbox::new();
    let post = mailbox.post();
    interrupt::on_request(move || {
        // Without a watcher nobody waits for it.
        let _ = post.send(Message::Stop);
    });
    run_with(args, &mailbox, cx)
}

/// [`run`] with a mailbox of the caller's, to end watching.
pub(crate) fn run_with(args: &RunArgs, mailbox: &Mailbox, cx: &mut Context<'_, '_>) -> u8 {
    let session = match Session::new(args, cx.registry, cx.cache.as_deref()) {
        Ok(session) => session,
        Err(stopped) => return details(args, &Ran::never(stopped), None, cx),
    };
    if args.watch {
        return watch(args, &session, mailbox, cx);
    }
    let live = cx.console.is_live() && args.report == ReportFormat::Human;
    let ran = session.run(live, &Control::default());
    let status = details(args, &ran, session.close(), cx);
    let has_begun = !matches!(ran.result, Err(Stopped::Before { .. }));
    if has_begun && status != INTERRUPTED {
        closing(args, &ran, cx);
    }
    status
}
