//! The faces between two borders.

use glam::DVec3;

use super::BridgeOptions;
use super::rungs::Rungs;
use crate::Mesh;
use crate::domains::pieces::{Corner, NEW_EDGE, Pieces};
use crate::math::unit_or_zero;
use crate::normals::newell;
use crate::topology::{BoundaryWalk, next_in_face};

/// One strip to be built.
pub(super) struct Strip<'a> {
    mesh: &'a Mesh,
    walks: [&'a BoundaryWalk; 2],
    /// For each place of each walk the direction that continues the surface.
    outs: [Vec<DVec3>; 2],
    cuts: u32,
    smoothness: f64,
}

/// A rung: the vertices across the strip, from the first border to the second.
struct Rung {
    at: [usize; 2],
    vertices: Vec<u32>,
    /// What corners at the vertices between carry.
    values: Vec<u32>,
}

impl<'a> Strip<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        a: &'a BoundaryWalk,
        b: &'a BoundaryWalk,
        options: &BridgeOptions<'_>,
    ) -> Self {
        let smooth = options.smoothness > 0.0 && options.cuts > 0;
        let outs = [a, b].map(|walk| if smooth { outs(mesh, walk) } else { Vec::new() });
        Self {
            mesh,
            walks: [a, b],
            outs,
            cuts: options.cuts,
            smoothness: if smooth { options.smoothness } else { 0.0 },
        }
    }

    /// Adds all faces, rung by rung.
    pub(super) fn add(&self, rungs: &Rungs, pieces: &mut Pieces<'_>) {
        let count = rungs.list.len() - 1;
        let made: Vec<Rung> = rungs.list[..count]
            .iter()
            .map(|&at| self.rung(at, pieces))
            .collect();
        for k in 0..count {
            self.rows(&made[k], &made[(k + 1) % count], pieces);
        }
    }

    fn rung(&self, at: [usize; 2], pieces: &mut Pieces<'_>) -> Rung {
        let corners = [0, 1].map(|side| self.walks[side].corners[at[side]]);
        let [a, b] = corners.map(|corner| self.mesh.topology().corners()[corner as usize]);
        let (mut vertices, mut values) = (vec![a], vec![corners[0]]);
        for cut in 1..=self.cuts {
            // Where the borders touch there is nothing to cut.
            let s = f64::from(cut) / f64::from(self.cuts + 1);
            let shares = [1.0 - s, s];
            if a == b {
                vertices.push(a);
            } else {
                let of = [a, b].into_iter().zip(shares);
                vertices.push(pieces.vertex(self.between(at, [a, b], s), of));
            }
            values.push(pieces.blend(corners.into_iter().zip(shares)));
        }
        vertices.push(b);
        values.push(corners[1]);
        Rung {
            at,
            vertices,
            values,
        }
    }

    /// A place on the curve across.
    fn between(&self, at: [usize; 2], ends: [u32; 2], s: f64) -> DVec3 {
        let [a, b] = ends.map(|vertex| self.mesh.positions()[vertex as usize]);
        let across = b - a;
        let straight = a + across * s;
        if self.smoothness == 0.0 {
            return straight;
        }
        let length = across.length();
        let leave = self.outs[0][at[0]] * length - across;
        let arrive = self.outs[1][at[1]] * -length - across;
        let (h1, h2) = (s * (s * (s - 2.0) + 1.0), s * s * (s - 1.0));
        straight + (leave * h1 + arrive * h2) * self.smoothness
    }

    /// The faces between two rungs that follow each other.
    fn rows(&self, here: &Rung, next: &Rung, pieces: &mut Pieces<'_>) {
        let rows = here.vertices.len() - 1;
        let moves = [0, 1].map(|side| here.at[side] != next.at[side]);
        // The edge that is walked: from here on the first border, to here on the second.
        let edges = [
            self.walks[0].corners[here.at[0]],
            self.walks[1].corners[next.at[1]],
        ];
        let source = edges[usize::from(!moves[0])] as usize;
        let source = self.mesh.topology().adjacency().corner_faces()[source] as usize;
        for row in 0..rows {
            let corner = |rung: &Rung, row: usize| Corner {
                vertex: rung.vertices[row],
                values: rung.values[row],
                edge: NEW_EDGE,
            };
            let mut face = [
                corner(next, row),
                corner(here, row),
                corner(here, row + 1),
                corner(next, row + 1),
            ];
            if row == 0 {
                face[0].edge = edges[0];
                face[0].values = next_in_face(self.mesh.topology(), edges[0]);
                face[1].values = edges[0];
            }
            if row + 1 == rows {
                face[2].edge = edges[1];
                face[2].values = next_in_face(self.mesh.topology(), edges[1]);
                face[3].values = edges[1];
            }
            add_without_repeats(source, &face, pieces);
        }
    }
}

/// The face without corners that repeat the one before; none if fewer than
/// three are left.
fn add_without_repeats(source: usize, face: &[Corner; 4], pieces: &mut Pieces<'_>) {
    let kept: Vec<Corner> = (0..4)
        .filter(|&k| face[k].vertex != face[(k + 1) % 4].vertex)
        .map(|k| face[k])
        .collect();
    if kept.len() >= 3 {
        pieces.face(source, kept);
    }
}

/// For each place of a walk the unit vector in the mean direction that continues
/// the faces beyond the two border edges there.
fn outs(mesh: &Mesh, walk: &BoundaryWalk) -> Vec<DVec3> {
    let topology = mesh.topology();
    let place = |corner: u32| mesh.positions()[topology.corners()[corner as usize] as usize];
    let of_edge: Vec<DVec3> = walk
        .corners
        .iter()
        .map(|&corner| {
            let face = topology.adjacency().corner_faces()[corner as usize] as usize;
            let normal = newell(topology.corner_range(face).map(|c| place(c as u32)));
            let along = place(next_in_face(topology, corner)) - place(corner);
            // The face lies to the left of its edge.
            unit_or_zero(unit_or_zero(along).cross(unit_or_zero(normal)))
        })
        .collect();
    let count = of_edge.len();
    (0..count)
        .map(|k| unit_or_zero(of_edge[k] + of_edge[(k + count - 1) % count]))
        .collect()
}
