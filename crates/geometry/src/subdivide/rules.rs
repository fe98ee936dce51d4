//! Which mask moves a vertex (DeRose, Kass and Truong 1998).

use super::sharpness::decayed;
use super::value::{Value, blend};

/// How a vertex moves, by the sharpness around it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Rule {
    /// No or one sharp edge: the smooth mask.
    Smooth,
    /// Two sharp edges, by number: the vertex moves on the curve they make.
    Crease([u32; 2]),
    /// A sharp vertex, or three and more sharp edges: it stays.
    Corner,
}

impl Rule {
    /// The rule of a vertex of sharpness `vertex` whose edges are given as
    /// (number, sharpness).
    pub(super) fn of(vertex: f64, edges: impl Iterator<Item = (u32, f64)>) -> Self {
        if vertex > 0.0 {
            return Self::Corner;
        }
        let mut ends = [0; 2];
        let mut sharp = 0;
        for (edge, _) in edges.filter(|&(_, sharpness)| sharpness > 0.0) {
            match ends.get_mut(sharp) {
                Some(end) => *end = edge,
                None => return Self::Corner,
            }
            sharp += 1;
        }
        if sharp == 2 {
            Self::Crease(ends)
        } else {
            Self::Smooth
        }
    }
}

/// The rule before a refinement and the one after it, and how much of the first.
pub(super) struct Transition {
    parent: Rule,
    child: Rule,
    parent_weight: f64,
}

impl Transition {
    /// The transition of a vertex through one refinement. Where sharpness runs
    /// out during it, the two masks are mixed by the mean of what was left.
    pub(super) fn of(vertex: f64, edges: impl Iterator<Item = (u32, f64)> + Clone) -> Self {
        let parent = Rule::of(vertex, edges.clone());
        let after = edges
            .clone()
            .map(|(edge, sharpness)| (edge, decayed(sharpness, 1)));
        let child = Rule::of(decayed(vertex, 1), after);
        let ending = edges
            .map(|(_, sharpness)| sharpness)
            .chain([vertex])
            .filter(|&sharpness| sharpness > 0.0 && sharpness <= 1.0);
        let (count, sum) = ending.fold((0u32, 0.0), |(count, sum), sharpness| {
            (count + 1, sum + sharpness)
        });
        let parent_weight = if parent == child {
            1.0
        } else {
            sum / f64::from(count.max(1))
        };
        Self {
            parent,
            child,
            parent_weight,
        }
    }

    /// The value by both rules, mixed.
    pub(super) fn apply<T: Value>(&self, by_rule: impl Fn(Rule) -> T) -> T {
        if self.parent_weight >= 1.0 {
            return by_rule(self.parent);
        }
        blend(
            by_rule(self.child),
            by_rule(self.parent),
            self.parent_weight,
        )
    }
}

/// The crease mask: (1 6 1) / 8.
pub(super) fn crease_mask<T: Value>(vertex: T, ends: [T; 2]) -> T {
    super::value::moved(ends[0], vertex, ends[1])
}
