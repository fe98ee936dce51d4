//! A field from a formula.

use std::sync::Arc;

use tessgraph_geometry::{Domain, Field, Mesh, Quantity};
use tessgraph_graph::expr::Formula;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

use crate::support::elements::{self, Elements};

/// Evaluates a formula at every vertex or face and gives the numbers as a field.
///
/// The formula sees the place of the element as `x`, `y`, `z` in the file's
/// units, its number as `index` (from 0), the first texture coordinates as `u`
/// and `v`, and numeric attributes of the mesh by name. A field of plain numbers
/// takes on the unit of the input it is used at, as a literal would.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [8, 8], size: [8, 8]),
///     "out": EvaluateField(mesh: "base", on: Vertices, value: "0.1 + 0.05 * sin(x)"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct EvaluateField {
    /// Mesh whose elements the formula is evaluated on.
    mesh: Arc<Mesh>,
    /// The elements that get a number.
    #[input(default = Vertices)]
    on: FieldElements,
    /// The formula.
    #[input(free(x: length, y: length, z: length, u, v, index), attributes)]
    value: Arc<Formula>,
}

/// The elements a field is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Choice)]
#[choice(into = Elements)]
pub(crate) enum FieldElements {
    /// One number per vertex.
    Vertices,
    /// One number per face; x, y, z are the mean of its corners.
    Faces,
}

impl FieldElements {
    /// The domain of such a field.
    pub(crate) fn domain(self) -> Domain {
        Elements::from(self).domain()
    }
}

impl Node for EvaluateField {
    type Output = Arc<Field>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let values = elements::evaluate(&self.value, &self.mesh, self.on.into(), "value", cx)?;
        Ok(Arc::new(Field::new(
            self.on.domain(),
            Quantity::Number,
            values,
        )?))
    }
}
