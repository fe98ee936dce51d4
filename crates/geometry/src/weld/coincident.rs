//! Positions that are exactly equal.

use glam::DVec3;
use rayon::prelude::*;

use crate::{GeometryError, Monitor, parallel};

/// Parts that hashes fall into by their upper bits, so that a table of each
/// stays in the cache.
const PARTS: usize = 64;

/// Positions whose hashes are sorted into parts together.
const SORTED: usize = 1 << 15;

/// Two numbers of 32 bits: a position's index in the lower half; in the upper
/// its hash, and later the index of the first that has the same.
type Entry = u64;

/// A slot without an entry: no position has so high an index.
const EMPTY: Entry = Entry::MAX;

/// For each position the lowest index of one that is equal to it; -0 is 0.
///
/// Tables hold hashes alone, and positions are compared afterwards, from first
/// to last as they lie in memory. What a hash is decides only how long that
/// takes. Cost: O(positions), one look into a table each.
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub(super) fn lowest(
    positions: &[DVec3],
    monitor: &dyn Monitor,
) -> Result<Vec<u32>, GeometryError> {
    lowest_by(positions, hash, monitor)
}

fn lowest_by(
    positions: &[DVec3],
    hash: impl Fn(DVec3) -> u32 + Sync,
    monitor: &dyn Monitor,
) -> Result<Vec<u32>, GeometryError> {
    let mut entries: Vec<Entry> = parallel::zeroed(positions.len());
    let mut parts = by_part(positions, hash, &mut entries, monitor)?;
    // Equal positions lie in one part, in ascending order.
    parts.par_iter_mut().try_for_each(|part| {
        let mut table = Table::default();
        part.iter_mut().try_for_each(|entries| {
            monitor.check()?;
            for entry in entries.iter_mut() {
                let first = table.first(*entry);
                *entry = first << 32 | u64::from(*entry as u32);
            }
            Ok(())
        })
    })?;
    let mut lowest: Vec<u32> = parallel::zeroed(positions.len());
    let chunks = lowest
        .par_chunks_mut(SORTED)
        .zip(entries.par_chunks(SORTED));
    let differ = chunks.enumerate().map(|(chunk, (lowest, entries))| {
        monitor.check()?;
        let start = chunk * SORTED;
        for &entry in entries {
            lowest[entry as u32 as usize - start] = (entry >> 32) as u32;
        }
        let pairs = (start as u32..).zip(lowest.iter());
        let differs =
            |&(i, &first): &(u32, &u32)| positions[i as usize] != positions[first as usize];
        Ok(pairs.filter(differs).map(|(i, _)| i).collect())
    });
    let differ: Vec<Vec<u32>> = differ.collect::<Result<_, GeometryError>>()?;
    among(differ.concat(), positions, &mut lowest, monitor)?;
    Ok(lowest)
}

/// The same for positions that share a hash with an earlier, different one, given
/// in ascending order: then so do all that are equal to them.
fn among(
    mut differ: Vec<u32>,
    positions: &[DVec3],
    lowest: &mut [u32],
    monitor: &dyn Monitor,
) -> Result<(), GeometryError> {
    parallel::sort_by_key(&mut differ, monitor, |&i| bits(positions[i as usize]))?;
    let equal = |&a: &u32, &b: &u32| positions[a as usize] == positions[b as usize];
    for run in differ.chunk_by(equal) {
        for &i in run {
            lowest[i as usize] = run[0];
        }
    }
    Ok(())
}

