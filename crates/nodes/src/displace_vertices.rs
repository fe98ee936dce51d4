//! A mesh whose vertices are moved along directions.

use std::sync::Arc;

use tessgraph_geometry::{Amount, Directions, Mesh, displace_vertices};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Moves every vertex along its direction: P + d D.
///
/// Negative distances use the inward directions. With directions from
/// `CompensateThickness` the distance is a true thickness.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [8, 8], size: [8, 8], centre: true),
///     "up": VertexNormals(mesh: "base"),
///     "height": EvaluateField(mesh: "base", value: "2 - (x ^ 2 + y ^ 2) / 16"),
///     "out": DisplaceVertices(mesh: "base", directions: "up", distance: "height"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct DisplaceVertices {
    /// Mesh whose vertices are moved.
    mesh: Arc<Mesh>,
    /// Directions of its vertices.
    directions: Arc<Directions>,
    /// How far, a number or one per vertex.
    #[input(unit = length)]
    distance: Amount,
}

impl Node for DisplaceVertices {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let (mesh, directions) = (&self.mesh, &self.directions);
        Ok(Arc::new(displace_vertices(
            mesh,
            directions,
            &self.distance,
            cx.monitor(),
        )?))
    }
}
