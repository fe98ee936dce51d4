//! A mesh moved, turned and scaled.

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::{Mesh, transform};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Scales, turns and moves a mesh, in that order.
///
/// Scaling and turning are about `pivot`. A mirroring scale turns the faces round,
/// so that they keep facing outward; their first corner stays the first.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "box": Cuboid(size: [2, 1, 1]),
///     "out": Transform(mesh: "box", rotate: (0, 0, 30), translate: (5, 0, 0)),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct Transform {
    /// Mesh to transform.
    mesh: Arc<Mesh>,
    /// Factors along x, y and z.
    #[input(default = [1.0, 1.0, 1.0])]
    scale: DVec3,
    /// Angles about the fixed axes x, then y, then z.
    #[input(default = [0.0, 0.0, 0.0], unit = angle)]
    rotate: DVec3,
    /// Way along x, y and z.
    #[input(default = [0.0, 0.0, 0.0], unit = length)]
    translate: DVec3,
    /// The point that scaling and turning leave in place.
    #[input(default = [0.0, 0.0, 0.0], unit = length)]
    pivot: DVec3,
}

impl Node for Transform {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let rotation = transform::rotation_by(self.rotate)?;
        let world_from_local =
            transform::placement(self.scale, rotation, self.pivot, self.translate);
        Ok(Arc::new(transform::transform(
            &self.mesh,
            world_from_local,
            cx.monitor(),
        )?))
    }
}
