mod lengths;

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::math::{PI, cos, sin};
use crate::normals::face_normals;
use crate::test_shapes::{case, directions, grid, normals, renumbered, sphere};
use crate::{Attribute, AttributeValues, Field, Quantity, Unmonitored};

fn mean(iterations: u32) -> DiffuseOptions<'static> {
    DiffuseOptions {
        scheme: Scheme::Mean {
            iterations,
            diffusion: 0.5,
            laplacian: Laplacian::Uniform,
        },
        ..Default::default()
    }
}

fn cotangent(iterations: u32) -> DiffuseOptions<'static> {
    DiffuseOptions {
        scheme: Scheme::Mean {
            iterations,
            diffusion: 0.5,
            laplacian: Laplacian::Cotangent,
        },
        ..Default::default()
    }
}

fn edge_sum(iterations: u32) -> DiffuseOptions<'static> {
    DiffuseOptions {
        scheme: Scheme::EdgeSum {
            iterations,
            step: 0.2,
            flip_inverted: false,
        },
        ..Default::default()
    }
}

fn implicit(distance: f64) -> DiffuseOptions<'static> {
    DiffuseOptions {
        scheme: Scheme::Implicit { distance },
        ..Default::default()
    }
}

fn run(mesh: &Mesh, start: &Directions, options: &DiffuseOptions<'_>) -> Vec<DVec3> {
    let result = diffuse(mesh, start, options, &Unmonitored).unwrap();
    result.outward().to_vec()
}

fn hills(cells: u32) -> Mesh {
    grid(cells, cells, |x, y| {
        [x, y, 0.2 * sin(7.0 * x) * cos(5.0 * y)]
    })
}

fn bits(field: &[DVec3]) -> Vec<[u64; 3]> {
    field
        .iter()
        .map(|v| v.to_array().map(f64::to_bits))
        .collect()
}

fn assert_unit(field: &[DVec3]) {
    for (vertex, vector) in field.iter().enumerate() {
        assert!((vector.length() - 1.0).abs() < 1e-12, "{vertex}: {vector}");
    }
}

#[test]
fn one_pass_is_the_formula() {
    let mesh = grid(2, 1, |x, y| [x, y, 0.0]);
    let start = directions(
        &mesh,
        vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::Z, DVec3::X, DVec3::Y],
    );
    let field = run(&mesh, &start, &mean(1));
    // Vertex 1 has the neighbours 0, 2 and 4.
    let expected = DVec3::Y * 0.5 + (DVec3::X + DVec3::Z + DVec3::X) / 3.0 * 0.5;
    assert!((field[1] - expected.normalize()).length() < 1e-15);
    let field = run(&mesh, &start, &edge_sum(1));
    let expected = DVec3::Y + (DVec3::X + DVec3::Z + DVec3::X - DVec3::Y * 3.0) * 0.2;
    assert!((field[1] - expected.normalize()).length() < 1e-15);
}

#[test]
fn passes_add_up_exactly() {
    let mesh = hills(9);
    let start = normals(&mesh);
    for options in [mean as fn(u32) -> DiffuseOptions<'static>, cotangent] {
        for keep_side in [false, true] {
            let with = |n| DiffuseOptions {
                keep_side,
                ..options(n)
            };
            let twelve = run(&mesh, &start, &with(12));
            let five = diffuse(&mesh, &start, &with(5), &Unmonitored).unwrap();
            assert_eq!(bits(&run(&mesh, &five, &with(7))), bits(&twelve));
            assert_eq!(bits(&run(&mesh, &five, &with(0))), bits(five.outward()));
        }
    }
}

#[test]
fn a_constant_field_stays_put() {
    let mesh = hills(8);
    let lean = DVec3::new(0.36, 0.48, 0.8);
    let start = directions(&mesh, vec![lean; mesh.vertex_count()]);
    for options in [mean(50), cotangent(50), edge_sum(50), implicit(0.7)] {
        for vector in run(&mesh, &start, &options) {
            assert!((vector - lean).length() < 1e-12);
        }
    }
}

