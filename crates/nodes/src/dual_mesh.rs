//! The dual of a mesh.

use std::sync::Arc;

use crate::support::memory::afford;
use tessgraph_geometry::domains::{self, DualBorder};
use tessgraph_geometry::{Mesh, list_ids};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Makes a vertex of every face and a face of every vertex.
///
/// Triangles become hexagons, a Voronoi-like pattern; quads become quads that are
/// shifted by half a cell. A face has as many corners as its vertex had edges.
/// The new vertices are the length-weighted centres of the faces. The face
/// attribute `source_vertex` says which vertex a face comes from; materials,
/// groups and face values are those of the lowest face round it.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "triangles": TriangulateFaces(mesh: "base"),
///     "out": DualMesh(mesh: "triangles"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct DualMesh {
    /// The mesh; no edge may have more than two faces.
    mesh: Arc<Mesh>,
    /// What becomes of vertices on open borders.
    #[input(default = Closed)]
    border: DualBorderChoice,
}

/// What becomes of vertices on open borders.
#[derive(Clone, Copy, Choice)]
#[choice(into = DualBorder)]
pub(crate) enum DualBorderChoice {
    /// Their faces are cut off by the border, so that the outline stays.
    Closed,
    /// They get no face: the outline shrinks by half a cell.
    Open,
}

impl Node for DualMesh {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        // As many corners, and the rings they are found by.
        afford(4, [&*self.mesh], cx)?;
        let dual = domains::dual(&self.mesh, self.border.into())?;
        if !dual.skipped.is_empty() {
            cx.warn(format!(
                "no face for vertices {}: fewer than three faces meet there; \
                 weld the mesh, or join the faces there into one",
                list_ids(&dual.skipped)
            ));
        }
        Ok(Arc::new(dual.mesh))
    }
}
