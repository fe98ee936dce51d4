//! Tests of dual meshes: counts, Euler numbers, what is carried.

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::Unmonitored;
use crate::measure::{MeshMeasures, measure_mesh};
use crate::mesh::Material;
use crate::subdivide::CREASE;
use crate::test_shapes::{cylinder, sphere};
use crate::test_support::{assert_closed, cuboid, euler, grid, torus};
use crate::{Labels, primitives};

fn made(mesh: &Mesh, border: DualBorder) -> Mesh {
    let dual = dual(mesh, border).unwrap();
    assert!(dual.skipped.is_empty());
    dual.mesh
}

fn sources(mesh: &Mesh) -> Vec<i64> {
    match mesh
        .attribute(SOURCE_VERTEX, Domain::Face)
        .unwrap()
        .values()
    {
        AttributeValues::Integer(values) => values.to_vec(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_cube_becomes_an_octahedron_and_back() {
    let cube = cuboid(2.0, 2.0, 0.0, 2.0);
    let octahedron = made(&cube, DualBorder::Open);
    assert_closed(&octahedron);
    assert_eq!((octahedron.vertex_count(), octahedron.face_count()), (6, 8));
    // Vertices are the centres of the faces, one from the middle of the cube each.
    let middle = DVec3::ONE;
    assert!(
        octahedron
            .positions()
            .iter()
            .all(|p| (p.distance(middle) - 1.0).abs() < 1e-15)
    );
    let volume = measure_mesh(&octahedron).volume.unwrap();
    assert!((volume - 4.0 / 3.0).abs() < 1e-14, "{volume}");
    let back = made(&octahedron, DualBorder::Open);
    let volume = measure_mesh(&back).volume.unwrap();
    assert!((volume - 8.0 / 27.0).abs() < 1e-14, "{volume}");
    assert_eq!(sources(&octahedron), [0, 1, 2, 3, 4, 5, 6, 7]);
}

#[test]
fn a_closed_border_keeps_the_outline() {
    let plate = grid(3, 2, |x, y| [x, y, 0.0]);
    let closed = made(&plate, DualBorder::Closed);
    // 12 vertices give faces; centres, border middles and border vertices remain.
    assert_eq!(
        (closed.face_count(), closed.vertex_count()),
        (12, 6 + 10 + 10)
    );
    let found = measure_mesh(&closed);
    assert_eq!(
        (found.boundary_loops, found.euler, found.nonmanifold_edges),
        (1, 1, 0)
    );
    assert!((found.area - 6.0).abs() < 1e-14);
    assert_eq!(found.inconsistent_edges, 0);
    // A corner of the plate is a quad, an edge vertex a pentagon, inside stay quads.
    let sides: Vec<usize> = closed.topology().faces().map(<[u32]>::len).collect();
    assert_eq!(sides, [4, 5, 5, 4, 5, 4, 4, 5, 4, 5, 5, 4]);
    assert!(
        crate::normals::face_normals(&closed, &Unmonitored)
            .unwrap()
            .iter()
            .all(|n| n.z > 0.99)
    );
    let open = made(&plate, DualBorder::Open);
    assert_eq!((open.face_count(), open.vertex_count()), (2, 6));
    assert!((measure_mesh(&open).area - 2.0).abs() < 1e-14);
    assert_eq!(sources(&open), [5, 6]);
    assert_eq!(
        made(&grid(1, 1, |x, y| [x, y, 0.0]), DualBorder::Open).vertex_count(),
        0
    );
}

#[test]
fn triangles_become_hexagons_of_their_valence() {
    let ring = torus(8, 6, 3.0, 1.0);
    let triangles =
        super::super::triangulate_faces(&ring, &[true; 48], super::super::PieceOrder::Together);
    let hexagons = made(&triangles.unwrap(), DualBorder::Open);
    assert!(hexagons.topology().faces().all(|face| face.len() == 6));
    assert_eq!(euler(&hexagons), 0);
}

#[test]
fn sheets_that_touch_in_a_point_get_a_face_each() {
    let places = [(0., 0.), (1., 0.), (0., 1.), (-1., 0.), (0., -1.)].map(|(x, y)| [x, y, 0.0]);
    let mesh = Mesh::from_faces(places.to_vec(), &[[0, 1, 2], [0, 3, 4]]).unwrap();
    let closed = made(&mesh, DualBorder::Closed);
    assert_eq!(sources(&closed), [0, 0, 1, 2, 3, 4]);
    assert!((measure_mesh(&closed).area - 1.0).abs() < 1e-15);
}

#[test]
fn what_cannot_be_is_named() {
    let pillow = Mesh::from_faces(
        vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]],
        &[[0, 1, 2], [2, 1, 0]],
    );
    let found = dual(&pillow.unwrap(), DualBorder::Closed).unwrap();
    assert_eq!((found.mesh.face_count(), found.skipped), (0, vec![0, 1, 2]));
    let places: Vec<[f64; 3]> = (0..5)
        .map(|k| [f64::from(k), f64::from(k * k), 0.0])
        .collect();
    let fin = Mesh::from_faces(places, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]).unwrap();
    let error = dual(&fin, DualBorder::Closed).unwrap_err();
    assert_eq!(
        error.to_string(),
        "1 edge with more than two faces: 0-1 (3 faces)"
    );
}

