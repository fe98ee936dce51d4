//! Which borders are nearest to each other.

use glam::DVec3;

use super::places;
use crate::topology::BoundaryWalk;
use crate::{GeometryError, Mesh, Monitor, parallel};

/// A border in space.
struct Border {
    places: Vec<DVec3>,
    low: DVec3,
    high: DVec3,
}

impl Border {
    fn new(places: Vec<DVec3>) -> Self {
        let low = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        Self { places, low, high }
    }

    /// Not more than the distance of any two places.
    fn least_distance(&self, other: &Self) -> f64 {
        let gap = (self.low - other.high).max(other.low - self.high);
        gap.max(DVec3::ZERO).length()
    }

    fn middle_distance(&self, other: &Self) -> f64 {
        self.low
            .midpoint(self.high)
            .distance(other.low.midpoint(other.high))
    }

    /// Mean over the vertices of both of the distance to the other.
    fn distance(&self, other: &Self) -> f64 {
        0.5 * (self.mean_distance_to(other) + other.mean_distance_to(self))
    }

    fn mean_distance_to(&self, other: &Self) -> f64 {
        let sum: f64 = self
            .places
            .iter()
            .map(|&place| other.distance_of(place))
            .sum();
        sum / self.places.len() as f64
    }

    fn distance_of(&self, place: DVec3) -> f64 {
        let ends = self.places.iter().zip(self.places.iter().cycle().skip(1));
        let squared = ends.map(|(&a, &b)| {
            let (along, arm) = (b - a, place - a);
            let length = along.length_squared();
            let t = if length > 0.0 {
                (arm.dot(along) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            (arm - along * t).length_squared()
        });
        squared.fold(f64::INFINITY, f64::min).sqrt()
    }
}

/// Pairs of the walks `whole`, nearest first to be joined, none farther apart
/// than `reach`; in the order of their lower numbers. And who is left alone.
///
/// Joining the nearest pair first is the same as joining, round by round, all
/// that are each other's nearest.
pub(super) fn nearest(
    mesh: &Mesh,
    walks: &[BoundaryWalk],
    whole: &[u32],
    reach: f64,
    monitor: &dyn Monitor,
) -> Result<(Vec<[u32; 2]>, Vec<u32>), GeometryError> {
    let border = |&k: &u32| Border::new(places(mesh, &walks[k as usize]));
    let borders: Vec<Border> = whole.iter().map(border).collect();
    let mut free = vec![true; borders.len()];
    let mut best: Vec<Option<usize>> = vec![None; borders.len()];
    let mut pairs = Vec::new();
    loop {
        // Who lost the nearest one looks again.
        parallel::fill(&mut best, monitor, |k, nearest| {
            if free[k] && nearest.is_none_or(|other| !free[other]) {
                *nearest = nearest_to(&borders, &free, k, reach);
            }
        })?;
        let before = pairs.len();
        for a in 0..borders.len() {
            if let Some(b) = best[a]
                && a < b
                && best[b] == Some(a)
                && free[a]
                && free[b]
            {
                (free[a], free[b]) = (false, false);
                pairs.push([whole[a], whole[b]]);
            }
        }
        if pairs.len() == before {
            break;
        }
    }
    pairs.sort_unstable();
    let alone = whole
        .iter()
        .zip(&free)
        .filter(|(_, free)| **free)
        .map(|(&k, _)| k)
        .collect();
    Ok((pairs, alone))
}

/// The free border nearest to `k`, of equally near ones the lowest.
fn nearest_to(borders: &[Border], free: &[bool], k: usize, reach: f64) -> Option<usize> {
    let own = &borders[k];
    let others = || (0..borders.len()).filter(|&other| other != k && free[other]);
    // The same sum for both of a pair, whoever asks.
    let distance = |other: usize| borders[k.min(other)].distance(&borders[k.max(other)]);
    let by_middle = |&a: &usize, &b: &usize| {
        let [a, b] = [a, b].map(|other| own.middle_distance(&borders[other]));
        a.total_cmp(&b)
    };
    // Most likely the one with the nearest middle; it spares most of the others.
    let likely = others().min_by(by_middle)?;
    let mut best = (distance(likely), likely);
    for other in others() {
        if other != likely && own.least_distance(&borders[other]) <= best.0 {
            let found = (distance(other), other);
            if found < best {
                best = found;
            }
        }
    }
    (best.0 <= reach).then_some(best.1)
}
