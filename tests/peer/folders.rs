//! Folders of the same layout, made for the purpose: what each must come to.

use std::path::Path;

use tempfile::TempDir;

use super::case::{Case, Verdict};
use crate::support::{self, workspace};

/// A copy of a recorded case with some files replaced; "" leaves one out.
fn folder(case: &str, files: &[(&str, &str)]) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let inside = folder.path().join("case");
    std::fs::create_dir(&inside).expect("a folder");
    let from = workspace().join("tests/peer/cases").join(case);
    for entry in std::fs::read_dir(from).expect("a case") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name");
        std::fs::copy(&path, inside.join(name)).expect("a copy");
    }
    for (name, text) in files {
        let path = inside.join(name);
        match *text {
            "" => std::fs::remove_file(path).expect("a file"),
            text => std::fs::write(path, text).expect("a file"),
        }
    }
    folder
}

fn verdict(folder: &Path) -> Verdict {
    let cases = Case::all_in(folder);
    assert_eq!(cases.len(), 1);
    cases[0].verdict()
}

fn recorded(case: &str, file: &str) -> String {
    support::text_of(&workspace().join("tests/peer/cases").join(case).join(file))
}

const SADDLE: &str = "01_saddle_default";

#[test]
fn a_run_that_failed_is_beaten_by_a_finite_mesh() {
    let files = [
        ("ERROR.txt", "Traceback\nIndexError: boolean index"),
        ("tissue.obj", ""),
    ];
    let failed = folder(SADDLE, &files);
    let verdict = verdict(failed.path());
    assert!(
        matches!(&verdict, Verdict::Beaten(why) if why.contains("IndexError")),
        "{verdict}"
    );
}

#[test]
fn a_run_that_failed_does_not_excuse_ours() {
    let files = [
        ("ERROR.txt", "IndexError"),
        ("tissue.obj", ""),
        ("component.obj", "v 0 0 nan\n"),
    ];
    let verdict = verdict(folder(SADDLE, &files).path());
    assert!(matches!(verdict, Verdict::Differs(_)), "{verdict}");
    let files = [
        ("ERROR.txt", "IndexError"),
        ("tissue.obj", ""),
        ("base.obj", "v 0 0 0\n"),
    ];
    let verdict = self::verdict(folder(SADDLE, &files).path());
    assert!(matches!(verdict, Verdict::Differs(_)), "{verdict}");
}

#[test]
fn a_reference_with_nan_is_beaten() {
    let theirs = recorded(SADDLE, "tissue.obj").replacen("v -", "v nan -", 1);
    assert!(theirs.contains("nan"));
    let verdict = verdict(folder(SADDLE, &[("tissue.obj", &theirs)]).path());
    assert!(
        matches!(&verdict, Verdict::Beaten(why) if why.contains("NaN")),
        "{verdict}"
    );
}

#[test]
fn a_reference_that_differs_is_seen() {
    let theirs = recorded(SADDLE, "tissue.obj");
    let same = verdict(folder(SADDLE, &[("tissue.obj", &theirs)]).path());
    assert!(matches!(same, Verdict::Reproduced), "{same}");
    // One vertex is lifted by a hundredth.
    let line = theirs
        .lines()
        .find(|line| line.starts_with("v "))
        .expect("a vertex");
    let mut numbers: Vec<f64> = line[2..]
        .split(' ')
        .map(|n| n.parse().expect("a number"))
        .collect();
    numbers[2] += 0.01;
    let lifted = format!("v {} {} {}", numbers[0], numbers[1], numbers[2]);
    let other = theirs.replacen(line, &lifted, 1);
    let verdict = verdict(folder(SADDLE, &[("tissue.obj", &other)]).path());
    assert!(matches!(verdict, Verdict::Differs(_)), "{verdict}");
}

#[test]
fn keys_without_a_counterpart_are_listed() {
    let settings = r#"{"settings": {"normals_mode": "SHAPEKEYS", "bool_shapekeys": true}}"#;
    let verdict = verdict(folder(SADDLE, &[("settings.json", settings)]).path());
    let Verdict::Refused(keys) = &verdict else {
        panic!("{verdict}");
    };
    assert_eq!(keys, &["bool_shapekeys", "normals_mode"]);
}

