//! Random numbers that depend on a seed and an id alone.

/// A number in 0..1 that depends on seed and id alone (SplitMix64, Steele et
/// al. 2014, over both).
pub fn uniform(seed: u64, id: i64) -> f64 {
    let step = 0x9E37_79B9_7F4A_7C15;
    let mixed = mix(mix(seed.wrapping_add(step))
        .wrapping_add(id as u64)
        .wrapping_add(step));
    // 53 bits fill a double's mantissa.
    (mixed >> 11) as f64 / (1u64 << 53) as f64
}

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}
