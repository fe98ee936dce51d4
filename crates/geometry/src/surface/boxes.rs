//! Axis-aligned boxes sorted so that those meeting each other are found fast.

use glam::DVec3;

use super::leaf::{Lanes, WIDTH};
use super::order::{curve_order, index_of};
use crate::vectors::{greater, widened};
use crate::{GeometryError, Monitor, parallel};

/// Many boxes along a space-filling curve, and over them boxes of four, of four
/// times four and so on: a tree whose shape is that of its numbers.
#[derive(Debug)]
pub(crate) struct BoxTree {
    /// The number of each box along the curve.
    order: Vec<u32>,
    /// Boxes by fours: first the given ones, last those below the root.
    levels: Vec<Vec<Four>>,
}

/// Four boxes side by side; places without one have an empty box.
#[derive(Debug, Clone, bytemuck::Zeroable)]
struct Four {
    low: [Lanes; 3],
    high: [Lanes; 3],
}

/// Two fours of a level, or twice the same one: all pairs of boxes between them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pairs {
    level: usize,
    first: usize,
    second: usize,
}

/// Fours that a level needs to be one that work is handed out by.
const SHARED: usize = 128;

/// Pairs that meet after which a walk tells them.
const TOLD: usize = 256;

/// Level from which on a walk asks whether to stop.
const ASKING: usize = 2;

impl BoxTree {
    /// Sorts boxes, given by their lowest and highest corners.
    /// Cost: O(boxes · log boxes).
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`].
    pub(crate) fn new(boxes: &[[DVec3; 2]], monitor: &dyn Monitor) -> Result<Self, GeometryError> {
        let centres = parallel::map(boxes.len(), monitor, |index| {
            (boxes[index][0] + boxes[index][1]) * 0.5
        })?;
        let order = curve_order(&centres, monitor)?;
        let order = parallel::map(order.len(), monitor, |at| index_of(order[at]) as u32)?;
        let mut fours = parallel::map(boxes.len().div_ceil(WIDTH), monitor, |four| {
            let end = (four * WIDTH + WIDTH).min(order.len());
            let of_four = order[four * WIDTH..end].iter();
            Four::new(of_four.map(|&index| boxes[index as usize]))
        })?;
        let mut levels = Vec::new();
        while fours.len() > 1 {
            let above = fours.chunks(WIDTH);
            let above = above.map(|four| Four::new(four.iter().map(Four::bounds)));
            let above = above.collect();
            levels.push(std::mem::replace(&mut fours, above));
        }
        levels.push(fours);
        Ok(Self { order, levels })
    }

    /// All pairs, in parts that can be walked through side by side; the same
    /// parts always.
    pub(crate) fn parts(&self) -> Vec<Pairs> {
        let mut parts = vec![Pairs {
            level: self.levels.len() - 1,
            first: 0,
            second: 0,
        }];
        while let level = parts[0].level
            && level > 0
            && self.levels[level].len() < SHARED
        {
            let mut below = Vec::new();
            for part in parts {
                self.each_below(part, |first, second| {
                    below.push(Pairs {
                        level: level - 1,
                        first,
                        second,
                    });
                });
            }
            parts = below;
        }
        parts
    }

    /// Calls `visit` with some of the pairs [a, b], a < b, of boxes of a part that
    /// meet, borders included, again and again until it had them all; in an order
    /// that depends on the boxes alone.
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`].
    pub(crate) fn walk(
        &self,
        part: Pairs,
        monitor: &dyn Monitor,
        mut visit: impl FnMut(&[[u32; 2]]),
    ) -> Result<(), GeometryError> {
        let mut waiting = vec![part];
        let mut met = Vec::with_capacity(TOLD + WIDTH * WIDTH);
        widened(
            #[inline(always)]
            || {
                while let Some(part) = waiting.pop() {
                    if part.level >= ASKING {
                        monitor.check()?;
                    }
                    self.open(part, &mut waiting, &mut met);
                    if met.len() >= TOLD {
                        visit(&met);
                        met.clear();
                    }
                }
                visit(&met);
                Ok(())
            },
        )
    }

    /// Adds what is one level below a part to what waits, or to the pairs that met.
    #[inline(always)]
    fn open(&self, part: Pairs, waiting: &mut Vec<Pairs>, met: &mut Vec<[u32; 2]>) {
        if part.level > 0 {
            let level = part.level - 1;
            self.each_below(part, |first, second| {
                waiting.push(Pairs {
                    level,
                    first,
                    second,
                });
            });
            return;
        }
        self.each_below(part, |first, second| {
            if first != second {
                let (a, b) = (self.order[first], self.order[second]);
                met.push([a.min(b), a.max(b)]);
            }
        });
    }

    /// Calls `visit` with the places, one level below, of all pairs of boxes that
    /// meet; of one four also with each box and itself.
    #[inline(always)]
    fn each_below(&self, part: Pairs, mut visit: impl FnMut(usize, usize)) {
        let fours = &self.levels[part.level];
        let (first, second) = (&fours[part.first], &fours[part.second]);
        for a in 0..WIDTH {
            let gaps = second.gaps(first.get(a));
            // A byte for each, so that the compiler keeps the four side by side.
            let meet = gaps.map(|gap| u8::from(gap <= 0.0));
            let mut meeting = u32::from_le_bytes(meet);
            if part.first == part.second {
                meeting &= u32::MAX << (8 * a);
            }
            while meeting != 0 {
                let b = meeting.trailing_zeros() as usize / 8;
                visit(WIDTH * part.first + a, WIDTH * part.second + b);
                meeting &= meeting - 1;
            }
        }
    }
}

