//! The closest place of a surface to a point.

use glam::DVec3;

use super::Surface;
use super::leaf::Lanes;
use super::node::{LEAF, Node, Waiting};

/// Slack of a box's distance against its triangles', above their rounding.
pub(super) const SLACK: f64 = 1.0 + 1e-12;

/// In place of a leaf to start from: nothing is known yet.
pub(crate) const ANYWHERE: u32 = u32::MAX;

/// What part of the mesh a place lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// Inside a face, diagonals of its triangles included.
    Face,
    /// Inside an edge, by its number in [`crate::Adjacency`].
    Edge(u32),
    /// On a vertex.
    Vertex(u32),
}

/// The place of a surface closest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// Where it is.
    pub point: DVec3,
    /// How far it is, in metres.
    pub distance: f64,
    /// The face it is in; at an edge or vertex that of `triangle`.
    pub face: u32,
    /// Its triangle, by the order of [`crate::Mesh::triangles`].
    pub triangle: u32,
    /// The part of the mesh it lies on.
    pub feature: Feature,
    /// Weights of the triangle's three vertices; exactly 0 for those that have
    /// no part, so an edge has one zero and a vertex two.
    pub barycentric: DVec3,
    /// Where the search ended, from which a search close by starts well.
    pub(crate) leaf: u32,
}

/// The best triangle so far.
pub(super) struct Best {
    pub(super) squared: f64,
    triangle: u32,
    leaf: u32,
}

impl Best {
    /// Nothing was looked at yet.
    pub(super) const NONE: Self = Self {
        squared: f64::MAX,
        triangle: 0,
        leaf: 0,
    };
}

impl Surface {
    /// The place of the surface closest to `point`, finite and below 1e150.
    ///
    /// Exact up to rounding. Of equally close triangles the one with the lowest
    /// number counts. Cost: O(log triangles) near the surface.
    pub fn closest(&self, point: DVec3) -> Closest {
        self.closest_from(point, ANYWHERE)
    }

    /// The closest place to `point` if it is not farther than `reach`.
    pub fn closest_within(&self, point: DVec3, reach: f64) -> Option<Closest> {
        self.closest_among(point, reach, |_| true)
    }

    /// The closest place to `point` on a face that `counts`, if it is not farther
    /// than `reach`.
    pub(crate) fn closest_among(
        &self,
        point: DVec3,
        reach: f64,
        counts: impl Fn(u32) -> bool,
    ) -> Option<Closest> {
        let counts = |triangle: u32| counts(self.faces[triangle as usize]);
        let mut best = Best {
            squared: reach * reach,
            triangle: u32::MAX,
            leaf: 0,
        };
        self.search(&mut Waiting::new(self.root), point, &mut best, counts);
        (best.triangle != u32::MAX).then(|| self.finish(point, &best))
    }

    /// [`Surface::closest`] started from a leaf that may be close: the same
    /// answer, found sooner.
    pub(crate) fn closest_from(&self, point: DVec3, leaf: u32) -> Closest {
        self.closest_with(&mut Waiting::default(), point, leaf)
    }

    /// [`Surface::closest_from`] with memory that many searches share.
    #[inline(always)]
    pub(super) fn closest_with(&self, waiting: &mut Waiting, point: DVec3, leaf: u32) -> Closest {
        let mut best = Best::NONE;
        if (leaf as usize) < self.leaves.len() {
            self.visit(point, leaf, &mut best, |_| true);
            self.climb(waiting, point, leaf, &mut best);
        } else {
            waiting.begin(self.root);
            self.search(waiting, point, &mut best, |_| true);
        }
        self.finish(point, &best)
    }

    /// Walks from a leaf up to the root and at each node into what else may be
    /// closer: mostly nothing, so that the way up is one of known turns, where
    /// the way down from the root would be one of choices.
    #[inline(always)]
    pub(super) fn climb(&self, waiting: &mut Waiting, point: DVec3, leaf: u32, best: &mut Best) {
        let mut seen = LEAF | leaf;
        let mut above = self.leaves[leaf as usize].parent;
        while let Some(node) = self.nodes.get(above as usize) {
            let mut squares = self.squared_distances(node, point);
            for (square, &child) in squares.iter_mut().zip(&node.children) {
                if child == seen {
                    *square = f64::INFINITY;
                }
            }
            waiting.push(&squares, &node.children, best.squared * SLACK);
            self.search(waiting, point, best, |_| true);
            (seen, above) = (above, node.parent);
        }
    }

    /// Squared distance of `point` to the boxes of a node's children.
    #[inline(always)]
    pub(super) fn squared_distances(&self, node: &Node, point: DVec3) -> Lanes {
        match self.turned.get(node.turned as usize) {
            Some(turned) => turned.squared_distances(point),
            None => node.squared_distances(point),
        }
    }

    /// Walks through all that waits, nearest child first.
    #[inline(always)]
    fn search(
        &self,
        waiting: &mut Waiting,
        point: DVec3,
        best: &mut Best,
        counts: impl Fn(u32) -> bool + Copy,
    ) {
        while let Some((squared, reference)) = waiting.pop() {
            let limit = best.squared * SLACK;
            if squared > limit {
                continue;
            }
            if reference & LEAF != 0 {
                self.visit(point, reference & !LEAF, best, counts);
            } else {
                let node = &self.nodes[reference as usize];
                let squares = self.squared_distances(node, point);
                waiting.push(&squares, &node.children, limit);
            }
        }
    }

    #[inline(always)]
    pub(super) fn visit(
        &self,
        point: DVec3,
        leaf: u32,
        best: &mut Best,
        counts: impl Fn(u32) -> bool,
    ) {
        let lanes = &self.leaves[leaf as usize];
        let squares = lanes.squared_distances(point);
        for (&squared, &triangle) in squares.iter().zip(&lanes.triangles) {
            // Total order: distance, then number; the order of visits is no matter.
            let tie = squared <= best.squared && triangle < best.triangle;
            if (squared < best.squared || tie) && counts(triangle) {
                *best = Best {
                    squared,
                    triangle,
                    leaf,
                };
            }
        }
    }

    pub(super) fn finish(&self, point: DVec3, best: &Best) -> Closest {
        let triangle = best.triangle;
        let inside = self.leaves[best.leaf as usize].foot_inside(triangle, point);
        let foot = inside.unwrap_or_else(|| self.triangle(triangle).closest(point));
        Closest {
            point: foot.point,
            distance: best.squared.sqrt(),
            face: self.faces[triangle as usize],
            triangle,
            feature: self.feature(triangle, foot.barycentric),
            barycentric: foot.barycentric,
            leaf: best.leaf,
        }
    }

    /// The part of the mesh a place of a triangle lies on.
    fn feature(&self, triangle: u32, barycentric: DVec3) -> Feature {
        let parts = barycentric.to_array().map(|weight| weight > 0.0);
        match parts {
            [true, false, false] => Feature::Vertex(self.triangle_vertices(triangle)[0]),
            [false, true, false] => Feature::Vertex(self.triangle_vertices(triangle)[1]),
            [false, false, true] => Feature::Vertex(self.triangle_vertices(triangle)[2]),
            [true, true, false] => self.edge_feature(triangle, 0, 1),
            [true, false, true] => self.edge_feature(triangle, 0, 2),
            [false, true, true] => self.edge_feature(triangle, 1, 2),
            _ => Feature::Face,
        }
    }

    fn edge_feature(&self, triangle: u32, i: usize, j: usize) -> Feature {
        self.edge_between(triangle, i, j)
            .map_or(Feature::Face, Feature::Edge)
    }
}
