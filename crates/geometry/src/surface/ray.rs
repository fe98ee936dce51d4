//! Where a ray first meets a surface.

use glam::DVec3;

use super::Surface;
use super::leaf::Leaf;
use super::node::{LEAF, Waiting};

/// Widening of triangles, as a share of their size, so that no ray slips
/// through between two neighbours.
const OVERLAP: f64 = 1e-9;

/// From which side a ray must come for a hit to count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Facing {
    /// From either side.
    #[default]
    Any,
    /// From in front: against the face's normal.
    Front,
    /// From behind: along the face's normal.
    Back,
}

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Multiple of the ray's direction from its origin.
    pub at: f64,
    /// The face that is hit.
    pub face: u32,
    /// Its triangle, by the order of [`crate::Mesh::triangles`].
    pub triangle: u32,
}

impl Surface {
    /// The first place where `origin + at * direction`, `from <= at <= to`,
    /// crosses the surface in the sense of `facing`.
    ///
    /// Rays within a triangle's plane do not cross it. Of equal places the
    /// triangle with the lowest number counts. Cost: O(log triangles) for rays
    /// that are not much longer than the surface's parts are apart.
    ///
    /// ```
    /// use tessgraph_geometry::{Mesh, Unmonitored, glam::DVec3};
    /// use tessgraph_geometry::surface::{Facing, Surface};
    /// let triangle = Mesh::from_faces(
    ///     vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]], &[[0, 1, 2]])?;
    /// let surface = Surface::new(&triangle, &Unmonitored)?;
    /// let up = |facing| surface.first_hit(DVec3::new(0.2, 0.2, 0.0), DVec3::Z, 0.0, 9.0, facing);
    /// assert_eq!(up(Facing::Back).map(|hit| hit.at), Some(1.0));
    /// assert_eq!(up(Facing::Front), None);
    /// # Ok::<(), tessgraph_geometry::GeometryError>(())
    /// ```
    pub fn first_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        from: f64,
        to: f64,
        facing: Facing,
    ) -> Option<Hit> {
        let inverse = direction.recip();
        let mut best = (to, u32::MAX);
        let mut waiting = Waiting::new(self.root);
        while let Some((entry, reference)) = waiting.pop() {
            if entry > best.0 {
                continue;
            }
            if reference & LEAF != 0 {
                let leaf = &self.leaves[(reference & !LEAF) as usize];
                cross(leaf, origin, direction, from, facing, &mut best);
            } else {
                let node = &self.nodes[reference as usize];
                let entries = node.entries(origin, inverse, best.0);
                waiting.push(&entries, &node.children, best.0);
            }
        }
        let (at, triangle) = best;
        (triangle != u32::MAX).then(|| Hit {
            at,
            face: self.faces[triangle as usize],
            triangle,
        })
    }
}

/// Improves `best`, the parameter and number of a triangle, by those of a leaf.
fn cross(
    leaf: &Leaf,
    origin: DVec3,
    direction: DVec3,
    from: f64,
    facing: Facing,
    best: &mut (f64, u32),
) {
    for (k, &triangle) in leaf.triangles.iter().enumerate() {
        let [a, ab, ac, normal] = leaf.lane(k);
        let slope = direction.dot(normal);
        let counts = match facing {
            Facing::Any => slope != 0.0,
            Facing::Front => slope < 0.0,
            Facing::Back => slope > 0.0,
        };
        if !counts {
            continue;
        }
        let at = (a - origin).dot(normal) / slope;
        let sooner = at < best.0 || (at <= best.0 && triangle < best.1);
        if !(at >= from && sooner) {
            continue;
        }
        let h = origin + direction * at - a;
        let area2 = ab.cross(ac).dot(normal);
        let (to_b, to_c) = (normal.dot(h.cross(ac)), normal.dot(ab.cross(h)));
        let slack = OVERLAP * area2;
        if to_b >= -slack && to_c >= -slack && to_b + to_c <= area2 + slack {
            *best = (at, triangle);
        }
    }
}
