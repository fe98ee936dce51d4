//! Inner nodes: the boxes of up to four children.

use glam::DVec3;

use super::build::{Bounds, MAX_DEPTH};
use super::leaf::{Lanes, WIDTH};
use crate::vectors::{greater, lesser};

/// Set in a reference that means a leaf.
pub(super) const LEAF: u32 = 1 << 31;

/// A reference to nothing; its box is at infinity, so it is never followed.
pub(super) const EMPTY: u32 = u32::MAX;

/// Room for all references that can wait while the deepest tree is walked.
const STACK: usize = (WIDTH - 1) * MAX_DEPTH + WIDTH;

/// Boxes of four children, row by row, and references to them.
#[derive(Debug, Clone)]
pub(super) struct Node {
    low: [Lanes; 3],
    high: [Lanes; 3],
    pub(super) children: [u32; WIDTH],
    /// The number of its turned boxes, or [`UPRIGHT`].
    pub(super) turned: u32,
    /// The node whose child this is, or [`NO_NODE`].
    pub(super) parent: u32,
}

/// References still to be followed, each with a number that says how far it is.
pub(super) struct Waiting {
    stack: [(f64, u32); STACK],
    top: usize,
}

impl Default for Waiting {
    fn default() -> Self {
        Self {
            stack: [(0.0, 0); STACK],
            top: 0,
        }
    }
}

impl Waiting {
    /// Only the root waits.
    pub(super) fn new(root: u32) -> Self {
        let mut waiting = Self::default();
        waiting.begin(root);
        waiting
    }

    /// Only the root waits: for many walks with the same memory.
    #[inline(always)]
    pub(super) fn begin(&mut self, root: u32) {
        self.stack[0] = (0.0, root);
        self.top = 1;
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<(f64, u32)> {
        self.top = self.top.checked_sub(1)?;
        Some(self.stack[self.top])
    }

    /// Adds the children of one node that are not farther than `limit`, the
    /// nearest on top; an infinite number means no child.
    #[inline(always)]
    pub(super) fn push(&mut self, distances: &Lanes, children: &[u32; WIDTH], limit: f64) {
        if distances.iter().all(|&distance| distance > limit) {
            return;
        }
        let bottom = self.top;
        for (&distance, &child) in distances.iter().zip(children) {
            if distance > limit || distance == f64::INFINITY {
                continue;
            }
            let mut at = self.top;
            while at > bottom && self.stack[at - 1].0 < distance {
                self.stack[at] = self.stack[at - 1];
                at -= 1;
            }
            self.stack[at] = (distance, child);
            self.top += 1;
        }
    }
}

/// Squared distance of `p` to each of four boxes, without branches.
#[inline(always)]
pub(super) fn axis_distances(low: &[Lanes; 3], high: &[Lanes; 3], p: [f64; 3]) -> Lanes {
    let mut out = [0.0; WIDTH];
    for (k, out) in out.iter_mut().enumerate() {
        let away = |axis: usize| {
            let beyond = greater(low[axis][k] - p[axis], p[axis] - high[axis][k]);
            greater(beyond, 0.0)
        };
        let (x, y, z) = (away(0), away(1), away(2));
        *out = x * x + y * y + z * z;
    }
    out
}

/// Stands for the node above the root.
pub(super) const NO_NODE: u32 = u32::MAX;

/// Marks a node without [`super::turned::Turned`] boxes.
pub(super) const UPRIGHT: u32 = u32::MAX;

impl Default for Node {
    fn default() -> Self {
        Self {
            low: [[f64::INFINITY; WIDTH]; 3],
            high: [[f64::NEG_INFINITY; WIDTH]; 3],
            children: [EMPTY; WIDTH],
            turned: UPRIGHT,
            parent: NO_NODE,
        }
    }
}

impl Node {
    pub(super) fn set(&mut self, slot: usize, bounds: Bounds, reference: u32) {
        for axis in 0..3 {
            self.low[axis][slot] = bounds.low[axis];
            self.high[axis][slot] = bounds.high[axis];
        }
        self.children[slot] = reference;
    }

    /// Squared distance of `p` to each child's box; infinite for no child.
    #[inline(always)]
    pub(super) fn squared_distances(&self, p: DVec3) -> Lanes {
        axis_distances(&self.low, &self.high, p.to_array())
    }

    /// Where the ray enters each child's box, or infinity where it misses it
    /// or only meets it beyond `end`.
    #[inline]
    pub(super) fn entries(&self, origin: DVec3, inverse: DVec3, end: f64) -> Lanes {
        let mut out = [0.0; WIDTH];
        for (k, out) in out.iter_mut().enumerate() {
            let (mut near, mut far) = (0.0, end);
            for axis in 0..3 {
                let one = (self.low[axis][k] - origin[axis]) * inverse[axis];
                let two = (self.high[axis][k] - origin[axis]) * inverse[axis];
                // A ray within a box's face gives 0 · ∞ = NaN there. Both
                // helpers return their second argument then: no restriction.
                near = greater(lesser_or(one, two, f64::NEG_INFINITY), near);
                far = lesser(greater_or(one, two, f64::INFINITY), far);
            }
            // Ize 2013: the slabs' rounding must not lose boxes of no thickness.
            *out = if near <= far * (1.0 + 1e-14) && self.children[k] != EMPTY {
                near
            } else {
                f64::INFINITY
            };
        }
        out
    }
}

fn lesser_or(a: f64, b: f64, otherwise: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        otherwise
    } else {
        lesser(a, b)
    }
}

fn greater_or(a: f64, b: f64, otherwise: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        otherwise
    } else {
        greater(a, b)
    }
}
