//! The messages between the server and its page: JSON texts, each an object
//! whose `type` says what it is.
//!
//! The server keeps all state. A message replaces an earlier one of its type as
//! a whole, so a page that has one of each knows everything.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize, Serializer};
use tessgraph_geometry::digest::Digest;

/// The name of a buffer: 32 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct BufferName(pub Digest);

impl Serialize for BufferName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&self.0)
    }
}

/// A single value: of a parameter, a cell, a line of a report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// True or false.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A real number; null in JSON where it is not finite.
    Number(f64),
    /// A text, a path, the name of a choice.
    Text(String),
}

/// What the server tells the page.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ToPage {
    /// Who speaks; the first message of a connection.
    Hello(Hello),
    /// The graph file.
    Document(Document),
    /// Whether what is shown is true.
    Status(Status),
    /// What became of each node.
    Outcomes {
        /// In the order they are evaluated.
        nodes: Vec<NodeOutcome>,
    },
    /// What is wrong.
    Diagnostics {
        /// In the order of their places.
        items: Vec<Problem>,
    },
    /// What the graph measures and checks.
    Checks {
        /// In the order they are evaluated.
        items: Vec<Check>,
    },
    /// What the 3D view shows.
    Shown(Box<Shown>),
    /// The answer to [`FromPage::Pick`].
    Picked(Picked),
    /// The answer to [`FromPage::Measure`].
    Measured(Measured),
    /// The answer to [`FromPage::Section`].
    Sectioned(Sectioned),
    /// The answer to [`FromPage::Render`].
    Rendered {
        /// The number of the request.
        request: u64,
        /// The picture, a PNG.
        picture: BufferName,
    },
    /// The answer to [`FromPage::Describe`].
    Described(Described),
    /// The answer to [`FromPage::Preview`].
    Previewed(Box<Previewed>),
    /// Something people should know.
    Notice(Notice),
    /// The table of a study of the graph.
    Study(Study),
    /// What a page on another machine may do.
    Access {
        /// Whether it may change values.
        may_edit: bool,
    },
    /// With whom the page is shared: the answer to [`Sharing`].
    Shares(Shares),
}

/// With whom the page is shared.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Shares {
    /// Where devices of the network find it, if they may.
    pub lan: Option<Lan>,
    /// The devices.
    pub pairings: Vec<Pairing>,
}

/// Where devices of the network find the page.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Lan {
    /// The address, without a secret.
    pub address: String,
    /// Whether they may change values.
    pub edit: bool,
}

/// A device that was given an address.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Pairing {
    /// Its number.
    pub id: u32,
    /// Its address, with its secret.
    pub url: String,
    /// Pages that are open there.
    pub connected: usize,
}

/// Who speaks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hello {
    /// Of the program.
    pub version: String,
    /// The graph file's name.
    pub file: String,
    /// The folder it is in.
    pub folder: String,
    /// Another one after each start of the server.
    pub session: String,
    /// Whether the page may change nothing.
    pub read_only: bool,
}

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

/// A named value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// The value, in the file's units.
    pub value: Option<Value>,
    /// The sign of its unit.
    pub unit: String,
}

/// What the 3D view shows: one mesh, with directions and fields laid over it.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Shown {
    /// The node.
    pub node: String,
    /// The name of its result.
    pub result: String,
    /// What kind of value that is.
    pub kind: String,
    /// One more whenever anything below is another.
    pub version: u64,
    /// Why there is nothing to draw.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub empty: Option<String>,
    /// The mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<ShownMesh>,
    /// Directions on it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub directions: Option<ShownDirections>,
    /// Every field that fits its vertices or faces.
    pub fields: Vec<ShownField>,
    /// The rows, where the result is a table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<ShownTable>,
    /// The values, where the result is a report or a single value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub report: Option<Vec<Entry>>,
}

/// A mesh, in buffers about a local origin.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShownMesh {
    /// How many vertices.
    pub vertices: usize,
    /// How many faces.
    pub faces: usize,
    /// How many triangles they are drawn as.
    pub triangles: usize,
    /// What positions are relative to, in metres.
    pub origin: [f64; 3],
    /// Smallest and largest coordinates, in metres.
    pub bounds: [[f64; 3]; 2],
    /// Units of the file in a metre.
    pub scale: f64,
    /// Three `f32` per vertex.
    pub positions: BufferName,
    /// Three `u32` per triangle: vertices.
    pub triangles_buffer: BufferName,
    /// A `u32` per triangle: its face; ascending.
    pub triangle_faces: BufferName,
    /// A byte per triangle: bit k says that the side from corner k to the next
    /// one is a side of the face.
    pub edges: BufferName,
    /// A `u32` per face: the face of the base it came from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_faces: Option<BufferName>,
    /// Bytes of each of them.
    pub buffers: BTreeMap<BufferName, usize>,
}

/// Directions on the shown mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShownDirections {
    /// What has one: "vertex".
    pub per: &'static str,
    /// Three `f32` per vertex, in metres.
    pub outward: BufferName,
    /// What they are on: "mesh".
    pub on: &'static str,
}

