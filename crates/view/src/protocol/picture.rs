//! What the 3D view shows, and what is known of places in it.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Amount, BufferName, Entry, Value};

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
