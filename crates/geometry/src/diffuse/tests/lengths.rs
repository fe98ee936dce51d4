//! Directions that keep their lengths, or diffuse them.

use super::*;

fn with(lengths: Lengths, options: DiffuseOptions<'static>) -> DiffuseOptions<'static> {
    DiffuseOptions { lengths, ..options }
}

/// Normals of `mesh` with lengths between 1 and 3.
fn long_normals(mesh: &Mesh) -> Directions {
    let unit = normals(mesh);
    let long = |(vertex, unit): (usize, &DVec3)| *unit * (1.0 + (vertex % 5) as f64 / 2.0);
    directions(mesh, unit.outward().iter().enumerate().map(long).collect())
}

#[test]
fn kept_lengths_are_those_of_the_start() {
    let mesh = hills(6);
    let start = long_normals(&mesh);
    for options in [mean(7), cotangent(7), edge_sum(7), implicit(0.3)] {
        let unit = run(&mesh, &start, &options);
        let kept = run(&mesh, &start, &with(Lengths::Keep, options));
        for vertex in 0..mesh.vertex_count() {
            let length = start.outward()[vertex].length();
            assert!((kept[vertex] - unit[vertex] * length).length() < 1e-14);
        }
    }
}

#[test]
fn diffused_lengths_follow_the_formulas() {
    let mesh = grid(2, 1, |x, y| [x, y, 0.0]);
    let vectors: Vec<DVec3> = (1..7)
        .map(|k| DVec3::new(0.1 * f64::from(k), 0.0, f64::from(k)))
        .collect();
    let start = directions(&mesh, vectors.clone());
    let beside = |v: usize| {
        let row = [
            (v != 0 && v != 3).then(|| v - 1),
            (v % 3 < 2).then_some(v + 1),
        ];
        row.into_iter()
            .flatten()
            .chain([(v + 3) % 6])
            .collect::<Vec<_>>()
    };
    let once = run(&mesh, &start, &with(Lengths::Diffuse, mean(1)));
    let add = run(&mesh, &start, &with(Lengths::Diffuse, edge_sum(1)));
    for v in 0..6 {
        let around = beside(v);
        let sum: DVec3 = around.iter().map(|&other| vectors[other]).sum();
        let count = around.len() as f64;
        assert!((once[v] - (vectors[v] + sum / count) / 2.0).length() < 1e-14);
        assert!((add[v] - (vectors[v] + (sum - vectors[v] * count) * 0.2)).length() < 1e-14);
    }
}

#[test]
fn an_implicit_step_keeps_the_total_and_is_linear() {
    let mesh = grid(8, 8, |x, y| [x, y, 0.0]);
    let start = long_normals(&mesh);
    let options = with(Lengths::Diffuse, implicit(0.2));
    let once = run(&mesh, &start, &options);
    let twice = start.outward().iter().map(|&vector| vector * 2.0).collect();
    let twice = run(&mesh, &directions(&mesh, twice), &options);
    for (once, twice) in once.iter().zip(&twice) {
        assert!((*once * 2.0 - *twice).length() < 1e-12);
    }
    // Weighted by the triangles round each vertex; on this grid 1, 2, 3 or 6 of them.
    let mut areas = vec![0.0; mesh.vertex_count()];
    for triangle in mesh.triangle_vertices(&mesh.triangles()) {
        for vertex in triangle {
            areas[vertex as usize] += 1.0;
        }
    }
    let total = |field: &[DVec3]| field.iter().zip(&areas).map(|(v, a)| v.z * a).sum::<f64>();
    let (before, after) = (total(start.outward()), total(&once));
    assert!((before - after).abs() < 1e-6 * before, "{before} {after}");
    // And it diffuses: the lengths come nearer to each other.
    let spread = |field: &[DVec3]| {
        let lengths = || field.iter().map(|vector| vector.length());
        lengths().fold(0.0, f64::max) - lengths().fold(f64::INFINITY, f64::min)
    };
    assert!(spread(&once) < 0.5 * spread(start.outward()));
}

#[test]
fn lengths_that_grow_without_bound_are_refused() {
    // A hub of 32 edges: the sum of differences overshoots there.
    let rim = (0..32).map(|k| f64::from(k) * PI / 16.0);
    let places = rim.map(|a| [cos(a), sin(a), 0.0]).chain([[0.0, 0.0, 0.1]]);
    let faces: Vec<[u32; 3]> = (0..32).map(|k| [k, (k + 1) % 32, 32]).collect();
    let mesh = Mesh::from_faces(places.collect(), &faces).unwrap();
    let mut vectors = vec![DVec3::Z; 33];
    vectors[32] = DVec3::Z * 2.0;
    let start = directions(&mesh, vectors);
    let options = with(Lengths::Diffuse, edge_sum(1000));
    let refused = diffuse(&mesh, &start, &options, &Unmonitored);
    assert!(matches!(refused, Err(GeometryError::NonFiniteValue { .. })));
    assert_unit(&run(&mesh, &start, &edge_sum(1000)));
}

#[test]
fn long_directions_are_kept_in_front_of_their_faces() {
    let mesh = grid(6, 1, |x, y| [x, y, 3.0 * (x - 0.5).abs()]);
    let start = long_normals(&mesh);
    let options = DiffuseOptions {
        keep_side: true,
        ..with(Lengths::Diffuse, mean(200))
    };
    let field = directions(&mesh, run(&mesh, &start, &options));
    let inverted = inverted(&mesh, &field, &Unmonitored).unwrap();
    assert!(inverted.faces.is_empty() && inverted.least_cosine > 0.0);
    // Shorter than the shortest they become where slopes face each other, never zero.
    let lengths = || field.outward().iter().map(|vector| vector.length());
    assert!(lengths().fold(f64::INFINITY, f64::min) > 0.1);
    assert!(lengths().fold(0.0, f64::max) <= 3.0);
}
