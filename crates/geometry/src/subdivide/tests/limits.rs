//! The limit surface does not depend on the level it is asked for at.

use super::*;

fn limit(mesh: &Mesh, level: u32, boundary: Boundary) -> Mesh {
    let positions = Positions::Limit;
    run(
        mesh,
        Options {
            positions,
            boundary,
            ..levels(level)
        },
    )
    .mesh
}

/// Coarse vertices keep their numbers, so their limits can be compared.
pub(super) fn check_levels(mesh: &Mesh, boundary: Boundary, tolerance: f64) -> Mesh {
    let first = limit(mesh, 0, boundary);
    for level in 1..=4 {
        if mesh.face_count() << (2 * level) > 40_000 {
            break;
        }
        let later = limit(mesh, level, boundary);
        let pairs = first.positions().iter().zip(later.positions().iter());
        for (vertex, (a, b)) in pairs.enumerate() {
            assert!(
                a.distance(*b) < tolerance,
                "vertex {vertex} at {level}: {a} {b}"
            );
        }
    }
    first
}

/// And what 7 refinements reach is close to the limit.
fn check(mesh: &Mesh) {
    for boundary in [Boundary::EdgeOnly, Boundary::EdgeAndCorner] {
        let first = check_levels(mesh, boundary, 2e-14);
        let deep = run(
            mesh,
            Options {
                boundary,
                ..levels(7)
            },
        )
        .mesh;
        for (a, b) in first.positions().iter().zip(deep.positions().iter()) {
            // Ordinary vertices come 4 times closer each level.
            assert!(a.distance(*b) < 2e-3, "{a} {b}");
        }
    }
}

#[test]
fn smooth_limits_agree_at_every_level() {
    check(&cube());
    check(&mixed());
}

#[test]
fn crease_limits_agree_at_every_level() {
    check(&with_creases(cube(), &[([1, 3], 12.0)]));
    check(&with_creases(cube(), &[([1, 3], 2.4), ([3, 7], 0.6)]));
    check(&with_creases(
        cube(),
        &[([1, 3], 10.0), ([3, 7], 10.0), ([3, 2], 1.5)],
    ));
    check(&with_corners(
        with_creases(mixed(), &[([2, 4], 1.3)]),
        &[(4, 2.2)],
    ));
}

#[test]
fn all_points_of_a_level_are_on_the_surface() {
    // The points of level 2 are among those of level 4, wherever they lie.
    let mesh = with_creases(mixed(), &[([1, 2], 4.6), ([2, 4], 12.0), ([4, 3], 0.5)]);
    let coarse = limit(&mesh, 2, Boundary::EdgeOnly);
    let fine = limit(&mesh, 4, Boundary::EdgeOnly);
    for p in coarse.positions().iter() {
        let nearest = fine
            .positions()
            .iter()
            .map(|q| p.distance(*q))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-13, "{p}: {nearest}");
    }
}

#[test]
fn extraordinary_vertices_have_their_limit() {
    for valence in [2u32, 3, 5, 8, 40] {
        let n = 2 * valence;
        let ring = |k: u32| {
            let angle = crate::math::TAU * f64::from(k) / f64::from(n);
            [
                crate::math::cos(angle),
                crate::math::sin(angle),
                f64::from(k % 3),
            ]
        };
        let mut positions = vec![[0.0, 0.0, 2.0]];
        positions.extend((0..n).map(ring));
        let faces: Vec<[u32; 4]> = (0..valence)
            .map(|k| [0, 1 + 2 * k, 2 + 2 * k, 1 + (2 * k + 2) % n])
            .collect();
        let mesh = Mesh::from_faces(positions, &faces).expect("valid");
        let a = limit(&mesh, 0, Boundary::EdgeOnly).positions()[0];
        let b = limit(&mesh, 4, Boundary::EdgeOnly).positions()[0];
        assert!(a.distance(b) < 1e-12, "valence {valence}: {a} {b}");
    }
}
