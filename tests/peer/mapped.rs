//! Settings no recorded case has, held by small cases with a closed form.

use super::case::Verdict;
use super::folders::{folder, recorded, verdict};

const SADDLE: &str = "01_saddle_default";

/// Places, and faces by vertices counted from 0.
type Plates = (Vec<[f64; 3]>, Vec<Vec<usize>>);

/// What becomes of a case of these files, `settings` without its braces.
fn of(settings: &str, files: &[(&str, &str)]) -> Verdict {
    let settings = format!("{{\"settings\": {{{settings}}}}}");
    let mut all = vec![("settings.json", settings.as_str())];
    all.extend_from_slice(files);
    verdict(folder(SADDLE, &all).path())
}

/// An OBJ file of places and of faces by vertices counted from 0.
pub(super) fn obj(places: &[[f64; 3]], faces: &[Vec<usize>]) -> String {
    let vertex = |[x, y, z]: &[f64; 3]| format!("v {x:?} {y:?} {z:?}\n");
    let corners = |face: &Vec<usize>| -> String {
        let corners = face.iter().map(|vertex| format!(" {}", vertex + 1));
        corners.collect()
    };
    let vertices: String = places.iter().map(vertex).collect();
    let faces = faces.iter().map(|face| format!("f{}\n", corners(face)));
    vertices + &faces.collect::<String>()
}

/// `count` by `count` quads of side `side` from `[x, y, z]` on.
fn plate(from: [f64; 3], side: f64, count: usize) -> Plates {
    let at = |k: usize| k as f64 * side;
    let places = (0..=count).flat_map(|j| (0..=count).map(move |i| (i, j)));
    let places = places.map(|(i, j)| [from[0] + at(i), from[1] + at(j), from[2]]);
    let row = count + 1;
    let cells = (0..count).flat_map(|j| (0..count).map(move |i| j * row + i));
    let faces = cells.map(|k| vec![k, k + 1, k + row + 1, k + row]);
    (places.collect(), faces.collect())
}

/// Several plates as one mesh of pieces.
fn pieces(plates: &[Plates]) -> Plates {
    let (mut places, mut faces) = (Vec::new(), Vec::new());
    for (more, with) in plates {
        let first = places.len();
        let moved = |face: &Vec<usize>| face.iter().map(|vertex| vertex + first).collect();
        faces.extend(with.iter().map(moved));
        places.extend_from_slice(more);
    }
    (places, faces)
}

/// The pieces of the recorded saddle over the faces for which `keep`.
fn over_faces(keep: impl Fn(usize) -> bool) -> String {
    let theirs = recorded(SADDLE, "tissue.obj");
    let of = |file: &str, mark: &str| {
        let text = recorded(SADDLE, file);
        text.lines().filter(|line| line.starts_with(mark)).count()
    };
    let (vertices, faces) = (of("component.obj", "v "), of("component.obj", "f "));
    let marked = |mark: &'static str| theirs.lines().filter(move |line| line.starts_with(mark));
    let mut out = String::new();
    for (k, line) in marked("v ").enumerate() {
        if keep(k / vertices) {
            out += &format!("{line}\n");
        }
    }
    for (k, line) in marked("f ").enumerate() {
        let piece = k / faces;
        if !keep(piece) {
            continue;
        }
        let before = (0..piece).filter(|&other| !keep(other)).count() * vertices;
        let renamed = |corner: &str| {
            let index = corner.split('/').next().unwrap_or("");
            let index: usize = index.parse().expect("a vertex");
            format!(" {}", index - before)
        };
        let corners: String = line[2..].split_whitespace().map(renamed).collect();
        out += &format!("f{corners}\n");
    }
    out
}

#[test]
fn only_selected_faces_take_a_component() {
    let count = recorded(SADDLE, "base.obj").matches("f ").count();
    let chosen = |face: usize| face % 3 == 1;
    let selection = (0..count).map(|face| format!("{}\n", u8::from(chosen(face))));
    let selection: String = selection.collect();
    let theirs = over_faces(chosen);
    let files = [
        ("selection.csv", selection.as_str()),
        ("tissue.obj", &theirs),
    ];
    let verdict = of("\"bool_selection\": true", &files);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    let verdict = of("\"bool_selection\": false", &files);
    assert!(matches!(verdict, Verdict::Differs(_)), "{verdict}");
    // Without the file nobody knows what was selected.
    let verdict = of("\"bool_selection\": true", &[]);
    assert!(matches!(verdict, Verdict::Refused(_)), "{verdict}");
}

#[test]
fn only_faces_of_a_material_take_a_component() {
    let base = recorded(SADDLE, "base.obj");
    let mut face = 0;
    let mut with_materials = String::new();
    for line in base.lines() {
        if line.starts_with("f ") {
            with_materials += ["usemtl Stone\n", "usemtl Glass\n"][face % 2];
            face += 1;
        }
        with_materials += &format!("{line}\n");
    }
    let files = |theirs: &'static str| {
        [
            ("base.obj", with_materials.clone()),
            ("tissue.obj", theirs.into()),
        ]
    };
    for id in 0..2 {
        let theirs = over_faces(|face| face % 2 == id).leak();
        let settings = format!("\"bool_material_id\": true, \"material_id\": {id}");
        let files = files(theirs);
        let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
        let verdict = of(&settings, &files);
        assert!(matches!(verdict, Verdict::Reproduced), "{id}: {verdict}");
    }
}

