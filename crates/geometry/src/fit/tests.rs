#![expect(clippy::float_cmp, reason = "cuts and boxes are exact by construction")]

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::test_support::{cuboid, grid};
use crate::{Attribute, AttributeValues, Domain, Labels};

fn clip(mesh: &Mesh, x: Beyond, y: Beyond) -> Mesh {
    let options = FitOptions {
        fit: Fit::Unit,
        x,
        y,
        ..FitOptions::default()
    };
    fit_component(mesh, &options).unwrap()
}

fn area(mesh: &Mesh) -> f64 {
    let vectors = crate::normals::face_area_vectors(mesh, &crate::Unmonitored).unwrap();
    vectors.iter().map(|v| v.length() / 2.0).sum()
}

fn boundary_length(mesh: &Mesh) -> f64 {
    let loops = mesh.topology().boundary_loops();
    let place = |v: u32| mesh.positions()[v as usize];
    let length = |ring: &Vec<u32>| -> f64 {
        (0..ring.len())
            .map(|k| place(ring[k]).distance(place(ring[(k + 1) % ring.len()])))
            .sum()
    };
    loops.iter().map(length).sum()
}

#[test]
fn bounds_map_the_box_and_anchor_moves_it() {
    let part = cuboid(4.0, 2.0, 1.0, 3.0);
    for (anchor, low, high) in [
        (Anchor::Origin, 0.25, 0.75),
        (Anchor::Below, -0.5, 0.0),
        (Anchor::Centre, -0.25, 0.25),
        (Anchor::Above, 0.0, 0.5),
    ] {
        let options = FitOptions {
            height: Some(0.5),
            anchor,
            ..FitOptions::default()
        };
        let bounds = fit_component(&part, &options).unwrap().bounds().unwrap();
        assert_eq!(
            bounds,
            (DVec3::new(0.0, 0.0, low), DVec3::new(1.0, 1.0, high))
        );
    }
}

#[test]
fn flat_extents_go_to_the_middle() {
    let wall =
        Mesh::from_faces(vec![[7., 0., 0.], [7., 3., 0.], [7., 3., 1.]], &[[0, 1, 2]]).unwrap();
    let fitted = fit_component(&wall, &FitOptions::default()).unwrap();
    assert!(fitted.positions().iter().all(|p| p.x == 0.5));
    assert_eq!(component_frame(&wall, &Fit::Bounds).unwrap().area(), 0.0);
}

#[test]
fn a_cell_is_the_box_and_goes() {
    let base = cuboid(2.0, 2.0, 0.0, 1.0);
    let spike = [[3.0, 0.0, 5.0], [4.0, 0.0, 5.0], [3.0, 1.0, 5.0]];
    let positions = base
        .positions()
        .iter()
        .map(|p| p.to_array())
        .chain(spike)
        .collect();
    let mut faces: Vec<Vec<u32>> = base.topology().faces().map(<[u32]>::to_vec).collect();
    faces.push(vec![8, 9, 10]);
    let groups = Labels::new(
        vec![vec!["cell".to_owned()]],
        vec![0, 0, 0, 0, 0, 0, u32::MAX],
    );
    let mesh = Mesh::from_faces(positions, &faces)
        .unwrap()
        .with_groups(groups.unwrap())
        .unwrap();
    let fit = Fit::Cell {
        name: "cell".to_owned(),
    };
    let fitted = fit_component(
        &mesh,
        &FitOptions {
            fit,
            height: Some(0.1),
            ..FitOptions::default()
        },
    );
    let fitted = fitted.unwrap();
    assert_eq!((fitted.vertex_count(), fitted.face_count()), (3, 1));
    assert!((fitted.positions()[0] - DVec3::new(1.5, 0.0, 0.5)).length() < 1e-15);
}

#[test]
fn clipping_keeps_what_is_inside_and_stays_connected() {
    let sheet = grid(7, 5, |x, y| [x * 0.3 - 0.5, y * 0.4 - 0.6, x * 0.1]);
    let clipped = clip(&sheet, Beyond::Clip, Beyond::Clip);
    let (low, high) = clipped.bounds().unwrap();
    assert_eq!(
        (low.truncate(), high.truncate()),
        (glam::DVec2::ZERO, glam::DVec2::ONE)
    );
    // The sheet climbs 1 in 3.
    let slope = (1.0f64 + 1.0 / 9.0).sqrt();
    assert!((area(&clipped) - slope).abs() < 1e-12);
    assert_eq!(clipped.topology().boundary_loops().len(), 1);
    assert!((boundary_length(&clipped) - 2.0 - 2.0 * slope).abs() < 1e-12);
}

