//! Studies: nothing twice, nothing lost, the same table however it is made.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

use crate::support::program::{program, text, with_graphs};
use crate::support::text_of;

const STUDY: &str = "studies/canopy_study.ron";

/// The program on a study, with a cache below the folder.
fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(program());
    command
        .arg("study")
        .args(arguments)
        .current_dir(folder)
        .env("TESSGRAPH_CACHE", folder.join("cache"));
    command
}

fn study(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments)
        .output()
        .expect("the program runs")
}

/// The JSON report of a study that must have that exit status.
fn report(folder: &Path, arguments: &[&str], status: i32) -> Value {
    let done = study(folder, &[arguments, &["--report", "json"]].concat());
    assert_eq!(done.status.code(), Some(status), "{}", text(&done.stderr));
    serde_json::from_slice(&done.stdout).expect("JSON")
}

fn computed(report: &Value) -> u64 {
    report["computed"].as_u64().expect("a number")
}

fn reused(report: &Value) -> usize {
    let variants = report["variants"].as_array().expect("variants").iter();
    variants.filter(|variant| variant["reused"] == true).count()
}

fn table(folder: &Path, out: &str) -> String {
    text_of(&folder.join(out).join("results.csv"))
}

/// How many variants are recorded below a folder of results.
fn recorded(out: &Path) -> usize {
    let Ok(variants) = std::fs::read_dir(out.join("variants")) else {
        return 0;
    };
    let record = |entry: &std::fs::DirEntry| entry.path().join("variant.json").is_file();
    variants.flatten().filter(record).count()
}

#[test]
fn what_variants_share_is_computed_once() {
    let folder = with_graphs();
    let folder = folder.path();
    let first = report(folder, &[STUDY, "--out", "a"], 0);
    // Ten nodes stand above the axes; two are computed for each of 27 variants.
    assert_eq!(computed(&first), 10 + 27 * 2);
    let rows = table(folder, "a");
    assert_eq!(rows.lines().count(), 28);
    assert_eq!(
        rows.lines().next(),
        Some("id,closed,arrangement,depth,area,faces,area_per_face,status,error")
    );
    let begins: Vec<String> = rows
        .lines()
        .skip(1)
        .map(|row| row[17..].split(',').take(3).collect::<Vec<_>>().join(","))
        .collect();
    assert_eq!(
        begins[..4],
        ["0.1,1,0.6", "0.1,1,0.8", "0.1,1,1", "0.1,2,0.6"]
    );
    assert_eq!(recorded(&folder.join("a")), 27);
    let kept = folder
        .join("a/variants")
        .join(&rows.lines().nth(1).expect("a row")[..16]);
    assert!(kept.join("canopy.glb").is_file());
    // Without a cache on disk there is one in memory.
    let alone = report(folder, &[STUDY, "--out", "b", "--no-cache"], 0);
    assert_eq!(computed(&alone), 10 + 27 * 2);
    assert_eq!(table(folder, "b"), rows);
    // Again: everything is there.
    let again = report(folder, &[STUDY, "--out", "a"], 0);
    assert_eq!((computed(&again), reused(&again)), (0, 27));
}

#[test]
fn four_shards_and_one_run_give_the_same_table() {
    let folder = with_graphs();
    let folder = folder.path();
    report(folder, &[STUDY, "--out", "whole"], 0);
    for shard in ["3/4", "1/4", "4/4"] {
        report(folder, &[STUDY, "--out", "parts", "--shard", shard], 0);
    }
    let early = study(folder, &["collect", STUDY, "--out", "parts"]);
    assert_eq!(early.status.code(), Some(1));
    assert!(
        text(&early.stderr).contains("7 of 27 variants are not there"),
        "{}",
        text(&early.stderr)
    );
    assert!(!folder.join("parts/results.csv").exists());
    // The last one on another machine: with a folder of its own.
    report(
        folder,
        &[STUDY, "--out", "other", "--shard", "2/4", "--threads", "1"],
        0,
    );
    let joined = study(
        folder,
        &["collect", STUDY, "--out", "parts", "--from", "other"],
    );
    assert!(joined.status.success(), "{}", text(&joined.stderr));
    assert_eq!(table(folder, "parts"), table(folder, "whole"));
}

