//! Pairs of faces that certainly do not meet, sorted out four at a time.
//!
//! Nearly all faces whose boxes meet are neighbours, or pass each other closely.
//! A plane between them, found in floating point and judged with a bound on its
//! rounding, settles that; only what it leaves is worth an exact predicate. Pairs
//! that share as many corners are judged side by side, in vector instructions.

use glam::DVec3;

use super::filter::{ROUNDING, TINY};
use crate::surface::{Lanes, WIDTH};
use crate::vectors::{cross, dot, greater, minus};

/// Sorts out pairs of triangles and pairs of quads, given by the numbers of their
/// places; of all others nothing is certain.
pub(super) struct Sieve<'a> {
    positions: &'a [DVec3],
    /// Triangles that share nothing, a corner, an edge.
    triangles: [Four<3>; 3],
    /// Quads that share nothing, a corner.
    quads: [Four<4>; 2],
    /// Pairs of faces that may have more in common than the corner or edge they
    /// share.
    pub(super) doubtful: Vec<[u32; 2]>,
}

impl<'a> Sieve<'a> {
    /// A sieve for places at `positions`.
    pub(super) fn new(positions: &'a [DVec3]) -> Self {
        Self {
            positions,
            triangles: [Four::NONE; 3],
            quads: [Four::NONE; 2],
            doubtful: Vec::new(),
        }
    }

    /// Takes one more pair of faces, with the place of each of their corners.
    #[inline(always)]
    pub(super) fn take(&mut self, faces: [u32; 2], places: [&[u32]; 2]) {
        match places {
            [&[a, b, c], &[d, e, f]] => self.triangles(faces, [[a, b, c], [d, e, f]]),
            [&[a, b, c, d], &[e, f, g, h]] => self.quads(faces, [[a, b, c, d], [e, f, g, h]]),
            _ => self.doubtful.push(faces),
        }
    }

    #[inline(always)]
    fn triangles(&mut self, faces: [u32; 2], places: [[u32; 3]; 2]) {
        let shared = shared(&places);
        // The kind is looked up rather than branched on: it comes in no order.
        let kind = COUNT[shared[0]];
        let Some(four) = self
            .triangles
            .get_mut(kind)
            .filter(|_| kind == COUNT[shared[1]])
        else {
            self.doubtful.push(faces);
            return;
        };
        let first = shared.map(|corners| FIRST_OF_TRIANGLE[corners]);
        if four.add(faces, starting_at(first, places), self.positions) {
            let certain = match kind {
                0 => four.lie_apart(),
                1 => four.part_at_first(),
                _ => four.lean_apart(),
            };
            four.keep(certain, &mut self.doubtful);
        }
    }

    #[inline(always)]
    fn quads(&mut self, faces: [u32; 2], places: [[u32; 4]; 2]) {
        let [alone, corner] = &mut self.quads;
        let shared = shared(&places);
        match shared.map(|corners| COUNT[corners]) {
            [0, 0] => {
                if alone.add(faces, places, self.positions) {
                    alone.keep(alone.lie_apart(), &mut self.doubtful);
                }
            }
            [1, 1] => {
                let first = shared.map(|corners| corners.trailing_zeros() as usize);
                if corner.add(faces, starting_at(first, places), self.positions) {
                    corner.keep(corner.part_at_first(), &mut self.doubtful);
                }
            }
            _ => self.doubtful.push(faces),
        }
    }

    /// Judges the pairs that were taken and still wait for others.
    pub(super) fn finish(&mut self) {
        let doubtful = &mut self.doubtful;
        let [alone, corner, edge] = &mut self.triangles;
        alone.keep(alone.lie_apart(), doubtful);
        corner.keep(corner.part_at_first(), doubtful);
        edge.keep(edge.lean_apart(), doubtful);
        let [alone, corner] = &mut self.quads;
        alone.keep(alone.lie_apart(), doubtful);
        corner.keep(corner.part_at_first(), doubtful);
    }
}

/// How many corners a set of corners holds, a bit for each.
const COUNT: [usize; 16] = [0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4];