/// A field on the shown mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShownField {
    /// Its name, one of a kind.
    pub name: String,
    /// What people call it.
    pub label: String,
    /// "vertex" or "face".
    pub on: &'static str,
    /// The sign of its unit.
    pub unit: String,
    /// The smallest value.
    pub min: f64,
    /// The largest value.
    pub max: f64,
    /// An `f32` per element, in the file's units.
    pub values: BufferName,
    /// Whether its values are labels, not amounts.
    pub categorical: bool,
    /// The node that made it.
    pub node: String,
}

/// The beginning of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShownTable {
    /// Its columns.
    pub columns: Vec<ShownColumn>,
    /// Its first rows.
    pub rows: Vec<Vec<Option<Value>>>,
    /// How many rows there are.
    pub total: usize,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShownColumn {
    /// Its heading.
    pub name: String,
    /// The sign of its unit.
    pub unit: String,
}

/// A number with its unit, as text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Amount {
    /// With the digits people can use.
    pub text: String,
    /// With all that are known.
    pub exact: String,
}

impl From<String> for Amount {
    /// What is no number, or has no more digits.
    fn from(text: String) -> Self {
        let exact = text.clone();
        Self { text, exact }
    }
}

/// What is known of a face or a vertex.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Picked {
    /// The number of the request.
    pub request: u64,
    /// The face.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub face: Option<usize>,
    /// The vertex.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertex: Option<usize>,
    /// Labels, and values with their units.
    pub lines: Vec<(String, Amount)>,
    /// The outline in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertices: Option<Vec<[f64; 3]>>,
}

/// A distance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// The number of the request.
    pub request: u64,
    /// One end, in metres.
    pub from: [f64; 3],
    /// The other, in metres.
    pub to: [f64; 3],
    /// How far they are apart, with its unit.
    pub distance: Amount,
    /// The same along each axis.
    pub delta: [Amount; 3],
}

/// The cut of the mesh that is shown.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sectioned {
    /// The number of the request.
    pub request: u64,
    /// What the segments are relative to, in metres.
    pub origin: [f64; 3],
    /// Both ends of each segment, six `f32` in metres; those of closed outlines
    /// first, each with the body to its left, seen against the plane's normal.
    pub segments: BufferName,
    /// The panel of each segment, `u32`.
    pub panels: BufferName,
    /// How many segments there are.
    pub count: usize,
    /// How many of them are of closed outlines.
    pub closed_count: usize,
    /// Outlines that come back to where they began.
    pub closed: usize,
    /// Outlines that end somewhere: the body is open there.
    pub open: usize,
    /// Length of all outlines.
    pub length: Amount,
    /// Area within the closed ones.
    pub area: Amount,
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

/// How the picture follows a parameter before the graph is evaluated.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Previewed {
    /// The number of the request.
    pub request: u64,
    /// Why it cannot; then there is nothing else.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The [`Shown::version`] whose vertices the instances have.
    pub version: u64,
    /// What the vertices are made of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instances: Option<Instances>,
    /// Values of the parameter, ascending, and what all heights of the array are
    /// then multiplied by.
    pub factors: Vec<[f64; 2]>,
    /// Whether what will be evaluated is exactly that, between the values too.
    pub is_exact: bool,
}

/// The parts of an array: each of its vertices is a point of a component over a grid
/// of base vertices, at X = P(u, v) + h D(u', v').
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Instances {
    /// Two `u32` per vertex of the array: its placement, its point.
    pub vertices: BufferName,
    /// Eight `f32` per point: the first of the four grid vertices about (u, v), how
    /// far it is to the next along u and v, its height; the same of (u', v'), and
    /// the vertices in a row of the grid.
    pub points: BufferName,
    /// A `u32` each: the base's vertices under the placements, row by row.
    pub grids: BufferName,
    /// A `u32` per placement: where its grid begins.
    pub grid_starts: BufferName,
    /// Three `f32` per base vertex, about the origin of the shown mesh.
    pub positions: BufferName,
    /// Four `f32` per base vertex: the direction for heights from 0 on, its length.
    pub outward: BufferName,
    /// The same for heights below 0, where it is another.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inward: Option<BufferName>,
    /// Whether directions are units, and lengths interpolated apart.
    pub is_unit: bool,
    /// An `f32` per base vertex each: what heights are multiplied by there.
    pub factors: Vec<BufferName>,
    /// How far from the base the heights reach at most, in metres.
    pub reach: f64,
    /// Bytes of each of them.
    pub buffers: BTreeMap<BufferName, usize>,
}

/// A result in a few lines.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResultSummary {
    /// Its name.
    pub name: String,
    /// Counts, ranges, measures.
    pub summary: String,
}

/// How much a notice matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// Good to know.
    Info,
    /// Something was not done.
    Warning,
    /// Something went wrong.
    Error,
}

/// Something people should know.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Notice {
    /// How much it matters.
    pub level: Level,
    /// What.
    pub text: String,
}

/// The table of a study of the graph.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Study {
    /// The table's path.
    pub path: String,
    /// Its headings.
    pub columns: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<Option<Value>>>,
    /// The number of the picture of each row that has one; none at all if empty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pictures: Vec<Option<usize>>,
}

