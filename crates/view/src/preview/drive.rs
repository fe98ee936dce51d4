//! What a parameter does to an array: found by comparing plans.

use std::collections::{BTreeMap, BTreeSet};

use tessgraph_graph::Value;
use tessgraph_graph::node::InputSpec;
use tessgraph_graph::plan::{Origin, Plan, PlanNode, ResultRef};

use super::same;

/// Factors that differ by less are equal: rounding of expressions.
const ROUNDING: f64 = 1e-9;

/// How an array follows a parameter.
#[derive(Debug, PartialEq)]
pub(super) struct Drive {
    /// Values of the parameter, ascending, and what all heights of the array are then
    /// multiplied by.
    pub(super) factors: Vec<[f64; 2]>,
    /// Whether the array is exactly that, and between the values too.
    pub(super) is_exact: bool,
}

/// What another value changes.
struct Change {
    /// Of all heights of the array.
    factor: f64,
    /// Whether something is left out.
    is_slight: bool,
}

/// How the array follows the parameter in which `samples` differ.
///
/// # Errors
/// In words, if it follows in other ways than by its heights.
pub(super) fn drive(plan: &Plan, samples: &[(f64, Plan)], array: usize) -> Result<Drive, String> {
    let mut factors = Vec::new();
    let mut is_slight = false;
    for (value, other) in samples {
        let change = change(plan, other, array)?;
        factors.push([*value, change.factor]);
        is_slight |= change.is_slight;
    }
    let [[first, low], .., [last, high]] = factors[..] else {
        return Err("there are no values to compare".to_owned());
    };
    let is_low = |[_, factor]: &[f64; 2]| (factor - low).abs() <= ROUNDING * low.abs();
    if factors.iter().all(is_low) {
        return Err("no height of the array depends on it".to_owned());
    }
    let on_line = |&[value, factor]: &[f64; 2]| {
        let expected = low + (high - low) * (value - first) / (last - first);
        (factor - expected).abs() <= ROUNDING * factor.abs().max(1.0)
    };
    Ok(Drive {
        is_exact: !is_slight && factors.iter().all(on_line),
        factors,
    })
}

fn change(plan: &Plan, other: &Plan, array: usize) -> Result<Change, String> {
    if !has_same_nodes(plan, other) {
        return Err("the graph itself depends on it".to_owned());
    }
    let needed = plan.needed([ResultRef {
        node: array,
        result: 0,
    }]);
    // Of all heights that the array makes, and of those of each of its components.
    let mut of_array = 1.0;
    let (components, others) = used(plan, array, &needed);
    let mut of_components: BTreeMap<usize, f64> =
        components.iter().map(|node| (*node, 1.0)).collect();
    let mut is_slight = false;
    for input in changed(plan, other, &needed) {
        let preview = &input.planned.spec.preview;
        if preview.slight.contains(&input.spec.name) {
            is_slight = true;
            continue;
        }
        let refused = || {
            let (node, input) = (&input.planned.name, input.spec.name);
            format!("`{node}.{input}` depends on it, too")
        };
        if !preview.heights.contains(&input.spec.name) || others.contains(&input.node) {
            return Err(refused());
        }
        let quotient = quotient(input.from, input.to).ok_or_else(refused)?;
        if input.node == array {
            of_array *= quotient;
        } else {
            *of_components.get_mut(&input.node).ok_or_else(refused)? *= quotient;
        }
    }
    let factor = of_components.values().next().copied().unwrap_or(1.0);
    let differs = |other: &f64| (other - factor).abs() > ROUNDING * factor.abs();
    if of_components.values().any(differs) {
        return Err("it changes some of the components only".to_owned());
    }
    Ok(Change {
        factor: of_array * factor,
        is_slight,
    })
}

fn has_same_nodes(plan: &Plan, other: &Plan) -> bool {
    let is_same = |(one, other): (&PlanNode, &PlanNode)| {
        one.name == other.name && one.spec.name == other.spec.name
    };
    plan.nodes.len() == other.nodes.len() && plan.nodes.iter().zip(&other.nodes).all(is_same)
}

/// An input that is another one with another value of the parameter.
struct Changed<'a> {
    node: usize,
    planned: &'a PlanNode,
    spec: &'static InputSpec,
    from: &'a Origin,
    to: &'a Origin,
}

/// What is another input of the nodes that are needed.
fn changed<'a>(
    plan: &'a Plan,
    other: &'a Plan,
    needed: &'a [bool],
) -> impl Iterator<Item = Changed<'a>> {
    let nodes = plan.nodes.iter().zip(&other.nodes).enumerate();
    let nodes = nodes.filter(|(node, _)| needed[*node]);
    nodes.flat_map(|(node, (planned, other))| {
        let inputs = planned.inputs.iter().zip(&other.inputs);
        let inputs = planned.spec.inputs.iter().zip(inputs);
        let inputs = inputs.map(move |(spec, (from, to))| Changed {
            node,
            planned,
            spec,
            from: &from.origin,
            to: &to.origin,
        });
        inputs.filter(|input| !same(input.from, input.to))
    })
}

/// The nodes that make components of an array, and those that are needed for
/// something else.
fn used(plan: &Plan, array: usize, needed: &[bool]) -> (BTreeSet<usize>, BTreeSet<usize>) {
    let (mut components, mut others) = (BTreeSet::new(), BTreeSet::new());
    let nodes = plan.nodes.iter().enumerate();
    for (node, planned) in nodes.filter(|(node, _)| needed[*node]) {
        for (spec, input) in planned.spec.inputs.iter().zip(&planned.inputs) {
            let is_component =
                node == array && planned.spec.preview.components.contains(&spec.name);
            let nodes = input.origin.results().into_iter().map(|result| result.node);
            if is_component {
                components.extend(nodes);
            } else {
                others.extend(nodes);
            }
        }
    }
    (components, others)
}

/// How many times as large the number has become.
fn quotient(before: &Origin, after: &Origin) -> Option<f64> {
    let number = |origin: &Origin| match origin {
        Origin::Constant(Value::Number(number)) => Some(*number),
        Origin::Constant(Value::Integer(number)) => Some(*number as f64),
        _ => None,
    };
    let quotient = number(after)? / number(before)?;
    quotient.is_finite().then_some(quotient)
}
