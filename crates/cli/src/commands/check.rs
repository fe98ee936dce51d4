//! `check`: everything that is wrong with a graph, without running it.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use tessgraph_graph::Diagnostic;
use tessgraph_graph::plan::PlanOutput;

use super::{Context, status};
use crate::args::{Setting, existing, setting};
use crate::diagnostics::{error_count, lines, print};
use crate::graph_file::GraphFile;
use crate::outputs::{Folders, InputFile, input_files, targets};
use crate::text::count;

/// Checks a graph without running it, and shows all of its errors
#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// The graph file
    graph: PathBuf,
    /// Gives a parameter another value for this check
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<Setting>,
    /// Files outside the graph's folder that may be used: a file or folder
    #[arg(long, value_name = "PATH", value_parser = existing())]
    allow: Vec<PathBuf>,
    /// How errors are shown: for people on stderr, or as JSON lines on stdout
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = MessageFormat::Human)]
    message_format: MessageFormat,
}

/// How diagnostics are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MessageFormat {
    /// For people
    Human,
    /// One JSON object a line
    Json,
}

/// Carries the command out.
pub(crate) fn check(args: &CheckArgs, cx: &mut Context<'_, '_>) -> u8 {
    let (diagnostics, counts) = match examine(args, cx) {
        Ok(counts) => (Vec::new(), Some(counts)),
        Err(diagnostics) => (diagnostics, None),
    };
    match args.message_format {
        MessageFormat::Json => cx.console.data(&lines(&diagnostics)),
        MessageFormat::Human => {
            print(cx.console, &diagnostics);
            if let Some((nodes, outputs)) = counts {
                let (nodes, outputs) = (count(nodes, "node"), count(outputs, "output"));
                cx.console.data(&format!("ok: {nodes}, {outputs}\n"));
            } else {
                let errors = count(error_count(&diagnostics), "error");
                cx.console
                    .note(&format!("{errors} in {}\n", args.graph.display()));
            }
        }
    }
    status(&diagnostics)
}

/// How many nodes and outputs the graph has.
fn examine(args: &CheckArgs, cx: &Context<'_, '_>) -> Result<(usize, usize), Vec<Diagnostic>> {
    let file = GraphFile::open(&args.graph, cx.registry, &args.set, &args.allow)?;
    let outputs: Vec<&PlanOutput> = file.plan.outputs.iter().collect();
    let folders = Folders {
        graph: &file.folder,
        out: &file.folder,
        allowed: &args.allow,
        file: &file.path,
    };
    let mut problems = missing_files(&file);
    if let Err(found) = targets(&file.plan, &outputs, &folders, cx.registry) {
        problems.extend(found);
    }
    if problems.is_empty() {
        Ok((file.plan.nodes.len(), outputs.len()))
    } else {
        Err(problems)
    }
}

/// The files that a run would not find or not be allowed to read.
fn missing_files(file: &GraphFile) -> Vec<Diagnostic> {
    let problem = |input: InputFile<'_>| {
        let reason = file.world.problem(&input.path)?;
        let span = input.span.unwrap_or(input.node.span.clone());
        let (source, included) = (&input.node.source, input.node.included.iter().cloned());
        let error = Diagnostic::error("missing_file", source, span, reason.to_string(), "");
        Some(error.with_places(included).with_node(&input.node.name))
    };
    input_files(&file.plan)
        .into_iter()
        .filter_map(problem)
        .collect()
}
