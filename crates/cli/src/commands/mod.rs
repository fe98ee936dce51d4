//! The subcommands, one file each.

pub(crate) mod cache;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod engine;
pub(crate) mod graph;
pub(crate) mod info;
pub(crate) mod new;
pub(crate) mod nodes;
pub(crate) mod render;
pub(crate) mod run;
pub(crate) mod study;
pub(crate) mod view;

use std::path::PathBuf;

use tessgraph_graph::check::WRONG_SETTING;
use tessgraph_graph::node::NodeSpec;
use tessgraph_graph::{Diagnostic, Severity};

use crate::console::Console;
use crate::diagnostics::{print, without_place};

/// All that was asked for was done.
pub(crate) const OK: u8 = 0;
/// The graph has errors, a node failed, or a file could not be read or written.
pub(crate) const FAILED: u8 = 1;
/// The command was used wrongly.
pub(crate) const USAGE: u8 = 2;

/// The exit status for these diagnostics: where only values from the command
/// line are wrong, it was used wrongly.
pub(crate) fn status(diagnostics: &[Diagnostic]) -> u8 {
    let mut errors = diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.severity == Severity::Error)
        .peekable();
    if errors.peek().is_none() {
        OK
    } else if errors.all(|error| error.code == WRONG_SETTING) {
        USAGE
    } else {
        FAILED
    }
}

/// What every command is given.
pub(crate) struct Context<'a, 'c> {
    /// Where text goes.
    pub(crate) console: &'a mut Console<'c>,
    /// The nodes there are.
    pub(crate) registry: &'static [NodeSpec],
    /// The folder results are kept in unless another one is named; none when
    /// the program is called as a library.
    pub(crate) cache: Option<PathBuf>,
}

impl Context<'_, '_> {
    /// Shows an error that has no place in a graph; gives `status` back.
    pub(crate) fn fail(
        &mut self,
        status: u8,
        code: &'static str,
        message: impl Into<String>,
        help: Option<String>,
    ) -> u8 {
        let mut diagnostic = without_place(code, "", message);
        diagnostic.help = help;
        print(self.console, &[diagnostic]);
        status
    }
}
