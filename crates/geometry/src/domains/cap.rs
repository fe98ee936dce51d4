//! Holes closed by new faces.

use super::fan::{edge_weights, weighted_mean};
use super::pieces::{Corner, NEW_EDGE, Pieces};
use crate::topology::{BoundaryWalk, boundary_walks, next_in_face};
use crate::{GeometryError, Mesh};

/// What closes a hole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cap {
    /// One polygon.
    #[default]
    Polygon,
    /// Triangles round the hole's length-weighted centre.
    Fan,
}

/// A mesh whose holes were closed.
#[derive(Debug, Clone)]
pub struct Capped {
    /// The mesh; caps follow the old faces, by the lowest corner at each hole.
    pub mesh: Mesh,
    /// Holes closed.
    pub caps: usize,
    /// Holes left open because they have more edges than asked for.
    pub larger: usize,
    /// Borders left open because they do not return to where they start, or
    /// have fewer than three edges.
    pub broken: usize,
}

/// Closes open borders of at most `most_edges` edges (any without it).
///
/// A cap runs against the border, so that it continues the surface's orientation.
/// It takes material, group and face values from the face at the border's first
/// edge, corner values from the faces it touches, and the creases of the border
/// edges. Note that the outer border of an open surface is a hole too: limit the
/// edges to leave it. Cost: O(corners).
///
/// # Errors
/// As [`Mesh::new`].
pub fn cap_holes(
    mesh: &Mesh,
    cap: Cap,
    most_edges: Option<usize>,
) -> Result<Capped, GeometryError> {
    let mut pieces = Pieces::new(mesh, 2 * mesh.corner_count());
    (0..mesh.face_count()).for_each(|face| pieces.keep(face));
    let (mut caps, mut larger, mut broken) = (0, 0, 0);
    for walk in boundary_walks(mesh.topology()) {
        if !walk.closed || walk.corners.len() < 3 {
            broken += 1;
        } else if most_edges.is_some_and(|most| walk.corners.len() > most) {
            larger += 1;
        } else {
            caps += 1;
            close(mesh, &mut pieces, &walk, cap);
        }
    }
    let mesh = pieces.finish(false)?;
    Ok(Capped {
        mesh,
        caps,
        larger,
        broken,
    })
}

fn close(mesh: &Mesh, pieces: &mut Pieces<'_>, walk: &BoundaryWalk, cap: Cap) {
    let topology = mesh.topology();
    let face = topology.adjacency().corner_faces()[walk.corners[0] as usize] as usize;
    // Walked backwards: the corner at the far end of each edge, left by that edge.
    let around: Vec<Corner> = walk
        .corners
        .iter()
        .rev()
        .map(|&corner| Corner {
            edge: corner,
            ..pieces.old(next_in_face(topology, corner) as usize, false)
        })
        .collect();
    if cap == Cap::Polygon {
        pieces.face(face, around);
        return;
    }
    let count = around.len();
    let mut weights = Vec::new();
    let place = |k: usize| mesh.positions()[around[k].vertex as usize];
    edge_weights(count, place, &mut weights);
    let shares = || around.iter().zip(weights.iter().copied());
    let vertex = pieces.vertex(
        weighted_mean(count, place, &weights),
        shares().map(|(corner, weight)| (corner.vertex, weight)),
    );
    let centre = Corner {
        vertex,
        values: pieces.blend(shares().map(|(corner, weight)| (corner.values, weight))),
        edge: NEW_EDGE,
    };
    for k in 0..count {
        let next = Corner {
            edge: NEW_EDGE,
            ..around[(k + 1) % count]
        };
        pieces.face(face, [around[k], next, centre]);
    }
}
