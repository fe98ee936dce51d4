//! What a run came to, node by node.

use tessgraph_graph::eval::KeyChange;
use tessgraph_graph::node::InputSpec;
use tessgraph_graph::plan::{Origin, PlanInput, PlanNode, ResultRef};
use tessgraph_graph::value::Kind;
use tessgraph_graph::{Evaluation, Outcome, Plan, Severity, Value};

use crate::protocol::{Check, Entry, NodeOutcome};
use crate::values::{entries, said, single};

/// What became of each node; `changes` say why.
pub fn outcomes(evaluation: &Evaluation, changes: &[KeyChange]) -> Vec<NodeOutcome> {
    let mut outcomes: Vec<NodeOutcome> = Vec::with_capacity(evaluation.nodes.len());
    for node in &evaluation.nodes {
        outcomes.push(NodeOutcome {
            name: node.name.clone(),
            outcome: node.outcome.name().to_owned(),
            ms: node.ms,
            bytes: node.bytes,
            warnings: node.warnings.clone(),
            explain: None,
        });
    }
    // Both are in the plan's order.
    let mut place = 0;
    for change in changes {
        while outcomes
            .get(place)
            .is_some_and(|node| node.name != change.node)
        {
            place += 1;
        }
        if let Some(node) = outcomes.get_mut(place) {
            let line = match change.is_first {
                true if node.outcome != Outcome::Computed.name() => continue,
                true => "computed for the first time".to_owned(),
                false => format!("{}: {} -> {}", change.input, change.old, change.new),
            };
            let text = node.explain.get_or_insert_default();
            if !text.is_empty() {
                text.push('\n');
            }
            text.push_str(&line);
        }
    }
    outcomes
}

/// Entries of a report that are said in its sentence.
const MOST_SAID: usize = 4;

/// What the graph measures and checks: nodes that give a report, and nodes that
/// give nothing but whether something holds.
pub fn checks(plan: &Plan, evaluation: &Evaluation) -> Vec<Check> {
    let nodes = plan.nodes.iter().enumerate();
    nodes
        .filter_map(|(node, planned)| match planned.spec.outputs.first()?.kind {
            Kind::Report => measurement(plan, evaluation, node),
            Kind::Bool if planned.spec.outputs.len() == 1 => rule(plan, evaluation, node),
            _ => None,
        })
        .collect()
}

fn measurement(plan: &Plan, evaluation: &Evaluation, node: usize) -> Option<Check> {
    let planned = &plan.nodes[node];
    let Value::Report(report) = evaluation.value(ResultRef { node, result: 0 })? else {
        return None;
    };
    let values = entries(report, plan.units);
    let counts = fault_counts(planned);
    let is_count = |entry: &&Entry| counts.contains(&entry.name.as_str());
    let faults: Vec<&Entry> = values.iter().filter(is_count).collect();
    let is_none = |entry: &&Entry| entry.value == Some(crate::protocol::Value::Integer(0));
    let ok = (!faults.is_empty()).then(|| faults.iter().all(is_none));
    // What decides is said first.
    let others = values.iter().filter(|entry| !is_count(entry));
    let sentence = faults.into_iter().chain(others).take(MOST_SAID).map(said);
    Some(Check {
        node: planned.name.clone(),
        kind: planned.spec.name.to_owned(),
        ok,
        sentence: sentence.collect::<Vec<_>>().join(", "),
        values,
    })
}

/// The results of a node that count faults, as it is used.
fn fault_counts(node: &PlanNode) -> Vec<&'static str> {
    let is_given = |name: &&'static str| {
        let inputs = node.spec.inputs.iter().zip(&node.inputs);
        let mut inputs = inputs.filter(|(spec, _)| spec.name == *name);
        inputs.any(|(_, input)| !matches!(input.origin, Origin::Absent))
    };
    let results = node.spec.outputs.iter();
    results
        .filter(|result| {
            result
                .faults
                .is_some_and(|inputs| inputs.iter().all(is_given))
        })
        .map(|result| result.name)
        .collect()
}

fn rule(plan: &Plan, evaluation: &Evaluation, node: usize) -> Option<Check> {
    let planned = &plan.nodes[node];
    let run = evaluation.nodes.get(node)?;
    let (ok, sentence) = match run.outcome {
        Outcome::Failed => (false, failure(evaluation, &planned.name)?),
        outcome if outcome.is_done() => {
            let result = ResultRef { node, result: 0 };
            let holds = matches!(evaluation.value(result), Some(Value::Bool(true)));
            let word = if holds { "holds" } else { "does not hold" };
            (holds, format!("{} {word}", planned.name))
        }
        _ => return None,
    };
    Some(Check {
        node: planned.name.clone(),
        kind: planned.spec.name.to_owned(),
        values: written(plan, node),
        ok: Some(ok),
        sentence,
    })
}

/// The inputs of a rule that are known before anything runs: its message.
fn written(plan: &Plan, node: usize) -> Vec<Entry> {
    let planned = &plan.nodes[node];
    let inputs = planned.spec.inputs.iter().zip(&planned.inputs);
    let entry = |(spec, input): (&InputSpec, &PlanInput)| {
        let span = input.span.clone()?;
        let value = match &input.origin {
            Origin::Constant(value) => single(value)?,
            _ => {
                let text = planned.source.text().get(span)?;
                crate::protocol::Value::Text(text.trim_matches('"').to_owned())
            }
        };
        Some(Entry {
            name: spec.name.to_owned(),
            value: Some(value),
            unit: String::new(),
        })
    };
    inputs.filter_map(entry).collect()
}

/// Why a node failed, without its name.
fn failure(evaluation: &Evaluation, node: &str) -> Option<String> {
    let of_node = evaluation.diagnostics.iter().find(|diagnostic| {
        diagnostic.severity == Severity::Error && diagnostic.node.as_deref() == Some(node)
    })?;
    let message = &of_node.message;
    let prefix = format!("`{node}`: ");
    Some(message.strip_prefix(&prefix).unwrap_or(message).to_owned())
}
