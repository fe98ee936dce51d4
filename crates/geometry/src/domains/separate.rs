//! Faces that share no vertices.

use crate::rebuild::{Sources, rebuild};
use crate::{GeometryError, Mesh, Topology};

/// Gives every face vertices of its own, in the order of corners.
///
/// Faces lie where they were and keep all they carry; a vertex's values go to each
/// of its copies. So each face has one normal for all its corners, and directions
/// made of it are those of a flat cell. Vertices of no face go. Cost: O(corners).
///
/// ```
/// use tessgraph_geometry::{Mesh, domains::separate_faces};
/// let places = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 1.]];
/// let folded = Mesh::from_faces(places, &[[0, 1, 2], [0, 2, 3]])?;
/// let two = separate_faces(&folded)?;
/// assert_eq!((two.face(1), two.vertex_count()), (&[3, 4, 5][..], 6));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// As [`Mesh::new`].
pub fn separate_faces(mesh: &Mesh) -> Result<Mesh, GeometryError> {
    let topology = mesh.topology();
    let sources = topology.corners().to_vec();
    let positions = sources
        .iter()
        .map(|&vertex| mesh.positions()[vertex as usize])
        .collect();
    let corners = (0..mesh.corner_count() as u32).collect();
    let separate = Topology::new(mesh.corner_count(), topology.offsets().to_vec(), corners)?;
    let sources = Sources {
        vertices: Some(sources),
        ..Sources::default()
    };
    rebuild(mesh, positions, separate, &sources)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::directions::face_normal_directions;
    use crate::normals::face_normals;
    use crate::test_shapes::grid;
    use crate::{Attribute, AttributeValues, Domain, Unmonitored};

    #[test]
    fn each_face_has_its_own_normal_and_the_values_of_its_vertices() {
        let mesh = grid(3, 2, |x, y| [x, y, x * y + 0.3 * x * x]);
        let values: Vec<f64> = (0..mesh.vertex_count()).map(|v| v as f64).collect();
        let values = AttributeValues::Number(values.into());
        let mesh = mesh
            .with_attribute(Attribute::new("number", Domain::Vertex, values))
            .unwrap();
        let apart = separate_faces(&mesh).unwrap();
        assert_eq!(apart.vertex_count(), 4 * mesh.face_count());
        let normals = face_normals(&mesh, &Unmonitored).unwrap();
        let directions = face_normal_directions(&apart, true, &Unmonitored).unwrap();
        let numbers = apart.attribute("number", Domain::Vertex).unwrap();
        let AttributeValues::Number(numbers) = numbers.values() else {
            panic!("numbers");
        };
        for (face, normal) in normals.iter().enumerate() {
            for (&vertex, &copy) in mesh.face(face).iter().zip(apart.face(face)) {
                let direction = directions.outward()[copy as usize];
                assert!((direction - *normal).length() < 1e-15);
                assert!((numbers[copy as usize] - f64::from(vertex)).abs() < 0.5);
            }
        }
    }
}
