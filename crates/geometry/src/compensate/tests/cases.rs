//! The folds of the reference cases.

use super::*;
use crate::math::lerp;
use crate::test_shapes::case;

/// Target minus base, vertex by vertex.
fn towards(base: &Mesh, target: &Mesh) -> Directions {
    let pairs = base.positions().iter().zip(target.positions().iter());
    directions(base, pairs.map(|(&p, &t)| t - p).collect())
}

#[test]
fn narrow_fold_along_target_directions() {
    let Some(base) = case("08_fold_target_even10/base.obj") else {
        return;
    };
    let Some(target) = case("08_fold_target_even10/target.obj") else {
        return;
    };
    let dirs = towards(&base, &target);
    let (out, inn) = (0.4, 0.1);
    let even = compensate(
        &base,
        &dirs,
        &out.into(),
        &inn.into(),
        &Default::default(),
        &Unmonitored,
    )
    .unwrap();
    for report in [&even.outward, &even.inward] {
        assert_eq!(report.solved + report.extended, 225);
        assert!(report.solved_errors.max <= 1e-4);
        assert!(report.most_evaluations <= 6, "{}", report.most_evaluations);
    }
    assert!(even.outward.extended > 0);
}

#[test]
fn narrow_fold_along_normals_names_what_does_not_fit() {
    let Some(base) = case("03_fold_default/base.obj") else {
        return;
    };
    let even = compensate(
        &base,
        &normals(&base),
        &0.4.into(),
        &0.1.into(),
        &Default::default(),
        &Unmonitored,
    )
    .unwrap();
    // Walls closer than twice the thickness: five columns on each side of the
    // fold, all nine rows of each.
    assert_eq!(even.outward.unsolved.len(), 90);
    assert_eq!(even.outward.solved, 135);
    assert!(even.inward.unsolved.is_empty());
    for unsolved in &even.outward.unsolved {
        // Half of the gap at that height, which is less than wanted.
        assert!(unsolved.reached < 0.35 && unsolved.wanted > 0.39);
    }
}

/// The top vertices of the cases' component on every face, each solved at its
/// own place: (u, v) are 0.02 and 0.98.
fn per_vertex(base: &Mesh, dirs: &Directions, t: f64, side: Side) -> Vec<Solution> {
    let surface = Surface::new(base, &Unmonitored).unwrap();
    let solver = Solver::new(&surface);
    let normals = normals(base);
    let mut found = Vec::new();
    for face in base.topology().faces() {
        let at = |values: &[DVec3], u: f64, v: f64| {
            let [a, b, c, d] = [face[0], face[1], face[2], face[3]].map(|v| values[v as usize]);
            lerp(lerp(a, b, u), lerp(d, c, u), v)
        };
        for (u, v) in [(0.02, 0.02), (0.98, 0.02), (0.98, 0.98), (0.02, 0.98)] {
            let start = Start {
                origin: at(base.positions(), u, v),
                direction: at(dirs.outward(), u, v).normalize(),
                normal: at(normals.outward(), u, v).normalize(),
                off_surface: f64::INFINITY,
            };
            found.push(solver.solve(&start, t, side));
        }
    }
    found
}

fn count(found: &[Solution], status: Status) -> usize {
    found
        .iter()
        .filter(|solution| solution.status == status)
        .count()
}

#[test]
fn every_component_vertex_can_be_solved_for_itself() {
    let Some(base) = case("03_fold_default/base.obj") else {
        return;
    };
    let Some(target) = case("08_fold_target_even10/target.obj") else {
        return;
    };
    let top = per_vertex(&base, &normals(&base), 0.4, Side::Outward);
    assert_eq!(
        (count(&top, Status::Solved), count(&top, Status::Unsolved)),
        (448, 320)
    );
    let dirs = towards(&base, &target);
    for (side, t) in [(Side::Outward, 0.4), (Side::Inward, 0.1)] {
        let found = per_vertex(&base, &dirs, t, side);
        assert_eq!(
            count(&found, Status::Solved) + count(&found, Status::Extended),
            768
        );
        for solution in found {
            assert!((solution.reached - t).abs() <= 2e-4 * t);
            assert!(solution.evaluations <= 12);
        }
    }
}

/// Error at the component's vertices with one factor a base vertex: max, rms.
fn between_vertices(base: &Mesh, even: &Directions, t: f64, side: Side) -> Errors {
    let surface = Surface::new(base, &Unmonitored).unwrap();
    let (vectors, sign) = match side {
        Side::Outward => (even.outward(), 1.0),
        Side::Inward => (even.inward(), -1.0),
    };
    let mut errors = Vec::new();
    for face in base.topology().faces() {
        for (u, v) in [(0.02, 0.02), (0.98, 0.02), (0.98, 0.98), (0.02, 0.98)] {
            let corners = [face[0], face[1], face[2], face[3]];
            let blend = |of: &dyn Fn(u32) -> DVec3| {
                let [a, b, c, d] = corners.map(of);
                lerp(lerp(a, b, u), lerp(d, c, u), v)
            };
            let place = blend(&|v| base.positions()[v as usize]);
            let sense = blend(&|v| vectors[v as usize].normalize()).normalize();
            let length = blend(&|v| DVec3::X * vectors[v as usize].length()).x;
            let point = place + sense * (sign * t * length);
            errors.push((surface.distance(point, Border::Extend).0 - t).abs() / t);
        }
    }
    Errors::of(errors.into_iter())
}

#[test]
fn one_factor_a_base_vertex_is_nearly_even_between_them() {
    for (folder, out) in [
        ("08_fold_target_even10", 0.4),
        ("32_valley_fold_target_constant", 1.3),
    ] {
        let Some(base) = case(&format!("{folder}/base.obj")) else {
            return;
        };
        let Some(target) = case(&format!("{folder}/target.obj")) else {
            return;
        };
        let (dirs, options) = (towards(&base, &target), CompensateOptions::default());
        let even = compensate(
            &base,
            &dirs,
            &out.into(),
            &0.1.into(),
            &options,
            &Unmonitored,
        );
        let even = even.unwrap();
        for (side, t) in [(Side::Outward, out), (Side::Inward, 0.1)] {
            let errors = between_vertices(&base, &even.directions, t, side);
            assert!(errors.rms <= 5e-3 && errors.max <= 1.5e-2, "{errors:?}");
        }
        for report in [&even.outward, &even.inward] {
            assert_eq!(report.solved + report.extended, base.vertex_count());
        }
    }
}
