//! From a document and a registry to a plan, or to everything that is wrong.
//!
//! Nothing is evaluated here. Every name is resolved, every literal becomes a
//! value in SI units, every edge is checked for its kind, and all mistakes of
//! the file are found in one go.

mod arguments;
mod axis;
mod choice;
mod expand;
mod expressions;
mod inputs;
mod interpolate;
mod literal;
mod measures;
mod order;
mod outputs;
mod overrides;
mod reference;
mod scope;
pub mod study;

#[cfg(test)]
mod tests;

use std::rc::Rc;
use std::sync::Arc;

pub use overrides::WRONG_SETTING;
pub(crate) use overrides::value_of;

use crate::diagnostic::{Diagnostic, Source};
use crate::document::{self, DeclaredInput, DeclaredKind, Document, Problems, Text};
use crate::names::{quoted, shown};
use crate::node::NodeSpec;
use crate::plan::{Origin, Plan, PlanMeasure, PlanNode, PlanOutput, PlanParameter};
use crate::world::{MemoryWorld, World};
use expand::{Call, ExpandedNode, Expander};
use scope::Givings;
use study::StudyGraph;

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
///
/// Cost: besides, what is included once for each time it is included.
pub fn load_with(
    name: &str,
    bytes: &[u8],
    registry: &'static [NodeSpec],
    options: &LoadOptions,
    world: &dyn World,
) -> Loaded {
    let graph = StudyGraph {
        name,
        bytes,
        registry,
    };
    let mut prepare = |document: &mut Document, problems: &mut Problems| {
        overrides::apply(&mut document.params, &options.set, problems);
    };
    load_prepared(graph, &mut prepare, None, world)
}

/// Expressions over a graph that stand in another file.
struct Measured<'a> {
    source: &'a Arc<Source>,
    /// Names and expressions.
    measures: &'a [(Text, Text)],
}

/// Gives the parameters of a graph their values, and reports what is wrong.
type Prepare<'p> = dyn FnMut(&mut Document, &mut Problems) + 'p;

/// Reads and checks a graph whose parameters `prepare` gives their values.
fn load_prepared(
    graph: StudyGraph<'_>,
    prepare: &mut Prepare<'_>,
    measured: Option<&Measured<'_>>,
    world: &dyn World,
) -> Loaded {
    let (mut document, mut problems) = match document::read(graph.name, graph.bytes) {
        Ok(read) => read,
        Err(problems) => {
            return Loaded {
                plan: Err(problems),
                included: Vec::new(),
            };
        }
    };
    prepare(&mut document, &mut problems);
    check_runnable(&document, &mut problems);
    let mut expander = Expander::new(graph.name, graph.registry, world);
    let given = Givings::defaults(&document);
    let call = expander.main(graph.name, Rc::new(document), given);
    let ends = expander.expand(&call, |expander, scope, found| {
        let outputs = outputs::check(scope, &call.document, found, &mut |name, target, span| {
            expander.single(&call, name, target, span)
        });
        outputs::check_results(scope, &call.document.results, found);
        let measures = measured.map_or_else(Vec::new, |measured| {
            let mut problems = Problems::new(measured.source);
            let measures = measures::check(scope, measured.measures, &mut problems);
            let problems = problems.into_sorted();
            problems
                .into_iter()
                .for_each(|problem| expander.report(problem));
            measures
        });
        (outputs, measures)
    });
    for problem in problems.into_sorted() {
        expander.report(problem);
    }
    finish(expander, &call, ends)
}

/// The plan, if nothing is wrong and no node needs itself.
fn finish(
    mut expander: Expander<'_>,
    call: &Call,
    (mut outputs, mut measures): (Vec<PlanOutput>, Vec<PlanMeasure>),
) -> Loaded {
    let places = expander.sort_nodes();
    let order = order::check(&mut expander);
    let included = std::mem::take(&mut expander.included);
    let plan = match order {
        Some(order) if expander.is_sound() => {
            let order_of = inverse(&order);
            let last: Vec<usize> = places.iter().map(|&place| order_of[place]).collect();
            for output in &mut outputs {
                output.result.node = last[output.result.node];
            }
            for measure in &mut measures {
                renumber(&mut measure.origin, &last);
            }
            let nodes = plan_nodes(expander.nodes, &order, &order_of);
            let mut plan = plan(call, included.clone(), nodes, outputs);
            plan.measures = measures;
            Ok(plan)
        }
        _ => Err(expander.into_problems()),
    };
    Loaded { plan, included }
}

/// For each node its place in the order.
fn inverse(order: &[usize]) -> Vec<usize> {
    let mut places = vec![0; order.len()];
    for (place, &node) in order.iter().enumerate() {
        places[node] = place;
    }
    places
}

fn plan(
    call: &Call,
    included: Vec<String>,
    nodes: Vec<PlanNode>,
    outputs: Vec<PlanOutput>,
) -> Plan {
    let parameters = call.given.params.iter().filter_map(|param| {
        Some(PlanParameter {
            name: param.name.value.clone(),
            value: param.value.clone()?,
        })
    });
    Plan {
        source: Arc::clone(&call.document.source),
        included,
        units: call.document.units,
        parameters: parameters.collect(),
        nodes,
        outputs,
        measures: Vec::new(),
    }
}

/// A graph that takes something from another graph cannot run by itself.
fn check_runnable(document: &Document, problems: &mut Problems) {
    let is_missing = |input: &&DeclaredInput| match input.kind {
        // It may have been given a value from outside.
        DeclaredKind::Param(param) => input.required && document.params[param].value.is_none(),
        _ => input.required,
    };
    let missing: Vec<&DeclaredInput> = document.inputs.iter().filter(is_missing).collect();
    let Some(first) = missing.first() else {
        return;
    };
    let names = quoted(missing.iter().map(|input| input.name.value.as_str()), 8);
    let message = format!("the graph cannot run by itself: {names} must be given to it");
    let path = document
        .source
        .name()
        .rsplit(['/', '\\'])
        .next()
        .unwrap_or_default();
    let help = format!(
        "run a graph that includes it: `Subgraph(path: \"{}\", with: {{\"{}\": ...}})`",
        shown(path),
        shown(&first.name.value)
    );
    let mut error = problems.error("not_runnable", &first.name.span, message, "has no default");
    for input in &missing[1..] {
        error = error.with_label(input.name.span.clone(), "has no default");
    }
    problems.add(error.with_help(help));
}

/// The nodes of the plan in the given order.
fn plan_nodes(nodes: Vec<ExpandedNode>, order: &[usize], places: &[usize]) -> Vec<PlanNode> {
    let mut nodes: Vec<Option<PlanNode>> = nodes
        .into_iter()
        .map(|node| {
            let mut inputs = node.inputs;
            for input in &mut inputs {
                renumber(&mut input.origin, places);
            }
            Some(PlanNode {
                name: node.name,
                spec: node.spec,
                inputs,
                span: node.span,
                source: node.source,
                units: node.units,
                included: node.included,
            })
        })
        .collect();
    order
        .iter()
        .filter_map(|&node| nodes[node].take())
        .collect()
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
