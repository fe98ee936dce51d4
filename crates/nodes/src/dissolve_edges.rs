//! Edges taken away, the faces beside them joined.

use std::sync::Arc;

use tessgraph_geometry::domains;
use tessgraph_geometry::{Mesh, list_ids};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs, Outputs};

/// Takes edges away, so that the faces beside them become one polygon.
///
/// `FitComponent` leaves the edge attribute `seam` where it cuts a component:
/// dissolved after `ArrayComponents(join: Weld)`, a pattern runs across cells as if
/// it had never been cut. Or take away all edges that are flat to within an angle.
/// Faces that together would have a hole or touch themselves stay, and are named in
/// a warning.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [6, 4], size: [6, 4]),
///     "roof": SetAttribute(mesh: "base", name: "keep", on: Edges, value: "if(abs(x) < 0.01, 0, 1)"),
///     "out": DissolveEdges(mesh: "roof", attribute: "keep"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct DissolveEdges {
    /// Mesh whose edges are taken away.
    mesh: Arc<Mesh>,
    /// Which edges go.
    #[input(default = Attribute)]
    by: EdgeRule,
    /// Name of the edge attribute.
    #[input(default = "seam", only_with(by = Attribute))]
    attribute: String,
    /// Edges with at least this value go.
    #[input(default = 0.5, only_with(by = Attribute))]
    at_least: f64,
    /// Edges between faces whose normals differ by no more go.
    #[input(default = 1.0, min = 0, max = 180, unit = angle, only_with(by = Angle))]
    angle: f64,
    /// Vertices that lost an edge and are left between two go where these are
    /// straight to within this angle; 180 takes all of them.
    #[input(default = 1.0, min = 0, max = 180, unit = angle)]
    straight: f64,
}

/// Which edges are taken away.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum EdgeRule {
    /// By an edge attribute: the seams of a cut component, or one that
    /// `SetAttribute(on: Edges)` made.
    Attribute,
    /// By the angle between the faces.
    Angle,
}

/// The mesh with fewer edges.
#[derive(Outputs)]
pub(crate) struct DissolvedEdges {
    /// The mesh.
    mesh: Arc<Mesh>,
    /// Faces that went into another one.
    joined: usize,
    /// Vertices taken out of straight edges.
    straightened: usize,
    /// Groups of faces left as they were.
    kept: usize,
}

impl Node for DissolveEdges {
    type Output = DissolvedEdges;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let mesh = &self.mesh;
        let chosen = match self.by {
            EdgeRule::Attribute => {
                domains::edges_by_attribute(mesh, &self.attribute, self.at_least)
                    .map_err(|error| NodeError::from(error).at_input("attribute"))?
            }
            EdgeRule::Angle => domains::edges_within_angle(mesh, self.angle, cx.monitor())?,
        };
        let dissolved = domains::dissolve_edges(mesh, &chosen, self.straight)?;
        if !dissolved.kept.is_empty() {
            cx.warn(format!(
                "faces joined to {} stay apart: together they would have a hole, touch \
                 themselves or close the surface; choose fewer of the edges round them",
                list_ids(&dissolved.kept)
            ));
        }
        Ok(DissolvedEdges {
            mesh: Arc::new(dissolved.mesh),
            joined: dissolved.joined,
            straightened: dissolved.straightened,
            kept: dissolved.kept.len(),
        })
    }
}
