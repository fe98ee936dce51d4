//! `run`: makes the outputs of a graph.

mod args;
mod session;
mod told;

pub(crate) use args::{ReportFormat, RunArgs};

use super::Context;
use session::{Ran, Session};

/// Carries the command out.
pub(crate) fn run(args: &RunArgs, cx: &mut Context<'_, '_>) -> u8 {
    let ran = match Session::new(args, cx.registry, cx.cache.as_deref()) {
        Ok(session) => session.run(cx.console.is_live() && args.report == ReportFormat::Human),
        Err(stopped) => Ran::never(stopped),
    };
    told::tell(args, ran, cx)
}
