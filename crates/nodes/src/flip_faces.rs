//! Faces turned round.

use std::sync::Arc;

use tessgraph_geometry::domains::{self, chosen_faces};
use tessgraph_geometry::{Amount, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Turns faces round, so that their normals point to the other side.
///
/// The first corner of a face stays (0, 0); u and v of its component change
/// places. Normals stored in the mesh are left alone.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "box": Cuboid(size: [1, 1, 1]),
///     "out": FlipFaces(mesh: "box"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct FlipFaces {
    /// Mesh whose faces are turned.
    mesh: Arc<Mesh>,
    /// Which faces are turned: those where this is 0.5 or more.
    #[input(default = 1.0)]
    faces: Amount,
}

impl Node for FlipFaces {
    type Output = Arc<Mesh>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let chosen = chosen_faces(&self.mesh, &self.faces)
            .map_err(|error| NodeError::from(error).at_input("faces"))?;
        Ok(Arc::new(domains::flip_chosen_faces(&self.mesh, &chosen)?))
    }
}
