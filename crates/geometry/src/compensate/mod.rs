//! Thickness compensation along custom directions (§3.2).

mod exit;
mod highest;
mod local;
mod report;
mod solver;
#[cfg(test)]
mod tests;

use glam::DVec3;

pub use report::{Errors, SideReport, Unsolved};
pub use solver::{NOT_MOVED, Side, Solution, Solver, Start, Status};

use crate::math::{angle_between, unit_or_zero};
use crate::mesh::Domain;
use crate::normals::{NormalWeights, vertex_normals, vertices_without_normal};
use crate::parallel;
use crate::surface::{ANYWHERE, Border, Surface};
use crate::{Amount, Directions, GeometryError, Mesh, Monitor};
use local::Local;

/// How lengths are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Compensate {
    /// By the angle to the normal alone: d = t / cos (figure 8A). Exact where
    /// the closest place lies in a face with that normal.
    Local,
    /// By the distance to the whole surface (figure 8B), see [`Solver`].
    #[default]
    Global,
}

/// Settings of [`compensate`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CompensateOptions {
    /// How lengths are found.
    pub mode: Compensate,
    /// Largest error that counts as none, as a share of the thickness.
    pub tolerance: f64,
    /// Longest way in thicknesses, at least 1; directions whose cosine to the
    /// normal is below its inverse count as tangential.
    pub limit: f64,
    /// How distances beyond open borders are measured.
    pub border: Border,
}

impl Default for CompensateOptions {
    fn default() -> Self {
        Self {
            mode: Compensate::Global,
            tolerance: 1e-4,
            limit: 20.0,
            border: Border::Extend,
        }
    }
}

/// Compensated directions and how well they keep the thickness.
#[derive(Debug, Clone)]
pub struct Compensation {
    /// D = (d / t) D^: a height w = t lands at distance t.
    pub directions: Directions,
    /// Of heights w >= 0.
    pub outward: SideReport,
    /// Of heights w < 0.
    pub inward: SideReport,
    /// Widest angle between a direction and the vertex normal, in radians.
    pub largest_tilt: f64,
}

/// Lengths that keep `outward` and `inward` thickness along `directions` (§3.2).
///
/// The two sides are solved apart. Thickness is in metres, constant or one per
/// vertex, finite and not negative; where it is 0 the local factor 1 / cos is
/// kept, the limit for thin components. Isolated vertices keep their vectors
/// and are not counted. Cost: O(vertices · log triangles) for `Local`, and
/// one to a dozen times that for `Global`.
///
/// ```
/// use tessgraph_geometry::compensate::{CompensateOptions, compensate};
/// use tessgraph_geometry::{DirectionSource, Directions, Mesh, Unmonitored, glam::DVec3};
/// let plate = Mesh::from_faces(
///     vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
///     &[[0, 1, 2, 3]],
/// )?;
/// let leaning = vec![DVec3::new(0.0, 0.6, 0.8); 4];
/// let directions = Directions::new(&plate, leaning, DirectionSource::Surface)?;
/// let (t, options) = (0.1.into(), CompensateOptions::default());
/// let even = compensate(&plate, &directions, &t, &t, &options, &Unmonitored)?;
/// assert!((even.directions.outward()[2].z - 1.0).abs() < 1e-12);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::Compensated`], [`GeometryError::OtherTopology`];
/// [`GeometryError::ZeroDirection`], [`GeometryError::NoNormal`] and
/// [`GeometryError::OpposedDirection`] name vertices of faces;
/// [`GeometryError::OutOfRange`] for settings and thickness,
/// [`GeometryError::Empty`] for a mesh without faces, [`GeometryError::Cancelled`].
pub fn compensate(
    mesh: &Mesh,
    directions: &Directions,
    outward: &Amount,
    inward: &Amount,
    options: &CompensateOptions,
    monitor: &dyn Monitor,
) -> Result<Compensation, GeometryError> {
    check(mesh, directions, options)?;
    check_thickness(mesh, outward)?;
    check_thickness(mesh, inward)?;
    let units = unit_directions(mesh, directions.outward(), monitor)?;
    let normals = vertex_normals(mesh, NormalWeights::Angle, true, monitor)?;
    let largest_tilt = check_sides(mesh, &units, &normals)?;
    let surface = Surface::new(mesh, monitor)?;
    let work = Work {
        mesh,
        units: &units,
        normals: &normals,
        solver: Solver::new(&surface)
            .with_tolerance(options.tolerance)
            .with_limit(options.limit)
            .with_border(options.border),
        mode: options.mode,
    };
    let (out_vectors, out_report) = work.side(outward, Side::Outward, directions, monitor)?;
    let (in_vectors, in_report) = work.side(inward, Side::Inward, directions, monitor)?;
    Ok(Compensation {
        directions: directions.compensated(out_vectors, in_vectors)?,
        outward: out_report,
        inward: in_report,
        largest_tilt,
    })
}

/// What both sides share.
struct Work<'a> {
    mesh: &'a Mesh,
    units: &'a [DVec3],
    normals: &'a [DVec3],
    solver: Solver<'a>,
    mode: Compensate,
}