/// A component of 2 by 2 quads at height 0.1: each pass makes four plates of one.
fn two_by_two() -> String {
    let (places, faces) = plate([0.0, 0.0, 0.1], 0.5, 2);
    obj(&places, &faces)
}

/// The plates of one pass over a unit square that lies at `from`.
fn pass(from: [f64; 3], pass: u32) -> Plates {
    let count = 1 << (pass - 1);
    let side = 1.0 / f64::from(count);
    let at = |k: i32| f64::from(k) * side;
    let plates = (0..count).flat_map(|j| (0..count).map(move |i| (i, j)));
    let plates = plates.map(|(i, j)| {
        let from = [from[0] + at(i), from[1] + at(j), from[2]];
        plate(from, side / 2.0, 2)
    });
    pieces(&plates.collect::<Vec<_>>())
}

#[test]
fn passes_take_what_the_pass_before_made() {
    let (places, faces) = plate([0.0; 3], 1.0, 1);
    let (base, component) = (obj(&places, &faces), two_by_two());
    let judge = |more: &str, plates: &Plates| {
        let theirs = obj(&plates.0, &plates.1);
        let target = base
            .replace(" 0.0\n", " 0.8\n")
            .replace("v 1.0", "v 1.6")
            .replace("v 0.0", "v 0.6");
        let files = [
            ("base.obj", base.as_str()),
            ("component.obj", &component),
            ("target.obj", &target),
            ("tissue.obj", &theirs),
        ];
        of(&format!("\"scale_mode\": \"CONSTANT\"{more}"), &files)
    };
    let three = pass([0.0, 0.0, 0.3], 3);
    let verdict = judge(", \"iterations\": 3", &three);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    let verdict = judge(", \"iterations\": 2", &three);
    assert!(matches!(verdict, Verdict::Differs(_)), "{verdict}");
    let all = [1, 2, 3].map(|k| pass([0.0, 0.0, 0.1 * f64::from(k)], k));
    let verdict = judge(
        ", \"iterations\": 3, \"combine_mode\": \"ALL\"",
        &pieces(&all),
    );
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    // Towards a target at (0.6, 0, 0.8) first, then along normals.
    let towards = ", \"iterations\": 2, \"normals_mode\": \"OBJECT\"";
    let verdict = judge(towards, &pass([0.06, 0.0, 0.18], 2));
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
}

#[test]
fn components_turn_with_their_side_v_0_to_the_border() {
    let (places, faces) = plate([0.0; 3], 1.0, 3);
    // A component whose fourth vertex says which way it lies.
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.2, 0.6]];
    let box_corner = [0.0, 1.0];
    let drawn = [&corners[..], &[box_corner]].concat();
    let shape = vec![vec![0, 1, 2, 3], vec![0, 3, 4]];
    let drawn: Vec<[f64; 3]> = drawn.iter().map(|[x, y]| [*x, *y, 0.1]).collect();
    // The first border side of each face in its sense, with v = 0 on it.
    let sides = [
        ([0.0, 0.0], [1.0, 0.0], [0.0, 1.0]),
        ([1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]),
        ([1.0, 1.0], [-1.0, 0.0], [0.0, -1.0]),
        ([0.0, 1.0], [0.0, -1.0], [1.0, 0.0]),
    ];
    // Rows from y = 0 up; of two sides the one that comes first.
    let first = [3, 0, 0, 3, 0, 1, 2, 2, 1];
    let plates = first.iter().enumerate().map(|(face, &side)| {
        let (from, u, v) = sides[side];
        let cell = [(face % 3) as f64, (face / 3) as f64];
        let along = |p: &[f64; 3], k: usize| cell[k] + from[k] + p[0] * u[k] + p[1] * v[k];
        let place = |p: &[f64; 3]| [along(p, 0), along(p, 1), p[2]];
        (drawn.iter().map(place).collect(), shape.clone())
    });
    let theirs = pieces(&plates.collect::<Vec<_>>());
    let (base, component) = (obj(&places, &faces), obj(&drawn, &shape));
    let theirs = obj(&theirs.0, &theirs.1);
    let files = [
        ("base.obj", base.as_str()),
        ("component.obj", &component),
        ("tissue.obj", &theirs),
    ];
    let constant = "\"scale_mode\": \"CONSTANT\"";
    let verdict = of(
        &format!("{constant}, \"auto_rotate_boundary\": true"),
        &files,
    );
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    let verdict = of(constant, &files);
    assert!(matches!(verdict, Verdict::Differs(_)), "{verdict}");
}

