//! Points that move a little again and again, and the parts of a surface that can
//! be closest to them.

use glam::DVec3;
use rayon::prelude::*;

use super::closest::{Best, SLACK};
use super::node::{LEAF, Waiting};
use super::{Closest, Surface};
use crate::parallel::{self, CHUNK};
use crate::vectors::widened;
use crate::{GeometryError, Monitor};

/// Leaves kept for a point at most; farther ones only shorten its reach.
const MOST: usize = 24;

/// Rounding of a distance, as a share of the coordinates it is computed from:
/// some twenty operations.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// In place of a leaf: from here on nothing is known.
const END: u32 = u32::MAX;

/// Closest places of points, and what finds them sooner after the points moved.
///
/// For each point p this keeps the leaves of the surface's tree within
/// d + 2 δ of it, nearest first, where d is its distance and δ the way it is
/// thought to move. Moved to q, its distance is at most d + |q − p|, and what is
/// farther from p than r is farther from q than r − |q − p|. So as soon as the
/// next leaf's r exceeds the least distance found by |q − p| no other can be
/// closer: the answer is certain without a look at the tree. Where that does not
/// come to pass, since a point went too far, the tree is searched as ever.
///
/// Takes some 40 bytes a point and 8 for each of its leaves, at most 24.
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored, glam::DVec3, surface::Surface};
/// let square = Mesh::from_faces(
///     vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
///     &[[0, 1, 2, 3]],
/// )?;
/// let surface = Surface::new(&square, &Unmonitored)?;
/// let followed = surface.follow(&[DVec3::new(0.5, 0.5, 1.0)], 0.25, &Unmonitored)?;
/// assert_eq!(followed.places()[0].distance, 1.0);
/// let moved = DVec3::new(0.5, 0.25, 1.25);
/// let found = followed.closest(&[moved], &Unmonitored)?;
/// assert_eq!(found[0], surface.closest(moved));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
#[derive(Debug)]
pub struct Followed<'a> {
    surface: &'a Surface,
    points: Vec<DVec3>,
    places: Vec<Closest>,
    chunks: Vec<Candidates>,
}

/// The leaves near a chunk of points.
#[derive(Debug)]
struct Candidates {
    /// Where the list of each point begins.
    starts: Vec<u32>,
    /// The lists, each with [`END`] as its last leaf.
    leaves: Vec<Candidate>,
}

/// A leaf, and what its triangles are at least away from the point.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    distance: f32,
    leaf: u32,
}

impl Candidate {
    fn new(distance: f64, leaf: u32) -> Self {
        Self {
            distance: (distance as f32).next_down(),
            leaf,
        }
    }
}

