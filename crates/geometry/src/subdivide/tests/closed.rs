//! Counts by formula, known places, and what is refused.

use super::*;
use crate::measure::measure_mesh;
use crate::primitives::{grid, parametric_surface};
use crate::subdivide::subdivided_counts;
use glam::DVec2;

#[test]
fn counts_are_those_of_the_formula() {
    for mesh in [
        cube(),
        mixed(),
        grid([3, 2], DVec2::ONE, false).expect("valid"),
    ] {
        let euler = measure_mesh(&mesh).euler;
        for level in 0..=4 {
            for scheme in [Scheme::CatmullClark, Scheme::Bilinear] {
                let fine = run(
                    &mesh,
                    Options {
                        scheme,
                        ..levels(level)
                    },
                )
                .mesh;
                let counts = subdivided_counts(&mesh, level).expect("few");
                let measures = measure_mesh(&fine);
                assert_eq!(counts.vertices, measures.vertices as u128);
                assert_eq!(counts.edges, measures.edges as u128);
                assert_eq!(counts.faces, measures.faces as u128);
                assert_eq!(counts.corners, fine.corner_count() as u128);
                assert_eq!((measures.euler, measures.isolated_vertices), (euler, 0));
                assert_eq!(measures.nonmanifold_edges + measures.inconsistent_edges, 0);
                assert_eq!(measures.nonmanifold_vertices, 0);
                assert!(level == 0 || fine.topology().faces().all(|face| face.len() == 4));
            }
        }
    }
}

#[test]
fn a_cube_goes_where_it_is_known_to() {
    let fine = run(&cube(), levels(1)).mesh;
    // A corner (1, 1, 1): S(n-3)/n + 2R/n + Q/n = 5/9; an edge 3/4; a face 1.
    assert!((fine.positions()[7] - DVec3::splat(5.0 / 9.0)).length() < 1e-15);
    let lengths = fine.positions()[8..].iter().map(|p| p.abs().max_element());
    assert!(
        lengths
            .clone()
            .take(12)
            .all(|length| (length - 0.75).abs() < 1e-15)
    );
    assert!(lengths.skip(12).all(|length| (length - 1.0).abs() < 1e-15));
    // (9 S + 4 sum e + sum f) / 24 = 1/2.
    let positions = Positions::Limit;
    for level in 0..=3 {
        let limit = run(
            &cube(),
            Options {
                positions,
                ..levels(level)
            },
        )
        .mesh;
        assert!((limit.positions()[7] - DVec3::splat(0.5)).length() < 1e-15);
    }
}

#[test]
fn a_regular_plane_stays_where_it_is() {
    // Linear precision: an affine grid with kept corners keeps its lines, and
    // its inner vertices are the bilinear ones.
    let mesh = grid([4, 3], DVec2::new(8.0, 3.0), true).expect("valid");
    for positions in [Positions::Refined, Positions::Limit] {
        let options = Options {
            positions,
            ..levels(3)
        };
        let smooth = run(&mesh, options).mesh;
        let measures = measure_mesh(&smooth);
        assert_eq!(measures.bounds, mesh.bounds());
        assert!((measures.area - 24.0).abs() < 1e-12);
        assert!(smooth.positions().iter().all(|p| p.z == 0.0));
        let scheme = Scheme::Bilinear;
        let linear = run(
            &mesh,
            Options {
                scheme,
                ..levels(3)
            },
        )
        .mesh;
        let far_inside = |p: &DVec3| p.x.abs() <= 2.0 && p.y.abs() <= 0.5;
        for (a, b) in smooth.positions().iter().zip(linear.positions().iter()) {
            assert!(!far_inside(b) || a.distance(*b) < 1e-14, "{a} {b}");
        }
    }
}

#[test]
fn edge_only_rounds_corners_and_edge_and_corner_keeps_them() {
    let mesh = grid([1, 1], DVec2::ONE, false).expect("valid");
    let kept = run(&mesh, levels(2)).mesh;
    assert_eq!(kept.positions()[..4], mesh.positions()[..]);
    let boundary = Boundary::EdgeOnly;
    let positions = Positions::Limit;
    let round = run(
        &mesh,
        Options {
            boundary,
            positions,
            ..levels(2)
        },
    )
    .mesh;
    // A corner of a closed cubic B-spline: (1 4 1)/6 of its polygon.
    let corner = DVec3::new(1.0, 1.0, 0.0) / 6.0;
    assert!(round.positions()[0].distance(corner) < 1e-15);
}

#[test]
fn bilinear_stays_on_the_patch() {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [3.0, 0.0, 1.0],
        [4.0, 2.0, -1.0],
        [0.0, 2.0, 2.0],
    ];
    let mesh = Mesh::from_faces(positions, &[[0u32, 1, 2, 3]]).expect("valid");
    let scheme = Scheme::Bilinear;
    let fine = run(
        &mesh,
        Options {
            scheme,
            ..levels(3)
        },
    );
    let grid = fine.parents.whole_grid(0).expect("a quad");
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| mesh.positions()[k]);
    for (k, vertex) in grid.vertices().enumerate() {
        let (u, v) = ((k % 9) as f64 / 8.0, (k / 9) as f64 / 8.0);
        let place = (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v;
        assert!(fine.mesh.positions()[vertex as usize].distance(place) < 1e-15);
    }
}