/// What the page asks for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum FromPage {
    /// Evaluate with another value of a parameter.
    Set {
        /// The parameter.
        name: String,
        /// The value, in the file's units.
        value: Value,
    },
    /// Put a value into the file.
    Write {
        /// The parameter.
        name: String,
        /// The value, in the file's units.
        value: Value,
    },
    /// Put back what the file said when the session began.
    Reset {
        /// The parameter.
        name: String,
    },
    /// Take back the last edit made here.
    Undo,
    /// Make the last edit again that was taken back.
    Redo,
    /// Show another result.
    Show {
        /// The node.
        node: String,
        /// The name of the result; the main one if left out.
        result: Option<String>,
    },
    /// Stop the run at work.
    Cancel,
    /// Run, whatever has changed.
    Run,
    /// Tell what is known of a face or a vertex.
    Pick {
        /// A number for the answer.
        request: u64,
        /// The face.
        face: Option<usize>,
        /// The vertex, of the face if both are given.
        vertex: Option<usize>,
    },
    /// Measure a distance.
    Measure {
        /// A number for the answer.
        request: u64,
        /// One end.
        from: MeasureEnd,
        /// The other.
        to: MeasureEnd,
    },
    /// Cut what is shown.
    Section {
        /// A number for the answer.
        request: u64,
        /// Where.
        plane: PlaneAsked,
    },
    /// Draw what is shown, for a browser that cannot.
    Render {
        /// A number for the answer.
        request: u64,
        /// Width and height in pixels.
        size: [u32; 2],
        /// From the model towards the eye; not zero.
        towards: [f64; 3],
    },
    /// Tell how the picture follows a parameter before the graph is evaluated.
    Preview {
        /// A number for the answer.
        request: u64,
        /// The parameter.
        name: String,
        /// The smallest value that it may be given next, in the file's units.
        from: f64,
        /// The largest one.
        to: f64,
    },
    /// Tell what is known of a node.
    Describe {
        /// The node.
        node: String,
    },
}

impl FromPage {
    /// Whether it changes the graph, what it runs with, or the run at work.
    pub fn is_change(&self) -> bool {
        use FromPage::{Cancel, Redo, Reset, Run, Set, Undo, Write};
        matches!(
            self,
            Set { .. } | Write { .. } | Reset { .. } | Undo | Redo | Cancel | Run
        )
    }
}

/// What the owner's page asks about sharing; the server sees to it itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Sharing {
    /// With whom it is shared.
    Shares,
    /// Give another device an address.
    Pair,
    /// Take an address back.
    Unpair {
        /// The device's number.
        id: u32,
    },
}

/// An end of a measured distance.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
pub struct MeasureEnd {
    /// A vertex.
    pub vertex: Option<usize>,
    /// Or a face.
    pub face: Option<usize>,
    /// Or a place of a cut.
    pub cut: Option<CutPlace>,
}

/// A plane.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct PlaneAsked {
    /// Its direction; need not be of length one.
    pub normal: [f64; 3],
    /// Its distance from the origin along that, in metres.
    pub at: f64,
}

/// The place of a cut that is closest to another.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct CutPlace {
    /// Where is cut.
    pub plane: PlaneAsked,
    /// Near this place, in metres.
    pub near: [f64; 3],
    /// Corners within this many metres are taken before sides.
    pub snap: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_read_as_they_are_agreed() {
        let read = |text: &str| serde_json::from_str::<FromPage>(text);
        let name = || "t".to_owned();
        for (text, expected) in [
            (
                r#"{"type":"set","name":"t","value":0.5}"#,
                FromPage::Set {
                    name: name(),
                    value: Value::Number(0.5),
                },
            ),
            (
                r#"{"type":"write","name":"t","value":3}"#,
                FromPage::Write {
                    name: name(),
                    value: Value::Integer(3),
                },
            ),
            (r#"{"type":"undo"}"#, FromPage::Undo),
            (
                r#"{"type":"show","node":"t"}"#,
                FromPage::Show {
                    node: name(),
                    result: None,
                },
            ),
            (
                r#"{"type":"pick","request":7,"face":2}"#,
                FromPage::Pick {
                    request: 7,
                    face: Some(2),
                    vertex: None,
                },
            ),
        ] {
            assert_eq!(read(text).unwrap(), expected);
        }
        for wrong in [
            "",
            "{}",
            r#"{"type":"format"}"#,
            r#"{"type":"set","name":"t"}"#,
            r#"{"type":"pick","request":-1}"#,
        ] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn messages_are_flat_objects_with_a_type() {
        let status = ToPage::Status(Status {
            state: State::UpToDate,
            ms: Some(1.5),
            ..Status::default()
        });
        assert_eq!(
            serde_json::to_string(&status).unwrap(),
            r#"{"type":"status","state":"up_to_date","ms":1.5}"#
        );
        let entry = Entry {
            name: "a".to_owned(),
            value: Some(Value::Number(f64::NAN)),
            unit: String::new(),
        };
        assert_eq!(
            serde_json::to_string(&entry).unwrap(),
            r#"{"name":"a","value":null,"unit":""}"#
        );
    }
}
