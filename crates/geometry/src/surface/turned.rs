//! Boxes that lean with the surface.

use glam::DVec3;

use super::build::Bounds;
use super::leaf::{Lanes, WIDTH};
use super::node::axis_distances;
use super::triangle::Triangle;
use crate::math::unit_or_zero;

/// Below this share of its triangles' area that their mean normal keeps, a part
/// of the surface has no side of its own.
const FLAT: f64 = 0.5;

/// Normals with a component above this are those of upright boxes.
const UPRIGHT: f64 = 0.999;

/// Widening of boxes, as a share of the part they lie in: above the rounding of
/// turning a place of it.
const PAD: f64 = 1e-14;

/// The boxes of up to four children, in axes along and across the surface.
///
/// Upright boxes of a leaning surface are as thick as they are wide, and a point
/// above it meets very many of them; these are as thin as the surface is
/// curved, so nearly all leaves but the closest one's are passed over.
#[derive(Debug, Clone)]
pub(super) struct Turned {
    origin: DVec3,
    axes: [DVec3; 3],
    low: [Lanes; 3],
    high: [Lanes; 3],
}

impl Turned {
    /// Boxes of the triangles of each child, in axes that suit all of them;
    /// `None` where upright boxes are as good.
    pub(super) fn new(children: &[Vec<Triangle>]) -> Option<Self> {
        let (mut normal, mut area) = (DVec3::ZERO, 0.0);
        let mut bounds = Bounds::NONE;
        for &Triangle([a, b, c]) in children.iter().flatten() {
            let cross = (b - a).cross(c - a);
            normal += cross;
            area += cross.length();
            bounds = bounds.with(a).with(b).with(c);
        }
        if normal.length() < FLAT * area {
            return None;
        }
        let normal = unit_or_zero(normal);
        if normal == DVec3::ZERO || normal.abs().max_element() > UPRIGHT {
            return None;
        }
        // The coordinate axis farthest from the normal is turned least.
        let axis = DVec3::AXES[normal.abs().min_position()];
        let along = unit_or_zero(axis - normal * normal.dot(axis));
        let mut turned = Self {
            origin: (bounds.low + bounds.high) * 0.5,
            axes: [along, normal.cross(along), normal],
            low: [[f64::INFINITY; WIDTH]; 3],
            high: [[f64::NEG_INFINITY; WIDTH]; 3],
        };
        let pad = (bounds.high - bounds.low).max_element() * PAD;
        for (slot, triangles) in children.iter().enumerate() {
            turned.set(slot, triangles, pad);
        }
        Some(turned)
    }

    fn set(&mut self, slot: usize, triangles: &[Triangle], pad: f64) {
        let places = triangles.iter().flat_map(|triangle| triangle.0);
        let bounds = places.fold(Bounds::NONE, |bounds, place| {
            bounds.with(DVec3::from_array(self.turn(place)))
        });
        for axis in 0..3 {
            self.low[axis][slot] = bounds.low[axis] - pad;
            self.high[axis][slot] = bounds.high[axis] + pad;
        }
    }

    #[inline(always)]
    fn turn(&self, place: DVec3) -> [f64; 3] {
        let arm = place - self.origin;
        self.axes.map(|axis| axis.dot(arm))
    }

    /// Squared distance of `p` to each child's box; infinite for no child.
    #[inline(always)]
    pub(super) fn squared_distances(&self, p: DVec3) -> Lanes {
        axis_distances(&self.low, &self.high, self.turn(p))
    }
}
