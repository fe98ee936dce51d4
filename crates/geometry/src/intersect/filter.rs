//! What plain floating point settles beyond doubt, so that exact predicates are
//! left with the rest.
//!
//! Bounds on rounding are for products that do not underflow: what is too small
//! for that settles nothing.

use glam::DVec3;

/// The rounding of one operation, relative to its result.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// Results below this may have lost digits to underflow.
const TINY: f64 = 1e-280;

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

/// Whether two faces certainly have nothing in common but the corner, or as
/// triangles the edge, that they share; `places` numbers their corners, equal
/// where these are shared.
#[inline]
pub(super) fn apart<const N: usize, const M: usize>(
    places: (&[u32; N], &[u32; M]),
    positions: &[DVec3],
) -> bool {
    let (mut in_a, mut in_b) = (0u32, 0u32);
    for (i, own) in places.0.iter().enumerate() {
        for (j, other) in places.1.iter().enumerate() {
            let equal = u32::from(own == other);
            in_a |= equal << i;
            in_b |= equal << j;
        }
    }
    // Written one by one: made by a closure they would be copied, and waited for.
    let (mut a, mut b) = ([DVec3::ZERO; N], [DVec3::ZERO; M]);
    for (at, &place) in a.iter_mut().zip(places.0) {
        *at = positions[place as usize];
    }
    for (at, &place) in b.iter_mut().zip(places.1) {
        *at = positions[place as usize];
    }
    let is_one = |mask: u32| mask.is_power_of_two();
    if in_a == 0 {
        lie_apart(&a, &b)
    } else if is_one(in_a) && is_one(in_b) {
        let shared = [in_a, in_b].map(|mask| mask.trailing_zeros() as usize);
        part_at(&a, &b, shared)
    } else if N == 3 && M == 3 && is_one(!in_a & 7) && is_one(!in_b & 7) {
        let [apex, other] = [in_a, in_b].map(|mask| (!mask & 7).trailing_zeros() as usize);
        lean_apart(a[(apex + 1) % N], a[(apex + 2) % N], a[apex], b[other])
    } else {
        false
    }
}

/// How far a place lies along a way, and a bound on the rounding of that: four
/// roundings of each product, one of the place's own difference.
#[inline(always)]
fn along(way: DVec3, arm: DVec3) -> (f64, f64) {
    let (x, y, z) = (way.x * arm.x, way.y * arm.y, way.z * arm.z);
    let size = x.abs() + y.abs() + z.abs();
    (x + y + z, 8.0 * ROUNDING * size + TINY)
}

/// Whether a plane between two sets of places certainly parts them.
#[inline(always)]
fn lie_apart<const N: usize, const M: usize>(a: &[DVec3; N], b: &[DVec3; M]) -> bool {
    // Any plane may be tried: across the way from one middle to the other.
    let sum = |places: &[DVec3]| {
        places
            .iter()
            .fold(DVec3::ZERO, |sum, &place| sum + place - a[0])
    };
    let way = sum(b) * (1.0 / M as f64) - sum(a) * (1.0 / N as f64);
    let mut high = 0.0;
    for &place in &a[1..] {
        let (at, error) = along(way, place - a[0]);
        high = greater(at + 2.0 * error, high);
    }
    b.iter().all(|&place| {
        let (at, error) = along(way, place - a[0]);
        at - 2.0 * error > high
    })
}

/// Whether a plane through the corner that both share certainly has the other
/// corners of one on its one side and those of the other beyond: what each
/// spans meets the other's in that corner alone.
#[inline(always)]
fn part_at<const N: usize, const M: usize>(
    a: &[DVec3; N],
    b: &[DVec3; M],
    shared: [usize; 2],
) -> bool {
    let point = a[shared[0]];
    // Across the ways to their middles, as if all corners were equally far.
    let to = |place: DVec3| {
        let arm = place - point;
        let size = arm.x.abs() + arm.y.abs() + arm.z.abs();
        // The shared corner itself leads nowhere.
        arm * (1.0 / greater(size, f64::MIN_POSITIVE))
    };
    let sum = |places: &[DVec3]| {
        places
            .iter()
            .fold(DVec3::ZERO, |sum, &place| sum + to(place))
    };
    let way = sum(b) * (1.0 / M as f64) - sum(a) * (1.0 / N as f64);
    let is_side = |(at, error): (f64, f64), sign: f64| at * sign > error;
    let on_side = |places: &[DVec3], shared: usize, sign: f64| {
        let mut all = true;
        for (corner, &place) in places.iter().enumerate() {
            all &= corner == shared || is_side(along(way, place - point), sign);
        }
        all
    };
    on_side(a, shared[0], -1.0) && on_side(b, shared[1], 1.0)
}

#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Whether two triangles on the edge from `start` to `end` certainly lean away
/// from each other: seen along the edge, by more than a right angle.
#[inline(always)]
fn lean_apart(start: DVec3, end: DVec3, own: DVec3, other: DVec3) -> bool {
    let (edge, own, other) = (end - start, own - start, other - start);
    let product = edge.cross(own).dot(edge.cross(other));
    // The same with all signs positive: what roundings are relative to.
    let sizes = |a: DVec3, b: DVec3| {
        let (a, b) = (a.abs(), b.abs());
        DVec3::new(
            a.y * b.z + a.z * b.y,
            a.z * b.x + a.x * b.z,
            a.x * b.y + a.y * b.x,
        )
    };
    let size = sizes(edge, own).dot(sizes(edge, other));
    product < -(16.0 * ROUNDING * size + TINY)
}