#[test]
fn poles_of_valence_32_stay_unit_and_in_front() {
    let Some(ball) = case("46_sphere_pole_CONSTANT_smooth5/base.obj") else {
        return;
    };
    assert_eq!(diverging_vertices(&ball).len(), 2);
    let start = normals(&ball);
    let field = run(&ball, &start, &mean(400));
    assert_unit(&field);
    let faces = face_normals(&ball, &Unmonitored).unwrap();
    let mut least = 1.0f64;
    for (face, normal) in faces.iter().enumerate() {
        for &vertex in ball.face(face) {
            least = least.min(field[vertex as usize].dot(*normal));
        }
    }
    assert!(least > 0.97, "{least}");
    // The edge sum diverges there: finite and unit length none the less.
    assert_unit(&run(&ball, &start, &edge_sum(400)));
    let diverged = diffuse(&ball, &start, &edge_sum(6), &Unmonitored).unwrap();
    assert!(
        !inverted(&ball, &diverged, &Unmonitored)
            .unwrap()
            .vertices
            .is_empty()
    );
}

#[test]
fn flipping_turns_inverted_results_round() {
    let ball = sphere(32, 8);
    let start = normals(&ball);
    let mut options = edge_sum(21);
    let plain = run(&ball, &start, &options);
    options.scheme = Scheme::EdgeSum {
        iterations: 21,
        step: 0.2,
        flip_inverted: true,
    };
    let flipped = run(&ball, &start, &options);
    let mut turned = 0;
    for ((plain, flipped), normal) in plain.iter().zip(&flipped).zip(start.outward().iter()) {
        let expected = if plain.dot(*normal) < 0.0 {
            -*plain
        } else {
            *plain
        };
        assert_eq!(*flipped, expected);
        turned += usize::from(plain.dot(*normal) < 0.0);
    }
    assert!(turned > 0);
}

#[test]
fn a_divergence_of_any_size_does_not_overflow() {
    let ball = sphere(64, 6);
    let field = run(&ball, &normals(&ball), &edge_sum(3000));
    assert_unit(&field);
}

#[test]
fn weights_keep_vertices() {
    let mesh = hills(6);
    let start = normals(&mesh);
    let values: Vec<f64> = (0..49).map(|v| f64::from(v % 3) * 0.5).collect();
    let field = Arc::new(Field::new(Domain::Vertex, Quantity::Number, values).unwrap());
    for options in [mean(20), cotangent(20), edge_sum(20), implicit(0.3)] {
        let options = DiffuseOptions {
            weights: Amount::Field(Arc::clone(&field)),
            ..options
        };
        let smooth = run(&mesh, &start, &options);
        for (vertex, &vector) in smooth.iter().enumerate() {
            let moved = (vector - start.outward()[vertex]).length();
            if vertex % 3 == 0 {
                assert!(moved < 1e-15);
            } else {
                assert!(moved > 1e-6);
            }
        }
    }
}

/// A tent over x, whose normals differ along u only, with its UVs.
fn tent() -> Mesh {
    let mesh = grid(8, 8, |x, y| [x, y, (x - 0.5).abs() + 0.3 * y * y]);
    let corners = mesh.topology().corners();
    let uv: Vec<DVec2> = corners
        .iter()
        .map(|&v| mesh.positions()[v as usize].truncate())
        .collect();
    let layer = Attribute::new("uv", Domain::Corner, AttributeValues::Vector2(uv.into()));
    mesh.with_attribute(layer).unwrap()
}

