//! Two triangles: whether they cross or meet, decided exactly.
//!
//! Signs that [`super::filter`] leaves open come from Shewchuk's adaptive
//! predicates (1997).

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

use super::filter;
use crate::math::unit_or_zero;

/// A triangle with the numbers of its places; equal places have equal numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corners {
    pub(super) at: [DVec3; 3],
    pub(super) place: [u32; 3],
}

/// Positive where `d` is on the side of a, b, c from which they turn left,
/// zero exactly in their plane.
#[inline]
pub(super) fn side(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    if let Some(product) = filter::triple(a, b, c, d) {
        return -product;
    }
    let coord = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    -orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// As [`side`], for the plane of a triangle.
pub(super) fn side_of([a, b, c]: [DVec3; 3], d: DVec3) -> f64 {
    side(a, b, c, d)
}

/// Which side of the line from a to b the point c is on, seen along `axis`.
#[inline]
fn turn(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let flat = |p: DVec3| [p[i], p[j]];
    if let Some(area) = filter::area(flat(a), flat(b), flat(c)) {
        return area;
    }
    let coord = |p: DVec3| Coord { x: p[i], y: p[j] };
    orient2d(coord(a), coord(b), coord(c))
}

/// An axis along which the triangle does not look like a line; `None` if it is
/// a line or a point.
pub(super) fn open_axis([a, b, c]: [DVec3; 3]) -> Option<usize> {
    let widest = (b - a).cross(c - a).abs().max_position();
    let axes = [widest, (widest + 1) % 3, (widest + 2) % 3];
    axes.into_iter().find(|&axis| turn(axis, a, b, c) != 0.0)
}

/// Whether the insides of two triangles cross: their planes do, and along the
/// common line both triangles hold a common stretch (Guigue and Devillers 2003).
pub(super) fn crosses(a: &Corners, b: &Corners) -> bool {
    straddling(a.at, b.at).is_some_and(|[a, b]| overlaps_along_line(a, b))
}

/// Both triangles turned so that the first corner of each is alone on its side
/// of the other's plane and in front of it; `None` unless both have corners
/// strictly on both sides.
fn straddling(mut a: [DVec3; 3], mut b: [DVec3; 3]) -> Option<[[DVec3; 3]; 2]> {
    let of_a = a.map(|corner| side_of(b, corner));
    let first_a = alone(of_a)?;
    let of_b = b.map(|corner| side_of(a, corner));
    let first_b = alone(of_b)?;
    a.rotate_left(first_a);
    b.rotate_left(first_b);
    if of_a[first_a] < 0.0 {
        b.swap(1, 2);
    }
    if of_b[first_b] < 0.0 {
        a.swap(1, 2);
    }
    Some([a, b])
}

fn alone(sides: [f64; 3]) -> Option<usize> {
    let front = sides.iter().filter(|&&side| side > 0.0).count();
    let back = sides.iter().filter(|&&side| side < 0.0).count();
    match (front, back) {
        (0, _) | (_, 0) => None,
        (1, _) => sides.iter().position(|&side| side > 0.0),
        _ => sides.iter().position(|&side| side < 0.0),
    }
}

fn overlaps_along_line([p1, q1, r1]: [DVec3; 3], [p2, q2, r2]: [DVec3; 3]) -> bool {
    side(p1, q1, p2, q2) < 0.0 && side(p1, r1, r2, p2) < 0.0
}

/// How far two crossing triangles go through each other, and how long the
/// segment is in which they do; `None` where they do not cross.
///
/// The depth is the least distance that would separate them along the normal
/// of one of them. Both are measured in floating point.
pub(super) fn extent(a: &Corners, b: &Corners) -> Option<[f64; 2]> {
    let [a, b] = straddling(a.at, b.at)?;
    if !overlaps_along_line(a, b) {
        return None;
    }
    let heights = |of: [DVec3; 3], over: [DVec3; 3]| {
        let normal = unit_or_zero((over[1] - over[0]).cross(over[2] - over[0]));
        of.map(|corner| (corner - over[0]).dot(normal))
    };
    let (of_a, of_b) = (heights(a, b), heights(b, a));
    let through = |heights: [f64; 3]| {
        let low = heights[0].min(heights[1]).min(heights[2]);
        let high = heights[0].max(heights[1]).max(heights[2]);
        high.min(-low).max(0.0)
    };
    let on_plane = |corners: [DVec3; 3], heights: [f64; 3], far: usize| {
        let fall = heights[0] - heights[far];
        let share = if fall == 0.0 {
            0.0
        } else {
            (heights[0] / fall).clamp(0.0, 1.0)
        };
        corners[0] + (corners[far] - corners[0]) * share
    };
    let one = [on_plane(a, of_a, 1), on_plane(a, of_a, 2)];
    let two = [on_plane(b, of_b, 1), on_plane(b, of_b, 2)];
    Some([through(of_a).min(through(of_b)), common_length(one, two)])
}

/// Length that two segments of one line have in common.
fn common_length(one: [DVec3; 2], two: [DVec3; 2]) -> f64 {
    let ways = [one[1] - one[0], two[1] - two[0]];
    let longer = if ways[1].length_squared() > ways[0].length_squared() {
        ways[1]
    } else {
        ways[0]
    };
    let along = unit_or_zero(longer);
    let span = |segment: [DVec3; 2]| {
        let [s, t] = segment.map(|end| (end - one[0]).dot(along));
        (s.min(t), s.max(t))
    };
    let (one, two) = (span(one), span(two));
    (one.1.min(two.1) - one.0.max(two.0)).max(0.0)
}

/// Whether two triangles have a point in common besides the corner or edge
/// that they share; borders count.
pub(super) fn meets(a: &Corners, b: &Corners) -> bool {
    let shared = |corner: &usize| b.place.contains(&a.place[*corner]);
    let in_a: Few = Few::of((0..3).filter(shared));
    let in_b: Few = Few::of((0..3).filter(|&corner: &usize| a.place.contains(&b.place[corner])));
    match (in_a.count, in_b.count) {
        (0, _) | (_, 0) => {
            // Mostly one lies wholly on one side of the other's plane.
            let of_a = a.at.map(|corner| side_of(b.at, corner));
            if is_one_side(of_a) {
                return false;
            }
            let of_b = b.at.map(|corner| side_of(a.at, corner));
            if is_one_side(of_b) {
                return false;
            }
            let any = |of: &Corners, sides: [f64; 3], over: &Corners| {
                (0..3).any(|k| {
                    let next = (k + 1) % 3;
                    let ends = [sides[k], sides[next]];
                    sided_segment_meets([of.at[k], of.at[next]], ends, over.at)
                })
            };
            any(a, of_a, b) || any(b, of_b, a)
        }
        (1, 1) => {
            let far = |of: &Corners, at: usize| [of.at[(at + 1) % 3], of.at[(at + 2) % 3]];
            let [p, q] = far(a, in_a.items[0]);
            let [r, s] = far(b, in_b.items[0]);
            // Beside the other's plane they have only the shared corner in it.
            let beside =
                |[one, two]: [f64; 2]| (one > 0.0 && two > 0.0) || (one < 0.0 && two < 0.0);
            let of_b = [r, s].map(|end| side_of(a.at, end));
            if beside(of_b) {
                return false;
            }
            let of_a = [p, q].map(|end| side_of(b.at, end));
            !beside(of_a)
                && (sided_segment_meets([p, q], of_a, b.at)
                    || sided_segment_meets([r, s], of_b, a.at))
        }
        (2, 2) => is_folded(a, b),
        _ => true,
    }
}

/// Up to three corner numbers, without allocation.
struct Few {
    items: [usize; 3],
    count: usize,
}

impl Few {
    fn of(corners: impl Iterator<Item = usize>) -> Self {
        let mut out = Self {
            items: [0; 3],
            count: 0,
        };
        for corner in corners {
            out.items[out.count] = corner;
            out.count += 1;
        }
        out
    }
}

/// Whether two triangles that share an edge lie in one plane and on the same
/// side of that edge: one folded over onto the other.
pub(super) fn is_folded(a: &Corners, b: &Corners) -> bool {
    let apex = |of: &Corners, other: &Corners| {
        (0..3).find(|&corner| !other.place.contains(&of.place[corner]))
    };
    let (Some(in_a), Some(in_b)) = (apex(a, b), apex(b, a)) else {
        return false;
    };
    let (edge, tip) = ([a.at[(in_a + 1) % 3], a.at[(in_a + 2) % 3]], b.at[in_b]);
    let Some(axis) = open_axis(a.at) else {
        return false;
    };
    // The plane last: neighbours are often in one plane, and to tell that from
    // nearly so takes long, but then they mostly lie on both sides of the edge.
    let own = turn(axis, edge[0], edge[1], a.at[in_a]);
    let other = turn(axis, edge[0], edge[1], tip);
    other != 0.0 && (own > 0.0) == (other > 0.0) && side_of(a.at, tip) == 0.0
}

/// Whether all corners are strictly in front of a plane, or all behind it.
fn is_one_side(sides: [f64; 3]) -> bool {
    sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
}

/// Whether the segment from p to q, whose ends are on these sides of a triangle's
/// plane, has a point in common with it, ends and borders included.
fn sided_segment_meets([p, q]: [DVec3; 2], [of_p, of_q]: [f64; 2], triangle: [DVec3; 3]) -> bool {
    if (of_p > 0.0 && of_q > 0.0) || (of_p < 0.0 && of_q < 0.0) {
        return false;
    }
    if of_p == 0.0 && of_q == 0.0 {
        return segment_meets_flat(p, q, triangle);
    }
    let [a, b, c] = triangle;
    let sides = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
}

/// As [`sided_segment_meets`] within the triangle's plane: nothing separates them,
/// neither an edge of the triangle nor the segment.
fn segment_meets_flat(p: DVec3, q: DVec3, triangle: [DVec3; 3]) -> bool {
    let Some(axis) = open_axis(triangle) else {
        return false;
    };
    let [a, b, c] = triangle;
    let inside = turn(axis, a, b, c).signum();
    let beyond = |from: DVec3, to: DVec3| {
        turn(axis, from, to, p) * inside < 0.0 && turn(axis, from, to, q) * inside < 0.0
    };
    if beyond(a, b) || beyond(b, c) || beyond(c, a) {
        return false;
    }
    let sides = triangle.map(|corner| turn(axis, p, q, corner));
    !(sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0))
}
