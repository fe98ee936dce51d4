//! `run`, from its graph to its files.

use serde_json::{Value, json};
use tessgraph_geometry::digest::Digest;

use super::Desk;
use crate::outputs::FileFormat;

/// A desk with a graph of these nodes and outputs, in centimetres.
fn desk(nodes: &str, outputs: &str) -> Desk {
    let desk = Desk::new();
    let params = r#"{"side": Number(default: 50, unit: Length)}"#;
    let text = format!(
        "Graph(version: 1, units: Cm, params: {params},\nnodes: {{\n{nodes}\n}},\noutputs: {{\n{outputs}\n}})"
    );
    desk.write("g.ron", &text);
    desk
}

#[test]
fn makes_outputs_and_leaves_them_alone_when_they_are_right() {
    let desk = desk(
        r#""a": Square(side: "side"), "l": Length(value: "2 * side"), "unused": Fails(value: 1),"#,
        r#""out/a.obj": "a", "out/l.json": "l", "out/l.csv": "l", "n.json": "l.length","#,
    );
    let given = desk.command("run", &["--report", "json"]);
    assert_eq!((given.status, given.err.as_str()), (0, ""));
    let report: Value = serde_json::from_str(&given.out).unwrap();
    assert_eq!(report["ok"], json!(true));
    let outcomes: Vec<_> = report["nodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|node| &node["outcome"])
        .collect();
    assert_eq!(outcomes, ["computed", "computed", "skipped"]);
    assert_eq!(report["outputs"][0]["path"], json!("out/a.obj"));
    assert_eq!(report["outputs"][0]["changed"], json!(true));
    assert_eq!(desk.json("out/l.json"), json!({"length": 100.0}));
    assert_eq!(desk.json("n.json"), json!(100.0));
    assert_eq!(desk.text("out/l.csv"), "name,value,unit\nlength,100,cm\n");
    assert!(
        desk.text("out/a.obj").contains("v 50 50 0\n"),
        "{}",
        desk.text("out/a.obj")
    );
    assert_eq!(desk.names("out"), ["a.obj", "l.csv", "l.json"]);

    let again = desk.command("run", &["--report", "json"]);
    let report: Value = serde_json::from_str(&again.out).unwrap();
    let changed = report["outputs"]
        .as_array()
        .unwrap()
        .iter()
        .any(|output| output["changed"] == true);
    assert!(!changed, "{report}");
    let other = desk.command("run", &["--set", "side=60", "--only", "n.json"]);
    assert!(
        other.err.contains("n.json") && !other.err.contains("a.obj"),
        "{}",
        other.err
    );
    assert_eq!(desk.json("n.json"), json!(120.0));
}

#[test]
fn glb_is_in_metres_and_says_what_it_was_made_from() {
    let desk = desk(r#""a": Square(side: "side"),"#, r#""a.glb": "a","#);
    let one = desk.command("run", &["--threads", "1"]);
    assert_eq!(one.status, 0, "{}", one.err);
    let first = desk.content("a.glb");
    let length = u32::from_le_bytes(first[12..16].try_into().unwrap()) as usize;
    let json: Value = serde_json::from_slice(&first[20..20 + length]).unwrap();
    let made = &json["asset"]["extras"]["tessgraph"];
    assert_eq!(made["version"], json!(env!("CARGO_PKG_VERSION")));
    assert_eq!(made["parameters"], json!({"side": 50.0}));
    assert_eq!(made["graph_digest"].as_str().unwrap().len(), 32);
    assert_eq!(json["accessors"][0]["max"], json!([0.5, 0.0, 0.0]));
    let two = desk.command(
        "run",
        &[
            "--threads",
            "2",
            "--out",
            &desk.path("elsewhere").to_string_lossy(),
        ],
    );
    assert_eq!(two.status, 0, "{}", two.err);
    assert_eq!(desk.content("elsewhere/a.glb"), first);
}

/// Digests of what each writer makes of the same values. If one changes, raise
/// the format's version in outputs/format.rs: otherwise outputs of the version
/// before count as current.
#[test]
fn bytes_change_only_with_the_version_of_their_writer() {
    let desk = desk(
        r#""a": Square(side: "side", painted: true), "l": Length(value: "side"),"#,
        r#""a.glb": "a", "a.obj": "a", "a.stl": "a", "a.ply": "a", "l.json": "l", "l.csv": "l","#,
    );
    assert_eq!(desk.command("run", &[]).status, 0);
    let mut found = String::new();
    for name in [
        "a.glb", "a.obj", "a.mtl", "a.stl", "a.ply", "l.json", "l.csv",
    ] {
        let mut bytes = desk.content(name);
        if name == "a.glb" {
            // It names the program's version, which has records of its own.
            let end = 20 + u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
            let mut json: Value = serde_json::from_slice(&bytes[20..end]).unwrap();
            json.as_object_mut().unwrap().remove("asset");
            bytes = [json.to_string().as_bytes(), &bytes[end..]].concat();
        }
        let version = FileFormat::of_path(name).map_or(1, FileFormat::version);
        found += &format!("{name} {version} {}\n", Digest::of(&bytes));
    }
    let expected = "\
a.glb 1 4614820e14e378b1d67819cea10bde88
a.obj 1 a87ff347ef6926b6a36fa8737b2104f3
a.mtl 1 1a4b880efa3ca3890e7753c1ce1cbc46
a.stl 1 2aa43188d02f691e3222084586617a82
a.ply 1 02cc5eea4eaee59fe9e907b7847b5bcc
l.json 1 4fa28e4d785f27f582d72e1af8bf196e
l.csv 1 534f9ac539112fc4b33b352a0392e72c
";
    assert_eq!(found, expected);
}

#[test]
fn materials_go_beside_an_obj() {
    let desk = desk(
        r#""a": Square(side: 1, painted: true),"#,
        r#""o/a.obj": "a","#,
    );
    let given = desk.command("run", &[]);
    assert_eq!(given.status, 0, "{}", given.err);
    assert!(
        given.err.contains("warning[node_warning]: fresh paint"),
        "{}",
        given.err
    );
    assert_eq!(desk.names("o"), ["a.mtl", "a.obj"]);
    assert!(desk.text("o/a.obj").contains("mtllib a.mtl"));
    assert!(desk.text("o/a.mtl").contains("newmtl paint"));
    assert!(given.err.contains("a.mtl"), "{}", given.err);
    let foreign = "newmtl of_somebody_else\n";
    desk.write("o/a.mtl", foreign);
    let given = desk.command("run", &[]);
    assert_eq!((given.status, desk.text("o/a.mtl")), (1, foreign.into()));
    assert!(
        given.err.contains("was not written by tessgraph"),
        "{}",
        given.err
    );
}

#[test]
fn a_failing_node_stops_only_what_needs_it() {
    let desk = desk(
        r#""bad": Fails(value: 1), "worse": Panics(value: 7), "below": Length(value: "bad"), "good": Length(value: 1),"#,
        r#""bad.json": "below", "worse.json": "worse", "good.json": "good","#,
    );
    let given = desk.command("run", &[]);
    assert_eq!(given.status, 1);
    assert!(
        !given.err.contains('\x1b') && !given.err.contains('\x07'),
        "{}",
        given.err
    );
    assert!(
        given.err.contains("node_failed") && given.err.contains("on purpose: 7"),
        "{}",
        given.err
    );
    assert!(given.err.contains("bug of tessgraph"), "{}", given.err);
    assert!(
        given.err.contains("1 computed, 2 failed, 1 blocked"),
        "{}",
        given.err
    );
    assert_eq!(desk.names(""), ["g.ron", "good.json"]);
}

#[test]
fn what_no_format_holds_is_refused_before_anything_runs() {
    let desk = desk(
        r#""a": Square(side: 1), "s": Squares(count: 2), "l": Length(value: 1),"#,
        r#""out/ok.json": "l", "a.dwg": "a", "s.obj": "s", "l.glb": "l", "a.csv": "a","#,
    );
    for command in ["run", "check"] {
        let given = desk.command(command, &[]);
        assert_eq!(given.status, 1);
        for message in [
            "`a.dwg` names no format",
            "a list of meshes cannot be written",
            "`l.glb` cannot hold a report",
            "a report is written as .json or .csv",
            "`a.csv` cannot hold a mesh",
        ] {
            assert!(given.err.contains(message), "{message} in {}", given.err);
        }
    }
    assert_eq!(desk.names(""), ["g.ron"]);
}

#[test]
fn inputs_are_never_overwritten() {
    let desk = desk(
        r#""r": Reads(path: "data/in.json"),"#,
        r#""data/in.json": "r", "link.json": "r", "data/beside.json": "r", "ok.json": "r","#,
    );
    let input = desk.write("data/in.json", "input");
    desk.write("data/beside.json", "beside");
    std::fs::hard_link(&input, desk.path("link.json")).unwrap();
    let given = desk.command("run", &[]);
    assert_eq!(given.status, 1);
    assert_eq!(
        given.err.matches("error[output_is_input]").count(),
        2,
        "{}",
        given.err
    );
    assert!(!desk.path("ok.json").exists());
    // The further file is known only when the run has read it.
    let given = desk.command("run", &["--only", "data/beside.json", "--only", "ok.json"]);
    assert_eq!(given.status, 1);
    assert!(
        given.err.contains("error[output_is_input]"),
        "{}",
        given.err
    );
    assert_eq!(
        (desk.text("data/in.json"), desk.text("data/beside.json")),
        ("input".into(), "beside".into())
    );
    assert_eq!(desk.json("ok.json"), json!(11));
}

#[test]
fn places_that_are_no_files_are_refused_before_anything_runs() {
    let desk = desk(
        r#""l": Length(value: 1),"#,
        r#""ok.json": "l", "folder.json": "l", "file/x.json": "l", "locked.json": "l","#,
    );
    std::fs::create_dir(desk.path("folder.json")).unwrap();
    desk.write("file", "");
    let locked = desk.write("locked.json", "mine");
    let mut permissions = std::fs::metadata(&locked).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&locked, permissions).unwrap();
    let given = desk.command("run", &[]);
    assert_eq!(given.status, 1);
    for reason in [
        "it is a folder",
        "is a file, not a folder",
        "it is read-only",
    ] {
        assert!(given.err.contains(reason), "{reason} in {}", given.err);
    }
    assert!(!desk.path("ok.json").exists());
    assert_eq!(desk.text("locked.json"), "mine");
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_need_leave() {
    let desk = desk(r#""l": Length(value: 1),"#, r#""away/x.json": "l","#);
    let elsewhere = Desk::new();
    std::os::unix::fs::symlink(elsewhere.path(""), desk.path("away")).unwrap();
    let given = desk.command("run", &[]);
    assert_eq!(given.status, 1);
    assert!(given.err.contains("error[output_outside]"), "{}", given.err);
    assert!(elsewhere.names("").is_empty());
    let given = desk.command("run", &["--allow", &elsewhere.path("").to_string_lossy()]);
    assert_eq!(given.status, 0, "{}", given.err);
    assert_eq!(elsewhere.names(""), ["x.json"]);
}

#[test]
fn wrong_usage_is_told_apart() {
    let desk = desk(r#""l": Length(value: 1),"#, r#""out/l.json": "l","#);
    for args in [
        &["--only", "out/m.json"][..],
        &["--set", "x"],
        &["--threads", "0"],
        &["--max-memory", "much"],
        &["--allow", "/no/such/folder"],
    ] {
        let given = desk.command("run", args);
        assert_eq!((given.status, given.out.as_str()), (2, ""), "{args:?}");
        assert!(given.err.starts_with("error"), "{}", given.err);
    }
    let given = desk.command("run", &["--only", "out/m.json"]);
    assert!(
        given.err.contains("did you mean `out/l.json`"),
        "{}",
        given.err
    );
    assert_eq!(desk.names(""), ["g.ron"]);
}

#[test]
fn a_graph_with_errors_still_gives_a_report() {
    let desk = Desk::new();
    desk.write(
        "g.ron",
        "Graph(version: 1, nodes: {\"a\": Nope()}, outputs: {\"a.glb\": \"a\"})",
    );
    let given = desk.command("run", &["--report", "json"]);
    assert_eq!(given.status, 1);
    let report: Value = serde_json::from_str(&given.out).unwrap();
    assert_eq!(
        (&report["ok"], &report["outputs"]),
        (&json!(false), &json!([]))
    );
    assert!(given.err.contains("g.ron:1:"), "{}", given.err);
}
