//! What every command that evaluates graphs is asked about its engine.

use std::path::{Path, PathBuf};

use clap::Args;
use tessgraph_graph::Engine;

use crate::args::existing;
use crate::memory::{count_this_thread, default_limit, parse_size, set_limit};

/// The share of the memory limit that kept results may take.
const CACHE_SHARE: u64 = 4;

/// How graphs are evaluated
#[derive(Debug, Args)]
pub(crate) struct EngineArgs {
    /// Computes everything anew
    #[arg(long)]
    pub(crate) no_cache: bool,
    /// Keeps results in this folder instead of the user's cache
    #[arg(long, value_name = "DIR", conflicts_with = "no_cache")]
    pub(crate) cache: Option<PathBuf>,
    /// How many threads compute; results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// A folder outside the graph's that may be read from and written to
    #[arg(long, value_name = "PATH", value_parser = existing())]
    pub(crate) allow: Vec<PathBuf>,
    /// How much memory may be used, as 2GB or 512MiB
    #[arg(long, value_name = "SIZE", value_parser = parse_size)]
    pub(crate) max_memory: Option<u64>,
}

impl EngineArgs {
    /// The threads that compute.
    ///
    /// # Errors
    /// In words, when the system gives none.
    pub(crate) fn pool(&self) -> Result<rayon::ThreadPool, String> {
        let mut pool = rayon::ThreadPoolBuilder::new().start_handler(|_| count_this_thread());
        if let Some(threads) = self.threads {
            pool = pool.num_threads(threads.into());
        }
        pool.build()
            .map_err(|error| format!("cannot start threads: {error}"))
    }

    /// Sets the memory limit; the bytes of it that kept results may take.
    pub(crate) fn cache_bytes(&self) -> u64 {
        let memory = self.max_memory.unwrap_or_else(default_limit);
        set_limit(memory);
        memory / CACHE_SHARE
    }

    /// The folder that keeps results: `folder` unless another is asked for.
    pub(crate) fn cache_folder<'a>(&'a self, folder: Option<&'a Path>) -> Option<&'a Path> {
        if self.no_cache {
            return None;
        }
        self.cache.as_deref().or(folder)
    }

    /// An engine that keeps results in memory, and in the folder if there is one.
    pub(crate) fn caching(&self, folder: Option<&Path>, bytes: u64) -> Engine {
        match self.cache_folder(folder) {
            Some(folder) => Engine::with_disk(bytes, folder),
            None => Engine::new(bytes),
        }
    }
}
