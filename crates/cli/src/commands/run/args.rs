//! What `run` is asked for.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::args::{Setting, setting};
use crate::commands::engine::EngineArgs;

/// Makes the outputs of a graph
#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// The graph file
    pub(crate) graph: PathBuf,
    /// Runs again whenever the graph or a file it reads changes
    #[arg(long)]
    pub(crate) watch: bool,
    /// Looks for changes twice a second, where the system tells of none: on network drives
    #[arg(long, requires = "watch")]
    pub(crate) poll: bool,
    /// Goes on watching after a run that took too much memory; milliseconds of 1970 when it began
    #[arg(long, value_name = "MS", requires = "watch", hide = true)]
    pub(crate) resume: Option<u64>,
    /// Gives a parameter another value for this run
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) set: Vec<Setting>,
    /// Makes only this output, named as in the graph; may be repeated
    #[arg(long, value_name = "OUTPUT")]
    pub(crate) only: Vec<String>,
    /// Writes outputs below this folder instead of the graph's
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// What is told at the end: for people on stderr, or JSON on stdout
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = ReportFormat::Human)]
    pub(crate) report: ReportFormat,
    /// Writes when each node ran to this file, for Perfetto or Chrome's tracing
    #[arg(long, value_name = "FILE")]
    pub(crate) timings: Option<PathBuf>,
    /// Says of each node what has changed since the last run
    #[arg(long, conflicts_with = "no_cache")]
    pub(crate) explain: bool,
    /// Computes this share of reused results again and compares, as 5%
    #[arg(long, value_name = "PERCENT", value_parser = percent, conflicts_with = "no_cache")]
    pub(crate) verify_cache: Option<f64>,
    #[command(flatten)]
    pub(crate) engine: EngineArgs,
}

/// How a run is reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReportFormat {
    /// A table for people
    Human,
    /// One JSON object on a line, one line for each run
    Json,
}

/// Reads "5%" or "5".
fn percent(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim_end().parse::<f64>();
    match number {
        Ok(number) if (0.0..=100.0).contains(&number) => Ok(number),
        _ => Err("give a share from 0% to 100%".to_owned()),
    }
}