#[test]
fn anisotropy_diffuses_along_one_sense_only() {
    let mesh = tent();
    // u differs from column to column, v from row to row.
    let vectors = (0..81)
        .map(|v| DVec3::new(f64::from(v % 9), f64::from(v / 9), 9.0))
        .collect();
    let start = directions(&mesh, vectors);
    for base in [mean(1), edge_sum(1)] {
        for (strength, along) in [(-1.0, true), (1.0, false)] {
            let anisotropy = Some(Anisotropy {
                grain: Grain::Layer("uv"),
                strength,
            });
            let field = run(
                &mesh,
                &start,
                &DiffuseOptions {
                    anisotropy,
                    ..base.clone()
                },
            );
            let at = |v: usize| start.outward()[v].normalize();
            let (one, two) = if along { (39, 41) } else { (31, 49) };
            let expected = match base.scheme {
                Scheme::Mean { .. } => at(40) * 0.5 + (at(one) + at(two)) * 0.25,
                _ => at(40) + (at(one) + at(two) - at(40) * 2.0) * 0.2,
            };
            assert!((field[40] - expected.normalize()).length() < 1e-14);
        }
        let none = Some(Anisotropy {
            grain: Grain::Layer("uv"),
            strength: 0.0,
        });
        let zero = run(
            &mesh,
            &start,
            &DiffuseOptions {
                anisotropy: none,
                ..base.clone()
            },
        );
        for (a, b) in zero.iter().zip(run(&mesh, &start, &base)) {
            assert!((*a - b).length() < 1e-15);
        }
    }
}

#[test]
fn a_direction_field_can_be_the_grain() {
    let flat = grid(4, 4, |x, y| [x, y, 0.0]);
    let vectors = (0..25)
        .map(|v| DVec3::new(f64::from(v % 5), f64::from(v / 5), 5.0))
        .collect();
    let start = directions(&flat, vectors);
    // Opposite senses are one grain.
    let grain = (0..25)
        .map(|v| if v % 2 == 0 { DVec3::X } else { -DVec3::X })
        .collect();
    let grain = directions(&flat, grain);
    let anisotropy = Some(Anisotropy {
        grain: Grain::Along(&grain),
        strength: -1.0,
    });
    let field = run(
        &flat,
        &start,
        &DiffuseOptions {
            anisotropy,
            ..mean(1)
        },
    );
    let at = |v: usize| start.outward()[v].normalize();
    let expected = at(12) * 0.5 + (at(11) + at(13)) * 0.25;
    assert!((field[12] - expected.normalize()).length() < 1e-14);
}

#[test]
fn keeping_the_side_leaves_nothing_inverted() {
    // A ridge as steep as roofs get, smoothed until its directions are parallel.
    let ridge = grid(12, 4, |x, y| [x, y, -3.0 * (x - 0.5).abs()]);
    let lean = directions(
        &ridge,
        vec![DVec3::new(1.0, 0.0, 0.1); ridge.vertex_count()],
    );
    for options in [mean(30), edge_sum(30), implicit(0.5), mean(0)] {
        let free = diffuse(&ridge, &lean, &options, &Unmonitored).unwrap();
        let found = inverted(&ridge, &free, &Unmonitored).unwrap();
        assert!(!found.vertices.is_empty() && found.faces.len() >= 24);
        let kept = DiffuseOptions {
            keep_side: true,
            ..options
        };
        let kept = diffuse(&ridge, &lean, &kept, &Unmonitored).unwrap();
        let none = inverted(&ridge, &kept, &Unmonitored).unwrap();
        assert!(none.vertices.is_empty() && none.faces.is_empty());
        assert!(none.least_cosine > 0.0, "{}", none.least_cosine);
        assert_unit(kept.outward());
    }
}

#[test]
fn keeping_the_side_changes_nothing_where_nothing_is_inverted() {
    let mesh = hills(10);
    let start = normals(&mesh);
    let kept = DiffuseOptions {
        keep_side: true,
        ..mean(25)
    };
    assert_eq!(
        bits(&run(&mesh, &start, &kept)),
        bits(&run(&mesh, &start, &mean(25)))
    );
}

