//! How thick a mesh is over its base surface.

use crate::mesh::Domain;
use crate::parallel;
use crate::surface::{Border, Surface};
use crate::{Amount, Field, GeometryError, Mesh, Monitor, Quantity};

/// How many values fall into each of equal ranges.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Start of the first range.
    pub low: f64,
    /// End of the last range, which it includes.
    pub high: f64,
    /// Values in each range; all in the first when low and high are the same.
    pub counts: Vec<u64>,
}

/// Distances of a mesh's vertices to a base surface.
#[derive(Debug, Clone)]
pub struct MeasuredThickness {
    /// The distance of each vertex, isolated ones included, in metres.
    pub field: Field,
    /// Vertices counted below: those of faces, or all of a mesh without faces.
    pub vertices: usize,
    /// Vertices left out because they are too close to the base.
    pub ignored: usize,
    /// The smallest distance.
    pub min: f64,
    /// The mean distance.
    pub mean: f64,
    /// The largest distance.
    pub max: f64,
    /// Root of the mean squared difference to what is wanted, in metres; 0
    /// where nothing was said to be wanted.
    pub rms_error: f64,
    /// Largest difference to what is wanted, in metres, and 0 likewise.
    pub max_error: f64,
    /// Vertices whose closest place on the base lies on its border.
    pub at_rim: usize,
    /// How the distances are spread between min and max.
    pub histogram: Histogram,
}

/// Settings of [`measure_thickness`].
#[derive(Debug, Clone, Copy)]
pub struct ThicknessOptions<'a> {
    /// What distances are compared with, constant or one per vertex of the mesh.
    pub wanted: Option<&'a Amount>,
    /// How distances beyond open borders are measured: the rule of thickness
    /// compensation.
    pub border: Border,
    /// Vertices at most this far from the base are not counted, in metres: those
    /// of a component that lie in the surface. Negative to count all.
    pub ignore_below: f64,
    /// Number of the histogram's ranges.
    pub bins: usize,
}

impl Default for ThicknessOptions<'_> {
    fn default() -> Self {
        Self {
            wanted: None,
            border: Border::Extend,
            ignore_below: -1.0,
            bins: 10,
        }
    }
}

