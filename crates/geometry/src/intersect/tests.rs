//! Crossings against closed forms, references and exact brute force.

use super::*;
use crate::Unmonitored;
use crate::test_support::peer_case;

mod oracle;

fn exact() -> IntersectOptions {
    IntersectOptions {
        tolerance: Some(0.0),
        ..Default::default()
    }
}

fn find(mesh: &Mesh) -> Intersections {
    intersections(mesh, &IntersectOptions::default(), &Unmonitored).unwrap()
}

#[test]
fn reference_cases_have_their_component_pairs() {
    let cases = [
        ("01_saddle_default", 0),
        ("03_fold_default", 176),
        ("04_fold_smooth5", 160),
        ("07_fold_target_constant", 0),
        ("08_fold_target_even10", 0),
        ("10_evalnormals_identity", 0),
        ("30_valley_fold_default", 152),
        ("31_valley_fold_smooth5", 104),
        ("31_valley_fold_smooth20", 0),
        ("32_valley_fold_target_constant", 0),
        ("46_sphere_pole_CONSTANT_smooth5", 0),
    ];
    for (name, pairs) in cases {
        let Some(case) = peer_case(name) else {
            return;
        };
        let found = find(&case.mesh("tissue"));
        assert_eq!(found.component_pairs.len(), pairs, "{name}");
    }
}

#[test]
fn a_cross_of_quads_counts_wherever_it_runs() {
    let quad = |at: [[f64; 3]; 4]| at;
    let flat = quad([[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.]]);
    let upright = [
        // Along the middle, a diagonal of the other, and both diagonals.
        quad([[1., -1., -1.], [1., 3., -1.], [1., 3., 1.], [1., -1., 1.]]),
        quad([[-1., -1., -1.], [3., 3., -1.], [3., 3., 1.], [-1., -1., 1.]]),
        quad([[0., 0., 0.], [1., 1., -1.], [2., 2., 0.], [1., 1., 1.]]),
        quad([[1., 1., -1.], [2.5, 2.5, 0.], [1., 1., 1.], [0.5, 0.5, 0.]]),
    ];
    for (k, other) in upright.into_iter().enumerate() {
        for angle in [0.0, 0.3] {
            let (s, c) = (crate::math::sin(angle), crate::math::cos(angle));
            let turn = |[x, y, z]: [f64; 3]| {
                let (y, z) = (c * y - s * z, s * y + c * z);
                [c * x - s * y, s * x + c * y, z]
            };
            let places: Vec<[f64; 3]> = flat.into_iter().chain(other).map(turn).collect();
            let mesh = Mesh::from_faces(places, &[[0, 1, 2, 3], [4, 5, 6, 7]]).unwrap();
            assert_eq!(find(&mesh).pairs, [[0, 1]], "{k} {angle}");
        }
    }
}

#[test]
fn touching_and_flat_overlap_are_contacts() {
    let floor = [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.]];
    let others = [
        // Standing on it, overlapping in its plane, over it, beside it.
        (
            [[1., 0.5, 0.], [1., 1., 0.], [1., 1., 1.], [1., 0.5, 1.]],
            1,
        ),
        ([[1., 1., 0.], [3., 1., 0.], [3., 3., 0.], [1., 3., 0.]], 1),
        ([[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.]], 1),
        ([[0., 0., 1.], [2., 0., 1.], [2., 2., 1.], [0., 2., 1.]], 0),
        ([[2., 0., 0.], [4., 0., 0.], [4., 2., 0.], [2., 2., 0.]], 0),
        ([[2., 2., 0.], [4., 2., 0.], [4., 4., 0.], [2., 4., 0.]], 0),
        ([[2., 1., 0.], [4., 1., 0.], [4., 2., 0.], [2., 2., 0.]], 1),
    ];
    for (k, (other, contacts)) in others.into_iter().enumerate() {
        let places = floor.into_iter().chain(other).collect();
        let mesh = Mesh::from_faces(places, &[[0, 1, 2, 3], [4, 5, 6, 7]]).unwrap();
        for options in [exact(), IntersectOptions::default()] {
            let found = intersections(&mesh, &options, &Unmonitored).unwrap();
            assert_eq!(
                (found.pairs.len(), found.contacts.len()),
                (0, contacts),
                "{k}"
            );
        }
    }
}

#[test]
fn a_neighbour_folded_over_crosses() {
    let places = vec![
        [0., 0., 0.],
        [2., 0., 0.],
        [2., 2., 0.],
        [0., 2., 0.],
        [2., 1., 0.],
        [0., 1., 0.],
    ];
    let folded = Mesh::from_faces(places.clone(), &[[0, 1, 2, 3], [1, 0, 5, 4]]).unwrap();
    assert_eq!(find(&folded).pairs, [[0, 1]]);
    let rolled = Mesh::from_faces(places, &[[0, 1, 2, 3], [2, 3, 0, 1]]).unwrap();
    let found = find(&rolled);
    assert_eq!((found.pairs.len(), found.contacts.len()), (0, 1));
}

