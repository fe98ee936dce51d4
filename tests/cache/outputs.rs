//! Output files that are as they were written: nothing is loaded for them, and
//! whatever is not sound about them or their record has them written again.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::{CAGE, fifty_nodes, files_of};
use crate::support::program::program;

const GRAPH: &str = r#"Graph(
    version: 1,
    params: {"depth": 0.1, "unused": 1},
    nodes: {
        "cage": ReadMesh(path: "cage.obj"),
        "normals": VertexNormals(mesh: "cage"),
        "shell": OffsetMesh(mesh: "cage", directions: "normals", outward: "depth"),
        "size": MeasureMesh(mesh: "shell"),
    },
    outputs: {"out/shell.obj": "shell", "out/shell.glb": "shell", "out/size.json": "size"},
)"#;

/// A cage with a material, and a face that STL cannot hold as it is.
const PAINTED: &str =
    "mtllib cage.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0.2\nv 0 1 0\nusemtl clay\nf 1 2 3 4\n";

/// A folder with a graph, and a cache beside it.
struct Project {
    folder: tempfile::TempDir,
}

/// A run as its report tells it.
#[derive(Debug, PartialEq)]
struct Told {
    status: u8,
    computed: Vec<String>,
    /// The outputs, and whether each was written.
    outputs: Vec<(String, bool)>,
    notes: String,
}

impl Project {
    fn new(graph: &str, cage: &str) -> Self {
        let project = Self {
            folder: tempfile::tempdir().expect("a folder"),
        };
        project.write("g.ron", graph);
        project.write("cage.obj", cage);
        project.write("cage.mtl", "newmtl clay\nKd 0.5 0.25 0.125\n");
        project
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: &str) {
        std::fs::write(self.path(name), content).expect("written");
    }

    fn content(&self, name: &str) -> Vec<u8> {
        #[allow(clippy::disallowed_methods, reason = "tests read what was written")]
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn run(&self, more: &[&str]) -> Told {
        let (graph, cache) = (self.path("g.ron"), self.path("cache"));
        let paths = [&graph, &cache].map(|path| path.to_string_lossy().into_owned());
        let args = ["tessgraph", "run", &paths[0], "--cache", &paths[1]];
        let args = [&args[..], &["--report", "json"], more].concat();
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let status = tessgraph::run(args, &mut out, &mut err);
        Told::new(status, &out, &err)
    }

    /// Removes every value from the cache: what is loaded now is computed.
    fn forget_values(&self) {
        for folder in ["cache/values", "cache/topologies"] {
            std::fs::remove_dir_all(self.path(folder)).expect("values were kept");
        }
    }
}

impl Told {
    fn new(status: u8, out: &[u8], err: &[u8]) -> Self {
        let notes = String::from_utf8(err.to_vec()).expect("UTF-8");
        let report: Value = serde_json::from_slice(out).unwrap_or_else(|_| panic!("{notes}"));
        let items = |name: &str| report[name].as_array().expect("a list").clone();
        let text = |value: &Value| value.as_str().expect("a text").to_owned();
        let nodes = items("nodes").into_iter();
        let computed = nodes.filter(|node| node["outcome"] == "computed");
        let changed = |output: &Value| output["changed"].as_bool().expect("true or false");
        Self {
            status,
            computed: computed.map(|node| text(&node["name"])).collect(),
            outputs: items("outputs")
                .iter()
                .map(|output| (text(&output["path"]), changed(output)))
                .collect(),
            notes,
        }
    }

