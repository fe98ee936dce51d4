//! The command line of tessgraph, callable from tests.
//!
//! [`run`] takes arguments and two writers; [`main`] is the same on the real
//! terminal. This is the only crate of the project that prints.

mod args;
mod atomic;
mod commands;
mod console;
mod diagnostics;
mod graph_file;
mod interrupt;
mod json;
mod memory;
mod mesh_file;
mod outputs;
mod picture;
mod places;
mod process;
mod progress;
mod report;
mod text;
mod timings;
mod watch;
mod world;

#[cfg(test)]
mod tests;

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

use clap::Parser as _;
use tessgraph_graph::node::NodeSpec;

use args::{Cli, Command};
use commands::{Context, FAILED, OK, USAGE};
use console::Console;

pub use memory::MemoryGuard;
pub use process::main;

/// Carries out a command; `args` begin with the name of the program.
///
/// Data that was asked for goes to `out`, everything else to `err`, both as
/// plain text. Results are kept in a folder only where `--cache` names one.
/// The result is the exit status: 0 all done, 1 the graph has
/// errors or a node failed, 2 wrong usage, 130 interrupted.
///
/// ```
/// let (mut out, mut err) = (Vec::new(), Vec::new());
/// let status = tessgraph::run(["tessgraph", "--version"], &mut out, &mut err);
/// assert_eq!(status, 0);
/// assert!(out.starts_with(b"tessgraph "));
/// ```
pub fn run<A>(args: A, out: &mut dyn Write, err: &mut dyn Write) -> u8
where
    A: IntoIterator,
    A::Item: Into<OsString> + Clone,
{
    let mut console = Console::plain(out, err);
    dispatch(args, &mut console, tessgraph_nodes::NODES, None)
}

/// [`run`] with any streams, any nodes and a folder that keeps results.
fn dispatch<A>(
    args: A,
    console: &mut Console<'_>,
    registry: &'static [NodeSpec],
    cache: Option<PathBuf>,
) -> u8
where
    A: IntoIterator,
    A::Item: Into<OsString> + Clone,
{
    let cli = match Cli::try_parse_from(args) {
        Ok(cli) => cli,
        Err(error) => return usage(&error, console),
    };
    let mut cx = Context {
        console,
        registry,
        cache,
    };
    let status = match &cli.command {
        Command::Run(args) => commands::run::run(args, &mut cx),
        Command::View(args) => commands::view::view(args, &mut cx),
        Command::Study(args) => commands::study::study(args, &mut cx),
        Command::Check(args) => commands::check::check(args, &mut cx),
        Command::Nodes(args) => commands::nodes::nodes(args, &mut cx),
        Command::Info(args) => commands::info::info(args, &mut cx),
        Command::Graph(args) => commands::graph::graph(args, &mut cx),
        Command::Completions(args) => commands::completions::completions(args, &mut cx),
        Command::Man(args) => commands::completions::man(args, &mut cx),
        Command::Cache(args) => commands::cache::cache(args, &mut cx),
        Command::New(args) => commands::new::new(args, &mut cx),
        Command::Render(args) => commands::render::render(args, &mut cx),
    };
    if let Some(failure) = console.out_failure() {
        let message = format!("error: cannot write to stdout: {failure}\n");
        console.note(&message);
        return status.max(FAILED);
    }
    status
}

/// Shows the help that was asked for, or what is wrong with the arguments.
fn usage(error: &clap::Error, console: &mut Console<'_>) -> u8 {
    let text = error.render();
    let text = if console.is_styled() {
        text.ansi().to_string()
    } else {
        text.to_string()
    };
    if error.use_stderr() {
        console.note(&text);
        USAGE
    } else {
        console.data(&text);
        OK
    }
}
