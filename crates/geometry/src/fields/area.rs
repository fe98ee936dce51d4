//! How large faces are.

use crate::normals::face_area_vectors;
use crate::{Domain, Field, GeometryError, Mesh, Monitor, Quantity, parallel};

/// The area of each face in square metres: half the length of Newell's vector,
/// for a face that is not flat the area of its shadow along its normal.
/// Cost: O(corners).
///
/// # Errors
/// [`GeometryError::NonFiniteValue`] for areas beyond the range of numbers,
/// [`GeometryError::Cancelled`].
pub fn face_areas(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Field, GeometryError> {
    let areas = areas(mesh, monitor)?;
    Field::new(Domain::Face, Quantity::Area, areas)
}

/// The mean of [`face_areas`] over the faces round each vertex; 0 without faces.
///
/// # Errors
/// As [`face_areas`].
pub fn mean_face_areas(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Field, GeometryError> {
    let means = vertex_means(mesh, monitor)?;
    Field::new(Domain::Vertex, Quantity::Area, means)
}

fn areas(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Vec<f64>, GeometryError> {
    let vectors = face_area_vectors(mesh, monitor)?;
    // Newell's vector is twice the area long.
    parallel::map(vectors.len(), monitor, |face| vectors[face].length() / 2.0)
}

/// The numbers of [`mean_face_areas`], one per vertex.
pub(crate) fn vertex_means(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Vec<f64>, GeometryError> {
    let areas = areas(mesh, monitor)?;
    let adjacency = mesh.topology().adjacency();
    parallel::map(mesh.vertex_count(), monitor, |vertex| {
        let corners = adjacency.vertex_corners(vertex);
        let area = |&corner: &u32| areas[adjacency.corner_faces()[corner as usize] as usize];
        let sum: f64 = corners.iter().map(area).sum();
        sum / corners.len().max(1) as f64
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;

    #[test]
    fn areas_of_a_step_of_squares() {
        // Squares of side 1 and 2 side by side share the edge from 1 to 2.
        let places = [[0., 0.], [1., 0.], [1., 1.], [0., 1.], [3., 0.], [3., 1.]];
        let places = places.iter().map(|[x, y]| [*x, *y, 0.5 * *x]).collect();
        let mesh = Mesh::from_faces(places, &[[0, 1, 2, 3], [1, 4, 5, 2]]).unwrap();
        let slope = 1.25f64.sqrt();
        let faces = face_areas(&mesh, &Unmonitored).unwrap();
        assert_eq!(
            (faces.domain(), faces.quantity()),
            (Domain::Face, Quantity::Area)
        );
        for (area, expected) in faces.values().iter().zip([1.0, 2.0]) {
            assert!((area - expected * slope).abs() < 1e-15);
        }
        let vertices = mean_face_areas(&mesh, &Unmonitored).unwrap();
        for (area, expected) in vertices.values().iter().zip([1.0, 1.5, 1.5, 1.0, 2.0, 2.0]) {
            assert!((area - expected * slope).abs() < 1e-15);
        }
    }
}