    /// The outputs that were written.
    fn written(&self) -> Vec<&str> {
        let written = self.outputs.iter().filter(|(_, changed)| *changed);
        written.map(|(path, _)| path.as_str()).collect()
    }
}

const NONE: [&str; 0] = [];

#[test]
fn unchanged_files_need_no_value() {
    let project = Project::new(GRAPH, CAGE);
    let first = project.run(&[]);
    assert_eq!(first.computed.len(), 4, "{}", first.notes);
    assert_eq!(
        first.written(),
        ["out/shell.obj", "out/shell.glb", "out/size.json"]
    );
    project.forget_values();
    let second = project.run(&[]);
    assert_eq!(
        (second.computed.as_slice(), second.written()),
        (&[][..], NONE.to_vec())
    );
    assert_eq!(second.outputs.len(), 3);
    // Elsewhere nothing is written yet, and the values have to be found again.
    let elsewhere = project.path("elsewhere").to_string_lossy().into_owned();
    let moved = project.run(&["--out", &elsewhere]);
    assert_eq!(moved.computed, ["cage", "normals", "shell"]);
    assert_eq!(moved.written().len(), 3);
    assert_eq!(
        project.content("elsewhere/out/shell.glb"),
        project.content("out/shell.glb")
    );
}

#[test]
fn a_file_that_was_touched_changed_cut_or_removed_is_made_right() {
    let project = Project::new(GRAPH, CAGE);
    project.run(&[]);
    for name in ["out/shell.obj", "out/shell.glb", "out/size.json"] {
        let right = project.content(name);
        let mut other = right.clone();
        other[right.len() / 2] ^= 1;
        for wrong in [&other[..], &right[..right.len() - 1], b""] {
            std::fs::write(project.path(name), wrong).expect("written");
            assert_eq!(project.run(&[]).written(), [name]);
            assert_eq!(project.content(name), right);
        }
        std::fs::remove_file(project.path(name)).expect("removed");
        let again = project.run(&[]);
        assert_eq!(
            (again.computed.as_slice(), again.written()),
            (&[][..], vec![name])
        );
        assert_eq!(project.content(name), right);
        std::fs::write(project.path(name), &right).expect("touched");
        assert_eq!(project.run(&[]).written(), NONE);
    }
}

#[test]
fn a_wrong_file_is_made_right_even_where_values_are_lost() {
    let project = Project::new(GRAPH, CAGE);
    project.run(&[]);
    let right = project.content("out/shell.obj");
    project.write("out/shell.obj", "v 0 0 0\n");
    project.forget_values();
    let again = project.run(&[]);
    assert_eq!(again.computed, ["cage", "normals", "shell"]);
    assert_eq!(again.written(), ["out/shell.obj"]);
    assert_eq!(project.content("out/shell.obj"), right);
}

#[test]
fn what_a_file_says_of_its_origin_counts() {
    let project = Project::new(GRAPH, CAGE);
    project.run(&[]);
    // A GLB names the parameters; an unused one changes nothing else.
    let told = project.run(&["--set", "unused=2"]);
    assert_eq!(
        (told.computed.as_slice(), told.written()),
        (&[][..], vec!["out/shell.glb"])
    );
    // And the digest of all it was made from.
    project.write("cage.obj", &format!("# redrawn\n{CAGE}"));
    let told = project.run(&["--set", "unused=2"]);
    assert_eq!(told.written(), ["out/shell.glb"]);
    // The same value in other units is other text.
    let feet = GRAPH.replace("version: 1,", "version: 1, units: Ft,");
    project.write("g.ron", &feet);
    assert!(
        project
            .run(&["--set", "unused=2"])
            .written()
            .contains(&"out/size.json")
    );
}

#[test]
fn a_damaged_record_has_the_output_looked_at_again() {
    let project = Project::new(GRAPH, CAGE);
    let expected = project.run(&[]).outputs.len();
    let right = project.content("out/shell.obj");
    for record in files_of(&project.path("cache/outputs")) {
        #[allow(clippy::disallowed_methods, reason = "tests read their own files")]
        let whole = std::fs::read(&record).expect("a record");
        for at in (0..whole.len()).step_by(16) {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x10;
            std::fs::write(&record, &bytes).expect("written");
            let told = project.run(&[]);
            assert_eq!(
                (told.status, told.written(), told.outputs.len()),
                (0, NONE.to_vec(), expected)
            );
            // Removed when it was met, and kept again.
            #[allow(clippy::disallowed_methods, reason = "tests read their own files")]
            let again = std::fs::read(&record).expect("a record");
            assert_eq!(again, whole, "byte {at}");
        }
    }
    assert_eq!(project.content("out/shell.obj"), right);
}

#[test]
fn a_material_library_belongs_to_its_output() {
    let graph = GRAPH.replace(
        ", \"out/shell.glb\": \"shell\", \"out/size.json\": \"size\"",
        "",
    );
    let project = Project::new(&graph, PAINTED);
    let first = project.run(&[]);
    assert_eq!(
        first.written(),
        ["out/shell.mtl", "out/shell.obj"],
        "{}",
        first.notes
    );
    let materials = project.content("out/shell.mtl");
    assert!(String::from_utf8_lossy(&materials).contains("Kd 0.5 0.25 0.125"));
    project.forget_values();
    assert_eq!(project.run(&[]).written(), NONE);
    std::fs::remove_file(project.path("out/shell.mtl")).expect("removed");
    assert_eq!(project.run(&[]).written(), ["out/shell.mtl"]);
    assert_eq!(project.content("out/shell.mtl"), materials);
    // Somebody else's file is never lost, and the output not written without it.
    std::fs::remove_file(project.path("out/shell.obj")).expect("removed");
    project.write("out/shell.mtl", "newmtl precious\n");
    let told = project.run(&[]);
    assert_eq!((told.status, told.outputs.len()), (1, 0));
    assert!(
        told.notes.contains("was not written by tessgraph"),
        "{}",
        told.notes
    );
    assert_eq!(project.content("out/shell.mtl"), b"newmtl precious\n");
    assert!(!project.path("out/shell.obj").exists());
}

#[test]
fn what_a_format_lost_is_said_again() {
    let graph = GRAPH.replace(
        "\"size\": Me",
        "\"tall\": SetAttribute(mesh: \"shell\", name: \"tall\", value: 2), \"size\": Me",
    );
    let graph = graph.replace("shell.obj\": \"shell", "shell.obj\": \"tall");
    let project = Project::new(&graph, CAGE);
    let lost = |told: &Told| -> Vec<String> {
        let lines = told.notes.lines().filter(|line| line.starts_with("note: "));
        lines.map(str::to_owned).collect()
    };
    let first = project.run(&[]);
    assert!(!lost(&first).is_empty(), "{}", first.notes);
    assert_eq!(lost(&project.run(&[])), lost(&first));
}

#[test]
fn without_a_cache_nothing_is_recorded() {
    let project = Project::new(GRAPH, CAGE);
    let graph = project.path("g.ron").to_string_lossy().into_owned();
    let args = ["tessgraph", "run", &graph, "--no-cache", "--report", "json"];
    let (mut out, mut err) = (Vec::new(), Vec::new());
    tessgraph::run(args, &mut out, &mut err);
    let first = Told::new(0, &out, &err);
    assert_eq!((first.computed.len(), first.written().len()), (4, 3));
    out.clear();
    tessgraph::run(args, &mut out, &mut err);
    let second = Told::new(0, &out, &[]);
    assert_eq!(
        (second.computed.len(), second.written()),
        (4, NONE.to_vec())
    );
    assert!(!project.path("cache").exists());
}

#[test]
fn a_second_process_finds_fifty_nodes_at_once_and_loads_nothing() {
    let outputs = r#"{"o.obj": "n49", "o.glb": "n49", "middle.ply": "n25"}"#;
    let project = Project::new(&fifty_nodes(outputs), CAGE);
    let process = || {
        let start = std::time::Instant::now();
        let done = Command::new(program())
            .args(["run", "g.ron", "--report", "json", "--cache", "cache"])
            .current_dir(project.folder.path())
            .output();
        let elapsed = start.elapsed();
        let done = done.expect("the program runs");
        (
            Told::new(
                done.status.code().map_or(1, |code| code as u8),
                &done.stdout,
                &done.stderr,
            ),
            elapsed,
        )
    };
    let (cold, _) = process();
    assert_eq!(
        (cold.computed.len(), cold.written().len()),
        (50, 3),
        "{}",
        cold.notes
    );
    project.forget_values();
    let mut best = std::time::Duration::MAX;
    for _ in 0..8 {
        let (warm, elapsed) = process();
        assert_eq!(
            (warm.status, warm.computed.len(), warm.written()),
            (0, 0, NONE.to_vec())
        );
        assert_eq!(warm.outputs.len(), 3);
        best = best.min(elapsed);
    }
    assert!(!has_files(&project.path("cache/values")));
    println!("50 warm nodes in a process of its own: {best:?}");
    // Ten times what it takes, for busy machines.
    assert!(best.as_millis() < 500, "{best:?}");
}

fn has_files(folder: &Path) -> bool {
    folder.exists() && !files_of(folder).is_empty()
}
