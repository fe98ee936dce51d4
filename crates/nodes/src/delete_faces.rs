//! Faces taken away.

use std::sync::Arc;

use tessgraph_geometry::domains::{self, chosen_faces};
use tessgraph_geometry::{Amount, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Takes faces away, and the vertices that only they use.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "white": SelectFaces(mesh: "base", by: Checker),
///     "out": DeleteFaces(mesh: "base", faces: "white"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct DeleteFaces {
    /// Mesh that loses faces.
    mesh: Arc<Mesh>,
    /// Which faces go: those where this is 0.5 or more.
    faces: Amount,
}

impl Node for DeleteFaces {
    type Output = Arc<Mesh>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let chosen = chosen_faces(&self.mesh, &self.faces)
            .map_err(|error| NodeError::from(error).at_input("faces"))?;
        Ok(Arc::new(domains::delete_faces(&self.mesh, &chosen)?))
    }
}
