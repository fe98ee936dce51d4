//! The command line.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Parser, Subcommand};

use crate::commands::cache::CacheArgs;
use crate::commands::check::CheckArgs;
use crate::commands::completions::{CompletionsArgs, ManArgs};
use crate::commands::graph::GraphArgs;
use crate::commands::info::InfoArgs;
use crate::commands::new::NewArgs;
use crate::commands::nodes::NodesArgs;
use crate::commands::render::RenderArgs;
use crate::commands::run::RunArgs;
use crate::commands::study::StudyArgs;
use crate::commands::view::ViewArgs;

/// Node-graph procedural modelling for architectural tessellation
#[derive(Debug, Parser)]
#[command(
    name = "tessgraph",
    version,
    propagate_version = true,
    arg_required_else_help = true,
    after_help = "Exit status: 0 all done; 1 the graph has errors or a node failed; 2 wrong usage."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Run(RunArgs),
    View(ViewArgs),
    Study(StudyArgs),
    Check(CheckArgs),
    Nodes(NodesArgs),
    Info(InfoArgs),
    New(NewArgs),
    Render(RenderArgs),
    Graph(GraphArgs),
    Cache(CacheArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

/// A parameter's name and the text of its value.
pub(crate) type Setting = (String, String);

/// Reads "name=value"; the value may hold further equals signs.
pub(crate) fn setting(text: &str) -> Result<Setting, String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("write it as name=value".to_owned()),
    }
}

/// Reads the path of something that exists.
pub(crate) fn existing() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| path.canonicalize().map(|_| path))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_definition_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn settings_split_at_the_first_equals_sign() {
        assert_eq!(setting("a = b=c"), Ok(("a".into(), "b=c".into())));
        assert!(setting("=1").is_err() && setting("a").is_err());
    }
}