/// Measures the thickness of `mesh` over `base`: the distance of each vertex
/// to the surface. Cost: O(vertices · log triangles).
///
/// ```
/// use tessgraph_geometry::measure::{ThicknessOptions, measure_thickness};
/// use tessgraph_geometry::surface::Surface;
/// use tessgraph_geometry::{Mesh, Unmonitored};
/// let low = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let base = Mesh::from_faces(low.to_vec(), &[[0, 1, 2]])?;
/// let shell = Mesh::from_faces(low.map(|[x, y, _]| [x, y, 0.25]).to_vec(), &[[0, 1, 2]])?;
/// let base = Surface::new(&base, &Unmonitored)?;
/// let options = ThicknessOptions { wanted: Some(&0.2.into()), ..Default::default() };
/// let found = measure_thickness(&shell, &base, &options, &Unmonitored)?;
/// assert_eq!((found.min, found.max), (0.25, 0.25));
/// assert!((found.rms_error - 0.05).abs() < 1e-15);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::Empty`] for a mesh without vertices, the errors of
/// [`Amount::check`], [`GeometryError::OutOfRange`] for no bins,
/// [`GeometryError::NonFiniteValue`] for distances beyond the range of
/// numbers, [`GeometryError::Cancelled`].
pub fn measure_thickness(
    mesh: &Mesh,
    base: &Surface,
    options: &ThicknessOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<MeasuredThickness, GeometryError> {
    let wanted = options.wanted;
    check(mesh, wanted, options.bins)?;
    let positions = mesh.positions();
    let found = base.distances(positions, options.border, monitor)?;
    let adjacency = mesh.topology().adjacency_with(monitor)?;
    let is_used =
        |vertex: usize| mesh.face_count() == 0 || !adjacency.vertex_corners(vertex).is_empty();
    let is_far = |vertex: usize| found[vertex].0 > options.ignore_below;
    let counts = |vertex: usize| is_used(vertex) && is_far(vertex);
    let sums = parallel::reduce(
        found.len(),
        Sums::default,
        |sums, vertex| {
            if counts(vertex) {
                sums.with(found[vertex], wanted.map(|wanted| wanted.at(vertex)))
            } else {
                sums
            }
        },
        Sums::join,
    );
    let values = found.iter().map(|&(distance, _)| distance).collect();
    let field = Field::new(Domain::Vertex, Quantity::Length, values)?;
    let counted = (0..found.len()).filter(|&vertex| counts(vertex));
    let histogram = Histogram::of(
        counted.map(|v| found[v].0),
        sums.min,
        sums.max,
        options.bins,
    );
    if sums.count == 0 {
        let vertices = "vertices farther from the base than those to be ignored";
        return Err(GeometryError::Empty {
            what: "the mesh to be measured",
            missing: vertices,
        });
    }
    let n = sums.count as f64;
    let ignored = (0..found.len())
        .filter(|&vertex| is_used(vertex) && !is_far(vertex))
        .count();
    Ok(MeasuredThickness {
        field,
        vertices: sums.count,
        ignored,
        min: sums.min,
        mean: sums.sum / n,
        max: sums.max,
        rms_error: (sums.squares / n).sqrt(),
        max_error: sums.max_error,
        at_rim: sums.at_rim,
        histogram,
    })
}

fn check(mesh: &Mesh, wanted: Option<&Amount>, bins: usize) -> Result<(), GeometryError> {
    if mesh.vertex_count() == 0 {
        return Err(GeometryError::Empty {
            what: "the mesh to be measured",
            missing: "vertices",
        });
    }
    if bins == 0 {
        return Err(GeometryError::OutOfRange {
            what: "the number of ranges",
            value: 0.0,
            requirement: "it must be at least 1",
        });
    }
    wanted.map_or(Ok(()), |wanted| wanted.check(mesh, Domain::Vertex))
}

/// What is added up over vertices.
#[derive(Clone, Copy)]
struct Sums {
    count: usize,
    min: f64,
    max: f64,
    sum: f64,
    squares: f64,
    max_error: f64,
    at_rim: usize,
}

impl Default for Sums {
    fn default() -> Self {
        Self {
            count: 0,
            min: f64::INFINITY,
            max: 0.0,
            sum: 0.0,
            squares: 0.0,
            max_error: 0.0,
            at_rim: 0,
        }
    }
}

impl Sums {
    fn with(self, (distance, at_rim): (f64, bool), wanted: Option<f64>) -> Self {
        let error = wanted.map_or(0.0, |wanted| (distance - wanted).abs());
        Self {
            count: self.count + 1,
            min: self.min.min(distance),
            max: self.max.max(distance),
            sum: self.sum + distance,
            squares: self.squares + error * error,
            max_error: self.max_error.max(error),
            at_rim: self.at_rim + usize::from(at_rim),
        }
    }

    fn join(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            sum: self.sum + other.sum,
            squares: self.squares + other.squares,
            max_error: self.max_error.max(other.max_error),
            at_rim: self.at_rim + other.at_rim,
        }
    }
}

impl Histogram {
    /// Where range `k` begins and the one before it ends.
    pub fn edge(&self, k: usize) -> f64 {
        let count = self.counts.len();
        if k >= count {
            return self.high;
        }
        self.low + (self.high - self.low) * (k as f64 / count as f64)
    }

    fn of(values: impl Iterator<Item = f64>, low: f64, high: f64, bins: usize) -> Self {
        let mut counts = vec![0; bins];
        let scale = if high > low {
            bins as f64 / (high - low)
        } else {
            0.0
        };
        for value in values {
            let bin = ((value - low) * scale) as usize;
            counts[bin.min(bins - 1)] += 1;
        }
        Self { low, high, counts }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::Unmonitored;
    use crate::compensate::{CompensateOptions, compensate};
    use crate::test_shapes::{cylinder, grid, normals};

    fn surface(mesh: &Mesh) -> Surface {
        Surface::new(mesh, &Unmonitored).unwrap()
    }

    fn settings(wanted: Option<&Amount>, border: Border, bins: usize) -> ThicknessOptions<'_> {
        ThicknessOptions {
            wanted,
            border,
            bins,
            ..ThicknessOptions::default()
        }
    }