#[test]
fn implicit_solves_its_system() {
    // Dense Gaussian elimination as the oracle.
    let mesh = hills(5);
    let start = normals(&mesh);
    let (count, d) = (36, 0.4);
    let mut matrix = vec![vec![0.0; count]; count];
    for triangle in mesh.triangle_vertices(&mesh.triangles()) {
        let p = triangle.map(|v| mesh.positions()[v as usize]);
        let area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).length();
        for v in triangle {
            matrix[v as usize][v as usize] += area / 3.0;
        }
    }
    let mut right: Vec<DVec3> = (0..count)
        .map(|v| start.outward()[v] * matrix[v][v])
        .collect();
    let (edges, weights) = stencil::cotangent_edges(&mesh);
    for (&[a, b], weight) in edges.iter().zip(weights) {
        let (a, b, w) = (a as usize, b as usize, weight * d * d);
        matrix[a][a] += w;
        matrix[b][b] += w;
        matrix[a][b] -= w;
        matrix[b][a] -= w;
    }
    for k in 0..count {
        for row in k + 1..count {
            let factor = matrix[row][k] / matrix[k][k];
            let upper = matrix[k].clone();
            for (entry, above) in matrix[row].iter_mut().zip(upper) {
                *entry -= factor * above;
            }
            right[row] = right[row] - right[k] * factor;
        }
    }
    let mut solved = vec![DVec3::ZERO; count];
    for k in (0..count).rev() {
        let known: DVec3 = (k + 1..count).map(|c| solved[c] * matrix[k][c]).sum();
        solved[k] = (right[k] - known) / matrix[k][k];
    }
    for (vector, solved) in run(&mesh, &start, &implicit(d)).iter().zip(solved) {
        assert!((*vector - solved.normalize()).length() < 1e-7);
    }
}

#[test]
fn implicit_does_not_depend_on_density() {
    let at = |cells: u32| {
        let mesh = hills(cells);
        let field = run(&mesh, &normals(&mesh), &implicit(0.2));
        let step = cells / 8;
        let place = move |i: u32, j: u32| ((j * step) * (cells + 1) + i * step) as usize;
        (0..81)
            .map(|k| field[place(k % 9, k / 9)])
            .collect::<Vec<_>>()
    };
    let (coarse, fine) = (at(32), at(64));
    for (a, b) in coarse.iter().zip(&fine) {
        assert!((*a - *b).length() < 0.02);
    }
}

#[test]
fn cotangents_of_a_right_triangle() {
    let mesh =
        Mesh::from_faces(vec![[0., 0., 0.], [1., 0., 0.], [0., 2., 0.]], &[[0, 1, 2]]).unwrap();
    let (edges, weights) = stencil::cotangent_edges(&mesh);
    assert_eq!(edges, [[0, 1], [0, 2], [1, 2]]);
    for (weight, expected) in weights.iter().zip([1.0, 0.25, 0.0]) {
        assert!((weight - expected).abs() < 1e-15);
    }
}

#[test]
fn degenerate_faces_and_isolated_vertices_are_harmless() {
    let positions = vec![
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [2., 0., 0.],
        [2., 0., 0.],
        [7., 7., 7.],
    ];
    let faces: Vec<Vec<u32>> = vec![vec![0, 1, 2, 3], vec![1, 4, 5], vec![4, 5, 4]];
    let mesh = Mesh::from_faces(positions, &faces).unwrap();
    let start = normals(&mesh);
    for options in [mean(3), cotangent(3), edge_sum(3), implicit(1.0)] {
        for keep_side in [false, true] {
            let field = run(
                &mesh,
                &start,
                &DiffuseOptions {
                    keep_side,
                    ..options.clone()
                },
            );
            assert!(field.iter().all(|v| v.is_finite()));
            assert_eq!(field[6], DVec3::ZERO);
            assert!((field[0] - DVec3::Z).length() < 1e-12);
        }
    }
    // Over mesh edges directions reach the faces that have none.
    assert!((run(&mesh, &start, &mean(3))[5] - DVec3::Z).length() < 1e-12);
}

