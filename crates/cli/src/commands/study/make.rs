//! Making one variant.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use serde_json::{Value as Json, json};
use tessgraph_graph::plan::{PlanOutput, ResultRef};
use tessgraph_graph::study::Variant;
use tessgraph_graph::{Diagnostic, Engine, Evaluation, NodeSpec, Outcome, Plan, Severity, Value};

use super::desk::{Desk, DigestingWorld};
use super::record::{Kept, Record};
use crate::interrupt;
use crate::json::number;
use crate::outputs::{Folders, OutputObserver, Outputs, Target, targets};
use crate::progress::Progress;

/// Nothing but the user stops a study.
static NEVER: AtomicBool = AtomicBool::new(false);

/// What became of a variant.
pub(super) struct Made {
    pub(super) record: Record,
    /// Errors and warnings.
    pub(super) diagnostics: Vec<Diagnostic>,
}

/// The places of the outputs that a study keeps of one variant.
///
/// # Errors
/// Everything that stands against them.
pub(super) fn settle(
    desk: &Desk,
    plan: &Plan,
    (folder, allowed): (&Path, &[std::path::PathBuf]),
    registry: &'static [NodeSpec],
) -> Result<Vec<Target>, Vec<Diagnostic>> {
    let keep: Vec<&str> = desk.study.keep().collect();
    let outputs = plan.outputs.iter();
    let outputs: Vec<&PlanOutput> = outputs
        .filter(|output| keep.contains(&output.path.as_str()))
        .collect();
    let folders = Folders {
        graph: &desk.folder,
        out: folder,
        allowed,
        file: &desk.graph,
    };
    targets(plan, &outputs, &folders, registry)
}

/// Makes a variant; `None` if the user asked to stop.
pub(super) fn make(
    desk: &Desk,
    engine: &Engine,
    variant: &Variant,
    (allowed, registry): (&[std::path::PathBuf], &'static [NodeSpec]),
) -> Option<Made> {
    let start = Instant::now();
    let folder = Desk::folder_in(&desk.out, variant);
    let mut record = Record {
        job: desk.job(variant),
        files: [desk.own_digest()].into(),
        error: None,
        measures: vec![Json::Null; desk.study.measures().count()],
        kept: Vec::new(),
        ms: 0.0,
        computed: 0,
    };
    let world = match desk.disk() {
        Ok(disk) => DigestingWorld::new(disk),
        Err(error) => {
            record.error = Some(error.to_string());
            let diagnostics = Vec::new();
            return Some(Made {
                record,
                diagnostics,
            });
        }
    };
    let loaded = desk.study.load(desk.text(), &desk.values(variant), &world);
    let settled = loaded.plan.and_then(|plan| {
        let targets = settle(desk, &plan, (&folder, allowed), registry)?;
        Ok((plan, targets))
    });
    let diagnostics = match settled {
        Ok((plan, targets)) => evaluate(engine, (&plan, &targets), &world, &folder, &mut record)?,
        Err(problems) => problems,
    };
    if record.error.is_none() {
        let error = diagnostics
            .iter()
            .find(|problem| problem.severity == Severity::Error);
        record.error = error.map(|problem| problem.message.clone());
    }
    record.files.extend(world.digests());
    record.ms = start.elapsed().as_secs_f64() * 1000.0;
    Some(Made {
        record,
        diagnostics,
    })
}

/// Evaluates a variant's plan and writes what is kept of it.
fn evaluate(
    engine: &Engine,
    (plan, targets): (&Plan, &[Target]),
    world: &DigestingWorld,
    folder: &Path,
    record: &mut Record,
) -> Option<Vec<Diagnostic>> {
    let measured = plan
        .measures
        .iter()
        .flat_map(|measure| measure.origin.results());
    let mut results: Vec<ResultRef> = targets
        .iter()
        .map(|target| target.result)
        .chain(measured)
        .collect();
    results.sort_unstable();
    results.dedup();
    let names = plan.nodes.iter().map(|node| node.name.clone()).collect();
    let progress = Progress::new(names, &NEVER);
    let outputs = Outputs::new(plan, targets, engine);
    let observer = OutputObserver {
        inner: &progress,
        outputs: &outputs,
    };
    let evaluation = engine.evaluate(plan, &results, world, &observer);
    if evaluation.cancelled {
        return None;
    }
    let computed = evaluation
        .nodes
        .iter()
        .filter(|node| node.outcome == Outcome::Computed);
    record.computed = computed.count();
    let (written, problems) = outputs.write(&evaluation, &world.files.files_read(), &NEVER);
    if interrupt::is_requested() {
        return None;
    }
    let kept = written
        .iter()
        .filter_map(|output| Kept::of(folder, &output.name));
    record.kept = kept.collect();
    measure(plan, &evaluation, record);
    let mut diagnostics = evaluation.diagnostics;
    diagnostics.extend(problems);
    // What a node says is nearer to the cause than a measure that is missing.
    if diagnostics
        .iter()
        .any(|problem| problem.severity == Severity::Error)
    {
        record.error = None;
    }
    Some(diagnostics)
}

/// The values of the measures, as far as they are known.
fn measure(plan: &Plan, evaluation: &Evaluation, record: &mut Record) {
    for (place, measure) in plan.measures.iter().enumerate() {
        match measure.value(evaluation) {
            Ok(value) => record.measures[place] = as_json(&value),
            Err(reason) => {
                let message = format!("the measure `{}` has no value: {reason}", measure.name);
                record.error.get_or_insert(message);
            }
        }
    }
}

/// A value of a parameter or a measure.
pub(super) fn as_json(value: &Value) -> Json {
    match value {
        Value::Bool(value) => json!(value),
        Value::Integer(value) => json!(value),
        Value::Number(value) => number(*value),
        Value::Text(text) => json!(text.as_ref()),
        _ => Json::Null,
    }
}
