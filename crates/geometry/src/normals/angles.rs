//! The angles of all corners, many at a time.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::ops::Range;

use crate::math::atan2;
use crate::vectors::widened;
use crate::{GeometryError, Mesh, Monitor, parallel};

/// Corners whose angles are found together.
const BLOCK: usize = 16;

/// A number for each corner of a block.
type Block = [f64; BLOCK];

/// The angle of each face at each of its corners, in radians, one per corner: the
/// same as [`super::corner_angle`] to the last bit.
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub(super) fn corner_angles(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Vec<f64>, GeometryError> {
    let mut angles = parallel::zeroed(mesh.corner_count());
    parallel::fill_chunks(&mut angles, monitor, |first, angles| {
        widened(
            #[inline(always)]
            || fill(mesh, first, angles),
        );
    })?;
    Ok(angles)
}

/// The angles of the corners from `first` on.
#[inline(always)]
fn fill(mesh: &Mesh, first: usize, angles: &mut [f64]) {
    let (offsets, corners) = (mesh.topology().offsets(), mesh.topology().corners());
    let mut face = offsets.partition_point(|&start| start as usize <= first) - 1;
    let mut range = mesh.topology().corner_range(face);
    let positions = mesh.positions().as_slice();
    let place = |corner: usize| positions[corners[corner] as usize];
    // The place of a corner, given round its face from its first corner on.
    let round = |range: &Range<usize>, from: usize| place(range.start + from % range.len());
    let before = round(&range, first - range.start + range.len() - 1);
    let (mut corner, mut arm, mut here) = (first, before - place(first), place(first));
    for angles in angles.chunks_mut(BLOCK) {
        let mut arms = Arms::default();
        for k in 0..angles.len() {
            if corner == range.end {
                face += 1;
                range = mesh.topology().corner_range(face);
                here = place(corner);
                arm = place(range.end - 1) - here;
            }
            corner += 1;
            let next = place(if corner == range.end {
                range.start
            } else {
                corner
            });
            let ahead = next - here;
            arms.set(k, ahead, arm);
            (arm, here) = (here - next, next);
        }
        angles.copy_from_slice(&arms.angles()[..angles.len()]);
    }
}

/// Two vectors at each corner, coordinate by coordinate.
struct Arms {
    a: [Block; 3],
    b: [Block; 3],
}

impl Default for Arms {
    fn default() -> Self {
        Self {
            a: [[0.0; BLOCK]; 3],
            b: [[0.0; BLOCK]; 3],
        }
    }
}

impl Arms {
    #[inline(always)]
    fn set(&mut self, k: usize, a: glam::DVec3, b: glam::DVec3) {
        [self.a[0][k], self.a[1][k], self.a[2][k]] = a.to_array();
        [self.b[0][k], self.b[1][k], self.b[2][k]] = b.to_array();
    }

    /// As [`crate::math::angle_between`] finds the angle between them.
    #[inline(always)]
    fn angles(&self) -> Block {
        let ([ax, ay, az], [bx, by, bz]) = (&self.a, &self.b);
        let (mut sines, mut cosines) = ([0.0; BLOCK], [0.0; BLOCK]);
        for k in 0..BLOCK {
            let x = ay[k] * bz[k] - by[k] * az[k];
            let y = az[k] * bx[k] - bz[k] * ax[k];
            let z = ax[k] * by[k] - bx[k] * ay[k];
            sines[k] = (x * x + y * y + z * z).sqrt();
            cosines[k] = ax[k] * bx[k] + ay[k] * by[k] + az[k] * bz[k];
        }
        let mut ratios = [0.0; BLOCK];
        for k in 0..BLOCK {
            ratios[k] = (sines[k] / cosines[k]).abs();
        }
        let mut angles = arc_tangents(&ratios, &cosines);
        let usual = |ratio: f64| (ratio > SMALL) & (ratio < LARGE);
        if !ratios.iter().fold(true, |all, &ratio| all & usual(ratio)) {
            for k in 0..BLOCK {
                if !usual(ratios[k]) {
                    angles[k] = atan2(sines[k], cosines[k]);
                }
            }
        }
        angles
    }
}

/// Ratios between which [`arc_tangents`] needs no cases of its own.
const SMALL: f64 = 1e-18;
const LARGE: f64 = 1e18;

/// `atan2(y, x)` for y > 0, by `ratio` = y / |x| within the limits above.
///
/// The method of FreeBSD's msun, which `libm` follows (Sun Microsystems 1993),
/// operation by operation and so to the same bits, but with choices in place
/// of branches: the ratio is brought near 0 by the addition theorem from the
/// nearest of 0, 1/2, 1, 3/2 and infinity, and there a polynomial takes over.
#[inline(always)]
fn arc_tangents(ratio: &Block, x: &Block) -> Block {
    const PI_REST: f64 = 1.224_646_799_147_353_2e-16;
    let choose = |condition: bool, one: f64, other: f64| if condition { one } else { other };
    let mut out = [0.0; BLOCK];
    for (k, out) in out.iter_mut().enumerate() {
        let q = ratio[k];
        // The arc tangent of the nearest as a sum, and the rest as a fraction.
        let [mut high, mut low] = FROM_INFINITY;
        let (mut over, mut under) = (-1.0, q);
        for (limit, [far, near], fraction) in [
            (2.4375, FROM_THREE_HALVES, [q - 1.5, 1.0 + 1.5 * q]),
            (1.1875, FROM_ONE, [q - 1.0, q + 1.0]),
            (0.6875, FROM_HALF, [2.0 * q - 1.0, 2.0 + q]),
            (0.4375, [0.0, 0.0], [q, 1.0]),
        ] {
            let is_below = q < limit;
            high = choose(is_below, far, high);
            low = choose(is_below, near, low);
            over = choose(is_below, fraction[0], over);
            under = choose(is_below, fraction[1], under);
        }
        let rest = over / under;
        let angle = high - (rest * series(rest) - low - rest);
        *out = choose(x[k] < 0.0, PI - (angle - PI_REST), angle);
    }
    out
}

const FROM_HALF: [f64; 2] = [4.636_476_090_008_061e-1, 2.269_877_745_296_168_7e-17];
const FROM_ONE: [f64; 2] = [FRAC_PI_4, 3.061_616_997_868_383e-17];
const FROM_THREE_HALVES: [f64; 2] = [9.827_937_232_473_29e-1, 1.390_331_103_123_099_8e-17];
const FROM_INFINITY: [f64; 2] = [FRAC_PI_2, 6.123_233_995_736_766e-17];

/// 1 - atan(t) / t near 0, odd and even powers of t² apart.
#[inline(always)]
fn series(t: f64) -> f64 {
    const C: [f64; 11] = [
        3.333_333_333_333_293e-1,
        -1.999_999_999_987_648_3e-1,
        1.428_571_427_250_346_6e-1,
        -1.111_111_040_546_235_6e-1,
        9.090_887_133_436_507e-2,
        -7.691_876_205_044_83e-2,
        6.661_073_137_387_531e-2,
        -5.833_570_133_790_573_5e-2,
        4.976_877_994_615_932_4e-2,
        -3.653_157_274_421_691_6e-2,
        1.628_582_011_536_578_2e-2,
    ];
    let z = t * t;
    let w = z * z;
    let odd = z * (C[0] + w * (C[2] + w * (C[4] + w * (C[6] + w * (C[8] + w * C[10])))));
    let even = w * (C[1] + w * (C[3] + w * (C[5] + w * (C[7] + w * C[9]))));
    odd + even
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::uniform;

    #[test]
    fn blocks_give_the_bits_of_libm_on_every_machine() {
        let draw = |k: i64| uniform(11, k);
        for round in 0..2000 {
            let spread = if round % 2 == 0 { 2.0 } else { 110.0 };
            let number = |k: i64| {
                let size = libm::exp2((draw(2 * k) - 0.5) * spread);
                size * (2.0 * draw(2 * k + 1) - 1.0)
            };
            let block = |row: i64| -> [Block; 3] {
                std::array::from_fn(|axis| {
                    std::array::from_fn(|k| {
                        number((((round * 2 + row) * 3 + axis as i64) << 8) + k as i64)
                    })
                })
            };
            let mut arms = Arms {
                a: block(0),
                b: block(1),
            };
            // Right angles, straight ones, none, and arms without length.
            for (k, [a, b]) in [
                [[1.0, 0.0, 0.0], [0.0, 3.0, 0.0]],
                [[1.0, 2.0, 3.0], [-2.0, -4.0, -6.0]],
                [[1.0, 2.0, 3.0], [2.0, 4.0, 6.0]],
                [[0.0; 3], [1.0, 1.0, 1.0]],
                [[1e200, 0.0, 0.0], [1e200, 1e200, 0.0]],
                [[1.0, 0.0, 0.0], [1.0, 1e-20, 0.0]],
            ]
            .into_iter()
            .enumerate()
            {
                arms.set(k, a.into(), b.into());
            }
            let at = |rows: &[Block; 3], k: usize| glam::DVec3::from(rows.map(|row| row[k]));
            let bits = |block: Block| block.map(f64::to_bits);
            let expected =
                std::array::from_fn(|k| crate::math::angle_between(at(&arms.a, k), at(&arms.b, k)));
            assert_eq!(bits(arms.angles()), bits(expected));
            let wide = widened(
                #[inline(always)]
                || arms.angles(),
            );
            assert_eq!(bits(wide), bits(expected));
        }
    }

    #[test]
    fn every_corner_has_the_angle_it_has_alone() {
        // Triangles at the poles and more corners than one chunk; a corner that is
        // there twice, and one to which its neighbours return.
        let many = crate::test_shapes::sphere(80, 50);
        let places = [[0.0; 3], [0.0; 3], [1.0, 2.0, 3.0], [3.0, 1.0, 0.0]];
        let few = Mesh::from_faces(places.to_vec(), &[&[0, 1, 2, 3][..], &[3, 2, 3, 0, 1]]);
        for mesh in [&many, &few.unwrap()] {
            let angles = corner_angles(mesh, &crate::Unmonitored).unwrap();
            for (corner, angle) in angles.into_iter().enumerate() {
                let alone = crate::normals::corner_angle(mesh, corner as u32);
                assert_eq!(angle.to_bits(), alone.to_bits(), "{corner}");
            }
        }
        assert!(many.corner_count() > 3 * parallel::CHUNK);
    }
}