/// The add-on's mapping of triangles turned as quads with a side of no length:
/// corners (00, 10, 11, 01) rolled, positions and normals interpolated.
fn turned_triangles(turns: usize) -> String {
    use tessgraph_geometry::glam::DVec3;
    use tessgraph_geometry::normals::{NormalWeights, vertex_normals};
    let ran = support::Ran::nodes(
        "\"read\": ReadMesh(path: \"base.obj\"), \n\"base\": FanFaces(mesh: \"read\", order: Appended)",
        &[("base.obj", &recorded("12_fan_hex", "base.obj"))],
    );
    let base = ran.mesh("base");
    let folder = workspace().join("tests/peer/cases/12_fan_hex");
    let component = support::read_obj(&folder.join("component.obj")).expect("a component");
    let monitor = tessgraph_geometry::Unmonitored;
    let normals = vertex_normals(&base, NormalWeights::Angle, true, &monitor).expect("normals");
    let places = component.positions();
    let low = places.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let size = places
        .iter()
        .fold(DVec3::NEG_INFINITY, |high, p| high.max(*p))
        - low;
    let (mut text, count) = (String::new(), places.len());
    for face in base.topology().faces() {
        let [a, b, c] = [face[0], face[1], face[2]].map(|vertex| vertex as usize);
        let mut corners = [a, b, c, c];
        corners.rotate_right(turns);
        let at = |values: &[DVec3], u: f64, v: f64| {
            let [p, q, r, s] = corners.map(|corner| values[corner]);
            p.lerp(q, u).lerp(s.lerp(r, u), v)
        };
        for p in places.iter() {
            let (u, v) = ((p.x - low.x) / size.x, (p.y - low.y) / size.y);
            let x = at(base.positions(), u, v) + p.z * at(&normals, u, v);
            text += &format!("v {:?} {:?} {:?}\n", x.x, x.y, x.z);
        }
    }
    for piece in 0..base.face_count() {
        for face in component.topology().faces() {
            let corner = |&vertex: &u32| (piece * count + vertex as usize + 1).to_string();
            let corners: Vec<String> = face.iter().map(corner).collect();
            text += &format!("f {}\n", corners.join(" "));
        }
    }
    text
}

#[test]
fn triangles_turn_as_quads_with_a_side_of_no_length() {
    for turns in 1..4 {
        let settings = format!(
            "{{\"settings\": {{\"fill_mode\": \"FAN\", \"scale_mode\": \"CONSTANT\", \"rotation_shift\": {turns}}}}}"
        );
        let theirs = turned_triangles(turns);
        let files = [
            ("settings.json", settings.as_str()),
            ("tissue.obj", theirs.as_str()),
        ];
        let verdict = verdict(folder("12_fan_hex", &files).path());
        assert!(matches!(verdict, Verdict::Reproduced), "{turns}: {verdict}");
    }
}

#[test]
fn frames_take_their_width_from_a_group_and_another_beyond_borders() {
    let with = |extra: &str, weight: &str| {
        let settings = format!(
            "{{\"settings\": {{\"fill_mode\": \"FRAME\", \"frame_boundary\": true, \
             \"scale_mode\": \"CONSTANT\", \"zscale\": 0.5{extra}}}}}"
        );
        let vertices = recorded("13_frame_hex", "base.obj").matches("v ").count();
        let weights = format!("{weight}\n").repeat(vertices);
        let files = [
            ("settings.json", settings.as_str()),
            ("weights.csv", weights.as_str()),
        ];
        verdict(folder("13_frame_hex", &files).path())
    };
    // The recorded width is 0.3: half of 0.6 by a group at 0.5.
    let group = ", \"frame_thickness\": 0.6, \"vertex_group_frame_thickness\": \"W\"";
    let verdict = with(group, "0.5");
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    let verdict = with(group, "0.75");
    assert!(matches!(verdict, Verdict::Differs(_)), "{verdict}");
    // Of 0.2 by default, and 0.3 beyond the border: other rings, same border.
    let same = ", \"frame_thickness\": 0.3, \"frame_boundary_thickness\": 0.3";
    let verdict = with(same, "1");
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
    let other = ", \"frame_thickness\": 0.3, \"frame_boundary_thickness\": 0.2";
    let verdict = with(other, "1");
    assert!(matches!(verdict, Verdict::Differs(_)), "{verdict}");
}
