//! What plain floating point settles beyond doubt, so that exact predicates are
//! left with the rest.
//!
//! Bounds on rounding are for products that do not underflow: what is too small
//! for that settles nothing.

use glam::DVec3;

/// The rounding of one operation, relative to its result.
pub(super) const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Results below this may have lost digits to underflow.
pub(super) const TINY: f64 = 1e-280;

/// The triple product of the ways from d to a, b and c, if its sign is certain
/// (Shewchuk 1997, first stage of `orient3d`).
#[inline(always)]
pub(super) fn triple(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<f64> {
    let (a, b, c) = (a - d, b - d, c - d);
    let (bc, cb) = (b.x * c.y, c.x * b.y);
    let (ca, ac) = (c.x * a.y, a.x * c.y);
    let (ab, ba) = (a.x * b.y, b.x * a.y);
    let product = a.z * (bc - cb) + b.z * (ca - ac) + c.z * (ab - ba);
    let sum = (bc.abs() + cb.abs()) * a.z.abs()
        + (ca.abs() + ac.abs()) * b.z.abs()
        + (ab.abs() + ba.abs()) * c.z.abs();
    (product.abs() > 8.0 * ROUNDING * sum + TINY).then_some(product)
}

/// Twice the area of a, b, c in the plane, if its sign is certain (as there).
#[inline(always)]
pub(super) fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Option<f64> {
    let left = (a[0] - c[0]) * (b[1] - c[1]);
    let right = (a[1] - c[1]) * (b[0] - c[0]);
    let product = left - right;
    (product.abs() > 4.0 * ROUNDING * (left.abs() + right.abs()) + TINY).then_some(product)
}
