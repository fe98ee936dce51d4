//! `run`: makes the outputs of a graph.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};
use tessgraph_graph::eval::KeyChange;
use tessgraph_graph::names::did_you_mean;
use tessgraph_graph::plan::PlanOutput;
use tessgraph_graph::{Diagnostic, Engine, Evaluation, Plan};

use super::{Context, FAILED, OK, USAGE};
use crate::args::{Setting, existing, setting};
use crate::diagnostics::{error_count, print, without_place};
use crate::graph_file::GraphFile;
use crate::interrupt::{self, INTERRUPTED};
use crate::memory::{default_limit, parse_size, set_limit};
use crate::outputs::{Folders, OutputObserver, Outputs, Target, WrittenOutput, targets};
use crate::progress::Progress;
use crate::report::{RunReport, human, json};
use crate::text::{Align, printable, table};

/// The share of the memory limit that kept results may take.
const CACHE_SHARE: u64 = 4;

/// Makes the outputs of a graph
#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// The graph file
    graph: PathBuf,
    /// Gives a parameter another value for this run
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<Setting>,
    /// Makes only this output, named as in the graph; may be repeated
    #[arg(long, value_name = "OUTPUT")]
    only: Vec<String>,
    /// Writes outputs below this folder instead of the graph's
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// What is told at the end: for people on stderr, or JSON on stdout
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = ReportFormat::Human)]
    report: ReportFormat,
    /// Computes everything anew
    #[arg(long)]
    no_cache: bool,
    /// Keeps results in this folder instead of the user's cache
    #[arg(long, value_name = "DIR", conflicts_with = "no_cache")]
    cache: Option<PathBuf>,
    /// Says of each node what has changed since the last run
    #[arg(long, conflicts_with = "no_cache")]
    explain: bool,
    /// Computes this share of reused results again and compares, as 5%
    #[arg(long, value_name = "PERCENT", value_parser = percent, conflicts_with = "no_cache")]
    verify_cache: Option<f64>,
    /// How many threads compute; results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// A folder outside the graph's that may be read from and written to
    #[arg(long, value_name = "PATH", value_parser = existing())]
    allow: Vec<PathBuf>,
    /// How much memory may be used, as 2GB or 512MiB
    #[arg(long, value_name = "SIZE", value_parser = parse_size)]
    max_memory: Option<u64>,
}

/// How a run is reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ReportFormat {
    /// A table for people
    Human,
    /// One JSON object
    Json,
}

/// Why a run ended before anything was computed.
enum Stopped {
    /// The graph or its files are at fault.
    Graph(Vec<Diagnostic>),
    /// The command line is.
    Usage {
        message: String,
        help: Option<String>,
    },
}

/// What a run came to.
struct Finished {
    evaluation: Evaluation,
    changes: Vec<KeyChange>,
    cache_warning: Option<String>,
    outputs: Vec<WrittenOutput>,
    diagnostics: Vec<Diagnostic>,
}

/// Carries the command out.
pub(crate) fn run(args: &RunArgs, cx: &mut Context<'_, '_>) -> u8 {
    let start = Instant::now();
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = args.threads {
        pool = pool.num_threads(threads.into());
    }
    let pool = match pool.build() {
        Ok(pool) => pool,
        Err(error) => {
            let help = Some("ask for fewer with `--threads`".to_owned());
            return cx.fail(
                FAILED,
                "threads",
                format!("cannot start threads: {error}"),
                help,
            );
        }
    };
    let live = cx.console.is_live() && args.report == ReportFormat::Human;
    let (registry, cache) = (cx.registry, cx.cache.clone());
    let result = pool.install(|| {
        let file = GraphFile::open(&args.graph, registry, &args.set, &args.allow)
            .file
            .map_err(Stopped::Graph)?;
        let targets = settle(args, &file, registry)?;
        Ok(make(args, &file, cache.as_deref(), &targets, live))
    });
    let ms = start.elapsed().as_secs_f64() * 1000.0;
    match result {
        Ok(finished) => finish(args, finished, ms, cx),
        Err(Stopped::Usage { message, help }) => cx.fail(USAGE, "usage", message, help),
        Err(Stopped::Graph(diagnostics)) => {
            print(cx.console, &diagnostics);
            if args.report == ReportFormat::Json {
                cx.console.data(&json(&RunReport {
                    ok: false,
                    ms,
                    nodes: &[],
                    outputs: &[],
                }));
            }
            FAILED
        }
    }
}

/// Where the wanted outputs go.
fn settle(
    args: &RunArgs,
    file: &GraphFile,
    registry: &'static [tessgraph_graph::NodeSpec],
) -> Result<Vec<Target>, Stopped> {
    let outputs = wanted(&file.plan, &args.only)?;
    let folders = Folders {
        graph: &file.folder,
        out: args.out.as_deref().unwrap_or(&file.folder),
        allowed: &args.allow,
        file: &file.path,
    };
    targets(&file.plan, &outputs, &folders, registry).map_err(Stopped::Graph)
}

