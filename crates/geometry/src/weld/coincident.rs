//! Positions that are exactly equal.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::parallel::{self, in_order};
use crate::{GeometryError, Monitor};

/// Parts that are looked through side by side. Each passes over the part numbers
/// of all positions, so more of them cost more.
const PARTS: usize = 8;

/// A slot without a position.
const EMPTY: u32 = u32::MAX;

/// For each position the lowest index of one that is equal to it; -0 is 0.
///
/// Equal positions have equal hashes and so lie in one part; each part enters
/// its own in ascending order into a table, where the first of equals stays.
/// What a hash is decides only how long that takes. Cost: O(positions), one
/// look into the table each.
pub(super) fn lowest(
    positions: &[DVec3],
    monitor: &dyn Monitor,
) -> Result<Vec<u32>, GeometryError> {
    let hashes = parallel::map(positions.len(), monitor, |i| hash(positions[i]))?;
    let lowest: Vec<AtomicU32> = (0..positions.len()).map(|_| AtomicU32::new(0)).collect();
    (0..PARTS).into_par_iter().try_for_each(|part| {
        let count = hashes.iter().filter(|&&hash| part_of(hash) == part).count();
        // At most half full, so that free slots are near.
        let mut table = vec![EMPTY; (2 * count).next_power_of_two()];
        let mask = table.len() - 1;
        in_order(positions.len(), monitor, |i| {
            if part_of(hashes[i]) != part {
                return;
            }
            let mut slot = hashes[i] as usize & mask;
            let found = loop {
                match table[slot] {
                    EMPTY => {
                        table[slot] = i as u32;
                        break i as u32;
                    }
                    other if positions[other as usize] == positions[i] => break other,
                    _ => slot = (slot + 1) & mask,
                }
            };
            // Written once, by the one part it belongs to.
            lowest[i].store(found, Ordering::Relaxed);
        })
    })?;
    Ok(lowest.into_iter().map(AtomicU32::into_inner).collect())
}

fn part_of(hash: u32) -> usize {
    hash as usize >> (u32::BITS - PARTS.ilog2())
}

/// The bits of all three coordinates, mixed (the finish of MurmurHash3).
fn hash(position: DVec3) -> u32 {
    // Adding zero turns -0 into 0.
    let [x, y, z] = (position + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut bits = x.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    bits = (bits.rotate_left(31) ^ y).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
    bits = (bits.rotate_left(31) ^ z).wrapping_mul(0x1656_67B1_9E37_79F9);
    bits = (bits ^ (bits >> 33)).wrapping_mul(0xFF51_AFD7_ED55_8CCD);
    bits = (bits ^ (bits >> 33)).wrapping_mul(0xC4CE_B9FE_1A85_EC53);
    (bits >> 32) as u32
}
