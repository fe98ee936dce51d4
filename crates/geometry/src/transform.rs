//! Moves, turns, scales and mirrors meshes.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use crate::math::{cos, sin, unit_or_zero};
use crate::mesh::{Attribute, AttributeValues, Domain};
use crate::{GeometryError, Mesh, Monitor, Topology, parallel};

/// Attribute that holds unit normals, on vertices, faces or corners.
pub const NORMAL: &str = "normal";

/// Rotation by `angle` radians about `axis`, counter-clockwise seen against it
/// (Rodrigues). The axis need not have unit length.
///
/// # Errors
/// [`GeometryError::Invalid`] for an axis of length zero or not finite;
/// [`GeometryError::OutOfRange`] for an angle that is not finite.
pub fn rotation_about(axis: DVec3, angle: f64) -> Result<DMat3, GeometryError> {
    check_angles(&[angle])?;
    let axis = unit_or_zero(axis);
    if axis == DVec3::ZERO {
        let message = "the axis of rotation has no direction";
        return Err(GeometryError::Invalid(message.into()));
    }
    let (sin, cos) = (sin(angle), cos(angle));
    let turned = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    Ok(DMat3::from_cols(
        turned(DVec3::X),
        turned(DVec3::Y),
        turned(DVec3::Z),
    ))
}

/// Rotation about the fixed x axis, then the y axis, then the z axis, by
/// `angles` in radians.
///
/// # Errors
/// [`GeometryError::OutOfRange`] for an angle that is not finite.
pub fn rotation_by(angles: DVec3) -> Result<DMat3, GeometryError> {
    check_angles(&angles.to_array())?;
    let [x, y, z] = angles.to_array().map(|angle| (sin(angle), cos(angle)));
    let about_x = DMat3::from_cols(
        DVec3::X,
        DVec3::new(0.0, x.1, x.0),
        DVec3::new(0.0, -x.0, x.1),
    );
    let about_y = DMat3::from_cols(
        DVec3::new(y.1, 0.0, -y.0),
        DVec3::Y,
        DVec3::new(y.0, 0.0, y.1),
    );
    let about_z = DMat3::from_cols(
        DVec3::new(z.1, z.0, 0.0),
        DVec3::new(-z.0, z.1, 0.0),
        DVec3::Z,
    );
    Ok(about_z * about_y * about_x)
}

/// The map that scales by `scale` along x, y and z, then turns by `rotation`,
/// both about `pivot`, then moves by `translation`, in metres.
pub fn placement(scale: DVec3, rotation: DMat3, pivot: DVec3, translation: DVec3) -> DAffine3 {
    let linear = rotation * DMat3::from_diagonal(scale);
    DAffine3::from_mat3_translation(linear, pivot - linear * pivot + translation)
}

fn check_angles(angles: &[f64]) -> Result<(), GeometryError> {
    match angles.iter().find(|angle| !angle.is_finite()) {
        Some(&value) => Err(GeometryError::OutOfRange {
            what: "the angle of rotation",
            value,
            requirement: "it must be finite",
        }),
        None => Ok(()),
    }
}

