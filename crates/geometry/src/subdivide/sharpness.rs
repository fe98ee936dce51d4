//! Sharpness of edges and vertices, and how it decays.

use crate::mesh::{AttributeValues, Domain, Mesh};
use crate::parallel;
use crate::topology::Topology;
use crate::{GeometryError, Monitor};

use super::Boundary;

/// Corner attribute that holds the sharpness of the edge leaving each corner.
pub const CREASE: &str = "crease";

/// Vertex attribute that holds the sharpness of each vertex.
pub const CORNER_SHARPNESS: &str = "corner_sharpness";

/// From this sharpness on an edge or vertex stays sharp for ever (OpenSubdiv's
/// convention).
pub const INFINITELY_SHARP: f64 = 10.0;

/// Sharpness of all edges and vertices of a topology; infinite where it never
/// decays: boundary edges, isolated vertices, vertices that several sheets
/// share, and everything from [`INFINITELY_SHARP`] on.
pub(super) struct Sharpness {
    edges: Vec<f64>,
    vertices: Vec<f64>,
}

impl Sharpness {
    /// Reads the attributes of `mesh` and applies the boundary rule.
    pub(super) fn read(
        mesh: &Mesh,
        boundary: Boundary,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        let topology = mesh.topology();
        let adjacency = topology.adjacency();
        let creases = numbers(mesh, CREASE, Domain::Corner);
        let corners = numbers(mesh, CORNER_SHARPNESS, Domain::Vertex);
        let edges = parallel::map(adjacency.edge_count(), monitor, |edge| {
            if adjacency.is_boundary_edge(edge) {
                return f64::INFINITY;
            }
            let sides = adjacency.edge_corners(edge).iter();
            normalised(
                sides
                    .map(|&corner| creases.at(corner as usize))
                    .fold(0.0, f64::max),
            )
        })?;
        let vertices = parallel::map(topology.vertex_count(), monitor, |vertex| {
            if is_always_sharp(topology, boundary, vertex) {
                f64::INFINITY
            } else {
                normalised(corners.at(vertex))
            }
        })?;
        Ok(Self { edges, vertices })
    }

    pub(super) fn new(edges: Vec<f64>, vertices: Vec<f64>) -> Self {
        Self { edges, vertices }
    }

    /// Sharpness that is left of an edge after `level` refinements.
    pub(super) fn edge(&self, edge: usize, level: u32) -> f64 {
        decayed(self.edges[edge], level)
    }

    /// Sharpness that is left of a vertex after `level` refinements.
    pub(super) fn vertex(&self, vertex: usize, level: u32) -> f64 {
        decayed(self.vertices[vertex], level)
    }
}

/// A vertex keeps its place for ever when no smooth rule is defined for it.
fn is_always_sharp(topology: &Topology, boundary: Boundary, vertex: usize) -> bool {
    let corners = topology.adjacency().vertex_corners(vertex);
    match corners.len() {
        0 => true,
        1 => boundary == Boundary::EdgeAndCorner,
        _ => topology.fan_count(vertex) > 1,
    }
}

/// What is left of `sharpness` after `level` refinements: one less each time
/// ("Uniform" creases; DeRose, Kass and Truong 1998).
pub(super) fn decayed(sharpness: f64, level: u32) -> f64 {
    (sharpness - f64::from(level)).max(0.0)
}

/// As [`decayed`], for a sharpness as it stands in an attribute.
pub(super) fn decayed_attribute(sharpness: f64, level: u32) -> f64 {
    if sharpness >= INFINITELY_SHARP {
        sharpness
    } else {
        decayed(sharpness, level)
    }
}

fn normalised(sharpness: f64) -> f64 {
    if sharpness >= INFINITELY_SHARP {
        f64::INFINITY
    } else {
        sharpness.max(0.0)
    }
}

/// A numeric attribute that reads as 0 everywhere when the mesh has none.
enum Numbers<'a> {
    None,
    Whole(&'a [i64]),
    Real(&'a [f64]),
}

impl Numbers<'_> {
    fn at(&self, index: usize) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Whole(values) => values[index] as f64,
            Self::Real(values) => values[index],
        }
    }
}

fn numbers<'a>(mesh: &'a Mesh, name: &str, domain: Domain) -> Numbers<'a> {
    match mesh
        .attribute(name, domain)
        .map(|attribute| attribute.values())
    {
        Some(AttributeValues::Number(values)) => Numbers::Real(values),
        Some(AttributeValues::Integer(values)) => Numbers::Whole(values),
        _ => Numbers::None,
    }
}