impl Default for Four {
    fn default() -> Self {
        Self {
            low: [[f64::INFINITY; WIDTH]; 3],
            high: [[f64::NEG_INFINITY; WIDTH]; 3],
        }
    }
}

impl Four {
    /// Up to four boxes.
    fn new(boxes: impl Iterator<Item = [DVec3; 2]>) -> Self {
        let mut four = Self::default();
        for (lane, [low, high]) in boxes.enumerate() {
            for axis in 0..3 {
                four.low[axis][lane] = low[axis];
                four.high[axis][lane] = high[axis];
            }
        }
        four
    }

    /// One of the boxes: its lowest and highest corner.
    #[inline(always)]
    fn get(&self, lane: usize) -> [[f64; 3]; 2] {
        let of = |rows: &[Lanes; 3]| [rows[0][lane], rows[1][lane], rows[2][lane]];
        [of(&self.low), of(&self.high)]
    }

    /// The box round all four.
    fn bounds(&self) -> [DVec3; 2] {
        let low = self
            .low
            .map(|row| row.into_iter().fold(f64::INFINITY, f64::min));
        let high = self
            .high
            .map(|row| row.into_iter().fold(f64::NEG_INFINITY, f64::max));
        [DVec3::from_array(low), DVec3::from_array(high)]
    }

    /// How far each of the four is from a box, along the axis where it is farthest:
    /// at most 0 if they share a point; an empty box is infinitely far.
    #[inline(always)]
    fn gaps(&self, [low, high]: [[f64; 3]; 2]) -> Lanes {
        let mut gaps = [0.0; WIDTH];
        for (lane, gap) in gaps.iter_mut().enumerate() {
            let along = |axis: usize| {
                let above = self.low[axis][lane] - high[axis];
                let below = low[axis] - self.high[axis][lane];
                greater(above, below)
            };
            *gap = greater(along(0), greater(along(1), along(2)));
        }
        gaps
    }
}

/// Whether two boxes share a point, borders included.
pub(crate) fn overlap(a: [DVec3; 2], b: [DVec3; 2]) -> bool {
    a[0].cmple(b[1]).all() && b[0].cmple(a[1]).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::random::uniform;

    #[test]
    fn all_pairs_that_meet_are_visited_once() {
        for (count, size) in [(1, 0.1), (4, 2.0), (5, 0.5), (257, 0.2), (3000, 0.05)] {
            let draw = |i: i64, k: i64| uniform(3, 8 * i + k);
            let boxes: Vec<[DVec3; 2]> = (0..count)
                .map(|i| {
                    let low = DVec3::new(draw(i, 0), draw(i, 1), draw(i, 2));
                    // Some have no thickness, and some share a side with another.
                    let low = if i % 3 == 0 {
                        (low * 8.0).floor() / 8.0
                    } else {
                        low
                    };
                    let wide = DVec3::new(draw(i, 3), draw(i, 4), f64::from(i % 2 == 0));
                    [low, low + wide * size]
                })
                .collect();
            let tree = BoxTree::new(&boxes, &Unmonitored).unwrap();
            let mut found = Vec::new();
            for part in tree.parts() {
                let visit = |met: &[[u32; 2]]| found.extend_from_slice(met);
                tree.walk(part, &Unmonitored, visit).unwrap();
            }
            found.sort_unstable();
            let all = (0..count as u32).flat_map(|a| (a + 1..count as u32).map(move |b| [a, b]));
            let meet = |&[a, b]: &[u32; 2]| overlap(boxes[a as usize], boxes[b as usize]);
            assert_eq!(found, all.filter(meet).collect::<Vec<_>>(), "{count}");
        }
    }
}
