//! Distances of a mesh's elements to a surface or to points.

use glam::DVec3;

use crate::mesh::Domain;
use crate::surface::Surface;
use crate::{Field, GeometryError, Mesh, Monitor, Quantity, Topology, parallel};

/// The place of each element: a vertex's position, the mean of a face's
/// corners, the position of a corner's vertex. Cost: O(corners).
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub fn places(
    mesh: &Mesh,
    domain: Domain,
    monitor: &dyn Monitor,
) -> Result<Vec<DVec3>, GeometryError> {
    let at = |vertex: u32| mesh.positions()[vertex as usize];
    parallel::map(
        mesh.element_count(domain),
        monitor,
        |element| match domain {
            Domain::Vertex => mesh.positions()[element],
            Domain::Corner => at(mesh.topology().corners()[element]),
            Domain::Face => {
                let face = mesh.face(element);
                let start = at(face[0]);
                let sum: DVec3 = face.iter().map(|&vertex| at(vertex) - start).sum();
                start + sum / face.len() as f64
            }
        },
    )
}

/// The distance of each element of `mesh` to a surface, in metres.
/// Cost: O(elements · log triangles).
///
/// # Errors
/// Those of [`Field::new`], [`GeometryError::Cancelled`].
pub fn distances_to_surface(
    mesh: &Mesh,
    domain: Domain,
    to: &Surface,
    monitor: &dyn Monitor,
) -> Result<Field, GeometryError> {
    let places = places(mesh, domain, monitor)?;
    let found = to.closest_all(&places, monitor)?;
    let values = found.iter().map(|closest| closest.distance).collect();
    Field::new(domain, Quantity::Length, values)
}

/// The distance of each element of `mesh` to the nearest of `points`, in metres.
/// Cost: O((elements + points) · log points).
///
/// # Errors
/// [`GeometryError::Empty`] without points, [`GeometryError::NonFiniteVertex`]
/// for one that is not finite, [`GeometryError::OutOfRange`] for coordinates
/// above 1e150, [`GeometryError::Cancelled`].
pub fn distances_to_points(
    mesh: &Mesh,
    domain: Domain,
    points: &[DVec3],
    monitor: &dyn Monitor,
) -> Result<Field, GeometryError> {
    if points.is_empty() {
        return Err(GeometryError::Empty {
            what: "the list of points",
            missing: "points",
        });
    }
    distances_to_surface(mesh, domain, &cloud(points, monitor)?, monitor)
}

/// Points as a surface of triangles without size.
pub(super) fn cloud(points: &[DVec3], monitor: &dyn Monitor) -> Result<Surface, GeometryError> {
    let corners = (0..points.len() as u32)
        .flat_map(|point| [point; 3])
        .collect();
    let topology = Topology::uniform(points.len(), 3, corners)?;
    Surface::new(&Mesh::new(points.to_vec(), topology.into())?, monitor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::test_support::grid;

    #[test]
    fn distances_to_points_and_planes_have_closed_forms() {
        let mesh = grid(9, 7, |x, y| [x, y, 2.0]);
        let points = [
            DVec3::new(3.2, 1.0, 0.0),
            DVec3::new(8.0, 6.5, 4.0),
            DVec3::ZERO,
        ];
        for domain in [Domain::Vertex, Domain::Face] {
            let found = distances_to_points(&mesh, domain, &points, &Unmonitored).unwrap();
            let places = places(&mesh, domain, &Unmonitored).unwrap();
            for (&place, &value) in places.iter().zip(found.values().iter()) {
                let brute = points.map(|point| place.distance(point));
                let least = brute.into_iter().fold(f64::INFINITY, f64::min);
                assert!((value - least).abs() < 1e-13);
            }
            let floor = Surface::new(&grid(1, 1, |x, y| [9.0 * x, 9.0 * y, 0.0]), &Unmonitored);
            let found = distances_to_surface(&mesh, domain, &floor.unwrap(), &Unmonitored);
            assert!(
                found
                    .unwrap()
                    .values()
                    .iter()
                    .all(|&value| (value - 2.0).abs() < 1e-15)
            );
        }
        assert!(distances_to_points(&mesh, Domain::Face, &[], &Unmonitored).is_err());
    }
}
