//! How thick something is over its base.

use std::sync::Arc;

use tessgraph_geometry::measure::{self, Histogram, ThicknessOptions};
use tessgraph_geometry::surface::Surface;
use tessgraph_geometry::{Amount, Field, Mesh, Quantity};
use tessgraph_graph::value::{Column, ColumnValues, Table};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Inputs, Outputs};

use crate::compensate_thickness::BorderChoice;

/// Measures the distance of a mesh's vertices to a base surface.
///
/// The distance is to the surface itself, the closest place on any face, by the
/// border rule that the thickness was compensated with. Vertices that lie in the
/// base (those of a component at height 0) are left out with `ignore_below`.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": ParametricSurface(x: "4 * u", y: "4 * v", z: "0.3 * sin(u * tau)", cells: [12, 6]),
///     "normals": VertexNormals(mesh: "base"),
///     "moved": DisplaceVertices(mesh: "base", directions: "normals", distance: 0.2),
///     "out": MeasureThickness(mesh: "moved", base: "base", thickness: 0.2),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct MeasureThickness {
    /// Mesh whose vertices are measured.
    mesh: Arc<Mesh>,
    /// Surface they are measured to.
    base: Arc<Mesh>,
    /// Wanted thickness that errors are told against, a number or one per vertex
    /// of the mesh.
    #[input(min = 0, unit = length)]
    thickness: Option<Amount>,
    /// How distances beyond open borders are measured.
    #[input(default = Extend)]
    border: BorderChoice,
    /// Vertices this close to the base or closer are left out.
    #[input(min = 0, unit = length)]
    ignore_below: Option<f64>,
    /// Into how many equal ranges the histogram cuts the distances.
    #[input(default = 10, min = 1, max = 1000)]
    bins: u32,
}

/// Distances to the base.
#[derive(Outputs)]
#[outputs(report)]
pub(crate) struct Thickness {
    /// Vertices measured.
    vertices: usize,
    /// Vertices left out by `ignore_below`.
    ignored: usize,
    /// Smallest distance.
    #[output(unit = length)]
    min: f64,
    /// Mean distance.
    #[output(unit = length)]
    mean: f64,
    /// Largest distance.
    #[output(unit = length)]
    max: f64,
    /// Root mean square difference to the wanted thickness; 0 if none is given.
    #[output(unit = length)]
    rms_error: f64,
    /// Largest difference to the wanted thickness; 0 if none is given.
    #[output(unit = length)]
    max_error: f64,
    /// Vertices measured to the rim of the base.
    at_rim: usize,
    /// The distance of every vertex.
    #[output(unit = length)]
    distances: Arc<Field>,
    /// How many vertices lie in each of equal ranges from the smallest to the largest
    /// distance: columns `from`, `to` and `vertices`.
    histogram: Arc<Table>,
}

impl Node for MeasureThickness {
    type Output = Thickness;
    const VERSION: u32 = 2;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let base = Surface::new(&self.base, cx.monitor())
            .map_err(|error| NodeError::from(error).at_input("base"))?;
        let options = ThicknessOptions {
            wanted: self.thickness.as_ref(),
            border: self.border.into(),
            ignore_below: self.ignore_below.unwrap_or(-1.0),
            bins: self.bins as usize,
        };
        let found = measure::measure_thickness(&self.mesh, &base, &options, cx.monitor())?;
        if !(found.mean.is_finite() && found.rms_error.is_finite()) {
            let message =
                "the distances, or those wanted, are so large that their squares overflow";
            return Err(NodeError::new(message).with_help("measure a smaller mesh and thickness"));
        }
        Ok(Thickness {
            vertices: found.vertices,
            ignored: found.ignored,
            min: found.min,
            mean: found.mean,
            max: found.max,
            rms_error: found.rms_error,
            max_error: found.max_error,
            at_rim: found.at_rim,
            histogram: Arc::new(table(&found.histogram)?),
            distances: Arc::new(found.field),
        })
    }
}

/// A row for each range.
fn table(histogram: &Histogram) -> Result<Table, NodeError> {
    let count = histogram.counts.len();
    let column = |name: &str, quantity, values| Column {
        name: name.to_owned(),
        quantity,
        values,
    };
    let edges = |first: usize| {
        let edges = (first..first + count).map(|k| histogram.edge(k));
        ColumnValues::Number(edges.collect())
    };
    let counts = histogram.counts.iter().map(|&count| count.cast_signed());
    Table::new(vec![
        column("from", Quantity::Length, edges(0)),
        column("to", Quantity::Length, edges(1)),
        column(
            "vertices",
            Quantity::Number,
            ColumnValues::Integer(counts.collect()),
        ),
    ])
    .ok_or_else(|| NodeError::new("the columns of the histogram differ in length"))
}
