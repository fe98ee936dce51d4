//! Many queries at once, in an order that keeps the tree in the cache.

use glam::DVec3;
use rayon::prelude::*;

use super::node::Waiting;
use super::{ANYWHERE, Border, Closest, Surface};
use crate::parallel::{self, CHUNK};
use crate::vectors::widened;
use crate::{GeometryError, Monitor};

/// Cells along each axis of the curve's grid.
const CELLS: f64 = 1024.0;

impl Surface {
    /// The closest place to each of `points`, in their order, in parallel.
    ///
    /// Walks the points along a space-filling curve and starts each search
    /// where the last one ended, which changes how long it takes but not what
    /// it finds. Cost: O(points · log triangles).
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`].
    pub fn closest_all(
        &self,
        points: &[DVec3],
        monitor: &dyn Monitor,
    ) -> Result<Vec<Closest>, GeometryError> {
        self.along_curve(
            points,
            monitor,
            #[inline(always)]
            |waiting, point, leaf| {
                let closest = self.closest_with(waiting, point, leaf);
                (closest, closest.leaf)
            },
        )
    }

    /// The distance to each of `points` under a border rule, and whether the
    /// closest place of the mesh lies on its border; as [`Surface::closest_all`].
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`].
    pub fn distances(
        &self,
        points: &[DVec3],
        border: Border,
        monitor: &dyn Monitor,
    ) -> Result<Vec<(f64, bool)>, GeometryError> {
        self.along_curve(
            points,
            monitor,
            #[inline(always)]
            |waiting, point, leaf| {
                let measured = self.measure_with(waiting, point, border, leaf);
                ((measured.distance, measured.at_rim), measured.closest.leaf)
            },
        )
    }

    /// `query(point, leaf)` for each point, given the leaf the last one ended in.
    fn along_curve<T: Copy + Send + Sync>(
        &self,
        points: &[DVec3],
        monitor: &dyn Monitor,
        query: impl Fn(&mut Waiting, DVec3, u32) -> (T, u32) + Sync,
    ) -> Result<Vec<T>, GeometryError> {
        let order = curve_order(points, monitor)?;
        let search = |chunk: &[u64]| {
            monitor.check()?;
            let mut leaf = ANYWHERE;
            let mut waiting = Waiting::default();
            Ok(widened(
                #[inline(always)]
                || {
                    let mut found = Vec::with_capacity(chunk.len());
                    for &key in chunk {
                        let (one, end) = query(&mut waiting, points[index_of(key)], leaf);
                        found.push(one);
                        leaf = end;
                    }
                    found
                },
            ))
        };
        let found: Vec<Vec<T>> = order
            .par_chunks(CHUNK)
            .map(search)
            .collect::<Result<_, GeometryError>>()?;
        let mut place = vec![0u32; points.len()];
        for (at, &key) in order.iter().enumerate() {
            place[index_of(key)] = at as u32;
        }
        Ok(place
            .par_iter()
            .map(|&at| found[at as usize / CHUNK][at as usize % CHUNK])
            .collect())
    }
}

/// The points by their place on a Morton curve: its cell in the upper half of
/// each number, the point's index in the lower, so that there are no ties.
pub(super) fn curve_order(
    points: &[DVec3],
    monitor: &dyn Monitor,
) -> Result<Vec<u64>, GeometryError> {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for &point in points {
        low = low.min(point);
        high = high.max(point);
    }
    let size = (high - low).max_element();
    let scale = if size > 0.0 { CELLS / size } else { 0.0 };
    let mut order = parallel::map(points.len(), monitor, |index| {
        let cell = (points[index] - low) * scale;
        let [x, y, z] = cell.to_array().map(|place| spread(place as u64));
        (x | y << 1 | z << 2) << 32 | index as u64
    })?;
    order.par_sort_unstable();
    Ok(order)
}

pub(super) fn index_of(key: u64) -> usize {
    (key & u64::from(u32::MAX)) as usize
}

/// The lower ten bits of `cell`, two zeros put between each.
fn spread(cell: u64) -> u64 {
    let mut bits = cell.min(1023);
    bits = (bits | bits << 16) & 0x0300_00ff;
    bits = (bits | bits << 8) & 0x0300_f00f;
    bits = (bits | bits << 4) & 0x030c_30c3;
    (bits | bits << 2) & 0x0924_9249
}
