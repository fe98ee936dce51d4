//! Functions whose result must not depend on the platform.
//!
//! The standard library forwards trigonometry to the system's C library, whose
//! last bits differ between machines. Everything here goes through `libm`, so
//! equal inputs give equal bytes everywhere. `f64::sqrt` is exact by IEEE 754
//! and may be used directly.

use glam::{DVec2, DVec3};

pub use libm::{acos, asin, atan, atan2, cbrt, cos, exp, hypot, log as ln, pow, sin, tan};
pub use std::f64::consts::{PI, TAU};

/// The angle between two vectors in radians, in 0..=π; 0 if either is zero.
///
/// atan2 of cross and dot product is accurate for small angles, where the
/// arc cosine of the dot product loses half of its digits.
pub fn angle_between(a: DVec3, b: DVec3) -> f64 {
    atan2(a.cross(b).length(), a.dot(b))
}

/// `vector` at unit length, or zero where it has no direction.
///
/// Scales by the largest component first, so that lengths from 1e-300 to 1e300
/// neither underflow nor overflow on the way.
pub fn unit_or_zero(vector: DVec3) -> DVec3 {
    let largest = vector.abs().max_element();
    if largest > 0.0 && largest.is_finite() {
        let scaled = vector / largest;
        scaled / scaled.length()
    } else {
        DVec3::ZERO
    }
}

/// Linear interpolation that is exact at both ends: `a` at 0 and `b` at 1.
pub fn lerp(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    a * (1.0 - t) + b * t
}

/// [`lerp`] in the plane.
pub fn lerp2(a: DVec2, b: DVec2, t: f64) -> DVec2 {
    a * (1.0 - t) + b * t
}

/// The eigenvalues of a symmetric matrix and their unit eigenvectors, by Jacobi
/// rotations (Golub and Van Loan 2013, §8.5); in no order.
pub fn symmetric_axes(mut m: [[f64; 3]; 3]) -> ([f64; 3], [DVec3; 3]) {
    let mut axes = [DVec3::X, DVec3::Y, DVec3::Z];
    // Convergence is quadratic; three sweeps usually suffice.
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let r = 3 - p - q;
            let (pp, qq, pq, pr, qr) = (m[p][p], m[q][q], m[p][q], m[p][r], m[q][r]);
            m[p][p] = pp - t * pq;
            m[q][q] = qq + t * pq;
            (m[p][q], m[q][p]) = (0.0, 0.0);
            m[p][r] = c * pr - s * qr;
            m[q][r] = s * pr + c * qr;
            (m[r][p], m[r][q]) = (m[p][r], m[q][r]);
            let (u, v) = (axes[p], axes[q]);
            axes[p] = u * c - v * s;
            axes[q] = u * s + v * c;
        }
    }
    ([m[0][0], m[1][1], m[2][2]], axes.map(unit_or_zero))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_angles_keep_their_digits() {
        let angle = angle_between(DVec3::X, DVec3::new(1.0, 1e-9, 0.0));
        assert!((angle - 1e-9).abs() < 1e-24);
    }

    #[test]
    fn unit_survives_extreme_lengths() {
        for length in [1e-300, 1.0, 1e300] {
            let unit = unit_or_zero(DVec3::new(3.0, 4.0, 0.0) * length);
            assert!((unit - DVec3::new(0.6, 0.8, 0.0)).length() < 1e-15);
        }
        assert_eq!(unit_or_zero(DVec3::ZERO), DVec3::ZERO);
    }
}
