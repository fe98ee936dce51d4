//! Normals of faces and vertices.

mod angles;

use glam::DVec3;

use crate::math::{angle_between, unit_or_zero};
use crate::parallel;
use crate::{GeometryError, Mesh, Monitor};

/// Newell's area vector of a polygon: its direction is the normal of the best
/// fitting plane, its length twice the polygon's area (Sutherland et al. 1974).
///
/// Sums cross products about the first corner, so that a polygon far from the
/// origin keeps its digits.
pub fn newell(polygon: impl IntoIterator<Item = DVec3>) -> DVec3 {
    let mut places = polygon.into_iter();
    let (Some(origin), Some(first)) = (places.next(), places.next()) else {
        return DVec3::ZERO;
    };
    let mut previous = first - origin;
    let mut sum = DVec3::ZERO;
    for place in places {
        let arm = place - origin;
        sum += previous.cross(arm);
        previous = arm;
    }
    sum
}

/// Newell area vectors of all faces, one per face, in square metres times two.
/// Cost: O(corners).
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub fn face_area_vectors(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Vec<DVec3>, GeometryError> {
    let positions = mesh.positions();
    parallel::map(mesh.face_count(), monitor, |face| {
        newell(
            mesh.face(face)
                .iter()
                .map(|&vertex| positions[vertex as usize]),
        )
    })
}

/// Unit normals of all faces, one per face; zero for a face without area.
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub fn face_normals(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Vec<DVec3>, GeometryError> {
    let mut normals = face_area_vectors(mesh, monitor)?;
    parallel::fill(&mut normals, monitor, |_, normal| {
        *normal = unit_or_zero(*normal);
    })?;
    Ok(normals)
}

/// How the normals of the faces round a vertex are weighted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NormalWeights {
    /// By the face's angle at the vertex (Thürmer and Wüthrich 1998): does not
    /// depend on how the surface is cut into faces.
    #[default]
    Angle,
    /// By the face's area.
    Area,
    /// All alike.
    Uniform,
}

/// Vertex normals: the weighted sum of the face normals round each vertex, one
/// per vertex, at unit length if `unit`.
///
/// A vertex without faces, or with only degenerate ones, gets the zero vector;
/// [`vertices_without_normal`] names those. Never NaN. Cost: O(corners).
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub fn vertex_normals(
    mesh: &Mesh,
    weights: NormalWeights,
    unit: bool,
    monitor: &dyn Monitor,
) -> Result<Vec<DVec3>, GeometryError> {
    // Area vectors, or unit normals where size does not count.
    let of_face = match weights {
        NormalWeights::Area => face_area_vectors(mesh, monitor)?,
        NormalWeights::Angle | NormalWeights::Uniform => face_normals(mesh, monitor)?,
    };
    let adjacency = mesh.topology().adjacency_with(monitor)?;
    let angles = match weights {
        NormalWeights::Angle => angles::corner_angles(mesh, monitor)?,
        NormalWeights::Area | NormalWeights::Uniform => Vec::new(),
    };
    parallel::map(mesh.vertex_count(), monitor, |vertex| {
        let mut sum = DVec3::ZERO;
        for &corner in adjacency.vertex_corners(vertex) {
            let normal = of_face[adjacency.corner_faces()[corner as usize] as usize];
            sum += match weights {
                NormalWeights::Angle => normal * angles[corner as usize],
                NormalWeights::Area => normal * 0.5,
                NormalWeights::Uniform => normal,
            };
        }
        if unit { unit_or_zero(sum) } else { sum }
    })
}

/// The angle of a face at one of its corners, in radians.
pub fn corner_angle(mesh: &Mesh, corner: u32) -> f64 {
    let topology = mesh.topology();
    let face = topology.adjacency().corner_faces()[corner as usize] as usize;
    let range = topology.corner_range(face);
    let (here, count) = (corner as usize - range.start, range.len());
    let vertices = topology.face(face);
    let place = |k: usize| mesh.positions()[vertices[k % count] as usize];
    let at = place(here);
    angle_between(place(here + 1) - at, place(here + count - 1) - at)
}

/// Vertices that belong to a face but have no normal, ascending: zero vectors
/// in `normals` (one per vertex). Isolated vertices are not listed.
pub fn vertices_without_normal(mesh: &Mesh, normals: &[DVec3]) -> Vec<u32> {
    let adjacency = mesh.topology().adjacency();
    let lacks = |&vertex: &usize| {
        normals[vertex] == DVec3::ZERO && !adjacency.vertex_corners(vertex).is_empty()
    };
    (0..mesh.vertex_count())
        .filter(lacks)
        .map(|vertex| vertex as u32)
        .collect()
}
