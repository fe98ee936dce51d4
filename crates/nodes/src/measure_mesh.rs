//! Counts, area and volume.

use std::sync::Arc;

use tessgraph_geometry::{Mesh, measure};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Inputs, Outputs};

/// Measures a mesh: counts, borders, size, area and volume.
///
/// Results can be used in expressions: `"size.area * 25"`.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "box": Cuboid(size: [2, 1, 0.5]),
///     "out": MeasureMesh(mesh: "box"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct MeasureMesh {
    /// Mesh to measure.
    mesh: Arc<Mesh>,
}

/// What a mesh measures.
#[derive(Outputs)]
#[outputs(report)]
pub(crate) struct Measures {
    /// Vertices, isolated ones included.
    vertices: usize,
    /// Edges.
    edges: usize,
    /// Faces.
    faces: usize,
    /// Used vertices minus edges plus faces: 2 for a sphere, 0 for a torus, 1 for a disc.
    euler: i64,
    /// Connected pieces.
    components: usize,
    /// Loops of open edges.
    boundary_loops: usize,
    /// Edges with more than two faces.
    nonmanifold_edges: usize,
    /// Whether every edge has two faces of opposite sense, so that there is a volume.
    closed: bool,
    /// Extent along x.
    #[output(unit = length)]
    size_x: f64,
    /// Extent along y.
    #[output(unit = length)]
    size_y: f64,
    /// Extent along z.
    #[output(unit = length)]
    size_z: f64,
    /// Area of all faces.
    #[output(unit = area)]
    area: f64,
    /// Volume enclosed; 0 unless closed.
    #[output(unit = volume)]
    volume: f64,
}

impl Node for MeasureMesh {
    type Output = Measures;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let found = measure::measure_mesh(&self.mesh);
        if !found.is_finite() {
            let message = "the coordinates are so large that the area or volume overflows";
            return Err(NodeError::new(message).with_help("scale the mesh down with Transform"));
        }
        let size = found
            .bounds
            .map_or(glam::DVec3::ZERO, |(low, high)| high - low);
        Ok(Measures {
            vertices: found.vertices,
            edges: found.edges,
            faces: found.faces,
            euler: found.euler,
            components: found.components,
            boundary_loops: found.boundary_loops,
            nonmanifold_edges: found.nonmanifold_edges,
            closed: found.volume.is_some(),
            size_x: size.x,
            size_y: size.y,
            size_z: size.z,
            area: found.area,
            volume: found.volume.unwrap_or(0.0),
        })
    }
}
