//! Loops for the vectors of the machine that runs them.
#![allow(
    unsafe_code,
    reason = "code for instructions that not every machine has can only be entered so"
)]

/// What `kernel` gives, by a second version of it for 256-bit vectors (AVX2) where
/// the machine has them: twice as many numbers at a time, of which each is the same.
///
/// No result can depend on it. The compiler keeps the order of every sum, and
/// fuses no product with one: that would be another instruction set (FMA), and
/// is never done unasked. The closure, and what it calls in loops, should be
/// `#[inline(always)]`; what is not stays as it is for every machine.
#[inline]
pub(crate) fn widened<R>(kernel: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2")]
        fn with_avx2<R>(kernel: impl FnOnce() -> R) -> R {
            kernel()
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the machine has the only feature the function needs.
            return unsafe { with_avx2(kernel) };
        }
    }
    kernel()
}

// Ways as plain arrays, which loops over lanes of them turn into vectors.

#[inline(always)]
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
pub(crate) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The smaller of two numbers: one instruction, where `f64::min` must also
/// look for NaN.
#[inline(always)]
pub(crate) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of two numbers, as [`lesser`].
#[inline(always)]
pub(crate) fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::uniform;

    /// Products added to others, roots, quotients and a sum in order: what fused or
    /// regrouped instructions would round otherwise.
    #[inline(always)]
    fn kernel(numbers: &[f64]) -> (Vec<u64>, u64) {
        let mut out = Vec::with_capacity(numbers.len());
        let mut sum = 0.0;
        for (a, b) in numbers.iter().zip(&numbers[1..]) {
            out.push(((a * b + a) / (b * b + 1.0).sqrt() - a * a).to_bits());
            sum += a * b;
        }
        (out, sum.to_bits())
    }

    #[test]
    fn wide_vectors_give_the_same_bits() {
        let numbers: Vec<f64> = (0..10_001).map(|k| uniform(5, k) * 7.0 - 3.0).collect();
        let wide = widened(
            #[inline(always)]
            || kernel(&numbers),
        );
        assert_eq!(wide, kernel(&numbers));
    }
}
