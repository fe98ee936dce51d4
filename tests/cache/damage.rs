//! Damaged, cut, emptied, swapped and missing files: found out, and computed
//! again.

use std::path::{Path, PathBuf};

use tessgraph_geometry::digest::Digest;
use tessgraph_graph::eval::CacheFolder;
use tessgraph_graph::{Engine, Outcome};

use super::{GRAPH, MEMORY, Run, files_of};

/// A graph with few and small files, for exhaustive damage.
const SMALL: &str = r#"Graph(
    version: 1,
    nodes: {
        "cage": ReadMesh(path: "cage.obj"),
        "normals": VertexNormals(mesh: "cage"),
        "shell": OffsetMesh(mesh: "cage", directions: "normals", outward: 0.1),
        "size": MeasureMesh(mesh: "shell"),
    },
    outputs: {"shell.obj": "shell", "size.json": "size"},
)"#;

/// A filled cache, and what every run must give.
struct Filled {
    folder: tempfile::TempDir,
    files: Vec<(PathBuf, Vec<u8>)>,
    expected: Vec<(String, Digest)>,
}

impl Filled {
    fn new(text: &str) -> Self {
        // Thousands of files are written and synced: in memory where that is offered.
        let memory = Path::new("/dev/shm");
        let folder = tempfile::tempdir_in(memory).or_else(|_| tempfile::tempdir());
        let folder = folder.expect("a folder");
        Run::outputs(text, folder.path());
        let read = |path: PathBuf| {
            #[allow(clippy::disallowed_methods, reason = "tests read their own files")]
            let bytes = std::fs::read(&path).expect("a cache file");
            (path, bytes)
        };
        let files: Vec<_> = files_of(folder.path()).into_iter().map(read).collect();
        let files = files.into_iter();
        let files = files.filter(|(path, _)| !path.ends_with("CACHEDIR.TAG"));
        Self {
            files: files.collect(),
            expected: Run::with(&Engine::without_cache(), text, true).digests(),
            folder,
        }
    }

    /// Checks that a run with `path` replaced by `bytes` is right, and puts the
    /// file back.
    fn survives(&self, text: &str, place: usize, bytes: &[u8], what: &str) {
        let (path, right) = &self.files[place];
        write(path, bytes);
        // All values are wanted, so that every file is read.
        let run = Run::with(&Engine::with_disk(MEMORY, self.folder.path()), text, true);
        let name = path.display();
        assert_eq!(run.digests(), self.expected, "{name}: {what}");
        let computed = run.nodes(Outcome::Computed);
        assert!(!computed.is_empty(), "{name}: {what} went unnoticed");
        write(path, right);
    }
}

fn write(path: &Path, bytes: &[u8]) {
    std::fs::write(path, bytes).expect("the cache can be written to");
}

#[test]
fn any_flipped_byte_is_found_out() {
    let filled = Filled::new(SMALL);
    assert!(filled.files.len() >= 8, "{} files", filled.files.len());
    for (place, (_, right)) in filled.files.iter().enumerate() {
        let mut bytes = right.clone();
        for at in 0..bytes.len() {
            bytes[at] ^= 0x41;
            filled.survives(SMALL, place, &bytes, &format!("byte {at} flipped"));
            bytes[at] ^= 0x41;
        }
    }
}

#[test]
fn files_cut_at_any_length_emptied_or_too_long_are_found_out() {
    let filled = Filled::new(SMALL);
    for (place, (_, right)) in filled.files.iter().enumerate() {
        // Every length within the header, and every seventh after it.
        for length in (0..88).chain((88..right.len()).step_by(7)) {
            filled.survives(SMALL, place, &right[..length], &format!("cut to {length}"));
        }
        let longer = [right.as_slice(), b"x"].concat();
        filled.survives(SMALL, place, &longer, "one byte more");
    }
}

#[test]
fn files_swapped_with_another_are_found_out() {
    let filled = Filled::new(SMALL);
    for place in 0..filled.files.len() {
        for (other, (path, bytes)) in filled.files.iter().enumerate() {
            if other != place {
                let what = format!("holds {}", path.display());
                filled.survives(SMALL, place, bytes, &what);
            }
        }
    }
}

