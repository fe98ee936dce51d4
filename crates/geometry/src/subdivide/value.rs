//! What can be averaged, and the three filters every mask is made of.

use std::ops::{Add, Mul};

use glam::{DVec2, DVec3};

/// A quantity that masks average: a scalar, a pair or a triple.
pub(super) trait Value:
    Copy + Default + Send + Sync + bytemuck::Zeroable + Add<Output = Self> + Mul<f64, Output = Self>
{
    /// How far two values are apart; decides when an iteration has settled.
    fn gap(self, other: Self) -> f64;
}

impl Value for f64 {
    fn gap(self, other: Self) -> f64 {
        (self - other).abs()
    }
}

impl Value for DVec2 {
    fn gap(self, other: Self) -> f64 {
        (self - other).abs().max_element()
    }
}

impl Value for DVec3 {
    fn gap(self, other: Self) -> f64 {
        (self - other).abs().max_element()
    }
}

/// Zeroed memory straight from the system, so that pages are first touched by
/// the thread that fills them.
pub(super) fn zeroed<T: Value>(count: usize) -> Vec<T> {
    bytemuck::zeroed_vec(count)
}

/// The point half way.
pub(super) fn middle<T: Value>(a: T, b: T) -> T {
    (a + b) * 0.5
}

/// The moved middle one of three in a row: (1 6 1) / 8, cubic B-spline refinement.
pub(super) fn moved<T: Value>(a: T, b: T, c: T) -> T {
    (a + b * 6.0 + c) * 0.125
}

/// The limit of the middle one of three in a row: (1 4 1) / 6.
pub(super) fn limit<T: Value>(a: T, b: T, c: T) -> T {
    (a + b * 4.0 + c) * (1.0 / 6.0)
}

/// `a` at 0, `b` at 1, exactly.
pub(super) fn blend<T: Value>(a: T, b: T, t: f64) -> T {
    if t <= 0.0 {
        a
    } else if t >= 1.0 {
        b
    } else {
        a * (1.0 - t) + b * t
    }
}

/// Refines a line: `line` has m + 1 values, `out` receives the 2m - 1 values of
/// the refined line without its ends.
pub(super) fn refine_line<T: Value>(line: &[T], out: &mut [T]) {
    out[0] = middle(line[0], line[1]);
    for (three, pair) in line.windows(3).zip(out[1..].chunks_exact_mut(2)) {
        pair[0] = moved(three[0], three[1], three[2]);
        pair[1] = middle(three[1], three[2]);
    }
}
