//! What `study` is asked for.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::args::existing;
use crate::commands::engine::EngineArgs;
use crate::commands::run::ReportFormat;

/// Makes variants of a graph, and a table of what was measured of them
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct StudyArgs {
    #[command(subcommand)]
    pub(crate) command: Option<StudyCommand>,
    #[command(flatten)]
    pub(super) make: MakeArgs,
}

/// What else can be done with a study.
#[derive(Debug, Subcommand)]
pub(crate) enum StudyCommand {
    Collect(CollectArgs),
}

/// What making the variants takes.
#[derive(Debug, Args)]
pub(crate) struct MakeArgs {
    /// The study file
    #[arg(required = true)]
    pub(super) study: Option<PathBuf>,
    /// The folder of results; out/NAME beside the study, unless given
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Makes a part of the variants only: 1/4 to 4/4, on four machines, say
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(super) shard: Option<Shard>,
    /// What is told at the end: for people on stderr, or JSON on stdout
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = ReportFormat::Human)]
    pub(super) report: ReportFormat,
    #[command(flatten)]
    pub(super) engine: EngineArgs,
}

/// Joins the results of all shards into one table
#[derive(Debug, Args)]
pub(crate) struct CollectArgs {
    /// The study file
    pub(super) study: PathBuf,
    /// The folder of results; out/NAME beside the study, unless given
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// A further folder of results, of another machine; may be repeated
    #[arg(long, value_name = "DIR", value_parser = existing())]
    pub(super) from: Vec<PathBuf>,
    /// A folder outside the graph's that was allowed to the shards
    #[arg(long, value_name = "PATH", value_parser = existing())]
    pub(super) allow: Vec<PathBuf>,
}

/// A part of all variants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shard {
    /// Which part, from 0.
    index: usize,
    /// Of how many.
    count: usize,
}

impl Shard {
    /// Whether the variant in that place belongs to the part.
    pub(super) fn has(self, place: usize) -> bool {
        place % self.count == self.index
    }
}

/// Reads "2/4".
fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/');
    let number = |part: &str| part.trim().parse::<usize>().ok();
    match parts.map(|(index, count)| (number(index), number(count))) {
        Some((Some(index), Some(count))) if (1..=count).contains(&index) => Ok(Shard {
            index: index - 1,
            count,
        }),
        _ => Err("write it as 1/4, 2/4, 3/4 or 4/4".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variant_belongs_to_one_shard() {
        let shards: Vec<Shard> = ["1/3", " 2 / 3", "3/3"]
            .map(|text| shard(text).unwrap())
            .into();
        for place in 0..10 {
            assert_eq!(shards.iter().filter(|shard| shard.has(place)).count(), 1);
        }
        for wrong in ["0/3", "4/3", "1", "a/b", "1/0", ""] {
            assert!(shard(wrong).is_err(), "{wrong}");
        }
    }
}
