//! From a document and a registry to a plan, or to everything that is wrong.
//!
//! Nothing is evaluated here. Every name is resolved, every literal becomes a
//! value in SI units, every edge is checked for its kind, and all mistakes of
//! the file are found in one go.

mod choice;
mod expressions;
mod inputs;
mod interpolate;
mod literal;
mod order;
mod outputs;
mod overrides;
mod reference;
mod scope;

#[cfg(test)]
mod tests;

use std::sync::Arc;

pub use overrides::WRONG_SETTING;

use crate::diagnostic::Diagnostic;
use crate::document::{self, Document, Problems};
use crate::names::quoted;
use crate::node::NodeSpec;
use crate::plan::{Origin, Plan, PlanInput, PlanNode, PlanOutput, PlanParameter};
use crate::world::{MemoryWorld, World};
use scope::Scope;

/// What the caller of [`load`] may change about a graph.
#[derive(Debug, Clone, Default)]
pub struct LoadOptions {
    /// Values for parameters instead of their defaults, as text: name, value.
    /// Of several for one parameter the last counts.
    pub set: Vec<(String, String)>,
}

/// What came of reading a graph and the graphs it includes.
#[derive(Debug)]
pub struct Loaded {
    /// The plan, or all problems of all files.
    pub plan: Result<Plan, Vec<Diagnostic>>,
    /// The files of included graphs as far as they were met, also those that do
    /// not exist: paths from the main graph's folder, each once.
    pub included: Vec<String>,
}

/// Reads and checks a graph file that includes no other; `name` is what its
/// reader knows it by.
///
/// Cost: O(size of the file · log), without evaluating any node.
///
/// # Errors
/// All problems of the file in the order of their places: of syntax errors the
/// first, of everything else all.
///
/// ```
/// use tessgraph_graph::{LoadOptions, load};
/// let text = b"Graph(version: 1, nodes: {}, outputs: {})";
/// let problems = load("facade.ron", text, &[], &LoadOptions::default()).unwrap_err();
/// assert_eq!(problems[0].code, "no_outputs");
/// ```
pub fn load(
    name: &str,
    bytes: &[u8],
    registry: &'static [NodeSpec],
    options: &LoadOptions,
) -> Result<Plan, Vec<Diagnostic>> {
    load_with(name, bytes, registry, options, &MemoryWorld::default()).plan
}

/// [`load`] for graphs that include others, which are read from `world`.
pub fn load_with(
    name: &str,
    bytes: &[u8],
    registry: &'static [NodeSpec],
    options: &LoadOptions,
    _world: &dyn World,
) -> Loaded {
    Loaded {
        plan: plan(name, bytes, registry, options),
        included: Vec::new(),
    }
}

fn plan(
    name: &str,
    bytes: &[u8],
    registry: &'static [NodeSpec],
    options: &LoadOptions,
) -> Result<Plan, Vec<Diagnostic>> {
    let (mut document, mut problems) = document::read(name, bytes)?;
    overrides::apply(&mut document.params, &options.set, &mut problems);
    check_runnable(&document, &mut problems);
    let scope = Scope::new(&document, registry, &mut problems);
    let inputs: Vec<Vec<PlanInput>> = (0..document.nodes.len())
        .map(|index| inputs::check(&scope, index, &mut problems))
        .collect();
    let outputs = outputs::check(&scope, &document, &mut problems);
    outputs::check_results(&scope, &document.results, &mut problems);
    let order = order::check(&document, &inputs, &mut problems);
    let specs = scope.specs;
    match (order, specs.into_iter().collect::<Option<Vec<_>>>()) {
        (Some(order), Some(specs)) if problems.is_empty() => {
            Ok(assemble(document, specs, inputs, outputs, &order))
        }
        _ => Err(problems.into_sorted()),
    }
}

/// A graph that takes something from another graph cannot run by itself.
fn check_runnable(document: &Document, problems: &mut Problems) {
    let Some(first) = document.required.first() else {
        return;
    };
    let names = quoted(
        document.required.iter().map(|input| input.value.as_str()),
        8,
    );
    let message = format!("the graph cannot run by itself: {names} must be given to it");
    let help = "give each of these inputs a default, or use the graph inside another one";
    let mut error = problems.error("not_runnable", &first.span, message, "has no default");
    for input in &document.required[1..] {
        error = error.with_label(input.span.clone(), "has no default");
    }
    problems.add(error.with_help(help));
}

/// Puts the checked parts together, nodes in the given order.
fn assemble(
    document: Document,
    specs: Vec<&'static NodeSpec>,
    inputs: Vec<Vec<PlanInput>>,
    outputs: Vec<PlanOutput>,
    order: &[usize],
) -> Plan {
    let mut places = vec![0; order.len()];
    for (place, &node) in order.iter().enumerate() {
        places[node] = place;
    }
    let entries = document.nodes.into_iter().zip(specs).zip(inputs);
    let mut nodes: Vec<(usize, PlanNode)> = entries
        .enumerate()
        .map(|(index, ((entry, spec), mut inputs))| {
            for input in &mut inputs {
                renumber(&mut input.origin, &places);
            }
            (
                places[index],
                PlanNode {
                    name: entry.name.value,
                    spec,
                    inputs,
                    span: entry.span,
                },
            )
        })
        .collect();
    nodes.sort_by_key(|(place, _)| *place);
    let parameters = document.params.into_iter().filter_map(|param| {
        Some(PlanParameter {
            name: param.name.value,
            value: param.value?,
        })
    });
    let mut outputs = outputs;
    for output in &mut outputs {
        output.result.node = places[output.result.node];
    }
    Plan {
        source: Arc::clone(&document.source),
        included: Vec::new(),
        units: document.units,
        parameters: parameters.collect(),
        nodes: nodes.into_iter().map(|(_, node)| node).collect(),
        outputs,
    }
}

fn renumber(origin: &mut Origin, places: &[usize]) {
    match origin {
        Origin::Absent | Origin::Constant(_) => {}
        Origin::Result(result) => result.node = places[result.node],
        Origin::Expression(expression) => expression.renumber(places),
        Origin::List(items) => items.iter_mut().for_each(|item| renumber(item, places)),
        Origin::Vector(parts) => parts.iter_mut().for_each(|part| renumber(part, places)),
        Origin::Formula(template) => template.renumber(places),
    }
}