    #[test]
    fn vertices_in_the_base_can_be_left_out() {
        let plate = grid(4, 4, |x, y| [x, y, 0.0]);
        let base = surface(&plate);
        let twice = grid(4, 4, |x, y| [x, y, if y > 0.6 { 0.2 } else { 0.0 }]);
        let options = ThicknessOptions {
            ignore_below: 1e-9,
            ..settings(None, Border::Clip, 1)
        };
        let found = measure_thickness(&twice, &base, &options, &Unmonitored).unwrap();
        assert_eq!((found.vertices, found.ignored), (10, 15));
        assert_eq!((found.min, found.max), (0.2, 0.2));
        let none = measure_thickness(&plate, &base, &options, &Unmonitored);
        assert!(matches!(none, Err(GeometryError::Empty { .. })));
    }

    #[test]
    fn a_slope_over_a_plate() {
        let base = surface(&grid(4, 4, |x, y| [x, y, 0.0]));
        // Heights 0 to 1, and a border that overhangs at x = 1.5.
        let slope = grid(10, 1, |x, y| [1.5 * x, y, x]);
        let wanted = (0..22).map(|v| f64::from(v % 11) * 0.1).collect();
        let wanted = Field::new(Domain::Vertex, Quantity::Length, wanted).unwrap();
        let wanted = Amount::Field(Arc::new(wanted));
        let measure = |border| {
            measure_thickness(
                &slope,
                &base,
                &settings(Some(&wanted), border, 5),
                &Unmonitored,
            )
            .unwrap()
        };
        let extended = measure(Border::Extend);
        assert_eq!(
            (extended.vertices, extended.min, extended.max),
            (22, 0.0, 1.0)
        );
        assert!((extended.mean - 0.5).abs() < 1e-15 && extended.max_error < 1e-15);
        assert_eq!(extended.histogram.counts, [4, 4, 4, 4, 6]);
        let clipped = measure(Border::Clip);
        // The last vertex is (0.5, 1) away from the border.
        assert!((clipped.max - 1.25f64.sqrt()).abs() < 1e-15);
        assert!(clipped.field.values()[10] >= clipped.max);
        assert_eq!((clipped.at_rim, extended.at_rim), (22, 22));
    }

    #[test]
    fn what_is_compensated_measures_as_wanted() {
        let tube = cylinder(64, 3);
        let (t, options) = (0.1.into(), CompensateOptions::default());
        let even = compensate(&tube, &normals(&tube), &t, &t, &options, &Unmonitored).unwrap();
        let vectors = even.directions.inward().iter();
        let moved = tube
            .positions()
            .iter()
            .zip(vectors)
            .map(|(&p, &d)| p - 0.1 * d);
        let shell = tube.with_positions(moved.collect()).unwrap();
        let base = surface(&tube);
        let found = measure_thickness(
            &shell,
            &base,
            &settings(Some(&t), Border::Extend, 3),
            &Unmonitored,
        );
        let found = found.unwrap();
        assert!(found.max_error <= 1e-5 && found.rms_error <= found.max_error);
    }

    #[test]
    fn isolated_vertices_are_measured_but_not_counted() {
        let base = surface(&grid(1, 1, |x, y| [x, y, 0.0]));
        let places = vec![[0., 0., 1.], [1., 0., 1.], [0., 1., 1.], [0.5, 0.5, 9.0]];
        let mesh = Mesh::from_faces(places.clone(), &[[0, 1, 2]]).unwrap();
        let measure = |mesh: &Mesh| {
            measure_thickness(mesh, &base, &settings(None, Border::Clip, 2), &Unmonitored).unwrap()
        };
        let found = measure(&mesh);
        assert_eq!(
            (found.vertices, found.max, found.field.values()[3]),
            (3, 1.0, 9.0)
        );
        assert_eq!(found.histogram.counts, [3, 0]);
        let cloud = Mesh::from_faces(places, &[] as &[[u32; 3]]).unwrap();
        assert_eq!((measure(&cloud).vertices, measure(&cloud).max), (4, 9.0));
    }

    #[test]
    fn nothing_to_measure_is_an_error() {
        let base = surface(&grid(1, 1, |x, y| [x, y, 0.0]));
        let none = Mesh::from_faces(Vec::new(), &[] as &[[u32; 3]]).unwrap();
        let empty = measure_thickness(&none, &base, &settings(None, Border::Clip, 1), &Unmonitored);
        assert!(matches!(empty, Err(GeometryError::Empty { .. })));
        let mesh = grid(1, 1, |x, y| [x, y, 1.0]);
        let bins = measure_thickness(&mesh, &base, &settings(None, Border::Clip, 0), &Unmonitored);
        assert!(matches!(bins, Err(GeometryError::OutOfRange { .. })));
    }
}
