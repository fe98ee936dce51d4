//! Distances to attractors as a field.

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::surface::Surface;
use tessgraph_geometry::{Field, Mesh, fields};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::evaluate_field::FieldElements;

/// Gives the distance of every vertex or face to the nearest attractor.
///
/// Attractors are the surface of a mesh, its vertices alone, or points. Combine
/// fields by formula: store them with `SetAttribute` and use their names in
/// `EvaluateField`, as in `"max(0.1, 1 - d / 3)"`.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [8, 8], size: [8, 8]),
///     "out": DistanceField(mesh: "base", on: Faces, points: [(2, 2, 0), (6, 7, 1)]),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct DistanceField {
    /// Mesh whose elements are measured.
    mesh: Arc<Mesh>,
    /// The elements that get a distance; of a face the mean of its corners counts.
    #[input(default = Vertices)]
    on: FieldElements,
    /// Mesh they are measured to; either this or `points`.
    to: Option<Arc<Mesh>>,
    /// Whether only the vertices of `to` count.
    #[input(default = false)]
    vertices_only: bool,
    /// Points they are measured to; either this or `to`.
    #[input(unit = length)]
    points: Option<Vec<DVec3>>,
}

impl Node for DistanceField {
    type Output = Arc<Field>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let (mesh, domain, monitor) = (&self.mesh, self.on.domain(), cx.monitor());
        let field = match (&self.to, &self.points) {
            (Some(to), None) if self.vertices_only => {
                fields::distances_to_points(mesh, domain, to.positions(), monitor)
                    .map_err(|error| NodeError::from(error).at_input("to"))?
            }
            (Some(to), None) => {
                let surface = Surface::new(to, monitor)
                    .map_err(|error| NodeError::from(error).at_input("to"))?;
                fields::distances_to_surface(mesh, domain, &surface, monitor)?
            }
            (None, Some(points)) => fields::distances_to_points(mesh, domain, points, monitor)
                .map_err(|error| NodeError::from(error).at_input("points"))?,
            _ => {
                return Err(NodeError::new("give either `to` or `points`")
                    .with_help("`to` is a mesh, `points` a list like [(0, 0, 1), (2, 0, 1)]"));
            }
        };
        Ok(Arc::new(field))
    }
}
