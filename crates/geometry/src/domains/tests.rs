//! Tests of how faces are cut, turned and flipped.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::mesh::{Attribute, AttributeValues, Material};
use crate::normals::face_area_vectors;
use crate::subdivide::CREASE;
use crate::test_support::peer_case;
use crate::{Field, Labels, Quantity, Unmonitored};

fn faces(mesh: &Mesh) -> Vec<Vec<u32>> {
    mesh.topology().faces().map(<[u32]>::to_vec).collect()
}

/// A flat regular polygon of n corners and a triangle on its first edge, with
/// the values x + 2 y on vertices and corners, creases and a material.
fn marked(n: u32) -> Mesh {
    use crate::math::{TAU, cos, sin};
    let angle = |k: u32| TAU * f64::from(k) / f64::from(n);
    let mut places: Vec<[f64; 3]> = (0..n)
        .map(|k| [cos(angle(k)), sin(angle(k)), 0.0])
        .collect();
    places.push([3.0, -1.0, 0.0]);
    let ring: Vec<u32> = (0..n).collect();
    let mesh = Mesh::from_faces(places, &[ring, vec![1, 0, n]]).unwrap();
    let value = |v: u32| {
        let p = mesh.positions()[v as usize];
        p.x + 2.0 * p.y
    };
    let at_vertices = (0..=n).map(value).collect();
    let at_corners = mesh
        .topology()
        .corners()
        .iter()
        .map(|&v| value(v))
        .collect();
    let edges = mesh.topology().adjacency().corner_edges();
    let creases = edges.iter().map(|&edge| f64::from(edge) + 1.0).collect();
    let number = AttributeValues::Number;
    mesh.clone()
        .with_attribute(Attribute::new("a", Domain::Vertex, number(at_vertices)))
        .and_then(|m| m.with_attribute(Attribute::new("b", Domain::Corner, number(at_corners))))
        .and_then(|m| m.with_attribute(Attribute::new(CREASE, Domain::Corner, number(creases))))
        .and_then(|m| {
            let names = vec![Material::named("stone"), Material::named("glass")];
            m.with_materials(Labels::new(names, vec![1, 0])?)
        })
        .unwrap()
}

fn numbers(mesh: &Mesh, name: &str, domain: Domain) -> Vec<f64> {
    match mesh.attribute(name, domain).map(Attribute::values) {
        Some(AttributeValues::Number(values)) => values.to_vec(),
        other => panic!("{other:?}"),
    }
}

/// Checks what every operation must keep: area vectors, the linear field on
/// vertices and corners, materials by place, and every crease on its edge.
fn check_carried(out: &Mesh, flipped: bool) {
    let here = |v: u32| {
        let p = out.positions()[v as usize];
        p.x + 2.0 * p.y
    };
    for (vertex, value) in (0u32..).zip(numbers(out, "a", Domain::Vertex)) {
        assert!(
            (value - here(vertex)).abs() < 1e-12,
            "{vertex}: {value} {}",
            here(vertex)
        );
    }
    let corners = out.topology().corners();
    for (&vertex, value) in corners.iter().zip(numbers(out, "b", Domain::Corner)) {
        assert!(
            (value - here(vertex)).abs() < 1e-12,
            "{vertex}: {value} {}",
            here(vertex)
        );
    }
    let total: DVec3 = face_area_vectors(out, &Unmonitored).unwrap().iter().sum();
    let input = marked(old_polygon(out));
    let before: DVec3 = face_area_vectors(&input, &Unmonitored)
        .unwrap()
        .iter()
        .sum();
    let before = if flipped { -before } else { before };
    assert!((total - before).length() < 1e-12);
    let crease_of = |mesh: &Mesh| {
        let values = numbers(mesh, CREASE, Domain::Corner);
        let adjacency = mesh.topology().adjacency();
        let mut of: Vec<_> = (0..adjacency.edge_count())
            .map(|edge| {
                let [a, b] = adjacency.edge(edge);
                let on = adjacency.edge_corners(edge);
                assert!(on.iter().all(|&c| {
                    values[c as usize]
                        .total_cmp(&values[on[0] as usize])
                        .is_eq()
                }));
                ((a.min(b), a.max(b)), values[on[0] as usize])
            })
            .filter(|(_, value)| *value != 0.0)
            .collect();
        of.sort_by_key(|(edge, _)| *edge);
        of
    };
    assert_eq!(crease_of(out), crease_of(&input));
}

