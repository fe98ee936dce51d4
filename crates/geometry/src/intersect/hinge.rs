//! Crossings that run along a polygon's diagonal.
//!
//! Where one polygon's plane goes through the other exactly along a diagonal,
//! as happens in every regular pattern, neither of the triangles beside the
//! diagonal crosses anything: each lies on one side. Only together they do.

use glam::DVec3;

use super::polygon::Polygon;
use super::predicate::{side, side_of};
use crate::math::unit_or_zero;

/// A diagonal and the far corners of the triangles beside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hinge {
    pub(super) edge: [DVec3; 2],
    pub(super) wings: [DVec3; 2],
}

impl Hinge {
    /// Whether the wings lie on different sides of a triangle's plane, each
    /// farther than `tolerance`.
    fn straddles(&self, triangle: [DVec3; 3], tolerance: f64) -> bool {
        let [one, two] = self.wings.map(|wing| sign(triangle, wing, tolerance));
        one * two < 0
    }

    /// Whether the wings of two hinges on one line take turns round it, no two
    /// of them within `tolerance` of one half plane.
    fn alternates(&self, other: &Self, tolerance: f64) -> bool {
        let along = unit_or_zero(self.edge[1] - self.edge[0]);
        let away = |wing: DVec3| along.cross(wing - self.edge[0]);
        let clear = |own: DVec3, others: DVec3| {
            away(own).dot(away(others)) < 0.0
                || sign([self.edge[0], self.edge[1], own], others, tolerance) != 0
        };
        // Whether a wing is met on the way from the first own wing to the second.
        let turn = |a: DVec3, b: DVec3| side(self.edge[0], self.edge[1], a, b);
        let [from, to] = self.wings;
        let between = |wing: DVec3| {
            if turn(from, to) > 0.0 {
                turn(from, wing) > 0.0 && turn(wing, to) > 0.0
            } else {
                turn(from, wing) > 0.0 || turn(wing, to) > 0.0
            }
        };
        let every = |own: &DVec3| other.wings.iter().all(|&wing| clear(*own, wing));
        self.wings.iter().all(every) && between(other.wings[0]) != between(other.wings[1])
    }
}

/// On which side of a triangle's plane a point is: -1, 1, or 0 within the
/// tolerance; exact where that is 0.
fn sign(triangle: [DVec3; 3], point: DVec3, tolerance: f64) -> i8 {
    let height = if tolerance > 0.0 {
        let normal = unit_or_zero((triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]));
        (point - triangle[0]).dot(normal)
    } else {
        side_of(triangle, point)
    };
    i8::from(height > tolerance) - i8::from(height < -tolerance)
}

/// Least distance from the border, as a share of the triangle's size, at which
/// a place counts as inside where the tolerance does not say.
const INSIDE: f64 = 1e-12;

/// Whether a diagonal of `a` lies in a triangle of `b`, `a` being on both sides.
pub(super) fn through_hinge(
    a: &Polygon<'_>,
    b: &Polygon<'_>,
    choices: [usize; 2],
    tolerance: f64,
) -> bool {
    (0..a.diagonals()).any(|index| {
        let hinge = a.hinge(choices[0], index);
        (0..b.diagonals() + 1).any(|index| {
            b.triangle(choices[1], index).is_some_and(|corners| {
                let flat = |point: DVec3| sign(corners.at, point, tolerance) == 0;
                hinge.edge.iter().all(|&end| flat(end))
                    && hinge.straddles(corners.at, tolerance)
                    && lies_inside(hinge.edge, corners.at, tolerance)
            })
        })
    })
}

/// Whether a stretch of a segment in a triangle's plane is inside it, longer
/// than the tolerance and farther than that from its border in the middle.
fn lies_inside([start, end]: [DVec3; 2], triangle: [DVec3; 3], tolerance: f64) -> bool {
    let [a, b, c] = triangle;
    let normal = unit_or_zero((b - a).cross(c - a));
    let size = (b - a).length().max((c - a).length()).max((c - b).length());
    let margin = tolerance.max(size * INSIDE);
    let (mut from, mut to) = (0.0f64, 1.0f64);
    let sides = [(a, b), (b, c), (c, a)].map(|(a, b)| {
        let inward = normal.cross(unit_or_zero(b - a));
        ((start - a).dot(inward), (end - a).dot(inward))
    });
    for (near, far) in sides {
        let cut = near / (near - far);
        match (near > 0.0, far > 0.0) {
            (true, true) => {}
            (true, false) => to = to.min(cut),
            (false, true) => from = from.max(cut),
            (false, false) => return false,
        }
    }
    let middle = (from + to) * 0.5;
    let deep = |(near, far): (f64, f64)| near + (far - near) * middle > margin;
    (to - from) * (end - start).length() > margin && sides.into_iter().all(deep)
}

/// Whether diagonals of both lie in one line and the triangles beside them
/// alternate round it.
pub(super) fn hinges_cross(
    a: &Polygon<'_>,
    b: &Polygon<'_>,
    choices: [usize; 2],
    tolerance: f64,
) -> bool {
    (0..a.diagonals()).any(|in_a| {
        let one = a.hinge(choices[0], in_a);
        (0..b.diagonals()).any(|in_b| {
            let two = b.hinge(choices[1], in_b);
            is_common_line(one.edge, two.edge, tolerance) && one.alternates(&two, tolerance)
        })
    })
}

/// Whether two segments lie in one line and have a stretch in common.
fn is_common_line(one: [DVec3; 2], two: [DVec3; 2], tolerance: f64) -> bool {
    let way = one[1] - one[0];
    let (along, length) = (unit_or_zero(way), way.length());
    let margin = tolerance.max(length * INSIDE);
    let [s, t] = two.map(|end| {
        let arm = end - one[0];
        (arm.dot(along), along.cross(arm).length())
    });
    let common = length.min(s.0.max(t.0)) - s.0.min(t.0).max(0.0);
    s.1 <= margin && t.1 <= margin && common > margin
}
