//! Polygons cut along their diagonals, into quads or triangles.

use glam::DVec3;

use super::check_per_face;
use super::pieces::Pieces;
use crate::normals::newell;
use crate::{GeometryError, Mesh};

/// Where the pieces of a face stand among the faces of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PieceOrder {
    /// All pieces of a face together, in the place of the face.
    #[default]
    Together,
    /// One piece in the place of the face, the others after all faces.
    Appended,
}

/// A mesh whose large polygons were cut.
#[derive(Debug, Clone)]
pub struct Split {
    /// The mesh; its face attribute [`super::SOURCE_FACE`] names the faces cut.
    pub mesh: Mesh,
    /// Faces of the input with a piece that turns against them, ascending: the
    /// cuts of a concave polygon need not lie inside it.
    pub folded: Vec<u32>,
}

/// Cuts polygons of more than four corners into quads and at most one triangle.
///
/// Of the corner list P the quad (P\[-2\], P\[-1\], P\[0\], P\[1\]) is cut off and
/// P\[-1\] and P\[0\] dropped, until four corners are left, or three, which give
/// the triangle (P\[-2\], P\[-1\], P\[0\]): the strip of the paper's add-on.
/// Triangles and quads are kept as they are, first and in order; the pieces
/// follow, face by face. Meant for convex polygons; `folded` names the others
/// that came out badly. Cost: O(corners).
///
/// ```
/// use tessgraph_geometry::{Mesh, domains::split_into_quads};
/// let pentagon = Mesh::from_faces(
///     vec![[0., 0., 0.], [1., 0., 0.], [1.5, 1., 0.], [0.5, 2., 0.], [-0.5, 1., 0.]],
///     &[&[0, 1, 2, 3, 4]],
/// )?;
/// let split = split_into_quads(&pentagon)?;
/// assert_eq!((split.mesh.face(0), split.mesh.face(1)), (&[3, 4, 0, 1][..], &[2, 3, 1][..]));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// As [`Mesh::new`].
pub fn split_into_quads(mesh: &Mesh) -> Result<Split, GeometryError> {
    let mut pieces = Pieces::new(mesh, 2 * mesh.corner_count());
    let large = |&face: &usize| mesh.face(face).len() > 4;
    for face in (0..mesh.face_count()).filter(|face| !large(face)) {
        pieces.keep(face);
    }
    let mut folded = Vec::new();
    for face in (0..mesh.face_count()).filter(large) {
        let normal = area_vector(mesh, face, None);
        let mut turned = false;
        // The corners left are those from `first` on, in number `left`.
        let (mut first, mut left) = (0, mesh.face(face).len());
        while left > 2 {
            let last = first + left - 1;
            let four = [last - 1, last, first, first + 1];
            let three = [last - 1, last, first];
            let piece = if left > 3 { &four[..] } else { &three[..] };
            pieces.piece(face, piece);
            turned |= area_vector(mesh, face, Some(piece)).dot(normal) < 0.0;
            (first, left) = (first + 1, left - 2);
        }
        if turned {
            folded.push(face as u32);
        }
    }
    let mesh = pieces.finish(true)?;
    Ok(Split { mesh, folded })
}

/// The Newell vector of a face, or of some of its corners.
fn area_vector(mesh: &Mesh, face: usize, corners: Option<&[usize]>) -> DVec3 {
    let vertices = mesh.face(face);
    let place = |&vertex: &u32| mesh.positions()[vertex as usize];
    match corners {
        None => newell(vertices.iter().map(place)),
        Some(corners) => newell(corners.iter().map(|&corner| place(&vertices[corner]))),
    }
}

/// Cuts faces into triangles, those of [`Mesh::triangles`]: the same surface.
///
/// A quad p0 p1 p2 p3 gives (p0, p1, p2) and (p0, p2, p3). With
/// [`PieceOrder::Appended`] the last triangle of each face takes its place and
/// the others follow after all faces, as the paper's add-on orders them. Faces
/// that are not `chosen` (one value per face) stay. The face attribute
/// [`super::SOURCE_FACE`] names the face of each triangle. Cost: O(corners);
/// O(n²) for a concave face of n corners.
///
/// # Errors
/// [`GeometryError::AttributeLength`] unless `chosen` has one value per face.
pub fn triangulate_faces(
    mesh: &Mesh,
    chosen: &[bool],
    order: PieceOrder,
) -> Result<Mesh, GeometryError> {
    check_per_face("chosen", mesh, chosen.len())?;
    let triangles = mesh.triangles();
    let mut pieces = Pieces::new(mesh, 3 * triangles.corners.len());
    let mut later: Vec<(usize, [usize; 3])> = Vec::new();
    for same in triangles
        .faces
        .chunk_by(|a, b| a == b)
        .scan(0, |start, faces| {
            let range = *start..*start + faces.len();
            *start = range.end;
            Some(range)
        })
    {
        let face = triangles.faces[same.start] as usize;
        if !chosen[face] {
            pieces.keep(face);
            continue;
        }
        let start = mesh.topology().corner_range(face).start;
        for triangle in same.clone() {
            let corners = triangles.corners[triangle].map(|corner| corner as usize - start);
            if order == PieceOrder::Together || triangle + 1 == same.end {
                pieces.piece(face, &corners);
            } else {
                later.push((face, corners));
            }
        }
    }
    for (face, corners) in later {
        pieces.piece(face, &corners);
    }
    pieces.finish(true)
}
