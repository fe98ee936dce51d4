//! `study`: makes variants of a graph and a table of what was measured.

mod args;
mod desk;
mod make;
mod progress;
mod record;
mod table;
mod told;

use std::path::{Path, PathBuf};
use std::time::Instant;

use tessgraph_graph::study::Variant;
use tessgraph_graph::{Diagnostic, Engine};

pub(crate) use args::StudyArgs;
use args::{CollectArgs, MakeArgs, StudyCommand};
use desk::{Desk, DigestingWorld};
use make::Made;
use progress::Progress;
use record::Record;
use told::{Done, Told};

use super::run::ReportFormat;
use super::{Context, FAILED, OK};
use crate::atomic::write_if_changed;
use crate::diagnostics::{print, without_place};
use crate::interrupt::{self, INTERRUPTED};
use crate::text::{count, printable};

/// The table's name in the folder of results.
const TABLE: &str = "results.csv";

/// Where the table of a study is, unless another folder was named.
pub(crate) fn table_of(study: &Path) -> PathBuf {
    desk::default_out(study).join(TABLE)
}

/// Carries the command out.
pub(crate) fn study(args: &StudyArgs, cx: &mut Context<'_, '_>) -> u8 {
    match (&args.command, &args.make.study) {
        (Some(StudyCommand::Collect(args)), _) => collect(args, cx),
        (None, Some(path)) => make(&args.make, path, cx),
        // The command line asks for one of them.
        (None, None) => FAILED,
    }
}

/// Makes the variants that are not there yet, and the table when all are.
fn make(args: &MakeArgs, path: &Path, cx: &mut Context<'_, '_>) -> u8 {
    let start = Instant::now();
    let pool = match args.engine.pool() {
        Ok(pool) => pool,
        Err(message) => {
            let help = "ask for fewer with `--threads`".to_owned();
            return cx.fail(FAILED, "threads", message, Some(help));
        }
    };
    let bytes = args.engine.cache_bytes();
    let registry = cx.registry;
    let desk = Desk::open(path, args.out.as_deref(), &args.engine.allow, registry);
    let desk = desk.and_then(|desk| pool.install(|| check(&desk, args, registry)).map(|()| desk));
    let desk = match desk {
        Ok(desk) => desk,
        Err(diagnostics) => {
            print(cx.console, &diagnostics);
            return FAILED;
        }
    };
    // Also with `--no-cache` there is one in memory: what variants share is
    // computed once.
    let engine = args.engine.caching(cx.cache.as_deref(), bytes);
    let mut told = Told::new(&desk, args.report);
    let mine = |place: usize| args.shard.is_none_or(|shard| shard.has(place));
    let variants: Vec<&Variant> = desk
        .variants
        .list
        .iter()
        .enumerate()
        .filter(|(place, _)| mine(*place))
        .map(|(_, variant)| variant)
        .collect();
    let live = cx.console.is_live() && args.report == ReportFormat::Human;
    let mut progress = Progress::new(variants.len(), live);
    for variant in variants {
        let done = pool.install(|| one(&desk, &engine, variant, args, registry));
        match done {
            Ok(Some(done)) => {
                progress.finished(variant, &done.record, done.reused);
                if !live {
                    told.line(variant, &done, cx.console);
                }
                told.add(variant, done);
            }
            Ok(None) => return stopped(&mut progress, &told, cx),
            Err(problem) => {
                progress.end();
                print(cx.console, &[problem]);
                return FAILED;
            }
        }
    }
    progress.end();
    engine.flush();
    if let Some(warning) = engine.cache_warning() {
        cx.console.note(&printable(&format!("note: {warning}\n")));
    }
    let table = match args.shard {
        Some(_) => Ok(false),
        None => tabulate(&desk, &[]),
    };
    told.end(start, table, cx)
}

/// Says that the user asked to stop.
fn stopped(progress: &mut Progress, told: &Told<'_>, cx: &mut Context<'_, '_>) -> u8 {
    progress.end();
    let finished = count(told.count(), "variant");
    let message = format!("interrupted; {finished} finished, the same command goes on from there");
    print(cx.console, &[without_place("interrupted", "", message)]);
    INTERRUPTED
}