#[test]
fn values_are_interpolated_and_labels_come_from_the_lowest_face() {
    let plate = grid(2, 2, |x, y| [x, y, 0.0]);
    let number = |values: Vec<f64>| AttributeValues::Number(values.into());
    let of = |p: &DVec3| p.x + 10.0 * p.y;
    let corners = plate.topology().corners().iter();
    let at_corners = corners
        .map(|&v| of(&plate.positions()[v as usize]))
        .collect();
    let at_vertices = plate.positions().iter().map(of).collect();
    let names = (0..4).map(|k| Material::named(format!("{k}"))).collect();
    let creases = vec![2.0; 16];
    let mesh = plate
        .with_attribute(Attribute::new("a", Domain::Vertex, number(at_vertices)))
        .and_then(|m| m.with_attribute(Attribute::new("b", Domain::Corner, number(at_corners))))
        .and_then(|m| m.with_attribute(Attribute::new(CREASE, Domain::Corner, number(creases))))
        .and_then(|m| m.with_materials(Labels::new(names, vec![0, 1, 2, 3])?))
        .unwrap();
    let out = made(&mesh, DualBorder::Closed);
    let values = |name, domain| match out.attribute(name, domain).unwrap().values() {
        AttributeValues::Number(values) => values.to_vec(),
        other => panic!("{other:?}"),
    };
    for (place, value) in out.positions().iter().zip(values("a", Domain::Vertex)) {
        assert!((of(place) - value).abs() < 1e-14);
    }
    for (&vertex, value) in out
        .topology()
        .corners()
        .iter()
        .zip(values("b", Domain::Corner))
    {
        assert!((of(&out.positions()[vertex as usize]) - value).abs() < 1e-14);
    }
    let adjacency = out.topology().adjacency();
    let creases = values(CREASE, Domain::Corner);
    for edge in 0..adjacency.edge_count() {
        for &corner in adjacency.edge_corners(edge) {
            let wanted = if adjacency.is_boundary_edge(edge) {
                2.0
            } else {
                0.0
            };
            assert!((creases[corner as usize] - wanted).abs() < 1e-15);
        }
    }
    let labels: Vec<_> = (0..9)
        .map(|f| out.materials().get(f).unwrap().name.clone())
        .collect();
    assert_eq!(labels, ["0", "0", "1", "0", "0", "1", "2", "2", "3"]);
}

fn check(mesh: &Mesh) {
    let before = measure_mesh(mesh);
    let first = made(mesh, DualBorder::Closed);
    let counts = |m: &MeshMeasures| {
        (
            m.components,
            m.boundary_loops,
            m.nonmanifold_edges,
            m.inconsistent_edges,
            m.euler,
        )
    };
    assert_eq!(counts(&measure_mesh(&first)), counts(&before));
    if before.boundary_edges > 0 {
        return;
    }
    assert_eq!(first.vertex_count(), mesh.face_count());
    assert_eq!(first.face_count(), mesh.vertex_count());
    let adjacency = mesh.topology().adjacency();
    for (vertex, face) in first.topology().faces().enumerate() {
        assert_eq!(face.len(), adjacency.vertex_edges(vertex).len());
    }
    let second = made(&first, DualBorder::Closed);
    assert_eq!(
        (second.vertex_count(), second.face_count()),
        (mesh.vertex_count(), mesh.face_count())
    );
}

proptest! {
    #[test]
    fn duals_keep_the_euler_number_and_swap_counts(a in 3u32..9, b in 3u32..9) {
        check(&torus(a, b, 3.0, 1.0));
        check(&sphere(a, b));
        check(&cylinder(a, b));
        check(&grid(a, b, |x, y| [x, y, 0.1 * x * y]));
        check(&primitives::cuboid(DVec3::ONE, [a as usize, b as usize, 2], false).unwrap());
    }
}
