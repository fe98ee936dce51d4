//! A graph file as the page is told it.

use std::collections::BTreeMap;

use tessgraph_graph::document::edit::{Declaration, Declarations};
use tessgraph_graph::plan::{PlanInput, PlanNode};
use tessgraph_graph::reference::first_line;
use tessgraph_graph::value::Kind;
use tessgraph_graph::{Lines, Plan};

use crate::protocol::{GraphNode, NodeInput, NodeResult, Output, Parameter, Value};
pub use crate::values::single;

/// What a session knows about parameters besides what their file says.
#[derive(Debug, Default)]
pub struct Values {
    /// What the file said when the session began, or when the parameter was new.
    pub initial: BTreeMap<String, Value>,
    /// What the graph ran with last, where that is not what the file says.
    pub now: BTreeMap<String, Value>,
    /// Parameters that nobody may change.
    pub locked: Vec<String>,
}

impl Values {
    /// Learns from a file what its new parameters are at first.
    pub fn begin(&mut self, declared: &Declarations) {
        for declaration in declared.parameters() {
            if let Some(value) = single(declaration.value()) {
                let name = declaration.name().to_owned();
                self.initial.entry(name).or_insert(value);
            }
        }
    }
}

/// The parameters of a file, in its order.
pub fn parameters(declared: &Declarations, values: &Values) -> Vec<Parameter> {
    let lines = Lines::of(declared.source().text());
    let parameter = |declaration: &Declaration| {
        let name = declaration.name();
        let in_file = single(declaration.value())?;
        let (min, max) = declaration.limits();
        let span = declaration.span();
        let choices = declaration.choices();
        Some(Parameter {
            kind: declaration.kind().to_lowercase(),
            value: values.now.get(name).unwrap_or(&in_file).clone(),
            initial: values.initial.get(name).unwrap_or(&in_file).clone(),
            in_file,
            min,
            max,
            unit: declared.units().quantity_sign(declaration.quantity()),
            of: (!choices.is_empty()).then(|| choices.to_vec()),
            about: declaration.about().to_owned(),
            locked: values.locked.iter().any(|other| other == name),
            line: lines.position(span.start).line,
            span: [span.start, span.end],
            name: name.to_owned(),
        })
    };
    declared.parameters().iter().filter_map(parameter).collect()
}

/// The nodes of a plan, in its order.
pub fn nodes(plan: &Plan) -> Vec<GraphNode> {
    let lines = Lines::of(plan.source.text());
    let node = |node: &PlanNode| {
        // Of an included node the place where the main graph includes it.
        let place = node.included.last().map(|place| &place.label.span);
        let span = lines.valid(place.unwrap_or(&node.span));
        let inputs = node.spec.inputs.iter().zip(&node.inputs);
        let inputs = inputs.filter_map(|(spec, input)| self::input(plan, node, spec.name, input));
        let results = node.spec.outputs.iter().enumerate();
        GraphNode {
            name: node.name.clone(),
            kind: node.spec.name.to_owned(),
            about: first_line(node.spec.doc).trim().to_owned(),
            line: lines.position(span.start).line,
            span: [span.start, span.end],
            inputs: inputs.collect(),
            results: results
                .map(|(index, result)| NodeResult {
                    name: result.name.to_owned(),
                    kind: kind_name(result.kind),
                    main: index == 0,
                })
                .collect(),
        }
    };
    plan.nodes.iter().map(node).collect()
}

/// An input that is written, or that a form of the language has connected.
fn input(plan: &Plan, node: &PlanNode, name: &str, input: &PlanInput) -> Option<NodeInput> {
    let mut from: Vec<String> = Vec::new();
    for result in input.origin.results() {
        let name = &plan.nodes[result.node].name;
        if !from.contains(name) {
            from.push(name.clone());
        }
    }
    let written = input.span.clone();
    if written.is_none() && from.is_empty() {
        return None;
    }
    let text = written.and_then(|span| node.source.text().get(span));
    Some(NodeInput {
        name: name.to_owned(),
        text: text.unwrap_or_default().to_owned(),
        from,
    })
}

/// The outputs of a plan, in the order of the file.
pub fn outputs(plan: &Plan) -> Vec<Output> {
    let output = |output: &tessgraph_graph::plan::PlanOutput| {
        let spec = plan.result_spec(output.result);
        Output {
            path: output.path.clone(),
            node: plan.nodes[output.result.node].name.clone(),
            result: spec.name.to_owned(),
            kind: kind_name(spec.kind),
        }
    };
    plan.outputs.iter().map(output).collect()
}

/// "Mesh", "List(Mesh)".
pub(crate) fn kind_name(kind: Kind) -> String {
    format!("{kind:?}")
}
