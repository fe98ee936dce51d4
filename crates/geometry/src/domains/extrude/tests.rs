//! Tests of extruded faces: volumes, counts, and what is carried.

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::measure::measure_mesh;
use crate::mesh::Material;
use crate::subdivide::CREASE;
use crate::test_support::{assert_closed, cuboid, grid, torus, volume};
use crate::{DirectionSource, Field, Labels, Quantity, Unmonitored};

fn options(mode: ExtrudeMode, height: f64) -> ExtrudeOptions<'static> {
    ExtrudeOptions {
        mode,
        height: Amount::Constant(height),
        directions: None,
        cap: true,
    }
}

fn all(mesh: &Mesh, options: &ExtrudeOptions<'_>) -> Mesh {
    extrude_faces(mesh, &vec![true; mesh.face_count()], options, &Unmonitored).unwrap()
}

fn parts(mesh: &Mesh) -> Vec<i64> {
    match mesh.attribute(PART, Domain::Face).unwrap().values() {
        AttributeValues::Integer(parts) => parts.to_vec(),
        other => panic!("{other:?}"),
    }
}

fn face_field(values: Vec<f64>) -> Amount {
    Amount::Field(std::sync::Arc::new(
        Field::new(Domain::Face, Quantity::Length, values).unwrap(),
    ))
}

#[test]
fn a_cube_has_closed_forms() {
    let cube = cuboid(1.0, 1.0, 0.0, 1.0);
    for h in [0.5, -0.25] {
        let each = all(&cube, &options(ExtrudeMode::Individual, h));
        assert_closed(&each);
        assert!((volume(&each) - (1.0 + 6.0 * h)).abs() < 1e-14);
        assert_eq!((each.vertex_count(), each.face_count()), (32, 30));
        assert_eq!(parts(&each)[..6], [0, 1, 1, 1, 1, 0]);
        // As one region there is no border left: the cube grows by h all round.
        let whole = all(&cube, &options(ExtrudeMode::Region, h));
        assert_closed(&whole);
        assert!((volume(&whole) - crate::math::pow(1.0 + 2.0 * h, 3.0)).abs() < 1e-13);
        assert_eq!((whole.vertex_count(), whole.face_count()), (8, 6));
    }
}

#[test]
fn a_region_has_walls_round_it_only() {
    let plate = grid(4, 3, |x, y| [x, y, 0.0]);
    let chosen: Vec<bool> = (0..12).map(|f| f % 4 < 2).collect();
    let out = extrude_faces(
        &plate,
        &chosen,
        &options(ExtrudeMode::Region, 2.0),
        &Unmonitored,
    );
    let out = out.unwrap();
    // 2 x 3 quads: a rim of 10 edges; 12 vertices moved, of which 2 had only moved faces.
    assert_eq!(parts(&out).iter().filter(|part| **part == 1).count(), 10);
    assert_eq!(parts(&out).iter().filter(|part| **part == 2).count(), 6);
    assert_eq!(out.vertex_count(), 20 + 12 - 2);
    let high = out.positions().iter().filter(|p| p.z > 1.999).count();
    assert_eq!(high, 12);
    let found = measure_mesh(&out);
    assert_eq!(
        (
            found.components,
            found.boundary_loops,
            found.nonmanifold_edges,
            found.inconsistent_edges
        ),
        (1, 1, 0, 0)
    );
    assert!((found.area - (12.0 + 10.0 * 2.0)).abs() < 1e-12);
    // Without caps only walls and the faces that stayed are left.
    let open = ExtrudeOptions {
        cap: false,
        ..options(ExtrudeMode::Region, 2.0)
    };
    let open = extrude_faces(&plate, &chosen, &open, &Unmonitored).unwrap();
    assert_eq!((open.face_count(), open.vertex_count()), (16, 20 + 10 - 2));
}

#[test]
fn regions_that_touch_in_a_point_stay_apart() {
    let plate = grid(2, 2, |x, y| [x, y, 0.0]);
    let chosen = [true, false, false, true];
    for mode in [ExtrudeMode::Region, ExtrudeMode::Individual] {
        let out = extrude_faces(&plate, &chosen, &options(mode, 1.0), &Unmonitored).unwrap();
        assert_eq!((out.vertex_count(), out.face_count()), (9 + 8, 4 + 8));
        assert_eq!(measure_mesh(&out).nonmanifold_edges, 0);
    }
}

#[test]
fn heights_and_directions_may_vary() {
    let plate = grid(3, 1, |x, y| [x, y, 0.0]);
    let heights = options(ExtrudeMode::Individual, 0.0);
    let heights = ExtrudeOptions {
        height: face_field(vec![1.0, 0.0, -2.0]),
        ..heights
    };
    let out = all(&plate, &heights);
    // A face of height 0 stays as it is.
    assert_eq!(parts(&out), [0, 1, 1, 1, 1, 2, 0, 1, 1, 1, 1]);
    let bounds = out.bounds().unwrap();
    assert_eq!((bounds.0.z, bounds.1.z), (-2.0, 1.0));
    let lean = vec![DVec3::new(0.5, 0.0, 1.0); 8];
    let directions = Directions::new(&plate, lean, DirectionSource::Surface).unwrap();
    for mode in [ExtrudeMode::Region, ExtrudeMode::Individual] {
        let along = ExtrudeOptions {
            directions: Some(&directions),
            ..options(mode, 2.0)
        };
        let out = all(&plate, &along);
        assert_eq!(out.bounds().unwrap().1, DVec3::new(4.0, 1.0, 2.0));
    }
    let none = Directions::new(&plate, vec![DVec3::ZERO; 8], DirectionSource::Surface).unwrap();
    let along = ExtrudeOptions {
        directions: Some(&none),
        ..options(ExtrudeMode::Region, 2.0)
    };
    let error = extrude_faces(&plate, &[true, false, false], &along, &Unmonitored);
    let vertices = vec![0, 1, 4, 5];
    assert_eq!(
        error.unwrap_err(),
        GeometryError::ZeroDirection { vertices }
    );
}

