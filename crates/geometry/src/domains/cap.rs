//! Holes closed by new faces.

use super::closing::{chosen_walks, with_crease, with_material};
use super::fan::{edge_weights, weighted_mean};
use super::pieces::{Corner, NEW_EDGE, Pieces};
use crate::topology::{BoundaryWalk, boundary_walks, next_in_face};
use crate::{Amount, GeometryError, Mesh};

/// What closes a hole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cap {
    /// One polygon.
    #[default]
    Polygon,
    /// Triangles round the hole's length-weighted centre.
    Fan,
}

/// Settings of [`cap_holes`].
#[derive(Debug, Clone)]
pub struct CapOptions<'a> {
    /// What closes a hole.
    pub cap: Cap,
    /// Holes with more edges stay open; `None` for no limit.
    pub most_edges: Option<usize>,
    /// Which holes are closed: those where this is 0.5 or more all along; a
    /// number, or one per vertex or face.
    pub only: Amount,
    /// Sharpness of the edges round caps, if they have not a higher one.
    pub crease: f64,
    /// Material of the caps; `None` for that of the face at the first edge.
    pub material: Option<&'a str>,
}

impl Default for CapOptions<'_> {
    fn default() -> Self {
        Self {
            cap: Cap::Polygon,
            most_edges: None,
            only: Amount::Constant(1.0),
            crease: 0.0,
            material: None,
        }
    }
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

/// Closes open borders.
///
/// A cap runs against the border, so that it continues the surface's orientation.
/// It takes material, group and face values from the face at the border's first
/// edge, corner values from the faces it touches, and the creases of the border
/// edges. Note that the outer border of an open surface is a hole too: limit the
/// edges to leave it. Cost: O(corners).
///
/// # Errors
/// As [`Mesh::new`]; [`GeometryError::OutOfRange`] for a crease that is negative
/// or not finite; [`GeometryError::FieldLength`].
pub fn cap_holes(mesh: &Mesh, options: &CapOptions<'_>) -> Result<Capped, GeometryError> {
    let mut pieces = Pieces::new(mesh, 2 * mesh.corner_count());
    (0..mesh.face_count()).for_each(|face| pieces.keep(face));
    let (mut caps, mut larger, mut broken) = (0, 0, 0);
    let mut rims = Vec::new();
    let walks = boundary_walks(mesh.topology());
    let chosen = chosen_walks(mesh, &walks, &options.only)?;
    for (walk, _) in walks.iter().zip(chosen).filter(|(_, chosen)| *chosen) {
        let edges = walk.corners.len();
        if !walk.closed || edges < 3 {
            broken += 1;
        } else if options.most_edges.is_some_and(|most| edges > most) {
            larger += 1;
        } else {
            caps += 1;
            rims.extend_from_slice(&walk.corners);
            close(mesh, &mut pieces, walk, options.cap);
        }
    }
    let closed = with_material(pieces.finish(false)?, mesh.face_count(), options.material)?;
    Ok(Capped {
        mesh: with_crease(closed, rims.into_iter(), options.crease)?,
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
