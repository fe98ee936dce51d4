//! Global compensation of one point (§3.2, figure 8B).

use glam::DVec3;

use super::exit::exit;
use super::highest::highest;
use crate::surface::{ANYWHERE, Border, Facing, Measured, Surface};

/// Which side of the base a point is moved to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// Along the direction: heights w >= 0.
    Outward,
    /// Against the direction: heights w < 0.
    Inward,
}

/// A point of the base and the way it is to be moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// The point; anywhere on the surface, or near it as on a bilinear patch.
    pub origin: DVec3,
    /// Unit vector along which outward points go; inward ones go against it.
    pub direction: DVec3,
    /// Unit normal of the base there.
    pub normal: DVec3,
    /// The most `origin` may lie away from the surface: 0 for a vertex, the
    /// patch's warp if known, infinity if not.
    pub off_surface: f64,
}

/// How a point reached its thickness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Status {
    /// At the wanted distance from the mesh itself.
    #[default]
    Solved,
    /// At the wanted distance from the extension of the border.
    Extended,
    /// At the wanted distance from the mesh, but not from its extension.
    BorderClipped,
    /// Nowhere on its way at the wanted distance: left where it is farthest.
    Unsolved,
}

impl Status {
    /// Its number in a field of statuses: 0 solved, 1 extended, 2 border clipped, 3
    /// unsolved; [`NOT_MOVED`] stands for points that need none.
    pub fn number(self) -> f64 {
        match self {
            Self::Solved => 0.0,
            Self::Extended => 1.0,
            Self::BorderClipped => 2.0,
            Self::Unsolved => 3.0,
        }
    }
}

/// Number of points without a status: not on this side, or of no face.
pub const NOT_MOVED: f64 = -1.0;

/// The length found for one point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Solution {
    /// How far the point is moved along its direction, in metres.
    pub length: f64,
    /// Its distance from the surface there, by the solver's border rule.
    pub reached: f64,
    /// Whether that is the wanted thickness.
    pub status: Status,
    /// Distances to the surface that were evaluated.
    pub evaluations: u32,
}

/// Finds the lengths at which points are a wanted distance from a surface.
///
/// The distance d' to a surface is the least of the distances to its
/// triangles, each a convex function of the length d. So while the closest
/// triangle is nearer than the wanted t, no solution comes before the way
/// leaves that triangle's neighbourhood, a length found without any search;
/// going from exit to exit never passes the first solution, and ends at it.
/// Each step is at least t - d', the safe step of §3.2's iteration, and on a
/// plane one is enough. Cost: one closest-point search a step and one ray.
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored, glam::DVec3};
/// use tessgraph_geometry::compensate::{Side, Solver, Start, Status};
/// use tessgraph_geometry::surface::{Border, Surface};
/// let plate = Mesh::from_faces(
///     vec![[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 0.0], [-9.0, 9.0, 0.0]],
///     &[[0, 1, 2, 3]],
/// )?;
/// let surface = Surface::new(&plate, &Unmonitored)?;
/// let solver = Solver::new(&surface);
/// let start = Start {
///     origin: DVec3::ZERO,
///     direction: DVec3::new(0.6, 0.0, 0.8),
///     normal: DVec3::Z,
///     off_surface: 0.0,
/// };
/// let solution = solver.solve(&start, 2.0, Side::Outward);
/// assert_eq!(solution.status, Status::Solved);
/// assert!((solution.length - 2.5).abs() < 1e-12);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Solver<'a> {
    pub(super) surface: &'a Surface,
    /// Largest error counted as solved, as a share of the thickness; 1e-4 by
    /// default. Never below the rounding of the mesh's coordinates.
    pub tolerance: f64,
    /// Longest way, in thicknesses; 20 by default.
    pub limit: f64,
    /// How distances beyond open borders are measured; `Extend` by default.
    pub border: Border,
    /// Distances below this are rounding, in metres.
    rounding: f64,
}

/// Steps after which a point counts as unsolved. Each triangle is left once,
/// so only ways along very many triangles come near it.
const STEPS: u32 = 1000;

/// Crossings of the base this close to the start, in thicknesses, are the
/// start's own faces.
const OWN: f64 = 1e-9;

/// How much longer than the local length an extended one may be (§5 iii).
const EXTENDED: f64 = 1.5;

/// The way of a point: `origin + length * direction`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
}

impl Path {
    pub(super) fn at(&self, length: f64) -> DVec3 {
        self.origin + self.direction * length
    }
}

/// How a climb along a path ended.
enum Climb {
    /// At the wanted distance.
    Reached(f64, Measured),
    /// Farther than wanted at once: the start lies beyond, or the closest
    /// feature of the border changed to one whose extension is elsewhere.
    Jumped(f64),
    /// Still nearer than wanted up to the limit.
    TooNear,
}

impl<'a> Solver<'a> {
    /// A solver against `surface` with the default tolerance, limit and border.
    pub fn new(surface: &'a Surface) -> Self {
        Self {
            surface,
            tolerance: 1e-4,
            limit: 20.0,
            border: Border::default(),
            rounding: 8.0 * f64::EPSILON * surface.largest_coordinate(),
        }
    }

    /// The same with another tolerance.
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// The same with another limit, in thicknesses.
    pub fn with_limit(self, limit: f64) -> Self {
        Self { limit, ..self }
    }

    /// The same with another border rule.
    pub fn with_border(self, border: Border) -> Self {
        Self { border, ..self }
    }

