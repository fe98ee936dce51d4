//! Closed forms, and what is refused.

mod cases;
mod properties;

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::*;
use crate::math::{PI, cos, sin};
use crate::test_shapes::{cylinder, directions, grid, normals, sphere};
use crate::{Field, Quantity, Unmonitored};

fn solve(mesh: &Mesh, dirs: &Directions, t: f64, options: &CompensateOptions) -> Compensation {
    compensate(mesh, dirs, &t.into(), &t.into(), options, &Unmonitored).unwrap()
}

fn fine() -> CompensateOptions {
    CompensateOptions {
        tolerance: 1e-12,
        ..Default::default()
    }
}

fn local() -> CompensateOptions {
    CompensateOptions {
        mode: Compensate::Local,
        ..Default::default()
    }
}

/// Normals of `mesh` turned by `angle` about `axis`.
fn tilted(mesh: &Mesh, axis: DVec3, angle: f64) -> Directions {
    let turn = DQuat::from_axis_angle(axis, angle);
    let vectors = normals(mesh).outward().iter().map(|&n| turn * n).collect();
    directions(mesh, vectors)
}

#[test]
fn plane_at_any_tilt() {
    let plate = grid(4, 4, |x, y| [10.0 * x - 5.0, 10.0 * y - 5.0, 0.0]);
    for degrees in [0.0f64, 1.0, 30.0, 60.0, 80.0, 86.0] {
        let angle = degrees.to_radians();
        let dirs = tilted(&plate, DVec3::new(0.6, 0.8, 0.0), angle);
        for mode in [Compensate::Local, Compensate::Global] {
            let even = solve(&plate, &dirs, 0.5, &CompensateOptions { mode, ..fine() });
            for vertex in 0..25 {
                let factor = 1.0 / cos(angle);
                for side in [even.directions.outward(), even.directions.inward()] {
                    let length = side[vertex].length();
                    assert!(
                        (length - factor).abs() <= 1e-12 * factor,
                        "{degrees} {vertex} {length}"
                    );
                }
            }
            assert!((even.largest_tilt - angle).abs() < 1e-12);
            for report in [&even.outward, &even.inward] {
                assert_eq!(report.solved + report.extended, 25);
                assert!(report.errors.max <= 1e-12);
            }
        }
    }
}

#[test]
fn polyhedral_cylinder_under_global() {
    let tube = cylinder(64, 4);
    let even = solve(&tube, &normals(&tube), 0.1, &fine());
    for vertex in 0..tube.vertex_count() {
        // Outward the edge itself is closest, inward the two faces beside it.
        let (out, inn) = (
            even.directions.outward()[vertex],
            even.directions.inward()[vertex],
        );
        assert!((out.length() - 1.0).abs() <= 1e-12);
        assert!((inn.length() - 1.0 / cos(PI / 64.0)).abs() <= 1e-12);
    }
    assert!(even.outward.errors.max <= 1e-12 && even.inward.errors.max <= 1e-12);
    assert_eq!(
        even.inward.solved + even.inward.extended,
        tube.vertex_count()
    );
}

#[test]
fn polyhedral_cylinder_at_a_tilt_keeps_the_distance() {
    let tube = cylinder(64, 8);
    let surface = Surface::new(&tube, &Unmonitored).unwrap();
    for degrees in [20.0f64, 45.0, 60.0] {
        let dirs = tilted(&tube, DVec3::Z, degrees.to_radians());
        let even = solve(
            &tube,
            &dirs,
            0.1,
            &CompensateOptions {
                border: Border::Clip,
                ..fine()
            },
        );
        for (vertex, place) in tube.positions().iter().enumerate() {
            let outside = *place + 0.1 * even.directions.outward()[vertex];
            let inside = *place - 0.1 * even.directions.inward()[vertex];
            assert!((surface.closest(outside).distance - 0.1).abs() <= 1e-13);
            assert!((surface.closest(inside).distance - 0.1).abs() <= 1e-13);
        }
    }
}

