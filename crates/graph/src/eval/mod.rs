//! Evaluation: computes what the requested outputs need, and nothing twice.

mod cache;
mod explain;
mod files;
mod inputs;
mod key;
mod outcome;
mod output;
mod run;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use self::cache::Cache;
pub use cache::{CacheFolder, CacheStats, FolderStats, GcReport, VerifyReport};
pub use explain::{KeyChange, NodeCost};
pub use outcome::{Evaluation, NodeRun, NodeTime, Observer, Outcome, Silent};
pub use output::{OutputRecord, WrittenFile};

use crate::plan::{Plan, ResultRef};
use crate::world::World;

/// Evaluates plans and keeps results for the next evaluation.
///
/// One engine serves many evaluations, also of different graphs: results are
/// addressed by content, so whatever agrees is shared.
#[derive(Debug)]
pub struct Engine {
    cache: Option<Arc<Cache>>,
    /// Of ten thousand results found, how many are computed again to compare.
    verified: u32,
}

impl Engine {
    /// An engine that keeps up to `bytes` of results in memory.
    pub fn new(bytes: u64) -> Self {
        Self {
            cache: Some(Arc::new(Cache::new(bytes, None))),
            verified: 0,
        }
    }

    /// An engine that keeps up to `bytes` of results in memory and all of them
    /// in `folder`, for other processes and later ones.
    ///
    /// A folder that cannot be used or written to is no failure: the engine
    /// works without it, and [`CacheStats::warning`] says why. It is kept to 20
    /// GB, looked after once an hour and after much writing; see
    /// [`Engine::limiting_disk`].
    pub fn with_disk(bytes: u64, folder: &Path) -> Self {
        Self {
            cache: Some(Arc::new(Cache::new(bytes, Some(folder)))),
            verified: 0,
        }
    }

    /// The same engine, whose folder is kept to about `bytes`: what was used long
    /// ago, is large, and was quick to compute goes first.
    #[must_use]
    pub fn limiting_disk(self, bytes: u64) -> Self {
        if let Some(cache) = &self.cache {
            cache.set_disk_budget(bytes);
        }
        self
    }

    /// The same engine, which begins to write results to its folder `pause` after
    /// they were computed: whoever shows them needs the processors first. Does not
    /// hold up [`Engine::flush`].
    #[must_use]
    pub fn storing_after(self, pause: Duration) -> Self {
        if let Some(cache) = &self.cache {
            cache.set_pause(pause);
        }
        self
    }

    /// An engine that computes everything anew in every evaluation.
    pub fn without_cache() -> Self {
        Self {
            cache: None,
            verified: 0,
        }
    }

    /// The same engine, which computes `percent` of the nodes whose results it
    /// finds all the same and compares. A difference is an error diagnostic of
    /// code `cache_mismatch`. Which nodes are chosen depends on their keys only.
    #[must_use]
    pub fn verifying(mut self, percent: f64) -> Self {
        self.verified = (percent.clamp(0.0, 100.0) * 100.0).round() as u32;
        self
    }

    /// What the cache holds; `None` without a cache. Waits as [`Engine::flush`].
    pub fn cache_stats(&self) -> Option<CacheStats> {
        self.flush();
        self.cache.as_deref().map(Cache::stats)
    }

    /// Why the cache folder is not used, or not written to, if that is known by
    /// now. To be shown once.
    pub fn cache_warning(&self) -> Option<String> {
        self.cache.as_deref().and_then(Cache::warning)
    }

    /// Returns when all results so far are in the cache's folder. They are
    /// written after [`Engine::evaluate`] has returned; dropping the engine
    /// waits for them too, but leaving the process at once does not.
    pub fn flush(&self) {
        if let Some(cache) = &self.cache {
            cache.flush();
        }
    }

    /// Computes the results `wanted` and everything they need.
    ///
    /// Nodes run side by side on the current rayon pool as soon as their inputs
    /// are there. A failing node blocks only what depends on it. The values are
    /// the same bytes for any number of threads. Values of nodes whose results
    /// are known are loaded only if something that is computed, or an output
    /// that [`Observer::needs`] them, takes them.
    pub fn evaluate(
        &self,
        plan: &Plan,
        wanted: &[ResultRef],
        world: &dyn World,
        observer: &dyn Observer,
    ) -> Evaluation {
        run::Run::new(self, plan, wanted, world, observer).finish()
    }

    /// Which parts of which keys differ from the last run of the graph called
    /// `identity` (its path, say) in the same cache folder, in the plan's
    /// order; the keys are then kept for the next time. Nothing without a
    /// folder; in a first run every node is new.
    pub fn explain(&self, identity: &str, plan: &Plan, evaluation: &Evaluation) -> Vec<KeyChange> {
        let cache = self.cache.as_deref();
        cache.map_or_else(Vec::new, |cache| {
            explain::explain(cache, identity, plan, evaluation)
        })
    }

    /// What each node of `plan` took when it was last computed, as far as the
    /// cache folder knows: by the keys that the nodes had in the last run of the
    /// graph called `identity`, whatever has been edited since. In the plan's
    /// order; nothing without a folder.
    pub fn last_costs(&self, identity: &str, plan: &Plan) -> Vec<Option<NodeCost>> {
        let cache = self.cache.as_deref();
        cache.map_or_else(Vec::new, |cache| explain::last_costs(cache, identity, plan))
    }

    /// What is known about the last writing of the output at `path`, an absolute
    /// path; `None` without a cache folder, and where nothing sound is known.
    pub fn output_record(&self, path: &Path) -> Option<OutputRecord> {
        output::find(self.cache.as_deref()?, path)
    }

    /// Keeps for later runs how the output at `path` was written. Without a
    /// cache folder nothing is kept.
    pub fn keep_output_record(&self, path: &Path, record: &OutputRecord) {
        if let Some(cache) = self.cache.as_deref() {
            output::keep(cache, path, record);
        }
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.flush();
    }
}

/// The message of a panic's payload.
fn panic_text(payload: &(dyn std::any::Any + Send)) -> String {
    let text = payload
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "no message".to_owned())
}

/// Runs a node and turns a panic into an error that says it is a bug.
fn guarded<T>(
    kind: &str,
    body: impl FnOnce() -> Result<T, crate::NodeError>,
) -> Result<T, crate::NodeError> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|payload| {
        let text = panic_text(payload.as_ref());
        Err(
            crate::NodeError::new(format!("internal error in {kind}: {text}"))
                .with_help("this is a bug of tessgraph, not of the graph; please report it"),
        )
    })
}

/// Results of a node, shared between the run and the cache.
type Values = Arc<[crate::Value]>;