/// Of the polygon that `marked` made: its corners, from the triangle's apex.
fn old_polygon(mesh: &Mesh) -> u32 {
    let apex = DVec3::new(3.0, -1.0, 0.0);
    mesh.positions().iter().position(|p| *p == apex).unwrap() as u32
}

#[test]
fn pieces_carry_values_creases_and_area() {
    for n in 3..10 {
        let mesh = marked(n);
        for order in [PieceOrder::Together, PieceOrder::Appended] {
            let fan = fan_faces(&mesh, &[true, true], order).unwrap();
            assert_eq!(fan.face_count(), n as usize + 3);
            check_carried(&fan, false);
            let triangles = triangulate_faces(&mesh, &[true, true], order).unwrap();
            assert_eq!(triangles.face_count(), n as usize - 1);
            check_carried(&triangles, false);
            let half = fan_faces(&mesh, &[false, true], order).unwrap();
            assert_eq!(half.face_count(), 4);
            check_carried(&half, false);
        }
        let split = split_into_quads(&mesh).unwrap();
        assert!(split.folded.is_empty());
        assert!(split.mesh.topology().faces().all(|face| face.len() < 5));
        check_carried(&split.mesh, false);
        let turned = rotate_faces(&mesh, &[2, -1]).unwrap();
        check_carried(&turned, false);
        assert_eq!(turned.materials(), mesh.materials());
        let flipped = flip_chosen_faces(&mesh, &[true, true]).unwrap();
        check_carried(&flipped, true);
        assert_eq!(
            faces(&flipped),
            faces(&crate::transform::flip_faces(&mesh).unwrap())
        );
        let back = flip_chosen_faces(&flipped, &[true, true]).unwrap();
        assert_eq!(back.digest(), mesh.digest());
    }
}

