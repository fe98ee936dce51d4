//! Makers of directions: constant, from faces, from an attribute.

use glam::DVec3;

use crate::math::unit_or_zero;
use crate::mesh::{AttributeValues, Domain};
use crate::normals::{face_normals, vertices_without_normal};
use crate::{DirectionSource, Directions, GeometryError, Mesh, Monitor, parallel};

/// One direction for all vertices: heights are measured along it, or along its
/// multiples unless `unit`.
///
/// # Errors
/// [`GeometryError::Invalid`] for a vector without length,
/// [`GeometryError::NonFiniteValue`].
pub fn constant_direction(
    mesh: &Mesh,
    vector: DVec3,
    unit: bool,
) -> Result<Directions, GeometryError> {
    if vector == DVec3::ZERO {
        return Err(GeometryError::Invalid(
            "the constant direction has no length; give one other than (0, 0, 0)".into(),
        ));
    }
    let unit = unit && vector.is_finite();
    let vector = if unit { unit_or_zero(vector) } else { vector };
    let vectors = vec![vector; mesh.vertex_count()];
    Directions::new(mesh, vectors, DirectionSource::Surface)
}

/// The mean of the unit normals of the faces round each vertex, all alike.
///
/// Shorter than 1 where faces are at an angle, unless `unit`. Isolated
/// vertices get the zero vector. Cost: O(corners).
///
/// # Errors
/// [`GeometryError::NoNormal`] names vertices whose faces have no area or
/// cancel each other; [`GeometryError::Cancelled`].
pub fn face_normal_directions(
    mesh: &Mesh,
    unit: bool,
    monitor: &dyn Monitor,
) -> Result<Directions, GeometryError> {
    let normals = face_normals(mesh, monitor)?;
    let adjacency = mesh.topology().adjacency();
    let vectors = parallel::map(mesh.vertex_count(), monitor, |vertex| {
        let corners = adjacency.vertex_corners(vertex).iter();
        let faces = corners.map(|&corner| adjacency.corner_faces()[corner as usize]);
        let around = faces
            .map(|face| normals[face as usize])
            .filter(|&normal| normal != DVec3::ZERO);
        mean(around, unit)
    })?;
    let vertices = vertices_without_normal(mesh, &vectors);
    if vertices.is_empty() {
        Directions::new(mesh, vectors, DirectionSource::Surface)
    } else {
        Err(GeometryError::NoNormal { vertices })
    }
}

/// Directions stored in the mesh: a vertex attribute of 3D vectors, or a
/// corner attribute, the mean of whose values round each vertex is taken.
///
/// A vertex attribute of that name goes first. Vectors keep their lengths
/// unless `unit`. Cost: O(corners).
///
/// # Errors
/// [`GeometryError::NoAttribute`], [`GeometryError::ZeroDirection`] for
/// vertices of faces, [`GeometryError::Cancelled`].
pub fn directions_from_attribute(
    mesh: &Mesh,
    name: &str,
    unit: bool,
    monitor: &dyn Monitor,
) -> Result<Directions, GeometryError> {
    let values = |domain| match mesh.attribute(name, domain).map(|a| a.values()) {
        Some(AttributeValues::Vector3(values)) => Some(values),
        _ => None,
    };
    let adjacency = mesh.topology().adjacency();
    let vectors = if let Some(values) = values(Domain::Vertex) {
        parallel::map(mesh.vertex_count(), monitor, |vertex| {
            mean([values[vertex]].into_iter(), unit)
        })?
    } else if let Some(values) = values(Domain::Corner) {
        parallel::map(mesh.vertex_count(), monitor, |vertex| {
            let corners = adjacency.vertex_corners(vertex).iter();
            mean(corners.map(|&corner| values[corner as usize]), unit)
        })?
    } else {
        let available = mesh.attributes().iter().map(|a| a.name().to_owned());
        return Err(GeometryError::NoAttribute {
            name: name.to_owned(),
            wanted: "3D vector vertex or corner",
            available: available.collect(),
        });
    };
    let vertices = vertices_without_normal(mesh, &vectors);
    if vertices.is_empty() {
        Directions::new(mesh, vectors, DirectionSource::Surface)
    } else {
        Err(GeometryError::ZeroDirection { vertices })
    }
}

