//! A run for the page: what lives as long as the command, and one run.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tessgraph_geometry::digest::Digest;
use tessgraph_graph::node::NodeSpec;
use tessgraph_graph::plan::ResultRef;
use tessgraph_graph::{Diagnostic, Engine, Evaluation, NodeRun, Observer, Plan, Value};
use tessgraph_view::outcomes::outcomes;
use tessgraph_view::protocol::{NodeOutcome, State, Status, ToPage};
use tessgraph_view::shown::{Gallery, Picture, default_result, wanted};
use tessgraph_view::{Hub, PageId};

use super::ViewArgs;
use crate::commands::run::Control;
use crate::graph_file::GraphFile;
use crate::interrupt;
use crate::progress::Progress;
use crate::world::Listener;

/// How often the page is told how far a run is.
const TICK: Duration = Duration::from_millis(100);

/// In this time a picture is sent, fetched and drawn, which takes all processors.
const UNTIL_SHOWN: Duration = Duration::from_millis(400);

/// What lives as long as the command.
pub(super) struct Studio<'a> {
    args: &'a ViewArgs,
    pub(super) registry: &'static [NodeSpec],
    engine: Engine,
    pool: rayon::ThreadPool,
    /// Bytes that kept results may take.
    memory: u64,
}

/// The node and the result that somebody wants to see, instead of the graph's first
/// mesh.
pub(super) type Asked = Option<(String, Option<String>)>;

/// What a run is asked for.
pub(super) struct Order {
    /// Values of parameters instead of the file's.
    pub(super) set: Vec<(String, String)>,
    /// What pages look at.
    pub(super) asked: Vec<(Option<PageId>, Asked)>,
    /// What the run is for.
    pub(super) cause: String,
    pub(super) hub: Arc<Hub>,
    pub(super) gallery: Arc<Gallery>,
}

/// What a run came to.
pub(super) struct Viewed {
    pub(super) stopped: bool,
    pub(super) ms: f64,
    /// The graph file as it was read.
    pub(super) content: Option<Arc<[u8]>>,
    /// The first file that was asked for and is not there.
    pub(super) missing: Option<PathBuf>,
    pub(super) result: Result<Done, Vec<Diagnostic>>,
}

/// What came of a graph that could be run.
pub(super) struct Done {
    pub(super) plan: Arc<Plan>,
    pub(super) evaluation: Arc<Evaluation>,
    /// The results that were to be shown, by page.
    pub(super) shown: Vec<(Option<PageId>, ResultRef)>,
    /// The pictures of those that could be made.
    pub(super) pictures: BTreeMap<ResultRef, Picture>,
}

/// What a run reads, as far as the page must know.
#[derive(Default)]
struct Read {
    content: Option<Arc<[u8]>>,
    missing: Option<PathBuf>,
}

impl<'a> Studio<'a> {
    /// Starts threads and opens the cache; `folder` keeps results unless the
    /// arguments name another one.
    ///
    /// # Errors
    /// In words, when the system gives no threads.
    pub(super) fn new(
        args: &'a ViewArgs,
        registry: &'static [NodeSpec],
        folder: Option<&Path>,
    ) -> Result<Self, String> {
        let pool = args.engine.pool()?;
        let memory = args.engine.cache_bytes();
        let engine = if args.engine.no_cache {
            Engine::without_cache()
        } else {
            let engine = args.engine.caching(folder, memory);
            engine.storing_after(UNTIL_SHOWN)
        };
        Ok(Self {
            args,
            registry,
            engine,
            pool,
            memory,
        })
    }

    /// Bytes that kept results may take.
    pub(super) fn memory(&self) -> u64 {
        self.memory
    }

    /// Returns when all results are kept that are to be.
    pub(super) fn close(&self) {
        self.engine.flush();
    }

    /// What became of each node, and why. Reads and writes a small file.
    pub(super) fn outcomes(&self, plan: &Plan, evaluation: &Evaluation) -> Vec<NodeOutcome> {
        // Under a name of its own: `run` compares with what `run` did.
        let identity = format!("view {}", self.args.graph.display());
        outcomes(
            evaluation,
            &self.engine.explain(&identity, plan, evaluation),
        )
    }

    /// Carries `work` out on the threads that compute, now.
    pub(super) fn compute_now<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// Carries `work` out on the threads that compute, some time.
    pub(super) fn spawn(&self, work: impl FnOnce() + Send + 'static) {
        self.pool.spawn(work);
    }

    /// Loads the graph and computes what its outputs and the page need.
    pub(super) fn run(&self, order: &Order, control: &Control) -> Viewed {
        let start = Instant::now();
        let read = Arc::new(Mutex::new(Read::default()));
        let listener = self.listener(&read, control);
        let result = self.pool.install(|| {
            let (set, allow) = (&order.set, &self.args.engine.allow);
            let file = GraphFile::open_telling(
                &self.args.graph,
                self.registry,
                set,
                allow,
                Some(&listener),
            )?;
            Ok(self.compute(file, order, control))
        });
        let read = std::mem::take(&mut *read.lock().unwrap_or_else(PoisonError::into_inner));
        let is_cancelled =
            |done: &Result<Done, _>| done.as_ref().is_ok_and(|done| done.evaluation.cancelled);
        Viewed {
            stopped: control.stop.load(Ordering::Relaxed) || is_cancelled(&result),
            ms: start.elapsed().as_secs_f64() * 1000.0,
            content: read.content,
            missing: read.missing,
            result,
        }
    }

