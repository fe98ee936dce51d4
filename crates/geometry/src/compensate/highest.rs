//! The place of a path that is farthest from the surface.

use super::solver::Path;
use crate::surface::{ANYWHERE, Piece, Surface};

/// Evaluations at most; walls, folds and tubes need under ten.
const EVALUATIONS: u32 = 64;

/// A place of the path and the piece of the surface it is closest to.
#[derive(Clone, Copy)]
struct Sample {
    length: f64,
    distance: f64,
    piece: Piece,
    leaf: u32,
}

/// A stretch of the path and the most the distance can be within it.
struct Stretch {
    ends: [Sample; 2],
    /// Where that most would be.
    peak: f64,
    most: f64,
}

impl Stretch {
    /// Bounds the distance between two samples. To each one's closest piece it
    /// is convex, so it stays below that piece's chord; the least of the two
    /// chords is highest at an end or where they cross.
    fn new(path: &Path, a: Sample, b: Sample) -> Self {
        let a_at_b = a.piece.distance(path.at(b.length)).max(b.distance);
        let b_at_a = b.piece.distance(path.at(a.length)).max(a.distance);
        let (over_a, over_b) = (b_at_a - a.distance, a_at_b - b.distance);
        let share = if over_a + over_b > 0.0 {
            over_a / (over_a + over_b)
        } else {
            0.5
        };
        let crossing = a.distance + share * (a_at_b - a.distance);
        Self {
            ends: [a, b],
            peak: a.length + share * (b.length - a.length),
            most: crossing.max(a.distance).max(b.distance),
        }
    }
}

/// The length up to `end` at which `path` is farthest from `surface`, up to
/// `slack` in distance; that distance; and how many were evaluated.
///
/// Always opens the stretch that may hold the most, so what is left over when
/// the evaluations run out is known to be little.
pub(super) fn highest(surface: &Surface, path: &Path, end: f64, slack: f64) -> (f64, f64, u32) {
    let sample = |length: f64, leaf: u32| {
        let closest = surface.closest_from(path.at(length), leaf);
        Sample {
            length,
            distance: closest.distance,
            piece: Piece::Triangle(surface.triangle(closest.triangle)),
            leaf: closest.leaf,
        }
    };
    let first = sample(0.0, ANYWHERE);
    let last = sample(end, first.leaf);
    let mut best = if last.distance > first.distance {
        last
    } else {
        first
    };
    let mut open = vec![Stretch::new(path, first, last)];
    let mut evaluations = 2;
    while evaluations < EVALUATIONS {
        let by_most = |&i: &usize, &j: &usize| open[i].most.total_cmp(&open[j].most);
        let Some(widest) = (0..open.len()).max_by(by_most) else {
            break;
        };
        let Stretch {
            ends: [a, b],
            peak,
            most,
        } = open.swap_remove(widest);
        if most <= best.distance + slack {
            break;
        }
        // A peak at an end says nothing new; halving does.
        let margin = 1e-3 * (b.length - a.length);
        let length = if peak - a.length > margin && b.length - peak > margin {
            peak
        } else {
            0.5 * (a.length + b.length)
        };
        let middle = sample(length, a.leaf);
        evaluations += 1;
        if middle.distance > best.distance {
            best = middle;
        }
        open.push(Stretch::new(path, a, middle));
        open.push(Stretch::new(path, middle, b));
    }
    (best.length, best.distance, evaluations)
}