/// Boxes side by side, `gap` apart, turned about two axes by `angle`.
fn boxes(count: u32, gap: f64, angle: f64) -> Mesh {
    use crate::math::{cos, sin};
    let (s, c) = (sin(angle), cos(angle));
    let one = crate::test_support::cuboid(1.0, 1.0, 0.0, 0.3);
    let (mut places, mut faces) = (Vec::new(), Vec::new());
    for k in 0..count * count {
        let start = places.len() as u32;
        let (i, j) = (f64::from(k % count), f64::from(k / count));
        places.extend(one.positions().iter().map(|p| {
            let (x, y, z) = (p.x + i * (1.0 + gap), p.y + j * (1.0 + gap), p.z);
            let (x, y) = (c * x - s * y, s * x + c * y);
            [x, c * y - s * z, s * y + c * z]
        }));
        faces.extend(one.topology().faces().map(|face| {
            face.iter()
                .map(|&vertex| vertex + start)
                .collect::<Vec<u32>>()
        }));
    }
    Mesh::from_faces(places, &faces).unwrap()
}

#[test]
fn a_flat_array_of_boxes_is_free_of_crossings() {
    for angle in [0.0, 0.1, 0.7, 2.3] {
        let touching = find(&boxes(6, 0.0, angle));
        assert_eq!(
            (touching.pairs.len(), touching.components),
            (0, 36),
            "{angle}"
        );
        assert!(angle > 0.0 || touching.contacts.len() >= 60);
        let overlapping = find(&boxes(6, -0.1, angle));
        // Boxes beside each other are flush all round, so that their faces only
        // touch; those that meet over a corner cross.
        assert_eq!(overlapping.component_pairs.len(), 50, "{angle}");
        let apart = find(&boxes(6, 0.1, angle));
        assert_eq!(apart.pairs.len() + apart.contacts.len(), 0);
    }
}

#[test]
fn pairs_within_and_between_components_are_told_apart() {
    let mesh = boxes(3, -0.1, 0.2);
    let count = |between| {
        let options = IntersectOptions {
            between,
            tolerance: None,
        };
        intersections(&mesh, &options, &Unmonitored)
            .unwrap()
            .pairs
            .len()
    };
    assert_eq!(count(Between::Inside), 0);
    assert!(count(Between::All) > 0);
    assert_eq!(count(Between::Components), count(Between::All));
    // As one panel they are inside it.
    let panels = AttributeValues::Integer(vec![7; mesh.face_count()].into());
    let one = mesh
        .clone()
        .with_attribute(crate::Attribute::new(PANEL, Domain::Face, panels));
    let found = find(&one.unwrap());
    assert_eq!((found.components, found.component_pairs.len()), (1, 0));
    assert_eq!(found.pairs.len(), count(Between::All));
}

#[test]
fn shallow_crossings_are_contacts() {
    let places = vec![
        [0., 0., 0.],
        [4., 0., 0.],
        [0., 4., 0.],
        [1., 1., -0.01],
        [2., 1., 1.],
        [1., 2., 1.],
    ];
    let mesh = Mesh::from_faces(places, &[[0, 1, 2], [3, 4, 5]]).unwrap();
    for (tolerance, pairs) in [(0.0, 1), (0.009, 1), (0.011, 0)] {
        let options = IntersectOptions {
            tolerance: Some(tolerance),
            ..Default::default()
        };
        let found = intersections(&mesh, &options, &Unmonitored).unwrap();
        assert_eq!(
            (found.pairs.len(), found.contacts.len()),
            (pairs, 1 - pairs)
        );
    }
}

#[test]
fn bad_input_is_named() {
    let mesh = boxes(1, 0.0, 0.0);
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        let options = IntersectOptions {
            tolerance: Some(tolerance),
            ..Default::default()
        };
        let refused = intersections(&mesh, &options, &Unmonitored);
        assert!(matches!(refused, Err(GeometryError::OutOfRange { .. })));
    }
    let far = Mesh::from_faces(
        vec![[0.; 3], [1e200, 0., 0.], [0., 1e200, 0.]],
        &[[0, 1, 2]],
    );
    let refused = intersections(&far.unwrap(), &exact(), &Unmonitored);
    assert!(matches!(refused, Err(GeometryError::OutOfRange { .. })));
    let empty = Mesh::from_faces::<[u32; 3]>(Vec::new(), &[]).unwrap();
    assert_eq!(find(&empty).components, 0);
}

#[test]
fn any_number_of_threads_finds_the_same() {
    let mesh = boxes(12, -0.1, 0.3);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let found = pool.install(|| find(&mesh));
        (found.pairs, found.contacts, found.field.digest())
    };
    assert_eq!(with(1), with(3));
}
