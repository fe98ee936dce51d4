//! What must hold for every base.

use proptest::prelude::*;

use super::*;
use crate::test_shapes::renumbered;

#[test]
fn thread_count_changes_no_bit() {
    let hills = hills();
    let dirs = leaning(&hills);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| solve(&hills, &dirs, 0.05, &CompensateOptions::default()))
    };
    let (one, three) = (run(1), run(3));
    assert_eq!(one.directions.digest(), three.directions.digest());
    assert_eq!((one.outward, one.inward), (three.outward, three.inward));
}

/// Gentle hills, some 5000 vertices, so that there are several chunks.
fn hills() -> Mesh {
    grid(70, 70, |x, y| [x, y, 0.05 * sin(7.0 * x) * cos(5.0 * y)])
}

/// Normals that all lean to one side, up to some 30 degrees.
fn leaning(mesh: &Mesh) -> Directions {
    let normals = normals(mesh);
    let lean = DVec3::new(0.4, 0.3, 0.2);
    directions(mesh, normals.outward().iter().map(|&n| n + lean).collect())
}

fn small_hills() -> Mesh {
    grid(6, 5, |x, y| [x, y, 0.1 * sin(5.0 * x) * cos(4.0 * y)])
}

fn assert_close(a: &[DVec3], b: &[DVec3]) {
    for (vertex, (a, b)) in a.iter().zip(b).enumerate() {
        assert!((*a - *b).length() < 1e-9, "{vertex}: {a} {b}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn moving_the_base_moves_the_result(
        x in -1.0..1.0f64, angle in 0.0..PI, scale in 0.01..100.0f64, is_local in any::<bool>(),
    ) {
        let base = small_hills();
        let dirs = leaning(&base);
        let turn = DQuat::from_axis_angle(DVec3::new(x, 0.5, 0.7).normalize(), angle);
        let shift = DVec3::new(5.0, x, -3.0) * scale;
        let moved = base.positions().iter().map(|&p| turn * p * scale + shift).collect();
        let moved = base.with_positions(moved).unwrap();
        let turned = dirs.outward().iter().map(|&d| turn * d).collect();
        let options = if is_local { local() } else { fine() };
        let here = solve(&base, &dirs, 0.05, &options);
        let there = solve(&moved, &directions(&moved, turned), 0.05 * scale, &options);
        let back = |side: &[DVec3]| side.iter().map(|&d| turn.inverse() * d).collect::<Vec<_>>();
        assert_close(here.directions.outward(), &back(there.directions.outward()));
        assert_close(here.directions.inward(), &back(there.directions.inward()));
    }

    #[test]
    fn renumbering_the_base_renumbers_the_result(seed in 1u64..1000) {
        let base = small_hills();
        let dirs = leaning(&base);
        let mut names: Vec<u32> = (0..base.vertex_count() as u32).collect();
        let mut state = seed;
        for k in (1..names.len()).rev() {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
            names.swap(k, (state >> 33) as usize % (k + 1));
        }
        let other = renumbered(&base, &names);
        let mut vectors = vec![DVec3::ZERO; names.len()];
        for (&direction, &name) in dirs.outward().iter().zip(&names) {
            vectors[name as usize] = direction;
        }
        let here = solve(&base, &dirs, 0.05, &fine());
        let there = solve(&other, &directions(&other, vectors), 0.05, &fine());
        let back = |side: &[DVec3]| names.iter().map(|&n| side[n as usize]).collect::<Vec<_>>();
        assert_close(here.directions.outward(), &back(there.directions.outward()));
        assert_close(here.directions.inward(), &back(there.directions.inward()));
    }

    #[test]
    fn turning_the_base_inside_out_swaps_the_sides(lean in -0.5..0.5f64, t in 0.01..0.08f64) {
        let base = small_hills();
        let vectors = |sign: f64| {
            normals(&base).outward().iter().map(|&n| sign * (n + DVec3::X * lean)).collect()
        };
        let faces: Vec<Vec<u32>> = base
            .topology()
            .faces()
            // The fan's corner stays first, so that the surface is the same.
            .map(|face| [face[0], face[3], face[2], face[1]].to_vec())
            .collect();
        let places = base.positions().iter().map(|p| p.to_array()).collect();
        let flipped = Mesh::from_faces(places, &faces).unwrap();
        let here = solve(&base, &directions(&base, vectors(1.0)), t, &fine());
        let there = solve(&flipped, &directions(&flipped, vectors(-1.0)), t, &fine());
        let back = |side: &[DVec3]| side.iter().map(|&d| -d).collect::<Vec<_>>();
        assert_close(here.directions.outward(), &back(there.directions.inward()));
        assert_close(here.directions.inward(), &back(there.directions.outward()));
    }

    #[test]
    fn what_counts_as_solved_is(tilt in 0.0..1.2f64, turn in 0.0..6.0f64, t in 0.01..0.3f64) {
        let base = small_hills();
        let axis = DVec3::new(cos(turn), sin(turn), 0.0);
        let dirs = tilted(&base, axis, tilt);
        let surface = Surface::new(&base, &Unmonitored).unwrap();
        let even = compensate(&base, &dirs, &t.into(), &t.into(), &Default::default(), &Unmonitored);
        let even = even.unwrap();
        for (side, sign, report) in [
            (even.directions.outward(), t, &even.outward),
            (even.directions.inward(), -t, &even.inward),
        ] {
            let named: Vec<u32> = report.unsolved.iter().map(|unsolved| unsolved.vertex).collect();
            for vertex in 0..base.vertex_count() {
                let point = base.positions()[vertex] + side[vertex] * sign;
                let clipped = report.border_clipped.contains(&(vertex as u32));
                let border = if clipped { Border::Clip } else { Border::Extend };
                let off = (surface.distance(point, border).0 - t).abs() / t;
                prop_assert!((off <= 1.0001e-4) != named.contains(&(vertex as u32)));
            }
        }
    }
}
