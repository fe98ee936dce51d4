//! Directions towards a target surface (§3.1).

use std::sync::Arc;

use tessgraph_geometry::target::{self, TargetLength, ZeroPairs};
use tessgraph_geometry::{Directions, GeometryError, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Points each vertex of a base at the same vertex of a target surface.
///
/// Base and target need the same faces with the same indices, since vertices are
/// paired by number: edit one from the other, or make both by the same nodes. The
/// method solves folds that no smoothing can (paper §3.1, figure 6).
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "target": Transform(mesh: "base", translate: (0, 0, 1), scale: (0.8, 0.8, 1)),
///     "out": TargetDirections(mesh: "base", target: "target"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct TargetDirections {
    /// The base surface.
    mesh: Arc<Mesh>,
    /// The target surface.
    target: Arc<Mesh>,
    /// How long the directions are.
    #[input(default = Target)]
    length: Length,
    /// Whether a vertex that lies on its target takes the surface normal instead of
    /// being an error.
    #[input(default = false)]
    zero_as_normal: bool,
}

/// How long directions towards a target are.
#[derive(Clone, Copy, Choice)]
#[choice(into = TargetLength)]
pub(crate) enum Length {
    /// As long as the way: a component one unit high reaches the target.
    Target,
    /// One: only the direction counts.
    Unit,
}

impl Node for TargetDirections {
    type Output = Arc<Directions>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let zero = if self.zero_as_normal {
            ZeroPairs::Normal
        } else {
            ZeroPairs::Refuse
        };
        let (length, monitor) = (self.length.into(), cx.monitor());
        let directions = target::target_directions(&self.mesh, &self.target, length, zero, monitor)
            .map_err(|error| fault(error).at_input("target"))?;
        Ok(Arc::new(directions))
    }
}

fn fault(error: GeometryError) -> NodeError {
    let coincides = matches!(error, GeometryError::ZeroDirection { .. });
    let fault = NodeError::from(error);
    if coincides {
        fault.with_help(
            "move these vertices of the target off the base, or take the surface normal there \
             with `zero_as_normal: true`",
        )
    } else {
        fault
    }
}
