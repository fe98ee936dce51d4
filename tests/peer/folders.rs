//! Folders of the same layout, made for the purpose: what each must come to.

use std::path::Path;

use tempfile::TempDir;

use super::case::{Case, Verdict};
use crate::support::{self, workspace};

/// A copy of a recorded case with some files replaced; "" leaves one out.
pub(super) fn folder(case: &str, files: &[(&str, &str)]) -> TempDir {
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

pub(super) fn verdict(folder: &Path) -> Verdict {
    let cases = Case::all_in(folder);
    assert_eq!(cases.len(), 1);
    cases[0].verdict()
}

pub(super) fn recorded(case: &str, file: &str) -> String {
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
