//! Directions along the surface's own normals.

use std::sync::Arc;

use tessgraph_geometry::normals::{self, NormalWeights};
use tessgraph_geometry::{DirectionSource, Directions, Mesh, list_ids};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Gives each vertex the normal of the surface there as its direction.
///
/// The normal is the weighted sum of the normals of the faces round the vertex;
/// for faces that are not flat, of the plane that fits best (Newell). A vertex
/// without faces, or with only degenerate ones, gets no direction and is named
/// in a warning.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "out": VertexNormals(mesh: "base"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct VertexNormals {
    /// Mesh whose vertex normals are taken.
    mesh: Arc<Mesh>,
    /// How the normals of the faces round a vertex are weighted.
    #[input(default = Angle)]
    weights: Weights,
    /// Whether directions have length 1; otherwise that of the weighted sum.
    #[input(default = true)]
    unit: bool,
}

/// How face normals are weighted.
#[derive(Clone, Copy, Choice)]
#[choice(into = NormalWeights)]
pub(crate) enum Weights {
    /// By the face's angle at the vertex.
    Angle,
    /// By the face's area.
    Area,
    /// All alike.
    Uniform,
}

impl Node for VertexNormals {
    type Output = Arc<Directions>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let weights = self.weights.into();
        let vectors = normals::vertex_normals(&self.mesh, weights, self.unit, cx.monitor())?;
        let without = normals::vertices_without_normal(&self.mesh, &vectors);
        if !without.is_empty() {
            cx.warn(format!(
                "no normal at vertices {}: the faces there have no area or face opposite ways; \
                 `FlipFaces` turns faces round",
                list_ids(&without)
            ));
        }
        Ok(Arc::new(Directions::new(
            &self.mesh,
            vectors,
            DirectionSource::Surface,
        )?))
    }
}
