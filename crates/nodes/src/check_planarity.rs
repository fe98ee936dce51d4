//! How far faces are from planar.

use std::sync::Arc;

use tessgraph_geometry::measure::{self, Planarity};
use tessgraph_geometry::{Domain, Field, Mesh, Quantity};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs, Outputs};

/// Measures how far faces are from planar, by each convention in use.
///
/// The conventions differ by up to four times on one quad, so each has its name:
/// ask your glass or sheet supplier which one a tolerance is meant in. Triangles
/// are planar; of faces with more than four corners each four in a row count.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "hypar": ParametricSurface(x: "4 * u", y: "4 * v", z: "u * v", cells: [4, 4]),
///     "out": CheckPlanarity(mesh: "hypar", convention: Diagonals, limit: 0.02),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct CheckPlanarity {
    /// Mesh whose faces are measured.
    mesh: Arc<Mesh>,
    /// The convention of `limit` and of the field.
    #[input(default = Plane)]
    convention: Convention,
    /// Largest distance that is allowed; faces above it are counted.
    #[input(min = 0, unit = length)]
    limit: Option<f64>,
}

/// What counts as a face's distance from planar.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum Convention {
    /// Largest distance of a corner to the best-fitting plane.
    Plane,
    /// Distance between the two diagonals.
    Diagonals,
    /// Largest distance of a corner to the plane of the other three.
    FourthCorner,
}

/// Largest distances from planar, by convention.
#[derive(Outputs)]
#[outputs(report)]
pub(crate) struct Flatness {
    /// Largest distance of a corner to the best-fitting plane of its face.
    #[output(unit = length)]
    plane: f64,
    /// Largest distance between the diagonals of a face.
    #[output(unit = length)]
    diagonals: f64,
    /// The same as a share of the diagonals' mean length.
    diagonal_share: f64,
    /// Largest distance of a corner to the plane of the other three.
    #[output(unit = length)]
    fourth_corner: f64,
    /// How far a component at height 0 lies off the surface at most: it follows the
    /// bilinear patch of a quad, distances are measured to the quad's triangles.
    #[output(unit = length)]
    warp: f64,
    /// Faces above the limit; 0 if none is given.
    #[output(faults = limit)]
    above: usize,
    /// The face with the largest distance by the chosen convention.
    worst_face: usize,
    /// The distance of every face by the chosen convention.
    #[output(unit = length)]
    field: Arc<Field>,
}

impl Node for CheckPlanarity {
    type Output = Flatness;
    const VERSION: u32 = 2;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let faces = measure::planarity(&self.mesh, cx.monitor())?;
        let chosen = |face: &Planarity| match self.convention {
            Convention::Plane => face.plane,
            Convention::Diagonals => face.diagonals,
            Convention::FourthCorner => face.fourth_corner,
        };
        let values: Vec<f64> = faces.iter().map(chosen).collect();
        let limit = self.limit.unwrap_or(f64::INFINITY);
        let above = values.iter().filter(|&&value| value > limit).count();
        let worst = |worst: usize, face: usize| {
            if values[face] > values[worst] {
                face
            } else {
                worst
            }
        };
        let worst_face = (0..values.len()).fold(0, worst);
        let largest = Planarity::largest(&faces);
        Ok(Flatness {
            plane: largest.plane,
            diagonals: largest.diagonals,
            diagonal_share: largest.diagonal_share,
            fourth_corner: largest.fourth_corner,
            warp: largest.warp,
            above,
            worst_face,
            field: Arc::new(Field::new(Domain::Face, Quantity::Length, values)?),
        })
    }
}