/// Of the corners that a triangle shares: the one, or the one beside two.
const FIRST_OF_TRIANGLE: [usize; 16] = [0, 0, 1, 2, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

/// Which corners of each of two faces the other has too, a bit for each; faces
/// have at most four.
#[inline(always)]
fn shared<const N: usize>([a, b]: &[[u32; N]; 2]) -> [usize; 2] {
    let (mut in_a, mut in_b) = (0, 0);
    for (i, own) in a.iter().enumerate() {
        for (j, other) in b.iter().enumerate() {
            let equal = usize::from(own == other);
            in_a |= equal << i;
            in_b |= equal << j;
        }
    }
    [in_a & 15, in_b & 15]
}

/// The corners of two faces, each from its corner `first` on.
#[inline(always)]
fn starting_at<const N: usize>(first: [usize; 2], places: [[u32; N]; 2]) -> [[u32; N]; 2] {
    let mut turned = places;
    for ((turned, places), first) in turned.iter_mut().zip(&places).zip(first) {
        for (k, place) in turned.iter_mut().enumerate() {
            *place = places[(first + k) % N];
        }
    }
    turned
}

/// Up to four pairs of faces with N corners, row by row.
struct Four<const N: usize> {
    faces: [[u32; 2]; WIDTH],
    /// Of both faces, each corner, each axis.
    corners: [[[Lanes; 3]; N]; 2],
    count: usize,
}

impl<const N: usize> Four<N> {
    const NONE: Self = Self {
        faces: [[0; 2]; WIDTH],
        corners: [[[[0.0; WIDTH]; 3]; N]; 2],
        count: 0,
    };

    /// Adds a pair; whether there are four now.
    #[inline(always)]
    fn add(&mut self, faces: [u32; 2], places: [[u32; N]; 2], positions: &[DVec3]) -> bool {
        let lane = self.count;
        for (rows, places) in self.corners.iter_mut().zip(places) {
            for (rows, place) in rows.iter_mut().zip(places) {
                let at = positions[place as usize].to_array();
                for (row, at) in rows.iter_mut().zip(at) {
                    row[lane] = at;
                }
            }
        }
        self.faces[lane] = faces;
        self.count += 1;
        self.count == WIDTH
    }

    /// Forgets all pairs but those that are not `certain`, which become doubtful.
    #[inline(always)]
    fn keep(&mut self, certain: [bool; WIDTH], doubtful: &mut Vec<[u32; 2]>) {
        for (faces, certain) in self.faces.iter().zip(certain).take(self.count) {
            if !certain {
                doubtful.push(*faces);
            }
        }
        self.count = 0;
    }

    /// Where a corner of the first face (`side` 0) or second is, of one pair.
    #[inline(always)]
    fn at(&self, side: usize, corner: usize, lane: usize) -> [f64; 3] {
        let rows = &self.corners[side][corner];
        [rows[0][lane], rows[1][lane], rows[2][lane]]
    }

    /// The ways from `from` to all corners of one face but the first few.
    #[inline(always)]
    fn ways(&self, side: usize, from: [f64; 3], lane: usize) -> [[f64; 3]; N] {
        let mut ways = [[0.0; 3]; N];
        for (corner, way) in ways.iter_mut().enumerate() {
            *way = minus(self.at(side, corner, lane), from);
        }
        ways
    }

    /// Whether a plane certainly parts both faces.
    #[inline(always)]
    fn lie_apart(&self) -> [bool; WIDTH] {
        let mut out = [false; WIDTH];
        for (lane, out) in out.iter_mut().enumerate() {
            let from = self.at(0, 0, lane);
            let (a, b) = (self.ways(0, from, lane), self.ways(1, from, lane));
            // Any plane may be tried: across the way from one middle to the other.
            let across = minus(sum(&b), sum(&a));
            let (mut high, mut low) = (0.0, f64::INFINITY);
            for &way in &a[1..] {
                let (at, error) = along(across, way);
                high = greater(at + 2.0 * error, high);
            }
            for &way in &b {
                let (at, error) = along(across, way);
                low = -greater(2.0 * error - at, -low);
            }
            *out = low > high;
        }
        out
    }

    /// Whether a plane through the first corner, which both share, certainly has
    /// the others of the one on its one side and those of the other beyond: what
    /// each spans meets the other's in that corner alone.
    #[inline(always)]
    fn part_at_first(&self) -> [bool; WIDTH] {
        let mut out = [false; WIDTH];
        for (lane, out) in out.iter_mut().enumerate() {
            let from = self.at(0, 0, lane);
            let (a, b) = (self.ways(0, from, lane), self.ways(1, from, lane));
            // Across the ways to their middles, as if all corners were equally far.
            let across = minus(sum(&b.map(even)), sum(&a.map(even)));
            let mut least = f64::INFINITY;
            for (ways, sign) in [(&a, -1.0), (&b, 1.0)] {
                for &way in &ways[1..] {
                    let (at, error) = along(across, way);
                    least = -greater(error - at * sign, -least);
                }
            }
            *out = least > 0.0;
        }
        out
    }
}

impl Four<3> {
    /// Whether two triangles certainly lean away from each other, the edge that
    /// both share being behind their first corner: seen along it, by more than a
    /// right angle.
    #[inline(always)]
    fn lean_apart(&self) -> [bool; WIDTH] {
        let mut out = [false; WIDTH];
        for (lane, out) in out.iter_mut().enumerate() {
            let start = self.at(0, 1, lane);
            let to = |side: usize, corner: usize| minus(self.at(side, corner, lane), start);
            let (edge, own, other) = (to(0, 2), to(0, 0), to(1, 0));
            let product = dot(cross(edge, own), cross(edge, other));
            let size = dot(cross_sizes(edge, own), cross_sizes(edge, other));
            *out = product < -(16.0 * ROUNDING * size + TINY);
        }
        out
    }
}

/// How far a place lies along a way, and a bound on the rounding of that: four
/// roundings of each product, one of the place's own difference.
#[inline(always)]
fn along(way: [f64; 3], arm: [f64; 3]) -> (f64, f64) {
    let (x, y, z) = (way[0] * arm[0], way[1] * arm[1], way[2] * arm[2]);
    let size = x.abs() + y.abs() + z.abs();
    (x + y + z, 8.0 * ROUNDING * size + TINY)
}

/// A way at about unit length; none stays none.
#[inline(always)]
fn even(way: [f64; 3]) -> [f64; 3] {
    let size = way[0].abs() + way[1].abs() + way[2].abs();
    let scale = 1.0 / greater(size, f64::MIN_POSITIVE);
    way.map(|along| along * scale)
}

#[inline(always)]
fn sum<const N: usize>(ways: &[[f64; 3]; N]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for way in ways {
        for (sum, along) in sum.iter_mut().zip(way) {
            *sum += along;
        }
    }
    sum
}

/// [`cross`] with all signs positive: what its roundings are relative to.
#[inline(always)]
fn cross_sizes(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let (a, b) = (a.map(f64::abs), b.map(f64::abs));
    [
        a[1] * b[2] + a[2] * b[1],
        a[2] * b[0] + a[0] * b[2],
        a[0] * b[1] + a[1] * b[0],
    ]
}
