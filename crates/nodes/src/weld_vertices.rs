//! Vertices at the same place joined.

use std::sync::Arc;

use crate::support::memory::afford;
use tessgraph_geometry::{Mesh, weld_border_vertices, weld_vertices};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Inputs, Outputs};

/// Joins vertices that lie within a distance of each other.
///
/// For imported soup of faces; arrays join their components exactly with
/// `ArrayComponents(join: Weld)`. Chains of near vertices become one, at the place
/// of the first, whatever the order. Faces with fewer than three corners left go.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "left": Grid(cells: [2, 2], size: [2, 2]),
///     "right": Transform(mesh: "left", translate: (2, 0, 0)),
///     "both": JoinMeshes(meshes: ["left", "right"]),
///     "out": WeldVertices(mesh: "both"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct WeldVertices {
    /// Mesh whose vertices are joined.
    mesh: Arc<Mesh>,
    /// Distance up to which vertices are joined; 0 joins equal places only.
    #[input(default = 1e-6, min = 0, unit = length)]
    distance: f64,
    /// Whether only vertices on open borders, and those of no face, are joined, so
    /// that details inside a surface are safe from a wide distance.
    #[input(default = false)]
    border_only: bool,
}

/// The welded mesh.
#[derive(Outputs)]
pub(crate) struct WeldedMesh {
    /// The mesh.
    mesh: Arc<Mesh>,
    /// Vertices that were joined to another.
    joined: usize,
    /// Faces that went.
    dropped_faces: usize,
}

impl Node for WeldVertices {
    type Output = WeldedMesh;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        afford(3, [&*self.mesh], cx)?;
        let (mesh, distance, monitor) = (&self.mesh, self.distance, cx.monitor());
        let welded = match self.border_only {
            true => weld_border_vertices(mesh, distance, monitor)?,
            false => weld_vertices(mesh, distance, monitor)?,
        };
        Ok(WeldedMesh {
            mesh: Arc::new(welded.mesh),
            joined: welded.joined,
            dropped_faces: welded.dropped_faces,
        })
    }
}
