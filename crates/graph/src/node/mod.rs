//! A node as data: what it takes, what it gives, and the function between.

mod context;
mod error;
mod preview;

pub use context::{EvalCx, FileUse};
pub use error::NodeError;
pub use preview::{Preview, TakeApart};

use tessgraph_geometry::Quantity;

use crate::value::{ChoiceSpec, Kind, OutputType, Report, Value};

/// One input, as data: parser, checker, reference page and editor read this.
#[derive(Debug, Clone, Copy)]
pub struct InputSpec {
    /// Its name in a graph file.
    pub name: &'static str,
    /// What it means.
    pub doc: &'static str,
    /// What kind of value it takes.
    pub kind: Kind,
    /// What its numbers measure; they are written in the file's units.
    pub quantity: Quantity,
    /// Whether it may be left out although it has no default.
    pub optional: bool,
    /// The value it has when left out, in SI units.
    pub default: Option<fn() -> Value>,
    /// The smallest number allowed, in SI units.
    pub min: Option<f64>,
    /// A number that every value must exceed, in SI units.
    pub above: Option<f64>,
    /// The largest number allowed, in SI units.
    pub max: Option<f64>,
    /// The names to choose from, for choices.
    pub choices: &'static [ChoiceSpec],
    /// How many items a list must have, if that is fixed.
    pub length: Option<usize>,
    /// The variables a formula may use besides mesh attributes.
    pub free: &'static [FreeName],
    /// Whether a formula may use mesh attributes by name.
    pub attributes: bool,
    /// This input counts only while that choice has one of these values.
    pub only_with: Option<(&'static str, &'static [&'static str])>,
}

/// A variable that a formula may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FreeName {
    /// Its name.
    pub name: &'static str,
    /// What it measures; the formula sees it in the file's units.
    pub quantity: Quantity,
}

/// One result, as data.
#[derive(Debug, Clone, Copy)]
pub struct OutputSpec {
    /// Its name, used as `"node.name"`.
    pub name: &'static str,
    /// What it means.
    pub doc: &'static str,
    /// What kind of value it is.
    pub kind: Kind,
    /// What its numbers measure.
    pub quantity: Quantity,
    /// For a count of faults, which ought to be 0: the inputs without which it
    /// counts none. `None` for everything else.
    pub faults: Option<&'static [&'static str]>,
}

/// The inputs of a node, derived from the struct that holds them.
pub trait Inputs: Sized {
    /// The node's name in a graph file.
    const NAME: &'static str;
    /// Its reference page: the struct's doc comment.
    const DOC: &'static str;
    /// Its inputs in order.
    const INPUTS: &'static [InputSpec];

    /// Takes the typed values out of `args`.
    ///
    /// # Errors
    /// When a value is of another kind than its spec says, which the checker
    /// rules out beforehand.
    fn bind(args: &mut Args) -> Result<Self, NodeError>;
}

/// The results of a node.
pub trait Outputs {
    /// The results in order; the first is what the node's bare name means.
    const OUTPUTS: &'static [OutputSpec];

    /// The values in the order of [`Outputs::OUTPUTS`].
    fn into_values(self) -> Vec<Value>;
}

/// What a node does, written by hand beside its inputs.
pub trait Node: Inputs {
    /// What it gives: one value, or a struct that derives [`Outputs`].
    type Output: Outputs;
    /// Raised whenever results change: entries in caches then no longer match.
    const VERSION: u32 = 1;
    /// What a picture may show of it before it is evaluated anew.
    const PREVIEW: Preview = Preview::NONE;

    /// Computes the results. Pure: equal inputs give equal bytes.
    ///
    /// # Errors
    /// What is wrong with the input values, by element id, with a way out.
    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError>;
}

/// A kind of node as data, for the registry.
#[derive(Debug, Clone, Copy)]
pub struct NodeSpec {
    /// Its name in a graph file.
    pub name: &'static str,
    /// Its reference page.
    pub doc: &'static str,
    /// Its version, part of every cache key.
    pub version: u32,
    /// Its inputs in order.
    pub inputs: &'static [InputSpec],
    /// Its results in order; the first is the main one.
    pub outputs: &'static [OutputSpec],
    /// What a picture may show of it before it is evaluated anew.
    pub preview: Preview,
    /// Computes the results from one value per input (`None` where left out).
    pub eval: fn(Args, &EvalCx<'_>) -> Result<Vec<Value>, NodeError>,
}

impl NodeSpec {
    /// The entry of node `N` for a registry.
    pub const fn of<N: Node>() -> Self {
        Self {
            name: N::NAME,
            doc: N::DOC,
            version: N::VERSION,
            inputs: N::INPUTS,
            outputs: <N::Output as Outputs>::OUTPUTS,
            preview: N::PREVIEW,
            eval: |mut args, cx| Ok(N::bind(&mut args)?.eval(cx)?.into_values()),
        }
    }

    /// The input of that name.
    pub fn input(&self, name: &str) -> Option<&'static InputSpec> {
        self.inputs.iter().find(|input| input.name == name)
    }
}

/// A node with one result: it is called after its kind and is the main one.
impl<T: OutputType> Outputs for T {
    const OUTPUTS: &'static [OutputSpec] = &[OutputSpec {
        name: "result",
        doc: "The result.",
        kind: T::KIND,
        quantity: Quantity::Number,
        faults: None,
    }];

    fn into_values(self) -> Vec<Value> {
        vec![self.into_value()]
    }
}

/// The values of a node's inputs, taken out one by one in order.
#[derive(Debug)]
pub struct Args {
    values: std::vec::IntoIter<Option<Value>>,
}

impl Args {
    /// One value per input; `None` where an optional one was left out.
    pub fn new(values: Vec<Option<Value>>) -> Self {
        Self {
            values: values.into_iter(),
        }
    }

    /// The next input's value as it is; `None` if it was left out.
    pub(crate) fn next_value(&mut self) -> Option<Value> {
        self.values.next().flatten()
    }

    /// The next input's value as its Rust type.
    ///
    /// # Errors
    /// When it is missing or of another kind.
    pub fn take<T: crate::value::InputType>(&mut self, spec: &InputSpec) -> Result<T, NodeError> {
        let typed = match self.values.next().flatten() {
            Some(value) => T::from_value(value),
            None => T::absent(),
        };
        typed.ok_or_else(|| {
            let wanted = spec.kind.label();
            NodeError::new(format!("`{}` takes {wanted}", spec.name)).at_input(spec.name)
        })
    }
}

/// The spec of the report that [`with_report`] puts first.
pub const REPORT: OutputSpec = OutputSpec {
    name: "report",
    doc: "All the numbers below as one report.",
    kind: Kind::Report,
    quantity: Quantity::Number,
    faults: None,
};

/// The report of a node's scalar results, put before them: for results that
/// derive [`Outputs`] with `#[outputs(report)]`.
pub fn with_report(specs: &[OutputSpec], mut values: Vec<Value>) -> Vec<Value> {
    let report = Report::of_results(&specs[1..], &values);
    values.insert(0, Value::Report(report.into()));
    values
}
