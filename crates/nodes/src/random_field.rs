//! Random numbers as a field.

use std::sync::Arc;

use tessgraph_geometry::{Field, Mesh, fields};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::evaluate_field::FieldElements;

/// Gives every vertex or face a random number.
///
/// The numbers depend on the seed and the element's number alone: they are the
/// same in every run, on every machine, and do not change when the shape does.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [8, 8], size: [8, 8]),
///     "out": RandomField(mesh: "base", on: Faces, seed: 7, low: -1, high: 1),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct RandomField {
    /// Mesh whose elements get a number.
    mesh: Arc<Mesh>,
    /// The elements that get a number.
    #[input(default = Vertices)]
    on: FieldElements,
    /// Another seed gives other numbers.
    #[input(default = 0)]
    seed: u32,
    /// The smallest number possible.
    #[input(default = 0.0)]
    low: f64,
    /// The number that all stay below.
    #[input(default = 1.0)]
    high: f64,
}

impl Node for RandomField {
    type Output = Arc<Field>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let domain = self.on.domain();
        let field = fields::random(&self.mesh, domain, self.seed.into(), self.low, self.high)
            .map_err(|error| NodeError::from(error).at_input("low"))?;
        Ok(Arc::new(field))
    }
}
