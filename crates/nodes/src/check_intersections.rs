//! Faces that cross each other.

use std::sync::Arc;

use tessgraph_geometry::intersect::{self, IntersectOptions};
use tessgraph_geometry::{Field, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs, Outputs};

/// Counts the pairs of faces that cross each other, by exact predicates.
///
/// A pair counts only if it crosses whichever way the diagonals of both faces are
/// drawn, and deeper and longer than `tolerance`. Faces that touch, coincide or
/// overlap in one plane are `contacts`; neighbours that only share a vertex or an
/// edge are neither. A component is a panel of `ArrayComponents`, or else a
/// connected piece of the mesh. `Require` turns the counts into a rule.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "fold": ParametricSurface(x: "4 * u", y: "2 * v", z: "6 * abs(u - 0.5)", cells: [8, 4]),
///     "normals": VertexNormals(mesh: "fold"),
///     "panels": ArrayComponents(base: "fold", component: "box", directions: "normals"),
///     "box": Cuboid(size: [1, 1, 0.8]),
///     "out": CheckIntersections(mesh: "panels", between: Components),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct CheckIntersections {
    /// Mesh whose faces are checked.
    mesh: Arc<Mesh>,
    /// Which pairs of faces are looked at.
    #[input(default = All)]
    between: Between,
    /// Crossings not deeper or not longer than this are contacts; 0 for exact. Left
    /// out, a millionth of the bounding box's diagonal.
    #[input(min = 0, unit = length)]
    tolerance: Option<f64>,
}

/// Which pairs of faces are looked at.
#[derive(Clone, Copy, Choice)]
#[choice(into = intersect::Between)]
pub(crate) enum Between {
    /// Faces of different components.
    Components,
    /// Faces of one component.
    Inside,
    /// All faces.
    All,
}

/// What crosses.
#[derive(Outputs)]
#[outputs(report)]
pub(crate) struct Crossings {
    /// Pairs of faces that cross.
    #[output(faults)]
    pairs: usize,
    /// Pairs of components with faces that cross.
    component_pairs: usize,
    /// Pairs of faces that touch, coincide or overlap in one plane.
    contacts: usize,
    /// Faces that cross another one.
    faces: usize,
    /// How many others each face crosses.
    field: Arc<Field>,
}

impl Node for CheckIntersections {
    type Output = Crossings;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let options = IntersectOptions {
            between: self.between.into(),
            tolerance: self.tolerance,
        };
        let found = intersect::intersections(&self.mesh, &options, cx.monitor())?;
        Ok(Crossings {
            pairs: found.pairs.len(),
            component_pairs: found.component_pairs.len(),
            contacts: found.contacts.len(),
            faces: found.faces.len(),
            field: Arc::new(found.field),
        })
    }
}