#[test]
fn settings_out_of_range_are_named() {
    let mesh = hills(2);
    let start = normals(&mesh);
    let refuses = |options: DiffuseOptions<'_>| {
        let result = diffuse(&mesh, &start, &options, &Unmonitored);
        assert!(
            matches!(result, Err(GeometryError::OutOfRange { .. })),
            "{options:?}"
        );
    };
    for bad in [-0.1, 1.5, f64::NAN] {
        refuses(DiffuseOptions {
            weights: bad.into(),
            ..mean(1)
        });
        let scheme = Scheme::Mean {
            iterations: 1,
            diffusion: bad,
            laplacian: Laplacian::Uniform,
        };
        refuses(DiffuseOptions { scheme, ..mean(1) });
    }
    refuses(implicit(-1.0));
    refuses(implicit(f64::INFINITY));
    let anisotropy = Some(Anisotropy {
        grain: Grain::Layer("uv"),
        strength: 0.5,
    });
    let missing = diffuse(
        &mesh,
        &start,
        &DiffuseOptions {
            anisotropy,
            ..mean(1)
        },
        &Unmonitored,
    );
    assert!(matches!(missing, Err(GeometryError::NoAttribute { .. })));
    let unfit = diffuse(
        &mesh,
        &start,
        &DiffuseOptions {
            anisotropy,
            ..implicit(1.0)
        },
        &Unmonitored,
    );
    assert!(matches!(unfit, Err(GeometryError::Invalid(_))));
    let both = start
        .compensated(start.outward().to_vec(), start.outward().to_vec())
        .unwrap();
    let compensated = diffuse(&mesh, &both, &mean(1), &Unmonitored);
    assert!(matches!(
        compensated,
        Err(GeometryError::Compensated { .. })
    ));
}

#[test]
fn a_cancelled_run_stops() {
    struct Stop;
    impl Monitor for Stop {
        fn cancelled(&self) -> bool {
            true
        }
    }
    let mesh = hills(2);
    for options in [mean(5), edge_sum(5), implicit(1.0)] {
        let result = diffuse(&mesh, &normals(&mesh), &options, &Stop);
        assert_eq!(result.unwrap_err(), GeometryError::Cancelled);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn turning_and_scaling_the_mesh_turns_the_result(
        x in -1.0..1.0f64, angle in 0.0..PI, scale in 0.1..10.0f64, which in 0usize..4,
    ) {
        let mesh = hills(5);
        let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(x, 0.5, 0.7).normalize(), angle));
        let moved = mesh.positions().iter().map(|&p| turn * p * scale + DVec3::X).collect();
        let moved = mesh.with_positions(moved).unwrap();
        let options = |scale: f64| [mean(4), cotangent(4), edge_sum(4), implicit(0.3 * scale)][which].clone();
        let here = run(&mesh, &normals(&mesh), &options(1.0));
        let there = run(&moved, &normals(&moved), &options(scale));
        for (a, b) in here.iter().zip(&there) {
            prop_assert!((turn * *a - *b).length() < 1e-7);
        }
    }

    #[test]
    fn renumbering_the_mesh_renumbers_the_result(seed in 1u64..1000, which in 0usize..4) {
        let mesh = hills(4);
        let mut names: Vec<u32> = (0..25).collect();
        let mut state = seed;
        for k in (1..25usize).rev() {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
            names.swap(k, (state >> 33) as usize % (k + 1));
        }
        let other = renumbered(&mesh, &names);
        let options = [mean(4), cotangent(4), edge_sum(4), implicit(0.3)][which].clone();
        let here = run(&mesh, &normals(&mesh), &options);
        let there = run(&other, &normals(&other), &options);
        for (vertex, &name) in names.iter().enumerate() {
            prop_assert!((here[vertex] - there[name as usize]).length() < 1e-7);
        }
    }
}
