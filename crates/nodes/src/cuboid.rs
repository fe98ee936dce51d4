//! A box.

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::{Mesh, primitives};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Makes a closed box of quads.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "out": Cuboid(size: [2, 1, 0.3], cells: [4, 2, 1]),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct Cuboid {
    /// Extent along x, y and z.
    #[input(default = [1.0, 1.0, 1.0], above = 0, unit = length)]
    size: [f64; 3],
    /// How many quads along x, y and z.
    #[input(default = [1, 1, 1], min = 1)]
    cells: [u32; 3],
    /// Whether the box lies about the origin instead of beginning there.
    #[input(default = false)]
    centre: bool,
}

impl Node for Cuboid {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let cells = self.cells.map(|count| count as usize);
        cx.monitor().afford(primitives::cuboid_bytes(cells))?;
        Ok(Arc::new(primitives::cuboid(
            DVec3::from(self.size),
            cells,
            self.centre,
        )?))
    }
}
