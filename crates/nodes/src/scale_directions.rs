//! Directions flattened or stretched along the axes.

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::{Amount, Directions, Mesh, directions};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Multiplies x, y and z of directions, each by its own factor.
///
/// `(1, 1, 0)` makes them level, `(0, 0, 1)` upright. Vertices with nothing left
/// are named in an error.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "wall": ParametricSurface(x: "4 * u", y: "sin(u * tau) + 0.5 * v", z: "3 * v", cells: [8, 3]),
///     "normals": VertexNormals(mesh: "wall"),
///     "out": ScaleDirections(mesh: "wall", directions: "normals", factors: (1, 1, 0)),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ScaleDirections {
    /// Mesh the directions belong to.
    mesh: Arc<Mesh>,
    /// Directions to scale.
    directions: Arc<Directions>,
    /// Factors along x, y and z.
    factors: DVec3,
    /// How much each vertex takes part: 0 leaves a direction as it is, 1 scales it
    /// fully; a number or one per vertex.
    #[input(default = 1.0, min = 0, max = 1)]
    amount: Amount,
    /// Whether the results are brought back to length 1.
    #[input(default = true)]
    unit: bool,
}

impl Node for ScaleDirections {
    type Output = Arc<Directions>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let (mesh, from, monitor) = (&self.mesh, &self.directions, cx.monitor());
        let found = directions::scale_directions(
            mesh,
            from,
            self.factors,
            &self.amount,
            self.unit,
            monitor,
        )?;
        Ok(Arc::new(found))
    }
}
