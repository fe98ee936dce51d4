//! Four triangles side by side, laid out for vector instructions.

use glam::DVec3;

use super::node::NO_NODE;
use super::triangle::{Foot, Triangle};
use crate::vectors::{cross, dot, greater, lesser, minus};

/// Triangles in a leaf, and children of a node.
pub(crate) const WIDTH: usize = 4;

/// One number for each of the four.
pub(crate) type Lanes = [f64; WIDTH];

/// Four triangles with their edges and normals worked out beforehand.
///
/// Rows of four instead of four structs, so that the plain loop over lanes in
/// [`Leaf::squared_distances`] becomes vector code. Where there are fewer than
/// four triangles the last is repeated.
#[derive(Debug, Clone)]
pub(super) struct Leaf {
    a: [Lanes; 3],
    ab: [Lanes; 3],
    ac: [Lanes; 3],
    /// Unit normal; zero for a sliver.
    normal: [Lanes; 3],
    /// Twice the area; negative for a sliver, so that nothing is inside it.
    area2: Lanes,
    /// 1 / squared length of ab, ac and bc; 0 where that edge has no length.
    inverse: [Lanes; 3],
    /// Their numbers.
    pub(super) triangles: [u32; WIDTH],
    /// The node whose child this is, or [`NO_NODE`].
    pub(super) parent: u32,
}

impl Leaf {
    /// A leaf of the given triangles, one to four.
    pub(super) fn new(triangles: [u32; WIDTH], corners: impl Fn(u32) -> Triangle) -> Self {
        let zero = [[0.0; WIDTH]; 3];
        let mut leaf = Self {
            a: zero,
            ab: zero,
            ac: zero,
            normal: zero,
            area2: [-1.0; WIDTH],
            inverse: zero,
            triangles,
            parent: NO_NODE,
        };
        for (lane, &triangle) in triangles.iter().enumerate() {
            leaf.set(lane, corners(triangle));
        }
        leaf
    }

    fn set(&mut self, lane: usize, triangle: Triangle) {
        let [a, b, c] = triangle.0;
        let (ab, ac) = (b - a, c - a);
        let (normal, area2) = triangle.plane().unwrap_or((DVec3::ZERO, -1.0));
        for axis in 0..3 {
            self.a[axis][lane] = a[axis];
            self.ab[axis][lane] = ab[axis];
            self.ac[axis][lane] = ac[axis];
            self.normal[axis][lane] = normal[axis];
        }
        self.area2[lane] = area2;
        for (row, edge) in [ab, ac, ac - ab].into_iter().enumerate() {
            let squared = edge.length_squared();
            self.inverse[row][lane] = if squared > 0.0 { 1.0 / squared } else { 0.0 };
        }
    }

    /// Squared distance of `p` to each triangle, without branches.
    ///
    /// Inside the prism over a triangle it is the distance to its plane,
    /// elsewhere the least of those to its edges.
    #[inline(always)]
    pub(super) fn squared_distances(&self, p: DVec3) -> Lanes {
        let mut out = [0.0; WIDTH];
        for (k, out) in out.iter_mut().enumerate() {
            let row = |rows: &[Lanes; 3]| [rows[0][k], rows[1][k], rows[2][k]];
            let (ab, ac, n, a) = (
                row(&self.ab),
                row(&self.ac),
                row(&self.normal),
                row(&self.a),
            );
            let h = [p.x - a[0], p.y - a[1], p.z - a[2]];
            let to_b = dot(n, cross(h, ac));
            let to_c = dot(n, cross(ab, h));
            let height = dot(n, h);
            let bc = minus(ac, ab);
            let edges = lesser(
                to_segment(h, ab, self.inverse[0][k]),
                lesser(
                    to_segment(h, ac, self.inverse[1][k]),
                    to_segment(minus(h, ab), bc, self.inverse[2][k]),
                ),
            );
            let inside = (to_b >= 0.0) & (to_c >= 0.0) & (to_b + to_c <= self.area2[k]);
            *out = if inside { height * height } else { edges };
        }
        out
    }

    /// The place of triangle `number` closest to `p` if that is inside it: the
    /// same as [`Triangle::closest`], without making normal and area anew.
    pub(super) fn foot_inside(&self, number: u32, p: DVec3) -> Option<Foot> {
        let k = self.triangles.iter().position(|&other| other == number)?;
        let ([a, ab, ac, normal], area2) = (self.lane(k), self.area2[k]);
        let h = p - a;
        let (to_b, to_c) = (normal.dot(h.cross(ac)), normal.dot(ab.cross(h)));
        // A sliver's area is negative, and nothing is inside it.
        let inside = to_b >= 0.0 && to_c >= 0.0 && to_b + to_c <= area2;
        inside.then(|| {
            let (v, w) = (to_b / area2, to_c / area2);
            Foot {
                point: p - normal * normal.dot(h),
                barycentric: DVec3::new((1.0 - v - w).max(0.0), v, w),
            }
        })
    }

    /// Corner a, both edges and normal of one lane; the normal is zero for a sliver.
    pub(super) fn lane(&self, k: usize) -> [DVec3; 4] {
        let row = |rows: &[Lanes; 3]| DVec3::new(rows[0][k], rows[1][k], rows[2][k]);
        [
            row(&self.a),
            row(&self.ab),
            row(&self.ac),
            row(&self.normal),
        ]
    }
}

/// Squared distance from the end of `h` to the segment from the origin along `e`.
#[inline(always)]
fn to_segment(h: [f64; 3], e: [f64; 3], inverse: f64) -> f64 {
    let t = dot(h, e) * inverse;
    let t = lesser(greater(t, 0.0), 1.0);
    let q = [h[0] - t * e[0], h[1] - t * e[1], h[2] - t * e[2]];
    dot(q, q)
}