#[test]
fn quads_split_in_the_order_of_the_add_on() {
    let quads = Mesh::from_faces(
        vec![
            [0., 0., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [0., 1., 0.],
            [2., 0., 0.],
            [2., 1., 0.],
        ],
        &[&[0, 1, 2, 3], &[1, 4, 5, 2]],
    )
    .unwrap();
    let split = triangulate_faces(&quads, &[true, true], PieceOrder::Appended).unwrap();
    assert_eq!(faces(&split), [[0, 2, 3], [1, 5, 2], [0, 1, 2], [1, 4, 5]]);
    let fan = fan_faces(&quads, &[true, true], PieceOrder::Appended).unwrap();
    assert_eq!(faces(&fan)[..3], [[0, 1, 6], [1, 4, 7], [1, 2, 6]]);
    let sources = fan.attribute(SOURCE_FACE, Domain::Face).unwrap().values();
    let expected = vec![0, 1, 0, 0, 0, 1, 1, 1];
    assert_eq!(*sources, AttributeValues::Integer(expected.into()));
}

#[test]
fn a_polygon_whose_strip_leaves_it_is_named() {
    // An arrow head: the strip's first quad reaches outside.
    let arrow = Mesh::from_faces(
        vec![
            [0., 0., 0.],
            [4., -3., 0.],
            [0., 4., 0.],
            [-4., -3., 0.],
            [-0.1, 0., 0.],
        ],
        &[&[0, 1, 2, 3, 4], &[0, 2, 3, 4, 1]],
    )
    .unwrap();
    let split = split_into_quads(&arrow).unwrap();
    assert!(!split.folded.is_empty());
    let same = triangulate_faces(&arrow, &[true, false], PieceOrder::Together).unwrap();
    let areas = face_area_vectors(&same, &Unmonitored).unwrap();
    assert!(areas[..3].iter().all(|area| area.z > 0.0));
}

/// Domains the add-on really used: `base_cells.obj` of its cases.
#[test]
fn domains_of_the_add_on() {
    type Convert = fn(&Mesh) -> Mesh;
    let cases: [(&str, Convert); 2] = [
        ("12_fan_hex", |mesh| {
            fan_faces(mesh, &vec![true; mesh.face_count()], PieceOrder::Appended).unwrap()
        }),
        ("16_quad_on_ngons", |mesh| {
            split_into_quads(mesh).unwrap().mesh
        }),
    ];
    for (name, convert) in cases {
        let Some(case) = peer_case(name) else { return };
        let (ours, theirs) = (convert(&case.mesh("base")), case.mesh("base_cells"));
        // Blender lists the first face it replaces after the others.
        let sorted = |mesh: &Mesh| {
            let mut faces = faces(mesh);
            faces.sort();
            faces
        };
        assert_eq!(sorted(&ours), sorted(&theirs), "{name}");
        for (a, b) in ours.positions().iter().zip(theirs.positions().iter()) {
            assert!(a.distance(*b) < 3e-6, "{name}: {a} {b}");
        }
    }
}

#[test]
fn turns_follow_uv_and_gradients() {
    let quad = Mesh::from_faces(
        vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
        &[&[0, 1, 2, 3], &[1, 2, 3, 0], &[2, 3, 0, 1], &[3, 0, 1, 2]],
    )
    .unwrap();
    let corners = quad.topology().corners();
    let uv: Vec<DVec2> = corners
        .iter()
        .map(|&v| quad.positions()[v as usize].truncate())
        .collect();
    let by_uv = rotate_faces(&quad, &turns_by_uv(&quad, &uv).unwrap()).unwrap();
    assert!(by_uv.topology().faces().all(|face| face == [0, 1, 2, 3]));
    let y = vec![0.0, 0.1, 1.0, 0.9];
    let field = Field::new(Domain::Vertex, Quantity::Number, y).unwrap();
    for along in [Along::Edges, Along::Diagonals] {
        let turns = turns_along_gradient(&quad, &field, along, false).unwrap();
        let up = rotate_faces(&quad, &turns).unwrap();
        assert!(up.topology().faces().all(|face| face == [0, 1, 2, 3]));
        let turns = turns_along_gradient(&quad, &field, along, true).unwrap();
        let down = rotate_faces(&quad, &turns).unwrap();
        assert!(down.topology().faces().all(|face| face == [2, 3, 0, 1]));
    }
    let level = Field::new(Domain::Vertex, Quantity::Number, vec![3.0; 4]).unwrap();
    let turns = turns_along_gradient(&quad, &level, Along::Edges, false).unwrap();
    assert_eq!(turns, [0; 4]);
}

#[test]
fn random_turns_use_every_turn_and_depend_on_the_seed() {
    let mesh = crate::test_support::grid(20, 20, |x, y| [x, y, 0.0]);
    let turns = turns_random(&mesh, 1);
    for turn in 0..4 {
        let share = turns.iter().filter(|&&t| t == turn).count();
        assert!((60..140).contains(&share), "{turn}: {share}");
    }
    assert_ne!(turns, turns_random(&mesh, 2));
}

proptest! {
    #[test]
    fn turning_adds_up(a in -9i64..9, b in -9i64..9, n in 3u32..8) {
        let mesh = marked(n);
        let twice = rotate_faces(&rotate_faces(&mesh, &[a, b]).unwrap(), &[b, a]).unwrap();
        let once = rotate_faces(&mesh, &[a + b, a + b]).unwrap();
        prop_assert_eq!(once.digest(), twice.digest());
        let round = rotate_faces(&mesh, &[i64::from(n), 3]).unwrap();
        prop_assert_eq!(round.digest(), mesh.digest());
    }
}

fn framed(mesh: &Mesh, options: &FrameOptions) -> Framed {
    frame_faces(mesh, &vec![true; mesh.face_count()], options, &Unmonitored).unwrap()
}

#[test]
fn frames_of_the_add_on() {
    let Some(case) = peer_case("13_frame_hex") else {
        return;
    };
    let options = FrameOptions {
        width: Amount::Constant(0.3),
        border: true,
        ..FrameOptions::default()
    };
    let (ours, theirs) = (
        framed(&case.mesh("base"), &options),
        case.mesh("base_cells"),
    );
    assert!(ours.overfull.is_empty());
    // The add-on starts its border loop elsewhere, so border vertices are matched
    // by place; everything inside has the same order.
    let (ours, rings) = (ours.mesh, 42);
    assert_eq!(faces(&ours)[rings..], faces(&theirs)[rings..]);
    let place = |mesh: &Mesh, v: u32| mesh.positions()[v as usize];
    for face in faces(&theirs) {
        let near = |other: &&Vec<u32>| {
            other
                .iter()
                .zip(&face)
                .all(|(&a, &b)| place(&ours, a).distance(place(&theirs, b)) < 3e-6)
        };
        assert!(faces(&ours).iter().any(|other| near(&other)), "{face:?}");
    }
}

#[test]
fn a_square_is_framed_at_every_inset() {
    let square = Mesh::from_faces(
        vec![[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.]],
        &[&[0, 1, 2, 3]],
    )
    .unwrap();
    for (inset, width, distance) in [
        (Inset::Constant, 0.25, 0.25),
        // 2 sqrt(4) / 4 = 1: the distance from centre to edge.
        (Inset::Relative, 0.25, 0.25),
        (Inset::Centre, 0.25, 0.25),
    ] {
        for (fill, extra) in [(Fill::Open, 0), (Fill::Fan, 4), (Fill::Polygon, 1)] {
            let options = FrameOptions {
                inset,
                width: Amount::Constant(width),
                fill,
                border: true,
                ..FrameOptions::default()
            };
            let mesh = framed(&square, &options).mesh;
            assert_eq!(mesh.face_count(), 8 + extra);
            let (low, high) = mesh.bounds().unwrap();
            assert!((low + DVec3::new(distance, distance, 0.0)).length() < 1e-12);
            assert!((high - DVec3::new(2.0 + distance, 2.0 + distance, 0.0)).length() < 1e-12);
            let inner = DVec3::new(distance, distance, 0.0);
            assert!((mesh.positions()[8] - inner).length() < 1e-12);
            let areas = face_area_vectors(&mesh, &Unmonitored).unwrap();
            assert!(areas.iter().all(|area| area.z > 0.0));
            let total: f64 = areas.iter().map(|area| area.z / 2.0).sum();
            let hole = if extra == 0 { 1.5f64 * 1.5 } else { 0.0 };
            assert!((total - (2.5 * 2.5 - hole)).abs() < 1e-12);
            let parts = mesh.attribute("part", Domain::Face).unwrap().values();
            let mut expected = vec![1; 4];
            expected.extend([0; 4]);
            expected.extend(vec![2; extra]);
            assert_eq!(*parts, AttributeValues::Integer(expected.into()));
        }
    }
}

#[test]
fn frames_carry_values_and_creases() {
    for n in 3..9 {
        for inset in [Inset::Constant, Inset::Relative, Inset::Centre] {
            let options = FrameOptions {
                inset,
                width: Amount::Constant(0.03),
                fill: Fill::Fan,
                ..FrameOptions::default()
            };
            let out = framed(&marked(n), &options);
            assert!(out.overfull.is_empty());
            check_carried(&out.mesh, false);
        }
    }
}

#[test]
fn edges_move_by_the_width_also_at_reflex_corners_and_on_triangles() {
    let shape = Mesh::from_faces(
        vec![
            [0., 0., 0.],
            [4., 0., 0.],
            [4., 4., 0.],
            [2., 1., 0.],
            [0., 4., 0.],
        ],
        &[&[0, 1, 2, 3, 4]],
    )
    .unwrap();
    let ours = framed(&shape, &FrameOptions::default()).mesh;
    for face in ours.topology().faces() {
        let at = |k: usize| ours.positions()[face[k] as usize];
        let along = (at(1) - at(0)).normalize();
        for k in [2, 3] {
            let distance = DVec3::Z.cross(along).dot(at(k) - at(0));
            assert!((distance - 0.2).abs() < 1e-12);
        }
    }
}

#[test]
fn too_wide_frames_are_named_and_kept_faces_stay() {
    let mesh = crate::test_support::grid(3, 1, |x, y| [x, y, 0.0]);
    let options = FrameOptions {
        width: Amount::Constant(0.6),
        ..FrameOptions::default()
    };
    let wide = frame_faces(&mesh, &[true, false, true], &options, &Unmonitored).unwrap();
    assert_eq!(wide.overfull, [0, 2]);
    assert_eq!(wide.mesh.face_count(), 9);
    let kept = FrameOptions {
        preserve_quads: true,
        ..options.clone()
    };
    assert_eq!(framed(&mesh, &kept).mesh.face_count(), 3);
    let bordered = FrameOptions {
        border: true,
        ..FrameOptions::default()
    };
    let some = frame_faces(&mesh, &[true, false, false], &bordered, &Unmonitored).unwrap();
    // Three border quads at face 0 with four outer vertices, its ring, two kept.
    assert_eq!((some.mesh.face_count(), some.mesh.vertex_count()), (9, 16));
    let bad = FrameOptions {
        width: Amount::Constant(-1.0),
        ..FrameOptions::default()
    };
    let found = frame_faces(&mesh, &[true; 3], &bad, &Unmonitored);
    assert!(matches!(
        found,
        Err(crate::GeometryError::OutOfRange { .. })
    ));
}

#[test]
fn widths_may_vary_over_vertices_and_faces() {
    let mesh = crate::test_support::grid(2, 1, |x, y| [x, y, 0.0]);
    let field = |domain, values| {
        let field = Field::new(domain, Quantity::Length, values).unwrap();
        FrameOptions {
            width: Amount::Field(std::sync::Arc::new(field)),
            ..FrameOptions::default()
        }
    };
    let by_face = framed(&mesh, &field(Domain::Face, vec![0.1, 0.3])).mesh;
    assert!((by_face.positions()[6] - DVec3::new(0.1, 0.1, 0.0)).length() < 1e-12);
    assert!((by_face.positions()[10] - DVec3::new(1.3, 0.3, 0.0)).length() < 1e-12);
    let by_vertex = framed(
        &mesh,
        &field(Domain::Vertex, vec![0.0, 0.2, 0.0, 0.0, 0.0, 0.0]),
    )
    .mesh;
    assert!((by_vertex.positions()[7] - DVec3::new(0.8, 0.2, 0.0)).length() < 1e-12);
    assert!((by_vertex.positions()[10] - DVec3::new(1.2, 0.2, 0.0)).length() < 1e-12);
}

#[test]
fn checkers_and_stripes_follow_the_quads() {
    let mesh = crate::test_support::grid(5, 4, |x, y| [x, y, 0.0]);
    // Turning faces must not matter but for the first, which sets the axes.
    let mut turns: Vec<i64> = (0..20).collect();
    turns[0] = 0;
    let mesh = rotate_faces(&mesh, &turns).unwrap();
    let cells = cells(&mesh);
    for (face, cell) in (0..).zip(cells) {
        assert_eq!(cell, [face % 5, face / 5]);
    }
    let sides = faces_within(&mesh, 0);
    assert_eq!(sides.iter().filter(|&&side| side).count(), 14);
    assert!(faces_within(&mesh, 1).iter().all(|&side| side));
}

#[test]
fn holes_are_capped_and_solids_close() {
    let tube = crate::test_shapes::cylinder(7, 2);
    for cap in [Cap::Polygon, Cap::Fan] {
        let options = CapOptions {
            cap,
            ..CapOptions::default()
        };
        let capped = cap_holes(&tube, &options).unwrap();
        assert_eq!(capped.caps, 2);
        let measured = crate::measure::measure_mesh(&capped.mesh);
        use crate::math::{TAU, sin};
        let volume = 2.0 * 3.5 * sin(TAU / 7.0);
        assert!((measured.volume.unwrap() - volume).abs() < 1e-12);
        let small = CapOptions {
            most_edges: Some(6),
            ..options
        };
        let none = cap_holes(&tube, &small).unwrap();
        assert_eq!((none.caps, none.larger), (0, 2));
    }
}

#[test]
fn caps_are_chosen_creased_and_coloured() {
    let tube = crate::test_shapes::cylinder(7, 2);
    let high = tube.positions().iter().map(|p| p.z - 1.0).collect();
    let field = Field::new(Domain::Vertex, Quantity::Number, high).unwrap();
    let options = CapOptions {
        only: Amount::Field(std::sync::Arc::new(field)),
        crease: 4.0,
        material: Some("lid"),
        ..CapOptions::default()
    };
    let capped = cap_holes(&tube, &options).unwrap();
    assert_eq!((capped.caps, capped.mesh.face_count()), (1, 15));
    let mesh = &capped.mesh;
    assert!(
        mesh.face(14)
            .iter()
            .all(|&v| mesh.positions()[v as usize].z > 1.9)
    );
    let named: Vec<_> = (0..15)
        .filter(|&face| mesh.materials().get(face).is_some())
        .collect();
    assert_eq!(
        (named, mesh.materials().get(14).unwrap().name.as_str()),
        (vec![14], "lid")
    );
    let creases = numbers(mesh, CREASE, Domain::Corner);
    assert!((creases.iter().sum::<f64>() - 7.0 * 2.0 * 4.0).abs() < 1e-12);
    let wrong = CapOptions {
        crease: f64::NAN,
        ..CapOptions::default()
    };
    assert!(cap_holes(&tube, &wrong).is_err());
}

#[test]
fn faces_go_with_the_vertices_only_they_use() {
    let mesh = marked(5);
    let kept = delete_faces(&mesh, &[true, false]).unwrap();
    assert_eq!((kept.vertex_count(), kept.face_count()), (3, 1));
    assert_eq!(kept.materials().get(0).unwrap().name, "stone");
}
