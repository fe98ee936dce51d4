//! Running a graph: what lives as long as the command, and one run.

use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use tessgraph_graph::eval::KeyChange;
use tessgraph_graph::names::did_you_mean;
use tessgraph_graph::node::NodeSpec;
use tessgraph_graph::plan::PlanOutput;
use tessgraph_graph::{Diagnostic, Engine, Evaluation, Plan};

use super::RunArgs;
use crate::atomic::write_if_changed;
use crate::commands::{FAILED, USAGE};
use crate::diagnostics::{error_count, without_place};
use crate::graph_file::GraphFile;
use crate::interrupt;
use crate::outputs::{Folders, OutputObserver, Outputs, Target, WrittenOutput, targets};
use crate::places::is_same_file;
use crate::progress::Progress;
use crate::text::printable;
use crate::timings::{self, EVALUATE, Phases};
use crate::world::Listener;

/// What one command keeps from run to run.
pub(crate) struct Session<'a> {
    args: &'a RunArgs,
    registry: &'static [NodeSpec],
    engine: Engine,
    pool: rayon::ThreadPool,
}

/// Why a run ended before anything was computed.
pub(crate) enum Stopped {
    /// The graph or its files are at fault.
    Graph(Vec<Diagnostic>),
    /// Something else is, and the exit status says what.
    Before {
        status: u8,
        code: &'static str,
        message: String,
        help: Option<String>,
    },
}

/// What a run came to.
pub(crate) struct Finished {
    pub(crate) evaluation: Evaluation,
    pub(crate) changes: Vec<KeyChange>,
    /// The most memory each node took, where that was measured.
    pub(crate) peaks: Vec<Option<u64>>,
    /// Whether it was stopped before all outputs were written.
    pub(crate) stopped: bool,
    pub(crate) outputs: Vec<WrittenOutput>,
    pub(crate) diagnostics: Vec<Diagnostic>,
}

impl Finished {
    /// Whether everything that was asked for was made.
    pub(crate) fn is_ok(&self) -> bool {
        self.evaluation.is_ok() && error_count(&self.diagnostics) == 0
    }
}

/// What somebody else can do about a run.
#[derive(Default)]
pub(crate) struct Control {
    /// Stops the run: it is out of date.
    pub(crate) stop: AtomicBool,
    /// Is told of every file the run reads.
    pub(crate) listener: Option<Listener>,
}

/// One run and the milliseconds it took.
pub(crate) struct Ran {
    pub(crate) result: Result<Finished, Stopped>,
    pub(crate) ms: f64,
}

impl Ran {
    /// A run that could not even begin.
    pub(crate) fn never(stopped: Stopped) -> Self {
        let (result, ms) = (Err(stopped), 0.0);
        Self { result, ms }
    }
}

/// The command line is at fault.
fn usage(message: String, help: Option<String>) -> Stopped {
    Stopped::Before {
        status: USAGE,
        code: "usage",
        message,
        help,
    }
}

impl<'a> Session<'a> {
    /// Starts threads and opens the cache; `folder` keeps results unless the
    /// arguments name another one.
    ///
    /// # Errors
    /// When the system gives no threads.
    pub(crate) fn new(
        args: &'a RunArgs,
        registry: &'static [NodeSpec],
        folder: Option<&Path>,
    ) -> Result<Self, Stopped> {
        let pool = args.engine.pool().map_err(|message| Stopped::Before {
            status: FAILED,
            code: "threads",
            message,
            help: Some("ask for fewer with `--threads`".to_owned()),
        })?;
        let bytes = args.engine.cache_bytes();
        Ok(Self {
            args,
            registry,
            engine: engine(args, folder, bytes),
            pool,
        })
    }

    /// Loads the graph, computes what is wanted and writes it; with `live` a
    /// bar shows progress.
    pub(crate) fn run(&self, live: bool, control: &Control) -> Ran {
        let start = Instant::now();
        let result = self.pool.install(|| {
            let mut phases = Phases::starting(start);
            let args = self.args;
            let opened = phases.during("check", || {
                let (set, listener) = (&args.set, control.listener.as_ref());
                let allow = &args.engine.allow;
                GraphFile::open_telling(&args.graph, self.registry, set, allow, listener)
            });
            let file = opened.map_err(Stopped::Graph)?;
            let targets = self.settle(&file)?;
            Ok(self.make(&file, &targets, live, phases, &control.stop))
        });
        let ms = start.elapsed().as_secs_f64() * 1000.0;
        Ran { result, ms }
    }

    /// Returns when all results are kept that are to be, and says why they could
    /// not be, if so.
    pub(crate) fn close(&self) -> Option<String> {
        self.engine.flush();
        self.engine.cache_warning()
    }

    /// Why results are not kept for later, if that is known by now.
    pub(crate) fn cache_warning(&self) -> Option<String> {
        self.engine.cache_warning()
    }

