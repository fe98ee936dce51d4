//! Several meshes as one.

use std::sync::Arc;

use crate::support::memory::afford;
use tessgraph_geometry::{Mesh, join};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Puts several meshes into one, one after the other.
///
/// Vertices are not merged. Materials, groups and objects of the same name become
/// one. An attribute that only some of the meshes have is 0 on the others.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "floor": Grid(cells: [4, 4], size: [4, 4]),
///     "box": Cuboid(size: [1, 1, 1]),
///     "out": JoinMeshes(meshes: ["floor", "box"]),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct JoinMeshes {
    /// The meshes in order.
    meshes: Vec<Arc<Mesh>>,
}

impl Node for JoinMeshes {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        if self.meshes.is_empty() {
            return Err(NodeError::new("there is nothing to join").at_input("meshes"));
        }
        let meshes: Vec<&Mesh> = self.meshes.iter().map(Arc::as_ref).collect();
        // Once as parts of attributes, and once whole.
        afford(2, meshes.iter().copied(), cx)?;
        Ok(Arc::new(join(&meshes)?))
    }
}
