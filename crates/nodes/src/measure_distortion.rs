//! How far components were bent out of shape.

use std::sync::Arc;

use tessgraph_geometry::{Field, Mesh, measure};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Inputs, Outputs};

/// Compares the components of an array with the undistorted component.
///
/// Every edge length and every angle of a copy is compared with the component's
/// own. With `scaled`, a copy of another size but the same shape counts as
/// undistorted. `field` and `angles` show the largest changes of the component
/// that each face belongs to. A copy is `inverted` where directions run into
/// each other below its height: it is folded over there, or inside out.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": ParametricSurface(x: "4 * u", y: "4 * v", z: "sin(2 * u)", cells: [4, 4]),
///     "normals": VertexNormals(mesh: "base"),
///     "box": Cuboid(size: [1, 1, 0.2]),
///     "panels": ArrayComponents(base: "base", component: "box", directions: "normals"),
///     "out": MeasureDistortion(mesh: "panels", component: "box"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct MeasureDistortion {
    /// The arrayed components.
    mesh: Arc<Mesh>,
    /// The component they are copies of.
    component: Arc<Mesh>,
    /// Whether a uniform change of size counts as none.
    #[input(default = true)]
    scaled: bool,
}

/// Largest changes, as shares of the component's lengths and as angles.
#[derive(Outputs)]
#[outputs(report)]
pub(crate) struct Changes {
    /// Components compared.
    components: usize,
    /// Largest change of an edge length, as a share of the original length.
    max_length_change: f64,
    /// Mean over the components of their largest change of an edge length.
    mean_length_change: f64,
    /// Largest change of an angle.
    #[output(unit = angle)]
    max_angle_change: f64,
    /// Mean over the components of their largest change of an angle.
    #[output(unit = angle)]
    mean_angle_change: f64,
    /// Components that are folded over somewhere or inside out.
    #[output(faults)]
    inverted: usize,
    /// Largest change of an edge length in each face's component.
    field: Arc<Field>,
    /// Largest change of an angle in each face's component.
    #[output(unit = angle)]
    angles: Arc<Field>,
}

impl Node for MeasureDistortion {
    type Output = Changes;
    const VERSION: u32 = 2;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let found = measure::distortion(&self.mesh, &self.component, self.scaled, cx.monitor())
            .map_err(|error| NodeError::from(error).at_input("mesh"))?;
        let max = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
        Ok(Changes {
            components: found.length_changes.len(),
            max_length_change: max(&found.length_changes),
            mean_length_change: mean(&found.length_changes),
            max_angle_change: max(&found.angle_changes),
            mean_angle_change: mean(&found.angle_changes),
            inverted: found.inverted.iter().filter(|&&inverted| inverted).count(),
            field: Arc::new(found.length_field),
            angles: Arc::new(found.angle_field),
        })
    }
}
