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
