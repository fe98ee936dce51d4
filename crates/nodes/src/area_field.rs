//! The size of faces as a field.

use std::sync::Arc;

use tessgraph_geometry::fields;
use tessgraph_geometry::{Domain, Field, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::evaluate_field::FieldElements;

/// Gives the area of every face, or the mean area of the faces round each vertex.
///
/// `ArrayComponents(height: Relative)` goes by the square root of the latter. As an
/// attribute it enters formulas: large faces may take another component.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "roof": ParametricSurface(x: "4 * u * u", y: "4 * v", z: "0", cells: [6, 4]),
///     "out": AreaField(mesh: "roof"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct AreaField {
    /// Mesh whose faces are measured.
    mesh: Arc<Mesh>,
    /// The elements that get a number.
    #[input(default = Faces)]
    on: FieldElements,
}

impl Node for AreaField {
    type Output = Arc<Field>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let field = match self.on.domain() {
            Domain::Face => fields::face_areas(&self.mesh, cx.monitor())?,
            _ => fields::mean_face_areas(&self.mesh, cx.monitor())?,
        };
        Ok(Arc::new(field))
    }
}
