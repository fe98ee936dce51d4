//! A surface given by formulas of u and v.

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::{Mesh, primitives};
use tessgraph_graph::expr::Formula;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Makes a quad mesh whose coordinates are formulas of u and v.
///
/// u and v run from 0 to 1. In a closed direction the last row of quads joins
/// the first one, so the formulas should agree at 0 and 1 there. Faces are
/// oriented so that the direction of u, that of v, and the normal form a
/// right-handed frame. The texture coordinates `uv` hold u and v and do not
/// jump back at a seam.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "out": ParametricSurface(
///         x: "(3 + cos(v * tau)) * cos(u * tau)",
///         y: "(3 + cos(v * tau)) * sin(u * tau)",
///         z: "sin(v * tau)",
///         cells: [24, 12], closed_u: true, closed_v: true,
///     ),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ParametricSurface {
    /// Formula of the x coordinate.
    #[input(unit = length, free(u, v))]
    x: Arc<Formula>,
    /// Formula of the y coordinate.
    #[input(unit = length, free(u, v))]
    y: Arc<Formula>,
    /// Formula of the z coordinate.
    #[input(unit = length, free(u, v))]
    z: Arc<Formula>,
    /// How many quads along u and along v; at least 3 in a closed direction.
    #[input(default = [10, 10], min = 1)]
    cells: [u32; 2],
    /// Whether u = 1 joins u = 0.
    #[input(default = false)]
    closed_u: bool,
    /// Whether v = 1 joins v = 0.
    #[input(default = false)]
    closed_v: bool,
}

impl Node for ParametricSurface {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let at = |formula: &Formula, u: f64, v: f64| {
            let mut values = [0.0; 2];
            for (value, name) in values.iter_mut().zip(formula.names()) {
                *value = if name == "u" { u } else { v };
            }
            formula.evaluate(&values[..formula.names().len()])
        };
        let place =
            |u: f64, v: f64| DVec3::new(at(&self.x, u, v), at(&self.y, u, v), at(&self.z, u, v));
        let cells = self.cells.map(|count| count as usize);
        let closed = [self.closed_u, self.closed_v];
        Ok(Arc::new(primitives::parametric_surface(
            cells,
            closed,
            place,
            cx.monitor(),
        )?))
    }
}