#[test]
fn polyhedral_sphere_under_global() {
    let ball = sphere(24, 12);
    let dirs = normals(&ball);
    let t = 0.05;
    let even = solve(&ball, &dirs, t, &fine());
    let triangles = ball.triangles();
    let mut least = vec![1.0f64; ball.vertex_count()];
    for triangle in ball.triangle_vertices(&triangles) {
        let [a, b, c] = triangle.map(|v| ball.positions()[v as usize]);
        let normal = (b - a).cross(c - a).normalize();
        for &v in ball
            .face(0)
            .iter()
            .chain(&triangle)
            .filter(|v| triangle.contains(v))
        {
            let cosine = normal.dot(dirs.outward()[v as usize]);
            least[v as usize] = least[v as usize].min(cosine);
        }
    }
    for (vertex, &cosine) in least.iter().enumerate() {
        let (out, inn) = (
            even.directions.outward()[vertex],
            even.directions.inward()[vertex],
        );
        assert!((out.length() - 1.0).abs() <= 1e-12);
        // Inside a convex body the least inclined face is not the nearest.
        assert!((inn.length() - 1.0 / cosine).abs() <= 1e-12, "{vertex}");
    }
}

#[test]
fn local_is_off_on_a_cylinder_as_known() {
    let tube = cylinder(64, 4);
    let error = |degrees: f64, t: f64| {
        let dirs = tilted(&tube, DVec3::Z, degrees.to_radians());
        let even = solve(&tube, &dirs, t, &local());
        (even.outward.errors.max, even.inward.errors.max)
    };
    let (out, inn) = error(0.0, 0.1);
    assert!(
        out < 1e-12 && (0.0011..0.0013).contains(&inn),
        "{out} {inn}"
    );
    let (out, inn) = error(20.0, 0.1);
    assert!((0.016..0.018).contains(&out) && (0.0185..0.0195).contains(&inn));
    let (out, inn) = error(45.0, 0.1);
    assert!((0.045..0.05).contains(&out) && (0.06..0.065).contains(&inn));
}

/// Two plates 1.6 apart that face each other.
fn walls() -> Mesh {
    let mut positions = Vec::new();
    let mut faces: Vec<[u32; 4]> = Vec::new();
    for (x, flip) in [(0.0, false), (1.6, true)] {
        let first = positions.len() as u32;
        let plate = grid(4, 4, |u, v| [x, 8.0 * u - 4.0, 8.0 * v - 4.0]);
        positions.extend(plate.positions().iter().map(|p| p.to_array()));
        faces.extend(plate.topology().faces().map(|face| {
            let [a, b, c, d] = [face[0], face[1], face[2], face[3]].map(|v| v + first);
            if flip { [d, c, b, a] } else { [a, b, c, d] }
        }));
    }
    Mesh::from_faces(positions, &faces).unwrap()
}

#[test]
fn local_says_where_the_closest_place_leaves_the_faces_around() {
    let walls = walls();
    // At 0.7 the own wall is closest, at 1 the other one, 0.6 away.
    let even = solve(&walls, &normals(&walls), 0.7, &local());
    assert!(even.outward.left_faces.is_empty() && even.outward.errors.max < 1e-12);
    let even = solve(&walls, &normals(&walls), 1.0, &local());
    assert_eq!(even.outward.left_faces.len(), walls.vertex_count());
    assert!((even.outward.errors.max - 0.4).abs() < 1e-12);
    assert!(even.inward.left_faces.is_empty());
}

#[test]
fn two_walls_closer_than_twice_the_thickness() {
    let walls = walls();
    let even = solve(&walls, &normals(&walls), 1.0, &CompensateOptions::default());
    assert_eq!(even.outward.unsolved.len(), walls.vertex_count());
    for unsolved in &even.outward.unsolved {
        assert!((unsolved.reached - 0.8).abs() < 1e-12);
        let length = even.directions.outward()[unsolved.vertex as usize].length();
        assert!((length - 0.8).abs() < 1e-12);
    }
    assert_eq!(
        even.inward.solved + even.inward.extended,
        walls.vertex_count()
    );
    // With room enough both are solved.
    let even = solve(
        &walls,
        &normals(&walls),
        0.79,
        &CompensateOptions::default(),
    );
    assert!(even.outward.unsolved.is_empty());
}

#[test]
fn borders_are_extended_up_to_half_as_much_again() {
    let plate = grid(2, 2, |x, y| [x, y, 0.0]);
    let dirs = directions(&plate, vec![DVec3::new(0.6, 0.0, 0.8); 9]);
    let t = 0.25;
    let clip = CompensateOptions {
        border: Border::Clip,
        ..fine()
    };
    let clipped = solve(&plate, &dirs, t, &clip);
    let extended = solve(&plate, &dirs, t, &fine());
    for vertex in 0..9 {
        let leans_out = vertex % 3 == 2;
        let length = clipped.directions.outward()[vertex].length();
        // Beyond the border the border itself is closest, at full length.
        assert!((length - if leans_out { 1.0 } else { 1.25 }).abs() < 1e-12);
        assert!((extended.directions.outward()[vertex].length() - 1.25).abs() < 1e-12);
    }
    assert_eq!((extended.outward.solved, extended.outward.extended), (6, 3));
    assert_eq!((extended.inward.solved, extended.inward.extended), (6, 3));
    assert!(extended.outward.errors.max < 1e-12);
    // Along the plate no length reaches the extension: the value of Clip stays.
    let flat = directions(&plate, vec![DVec3::new(1.0, 0.0, 0.0); 9]);
    let flat = solve(&plate, &flat, t, &fine());
    assert_eq!(flat.outward.border_clipped.len(), 9);
    assert!((flat.directions.outward()[2].length() - 1.0).abs() < 1e-12);
}

