//! `completions` and `man`: what shells and readers of manuals want.

use clap::{Args, CommandFactory as _};
use clap_complete::Shell;

use super::{Context, FAILED, OK};
use crate::args::Cli;

/// Prints completions for a shell, to be put where it looks for them
#[derive(Debug, Args)]
#[command(after_help = "For bash: tessgraph completions bash > \
                        ~/.local/share/bash-completion/completions/tessgraph")]
pub(crate) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Prints the manual page
#[derive(Debug, Args)]
#[command(after_help = "To read it: tessgraph man | man -l -")]
pub(crate) struct ManArgs {
    /// The command whose page is wanted, such as run; the whole program's if left out
    command: Option<String>,
}

/// Carries `completions` out.
pub(crate) fn completions(args: &CompletionsArgs, cx: &mut Context<'_, '_>) -> u8 {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "tessgraph", &mut text);
    cx.console.data(&String::from_utf8_lossy(&text));
    OK
}

/// Carries `man` out.
pub(crate) fn man(args: &ManArgs, cx: &mut Context<'_, '_>) -> u8 {
    let mut program = Cli::command();
    // Gives the subcommands their full names, "tessgraph-run".
    program.build();
    let page = match &args.command {
        None => program,
        Some(name) => match program.find_subcommand(name) {
            Some(found) => found.clone(),
            None => {
                let names = program.get_subcommands().map(clap::Command::get_name);
                let help = tessgraph_graph::names::did_you_mean(name, names);
                let message = format!("there is no command `{name}`");
                return cx.fail(super::USAGE, "usage", message, help);
            }
        },
    };
    let mut text = Vec::new();
    match clap_mangen::Man::new(page).render(&mut text) {
        Ok(()) => {
            cx.console.data(&String::from_utf8_lossy(&text));
            OK
        }
        Err(error) => {
            let message = format!("cannot make the page: {error}");
            cx.fail(FAILED, "internal", message, None)
        }
    }
}
