//! Faces as fans of triangles.

use std::sync::Arc;

use tessgraph_geometry::domains::{self, chosen_faces};
use tessgraph_geometry::{Amount, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::support::memory::afford;
use crate::triangulate_faces::OrderChoice;

/// Replaces each face by triangles from its edges to a centre.
///
/// A component's u then runs along the face's outer edge and its v towards the
/// centre, so any polygon can be covered. The centre is the mean of the corners
/// weighted by the lengths of their two edges. The face attribute `source_face`
/// says where each triangle comes from.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "hexagons": ReadMesh(path: "meshes/hexagons.obj"),
///     "out": FanFaces(mesh: "hexagons"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct FanFaces {
    /// Mesh whose faces are replaced.
    mesh: Arc<Mesh>,
    /// Which faces are replaced: those where this is 0.5 or more.
    #[input(default = 1.0)]
    faces: Amount,
    /// Where the triangles stand among the faces.
    #[input(default = Together)]
    order: OrderChoice,
}

impl Node for FanFaces {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let chosen = chosen_faces(&self.mesh, &self.faces)
            .map_err(|error| NodeError::from(error).at_input("faces"))?;
        // A triangle for each corner.
        afford(4, [&*self.mesh], cx)?;
        let fan = domains::fan_faces(&self.mesh, &chosen, self.order.into())?;
        Ok(Arc::new(fan))
    }
}