/// The mesh with every point p at `world_from_local * p`.
///
/// Attributes named [`NORMAL`] turn along and keep unit length (zero where the
/// map flattens them away); all others stay. A map that mirrors also flips the
/// faces, as [`flip_faces`] does, so that outside stays outside. Without that
/// the faces are shared with the given mesh. Cost: O(size), in parallel.
///
/// # Errors
/// [`GeometryError::NonFiniteVertex`] when a coordinate overflows, or the map
/// itself is not finite; [`GeometryError::Cancelled`].
///
/// ```
/// use tessgraph_geometry::{Unmonitored, glam::{DAffine3, DVec3}, measure::measure_mesh};
/// use tessgraph_geometry::{primitives::cuboid, transform::transform};
/// let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
/// let mirrored = transform(&cuboid(DVec3::ONE, [1, 1, 1], false)?, mirror, &Unmonitored)?;
/// assert_eq!(measure_mesh(&mirrored).volume, Some(1.0));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn transform(
    mesh: &Mesh,
    world_from_local: DAffine3,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    let places = mesh.positions();
    let mut moved = mesh.with_positions(parallel::map(places.len(), monitor, |vertex| {
        world_from_local.transform_point3(places[vertex])
    })?)?;
    let linear = world_from_local.matrix3;
    let mirrors = linear.determinant() < 0.0;
    // Cofactors turn area vectors, even where the map has no inverse; a mirror
    // turns them round once more, and so does the flip of the faces.
    let cofactors = DMat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    ) * if mirrors { -1.0 } else { 1.0 };
    for attribute in mesh.attributes() {
        if let (NORMAL, AttributeValues::Vector3(normals)) = (attribute.name(), attribute.values())
        {
            let turned = parallel::map(normals.len(), monitor, |index| {
                unit_or_zero(cofactors * normals[index])
            })?;
            let turned = AttributeValues::Vector3(turned.into());
            moved = moved.with_attribute(attribute.with_values(turned))?;
        }
    }
    if mirrors {
        flip_faces(&moved)
    } else {
        Ok(moved)
    }
}