    /// Notes what the page must know of the files that are read, and passes
    /// everything on.
    fn listener(&self, read: &Arc<Mutex<Read>>, control: &Control) -> Listener {
        let graph = std::path::absolute(&self.args.graph).ok();
        let (read, next) = (Arc::clone(read), control.listener.clone());
        Arc::new(move |path, content| {
            let mut known = read.lock().unwrap_or_else(PoisonError::into_inner);
            if content.is_none() && known.missing.is_none() && !path.exists() {
                known.missing = Some(path.clone());
            }
            if Some(&path) == graph.as_ref() {
                known.content.clone_from(&content);
            }
            drop(known);
            if let Some(next) = &next {
                next(path, content);
            }
        })
    }

    fn compute(&self, file: GraphFile, order: &Order, control: &Control) -> Done {
        let plan = Arc::new(file.plan);
        let shown = shown(&plan, &order.asked);
        let results: BTreeSet<ResultRef> = shown.iter().map(|(_, result)| *result).collect();
        let results: Vec<ResultRef> = results.into_iter().collect();
        let wanted = wanted(&plan, &results);
        let needed = plan.needed(wanted.iter().copied());
        let names = plan.nodes.iter().map(|node| node.name.clone()).collect();
        let observer = Watching {
            inner: &Progress::new(names, &control.stop),
            plan: &plan,
            order,
            shown: &shown,
            total: needed.iter().filter(|needed| **needed).count(),
            done: AtomicUsize::new(0),
            told: Mutex::new(Instant::now()),
        };
        let evaluation = self.engine.evaluate(&plan, &wanted, &file.world, &observer);
        let is_stopped = evaluation.cancelled || interrupt::is_requested();
        let picture = |result: &ResultRef| {
            let picture = order.gallery.picture(&plan, &evaluation, *result)?;
            Some((*result, picture))
        };
        let pictures = results.iter().filter(|_| !is_stopped);
        let pictures = pictures.filter_map(picture).collect();
        Done {
            evaluation: Arc::new(evaluation),
            plan,
            shown,
            pictures,
        }
    }
}

/// What is to be shown of a plan, by page.
fn shown(plan: &Plan, asked: &[(Option<PageId>, Asked)]) -> Vec<(Option<PageId>, ResultRef)> {
    let first = default_result(plan);
    let results = asked.iter().filter_map(|(page, asked)| {
        let asked = asked.as_ref();
        let asked = asked.and_then(|(node, result)| plan.result_of(node, result.as_deref()));
        Some((*page, asked.or(first)?))
    });
    results.collect()
}

/// Tells the page how far a run is.
struct Watching<'a> {
    inner: &'a Progress<'a>,
    plan: &'a Plan,
    order: &'a Order,
    shown: &'a [(Option<PageId>, ResultRef)],
    total: usize,
    done: AtomicUsize,
    /// When the page was told last.
    told: Mutex<Instant>,
}

impl Watching<'_> {
    /// The pages that look at a result.
    fn pages_at(&self, result: ResultRef) -> impl Iterator<Item = Option<PageId>> {
        let shown = self.shown.iter();
        shown.filter_map(move |(page, shown)| (*shown == result).then_some(*page))
    }

    /// Tells the page, unless it was told just now.
    fn tell(&self, node: usize, fraction: Option<f64>) {
        let now = Instant::now();
        let Ok(mut told) = self.told.try_lock() else {
            return;
        };
        if now.duration_since(*told) < TICK {
            return;
        }
        *told = now;
        drop(told);
        self.order.hub.publish(&ToPage::Status(Status {
            state: State::Computing,
            done: Some(self.done.load(Ordering::Relaxed).min(self.total)),
            total: Some(self.total),
            node: Some(self.plan.nodes[node].name.clone()),
            fraction,
            cause: Some(self.order.cause.clone()),
            ..Status::default()
        }));
    }
}

impl Observer for Watching<'_> {
    /// Only what is shown: of the rest mostly the digest is enough, and it can
    /// still be loaded.
    fn needs(&self, result: ResultRef, _: Digest, _: Digest) -> bool {
        self.pages_at(result).next().is_some()
    }

    fn found(&self, result: ResultRef, value: &Value) {
        let Order { gallery, hub, .. } = self.order;
        let mut pages = self.pages_at(result).peekable();
        if pages.peek().is_some()
            && let Some(coming) = gallery.foresee(value)
        {
            for page in pages.filter(|page| gallery.lacks(*page, &coming)) {
                hub.show(page, &ToPage::Coming(coming.clone()));
            }
        }
    }

    fn started(&self, node: usize) {
        self.inner.started(node);
        self.tell(node, None);
    }

    fn progress(&self, node: usize, done: u64, total: u64) {
        self.inner.progress(node, done, total);
        self.tell(node, (total > 0).then(|| done as f64 / total as f64));
    }

    fn finished(&self, node: usize, run: &NodeRun) {
        self.inner.finished(node, run);
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    fn memory_left(&self) -> Option<u64> {
        self.inner.memory_left()
    }

    fn cancelled(&self) -> bool {
        self.inner.cancelled()
    }
}
