//! How far a surface can be offset before it meets its own medial axis.

use glam::DVec3;

use super::distance::cloud;
use super::jet::jet_normal;
use crate::mesh::Domain;
use crate::normals::{NormalWeights, face_normals, vertex_normals, vertices_without_normal};
use crate::surface::Surface;
use crate::{Field, GeometryError, Mesh, Monitor, Quantity, parallel};

/// The largest offsets along and against the vertex normals.
#[derive(Debug, Clone)]
pub struct MaxOffset {
    /// Largest offset along the normal, one per vertex, in metres.
    pub outward: Field,
    /// Largest offset against the normal, one per vertex, in metres.
    pub inward: Field,
}

/// Steps of the shrinking ball; it settles in fewer than ten.
const STEPS: usize = 60;

/// Share of the radius below which a place counts as on the ball, not in it.
const ON_BALL: f64 = 1e-9;

/// The largest offset of each vertex along its normal before the surface's own
/// medial axis (Wallner et al. 2001), on both sides, at most `limit`.
///
/// It is the radius of the largest ball that touches the surface at the vertex
/// and holds none of it: the ball shrinks until nothing is inside (Ma et al.
/// 2012), r = |q - p|² / (2 n · (q - p)) for the place q found inside. All
/// vertices count, and the faces that look against the normal: those that look
/// along it belong to the sheet of the vertex, whose facets would take away
/// all room beside a convex vertex. n is the normal of the cubic that fits the
/// vertices of two rings (a 3-jet, Cazals and Pouget 2005), as an error of n is
/// felt over the distance of the next vertex; at folds, corners and in small
/// meshes it is the vertex normal.
///
/// With faces of size h the error is O(h²): on a torus of radii 3 and 1 at most
/// 1.1 % with 48 x 24 quads and 0.26 % with 96 x 48, and of the same order where
/// faces differ in size. Planes, and balls between planes, are exact. Isolated
/// vertices get 0. Cost: O(vertices · log triangles), more where many places are
/// equally near, as from the middle of a sphere.
///
/// # Errors
/// [`GeometryError::OutOfRange`] for a limit that is not positive and finite,
/// [`GeometryError::NoNormal`], those of [`Surface::new`],
/// [`GeometryError::Cancelled`].
pub fn max_offset(
    mesh: &Mesh,
    limit: f64,
    monitor: &dyn Monitor,
) -> Result<MaxOffset, GeometryError> {
    if !(limit > 0.0 && limit.is_finite()) {
        return Err(GeometryError::OutOfRange {
            what: "the limit",
            value: limit,
            requirement: "it must be positive and finite",
        });
    }
    let normals = vertex_normals(mesh, NormalWeights::Angle, true, monitor)?;
    let vertices = vertices_without_normal(mesh, &normals);
    if !vertices.is_empty() {
        return Err(GeometryError::NoNormal { vertices });
    }
    let room = Room {
        surface: Surface::new(mesh, monitor)?,
        vertices: cloud(mesh.positions(), monitor)?,
        face_normals: face_normals(mesh, monitor)?,
    };
    let side = |sense: f64| {
        let radii = parallel::map(mesh.vertex_count(), monitor, |vertex| {
            let normal = normals[vertex];
            if normal == DVec3::ZERO {
                return 0.0;
            }
            let jet = jet_normal(mesh, vertex, normal, &mut Vec::new());
            room.radius(mesh.positions()[vertex], jet * sense, normal, limit)
        })?;
        Field::new(Domain::Vertex, Quantity::Length, radii)
    };
    Ok(MaxOffset {
        outward: side(1.0)?,
        inward: side(-1.0)?,
    })
}

/// What a ball may run into.
struct Room {
    surface: Surface,
    vertices: Surface,
    face_normals: Vec<DVec3>,
}