/// Writes an entry for each position and cuts them into parts, each a list of
/// runs in ascending order.
fn by_part<'e>(
    positions: &[DVec3],
    hash: impl Fn(DVec3) -> u32 + Sync,
    entries: &'e mut [Entry],
    monitor: &dyn Monitor,
) -> Result<Vec<Vec<&'e mut [Entry]>>, GeometryError> {
    let chunks = entries
        .par_chunks_mut(SORTED)
        .zip(positions.par_chunks(SORTED));
    let runs = chunks.enumerate().map(|(chunk, (mut entries, positions))| {
        monitor.check()?;
        let hashes: Vec<u32> = positions.iter().map(|&position| hash(position)).collect();
        let mut ends = [0; PARTS];
        hashes.iter().for_each(|&hash| ends[part_of(hash)] += 1);
        let lengths = ends;
        let mut at = 0;
        for end in &mut ends {
            (*end, at) = (at, at + *end);
        }
        for (hash, index) in hashes.into_iter().zip(chunk * SORTED..) {
            let slot = &mut ends[part_of(hash)];
            entries[*slot] = u64::from(hash) << 32 | index as u64;
            *slot += 1;
        }
        Ok(lengths.map(|length| {
            let (run, rest) = std::mem::take(&mut entries).split_at_mut(length);
            entries = rest;
            run
        }))
    });
    let runs: Vec<[&mut [Entry]; PARTS]> = runs.collect::<Result<_, GeometryError>>()?;
    let mut parts: Vec<Vec<_>> = (0..PARTS).map(|_| Vec::with_capacity(runs.len())).collect();
    for run in runs.into_iter() {
        for (part, run) in parts.iter_mut().zip(run) {
            part.push(run);
        }
    }
    Ok(parts)
}

/// The first entry of each hash, found by its lower bits.
#[derive(Default)]
struct Table {
    slots: Vec<Entry>,
    used: usize,
}

impl Table {
    /// The index of the entry that was entered first with the same hash: its own
    /// if none was.
    #[inline]
    fn first(&mut self, entry: Entry) -> u64 {
        // At most half full, so that free slots are near.
        if 2 * self.used >= self.slots.len() {
            self.grow();
        }
        let slot = self.slot(entry);
        if self.slots[slot] == EMPTY {
            self.slots[slot] = entry;
            self.used += 1;
        }
        u64::from(self.slots[slot] as u32)
    }

    /// Where an entry of the same hash stands, or the free slot for one.
    #[inline]
    fn slot(&self, entry: Entry) -> usize {
        let mask = self.slots.len() - 1;
        let mut slot = (entry >> 32) as usize & mask;
        while self.slots[slot] != EMPTY && (self.slots[slot] ^ entry) >> 32 != 0 {
            slot = (slot + 1) & mask;
        }
        slot
    }

    #[cold]
    fn grow(&mut self) {
        let size = (4 * self.slots.len()).max(64);
        let old = std::mem::replace(&mut self.slots, vec![EMPTY; size]);
        for entry in old.into_iter().filter(|&entry| entry != EMPTY) {
            let slot = self.slot(entry);
            self.slots[slot] = entry;
        }
    }
}

fn part_of(hash: u32) -> usize {
    hash as usize >> (u32::BITS - PARTS.ilog2())
}

/// The bits of the coordinates, with 0 for -0.
fn bits(position: DVec3) -> [u64; 3] {
    (position + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// The bits of all three coordinates, mixed (the finish of MurmurHash3).
fn hash(position: DVec3) -> u32 {
    let [x, y, z] = bits(position);
    let mut bits = x.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    bits = (bits.rotate_left(31) ^ y).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
    bits = (bits.rotate_left(31) ^ z).wrapping_mul(0x1656_67B1_9E37_79F9);
    bits = (bits ^ (bits >> 33)).wrapping_mul(0xFF51_AFD7_ED55_8CCD);
    bits = (bits ^ (bits >> 33)).wrapping_mul(0xC4CE_B9FE_1A85_EC53);
    (bits >> 32) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;

    #[test]
    fn hashes_that_agree_by_chance_do_no_harm() {
        let random = |k: i64| (crate::random::uniform(7, k) * 40.0).floor();
        let places: Vec<DVec3> = (0..70_000)
            .map(|i| DVec3::new(random(3 * i), random(3 * i + 1), -random(3 * i + 2)))
            .collect();
        let good = lowest(&places, &Unmonitored).unwrap();
        let mut first = std::collections::BTreeMap::new();
        for ((i, &place), &lowest) in (0..).zip(&places).zip(&good) {
            assert_eq!(*first.entry(bits(place)).or_insert(i), lowest);
        }
        for hash in [|_| 7, |place: DVec3| hash(place) & 0xFC00_001F] {
            assert_eq!(lowest_by(&places, hash, &Unmonitored).unwrap(), good);
        }
    }
}