#[test]
fn loops_of_a_group_are_closed() {
    // Bottom and top of a box, and a plate beside it.
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let at = |z: f64, x: f64| corners.map(|[u, v]| [u + x, v, z]);
    let places = [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 5.0)].concat();
    let sheets = vec![vec![3, 2, 1, 0], vec![4, 5, 6, 7], vec![8, 9, 10, 11]];
    let base = obj(&places, &sheets);
    let component = obj(&at(0.0, 0.0), &[vec![0, 1, 2, 3]]);
    let judge = |more: &str, weights: [u8; 3], closing: &[Vec<usize>]| {
        let weights: String = weights.map(|w| format!("{w}\n").repeat(4)).concat();
        let theirs = obj(&places, &[sheets.as_slice(), closing].concat());
        let files = [
            ("base.obj", base.as_str()),
            ("component.obj", &component),
            ("weights.csv", &weights),
            ("tissue.obj", &theirs),
        ];
        let merged = "\"scale_mode\": \"CONSTANT\", \"merge\": true, \"bool_vertex_group\": true";
        of(&format!("{merged}, {more}"), &files)
    };
    let cap = |z: usize| vec![z + 3, z + 2, z + 1, z];
    let caps = "\"close_mesh\": \"CAP\", \"vertex_group_cap\": \"W\"";
    let verdict = judge(caps, [0, 0, 1], &[cap(8)]);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    let inverted = format!("{caps}, \"invert_vertex_group_cap\": true");
    let verdict = judge(&inverted, [1, 0, 1], &[cap(4)]);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    let walls = [0, 1, 2, 3].map(|k| vec![k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4]);
    let bridge = "\"close_mesh\": \"BRIDGE\", \"vertex_group_bridge\": \"W\"";
    let verdict = judge(bridge, [1, 1, 0], &walls);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    // Bridged by the group, capped without one.
    let both = "\"close_mesh\": \"BRIDGE_CAP\", \"vertex_group_bridge\": \"W\"";
    let verdict = judge(both, [1, 1, 0], &[&walls[..], &[cap(8)]].concat());
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
}

/// Quads in a row, from one place along x to the next, of width 1.
fn row(places: &[f64]) -> String {
    let count = places.len();
    let at = |y: f64| places.iter().map(move |&x| [x, y, 0.0]);
    let faces: Vec<Vec<usize>> = (0..count - 1)
        .map(|k| vec![k, k + 1, k + 1 + count, k + count])
        .collect();
    obj(&at(0.0).chain(at(1.0)).collect::<Vec<_>>(), &faces)
}

#[test]
fn patterns_that_were_cut_are_whole_again() {
    // A tile from the middle of each cell to the middle of the next.
    let (base, tile) = (row(&[0.0, 1.0, 2.0, 3.0]), row(&[0.5, 1.5]));
    let judge = |more: &str, theirs: &str| {
        let files = [
            ("base.obj", base.as_str()),
            ("component.obj", &tile),
            ("tissue.obj", theirs),
        ];
        let cyclic = "\"mode\": \"LOCAL\", \"bounds_x\": \"CYCLIC\", \"scale_mode\": \"CONSTANT\"";
        of(
            &format!("{cyclic}, \"merge\": true, \"merge_thres\": 0.01{more}"),
            &files,
        )
    };
    let healed = ", \"bool_dissolve_seams\": true";
    let verdict = judge(healed, &row(&[0.0, 0.5, 1.5, 2.5, 3.0]));
    assert!(matches!(verdict, Verdict::ReproducedWelded), "{verdict}");
    let verdict = judge("", &row(&[0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]));
    assert!(matches!(verdict, Verdict::ReproducedWelded), "{verdict}");
}

#[test]
fn neighbours_are_merged_within_a_distance() {
    // A component that leaves a gap of 0.02 between neighbours.
    let (base, tile) = (row(&[0.0, 1.0, 2.0]), row(&[0.01, 0.99]));
    let merged = row(&[0.01, 0.99, 1.99]);
    let apart = pieces(&[0.0, 1.0].map(|x| {
        let places = [[0.01, 0.0], [0.99, 0.0], [0.99, 1.0], [0.01, 1.0]];
        (
            places.map(|[u, v]| [u + x, v, 0.0]).to_vec(),
            vec![vec![0, 1, 2, 3]],
        )
    }));
    let apart = obj(&apart.0, &apart.1);
    for (more, theirs) in [
        ("\"merge_thres\": 0.03", &merged),
        (
            "\"merge_thres\": 0.03, \"merge_open_edges_only\": true",
            &merged,
        ),
        ("\"merge_thres\": 0.01", &apart),
        ("\"merge_thres\": 0.0001", &apart),
    ] {
        let files = [
            ("base.obj", base.as_str()),
            ("component.obj", &tile),
            ("tissue.obj", theirs),
        ];
        let local = "\"mode\": \"LOCAL\", \"scale_mode\": \"CONSTANT\", \"merge\": true";
        let verdict = of(&format!("{local}, {more}"), &files);
        assert!(matches!(verdict, Verdict::Reproduced), "{more}: {verdict}");
    }
}
