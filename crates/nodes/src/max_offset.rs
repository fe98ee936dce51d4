//! How far a surface can be offset.

use std::sync::Arc;

use tessgraph_geometry::{Field, Mesh, fields};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Inputs, Outputs};

/// Gives the largest offset at each vertex before the surface meets itself.
///
/// It is the radius of the largest ball that touches the surface at the vertex
/// with nothing of the surface inside: how far it is to the medial axis (Wallner
/// et al. 2001). Between walls it is half their gap, in a valley the radius of
/// the fold. A thickness beyond it cannot be free of crossings along normals.
/// Half the face size means a quarter of the error.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": ParametricSurface(x: "4 * u", y: "2 * v", z: "0.5 * sin(u * tau)", cells: [24, 6]),
///     "out": MaxOffset(mesh: "base", limit: 5),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct MaxOffset {
    /// Surface to be offset.
    mesh: Arc<Mesh>,
    /// Length beyond which there is room enough; left out, the diagonal of the
    /// bounding box.
    #[input(above = 0, unit = length)]
    limit: Option<f64>,
}

/// Room on both sides.
#[derive(Outputs)]
pub(crate) struct Offsets {
    /// Largest offset of each vertex along its normal.
    #[output(unit = length)]
    outward: Arc<Field>,
    /// Largest offset of each vertex against its normal.
    #[output(unit = length)]
    inward: Arc<Field>,
    /// The smallest outward offset.
    #[output(unit = length)]
    min_outward: f64,
    /// The smallest inward offset.
    #[output(unit = length)]
    min_inward: f64,
}

impl Node for MaxOffset {
    type Output = Offsets;
    const VERSION: u32 = 2;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let limit = self.limit.unwrap_or_else(|| self.mesh.diagonal());
        let found = fields::max_offset(&self.mesh, limit, cx.monitor())?;
        let used = |vertex: usize| {
            let adjacency = self.mesh.topology().adjacency();
            !adjacency.vertex_corners(vertex).is_empty()
        };
        let least = |field: &Field| {
            let values = field.values().iter().enumerate();
            values
                .filter(|&(vertex, _)| used(vertex))
                .fold(limit, |least, (_, &value)| least.min(value))
        };
        Ok(Offsets {
            min_outward: least(&found.outward),
            min_inward: least(&found.inward),
            outward: Arc::new(found.outward),
            inward: Arc::new(found.inward),
        })
    }
}
