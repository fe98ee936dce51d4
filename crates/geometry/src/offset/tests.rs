use proptest::prelude::*;

use super::*;
use crate::normals::{NormalWeights, vertex_normals};
use crate::test_support::{assert_closed, euler, grid, torus, volume};
use crate::{DirectionSource, Labels, Material, Unmonitored};

fn thicken(base: &Mesh, outward: f64, inward: f64) -> Result<Mesh, GeometryError> {
    let normals = vertex_normals(base, NormalWeights::Angle, true, &Unmonitored)?;
    let directions = Directions::new(base, normals, DirectionSource::Surface)?;
    offset_mesh(
        base,
        &directions,
        &outward.into(),
        &inward.into(),
        &Unmonitored,
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_flat_grid_becomes_a_plate(
        nx in 1u32..6, ny in 1u32..6, outward in 0.0..2.0f64, inward in 0.01..2.0f64,
    ) {
        let base = grid(nx, ny, |x, y| [2.0 * x, y, 5.0]);
        let plate = thicken(&base, outward, inward).unwrap();
        assert_closed(&plate);
        prop_assert_eq!(euler(&plate), 2);
        prop_assert_eq!(plate.vertex_count(), 2 * base.vertex_count());
        prop_assert_eq!(plate.face_count() as u32, 2 * nx * ny + 2 * (nx + ny));
        let expected = f64::from(2 * nx * ny) * (outward + inward);
        prop_assert!((volume(&plate) - expected).abs() < 1e-10 * expected.max(1.0));
    }
}

#[test]
fn a_closed_base_becomes_two_shells() {
    let base = torus(40, 24, 3.0, 1.0);
    let shell = thicken(&base, 0.2, 0.1).unwrap();
    assert_closed(&shell);
    assert_eq!(shell.face_count(), 2 * base.face_count());
    // Pappus between tubes of radius 1.2 and 0.9, less what polygons cut off.
    let exact = 2.0 * crate::math::PI * crate::math::PI * 3.0 * (1.2 * 1.2 - 0.9 * 0.9);
    let ratio = volume(&shell) / exact;
    assert!((0.97..1.0).contains(&ratio), "{ratio}");
}

#[test]
fn a_tube_has_two_borders_and_the_genus_of_a_torus() {
    let wrap = |v: u32| v % 12 + v / 12 * 12;
    let place = |k: u32| {
        let angle = crate::math::TAU * f64::from(k % 12) / 12.0;
        [
            crate::math::cos(angle),
            crate::math::sin(angle),
            f64::from(k / 12),
        ]
    };
    let faces: Vec<[u32; 4]> = (0..36)
        .map(|k| {
            let (i, j) = (k % 12, k / 12 * 12);
            [
                j + i,
                j + wrap(i + 1) % 12,
                j + 12 + wrap(i + 1) % 12,
                j + 12 + i,
            ]
        })
        .collect();
    let tube = Mesh::from_faces((0..48).map(place).collect(), &faces).unwrap();
    let pipe = thicken(&tube, 0.1, 0.1).unwrap();
    assert_closed(&pipe);
    assert_eq!(euler(&pipe), 0);
}

#[test]
fn vertices_where_borders_meet_are_split() {
    let base = Mesh::from_faces(
        vec![
            [0., 0., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [0., 1., 0.],
            [2., 1., 0.],
            [2., 2., 0.],
            [1., 2., 0.],
        ],
        &[[0, 1, 2, 3], [2, 4, 5, 6]],
    )
    .unwrap();
    let plates = thicken(&base, 0.5, 0.0).unwrap();
    assert_closed(&plates);
    assert_eq!((plates.vertex_count(), euler(&plates)), (16, 4));
    assert!((volume(&plates) - 1.0).abs() < 1e-14);
}

#[test]
fn inward_zero_leaves_the_base_as_the_bottom() {
    let base = grid(2, 2, |x, y| [x, y, x * y * 0.1]);
    let shell = thicken(&base, 0.3, 0.0).unwrap();
    assert_eq!(shell.positions()[9..], base.positions()[..]);
}

#[test]
fn parts_and_labels_are_carried() {
    let materials = Labels::new(vec![Material::named("steel")], vec![u32::MAX, 0]).unwrap();
    let uv = AttributeValues::Integer((0..8).collect());
    let base = grid(2, 1, |x, y| [x, y, 0.0])
        .with_materials(materials)
        .and_then(|mesh| mesh.with_attribute(Attribute::new("corner", Domain::Corner, uv)))
        .unwrap();
    let shell = thicken(&base, 0.1, 0.1).unwrap();
    let values = |name: &str, domain| match shell.attribute(name, domain).unwrap().values() {
        AttributeValues::Integer(values) => values.to_vec(),
        other => panic!("{}", other.type_name()),
    };
    assert_eq!(values(PART, Domain::Face), [0, 0, 1, 1, 2, 2, 2, 2, 2, 2]);
    assert_eq!(values("corner", Domain::Corner)[8..12], [0, 3, 2, 1]);
    let steel: Vec<bool> = (0..10)
        .map(|f| shell.materials().get(f).is_some())
        .collect();
    assert_eq!(steel[..4], [false, true, false, true]);
    assert_eq!(steel[4..].iter().filter(|&&s| s).count(), 3);
}

#[test]
fn what_cannot_be_thickened_is_refused_by_name() {
    let base = grid(2, 1, |x, y| [x, y, 0.0]);
    for (outward, inward) in [
        (0.0, 0.0),
        (-0.1, 0.2),
        (0.1, f64::NAN),
        (f64::INFINITY, 0.0),
    ] {
        let refused = thicken(&base, outward, inward);
        assert!(
            matches!(refused, Err(GeometryError::OutOfRange { .. })),
            "{outward} {inward}"
        );
    }
    let places = || base.positions().iter().map(|p| p.to_array()).collect();
    let flipped = Mesh::from_faces(places(), &[[0, 1, 4, 3], [4, 5, 2, 1]]).unwrap();
    let error = thicken(&flipped, 0.1, 0.0).unwrap_err().to_string();
    assert!(
        error.contains("faces 0 and 1") && error.contains("1-4"),
        "{error}"
    );
    let book = Mesh::from_faces(places(), &[[0, 1, 4, 3], [1, 2, 5, 4], [1, 4, 3, 0]]).unwrap();
    let refused = thicken(&book, 0.1, 0.0);
    assert!(matches!(refused, Err(GeometryError::NonManifold { .. })));
}
