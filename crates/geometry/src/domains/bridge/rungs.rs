//! Where the edges across a strip go.

use glam::DVec3;

use super::places;
use crate::topology::BoundaryWalk;
use crate::{GeometryError, Mesh, Monitor, parallel};

/// How much shorter a strip that is not turned over must be for the borders to
/// count as running the same way round.
const SHORTER: f64 = 0.999;

/// The edges across a strip: from place i of the first walk to place j of the
/// second one. The walks run in opposite senses, so i grows and j falls.
pub(super) struct Rungs {
    /// All rungs in order; the last one is the first again.
    pub(super) list: Vec<[usize; 2]>,
    /// Whether the borders run the same way round.
    pub(super) turned: bool,
}

impl Rungs {
    /// The rungs with the least sum of lengths, the second walk then turned on by
    /// `twist` edges.
    pub(super) fn new(
        mesh: &Mesh,
        a: &BoundaryWalk,
        b: &BoundaryWalk,
        twist: i64,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        let first = places(mesh, a);
        let same = places(mesh, b);
        let mut against = same.clone();
        against.reverse();
        let ladder = Ladder::new(&first, &against);
        let (start, length) = ladder.best_start(monitor)?;
        let (_, other) = Ladder::new(&first, &same).best_start(monitor)?;
        let count = against.len();
        let shift = twist.rem_euclid(count as i64) as usize;
        let steps = ladder.steps((start + shift) % count);
        // Counted from the end of the second walk, as it was turned round.
        let back = |[i, j]: [usize; 2]| [i % first.len(), count - 1 - j % count];
        Ok(Self {
            list: steps.map(back).collect(),
            turned: other < length * SHORTER && area(&first).dot(area(&same)) > 0.0,
        })
    }
}

/// Room for rounding: where two choices are as good, the first one is taken
/// wherever the mesh lies.
const SLACK: f64 = 1e-9;

/// Two loops walked in the same sense.
struct Ladder<'a> {
    one: &'a [DVec3],
    two: &'a [DVec3],
    /// Share of the length up to each place of `one`, from 0 to 1.
    along_one: Vec<f64>,
    along_two: Vec<f64>,
}

impl<'a> Ladder<'a> {
    fn new(one: &'a [DVec3], two: &'a [DVec3]) -> Self {
        Self {
            one,
            two,
            along_one: shares(one),
            along_two: shares(two),
        }
    }

    /// The place of the second loop to start from, and the rungs' length then.
    fn best_start(&self, monitor: &dyn Monitor) -> Result<(usize, f64), GeometryError> {
        let lengths = parallel::map(self.two.len(), monitor, |start| self.length(start))?;
        let all = lengths.into_iter().enumerate();
        let best = all.fold((0, f64::INFINITY), |best, (start, length)| {
            if length < best.1 * (1.0 - SLACK) {
                (start, length)
            } else {
                best
            }
        });
        Ok(best)
    }

    fn length(&self, start: usize) -> f64 {
        let place = |of: &[DVec3], k: usize| of[k % of.len()];
        let length = |[i, j]: [usize; 2]| place(self.one, i).distance(place(self.two, j));
        self.steps(start).map(length).sum()
    }

    /// The rungs as places of both loops, not reduced: from (0, start) once round.
    fn steps(&self, start: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
        let (n, m) = (self.one.len(), self.two.len());
        let mut next = Some([0, 0]);
        std::iter::from_fn(move || {
            let [i, j] = next?;
            next = match (i < n, j < m) {
                (false, false) => None,
                (true, false) => Some([i + 1, j]),
                (false, true) => Some([i, j + 1]),
                (true, true) => Some(self.step(i, j, start)),
            };
            Some([i, start + j])
        })
    }

    fn step(&self, i: usize, j: usize, start: usize) -> [usize; 2] {
        if self.one.len() == self.two.len() {
            return [i + 1, j + 1];
        }
        let m = self.two.len();
        let along = |j: usize| {
            let (rounds, place) = ((start + j) / m, (start + j) % m);
            rounds as f64 + self.along_two[place] - self.along_two[start]
        };
        let (from_one, to_one) = (self.along_one[i], self.along_one[i + 1]);
        let (from_two, to_two) = (along(j), along(j + 1));
        let near = 0.5 * (to_one - from_one).min(to_two - from_two);
        if (to_one - to_two).abs() <= near * (1.0 + SLACK) {
            [i + 1, j + 1]
        } else if to_one < to_two {
            [i + 1, j]
        } else {
            [i, j + 1]
        }
    }
}

/// Share of a loop's length up to each of its places, and 1 at the end; by
/// number where it has no length.
fn shares(places: &[DVec3]) -> Vec<f64> {
    let count = places.len();
    let mut shares = vec![0.0; count + 1];
    for k in 0..count {
        shares[k + 1] = shares[k] + places[k].distance(places[(k + 1) % count]);
    }
    let total = shares[count];
    for (k, share) in shares.iter_mut().enumerate() {
        *share = if total > 0.0 {
            *share / total
        } else {
            k as f64 / count as f64
        };
    }
    shares
}

fn area(places: &[DVec3]) -> DVec3 {
    crate::normals::newell(places.iter().copied())
}