/// The mesh with every face turned round: p0 p1 p2 p3 becomes p0 p3 p2 p1.
///
/// Corner 0 stays the corner (0, 0) of its face; u and v change places. Corner
/// attributes go with their corners, the edge attributes
/// [`CREASE`](crate::subdivide::CREASE) and [`SEAM`](crate::SEAM) with their edges. Attributes named [`NORMAL`] are left alone: they belong to the
/// surface, and whoever flips it decides. Cost: O(corners).
///
/// # Errors
/// None for a valid mesh.
pub fn flip_faces(mesh: &Mesh) -> Result<Mesh, GeometryError> {
    let topology = mesh.topology();
    // Corner k > 0 comes from corner n - k, the edge that leaves it from the
    // corner before that one.
    let mut from_corner = Vec::with_capacity(mesh.corner_count());
    let mut from_edge = Vec::with_capacity(mesh.corner_count());
    for face in 0..mesh.face_count() {
        let range = topology.corner_range(face);
        let (start, end) = (range.start as u32, range.end as u32);
        from_corner.push(start);
        from_corner.extend((start + 1..end).rev());
        from_edge.extend((start..end).rev());
    }
    let corners = from_corner
        .iter()
        .map(|&corner| topology.corners()[corner as usize]);
    let turned = Topology::new(
        mesh.vertex_count(),
        topology.offsets().to_vec(),
        corners.collect(),
    )?;
    let gather = |attribute: &Attribute| match attribute.domain() {
        Domain::Corner if attribute.is_on_edges() => attribute.values().gather(&from_edge),
        Domain::Corner => attribute.values().gather(&from_corner),
        _ => attribute.values().clone(),
    };
    let flipped = Mesh::new(mesh.positions().to_vec(), Arc::new(turned))?
        .with_materials(mesh.materials().clone())?
        .with_groups(mesh.groups().clone())?
        .with_objects(mesh.objects().clone())?;
    mesh.attributes()
        .iter()
        .try_fold(flipped, |flipped, attribute| {
            flipped.with_attribute(attribute.with_values(gather(attribute)))
        })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::Unmonitored;
    use crate::math::PI;
    use crate::measure::measure_mesh;
    use crate::normals::face_normals;
    use crate::primitives::cuboid;
    use crate::subdivide::CREASE;
    use crate::subdivide::{Options, subdivide};

    fn brick() -> Mesh {
        let mesh = cuboid(DVec3::new(1.0, 2.0, 3.0), [1, 2, 2], false).expect("valid");
        with_normals(&mesh)
    }

    fn with_normals(mesh: &Mesh) -> Mesh {
        let normals = face_normals(mesh, &Unmonitored).expect("not cancelled");
        let values = AttributeValues::Vector3(normals.into());
        let attribute = Attribute::new(NORMAL, Domain::Face, values);
        mesh.clone()
            .with_attribute(attribute)
            .expect("one per face")
    }

    fn normals(mesh: &Mesh) -> &[DVec3] {
        match mesh.attribute(NORMAL, Domain::Face).map(|a| a.values()) {
            Some(AttributeValues::Vector3(values)) => values,
            other => panic!("normals are {other:?}"),
        }
    }

    #[test]
    fn rotations_turn_the_known_way() {
        let quarter = rotation_about(DVec3::Z * 5.0, PI / 2.0).expect("valid");
        assert!((quarter * DVec3::X - DVec3::Y).length() < 1e-15);
        // x by 90 degrees takes y to z, then z by 90 degrees leaves it there.
        let both = rotation_by(DVec3::new(PI / 2.0, 0.0, PI / 2.0)).expect("valid");
        assert!((both * DVec3::Y - DVec3::Z).length() < 1e-15);
        assert!((both * DVec3::X - DVec3::Y).length() < 1e-15);
    }

    #[test]
    fn a_placement_keeps_its_pivot() {
        let pivot = DVec3::new(1.0, 2.0, 3.0);
        let turn = rotation_by(DVec3::new(0.3, 0.7, -1.1)).expect("valid");
        let map = placement(DVec3::new(2.0, 3.0, 0.5), turn, pivot, DVec3::X);
        assert!((map.transform_point3(pivot) - pivot - DVec3::X).length() < 1e-14);
    }

    #[test]
    fn a_mirror_keeps_corner_0_and_outside() {
        let mesh = brick();
        let mirrored = transform(
            &mesh,
            DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)),
            &Unmonitored,
        );
        let mirrored = mirrored.expect("finite");
        for face in 0..mesh.face_count() {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| mesh.face(face)[k]);
            assert_eq!(mirrored.face(face), [a, d, c, b]);
        }
        assert!((measure_mesh(&mirrored).volume.expect("closed") - 6.0).abs() < 1e-14);
        assert_eq!(normals(&mirrored), normals(&with_normals(&mirrored)));
        assert_eq!(mirrored.materials(), mesh.materials());
    }

    #[test]
    fn corner_values_and_creases_follow_a_flip() {
        let mesh = brick();
        // One edge of the bottom is sharp; both corners that leave it say so.
        let adjacency = mesh.topology().adjacency();
        let mut sharp = vec![0.0; mesh.corner_count()];
        for &corner in adjacency.edge_corners(3) {
            sharp[corner as usize] = 7.0;
        }
        let ids: Vec<f64> = mesh
            .topology()
            .corners()
            .iter()
            .map(|&v| f64::from(v))
            .collect();
        let mesh = [(CREASE, sharp), ("id", ids)]
            .into_iter()
            .fold(mesh, |mesh, (name, values)| {
                let values = AttributeValues::Number(values.into());
                let attribute = Attribute::new(name, Domain::Corner, values);
                mesh.with_attribute(attribute).expect("one per corner")
            });
        let flipped = flip_faces(&mesh).expect("valid");
        let values =
            |mesh: &Mesh, name| match mesh.attribute(name, Domain::Corner).map(|a| a.values()) {
                Some(AttributeValues::Number(values)) => values.to_vec(),
                other => panic!("{name} is {other:?}"),
            };
        let vertices = flipped.topology().corners().iter().map(|&v| f64::from(v));
        assert!(vertices.eq(values(&flipped, "id")));
        let sharp_edges = |mesh: &Mesh| {
            let creases = values(mesh, CREASE);
            let adjacency = mesh.topology().adjacency();
            let mut edges: Vec<_> = (0..adjacency.edge_count())
                .filter(|&e| {
                    adjacency
                        .edge_corners(e)
                        .iter()
                        .all(|&c| creases[c as usize] > 0.0)
                })
                .map(|e| adjacency.edge(e))
                .collect();
            edges.iter_mut().for_each(|edge| edge.sort_unstable());
            edges
        };
        assert_eq!(sharp_edges(&flipped), sharp_edges(&mesh));
        assert_eq!(sharp_edges(&mesh).len(), 1);
        // And so does the shape it subdivides to.
        let options = Options {
            levels: 2,
            ..Options::default()
        };
        let fine = |mesh: &Mesh| subdivide(mesh, options, &Unmonitored).expect("valid").mesh;
        let bounds = (fine(&mesh).bounds(), fine(&flipped).bounds());
        assert_eq!(bounds.0, bounds.1);
    }

    #[test]
    fn flipping_twice_changes_nothing() {
        let mesh = brick();
        let twice = flip_faces(&flip_faces(&mesh).expect("valid")).expect("valid");
        assert_eq!(twice.digest(), mesh.digest());
    }

    #[test]
    fn flattening_gives_no_nan() {
        let flat = transform(
            &brick(),
            DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0)),
            &Unmonitored,
        );
        let flat = flat.expect("finite");
        assert!(normals(&flat).iter().all(|n| n.is_finite()));
        let bottom = normals(&flat)[0];
        assert_eq!(bottom, -DVec3::Z);
        let nothing =
            transform(&brick(), DAffine3::from_scale(DVec3::ZERO), &Unmonitored).expect("finite");
        assert!(normals(&nothing).iter().all(|&n| n == DVec3::ZERO));
    }

    #[test]
    fn maps_that_are_not_finite_are_refused() {
        let huge = transform(
            &brick(),
            DAffine3::from_scale(DVec3::splat(1e308)),
            &Unmonitored,
        );
        assert!(matches!(huge, Err(GeometryError::NonFiniteVertex { .. })));
        assert!(rotation_about(DVec3::ZERO, 1.0).is_err());
        assert!(rotation_by(DVec3::new(0.0, f64::NAN, 0.0)).is_err());
    }

    proptest! {
        #[test]
        fn motions_keep_sizes_and_scales_scale_them(
            angles in prop::array::uniform3(-7.0..7.0f64),
            shift in prop::array::uniform3(-1e3..1e3f64),
            scale in prop::array::uniform3(prop_oneof![-3.0..-0.1f64, 0.1..3.0f64]),
        ) {
            let turn = rotation_by(angles.into()).expect("finite");
            let map = placement(scale.into(), turn, DVec3::ONE, shift.into());
            let moved = transform(&brick(), map, &Unmonitored).expect("finite");
            let volume = measure_mesh(&moved).volume.expect("closed");
            let expected = 6.0 * (scale[0] * scale[1] * scale[2]).abs();
            prop_assert!((volume / expected - 1.0).abs() < 1e-9, "{} {}", volume, expected);
            // Normals that were carried are those of the carried faces.
            for (a, b) in normals(&moved).iter().zip(normals(&with_normals(&moved))) {
                prop_assert!(a.distance(*b) < 1e-9);
            }
        }

        #[test]
        fn axis_and_angle_turn_in_the_plane_across(
            axis in prop::array::uniform3(-1.0..1.0f64),
            angle in -10.0..10.0f64,
        ) {
            let axis = DVec3::from(axis);
            prop_assume!(axis.length() > 1e-3);
            let turn = rotation_about(axis, angle).expect("valid");
            prop_assert!((turn * axis - axis).length() < 1e-14);
            prop_assert!((turn.determinant() - 1.0).abs() < 1e-14);
            let trace = turn.x_axis.x + turn.y_axis.y + turn.z_axis.z;
            prop_assert!((trace - 1.0 - 2.0 * cos(angle)).abs() < 1e-14);
        }
    }
}
