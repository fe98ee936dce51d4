//! Faces turned round.

use super::check_per_face;
use super::pieces::{Corner, Pieces};
use crate::{GeometryError, Mesh};

/// Turns chosen faces round: p0 p1 p2 p3 becomes p0 p3 p2 p1.
///
/// Corner 0 stays the corner (0, 0); u and v change places and the normal
/// points to the other side. Values on corners go with them, creases with
/// their edges. `chosen` has one value per face. Cost: O(corners).
///
/// # Errors
/// [`GeometryError::AttributeLength`] unless `chosen` has one value per face.
pub fn flip_chosen_faces(mesh: &Mesh, chosen: &[bool]) -> Result<Mesh, GeometryError> {
    check_per_face("chosen", mesh, chosen.len())?;
    let mut pieces = Pieces::new(mesh, mesh.corner_count());
    for (face, &chosen) in chosen.iter().enumerate() {
        if !chosen {
            pieces.keep(face);
            continue;
        }
        let range = mesh.topology().corner_range(face);
        for k in (0..range.len()).map(|k| (range.len() - k) % range.len()) {
            // Walking backwards, a corner is left by the edge that led to it.
            let before = range.start + (k + range.len() - 1) % range.len();
            pieces.push(Corner {
                edge: before as u32,
                ..pieces.old(range.start + k, true)
            });
        }
        pieces.end(face);
    }
    pieces.finish(false)
}
