//! The graph, and what became of it.

use serde::Serialize;

use super::{Entry, Value};

/// The graph file.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Document {
    /// Its text.
    pub source: String,
    /// The unit of every length in it: "m", "cm", "mm", "ft", "in".
    pub units: String,
    /// In the order of the file.
    pub parameters: Vec<Parameter>,
    /// In the order they are evaluated.
    pub nodes: Vec<GraphNode>,
    /// In the order of the file.
    pub outputs: Vec<Output>,
    /// Whether an edit made here can be taken back.
    pub can_undo: bool,
    /// Whether one that was taken back can be made again.
    pub can_redo: bool,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// "number", "integer", "bool", "text", "path" or "choice".
    pub kind: String,
    /// What the graph runs with now, in the file's units.
    pub value: Value,
    /// What the file says now.
    pub in_file: Value,
    /// What the file said when the session began.
    pub initial: Value,
    /// The smallest value allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// The largest value allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// The sign of its unit: "m", "°" or nothing.
    pub unit: String,
    /// The names a choice is made from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of: Option<Vec<String>>,
    /// What it means.
    pub about: String,
    /// Whether `--set` holds it.
    pub locked: bool,
    /// The line of its value, from 1.
    pub line: usize,
    /// The bytes of its value in the source.
    pub span: [usize; 2],
}

/// A node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GraphNode {
    /// Its name; behind those of the nodes that include its graph.
    pub name: String,
    /// Its kind.
    pub kind: String,
    /// What its kind does, in a sentence.
    pub about: String,
    /// The line where it stands in the source, or where the graph is included
    /// that it stands in.
    pub line: usize,
    /// The bytes of the same.
    pub span: [usize; 2],
    /// Its inputs that are written.
    pub inputs: Vec<NodeInput>,
    /// Its results.
    pub results: Vec<NodeResult>,
}

/// An input of a node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NodeInput {
    /// Its name.
    pub name: String,
    /// What is written there.
    pub text: String,
    /// The nodes it takes results of.
    pub from: Vec<String>,
}

/// A result of a node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NodeResult {
    /// Its name.
    pub name: String,
    /// "Mesh", "Directions", "Field", "Report", "Table", "Number", ...
    pub kind: String,
    /// Whether the node's bare name means it.
    pub main: bool,
}

/// An output.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Output {
    /// Its path as written.
    pub path: String,
    /// The node whose result it is.
    pub node: String,
    /// The name of the result.
    pub result: String,
    /// What kind of value it is.
    pub kind: String,
}

/// The state of the graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// What is shown is what the file says.
    UpToDate,
    /// It is being computed.
    #[default]
    Computing,
    /// Something is wrong: the pictures are of the last good run.
    Stale,
    /// A file is missing.
    Waiting,
    /// The run was stopped.
    Cancelled,
}

/// Whether what is shown is true.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Status {
    /// The state.
    pub state: State,
    /// Milliseconds of the last run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ms: Option<f64>,
    /// Nodes dealt with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub done: Option<usize>,
    /// Nodes there are to deal with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub total: Option<usize>,
    /// A node at work.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node: Option<String>,
    /// How much of that node's work is done, from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fraction: Option<f64>,
    /// Errors in the graph, or nodes that failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors: Option<usize>,
    /// The line of the first of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// The file that is missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waiting_for: Option<String>,
    /// What the run is or was for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cause: Option<String>,
}

/// What became of a node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NodeOutcome {
    /// Its name.
    pub name: String,
    /// As in reports; besides "running" and "stale".
    pub outcome: String,
    /// Milliseconds its evaluation took.
    pub ms: f64,
    /// Bytes of its results.
    pub bytes: usize,
    /// What it warned of.
    pub warnings: Vec<String>,
    /// What has changed since the run before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub explain: Option<String>,
}

/// Something that is wrong.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Problem {
    /// A stable name for this kind of problem.
    pub code: String,
    /// "error" or "warning".
    pub severity: String,
    /// What is wrong.
    pub message: String,
    /// The file it is in.
    pub file: String,
    /// The line of its place, from 1.
    pub line: usize,
    /// The column, in characters from 1.
    pub column: usize,
    /// The bytes of the place.
    pub span: [usize; 2],
    /// The place, and others that explain it.
    pub labels: Vec<ProblemLabel>,
    /// What to do about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub help: Option<String>,
    /// All of it as plain text.
    pub rendered: String,
}

/// A place in a text, with a remark.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProblemLabel {
    /// The remark.
    pub message: String,
    /// The line, from 1.
    pub line: usize,
    /// The column, in characters from 1.
    pub column: usize,
    /// The bytes.
    pub span: [usize; 2],
}

/// A measurement or check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// The node that makes it.
    pub node: String,
    /// The node's kind.
    pub kind: String,
    /// What it found.
    pub values: Vec<Entry>,
    /// Whether it is passed; nothing for a plain measurement.
    pub ok: Option<bool>,
    /// The same as a sentence.
    pub sentence: String,
}

/// What is known of a node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Described {
    /// The node.
    pub node: String,
    /// The reference page of its kind.
    pub markdown: String,
    /// What came out.
    pub results: Vec<ResultSummary>,
    /// What it warned of.
    pub warnings: Vec<String>,
}

/// A result in a few lines.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResultSummary {
    /// Its name.
    pub name: String,
    /// Counts, ranges, measures.
    pub summary: String,
}
