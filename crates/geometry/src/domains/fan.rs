//! Faces as fans of triangles round a centre.

use glam::DVec3;

use super::pieces::{Corner, NEW_EDGE, Pieces};
use super::{PieceOrder, check_per_face};
use crate::{GeometryError, Mesh};

/// Replaces faces by fans: triangles (v_i, v_i+1, c) round a new centre c.
///
/// c = Σ v_i (l_(i-1) + l_i) / Σ (l_(i-1) + l_i) with l_i the length of the edge
/// from v_i to v_i+1, so that many short edges do not pull it; the mean of the
/// corners where all edges have no length. For a component on the triangle, u
/// runs along the outer edge and v towards the centre. Attributes of c are the
/// same weighted mean. With [`PieceOrder::Appended`] the first triangle of each
/// face takes its place and the others follow after all faces, as the paper's
/// add-on orders them. Faces that are not `chosen` (one value per face) stay.
/// Centres follow the old vertices in face order; the face attribute
/// [`super::SOURCE_FACE`] names the face of each triangle. Cost: O(corners).
///
/// ```
/// use tessgraph_geometry::{Mesh, domains::{PieceOrder, fan_faces}, glam::DVec3};
/// let quad = Mesh::from_faces(
///     vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
///     &[&[0, 1, 2, 3]],
/// )?;
/// let fan = fan_faces(&quad, &[true], PieceOrder::Together)?;
/// assert_eq!((fan.face_count(), fan.positions()[4]), (4, DVec3::new(0.5, 0.5, 0.0)));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::AttributeLength`] unless `chosen` has one value per face.
pub fn fan_faces(mesh: &Mesh, chosen: &[bool], order: PieceOrder) -> Result<Mesh, GeometryError> {
    check_per_face("chosen", mesh, chosen.len())?;
    let topology = mesh.topology();
    let mut pieces = Pieces::new(mesh, 3 * mesh.corner_count());
    let mut weights = Vec::new();
    let mut later: Vec<(usize, Corner)> = Vec::new();
    for (face, &chosen) in chosen.iter().enumerate() {
        if !chosen {
            pieces.keep(face);
            continue;
        }
        let vertices = mesh.face(face);
        let place = |k: usize| mesh.positions()[vertices[k] as usize];
        edge_weights(vertices.len(), place, &mut weights);
        let centre = Corner {
            vertex: pieces.vertex(
                weighted_mean(vertices.len(), place, &weights),
                vertices.iter().copied().zip(weights.iter().copied()),
            ),
            values: pieces.blend((topology.offsets()[face]..).zip(weights.iter().copied())),
            edge: NEW_EDGE,
        };
        match order {
            PieceOrder::Together => {
                (0..vertices.len()).for_each(|k| wedge(&mut pieces, mesh, face, k, centre));
            }
            PieceOrder::Appended => {
                wedge(&mut pieces, mesh, face, 0, centre);
                later.push((face, centre));
            }
        }
    }
    for (face, centre) in later {
        (1..mesh.face(face).len()).for_each(|k| wedge(&mut pieces, mesh, face, k, centre));
    }
    pieces.finish(true)
}

/// The triangle from corner `k` of `face` and the next one to the centre.
fn wedge(pieces: &mut Pieces<'_>, mesh: &Mesh, face: usize, k: usize, centre: Corner) {
    let range = mesh.topology().corner_range(face);
    let next = range.start + (k + 1) % range.len();
    let outer = [
        pieces.old(range.start + k, true),
        pieces.old(next, false),
        centre,
    ];
    pieces.face(face, outer);
}

/// For each corner of a polygon the share of the perimeter its two edges have.
pub(super) fn edge_weights(count: usize, place: impl Fn(usize) -> DVec3, weights: &mut Vec<f64>) {
    let length = |k: usize| place(k).distance(place((k + 1) % count));
    weights.clear();
    weights.extend((0..count).map(|k| length((k + count - 1) % count) + length(k)));
    let total: f64 = weights.iter().sum();
    for weight in weights {
        *weight = if total > 0.0 {
            *weight / total
        } else {
            1.0 / count as f64
        };
    }
}

/// The weighted mean of a polygon's corners, taken about the first one so that
/// a polygon far from the origin keeps its digits.
pub(super) fn weighted_mean(
    count: usize,
    place: impl Fn(usize) -> DVec3,
    weights: &[f64],
) -> DVec3 {
    let origin = place(0);
    (0..count).fold(origin, |sum, k| sum + (place(k) - origin) * weights[k])
}