#[test]
fn cyclic_parts_come_in_again_at_the_other_side() {
    let tile = grid(1, 1, |x, y| [x + 0.25, y - 1.5, 0.0]);
    let wrapped = clip(&tile, Beyond::Cyclic, Beyond::Cyclic);
    assert_eq!(wrapped.face_count(), 4);
    // Four corners, and two vertices for each of four cuts on the rim, one of
    // each line, and four where the lines cross.
    assert_eq!(wrapped.vertex_count(), 16);
    let (low, high) = wrapped.bounds().unwrap();
    assert_eq!((low, high), (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)));
    assert!((area(&wrapped) - 1.0).abs() < 1e-15);
}

#[test]
fn cuts_interpolate_attributes_and_faces_keep_labels() {
    let value = |p: &DVec3| 3.0 * p.x - 2.0 * p.y + 1.0;
    let sheet = grid(3, 3, |x, y| [x * 0.6 - 0.4, y * 0.6 - 0.3, 0.0]);
    let at_vertex: Vec<f64> = sheet.positions().iter().map(value).collect();
    let corners = sheet.topology().corners().iter();
    let at_corner: Vec<f64> = corners.map(|&v| at_vertex[v as usize]).collect();
    let names = (0..9).map(|k| format!("object {k}")).collect();
    let sheet = sheet
        .with_attribute(Attribute::new(
            "a",
            Domain::Vertex,
            AttributeValues::Number(at_vertex.into()),
        ))
        .and_then(|mesh| {
            mesh.with_attribute(Attribute::new(
                "a",
                Domain::Corner,
                AttributeValues::Number(at_corner.into()),
            ))
        })
        .and_then(|mesh| mesh.with_objects(Labels::new(names, (0..9).collect())?))
        .unwrap();
    let clipped = clip(&sheet, Beyond::Clip, Beyond::Clip);
    for (domain, vertices) in [
        (
            Domain::Vertex,
            (0..clipped.vertex_count() as u32).collect::<Vec<_>>(),
        ),
        (Domain::Corner, clipped.topology().corners().to_vec()),
    ] {
        let AttributeValues::Number(values) = clipped.attribute("a", domain).unwrap().values()
        else {
            panic!("numbers stay numbers");
        };
        for (&vertex, number) in vertices.iter().zip(values.iter()) {
            let expected = value(&clipped.positions()[vertex as usize]);
            assert!((number - expected).abs() < 1e-12);
        }
    }
    assert_eq!(clipped.objects().get(0).unwrap(), "object 0");
    assert_eq!(clipped.objects().get(8).unwrap(), "object 8");
}

#[test]
fn edges_of_cuts_are_seams() {
    // Quads of 0.6 by 0.6 from (-0.4, -0.3) on, with creases along y.
    let sheet = grid(3, 3, |x, y| [x * 0.6 - 0.4, y * 0.6 - 0.3, 0.0]);
    let ends = |corner: u32| {
        let corners = [
            corner,
            crate::topology::next_in_face(sheet.topology(), corner),
        ];
        corners
            .map(|corner| sheet.positions()[sheet.topology().corners()[corner as usize] as usize])
    };
    let creases = (0..sheet.corner_count() as u32).map(|corner| {
        let [a, b] = ends(corner);
        if (a.x - b.x).abs() < 1e-9 { 3.0 } else { 0.0 }
    });
    let creases = AttributeValues::Number(creases.collect());
    let sheet = sheet
        .clone()
        .with_attribute(Attribute::new(
            crate::subdivide::CREASE,
            Domain::Corner,
            creases,
        ))
        .unwrap();
    for beyond in [Beyond::Clip, Beyond::Cyclic] {
        let cut = clip(&sheet, beyond, beyond);
        let values = |name: &str| match cut.attribute(name, Domain::Corner).map(Attribute::values) {
            Some(AttributeValues::Number(values)) => values.to_vec(),
            other => panic!("{name}: {other:?}"),
        };
        let (seams, creases) = (values(crate::SEAM), values(crate::subdivide::CREASE));
        for corner in 0..cut.corner_count() as u32 {
            let next = crate::topology::next_in_face(cut.topology(), corner);
            let [a, b] = [corner, next]
                .map(|c| cut.positions()[cut.topology().corners()[c as usize] as usize]);
            let on_side = |k: usize| [0.0, 1.0].iter().any(|&at| a[k] == at && b[k] == at);
            let seam = on_side(0) || on_side(1);
            assert_eq!(seams[corner as usize] > 0.5, seam, "{beyond:?} {a} {b}");
            let crease = !seam && (a.x - b.x).abs() < 1e-9;
            assert_eq!(creases[corner as usize] > 1.0, crease, "{beyond:?} {a} {b}");
        }
    }
}