#[test]
fn isolated_vertices_keep_number_and_place() {
    let mut positions: Vec<_> = cube().positions().iter().map(|p| p.to_array()).collect();
    positions.insert(0, [7.0, 8.0, 9.0]);
    let faces: Vec<_> = cube()
        .topology()
        .faces()
        .map(|f| f.iter().map(|v| v + 1).collect::<Vec<_>>())
        .collect();
    let mesh = Mesh::from_faces(positions, &faces).expect("valid");
    for positions in [Positions::Refined, Positions::Limit] {
        let fine = run(
            &mesh,
            Options {
                positions,
                ..levels(2)
            },
        )
        .mesh;
        assert_eq!(fine.positions()[0], DVec3::new(7.0, 8.0, 9.0));
        assert_eq!(measure_mesh(&fine).isolated_vertices, 1);
    }
}

#[test]
fn boxes_that_touch_in_a_corner_stay_together_there() {
    // The second cube's lowest corner is the first one's highest, vertex 7.
    let cube = cube();
    let mut positions: Vec<_> = cube.positions().iter().map(|p| p.to_array()).collect();
    positions.extend(cube.positions()[1..].iter().map(|p| (*p + 2.0).to_array()));
    let own = |v: u32| if v == 0 { 7 } else { v + 7 };
    let faces: Vec<Vec<u32>> = (cube.topology().faces().map(<[u32]>::to_vec))
        .chain(
            cube.topology()
                .faces()
                .map(|face| face.iter().map(|&v| own(v)).collect()),
        )
        .collect();
    let mesh = Mesh::from_faces(positions, &faces).expect("valid");
    for positions in [Positions::Refined, Positions::Limit] {
        let fine = run(
            &mesh,
            Options {
                positions,
                ..levels(3)
            },
        )
        .mesh;
        assert_eq!(fine.positions()[7], DVec3::ONE);
        assert!(fine.positions()[0].distance(-DVec3::ONE) > 0.4);
    }
}

#[test]
fn a_moebius_strip_is_subdivided_although_it_has_no_sides() {
    use crate::math::{PI, cos, sin};
    let strip = |u: f64, v: f64| {
        let (around, half) = (u * 2.0 * PI, u * PI);
        let r = 3.0 + (v - 0.5) * cos(half);
        DVec3::new(r * cos(around), r * sin(around), (v - 0.5) * sin(half))
    };
    let open = parametric_surface([12, 1], [false, false], strip, &Unmonitored).expect("finite");
    // Join the last column to the first, upside down.
    let faces: Vec<Vec<u32>> = open
        .topology()
        .faces()
        .map(|face| {
            let join = |&v: &u32| match v {
                12 => 13,
                25 => 0,
                _ => v,
            };
            face.iter().map(join).collect()
        })
        .collect();
    let positions = open.positions().iter().map(|p| p.to_array()).collect();
    let mesh = Mesh::from_faces(positions, &faces).expect("valid");
    let before = measure_mesh(&mesh);
    assert_eq!(
        (
            before.inconsistent_edges,
            before.boundary_loops,
            before.euler
        ),
        (1, 1, 0)
    );
    let after = measure_mesh(&run(&mesh, levels(3)).mesh);
    assert_eq!(
        (after.inconsistent_edges, after.boundary_loops, after.euler),
        (8, 1, 0)
    );
    // Nothing tears or folds: the seam is as smooth as the rest.
    assert!(after.area > 0.9 * before.area && after.area < before.area);
}

#[test]
fn what_cannot_be_subdivided_is_named() {
    let run = |mesh: &Mesh, level| subdivide(mesh, levels(level), &Unmonitored).err();
    let positions = vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let fin = Mesh::from_faces(positions.clone(), &[[0u32, 1, 2], [1, 0, 3], [0, 1, 4]]);
    let edges = vec![([0, 1], 3)];
    assert_eq!(
        run(&fin.expect("valid"), 1),
        Some(GeometryError::NonManifold { edges })
    );
    let repeated = Mesh::from_faces(positions, &[vec![0u32, 1, 2], vec![2, 1, 1, 3]]);
    let expected = GeometryError::RepeatedVertex { face: 1, vertex: 1 };
    assert_eq!(run(&repeated.expect("valid"), 1), Some(expected));
    assert!(matches!(
        run(&cube(), 9),
        Some(GeometryError::OutOfRange { value: 9.0, .. })
    ));
    let large = grid([1000, 1000], DVec2::ONE, false).expect("valid");
    // 65 536 faces of each of a million quads, and one more row of vertices.
    let expected = GeometryError::TooMany {
        what: "vertices",
        count: 256_001 * 256_001,
        limit: u128::from(u32::MAX - 1),
    };
    assert_eq!(run(&large, 8), Some(expected));
    assert!(matches!(
        subdivided_counts(&large, 8),
        Err(GeometryError::TooMany { .. })
    ));
    assert!(subdivided_counts(&cube(), u32::MAX).is_err());
}

#[test]
fn a_cancelled_subdivision_stops() {
    struct Stop;
    impl crate::Monitor for Stop {
        fn cancelled(&self) -> bool {
            true
        }
    }
    let cancelled = subdivide(&cube(), levels(4), &Stop);
    assert_eq!(cancelled.err(), Some(GeometryError::Cancelled));
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let mesh = with_creases(mixed(), &[([1, 2], 1.3), ([4, 3], 20.0)]);
    let digest = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool");
        let positions = Positions::Limit;
        pool.install(|| {
            run(
                &mesh,
                Options {
                    positions,
                    ..levels(6)
                },
            )
            .mesh
            .digest()
        })
    };
    assert_eq!(digest(1), digest(5));
}
