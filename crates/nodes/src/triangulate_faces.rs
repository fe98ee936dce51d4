//! Faces cut into triangles.

use std::sync::Arc;

use crate::support::memory::afford;
use tessgraph_geometry::domains::{self, PieceOrder, chosen_faces};
use tessgraph_geometry::{Amount, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Cuts faces into triangles without changing the surface.
///
/// A quad p0 p1 p2 p3 becomes (p0, p1, p2) and (p0, p2, p3); polygons become
/// fans from their first corner, concave ones are cut inside. These are the
/// triangles that distances, areas and intersections are measured on. The face
/// attribute `source_face` says where each triangle comes from.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 2], size: [4, 2]),
///     "out": TriangulateFaces(mesh: "base"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct TriangulateFaces {
    /// Mesh whose faces are cut.
    mesh: Arc<Mesh>,
    /// Which faces are cut: those where this is 0.5 or more.
    #[input(default = 1.0)]
    faces: Amount,
    /// Where the triangles stand among the faces.
    #[input(default = Together)]
    order: OrderChoice,
}

/// Where the pieces of a face stand.
#[derive(Clone, Copy, Choice)]
#[choice(into = PieceOrder)]
pub(crate) enum OrderChoice {
    /// All in the place of their face.
    Together,
    /// One in the place of the face, the others at the end, as the add-on does.
    Appended,
}

impl Node for TriangulateFaces {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let chosen = chosen_faces(&self.mesh, &self.faces)
            .map_err(|error| NodeError::from(error).at_input("faces"))?;
        afford(3, [&*self.mesh], cx)?;
        let cut = domains::triangulate_faces(&self.mesh, &chosen, self.order.into())?;
        Ok(Arc::new(cut))
    }
}
