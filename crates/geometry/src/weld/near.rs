//! Positions that lie near each other.

use glam::DVec3;

use super::coincident;
use crate::parallel::{self, CHUNK, in_order};
use crate::sets::Sets;
use crate::{GeometryError, Monitor};

/// The sets of all positions that chains of pairs within `distance` lead
/// between; the distance is above 0.
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub(super) fn sets(
    positions: &[DVec3],
    distance: f64,
    monitor: &dyn Monitor,
) -> Result<Sets, GeometryError> {
    if let Some(sets) = spread_out(positions, distance, monitor)? {
        return Ok(sets);
    }
    let mut sets = Sets::of_roots(coincident::lowest(positions, monitor)?);
    join_crowded(positions, distance, &mut sets, monitor)?;
    Ok(sets)
}

/// Side of a large cell in distances: what is near a place mostly lies in the
/// same cell.
const LARGE: f64 = 16.0;

/// Positions looked at for each one, on average, from which on they are crowded.
const CROWDED: usize = 32;

/// Least distance as a share of the largest coordinate, and the largest
/// coordinate, with which cells can be counted exactly.
const LEAST: f64 = 1e-12;
const LARGEST: f64 = 1e150;

/// No position.
const NONE: u32 = u32::MAX;

/// [`sets`] for positions most of which have few others within some distances:
/// every one is compared with all earlier ones of the cells it reaches. `None`
/// if that would be too many.
fn spread_out(
    positions: &[DVec3],
    distance: f64,
    monitor: &dyn Monitor,
) -> Result<Option<Sets>, GeometryError> {
    let largest = |largest: f64, place: &DVec3| largest.max(place.abs().max_element());
    let largest = positions.iter().fold(0.0, largest);
    if distance < LEAST * largest || distance.max(largest) > LARGEST {
        return Ok(None);
    }
    let mut cells = Cells::new(positions, distance);
    let mut sets = Sets::new(positions.len());
    let mut looks = 0;
    for start in (0..positions.len()).step_by(CHUNK) {
        monitor.check()?;
        let end = (start + CHUNK).min(positions.len());
        for i in start..end {
            looks += cells.enter(i as u32, positions, &mut sets);
        }
        if looks > CROWDED * end {
            return Ok(None);
        }
    }
    Ok(Some(sets))
}

/// Positions in large cells, which are found by a hash: cells of equal hash
/// are one.
struct Cells {
    low: DVec3,
    /// Cells a metre.
    scale: f64,
    distance: f64,
    /// The position entered last into each cell.
    last: Vec<u32>,
    /// For each position the one entered into its cell before.
    before: Vec<u32>,
}

impl Cells {
    fn new(positions: &[DVec3], distance: f64) -> Self {
        let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        Self {
            low,
            scale: 1.0 / (LARGE * distance),
            distance,
            last: vec![NONE; positions.len().next_power_of_two()],
            before: vec![NONE; positions.len()],
        }
    }

    /// Joins position `i` with all earlier ones within the distance, and enters
    /// it; says how many were looked at.
    #[inline]
    fn enter(&mut self, i: u32, positions: &[DVec3], sets: &mut Sets) -> usize {
        let place = positions[i as usize];
        // A little more than the distance, above the rounding of squares.
        let reach = DVec3::splat(self.distance * (1.0 + 1e-9));
        let (own, low, high) = (
            self.cell(place),
            self.cell(place - reach),
            self.cell(place + reach),
        );
        let (mut looks, mut is_new) = (0, true);
        let ends = |axis: usize| low[axis]..=high[axis];
        for z in ends(2) {
            for y in ends(1) {
                for x in ends(0) {
                    let mut other = self.last[self.slot([x, y, z])];
                    while other != NONE {
                        looks += 1;
                        let there = positions[other as usize];
                        if place.distance_squared(there) <= self.distance * self.distance {
                            sets.join(i, other);
                            is_new &= place != there;
                        }
                        other = self.before[other as usize];
                    }
                }
            }
        }
        // Of equal positions one is enough.
        if is_new {
            let slot = self.slot(own);
            self.before[i as usize] = self.last[slot];
            self.last[slot] = i;
        }
        looks
    }

    /// The cell of a place not more than a cell below the lowest.
    #[inline]
    fn cell(&self, place: DVec3) -> [u64; 3] {
        let cells = (place - self.low) * self.scale;
        // Off the lattice that positions often lie on.
        cells.to_array().map(|x| (x + 1.38) as i64 as u64)
    }

