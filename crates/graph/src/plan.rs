//! A checked graph: every name resolved, every literal typed, in SI units.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Place, Source};
use crate::expr::Expression;
use crate::node::NodeSpec;
use crate::units::Units;
use crate::value::Value;

/// A graph that passed all checks and can be evaluated.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The text it was read from.
    pub source: Arc<Source>,
    /// The files of included graphs: paths from the main graph's folder.
    pub included: Vec<String>,
    /// The unit of every length in that text.
    pub units: Units,
    /// The parameters with the values they have in this run, in file order.
    pub parameters: Vec<PlanParameter>,
    /// The nodes, each after all nodes it depends on; among equals in file order.
    pub nodes: Vec<PlanNode>,
    /// The outputs in file order.
    pub outputs: Vec<PlanOutput>,
    /// What a study measures, in its order; nothing in a plain run.
    pub measures: Vec<PlanMeasure>,
}

/// A number or condition over the graph's results, in the graph's units.
#[derive(Debug, Clone)]
pub struct PlanMeasure {
    /// Its name.
    pub name: String,
    /// What it is.
    pub origin: Origin,
}

/// A parameter and its value in this run.
#[derive(Debug, Clone)]
pub struct PlanParameter {
    /// Its name.
    pub name: String,
    /// Its value, as written: in the file's units.
    pub value: Value,
}

/// A node of the plan.
#[derive(Debug, Clone)]
pub struct PlanNode {
    /// Its name in the file; behind those of the nodes that include its graph:
    /// `panels/fitted`.
    pub name: String,
    /// What kind of node it is.
    pub spec: &'static NodeSpec,
    /// Its inputs, one per entry of `spec.inputs`.
    pub inputs: Vec<PlanInput>,
    /// Where it is defined: its kind and inputs.
    pub span: Range<usize>,
    /// The text it is defined in.
    pub source: Arc<Source>,
    /// The unit of every length in that text.
    pub units: Units,
    /// Where that text was included, from inside out; nothing for nodes of the
    /// main graph.
    pub included: Arc<[Place]>,
}

/// Where an input's value comes from, and where that is written.
#[derive(Debug, Clone)]
pub struct PlanInput {
    /// Where the value comes from.
    pub origin: Origin,
    /// The place of the value in the text; `None` for defaults.
    pub span: Option<Range<usize>>,
}

/// Where a value comes from.
#[derive(Debug, Clone)]
pub enum Origin {
    /// Left out, and optional.
    Absent,
    /// Known before anything runs, in SI units and within its range.
    Constant(Value),
    /// Another node's result, taken as it is.
    Result(ResultRef),
    /// An expression over other nodes' results, computed when they are known.
    Expression(Expression),
    /// A list of items, each with its own origin.
    List(Vec<Origin>),
    /// A vector of three numbers, each with its own origin.
    Vector(Box<[Origin; 3]>),
    /// A formula some of whose names are other nodes' numeric results.
    Formula(crate::expr::FormulaTemplate),
}

/// One result of one node, by position in the plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ResultRef {
    /// Index into [`Plan::nodes`].
    pub node: usize,
    /// Index into the node's results; 0 is the main one.
    pub result: usize,
}

/// A file to write.
#[derive(Debug, Clone)]
pub struct PlanOutput {
    /// Its path as written, relative to the graph's folder.
    pub path: String,
    /// What is written to it.
    pub result: ResultRef,
    /// The place of the path in the text.
    pub span: Range<usize>,
}

impl Origin {
    /// All results this origin needs, in the order they are written.
    pub fn results(&self) -> Vec<ResultRef> {
        match self {
            Self::Absent | Self::Constant(_) => Vec::new(),
            Self::Result(result) => vec![*result],
            Self::Expression(expression) => expression.results(),
            Self::List(items) => items.iter().flat_map(Self::results).collect(),
            Self::Vector(parts) => parts.iter().flat_map(Self::results).collect(),
            Self::Formula(template) => template.results(),
        }
    }
}

impl Plan {
    /// The index of the node of that name.
    pub fn node_index(&self, name: &str) -> Option<usize> {
        self.nodes.iter().position(|node| node.name == name)
    }

    /// The result that is called `node`, the node's main one, or `node.result`.
    ///
    /// Node names hold no dot.
    pub fn result(&self, name: &str) -> Option<ResultRef> {
        let (node, result) = match name.split_once('.') {
            Some((node, result)) => (node, Some(result)),
            None => (name, None),
        };
        self.result_of(node, result)
    }

    /// The result of that name of a node; its main one without a name.
    pub fn result_of(&self, node: &str, result: Option<&str>) -> Option<ResultRef> {
        let node = self.node_index(node)?;
        let results = self.nodes[node].spec.outputs;
        let result = match result {
            Some(name) => results.iter().position(|other| other.name == name)?,
            None => 0,
        };
        (result < results.len()).then_some(ResultRef { node, result })
    }

    /// Which nodes these results need, themselves included; one entry per node.
    pub fn needed(&self, results: impl IntoIterator<Item = ResultRef>) -> Vec<bool> {
        let mut needed = vec![false; self.nodes.len()];
        for result in results {
            needed[result.node] = true;
        }
        // Nodes stand after those they depend on.
        for index in (0..needed.len()).rev() {
            if needed[index] {
                for input in &self.nodes[index].inputs {
                    for result in input.origin.results() {
                        needed[result.node] = true;
                    }
                }
            }
        }
        needed
    }

    /// The spec of a result.
    pub fn result_spec(&self, result: ResultRef) -> &'static crate::node::OutputSpec {
        &self.nodes[result.node].spec.outputs[result.result]
    }
}
