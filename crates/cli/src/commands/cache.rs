//! `cache`: looks after the folder that keeps results between runs.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use tessgraph_graph::eval::CacheFolder;

use super::{Context, FAILED, OK};
use crate::memory::parse_size;
use crate::text::{bytes_text, count, printable};

/// Looks after the folder that keeps results between runs
#[derive(Debug, Args)]
pub(crate) struct CacheArgs {
    #[command(subcommand)]
    task: Task,
    /// The folder, instead of the user's cache
    #[arg(long, value_name = "DIR", global = true)]
    cache: Option<PathBuf>,
}

/// What is done with the folder.
#[derive(Debug, Subcommand)]
enum Task {
    /// Says how much it holds
    Stats,
    /// Removes what is worth least until the rest fits
    Gc {
        /// How much may stay, as 2GB or 512MiB
        #[arg(long, value_name = "SIZE", value_parser = parse_size, default_value = "4GB")]
        max_size: u64,
    },
    /// Reads everything and removes what is damaged
    Verify,
}

/// Carries the command out.
pub(crate) fn cache(args: &CacheArgs, cx: &mut Context<'_, '_>) -> u8 {
    let Some(path) = args.cache.clone().or_else(|| cx.cache.clone()) else {
        let help = Some("name a folder with `--cache DIR`".to_owned());
        return cx.fail(FAILED, "no_cache", "there is no cache folder", help);
    };
    let folder = match CacheFolder::open(&path) {
        Ok(folder) => folder,
        Err(problem) => return cx.fail(FAILED, "no_cache", problem, None),
    };
    let (text, status) = match args.task {
        Task::Stats => (stats(&path, &folder), OK),
        Task::Gc { max_size } => {
            let report = folder.gc(max_size);
            let (removed, kept) = (
                bytes_text(report.removed_bytes),
                bytes_text(report.kept_bytes),
            );
            let files = count(report.removed, "file");
            (format!("removed {files}, {removed}; {kept} left\n"), OK)
        }
        Task::Verify => verify(&folder),
    };
    cx.console.data(&printable(&text));
    status
}

fn stats(path: &Path, folder: &CacheFolder) -> String {
    let found = folder.stats();
    let (entries, values) = (count(found.entries, "node"), count(found.values, "value"));
    let bytes = bytes_text(found.bytes);
    format!(
        "{}\nresults of {entries}, {values}, {bytes}\n",
        path.display()
    )
}

/// Damage is found and removed; the status says that there was some.
fn verify(folder: &CacheFolder) -> (String, u8) {
    let report = folder.verify();
    let checked = count(report.checked, "file");
    if report.damaged.is_empty() {
        return (format!("{checked} checked, all sound\n"), OK);
    }
    let removed = count(report.damaged.len(), "damaged file");
    (format!("{checked} checked, {removed} removed\n"), FAILED)
}