#[test]
fn wrong_directions_are_named() {
    let plate = grid(1, 1, |x, y| [x, y, 0.0]);
    let with = |vector: DVec3| {
        let mut vectors = vec![DVec3::Z; 4];
        vectors[2] = vector;
        let dirs = directions(&plate, vectors);
        compensate(
            &plate,
            &dirs,
            &0.1.into(),
            &0.1.into(),
            &local(),
            &Unmonitored,
        )
    };
    let vertices = vec![2];
    assert_eq!(
        with(-DVec3::Z).unwrap_err(),
        GeometryError::OpposedDirection {
            vertices: vertices.clone()
        }
    );
    assert_eq!(
        with(DVec3::ZERO).unwrap_err(),
        GeometryError::ZeroDirection {
            vertices: vertices.clone()
        }
    );
    let tangential = with(DVec3::X).unwrap();
    assert_eq!(tangential.outward.clamped, vertices);
    assert!((tangential.directions.outward()[2].length() - 20.0).abs() < 1e-12);
    let dirs = normals(&plate);
    let once = solve(&plate, &dirs, 0.1, &local());
    let twice = compensate(
        &plate,
        &once.directions,
        &0.1.into(),
        &0.1.into(),
        &local(),
        &Unmonitored,
    );
    assert!(matches!(twice, Err(GeometryError::Compensated { .. })));
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let result = compensate(
            &plate,
            &dirs,
            &wrong.into(),
            &0.1.into(),
            &local(),
            &Unmonitored,
        );
        assert!(
            matches!(result, Err(GeometryError::OutOfRange { .. })),
            "{wrong}"
        );
    }
}

#[test]
fn extreme_thickness_stays_finite() {
    let hill = grid(6, 6, |x, y| [x, y, 0.3 * sin(3.0 * x) * sin(3.0 * y)]);
    let dirs = normals(&hill);
    for t in [0.0, 1e-300, 1e-9, 1e9, 1e150] {
        for mode in [Compensate::Local, Compensate::Global] {
            let even = solve(
                &hill,
                &dirs,
                t,
                &CompensateOptions {
                    mode,
                    ..Default::default()
                },
            );
            for vector in even
                .directions
                .outward()
                .iter()
                .chain(even.directions.inward().iter())
            {
                assert!(vector.is_finite(), "{t}");
            }
        }
    }
}

#[test]
fn thickness_varies_over_the_mesh_and_isolated_vertices_stay() {
    let mut positions: Vec<_> = grid(3, 3, |x, y| [x, y, 0.0])
        .positions()
        .iter()
        .map(|p| p.to_array())
        .collect();
    positions.push([5.0, 5.0, 5.0]);
    let faces: Vec<Vec<u32>> = grid(3, 3, |x, y| [x, y, 0.0])
        .topology()
        .faces()
        .map(<[u32]>::to_vec)
        .collect();
    let plate = Mesh::from_faces(positions, &faces).unwrap();
    let values: Vec<f64> = (0..17).map(|v| 0.01 * f64::from(v)).collect();
    let field = Field::new(Domain::Vertex, Quantity::Length, values).unwrap();
    let amount = Amount::Field(Arc::new(field));
    let leaning = DVec3::new(0.0, 0.6, 0.8);
    let mut vectors = vec![leaning; 16];
    vectors.push(DVec3::ZERO);
    let dirs = directions(&plate, vectors);
    let even = compensate(&plate, &dirs, &amount, &0.2.into(), &fine(), &Unmonitored).unwrap();
    for vertex in 0..16 {
        assert!((even.directions.outward()[vertex] - leaning / 0.8).length() < 1e-12);
    }
    assert_eq!(even.directions.outward()[16], DVec3::ZERO);
    assert_eq!(even.outward.solved + even.outward.extended, 16);
}
