//! `graph`: the picture of a graph.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use tessgraph_graph::Engine;
use tessgraph_graph::eval::NodeCost;

use super::{Context, FAILED, OK, status};
use crate::args::{Setting, existing, setting};
use crate::diagnostics::print;
use crate::graph_file::GraphFile;
use crate::picture::{Picture, dot, mermaid, svg};

/// Draws a graph, with the times of its last run
#[derive(Debug, Args)]
pub(crate) struct GraphArgs {
    /// The graph file
    graph: PathBuf,
    /// The form of the picture, on stdout
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = PictureFormat::Svg)]
    format: PictureFormat,
    /// Gives a parameter another value in the picture
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<Setting>,
    /// A folder outside the graph's that included graphs may be read from
    #[arg(long, value_name = "PATH", value_parser = existing())]
    allow: Vec<PathBuf>,
    /// Takes the times from this folder instead of the user's cache
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
}

/// How a graph is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PictureFormat {
    /// A picture, for browsers and documents
    Svg,
    /// Text for Graphviz
    Dot,
    /// Text for Mermaid
    Mermaid,
}

/// Carries the command out.
pub(crate) fn graph(args: &GraphArgs, cx: &mut Context<'_, '_>) -> u8 {
    let file = match GraphFile::open(&args.graph, cx.registry, &args.set, &args.allow) {
        Ok(file) => file,
        Err(diagnostics) => {
            print(cx.console, &diagnostics);
            return status(&diagnostics);
        }
    };
    let title = args.graph.file_name().unwrap_or_default().to_string_lossy();
    let costs = costs(args, &file, cx);
    let picture = Picture::new(&title, &file.plan, &costs);
    let text = match args.format {
        PictureFormat::Svg => svg(&picture),
        PictureFormat::Dot => Some(dot(&picture)),
        PictureFormat::Mermaid => Some(mermaid(&picture)),
    };
    let Some(text) = text else {
        let message = format!(
            "the graph is too large for a picture: {} boxes",
            picture.boxes.len()
        );
        let help = "Graphviz may manage: `--format dot`".to_owned();
        return cx.fail(FAILED, "too_large", message, Some(help));
    };
    cx.console.data(&text);
    OK
}

/// What the nodes cost when they were last computed, as far as a cache knows.
fn costs(args: &GraphArgs, file: &GraphFile, cx: &Context<'_, '_>) -> Vec<Option<NodeCost>> {
    let folder = args.cache.as_ref().or(cx.cache.as_ref());
    match folder.filter(|folder| folder.is_dir()) {
        Some(folder) => Engine::with_disk(0, folder).last_costs(&file.identity(), &file.plan),
        None => Vec::new(),
    }
}
