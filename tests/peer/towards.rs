//! Directions no recorded case has: flat cells, smoothed targets, scaled normals.

use tessgraph_geometry::glam::DVec3;

use super::case::Verdict;
use super::folders::{folder, recorded, verdict};
use super::mapped::obj;

/// What becomes of a base and a component with these settings and files.
fn of(settings: &str, files: &[(&str, &str)]) -> Verdict {
    let settings = format!("{{\"settings\": {{{settings}}}}}");
    let mut all = vec![("settings.json", settings.as_str())];
    all.extend_from_slice(files);
    verdict(folder("01_saddle_default", &all).path())
}

/// Three quads side by side along x, the last one rising, of width 2 in y.
const ROOF: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [2.0, 0.0, 0.0],
    [3.0, 0.0, 1.0],
    [0.0, 2.0, 0.0],
    [1.0, 2.0, 0.0],
    [2.0, 2.0, 0.0],
    [3.0, 2.0, 1.0],
];

fn roof_faces() -> Vec<Vec<usize>> {
    (0..3).map(|k| vec![k, k + 1, k + 5, k + 4]).collect()
}

/// A lid at height 0.3 over the whole box, one quad; its box is 2 by 4.
fn lid() -> String {
    let places = [[0.0, 0.0], [2.0, 0.0], [2.0, 4.0], [0.0, 4.0]].map(|[x, y]| [x, y, 0.3]);
    obj(&places, &[vec![0, 1, 2, 3]])
}

/// The corners of the roof's faces moved by `along`, for face and vertex, as pieces.
fn lifted(along: impl Fn(usize, usize) -> DVec3) -> String {
    let mut places = Vec::new();
    for (face, corners) in roof_faces().iter().enumerate() {
        for &vertex in corners {
            places.push((DVec3::from(ROOF[vertex]) + along(face, vertex)).to_array());
        }
    }
    let faces: Vec<Vec<usize>> = (0..3).map(|k| (4 * k..4 * k + 4).collect()).collect();
    obj(&places, &faces)
}

fn judge(settings: &str, theirs: &str, more: &[(&str, &str)]) -> Verdict {
    let (base, lid) = (obj(&ROOF, &roof_faces()), lid());
    let mut files = vec![
        ("base.obj", base.as_str()),
        ("component.obj", &lid),
        ("tissue.obj", theirs),
    ];
    files.extend_from_slice(more);
    of(settings, &files)
}

#[test]
fn flat_cells_have_one_normal_each() {
    let normal = |face: usize| match face {
        2 => DVec3::new(-1.0, 0.0, 1.0).normalize(),
        _ => DVec3::Z,
    };
    let theirs = lifted(|face, _| normal(face) * 0.3);
    let flat = "\"normals_mode\": \"FACES\", \"smooth_normals\": true";
    let constant = format!("{flat}, \"scale_mode\": \"CONSTANT\"");
    let verdict = judge(&constant, &theirs, &[]);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    // Heights by the mean size of the faces round each vertex, against the lid's box.
    let area = |vertex: usize| [2.0, 2.0, 1.0 + 2f64.sqrt(), 8f64.sqrt()][vertex % 4];
    let theirs = lifted(|face, vertex| normal(face) * (0.3 * (area(vertex) / 8.0).sqrt()));
    let verdict = judge(flat, &theirs, &[]);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    // Levelled, the flat ones would have nothing left; halved, the third leans.
    let half = DVec3::new(-1.0, 0.0, 0.5).normalize();
    let theirs = lifted(|face, _| {
        if face == 2 {
            half * 0.3
        } else {
            DVec3::Z * 0.3
        }
    });
    let verdict = judge(&format!("{constant}, \"normals_z\": 0.5"), &theirs, &[]);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
}

/// Vectors to a target above the roof, each with a length of its own.
fn way(vertex: usize) -> DVec3 {
    let k = vertex as f64;
    DVec3::new(0.1 * k, 0.02 * k * k - 0.3, 1.0 + 0.25 * k)
}

/// One pass of n + 0.2 w sum (n_j - n) over the roof's edges.
fn smoothed(weight: impl Fn(usize) -> f64) -> Vec<DVec3> {
    let beside = |v: usize| {
        let along = [
            (v != 0 && v != 4).then(|| v - 1),
            (v % 4 < 3).then_some(v + 1),
        ];
        along.into_iter().flatten().chain([(v + 4) % 8])
    };
    let pass = |v: usize| {
        let sum: DVec3 = beside(v).map(|other| way(other) - way(v)).sum();
        way(v) + sum * (0.2 * weight(v))
    };
    (0..8).map(pass).collect()
}

#[test]
fn targets_are_smoothed_with_their_lengths() {
    let target: Vec<[f64; 3]> = (0..8)
        .map(|v| (DVec3::from(ROOF[v]) + way(v)).to_array())
        .collect();
    let target = obj(&target, &roof_faces());
    let weights: String = (0..8)
        .map(|v| format!("{}\n", f64::from(v) / 7.0))
        .collect();
    let files = [("target.obj", target.as_str()), ("weights.csv", &weights)];
    let smooth =
        "\"normals_mode\": \"OBJECT\", \"smooth_normals\": true, \"smooth_normals_iter\": 1";
    let all = smoothed(|_| 1.0);
    let theirs = lifted(|_, vertex| all[vertex] * 0.3);
    let verdict = judge(smooth, &theirs, &files);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    let some = smoothed(|vertex| vertex as f64 / 7.0);
    let theirs = lifted(|_, vertex| some[vertex] * 0.3);
    let by_group = format!("{smooth}, \"vertex_group_smooth_normals\": \"W\"");
    let verdict = judge(&by_group, &theirs, &files);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    // At one thickness: as far as the height is reached along the vertex normal.
    let slope = DVec3::new(-1.0, 0.0, 1.0).normalize();
    let normal = |vertex: usize| match vertex % 4 {
        2 => (DVec3::Z + slope).normalize(),
        3 => slope,
        _ => DVec3::Z,
    };
    let theirs = lifted(|_, v| all[v] * (0.3 / all[v].dot(normal(v))));
    let constant = format!("{smooth}, \"scale_mode\": \"CONSTANT\"");
    let verdict = judge(&constant, &theirs, &files);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
}

#[test]
fn normals_are_scaled_by_a_group() {
    let weights: String = (0..8)
        .map(|v| format!("{}\n", f64::from(v) / 7.0))
        .collect();
    let slope = DVec3::new(-1.0, 0.0, 1.0).normalize();
    let scaled = |vertex: usize| {
        let normal = match vertex % 4 {
            2 => (DVec3::Z + slope).normalize(),
            3 => slope,
            _ => DVec3::Z,
        };
        let share = vertex as f64 / 7.0;
        (normal * DVec3::new(1.0 - 0.75 * share, 1.0, 1.0)).normalize()
    };
    let theirs = lifted(|_, vertex| scaled(vertex) * 0.3);
    let settings = "\"scale_mode\": \"CONSTANT\", \"normals_x\": 0.25, \
                    \"vertex_group_scale_normals\": \"W\"";
    let verdict = judge(settings, &theirs, &[("weights.csv", &weights)]);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
}

#[test]
fn a_target_that_does_not_fit_is_passed_over() {
    // As if nothing had been asked for: along the normals.
    let theirs = recorded("01_saddle_default", "tissue.obj");
    let target = "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n";
    let files = [("target.obj", target), ("tissue.obj", &theirs)];
    let verdict = of("\"normals_mode\": \"OBJECT\"", &files);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
}