/// The outputs that `--only` names, or all.
fn wanted<'p>(plan: &'p Plan, only: &[String]) -> Result<Vec<&'p PlanOutput>, Stopped> {
    if only.is_empty() {
        return Ok(plan.outputs.iter().collect());
    }
    let names = || plan.outputs.iter().map(|output| output.path.as_str());
    for name in only {
        if !names().any(|other| other == name) {
            let all: Vec<_> = names().map(|name| format!("`{name}`")).collect();
            let help = did_you_mean(name, names())
                .unwrap_or_else(|| format!("its outputs are {}", all.join(", ")));
            let message = format!("the graph has no output `{name}`");
            return Err(Stopped::Usage {
                message,
                help: Some(help),
            });
        }
    }
    Ok(plan
        .outputs
        .iter()
        .filter(|output| only.contains(&output.path))
        .collect())
}

/// Evaluates the plan and writes what came of it.
fn make(
    args: &RunArgs,
    file: &GraphFile,
    cache: Option<&Path>,
    targets: &[Target],
    live: bool,
) -> Finished {
    let (plan, world) = (&file.plan, &file.world);
    let memory = args.max_memory.unwrap_or_else(default_limit);
    set_limit(memory);
    let engine = engine(args, cache, memory / CACHE_SHARE);
    let results: Vec<_> = targets.iter().map(|target| target.result).collect();
    let names = plan.nodes.iter().map(|node| node.name.clone()).collect();
    let progress = Progress::new(names);
    let outputs = Outputs::new(plan, targets, &engine);
    let observer = OutputObserver {
        inner: &progress,
        outputs: &outputs,
    };
    let evaluation = progress.during(live, || engine.evaluate(plan, &results, world, &observer));
    // Also when nobody asks: the next run is compared with this one.
    let changes = engine.explain(&identity(&file.path), plan, &evaluation);
    let (outputs, diagnostics) = if evaluation.cancelled {
        (Vec::new(), Vec::new())
    } else {
        outputs.write(&evaluation, &world.files_read())
    };
    engine.flush();
    Finished {
        evaluation,
        changes,
        cache_warning: engine.cache_warning(),
        outputs,
        diagnostics,
    }
}

/// The engine the arguments ask for; `folder` keeps results unless they name
/// another one.
fn engine(args: &RunArgs, folder: Option<&Path>, bytes: u64) -> Engine {
    if args.no_cache {
        return Engine::without_cache();
    }
    let engine = match args.cache.as_deref().or(folder) {
        Some(folder) => Engine::with_disk(bytes, folder),
        None => Engine::new(bytes),
    };
    match args.verify_cache {
        Some(percent) => engine.verifying(percent),
        None => engine,
    }
}

/// What tells a graph file from others between runs.
fn identity(path: &Path) -> String {
    let full = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    full.to_string_lossy().into_owned()
}

/// Reads "5%" or "5".
fn percent(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim_end().parse::<f64>();
    match number {
        Ok(number) if (0.0..=100.0).contains(&number) => Ok(number),
        _ => Err("give a share from 0% to 100%".to_owned()),
    }
}

/// What has changed since the last run, a line for each input.
fn explained(changes: &[KeyChange]) -> String {
    if changes.is_empty() {
        return "nothing has changed since the last run\n\n".to_owned();
    }
    let row = |change: &KeyChange| {
        let from = match change.from.as_slice() {
            [] => String::new(),
            nodes => format!("from {}", nodes.join(", ")),
        };
        let place = format!("{}.{}", change.node, change.input);
        vec![place, format!("{} -> {}", change.old, change.new), from]
    };
    let rows: Vec<_> = changes.iter().map(row).collect();
    format!(
        "{}\n",
        table(&rows, &[Align::Left, Align::Left, Align::Left])
    )
}

/// Shows what a run came to.
fn finish(args: &RunArgs, finished: Finished, ms: f64, cx: &mut Context<'_, '_>) -> u8 {
    let Finished {
        evaluation,
        changes,
        cache_warning,
        outputs,
        diagnostics,
    } = finished;
    print(cx.console, &evaluation.diagnostics);
    print(cx.console, &diagnostics);
    if evaluation.cancelled || interrupt::is_requested() {
        let stopped = without_place("interrupted", "", "interrupted; nothing more was written");
        print(cx.console, &[stopped]);
        return INTERRUPTED;
    }
    for output in &outputs {
        for lost in &output.lost {
            let note = format!("note: {}: {lost}\n", output.shown);
            cx.console.note(&printable(&note));
        }
    }
    if let Some(warning) = cache_warning {
        cx.console.note(&printable(&format!("note: {warning}\n")));
    }
    if args.explain {
        cx.console.note(&printable(&explained(&changes)));
    }
    let ok = evaluation.is_ok() && error_count(&diagnostics) == 0;
    let report = RunReport {
        ok,
        ms,
        nodes: &evaluation.nodes,
        outputs: &outputs,
    };
    match args.report {
        ReportFormat::Human => cx.console.note(&human(&report)),
        ReportFormat::Json => cx.console.data(&json(&report)),
    }
    if ok { OK } else { FAILED }
}