#[test]
fn a_killed_study_goes_on_where_it_was() {
    let folder = with_graphs();
    let folder = folder.path();
    // Finer panels, so that there is time to be killed in.
    let finer = text_of(&folder.join(STUDY)).replace("{\"levels\": 1}", "{\"levels\": 4}");
    std::fs::write(folder.join(STUDY), finer).expect("a file");
    let out = folder.join("killed");
    let mut child = command(folder, &[STUDY, "--out", "killed"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    while recorded(&out) < 11 {
        let over = child.try_wait().expect("a process");
        assert!(
            over.is_none(),
            "it ended before it could be killed: {over:?}"
        );
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().expect("it is alive");
    child.wait().expect("it ends");
    let done = recorded(&out);
    assert!((11..27).contains(&done), "{done} of 27 were done");
    assert!(!out.join("results.csv").exists());
    let rest = report(folder, &[STUDY, "--out", "killed"], 0);
    assert_eq!(reused(&rest), done);
    assert!(
        computed(&rest) <= 2 * (27 - done as u64),
        "{} nodes for {done} done",
        computed(&rest)
    );
    report(folder, &[STUDY, "--out", "whole"], 0);
    assert_eq!(table(folder, "killed"), table(folder, "whole"));
}

#[test]
fn content_decides_what_is_made_again() {
    let folder = with_graphs();
    let folder = folder.path();
    let again = || {
        let report = report(folder, &[STUDY, "--out", "a"], 0);
        (reused(&report), computed(&report))
    };
    assert_eq!(again(), (0, 10 + 27 * 2));
    let write = |path: &str, from: &str, to: &str| {
        let text = text_of(&folder.join(path));
        assert!(text.contains(from), "{from} in {path}");
        std::fs::write(folder.join(path), text.replace(from, to)).expect("a file");
    };
    // Written again with the same content: nothing has changed.
    write("studies/canopy.ron", "canopy", "canopy");
    assert_eq!(again(), (27, 0));
    // A comment: the variants are looked at again, and nothing is computed.
    write("studies/canopy.ron", "// The three axes", "// All axes");
    assert_eq!(again(), (0, 0));
    // A measure more.
    write(
        STUDY,
        "\"faces\": \"size.faces\"",
        "\"faces\": \"size.faces\", \"wide\": \"size.size_x > 11\"",
    );
    assert_eq!(again(), (0, 0));
    assert!(
        table(folder, "a")
            .lines()
            .next()
            .expect("a row")
            .contains(",faces,wide,")
    );
    // One value more on an axis: the others are there.
    write(STUDY, "[1, 2, 3]", "[1, 2, 3, 4]");
    assert_eq!(again(), (27, 18));
    // A kept file is gone, or is not what was written.
    let row = table(folder, "a").lines().nth(5).expect("a row")[..16].to_owned();
    let kept = folder.join("a/variants").join(row).join("canopy.glb");
    std::fs::write(kept, "x").expect("a file");
    assert_eq!(again().0, 35);
    // The graph itself: what is above the change stays.
    write("studies/canopy.ron", "iterations: 20", "iterations: 21");
    assert_eq!(again().0, 0);
}

#[test]
fn a_failing_variant_stands_in_the_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("a file");
    write(
        "walls.ron",
        "Graph(version: 1, units: Mm, params: {\"n\": Integer(default: 2, min: 1, max: 9), \"kind\": Choice(default: Low, of: [Low, High])}, nodes: {\n\
         \"grid\": Grid(cells: [\"n\", 2], size: [1000, 500]),\n\
         \"size\": MeasureMesh(mesh: \"grid\"),\n\
         \"few\": Require(condition: \"size.faces < 7\", message: \"too many, faces\"),\n\
         }, outputs: {\"grid.obj\": \"grid\", \"few.json\": \"few\"})",
    );
    write(
        "s.ron",
        "Study(version: 1, graph: \"walls.ron\", axes: {\"n\": Linspace(from: 2, to: 4, count: 3), \"kind\": Values(of: [Low, High])},\n\
         keep: [\"grid.obj\", \"few.json\"], measures: {\"faces\": \"size.faces\", \"area\": \"round(size.area)\", \"fine\": \"few\"})",
    );
    let told = report(folder, &["s.ron"], 1);
    assert_eq!(told["ok"], false);
    let rows = table(folder, "out/s");
    let rows: Vec<&str> = rows.lines().skip(1).map(|row| &row[17..]).collect();
    // Areas in the graph's units.
    assert_eq!(
        rows,
        [
            "2,Low,4,500000,true,ok,",
            "2,High,4,500000,true,ok,",
            "3,Low,6,500000,true,ok,",
            "3,High,6,500000,true,ok,",
            "4,Low,8,500000,,failed,\"`few`: too many, faces\"",
            "4,High,8,500000,,failed,\"`few`: too many, faces\"",
        ]
    );
    // What failed is tried again, the rest is there; the table is the same.
    let again = report(folder, &["s.ron"], 1);
    assert_eq!(reused(&again), 4);
    let collected = study(folder, &["collect", "s.ron"]);
    assert_eq!(collected.status.code(), Some(1));
    let told = text(&study(folder, &["s.ron"]).stderr);
    assert!(
        told.contains("6 variants: 4 there already, 2 failed;"),
        "{told}"
    );
}

#[test]
fn samples_lie_in_their_ranges() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("a file");
    write(
        "g.ron",
        "Graph(version: 1, params: {\"a\": 1.0, \"n\": Integer(default: 2, min: 1, max: 9), \"k\": 1}, nodes: {\n\
         \"grid\": Grid(cells: [\"n\", \"k\"], size: [\"a\", 1]), \"size\": MeasureMesh(mesh: \"grid\"),\n\
         }, outputs: {\"size.json\": \"size\"})",
    );
    write(
        "s.ron",
        "Study(version: 1, graph: \"g.ron\", measures: {\"x\": \"size.size_x\", \"faces\": \"size.faces\"}, axes: {\n\
         \"both\": LatinHypercube(count: 9, seed: 5, over: {\"a\": Range(from: 1, to: 10), \"n\": Range(from: 1, to: 9)}),\n\
         \"k\": Random(from: 1, to: 3, count: 4, seed: 2)})",
    );
    report(folder, &["s.ron"], 0);
    let rows = table(folder, "out/s");
    let rows: Vec<Vec<f64>> = rows
        .lines()
        .skip(1)
        .map(|row| {
            row.split(',')
                .skip(1)
                .take(5)
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        })
        .collect();
    let mut slices: Vec<usize> = rows.iter().map(|row| row[0] as usize).collect();
    let mut whole: Vec<usize> = rows.iter().map(|row| row[1] as usize).collect();
    slices.sort_unstable();
    slices.dedup();
    whole.sort_unstable();
    whole.dedup();
    // Each slice of a, and each whole n, is met.
    assert_eq!((slices, whole), ((1..=9).collect(), (1..=9).collect()));
    for row in rows {
        assert!(
            (1.0..=3.0).contains(&row[2]) && row[2].fract() == 0.0,
            "{row:?}"
        );
        assert!(
            (row[3] - row[0]).abs() < 1e-12 && (row[4] - row[1] * row[2]).abs() < 1e-9,
            "{row:?}"
        );
    }
}

#[test]
fn mistakes_of_a_study_are_shown_at_their_places() {
    let folder = with_graphs();
    let folder = folder.path();
    let write = |text: &str| std::fs::write(folder.join("studies/s.ron"), text).expect("a file");
    let told = |body: &str| {
        write(body);
        let done = study(folder, &["studies/s.ron"]);
        assert_eq!(done.status.code(), Some(1), "{body}");
        assert!(!folder.join("studies/out").exists());
        text(&done.stderr)
    };
    let mut book = String::new();
    for body in [
        "Study(version: 1)",
        "Graph(version: 1)",
        "Study(version: 2, graph: \"canopy.ron\")",
        "Study(version: 1, graph: \"none.ron\", axes: {\"depth\": Values(of: [1])}, keep: [\"size.json\"])",
        "Study(version: 1, graph: \"canopy.ron\", set: {\"depth\": 1, \"closed\": 2}, axes: {\n  \
           \"dept\": Values(of: [1]),\n  \"depth\": Linspace(from: 0, to: 1, count: 2),\n  \
           \"levels\": Linspace(from: 0, to: 1, count: 3),\n  \"arrangement\": Vals(of: [1]),\n}, keep: [\"size.json\"])",
        "Study(version: 1, graph: \"canopy.ron\", axes: {\"depth\": Linspace(from: 0.5, to: 3, count: 1000000000)}, keep: [\"canopy.glb\"])",
        "Study(version: 1, graph: \"canopy.ron\", axes: {\"depth\": Values(of: [0.5, 0.7])}, keep: [\"canopy.gbl\"])",
        "Study(version: 1, graph: \"canopy.ron\", axes: {\"depth\": Values(of: [0.5, 0.7])}, measures: {\"id\": \"1\", \"a\": 3})",
        "Study(version: 1, graph: \"canopy.ron\", axes: {\"depth\": Values(of: [0.5, 0.7])},\n  measures: {\"a\": \"size.aera\", \"b\": \"canopy\", \"c\": \"1 +\"})",
    ] {
        book.push_str(&told(body));
        book.push_str("----\n");
    }
    insta::assert_snapshot!("mistakes", book);
}