#[test]
fn a_hair_beyond_the_square_is_put_on_its_side() {
    let sheet = grid(1, 1, |x, y| [x * (1.0 + 1e-12), y, 0.0]);
    let clipped = clip(&sheet, Beyond::Clip, Beyond::Extend);
    assert_eq!(clipped.vertex_count(), 4);
    assert_eq!(clipped.bounds().unwrap().1.x, 1.0);
}

#[test]
fn meaningless_settings_are_refused() {
    let tile = grid(1, 1, |x, y| [x + 2.0, y, 0.0]);
    for height in [-1.0, f64::NAN, f64::INFINITY] {
        let options = FitOptions {
            height: Some(height),
            ..FitOptions::default()
        };
        assert!(matches!(
            fit_component(&tile, &options),
            Err(GeometryError::OutOfRange { .. })
        ));
    }
    let gone = FitOptions {
        fit: Fit::Unit,
        x: Beyond::Clip,
        ..FitOptions::default()
    };
    assert!(matches!(
        fit_component(&tile, &gone),
        Err(GeometryError::Empty { .. })
    ));
    let far = grid(1, 1, |x, y| [x * 5000.0, y, 0.0]);
    let periods = FitOptions {
        fit: Fit::Unit,
        x: Beyond::Cyclic,
        ..FitOptions::default()
    };
    assert!(matches!(
        fit_component(&far, &periods),
        Err(GeometryError::OutOfRange { .. })
    ));
    let nothing = Mesh::from_faces::<[u32; 3]>(vec![[0.0; 3]], &[]).unwrap();
    assert!(matches!(
        fit_component(&nothing, &FitOptions::default()),
        Err(GeometryError::Empty { .. })
    ));
}

#[test]
fn outliers_are_named_and_even_grids_are_not() {
    for n in [1, 2, 5, 40] {
        let even = grid(n, n + 3, |x, y| [x, y, 0.0]);
        assert!(box_outliers(&even).unwrap().is_empty());
    }
    let even = grid(6, 6, |x, y| [x, y, 0.0]);
    let bolt = [[8.0, 3.0, 0.0], [8.1, 3.0, 0.0], [8.0, 3.1, 0.0]];
    let count = even.vertex_count() as u32;
    let positions = even
        .positions()
        .iter()
        .map(|p| p.to_array())
        .chain(bolt)
        .collect();
    let mut faces: Vec<Vec<u32>> = even.topology().faces().map(<[u32]>::to_vec).collect();
    faces.push(vec![count, count + 1, count + 2]);
    let found = box_outliers(&Mesh::from_faces(positions, &faces).unwrap()).unwrap();
    assert_eq!(found.len(), 1);
    assert_eq!(
        (found[0].side, found[0].faces.as_slice()),
        ("high x", &[36][..])
    );
    assert!((found[0].share - 2.1 / 8.1).abs() < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn cyclic_cuts_keep_area_and_connection(
        x in -3.0..3.0f64, y in -3.0..3.0f64, size in 0.3..4.0f64, turn in 0.0..6.3f64,
    ) {
        let (c, s) = (crate::math::cos(turn), crate::math::sin(turn));
        let place = |i: f64, j: f64| {
            let (i, j) = (i * size / 3.0, j * size / 3.0);
            [x + c * i - s * j, y + s * i + c * j, 0.0]
        };
        let sheet = grid(3, 3, place);
        let wrapped = clip(&sheet, Beyond::Cyclic, Beyond::Cyclic);
        prop_assert!((area(&wrapped) - size * size).abs() < 1e-9);
        let (low, high) = wrapped.bounds().unwrap();
        prop_assert!(low.min_element() >= 0.0 && high.truncate().max_element() <= 1.0);
        // Inside a cell neighbours share their cuts: what is open lies on the
        // square's sides or on the sheet's own rim.
        let rim = boundary_length(&wrapped);
        let on_sides: f64 = sides_length(&wrapped);
        prop_assert!((rim - on_sides - 4.0 * size).abs() < 1e-6, "{} {} {}", rim, on_sides, size);
    }
}

/// Length of boundary edges that lie in a side of the unit square.
fn sides_length(mesh: &Mesh) -> f64 {
    let adjacency = mesh.topology().adjacency();
    let mut sum = 0.0;
    for edge in 0..adjacency.edge_count() {
        let [a, b] = adjacency.edge(edge).map(|v| mesh.positions()[v as usize]);
        let in_side = |axis: usize| a[axis] == b[axis] && (a[axis] == 0.0 || a[axis] == 1.0);
        if adjacency.is_boundary_edge(edge) && (in_side(0) || in_side(1)) {
            sum += a.distance(b);
        }
    }
    sum
}