impl Room {
    /// Radius of the largest ball that touches `at` and lies in direction `way`.
    fn radius(&self, at: DVec3, way: DVec3, normal: DVec3, limit: f64) -> f64 {
        let mut radius = limit;
        for _ in 0..STEPS {
            let centre = at + way * radius;
            let inside = radius * (1.0 - ON_BALL);
            let vertex = self.vertices.closest_within(centre, inside);
            let found = vertex.or_else(|| {
                let faces_it = |face: u32| self.face_normals[face as usize].dot(normal) < 0.0;
                self.surface.closest_among(centre, inside, faces_it)
            });
            let Some(found) = found else {
                break;
            };
            let arm = found.point - at;
            let smaller = arm.length_squared() / (2.0 * arm.dot(way));
            if smaller.is_nan() || smaller >= radius {
                break;
            }
            radius = smaller;
        }
        radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::test_shapes::{cylinder, sphere};
    use crate::test_support::{grid, torus};

    #[test]
    fn sphere_cylinder_and_torus_have_closed_forms() {
        let worst = |mesh: &Mesh| {
            let found = max_offset(mesh, 50.0, &Unmonitored).unwrap();
            let errors = found
                .inward
                .values()
                .iter()
                .map(|radius| (radius - 1.0).abs());
            errors.fold(0.0, f64::max)
        };
        // All of radius 1; the sphere's normals are not radial beside its poles.
        assert!(worst(&sphere(32, 16)) < 0.06);
        assert!(worst(&cylinder(48, 3)) < 0.01);
        // Order two, also where faces differ in size: half the size, a quarter of the
        // error. Measured: 1.1 % and 0.26 %; uneven 8.7 % and 2.3 % (16 and 32 round).
        let [coarse, fine] = [24, 48].map(|n| worst(&torus(2 * n, n, 3.0, 1.0)));
        assert!(fine < 0.004 && fine < 0.3 * coarse, "{coarse} {fine}");
        let [coarse, fine] = [16, 32].map(|n| worst(&uneven_torus(n)));
        assert!(fine < 0.03 && fine < 0.3 * coarse, "{coarse} {fine}");
        let found = max_offset(&sphere(32, 16), 50.0, &Unmonitored).unwrap();
        assert!(found.outward.values().iter().all(|&radius| radius > 49.999));
        // Outside a torus the inner equator is 2 from the axis; the outer has all room.
        let ring = torus(96, 48, 3.0, 1.0);
        let found = max_offset(&ring, 50.0, &Unmonitored).unwrap();
        let at = |x: f64| {
            let place = DVec3::new(x, 0.0, 0.0);
            let near = |v: &usize| ring.positions()[*v].distance(place) < 1e-9;
            found.outward.values()[(0..ring.vertex_count()).find(near).unwrap()]
        };
        assert!((at(2.0) - 2.0).abs() < 0.01, "{}", at(2.0));
        assert!(at(4.0) > 49.0, "{}", at(4.0));
    }

    /// A torus of radii 3 and 1 of 2 n by n quads of very different sizes.
    fn uneven_torus(n: u32) -> Mesh {
        use crate::math::{atan2, cos, hypot, sin};
        let even = torus(2 * n, n, 3.0, 1.0);
        let slide = |p: &DVec3| {
            let (a, b) = (atan2(p.y, p.x), atan2(p.z, hypot(p.x, p.y) - 3.0));
            let turned = a + 0.2 * sin(2.0 * a + b);
            let b = b + 0.3 * sin(b) + 0.1 * cos(3.0 * a);
            let r = 3.0 + cos(b);
            DVec3::new(r * cos(turned), r * sin(turned), sin(b))
        };
        let places = even.positions().iter().map(slide).collect();
        even.with_positions(places).unwrap()
    }

    #[test]
    fn planes_have_all_room_and_folds_none_at_their_ridge() {
        let plane = grid(5, 4, |x, y| [x, y, 0.3 * x]);
        let found = max_offset(&plane, 7.0, &Unmonitored).unwrap();
        for field in [&found.outward, &found.inward] {
            assert!(
                field
                    .values()
                    .iter()
                    .all(|&room| (room - 7.0).abs() < 1e-12)
            );
        }
        // A valley of two planes at 45 degrees: a ball that touches one of them at x
        // from the ridge, and the other one, has the radius x √2.
        let valley = grid(20, 3, |x, y| [x - 10.0, y, (x - 10.0).abs()]);
        let found = max_offset(&valley, 1e3, &Unmonitored).unwrap();
        let exact = |x: f64| x * 2f64.sqrt();
        for (place, &room) in valley.positions().iter().zip(found.outward.values().iter()) {
            let x = place.x.abs();
            // Nearer the ridge the cubic rounds it.
            if x > 1.9 {
                assert!((room - exact(x)).abs() < 1e-9, "{x}: {room} {}", exact(x));
            }
        }
    }

    #[test]
    fn walls_leave_half_of_their_gap() {
        let low = grid(3, 3, |x, y| [x, y, 0.0]);
        // Turned over, so that the walls face each other, and its vertices elsewhere.
        let high = grid(2, 2, |x, y| [y * 2.1 - 0.5, x * 2.1 - 0.5, 1.6]);
        let walls = crate::join(&[&low, &high]).unwrap();
        let found = max_offset(&walls, 10.0, &Unmonitored).unwrap();
        for vertex in 0..16 {
            assert!((found.outward.values()[vertex] - 0.8).abs() < 1e-9);
            assert!(found.inward.values()[vertex] >= 10.0);
        }
        assert!(max_offset(&walls, 0.0, &Unmonitored).is_err());
    }
}
