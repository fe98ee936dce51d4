//! A flat quad grid.

use std::sync::Arc;

use glam::DVec2;
use tessgraph_geometry::{Mesh, primitives};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Makes a flat grid of quads in the plane z = 0.
///
/// u runs along x and v along y; the texture coordinates `uv` go from 0 to 1.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "out": Grid(cells: [6, 4], size: [6, 4], centre: true),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct Grid {
    /// How many quads along x and along y.
    #[input(default = [1, 1], min = 1)]
    cells: [u32; 2],
    /// Extent along x and along y.
    #[input(default = [1.0, 1.0], above = 0, unit = length)]
    size: [f64; 2],
    /// Whether the grid lies about the origin instead of beginning there.
    #[input(default = false)]
    centre: bool,
}

impl Node for Grid {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let cells = self.cells.map(|count| count as usize);
        cx.monitor().afford(primitives::grid_bytes(cells))?;
        Ok(Arc::new(primitives::grid(
            cells,
            DVec2::from(self.size),
            self.centre,
        )?))
    }
}
