//! One triangle: the closest place to a point.

use glam::DVec3;

/// Below this ratio of height to length a triangle counts as its three edges.
///
/// The normal of a sliver is off by about machine epsilon over that ratio,
/// while leaving its inside out costs the ratio itself; 1e-8 balances both.
const SLIVER: f64 = 1e-8;

/// The place of a triangle closest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Foot {
    /// Where it is.
    pub(crate) point: DVec3,
    /// Weights of the three corners; exactly 0 for corners that have no part.
    pub(crate) barycentric: DVec3,
}

/// A triangle by its three corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Triangle(pub(crate) [DVec3; 3]);

impl Triangle {
    /// The unit normal and twice the area, or `None` for a sliver.
    pub(crate) fn plane(&self) -> Option<(DVec3, f64)> {
        let [a, b, c] = self.0;
        let (ab, ac, bc) = (b - a, c - a, c - b);
        let cross = ab.cross(ac);
        let longest = ab
            .length_squared()
            .max(ac.length_squared())
            .max(bc.length_squared());
        let area2 = cross.length();
        (area2 > SLIVER * longest).then(|| (cross / area2, area2))
    }

    /// The closest place to `p`: inside, on an edge or at a corner.
    ///
    /// Degenerate triangles are their edges, down to a single point.
    pub(crate) fn closest(&self, p: DVec3) -> Foot {
        let [a, b, c] = self.0;
        let (h, ab, ac) = (p - a, b - a, c - a);
        if let Some((normal, area2)) = self.plane() {
            let (to_b, to_c) = (normal.dot(h.cross(ac)), normal.dot(ab.cross(h)));
            if to_b >= 0.0 && to_c >= 0.0 && to_b + to_c <= area2 {
                let (v, w) = (to_b / area2, to_c / area2);
                return Foot {
                    point: p - normal * normal.dot(h),
                    barycentric: DVec3::new((1.0 - v - w).max(0.0), v, w),
                };
            }
        }
        let edges = [(a, ab, 0, 1), (a, ac, 0, 2), (b, c - b, 1, 2)];
        let mut best = (f64::INFINITY, a, DVec3::X);
        for (start, along, i, j) in edges {
            let t = place_on_edge(p - start, along);
            let point = match t {
                t if t <= 0.0 => self.0[i],
                t if t >= 1.0 => self.0[j],
                t => start + along * t,
            };
            let squared = (p - point).length_squared();
            if squared < best.0 {
                let mut barycentric = DVec3::ZERO;
                barycentric[i] = 1.0 - t;
                barycentric[j] = t;
                best = (squared, point, barycentric);
            }
        }
        Foot {
            point: best.1,
            barycentric: best.2,
        }
    }
}

/// Parameter in 0..=1 of the place on an edge `along` closest to `arm`, both
/// from the edge's start; 0 for an edge without length.
fn place_on_edge(arm: DVec3, along: DVec3) -> f64 {
    let squared = along.length_squared();
    if squared > 0.0 {
        (arm.dot(along) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    }
}