#[test]
fn faces_without_a_normal_are_named() {
    let places = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [2., 0., 0.]];
    let mesh = Mesh::from_faces(places, &[[0, 1, 2], [0, 1, 3]]).unwrap();
    let run = |mode| extrude_faces(&mesh, &[true; 2], &options(mode, 1.0), &Unmonitored);
    let error = run(ExtrudeMode::Individual).unwrap_err();
    assert_eq!(error, GeometryError::NoArea { faces: vec![1] });
    assert_eq!(
        error.to_string(),
        "face 1 has no area, so there is no normal"
    );
    assert!(matches!(
        run(ExtrudeMode::Region),
        Err(GeometryError::Invalid(_))
    ));
    let bad = ExtrudeOptions {
        height: Amount::Constant(f64::NAN),
        ..options(ExtrudeMode::Region, 1.0)
    };
    let error = extrude_faces(&mesh, &[true; 2], &bad, &Unmonitored);
    assert!(matches!(error, Err(GeometryError::OutOfRange { .. })));
}

#[test]
fn walls_take_what_their_face_has_and_creases_stay_on_both_ends() {
    let plate = grid(2, 1, |x, y| [x, y, 0.0]);
    let edges = plate.topology().adjacency().corner_edges();
    let creases: Vec<f64> = edges.iter().map(|&edge| f64::from(edge) + 1.0).collect();
    let heights: Vec<f64> = plate.positions().iter().map(|p| p.x).collect();
    let number = |values: Vec<f64>| AttributeValues::Number(values.into());
    let mesh = plate
        .with_attribute(Attribute::new(CREASE, Domain::Corner, number(creases)))
        .and_then(|m| m.with_attribute(Attribute::new("x", Domain::Vertex, number(heights))))
        .and_then(|m| {
            let names = vec![Material::named("glass"), Material::named("steel")];
            m.with_materials(Labels::new(names, vec![1, 0])?)
        })
        .unwrap();
    let out = extrude_faces(
        &mesh,
        &[true, false],
        &options(ExtrudeMode::Region, 1.0),
        &Unmonitored,
    );
    let out = out.unwrap();
    let names = |face: usize| out.materials().get(face).unwrap().name.as_str();
    assert_eq!(
        (0..6).map(names).collect::<Vec<_>>(),
        ["steel", "steel", "steel", "steel", "steel", "glass"]
    );
    let AttributeValues::Number(x) = out.attribute("x", Domain::Vertex).unwrap().values() else {
        panic!("numbers");
    };
    for (place, x) in out.positions().iter().zip(x.iter()) {
        assert!((place.x - x).abs() < 1e-15);
    }
    let AttributeValues::Number(creases) = out.attribute(CREASE, Domain::Corner).unwrap().values()
    else {
        panic!("numbers");
    };
    let adjacency = out.topology().adjacency();
    for edge in 0..adjacency.edge_count() {
        let [a, b] = adjacency.edge(edge).map(|v| out.positions()[v as usize]);
        let on = adjacency.edge_corners(edge);
        let first = creases[on[0] as usize];
        assert!(
            on.iter()
                .all(|&c| creases[c as usize].total_cmp(&first).is_eq())
        );
        assert_eq!(first > 0.0, (a.z - b.z).abs() < 0.5, "{a} {b}");
    }
}

proptest! {
    #[test]
    fn closed_surfaces_stay_closed_and_gain_their_prisms(
        chosen in prop::collection::vec(any::<bool>(), 6 * 5),
        height in -0.3f64..0.5,
        region: bool,
    ) {
        let ring = torus(6, 5, 3.0, 1.0);
        let before = measure_mesh(&ring);
        let mode = if region { ExtrudeMode::Region } else { ExtrudeMode::Individual };
        let out = extrude_faces(&ring, &chosen, &options(mode, height), &Unmonitored).unwrap();
        let found = measure_mesh(&out);
        prop_assert_eq!(found.boundary_edges, 0);
        prop_assert_eq!(found.nonmanifold_edges, 0);
        prop_assert_eq!(found.inconsistent_edges, 0);
        prop_assert!(out.positions().iter().all(|p| p.is_finite()));
        let count = chosen.iter().filter(|chosen| **chosen).count();
        if !region && height != 0.0 {
            prop_assert_eq!(out.face_count(), 30 + 4 * count);
            prop_assert_eq!(out.vertex_count(), 30 + 4 * count);
            prop_assert_eq!(found.euler, before.euler);
            // Faces of a torus in these proportions are flat: volumes are those of prisms.
            let areas = crate::normals::face_area_vectors(&ring, &Unmonitored).unwrap();
            let area: f64 = areas.iter().zip(&chosen).filter(|(_, c)| **c).map(|(a, _)| a.length() / 2.0).sum();
            let gain = found.volume.unwrap() - before.volume.unwrap();
            prop_assert!((gain - area * height).abs() < 1e-9, "{} {}", gain, area * height);
        }
    }
}
