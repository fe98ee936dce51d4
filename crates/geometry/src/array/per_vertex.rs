//! Thickness compensation of every single component vertex (§3.2, §5).

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use glam::DVec3;

use super::{ArrayDomain, ArrayOptions, ArrayPoint, Arrayed, Displace};
use super::{array_components_with, array_counts};
use crate::compensate::{Side, SideReport, Solution, Solver, Start, Status};
use crate::compensate::{check_sides, check_tolerances};
use crate::math::unit_or_zero;
use crate::normals::{NormalWeights, vertex_normals};
use crate::surface::{Border, Surface};
use crate::{Directions, GeometryError, Mesh, Monitor};

/// Settings of [`array_compensated`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PerVertexOptions {
    /// Largest error that counts as none, as a share of each vertex's height.
    pub tolerance: f64,
    /// Longest way, in heights of the vertex, at least 1.
    pub limit: f64,
    /// How distances beyond open borders are measured.
    pub border: Border,
}

impl Default for PerVertexOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-4,
            limit: 20.0,
            border: Border::Extend,
        }
    }
}

/// How well the vertices of an array keep their heights.
///
/// Vertices are those of the array as it is returned, joined or not; those at
/// height 0 lie in the surface and are on neither side.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PerVertexReport {
    /// Of heights above 0.
    pub outward: SideReport,
    /// Of heights below 0.
    pub inward: SideReport,
    /// Base faces (or parents) under unsolved outward vertices, ascending.
    pub outward_faces: Vec<u32>,
    /// Base faces (or parents) under unsolved inward vertices, ascending.
    pub inward_faces: Vec<u32>,
}

/// [`super::array_components`] with every vertex brought to its own height from
/// the base surface (§3.2, §5).
///
/// A vertex at signed height h = w s k is moved along its direction, whose
/// length makes no difference, until it is |h| from the surface; below 0 against
/// it. The paper's tool uses one factor for each vertex of the base, taken from
/// the component's box: an approximation that §5 names. A vertex without a
/// solution is left where it is farthest, and one whose place on a warped quad
/// is off the surface by more than its height at once is left uncompensated;
/// both count as unsolved. Cost: that of the array and 1 to 12 closest-point
/// searches for each vertex off the surface; 24 bytes per vertex on top.
///
/// ```
/// use tessgraph_geometry::{
///     ArrayOptions, DirectionSource, Directions, Mesh, PerVertexOptions, Unmonitored,
///     array_compensated, glam::DVec3,
/// };
/// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let base = Mesh::from_faces(square.clone(), &[[0, 1, 2, 3]])?;
/// let lid = Mesh::from_faces(square.iter().map(|p| [p[0], p[1], 0.2]).collect(), &[[0, 1, 2, 3]])?;
/// let leaning = vec![DVec3::new(0.0, 0.6, 0.8); 4];
/// let leaning = Directions::new(&base, leaning, DirectionSource::Surface)?;
/// let (options, rule) = (ArrayOptions::default(), PerVertexOptions::default());
/// let (array, report) =
///     array_compensated(&base, &[&lid], &leaning, &options, &rule, &Unmonitored)?;
/// assert!((array.mesh.positions()[2].z - 0.2).abs() < 1e-12);
/// assert!(report.outward.unsolved.is_empty());
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// Those of [`super::array_components`]; [`GeometryError::Compensated`] for
/// compensated directions, [`GeometryError::NoNormal`] and
/// [`GeometryError::OpposedDirection`] name vertices of the base, and
/// [`GeometryError::OutOfRange`] is for the settings.
pub fn array_compensated(
    base: &Mesh,
    components: &[&Mesh],
    directions: &Directions,
    options: &ArrayOptions<'_>,
    rule: &PerVertexOptions,
    monitor: &dyn Monitor,
) -> Result<(Arrayed, PerVertexReport), GeometryError> {
    directions.check(base)?;
    if directions.is_compensated() {
        return Err(GeometryError::Compensated {
            operation: "`compensate: PerVertex` of ArrayComponents",
        });
    }
    check_tolerances(rule.tolerance, rule.limit)?;
    check_directions(base, directions, monitor)?;
    let surface = Surface::new(base, monitor)?;
    let cells = match options.domain {
        ArrayDomain::Face => base.face_count(),
        ArrayDomain::Parent(grids) => grids.len(),
    };
    let most = array_counts(components, cells, options.choose)?.vertices;
    let lift = Lift {
        solver: Solver::new(&surface)
            .with_tolerance(rule.tolerance)
            .with_limit(rule.limit)
            .with_border(rule.border),
        surface: &surface,
        records: (0..most).map(|_| Record::default()).collect(),
    };
    let array = array_components_with(base, components, directions, options, &lift, monitor)?;
    let report = lift.report(&array);
    Ok((array, report))
}

