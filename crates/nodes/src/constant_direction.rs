//! One direction everywhere.

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::{Directions, Mesh, directions};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Gives every vertex the same direction, upward by default.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "roof": ParametricSurface(x: "4 * u", y: "3 * v", z: "2 * abs(u - 0.5)", cells: [4, 3]),
///     "out": ConstantDirection(mesh: "roof", vector: (0, 1, 1)),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ConstantDirection {
    /// Mesh whose vertices get the direction.
    mesh: Arc<Mesh>,
    /// The direction.
    #[input(default = [0.0, 0.0, 1.0])]
    vector: DVec3,
    /// Whether it is brought to length 1, so that heights are distances along it.
    #[input(default = true)]
    unit: bool,
}

impl Node for ConstantDirection {
    type Output = Arc<Directions>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let found = directions::constant_direction(&self.mesh, self.vector, self.unit)
            .map_err(|error| NodeError::from(error).at_input("vector"))?;
        Ok(Arc::new(found))
    }
}
