//! Directions between two others.

use std::sync::Arc;

use tessgraph_geometry::{Amount, Directions, Mesh, directions};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Blends two fields of directions, vertex by vertex.
///
/// Sense and length are blended apart, so unit directions stay unit. A field as
/// `amount` leads from one rule to another over the surface: normals along the
/// rim, say, and upright inside.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "roof": ParametricSurface(x: "4 * u", y: "3 * v", z: "2 * abs(u - 0.5)", cells: [4, 3]),
///     "normals": VertexNormals(mesh: "roof"),
///     "upright": ConstantDirection(mesh: "roof"),
///     "share": EvaluateField(mesh: "roof", value: "y / 3"),
///     "out": BlendDirections(mesh: "roof", a: "normals", b: "upright", amount: "share"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct BlendDirections {
    /// Mesh the directions belong to.
    mesh: Arc<Mesh>,
    /// Directions at amount 0.
    a: Arc<Directions>,
    /// Directions at amount 1.
    b: Arc<Directions>,
    /// Share of `b`, a number or one per vertex.
    #[input(default = 0.5, min = 0, max = 1)]
    amount: Amount,
}

impl Node for BlendDirections {
    type Output = Arc<Directions>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let (mesh, monitor) = (&self.mesh, cx.monitor());
        let found = directions::blend_directions(mesh, &self.a, &self.b, &self.amount, monitor)?;
        Ok(Arc::new(found))
    }
}