/// Every direction must leave the base on its normal's side.
fn check_directions(
    base: &Mesh,
    directions: &Directions,
    monitor: &dyn Monitor,
) -> Result<(), GeometryError> {
    let normals = vertex_normals(base, NormalWeights::Angle, true, monitor)?;
    let check = |vectors: &[DVec3]| {
        let units: Vec<DVec3> = vectors.iter().copied().map(unit_or_zero).collect();
        check_sides(base, &units, &normals).map(|_tilt| ())
    };
    check(directions.outward())?;
    if directions.is_symmetric() {
        return Ok(());
    }
    check(directions.inward())
}

/// Moves each point until it is its height from the surface, and takes notes.
struct Lift<'a> {
    solver: Solver<'a>,
    surface: &'a Surface,
    /// One per vertex of the array before joining: points come from many
    /// threads, each to its own record.
    records: Vec<Record>,
}

/// What was found at one vertex; nothing for those in the surface.
#[derive(Default)]
struct Record {
    /// Bits of the height.
    height: AtomicU64,
    /// Bits of the distance reached.
    reached: AtomicU64,
    /// Evaluations times 4 plus the status's number.
    state: AtomicU32,
    face: AtomicU32,
}

/// Statuses by their number in [`Record::state`].
const STATUSES: [Status; 4] = [
    Status::Solved,
    Status::Extended,
    Status::BorderClipped,
    Status::Unsolved,
];

impl Record {
    fn write(&self, face: u32, height: f64, solution: &Solution) {
        let status = STATUSES.iter().position(|s| *s == solution.status);
        let state = solution.evaluations.min(u32::MAX >> 2) << 2 | status.unwrap_or(0) as u32;
        // Relaxed is enough: they are read after the threads were joined.
        self.height.store(height.to_bits(), Ordering::Relaxed);
        let reached = solution.reached.to_bits();
        self.reached.store(reached, Ordering::Relaxed);
        self.state.store(state, Ordering::Relaxed);
        self.face.store(face, Ordering::Relaxed);
    }

    fn height(&self) -> f64 {
        f64::from_bits(self.height.load(Ordering::Relaxed))
    }

    fn face(&self) -> u32 {
        self.face.load(Ordering::Relaxed)
    }

    fn solution(&self) -> Solution {
        let state = self.state.load(Ordering::Relaxed);
        Solution {
            // The vertex is in its place; nobody asks for the way there.
            length: 0.0,
            reached: f64::from_bits(self.reached.load(Ordering::Relaxed)),
            status: STATUSES[state as usize % 4],
            evaluations: state >> 2,
        }
    }
}

impl Displace for Lift<'_> {
    fn height(&self, point: &ArrayPoint) -> f64 {
        let (height, wanted) = (point.height, point.height.abs());
        let length = point.direction.length();
        if wanted <= 0.0 || !wanted.is_finite() {
            return height;
        }
        let solution = if length > 0.0 {
            self.solve(point, point.direction / length)
        } else {
            // Opposite directions have cancelled out: there is no way to go.
            Solution {
                status: Status::Unsolved,
                ..Solution::default()
            }
        };
        if let Some(record) = self.records.get(point.vertex as usize) {
            record.write(point.face, height, &solution);
        }
        if length > 0.0 {
            solution.length.copysign(height) / length
        } else {
            0.0
        }
    }
}

impl Lift<'_> {
    fn solve(&self, point: &ArrayPoint, direction: DVec3) -> Solution {
        let start = Start {
            origin: point.position,
            direction,
            normal: point.normal,
            // A place on a bilinear patch is off the faces by an unknown warp.
            off_surface: f64::INFINITY,
        };
        let wanted = point.height.abs();
        let side = if point.height > 0.0 {
            Side::Outward
        } else {
            Side::Inward
        };
        let mut solution = self.solver.solve(&start, wanted, side);
        if solution.status == Status::Unsolved && solution.length == 0.0 {
            // Farther than wanted before it moved: flattening it would be worse.
            solution.length = wanted;
            let end = point.position + direction * wanted.copysign(point.height);
            solution.reached = self.surface.distance(end, self.solver.border).0;
            solution.evaluations += 1;
        }
        solution
    }

    /// Counts up the vertices that are left in the array.
    fn report(&self, array: &Arrayed) -> PerVertexReport {
        let side = |of: fn(f64) -> bool| {
            let vertices = (0..array.mesh.vertex_count()).filter_map(move |vertex| {
                let source = match &array.vertex_sources {
                    Some(sources) => sources[vertex] as usize,
                    None => vertex,
                };
                let record = self.records.get(source)?;
                of(record.height()).then_some((vertex as u32, record))
            });
            let unsolved = vertices
                .clone()
                .filter(|(_, record)| record.solution().status == Status::Unsolved);
            let mut faces: Vec<u32> = unsolved.map(|(_, record)| record.face()).collect();
            faces.sort_unstable();
            faces.dedup();
            let found = vertices.map(|(v, record)| (v, record.height().abs(), record.solution()));
            (SideReport::of_solutions(found), faces)
        };
        let (outward, outward_faces) = side(|height| height > 0.0);
        let (inward, inward_faces) = side(|height| height < 0.0);
        PerVertexReport {
            outward,
            inward,
            outward_faces,
            inward_faces,
        }
    }
}