impl Surface {
    /// The closest place to each of `points`, and what finds them sooner when each
    /// has moved by `reach` metres or less; see [`Followed`].
    ///
    /// A point may go farther, it only takes longer then. Cost: twice to three
    /// times that of [`Surface::closest_all`], more the larger `reach` is.
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`].
    pub fn follow(
        &self,
        points: &[DVec3],
        reach: f64,
        monitor: &dyn Monitor,
    ) -> Result<Followed<'_>, GeometryError> {
        let places = self.closest_all(points, monitor)?;
        let gather = |(points, places): (&[DVec3], &[Closest])| {
            monitor.check()?;
            let mut waiting = Waiting::default();
            Ok(widened(
                #[inline(always)]
                || self.candidates(&mut waiting, points, places, reach),
            ))
        };
        let chunks = points.par_chunks(CHUNK).zip(places.par_chunks(CHUNK));
        let chunks = chunks.map(gather).collect::<Result<_, GeometryError>>()?;
        Ok(Followed {
            surface: self,
            points: points.to_vec(),
            places,
            chunks,
        })
    }

    /// What can be closest to each of `points` while they move by `reach`.
    #[inline(always)]
    fn candidates(
        &self,
        waiting: &mut Waiting,
        points: &[DVec3],
        places: &[Closest],
        reach: f64,
    ) -> Candidates {
        let mut near: Vec<(f64, u32)> = Vec::new();
        let mut chunk = Candidates {
            starts: Vec::with_capacity(points.len()),
            leaves: Vec::new(),
        };
        for (&point, place) in points.iter().zip(places) {
            let mut radius = place.distance + 2.0 * reach + self.rounding(point);
            near.clear();
            self.gather(waiting, point, radius, &mut near);
            near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            if let Some(&(dropped, _)) = near.get(MOST) {
                radius = dropped;
                near.truncate(MOST);
            }
            chunk.starts.push(chunk.leaves.len() as u32);
            let near = near
                .iter()
                .map(|&(distance, leaf)| Candidate::new(distance, leaf));
            chunk.leaves.extend(near);
            chunk.leaves.push(Candidate::new(radius, END));
        }
        chunk
    }

    /// The leaves with a triangle within `radius` of `point`, and how far the
    /// nearest of theirs is.
    #[inline(always)]
    fn gather(&self, waiting: &mut Waiting, point: DVec3, radius: f64, near: &mut Vec<(f64, u32)>) {
        let limit = radius * radius * SLACK;
        waiting.begin(self.root);
        while let Some((_, reference)) = waiting.pop() {
            if reference & LEAF == 0 {
                let node = &self.nodes[reference as usize];
                let squares = self.squared_distances(node, point);
                waiting.push(&squares, &node.children, limit);
                continue;
            }
            let leaf = reference & !LEAF;
            let squares = self.leaves[leaf as usize].squared_distances(point);
            let least = squares.into_iter().fold(f64::INFINITY, f64::min);
            if least <= limit {
                near.push((least.sqrt(), leaf));
            }
        }
    }

    /// The most a distance of `point` may be off by rounding, in metres.
    #[inline(always)]
    fn rounding(&self, point: DVec3) -> f64 {
        ROUNDING * (self.largest + point.abs().max_element())
    }
}

impl Followed<'_> {
    /// The closest place to each point where it was at first.
    pub fn places(&self) -> &[Closest] {
        &self.places
    }

    /// The closest place to each point where it is now, one in `points` for each
    /// followed one: the same as by [`Surface::closest_all`].
    ///
    /// Cost: a look at two to four leaves for each point within its reach.
    ///
    /// # Panics
    /// If there are not as many points as are followed.
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`].
    pub fn closest(
        &self,
        points: &[DVec3],
        monitor: &dyn Monitor,
    ) -> Result<Vec<Closest>, GeometryError> {
        assert_eq!(
            points.len(),
            self.points.len(),
            "one point for each followed"
        );
        let mut found = self.places.clone();
        parallel::fill_chunks(&mut found, monitor, |first, found| {
            let mut waiting = Waiting::default();
            let points = &points[first..first + found.len()];
            widened(
                #[inline(always)]
                || {
                    for (k, (&point, found)) in points.iter().zip(found).enumerate() {
                        *found = self.closest_to(&mut waiting, first + k, point);
                    }
                },
            );
        })?;
        Ok(found)
    }

    /// The closest place to followed point `index`, now at `point`.
    #[inline(always)]
    fn closest_to(&self, waiting: &mut Waiting, index: usize, point: DVec3) -> Closest {
        let surface = self.surface;
        let chunk = &self.chunks[index / CHUNK];
        let candidates = &chunk.leaves[chunk.starts[index % CHUNK] as usize..];
        let moved = (point - self.points[index]).length();
        let margin = moved + surface.rounding(point);
        let mut best = Best::NONE;
        let mut within = f64::INFINITY;
        for candidate in candidates {
            if f64::from(candidate.distance) > within {
                break;
            }
            if candidate.leaf == END {
                surface.climb(waiting, point, candidates[0].leaf, &mut best);
                break;
            }
            surface.visit(point, candidate.leaf, &mut best, |_| true);
            within = best.squared.sqrt() * SLACK + margin;
        }
        surface.finish(point, &best)
    }
}