    /// The smallest length that brings the start to `thickness` (finite, >= 0)
    /// from the surface without passing through it, and what was reached.
    ///
    /// Passing through means to cross a face against the side the point
    /// started from: from the front outward, from behind inward. Beyond it
    /// distances belong to the other side. Where no length does it, the point
    /// is left where it is farthest before that face or the limit.
    pub fn solve(&self, start: &Start, thickness: f64, side: Side) -> Solution {
        self.solve_near(start, thickness, side, &mut { ANYWHERE })
    }

    /// [`Solver::solve`] that starts its searches at `leaf` and leaves there where
    /// they ended: the same solution, found sooner for one point after another.
    pub(super) fn solve_near(
        &self,
        start: &Start,
        thickness: f64,
        side: Side,
        leaf: &mut u32,
    ) -> Solution {
        if thickness <= 0.0 {
            return Solution::default();
        }
        let path = Path {
            origin: start.origin,
            direction: match side {
                Side::Outward => start.direction,
                Side::Inward => -start.direction,
            },
        };
        let limit = self.limit * thickness;
        let mut evaluations = 0;
        let from = (thickness - start.off_surface).max(0.0);
        let climb = self.climb(
            &path,
            thickness,
            from..limit,
            Border::Clip,
            leaf,
            &mut evaluations,
        );
        let (length, measured) = match climb {
            Climb::Reached(length, measured) => (length, measured),
            Climb::Jumped(reached) => {
                return Solution {
                    length: from,
                    reached,
                    status: Status::Unsolved,
                    evaluations,
                };
            }
            Climb::TooNear => {
                let end = self
                    .crossing(&path, thickness, limit, side)
                    .unwrap_or(limit);
                return self.farthest(&path, thickness, end, evaluations);
            }
        };
        if let Some(end) = self.crossing(&path, thickness, length, side) {
            return self.farthest(&path, thickness, end, evaluations);
        }
        let mut solution = Solution {
            length,
            reached: measured.distance,
            status: Status::Solved,
            evaluations,
        };
        if measured.at_rim && self.border == Border::Extend {
            self.extend(&path, start, thickness, side, &measured, &mut solution);
        }
        solution
    }

    /// The largest deviation from `thickness` that counts as none, in metres.
    pub(super) fn slack(&self, thickness: f64) -> f64 {
        (self.tolerance * thickness).max(self.rounding)
    }

    /// Where the path first passes through the surface against its side.
    fn crossing(&self, path: &Path, thickness: f64, to: f64, side: Side) -> Option<f64> {
        let facing = match side {
            Side::Outward => Facing::Front,
            Side::Inward => Facing::Back,
        };
        let from = OWN * thickness;
        self.surface
            .first_hit(path.origin, path.direction, from, to, facing)
            .map(|hit| hit.at)
    }

    /// Goes from exit to exit until the distance is `thickness`.
    fn climb(
        &self,
        path: &Path,
        thickness: f64,
        range: std::ops::Range<f64>,
        border: Border,
        leaf: &mut u32,
        evaluations: &mut u32,
    ) -> Climb {
        let slack = self.slack(thickness);
        let mut length = range.start;
        for _ in 0..STEPS {
            let measured = self.surface.measure(path.at(length), border, *leaf);
            *evaluations += 1;
            *leaf = measured.closest.leaf;
            let gap = thickness - measured.distance;
            if gap.abs() <= slack {
                return Climb::Reached(length, measured);
            }
            if gap < 0.0 {
                return Climb::Jumped(measured.distance);
            }
            let Some(next) = exit(path, &measured.piece, thickness, length, range.end) else {
                return Climb::TooNear;
            };
            length = next.max(length + gap);
            if length > range.end {
                return Climb::TooNear;
            }
        }
        Climb::TooNear
    }

    /// Lengthens a solution whose closest place is on the border until the
    /// distance to the extended border is `thickness` (§5 iii).
    fn extend(
        &self,
        path: &Path,
        start: &Start,
        thickness: f64,
        side: Side,
        clipped: &Measured,
        solution: &mut Solution,
    ) {
        let cosine = start.direction.dot(start.normal);
        let longest = (EXTENDED * thickness / cosine.max(1e-300)).min(self.limit * thickness);
        let range = solution.length..longest.max(solution.length);
        let mut leaf = clipped.closest.leaf;
        let evaluations = &mut solution.evaluations;
        let border = Border::Extend;
        let climb = self.climb(path, thickness, range, border, &mut leaf, evaluations);
        let reached = match climb {
            Climb::Reached(length, measured) => {
                let crossing = self.crossing(path, thickness, length, side);
                crossing.is_none().then_some((length, measured))
            }
            Climb::Jumped(_) | Climb::TooNear => None,
        };
        match reached {
            Some((length, measured)) => {
                if length > solution.length {
                    solution.status = Status::Extended;
                }
                solution.length = length;
                solution.reached = measured.distance;
            }
            None => {
                solution.status = Status::BorderClipped;
                let point = path.at(solution.length);
                let measured = self.surface.measure(point, Border::Extend, leaf);
                solution.reached = measured.distance;
            }
        }
    }

    /// The unsolved end: where the path is farthest from the surface.
    fn farthest(&self, path: &Path, thickness: f64, end: f64, evaluations: u32) -> Solution {
        let (length, reached, more) = highest(self.surface, path, end, self.slack(thickness));
        Solution {
            length,
            reached,
            status: Status::Unsolved,
            evaluations: evaluations + more,
        }
    }
}
