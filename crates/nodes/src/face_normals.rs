//! The mean of face normals as directions.

use std::sync::Arc;

use tessgraph_geometry::{Directions, Mesh, directions};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Gives each vertex the mean normal of the faces round it, all alike.
///
/// Unlike `VertexNormals`, angles and areas do not count. With `unit: false` the
/// mean is shorter than 1 where faces meet at an angle.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "roof": ParametricSurface(x: "4 * u", y: "3 * v", z: "2 * abs(u - 0.5)", cells: [4, 3]),
///     "out": FaceNormals(mesh: "roof"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct FaceNormals {
    /// Mesh whose faces give the normals.
    mesh: Arc<Mesh>,
    /// Whether the means are brought to length 1.
    #[input(default = true)]
    unit: bool,
}

impl Node for FaceNormals {
    type Output = Arc<Directions>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let found = directions::face_normal_directions(&self.mesh, self.unit, cx.monitor())?;
        Ok(Arc::new(found))
    }
}
