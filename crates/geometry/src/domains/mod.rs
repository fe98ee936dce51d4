//! How faces become the quads and triangles that components are mapped to.

mod bridge;
mod cap;
mod closing;
mod dissolve;
mod dual;
mod extrude;
mod fan;
mod flip;
mod frame;
mod inset;
mod pieces;
mod push;
mod rotate;
mod select;
mod separate;
mod split;
#[cfg(test)]
mod tests;

pub use bridge::{BridgeOptions, Bridged, LoopPairs, bridge_loops};
pub use cap::{Cap, CapOptions, Capped, cap_holes};
pub use dissolve::{Dissolved, dissolve_edges, edges_by_attribute, edges_within_angle};
pub use dual::{Dual, DualBorder, SOURCE_VERTEX, dual};
pub use extrude::{ExtrudeMode, ExtrudeOptions, ExtrudePart, extrude_faces};
pub use fan::fan_faces;
pub use flip::flip_chosen_faces;
pub use frame::{Fill, FrameOptions, FramePart, Framed, Inset, frame_faces};
pub use pieces::SOURCE_FACE;
pub use rotate::{
    Along, rotate_faces, turns_along_gradient, turns_by_uv, turns_random, turns_random_as,
};
pub use select::{cells, delete_faces, faces_within};
pub use separate::separate_faces;
pub use split::{PieceOrder, Split, split_into_quads, triangulate_faces};

use crate::{Amount, Domain, GeometryError, Mesh};

/// Which faces of `mesh` are chosen: those where `amount` is at least 0.5.
///
/// A constant 1 chooses all; a field holds one number per face.
///
/// # Errors
/// As [`Amount::check`].
pub fn chosen_faces(mesh: &Mesh, amount: &Amount) -> Result<Vec<bool>, GeometryError> {
    amount.check(mesh, Domain::Face)?;
    Ok((0..mesh.face_count())
        .map(|face| amount.at(face) >= 0.5)
        .collect())
}

/// Checks that there is one value of `what` per face.
fn check_per_face(what: &str, mesh: &Mesh, actual: usize) -> Result<(), GeometryError> {
    if actual == mesh.face_count() {
        return Ok(());
    }
    Err(GeometryError::AttributeLength {
        name: what.to_owned(),
        domain: Domain::Face,
        expected: mesh.face_count(),
        actual,
    })
}
