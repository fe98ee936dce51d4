//! Distance to a surface whose open borders may be extended (§5 iii).

use glam::DVec3;

use super::node::Waiting;
use super::triangle::Triangle;
use super::{ANYWHERE, Closest, Feature, Surface};
use crate::math::unit_or_zero;

/// How the distance to a surface is measured beyond its open border.
///
/// A thickness is only ever judged by the rule it was solved with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Border {
    /// To the mesh as it is: beyond the border, to the border itself.
    Clip,
    /// To the faces extended straight beyond the border: where the closest
    /// place lies on a border edge, to the half strip that continues its
    /// triangle; where it lies on a border vertex, to the half strips of its
    /// border edges and the sectors between them.
    #[default]
    Extend,
}

/// A convex part of a surface or of its extension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Piece {
    Triangle(Triangle),
    /// `start + x along + y out` for 0 <= x <= 1 and y >= 0; `out` is a unit
    /// vector perpendicular to `along`, or zero.
    Strip {
        start: DVec3,
        along: DVec3,
        out: DVec3,
    },
    /// `tip + x one + y two` for x, y >= 0; both unit vectors.
    Sector {
        tip: DVec3,
        one: DVec3,
        two: DVec3,
    },
}

impl Piece {
    /// The place of this piece closest to `p`.
    pub(crate) fn closest(&self, p: DVec3) -> DVec3 {
        match *self {
            Self::Triangle(triangle) => triangle.closest(p).point,
            Self::Strip { start, along, out } => {
                let h = p - start;
                let squared = along.length_squared();
                let x = if squared > 0.0 {
                    (h.dot(along) / squared).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                start + along * x + out * h.dot(out).max(0.0)
            }
            Self::Sector { tip, one, two } => {
                let h = p - tip;
                let normal = one.cross(two);
                let squared = normal.length_squared();
                let x = h.cross(two).dot(normal);
                let y = one.cross(h).dot(normal);
                if squared > 1e-12 && x >= 0.0 && y >= 0.0 {
                    return p - normal * (h.dot(normal) / squared);
                }
                let on = |ray: DVec3| tip + ray * h.dot(ray).max(0.0);
                let (first, second) = (on(one), on(two));
                if (p - second).length_squared() < (p - first).length_squared() {
                    second
                } else {
                    first
                }
            }
        }
    }

    /// Distance of `p` to this piece.
    pub(crate) fn distance(&self, p: DVec3) -> f64 {
        (p - self.closest(p)).length()
    }
}

/// A distance to the surface under a border rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measured {
    pub(crate) distance: f64,
    /// The convex part it was measured to.
    pub(crate) piece: Piece,
    /// The closest place of the mesh itself.
    pub(crate) closest: Closest,
    /// Whether that lies on the border.
    pub(crate) at_rim: bool,
}

/// For each edge of the mesh the direction that continues its one face; zero
/// for edges that are no border.
#[derive(Debug)]
pub(super) struct Rim {
    out: Vec<DVec3>,
}

impl Rim {
    fn new(surface: &Surface) -> Self {
        let mut out = vec![DVec3::ZERO; surface.topology.adjacency().edge_count()];
        for triangle in 0..surface.triangle_count() as u32 {
            let places = surface.triangle(triangle).0;
            for (i, j, apex) in [(0, 1, 2), (1, 2, 0), (0, 2, 1)] {
                let Some(edge) = surface.edge_between(triangle, i, j) else {
                    continue;
                };
                if surface.is_border(Feature::Edge(edge)) {
                    let along = unit_or_zero(places[j] - places[i]);
                    let inward = places[apex] - places[i];
                    out[edge as usize] = unit_or_zero(along * inward.dot(along) - inward);
                }
            }
        }
        Self { out }
    }
}

impl Surface {
    /// Distance of `point` to the surface under `border`; searched from `leaf`,
    /// or [`ANYWHERE`].
    pub(crate) fn measure(&self, point: DVec3, border: Border, leaf: u32) -> Measured {
        self.measure_with(&mut Waiting::default(), point, border, leaf)
    }

    /// [`Surface::measure`] with memory that many searches share.
    pub(super) fn measure_with(
        &self,
        waiting: &mut Waiting,
        point: DVec3,
        border: Border,
        leaf: u32,
    ) -> Measured {
        let closest = self.closest_with(waiting, point, leaf);
        let at_rim = self.is_border(closest.feature);
        let mut measured = Measured {
            distance: closest.distance,
            piece: Piece::Triangle(self.triangle(closest.triangle)),
            closest,
            at_rim,
        };
        if at_rim && border == Border::Extend {
            self.visit_extension(closest.feature, &mut |piece| {
                let distance = piece.distance(point);
                if distance < measured.distance {
                    (measured.distance, measured.piece) = (distance, piece);
                }
            });
        }
        measured
    }

    /// Distance of `point` to the surface under a border rule, and whether the
    /// closest place of the mesh lies on its border.
    pub fn distance(&self, point: DVec3, border: Border) -> (f64, bool) {
        let measured = self.measure(point, border, ANYWHERE);
        (measured.distance, measured.at_rim)
    }

    /// Calls `visit` with each piece of the extension of a border feature.
    fn visit_extension(&self, feature: Feature, visit: &mut dyn FnMut(Piece)) {
        let rim = self.rim.get_or_init(|| Rim::new(self));
        let adjacency = self.topology.adjacency();
        let place = |vertex: u32| self.positions[vertex as usize];
        let strip = |edge: u32| {
            let [a, b] = adjacency.edge(edge as usize);
            Piece::Strip {
                start: place(a),
                along: place(b) - place(a),
                out: rim.out[edge as usize],
            }
        };
        match feature {
            Feature::Face => {}
            Feature::Edge(edge) => visit(strip(edge)),
            Feature::Vertex(vertex) => {
                let tip = place(vertex);
                let edges = adjacency.vertex_edges(vertex as usize).iter().copied();
                let border = edges.filter(|&edge| adjacency.is_boundary_edge(edge as usize));
                let mut ends = [[DVec3::ZERO; 2]; 2];
                let mut count = 0;
                for edge in border {
                    visit(strip(edge));
                    let far = place(adjacency.other_end(edge as usize, vertex as usize));
                    if let Some(end) = ends.get_mut(count) {
                        *end = [far - tip, rim.out[edge as usize]];
                    }
                    count += 1;
                }
                let [[along_one, one], [along_two, two]] = ends;
                // A gap opens where each edge turns away from the other's
                // strip; else the strips overlap. Where several borders meet
                // in one vertex, which of them belong together is not known.
                if count == 2 && along_two.dot(one) < 0.0 && along_one.dot(two) < 0.0 {
                    visit(Piece::Sector { tip, one, two });
                }
            }
        }
    }
}