/// What can be known before any variant is made: the graph by itself, the
/// measures, and where outputs go.
fn check(
    desk: &Desk,
    args: &MakeArgs,
    registry: &'static [tessgraph_graph::NodeSpec],
) -> Result<(), Vec<Diagnostic>> {
    let disk = desk.disk().map_err(|error| {
        let message = format!("cannot read the graph's folder: {error}");
        vec![without_place("unreadable", "", message)]
    })?;
    let world = DigestingWorld::new(disk);
    let plan = desk
        .study
        .load(desk.text(), &desk.variants.fixed, &world)
        .plan?;
    let folder = desk.out.join("variants");
    make::settle(desk, &plan, (&folder, &args.engine.allow), registry).map(|_| ())
}

/// One variant: found, or made and recorded. `None` if the user asked to stop.
fn one(
    desk: &Desk,
    engine: &Engine,
    variant: &Variant,
    args: &MakeArgs,
    registry: &'static [tessgraph_graph::NodeSpec],
) -> Result<Option<Done>, Diagnostic> {
    if interrupt::is_requested() {
        return Ok(None);
    }
    // What failed may have failed for a reason that is gone by now.
    let found = desk
        .current(&desk.out, variant)
        .filter(|record| record.error.is_none());
    if let Some(record) = found {
        return Ok(Some(Done {
            record,
            reused: true,
            diagnostics: Vec::new(),
        }));
    }
    let Some(made) = make::make(desk, engine, variant, (&args.engine.allow, registry)) else {
        return Ok(None);
    };
    let Made {
        record,
        diagnostics,
    } = made;
    let folder = Desk::folder_in(&desk.out, variant);
    match record.write(&folder) {
        Ok(()) => Ok(Some(Done {
            record,
            reused: false,
            diagnostics,
        })),
        Err(_) if interrupt::is_requested() => Ok(None),
        Err(error) => {
            let place = folder.to_string_lossy().into_owned();
            let message = format!("cannot write to {}: {error}", printable(&place));
            Err(without_place("output_failed", "", message))
        }
    }
}

/// Writes the table if all variants are there, in one of the folders.
///
/// # Errors
/// How many are not, or why the table cannot be written.
fn tabulate(desk: &Desk, from: &[std::path::PathBuf]) -> Result<bool, String> {
    // A file may have changed while the variants were made.
    desk.forget_files();
    let folders: Vec<&Path> = std::iter::once(desk.out.as_path())
        .chain(from.iter().map(std::path::PathBuf::as_path))
        .collect();
    let find = |variant: &Variant| {
        let found = folders
            .iter()
            .filter_map(|folder| desk.current(folder, variant));
        let found: Vec<Record> = found.collect();
        // One that was made later elsewhere may have succeeded.
        let whole = found.iter().position(|record| record.error.is_none());
        found.into_iter().nth(whole.unwrap_or(0))
    };
    let records: Vec<Option<Record>> = desk.variants.list.iter().map(find).collect();
    let missing = records.iter().filter(|record| record.is_none()).count();
    let Some(records) = records.into_iter().collect::<Option<Vec<Record>>>() else {
        let all = desk.variants.list.len();
        return Err(format!(
            "{missing} of {all} variants are not there, or not of these files"
        ));
    };
    let path = desk.out.join(TABLE);
    write_if_changed(&path, table::csv(desk, &records).as_bytes())
        .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    Ok(records.iter().all(|record| record.error.is_none()))
}

/// Makes the table of variants that were made before.
fn collect(args: &CollectArgs, cx: &mut Context<'_, '_>) -> u8 {
    let out = args.out.as_deref();
    let desk = match Desk::open(&args.study, out, &args.allow, cx.registry) {
        Ok(desk) => desk,
        Err(diagnostics) => {
            print(cx.console, &diagnostics);
            return FAILED;
        }
    };
    match tabulate(&desk, &args.from) {
        Ok(sound) => {
            let path = desk.out.join(TABLE);
            let variants = count(desk.variants.list.len(), "variant");
            let note = format!("{variants} in {}\n", path.display());
            cx.console.note(&printable(&note));
            if sound { OK } else { FAILED }
        }
        Err(message) => {
            let help = "run the shards that are missing; they make only what is not there";
            cx.fail(FAILED, "incomplete", message, Some(help.to_owned()))
        }
    }
}