    #[inline]
    fn slot(&self, [x, y, z]: [u64; 3]) -> usize {
        let mixed = x
            .wrapping_mul(0x9E37_79B9_7F4A_7C15)
            .wrapping_add(y.wrapping_mul(0xC2B2_AE3D_27D4_EB4F))
            .wrapping_add(z.wrapping_mul(0x1656_67B1_9E37_79F9));
        let mixed = (mixed ^ (mixed >> 32)).wrapping_mul(0xFF51_AFD7_ED55_8CCD);
        (mixed >> 32) as usize & (self.last.len() - 1)
    }
}

/// Joins all pairs within `distance` by a grid whose cells are so small that
/// all points of one cell belong together.
fn join_crowded(
    positions: &[DVec3],
    distance: f64,
    sets: &mut Sets,
    monitor: &dyn Monitor,
) -> Result<(), GeometryError> {
    let Some(low) = positions.iter().copied().reduce(DVec3::min) else {
        return Ok(());
    };
    // Below 1/sqrt(3): the cell's diagonal is shorter than the distance.
    let side = distance * 0.577;
    let cell_of = |p: DVec3| ((p - low) / side).floor().to_array().map(|x| x as i64);
    let mut points: Vec<([i64; 3], u32)> = Vec::new();
    in_order(positions.len(), monitor, |i| {
        if sets.root(i as u32) == i as u32 {
            points.push((cell_of(positions[i]), i as u32));
        }
    })?;
    parallel::sort_by_key(&mut points, monitor, |&point| point)?;
    let cells: Vec<&[([i64; 3], u32)]> = points.chunk_by(|a, b| a.0 == b.0).collect();
    for cell in &cells {
        for point in &cell[1..] {
            sets.join(cell[0].1, point.1);
        }
    }
    let near = |a: &[([i64; 3], u32)], b: &[([i64; 3], u32)]| {
        let place = |i: u32| positions[i as usize];
        a.iter().any(|&(_, i)| {
            b.iter()
                .any(|&(_, j)| place(i).distance_squared(place(j)) <= distance * distance)
        })
    };
    for [x, y] in FORWARD {
        // The column of cells to look at moves on with the cell, so one cursor
        // per column passes over all cells once.
        let mut cursor = 0;
        in_order(cells.len(), monitor, |index| {
            let cell = cells[index];
            let at = |z: i64| {
                let [cx, cy, cz] = cell[0].0;
                [
                    cx.saturating_add(x),
                    cy.saturating_add(y),
                    cz.saturating_add(z),
                ]
            };
            let first = at(if (x, y) == (0, 0) { 1 } else { -2 });
            while cells.get(cursor).is_some_and(|other| other[0].0 < first) {
                cursor += 1;
            }
            for other in cells[cursor..]
                .iter()
                .take_while(|other| other[0].0 <= at(2))
            {
                if sets.root(cell[0].1) != sets.root(other[0].1) && near(cell, other) {
                    sets.join(cell[0].1, other[0].1);
                }
            }
        })?;
    }
    Ok(())
}

/// Half of the columns that a cell of side 0.577 can have neighbours in.
const FORWARD: [[i64; 2]; 13] = [
    [0, 0],
    [0, 1],
    [0, 2],
    [1, -2],
    [1, -1],
    [1, 0],
    [1, 1],
    [1, 2],
    [2, -2],
    [2, -1],
    [2, 0],
    [2, 1],
    [2, 2],
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::random::uniform;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn both_ways_make_the_same_sets(
            seed in 0u64..1 << 40,
            spacing in prop::sample::select(vec![0.1, 0.5, 2.0, 30.0]),
            distance in prop::sample::select(vec![1e-5, 1.0, 700.0]),
            far in prop::sample::select(vec![0.0, -1e4, 1e8]),
        ) {
            // Four to a place of a random lattice, all within about a distance of it.
            let count = 400;
            let draw = |k: i64| uniform(seed, k);
            let places: Vec<DVec3> = (0..count).map(|i| {
                let lattice = |k: i64| (draw(3 * (i / 4) + k) * 8.0).floor() * spacing;
                let moved = |k: i64| draw(1000 * (k + 1) + i) - 0.5 + lattice(k);
                DVec3::new(moved(0), moved(1), moved(2)) * distance + far
            }).collect();
            let roots = |mut sets: Sets| (0..count as u32).map(|i| sets.root(i)).collect::<Vec<_>>();
            let mut crowded = Sets::of_roots(coincident::lowest(&places, &Unmonitored).unwrap());
            join_crowded(&places, distance, &mut crowded, &Unmonitored).unwrap();
            // `None` where they are crowded, or too far away for the distance.
            if let Some(sets) = spread_out(&places, distance, &Unmonitored).unwrap() {
                prop_assert_eq!(roots(sets), roots(crowded));
            } else {
                prop_assert!(spacing < 30.0 || far * LEAST > distance);
            }
        }
    }
}