/// The mean of `vectors`, zero without any, at unit length if `unit`.
fn mean(vectors: impl Iterator<Item = DVec3>, unit: bool) -> DVec3 {
    let (mut sum, mut count) = (DVec3::ZERO, 0u32);
    for vector in vectors {
        sum += vector;
        count += 1;
    }
    let mean = sum / f64::from(count.max(1));
    if unit { unit_or_zero(mean) } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::grid;
    use crate::{Attribute, Unmonitored};

    #[test]
    fn a_constant_is_the_same_everywhere() {
        let mesh = grid(1, 1, |x, y| [x, y, x * y]);
        let long = DVec3::new(0.0, 3.0, 4.0);
        let plain = constant_direction(&mesh, long, false).unwrap();
        assert!(plain.outward().iter().all(|&vector| vector == long));
        let unit = constant_direction(&mesh, long, true).unwrap();
        assert!(
            unit.outward()
                .iter()
                .all(|vector| (*vector - long / 5.0).length() < 1e-15)
        );
        for (wrong, unit) in [
            (DVec3::ZERO, false),
            (DVec3::NAN, true),
            (DVec3::INFINITY, true),
        ] {
            assert!(constant_direction(&mesh, wrong, unit).is_err());
        }
    }

    #[test]
    fn face_normals_are_averaged_without_weights() {
        // A wide level face and a narrow upright one share the edge x = 1.
        let mesh = Mesh::from_faces(
            vec![
                [0., 0., 0.],
                [1., 0., 0.],
                [1., 1., 0.],
                [0., 1., 0.],
                [1., 0., 0.1],
                [1., 1., 0.1],
            ],
            &[[0, 1, 2, 3], [1, 4, 5, 2]],
        )
        .unwrap();
        let plain = face_normal_directions(&mesh, false, &Unmonitored).unwrap();
        assert!((plain.outward()[1] - DVec3::new(-0.5, 0.0, 0.5)).length() < 1e-15);
        let unit = face_normal_directions(&mesh, true, &Unmonitored).unwrap();
        assert!((unit.outward()[1] - DVec3::new(-1.0, 0.0, 1.0).normalize()).length() < 1e-15);
        assert_eq!(unit.outward()[0], DVec3::Z);
        let flat = Mesh::from_faces(vec![[0.0; 3]; 3], &[[0, 1, 2]]).unwrap();
        let vertices = vec![0, 1, 2];
        let refused = face_normal_directions(&flat, false, &Unmonitored).unwrap_err();
        assert_eq!(refused, GeometryError::NoNormal { vertices });
    }

    #[test]
    fn attributes_are_read_by_vertex_or_averaged_over_corners() {
        let mesh = grid(2, 1, |x, y| [x, y, 0.0]);
        let corners = (0..8)
            .map(|corner| DVec3::new(0.0, f64::from(corner), 2.0))
            .collect();
        let corners = Attribute::new("lean", Domain::Corner, AttributeValues::Vector3(corners));
        let mesh = mesh.with_attribute(corners).unwrap();
        let lean = directions_from_attribute(&mesh, "lean", false, &Unmonitored).unwrap();
        // Vertex 1 is corner 1 of face 0 and corner 0 of face 1, the fifth of all.
        assert_eq!(lean.outward()[1], DVec3::new(0.0, 2.5, 2.0));
        let vertices = (0..6).map(|_| DVec3::X * 3.0).collect();
        let vertices = Attribute::new("lean", Domain::Vertex, AttributeValues::Vector3(vertices));
        let mesh = mesh.with_attribute(vertices).unwrap();
        let lean = directions_from_attribute(&mesh, "lean", true, &Unmonitored).unwrap();
        assert_eq!(lean.outward()[1], DVec3::X);
        let missing = directions_from_attribute(&mesh, "tilt", true, &Unmonitored).unwrap_err();
        assert!(missing.to_string().contains("`lean`"));
    }
}