impl Work<'_> {
    /// Compensated vectors of one side, and its report.
    fn side(
        &self,
        thickness: &Amount,
        side: Side,
        directions: &Directions,
        monitor: &dyn Monitor,
    ) -> Result<(Vec<DVec3>, SideReport), GeometryError> {
        let local = Local {
            solver: &self.solver,
        };
        let moves = |vertex: usize| is_used(self.mesh, vertex);
        let solve = |vertex: usize, leaf: &mut u32| {
            if !moves(vertex) {
                return local::Found::default();
            }
            let start = Start {
                origin: self.mesh.positions()[vertex],
                direction: self.units[vertex],
                normal: self.normals[vertex],
                off_surface: 0.0,
            };
            let wanted = thickness.at(vertex);
            match self.mode {
                Compensate::Local => local.solve(&start, vertex, wanted, side, leaf),
                Compensate::Global => local::Found {
                    solution: self.solver.solve_near(&start, wanted, side, leaf),
                    ..Default::default()
                },
            }
        };
        let mut found = vec![local::Found::default(); self.mesh.vertex_count()];
        parallel::fill_chunks(&mut found, monitor, |first, found| {
            // The next vertex is mostly near the last one.
            let mut leaf = ANYWHERE;
            for (vertex, found) in (first..).zip(found) {
                *found = solve(vertex, &mut leaf);
            }
        })?;
        let vectors = (0..found.len()).map(|vertex| {
            let wanted = thickness.at(vertex);
            if !moves(vertex) {
                directions.outward()[vertex]
            } else if wanted > 0.0 {
                self.units[vertex] * (found[vertex].solution.length / wanted)
            } else {
                let cosine = self.units[vertex].dot(self.normals[vertex]);
                self.units[vertex] / cosine.max(1.0 / self.solver.limit)
            }
        });
        let vectors = vectors.collect();
        let used = (0..found.len()).filter(|&vertex| moves(vertex));
        let report = SideReport::gather(used.map(|v| (v as u32, thickness.at(v), found[v])));
        Ok((vectors, report))
    }
}

/// Whether a face names this vertex.
fn is_used(mesh: &Mesh, vertex: usize) -> bool {
    let adjacency = mesh.topology().adjacency();
    !adjacency.vertex_corners(vertex).is_empty()
}

fn check(
    mesh: &Mesh,
    directions: &Directions,
    options: &CompensateOptions,
) -> Result<(), GeometryError> {
    directions.check(mesh)?;
    if directions.is_compensated() {
        return Err(GeometryError::Compensated {
            operation: "CompensateThickness",
        });
    }
    check_tolerances(options.tolerance, options.limit)
}

/// Refuses tolerances and limits that make no sense.
pub(crate) fn check_tolerances(tolerance: f64, limit: f64) -> Result<(), GeometryError> {
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(GeometryError::OutOfRange {
            what: "the tolerance",
            value: tolerance,
            requirement: "it must be above 0 and below 1",
        });
    }
    if !(limit >= 1.0 && limit.is_finite()) {
        return Err(GeometryError::OutOfRange {
            what: "the length limit",
            value: limit,
            requirement: "it must be at least 1, in thicknesses",
        });
    }
    Ok(())
}

fn check_thickness(mesh: &Mesh, thickness: &Amount) -> Result<(), GeometryError> {
    thickness.check(mesh, Domain::Vertex)?;
    let (low, high) = thickness.range();
    let wrong = if high.is_finite() { low } else { high };
    if low < 0.0 || !low.is_finite() || high == f64::INFINITY {
        return Err(GeometryError::OutOfRange {
            what: "the thickness",
            value: wrong,
            requirement: "it must be finite and not negative",
        });
    }
    Ok(())
}

/// The directions at unit length; zero for isolated vertices without one.
fn unit_directions(
    mesh: &Mesh,
    vectors: &[DVec3],
    monitor: &dyn Monitor,
) -> Result<Vec<DVec3>, GeometryError> {
    let units = parallel::map(vectors.len(), monitor, |v| unit_or_zero(vectors[v]))?;
    let vertices = vertices_without_normal(mesh, &units);
    if vertices.is_empty() {
        Ok(units)
    } else {
        Err(GeometryError::ZeroDirection { vertices })
    }
}

/// Checks that every direction leaves on its normal's side; the widest angle.
pub(crate) fn check_sides(
    mesh: &Mesh,
    units: &[DVec3],
    normals: &[DVec3],
) -> Result<f64, GeometryError> {
    let vertices = vertices_without_normal(mesh, normals);
    if !vertices.is_empty() {
        return Err(GeometryError::NoNormal { vertices });
    }
    let used = || (0..units.len()).filter(|&vertex| is_used(mesh, vertex));
    let opposed = used().filter(|&vertex| units[vertex].dot(normals[vertex]) < -TANGENTIAL);
    let vertices: Vec<u32> = opposed.map(|vertex| vertex as u32).collect();
    if !vertices.is_empty() {
        return Err(GeometryError::OpposedDirection { vertices });
    }
    Ok(used()
        .map(|vertex| angle_between(units[vertex], normals[vertex]))
        .fold(0.0, f64::max))
}

/// Cosines this close to 0 are tangents, not opposed: rounding decides there.
const TANGENTIAL: f64 = 1e-12;
