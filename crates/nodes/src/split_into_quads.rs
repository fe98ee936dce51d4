//! Polygons cut into quads.

use std::sync::Arc;

use crate::support::memory::afford;
use tessgraph_geometry::{Mesh, domains, list_ids};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Cuts faces of more than four corners into quads and at most one triangle.
///
/// Each polygon becomes a strip, as in the paper's add-on. Triangles and quads
/// are kept and come first. Meant for convex polygons: a concave one whose strip
/// leaves it is named in a warning. The face attribute `source_face` says where
/// each face comes from.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "hexagons": ReadMesh(path: "meshes/hexagons.obj"),
///     "out": SplitIntoQuads(mesh: "hexagons"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct SplitIntoQuads {
    /// Mesh whose large faces are cut.
    mesh: Arc<Mesh>,
}

impl Node for SplitIntoQuads {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        // A quad for each corner, and the edges they share.
        afford(6, [&*self.mesh], cx)?;
        let split = domains::split_into_quads(&self.mesh)?;
        if !split.folded.is_empty() {
            cx.warn(format!(
                "pieces of faces {} turn against their face, because it is not convex; \
                 TriangulateFaces keeps such faces as they are",
                list_ids(&split.folded)
            ));
        }
        Ok(Arc::new(split.mesh))
    }
}