    /// Where the wanted outputs go.
    fn settle(&self, file: &GraphFile) -> Result<Vec<Target>, Stopped> {
        let args = self.args;
        let out = args.out.as_deref();
        if let Some(out) = out.filter(|out| out.exists() && !out.is_dir()) {
            let out = printable(&out.to_string_lossy()).into_owned();
            let help = "name a folder; it is made if it is missing".to_owned();
            let message = format!("`--out {out}` is a file, not a folder");
            return Err(usage(message, Some(help)));
        }
        let outputs = wanted(&file.plan, &args.only)?;
        let folders = Folders {
            graph: &file.folder,
            out: out.unwrap_or(&file.folder),
            allowed: &args.engine.allow,
            file: &file.path,
        };
        targets(&file.plan, &outputs, &folders, self.registry).map_err(Stopped::Graph)
    }

    /// Evaluates the plan and writes what came of it.
    fn make(
        &self,
        file: &GraphFile,
        targets: &[Target],
        live: bool,
        mut phases: Phases,
        stop: &AtomicBool,
    ) -> Finished {
        let (engine, plan, world) = (&self.engine, &file.plan, &file.world);
        let results: Vec<_> = targets.iter().map(|target| target.result).collect();
        let names = plan.nodes.iter().map(|node| node.name.clone()).collect();
        let progress = Progress::new(names, stop);
        let outputs = Outputs::new(plan, targets, engine);
        let observer = OutputObserver {
            inner: &progress,
            outputs: &outputs,
        };
        let evaluation = phases.during(EVALUATE, || {
            progress.during(live, || engine.evaluate(plan, &results, world, &observer))
        });
        // Also when nobody asks: the next run is compared with this one.
        let changes = engine.explain(&file.identity(), plan, &evaluation);
        let (mut written, mut diagnostics) = (Vec::new(), Vec::new());
        if !evaluation.cancelled {
            let read = world.files_read();
            (written, diagnostics) =
                phases.during("write outputs", || outputs.write(&evaluation, &read, stop));
            let kept = targets.iter().map(|target| &target.path).chain(read.keys());
            diagnostics.extend(self.write_timings(
                &phases,
                &evaluation,
                &progress.peaks(),
                kept.chain([&file.path]),
            ));
        }
        Finished {
            changes,
            peaks: progress.peaks(),
            stopped: stop.load(Ordering::Relaxed) || interrupt::is_requested(),
            evaluation,
            outputs: written,
            diagnostics,
        }
    }

    /// Writes the time line if one is wanted, but onto none of the files `kept`.
    fn write_timings<'p>(
        &self,
        phases: &Phases,
        evaluation: &Evaluation,
        peaks: &[Option<u64>],
        mut kept: impl Iterator<Item = &'p PathBuf>,
    ) -> Option<Diagnostic> {
        let path = self.args.timings.as_deref()?;
        let problem = if kept.any(|other| is_same_file(other, path)) {
            "the run reads or writes that file itself".to_owned()
        } else {
            let trace = timings::trace(&self.args.graph, phases, evaluation, peaks);
            write_if_changed(path, trace.as_bytes()).err()?.to_string()
        };
        let name = path.to_string_lossy();
        let message = format!(
            "cannot write the timings to {}: {problem}",
            printable(&name)
        );
        Some(without_place("timings_failed", "", message))
    }
}

/// The outputs that `--only` names, or all.
fn wanted<'p>(plan: &'p Plan, only: &[String]) -> Result<Vec<&'p PlanOutput>, Stopped> {
    if only.is_empty() {
        return Ok(plan.outputs.iter().collect());
    }
    let names = || plan.outputs.iter().map(|output| output.path.as_str());
    for name in only {
        if !names().any(|other| tidy(other) == tidy(name)) {
            let all: Vec<_> = names().map(|name| format!("`{name}`")).collect();
            let help = did_you_mean(name, names())
                .unwrap_or_else(|| format!("its outputs are {}", all.join(", ")));
            let message = format!("the graph has no output `{name}`");
            return Err(usage(message, Some(help)));
        }
    }
    Ok(plan
        .outputs
        .iter()
        .filter(|output| only.iter().any(|name| tidy(name) == tidy(&output.path)))
        .collect())
}

/// The path without `./`, however it was written.
fn tidy(path: &str) -> PathBuf {
    let parts = Path::new(path).components();
    parts.filter(|part| *part != Component::CurDir).collect()
}

/// The engine the arguments ask for; `folder` keeps results unless they name
/// another one.
fn engine(args: &RunArgs, folder: Option<&Path>, bytes: u64) -> Engine {
    if args.engine.no_cache {
        return Engine::without_cache();
    }
    let engine = args.engine.caching(folder, bytes);
    match args.verify_cache {
        Some(percent) => engine.verifying(percent),
        None => engine,
    }
}
