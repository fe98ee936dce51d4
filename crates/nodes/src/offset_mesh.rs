//! The base surface thickened.

use std::sync::Arc;

use crate::support::memory::afford;
use tessgraph_geometry::{Amount, Directions, Mesh, offset_mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Thickens a surface along directions into a closed shell (paper, figure 9).
///
/// The surface is moved outward and inward; open borders are closed by a strip
/// of quads. With directions from `CompensateThickness` both distances are true
/// thicknesses. The face attribute `part` is 0 on the outer, 1 on the inner side
/// and 2 on the strips.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "normals": VertexNormals(mesh: "base"),
///     "out": OffsetMesh(mesh: "base", directions: "normals", outward: 0.2),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct OffsetMesh {
    /// The surface.
    mesh: Arc<Mesh>,
    /// Directions of its vertices.
    directions: Arc<Directions>,
    /// Distance to the outer side, a number or one per vertex.
    #[input(default = 0.0, min = 0, unit = length)]
    outward: Amount,
    /// Distance to the inner side, a number or one per vertex.
    #[input(default = 0.0, min = 0, unit = length)]
    inward: Amount,
}

impl Node for OffsetMesh {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        // Two sides, and walls between them.
        afford(4, [&*self.mesh], cx)?;
        let (outward, inward) = (&self.outward, &self.inward);
        let shell = offset_mesh(&self.mesh, &self.directions, outward, inward, cx.monitor())?;
        Ok(Arc::new(shell))
    }
}
