//! Times kernels beside other libraries and the machine's limits.
//!
//! Every benchmark of the workspace is a list of [`Case`]s. A case has our
//! kernel, perhaps other libraries that do the same work, and perhaps a limit:
//! what the machine needs for the memory traffic alone. All of them run in
//! turn, A B C A B C, so that whatever else the machine does meets all alike;
//! of each the least processor time counts. One line of a Markdown table comes
//! out, which docs/benchmarks.md takes as it is.
//!
//! `cargo bench -p PACKAGE -- [--quick] [NAME]...`: `--quick` runs the smallest
//! size of each case, names pick cases that hold one of them.

mod case;
mod clock;
mod held;
pub mod limits;
mod outside;
mod report;
pub mod shapes;

pub use case::{Bench, Case};
pub use outside::Arrays;

/// A number in 0..1 that depends on `seed` and `index` alone (SplitMix64,
/// Steele et al. 2014): the fixed seed of every benchmark's input.
pub fn random(seed: u64, index: u64) -> f64 {
    let mix = |mut z: u64| {
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    };
    let step = 0x9E37_79B9_7F4A_7C15_u64;
    let mixed = mix(mix(seed.wrapping_add(step)).wrapping_add(index.wrapping_mul(step)));
    (mixed >> 11) as f64 / (1u64 << 53) as f64
}

/// `items` in an order that depends on `seed` alone (Fisher and Yates).
pub fn shuffle<T>(items: &mut [T], seed: u64) {
    for end in (1..items.len()).rev() {
        let other = (random(seed, end as u64) * (end + 1) as f64) as usize;
        items.swap(end, other.min(end));
    }
}
