//! Curvature as a field.

use std::sync::Arc;

use tessgraph_geometry::fields::{self, Curvature};
use tessgraph_geometry::{Field, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Gives the curvature of a surface at each vertex.
///
/// Positive where the surface bends away from its normals, as a dome seen from
/// above. Values are in 1/m, Gauss curvature in 1/m², whatever the file's units.
/// On an open border no curvature is defined; its vertices take the mean of
/// their inner neighbours.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "dome": ParametricSurface(x: "4 * u - 2", y: "4 * v - 2", z: "sqrt(25 - (4 * u - 2) ^ 2 - (4 * v - 2) ^ 2)", cells: [16, 16]),
///     "out": CurvatureField(mesh: "dome", kind: Mean),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct CurvatureField {
    /// Mesh whose curvature is wanted.
    mesh: Arc<Mesh>,
    /// Which curvature.
    #[input(default = Gauss)]
    kind: Kind,
}

/// Which curvature.
#[derive(Clone, Copy, Choice)]
#[choice(into = Curvature)]
pub(crate) enum Kind {
    /// The product of the principal curvatures: positive on domes, negative on
    /// saddles, 0 where the surface can be unrolled.
    Gauss,
    /// The mean of the principal curvatures.
    Mean,
    /// The larger principal curvature.
    Max,
    /// The smaller principal curvature.
    Min,
}

impl Node for CurvatureField {
    type Output = Arc<Field>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let field = fields::curvature(&self.mesh, self.kind.into(), cx.monitor())?;
        Ok(Arc::new(field))
    }
}