#[test]
fn lost_values_are_computed_again_with_what_they_need() {
    let filled = Filled::new(GRAPH);
    std::fs::remove_dir_all(filled.folder.path().join("values")).expect("values");
    let warm = Run::with(
        &Engine::with_disk(MEMORY, filled.folder.path()),
        GRAPH,
        false,
    );
    // Nothing needs the size, which is known from its entry.
    let computed = ["cage", "deep", "normals", "shell", "surface"];
    assert_eq!(warm.nodes(Outcome::Computed), computed);
    assert_eq!(warm.nodes(Outcome::CutOff), ["size"]);
    for found in warm.digests() {
        assert!(filled.expected.contains(&found), "{found:?}");
    }
    let again = Run::outputs(GRAPH, filled.folder.path());
    assert_eq!(again.nodes(Outcome::Cached).len(), 6);
}

#[test]
fn values_that_memory_let_go_are_computed_again_without_a_folder() {
    let engine = Engine::new(0);
    let cold = Run::with(&engine, GRAPH, false);
    let warm = Run::with(&engine, GRAPH, false);
    assert_eq!(warm.digests(), cold.digests());
    assert_eq!(warm.nodes(Outcome::CutOff), ["size"]);
}

#[test]
fn verify_names_and_removes_exactly_what_is_damaged() {
    let filled = Filled::new(GRAPH);
    let cache = CacheFolder::open(filled.folder.path()).expect("a cache");
    let whole = cache.verify();
    assert_eq!(
        (whole.checked, whole.damaged.len()),
        (filled.files.len(), 0)
    );
    let (path, bytes) = &filled.files[3];
    write(path, &bytes[..bytes.len() - 1]);
    let found = cache.verify();
    assert_eq!(found.damaged, std::slice::from_ref(path));
    assert!(!path.exists());
    assert_eq!(cache.verify().checked, filled.files.len() - 1);
}

#[test]
fn a_clean_up_keeps_to_its_budget_and_nothing_breaks() {
    let filled = Filled::new(GRAPH);
    let cache = CacheFolder::open(filled.folder.path()).expect("a cache");
    let before = cache.stats();
    assert_eq!(before.entries, 6);
    let mut budget = before.bytes;
    while budget > 0 {
        budget /= 2;
        let report = cache.gc(budget);
        let left = cache.stats().bytes;
        assert_eq!(report.kept_bytes, left);
        assert!(left <= budget, "{left} bytes left of {budget}");
        let run = Run::with(
            &Engine::with_disk(MEMORY, filled.folder.path()),
            GRAPH,
            true,
        );
        assert_eq!(run.digests(), filled.expected);
    }
}

#[test]
fn a_folder_is_kept_to_its_budget_while_it_is_written_to() {
    let folder = tempfile::tempdir().expect("a folder");
    let filled = Filled::new(GRAPH);
    let whole = CacheFolder::open(filled.folder.path()).expect("a cache");
    // Room for two variants of the graph, of ten that are computed.
    let budget = 2 * whole.stats().bytes;
    let engine = Engine::with_disk(0, folder.path()).limiting_disk(budget);
    for step in 1..=10 {
        let text = GRAPH.replace("\"t\": 0.1", &format!("\"t\": 0.{step}1"));
        Run::with(&engine, &text, true);
    }
    engine.flush();
    let left = CacheFolder::open(folder.path()).expect("a cache").stats();
    // Looks follow an eighth of the budget's writing, and a file may be larger.
    assert!(left.bytes <= budget * 3 / 2, "{} of {budget}", left.bytes);
    let run = Run::with(&Engine::with_disk(MEMORY, folder.path()), GRAPH, true);
    assert_eq!(run.digests(), filled.expected);
}

#[test]
fn a_clean_up_removes_values_before_what_says_they_need_not_be_computed() {
    let filled = Filled::new(GRAPH);
    let cache = CacheFolder::open(filled.folder.path()).expect("a cache");
    let before = cache.stats();
    let entries = files_of(&filled.folder.path().join("entries"));
    let bytes: u64 = entries
        .iter()
        .map(|path| path.metadata().expect("a file").len())
        .sum();
    cache.gc(bytes);
    assert_eq!(cache.stats().entries, before.entries);
    assert_eq!(cache.stats().values, 0);
}
