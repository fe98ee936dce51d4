//! Every file of the corpus, where there is one: loads with the manifest's
//! counts, or is refused with a place, a cause and a way out.
//!
//! The corpus is not part of this repository. It is looked for at
//! `TESSGRAPH_CORPUS`, or in `shared/corpus` beside the workspace.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tessgraph_geometry::{Domain, Field, Mesh, Quantity, Unmonitored};

use crate::{
    FaultKind, Format, GlbColors, GlbNormals, GlbOptions, IoError, Loaded, Place, ReadOptions,
    ResolveError, no_files, read, write_glb,
};

struct Row {
    path: String,
    expected: String,
    counts: Option<(usize, usize)>,
}

fn corpus() -> Option<PathBuf> {
    let root = match std::env::var_os("TESSGRAPH_CORPUS") {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/corpus"),
    };
    if root.join("MANIFEST.tsv").is_file() {
        return Some(root);
    }
    println!("SKIPPED: there is no corpus at {}", root.display());
    None
}

#[expect(clippy::disallowed_methods, reason = "tests read files directly")]
fn content(path: &Path) -> std::io::Result<Vec<u8>> {
    std::fs::read(path)
}

fn rows(root: &Path) -> Vec<(Row, Format)> {
    let manifest = String::from_utf8(content(&root.join("MANIFEST.tsv")).unwrap()).unwrap();
    let row = |line: &str| {
        let cells: Vec<_> = line.split('\t').collect();
        let format = Format::from_name(cells[0])?;
        let counts = cells[4].parse().ok().zip(cells[5].parse().ok());
        let (path, expected) = (cells[0].to_owned(), cells[3].to_owned());
        Some((
            Row {
                path,
                expected,
                counts,
            },
            format,
        ))
    };
    manifest.lines().skip(1).filter_map(row).collect()
}

/// Reads a file with the files beside it.
fn load(path: &Path, format: Format) -> Result<Loaded, IoError> {
    let folder = path.parent().unwrap();
    let mut resolve = |name: &str| -> Result<Arc<[u8]>, ResolveError> {
        assert!(
            !name.contains("..") && !Path::new(name).is_absolute(),
            "asked for {name}"
        );
        match content(&folder.join(name)) {
            Ok(bytes) => Ok(bytes.into()),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                Err(ResolveError::NotFound)
            }
            Err(error) => Err(ResolveError::Failed(error.to_string())),
        }
    };
    let name = path.file_name().unwrap().to_string_lossy();
    let bytes = content(path).unwrap();
    read(
        format,
        &name,
        &bytes,
        &mut resolve,
        &ReadOptions::default(),
        &Unmonitored,
    )
}

/// What is wrong with the outcome of a row, if anything.
fn judge(row: &Row, outcome: &Result<Loaded, IoError>) -> Option<String> {
    match (outcome, row.expected.as_str()) {
        (Ok(loaded), "loads" | "either") => {
            let counts = (loaded.mesh.vertex_count(), loaded.mesh.face_count());
            let wanted = row.counts.unwrap_or(counts);
            (counts != wanted).then(|| format!("{counts:?} instead of {wanted:?}"))
        }
        (Ok(_), _) => Some("was not refused".to_owned()),
        (Err(error), "loads") => Some(error.to_string()),
        (Err(error), _) => {
            let fault = error.fault()?;
            let whole_file = matches!(fault.kind, FaultKind::Empty | FaultKind::Mesh);
            let no_place = fault.place == Place::File && !whole_file;
            let silent = fault.cause.is_empty() || fault.help.is_empty() || fault.file.is_empty();
            (no_place || silent).then(|| format!("says too little: {error}"))
        }
    }
}

#[test]
fn every_file_is_read_or_refused_as_the_manifest_says() {
    let Some(root) = corpus() else { return };
    let mut tally: BTreeMap<(String, &str), usize> = BTreeMap::new();
    let (mut wrong, mut incomplete) = (Vec::new(), Vec::new());
    for (row, format) in rows(&root) {
        let outcome = load(&root.join(&row.path), format);
        let kind = outcome
            .as_ref()
            .err()
            .and_then(IoError::fault)
            .map(|fault| fault.kind);
        if kind == Some(FaultKind::Unresolved) && row.expected == "loads" {
            incomplete.push(row.path.clone());
        } else if let Some(why) = judge(&row, &outcome) {
            wrong.push(format!("{}: {why}", row.path));
        }
        if let Err(error) = &outcome {
            println!("{error}");
        }
        let done = if outcome.is_ok() { "loaded" } else { "refused" };
        *tally.entry((row.expected, done)).or_default() += 1;
    }
    println!("{tally:#?}\nlack a file beside them: {incomplete:#?}");
    assert!(
        incomplete.len() <= 1,
        "files that are there were not found: {incomplete:?}"
    );
    assert!(
        wrong.is_empty(),
        "{} rows are wrong:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// Numbers that look random and are the same in every run (splitmix64).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) as usize % limit.max(1)
    }
}

#[test]
fn mutants_of_every_file_give_a_mesh_or_an_error() {
    let Some(root) = corpus() else { return };
    let asked = std::env::var("TESSGRAPH_MUTANTS")
        .ok()
        .and_then(|count| count.parse().ok());
    let wanted: usize = asked.unwrap_or(2000);
    let small = |bytes: &Vec<u8>| (1..20_000).contains(&bytes.len());
    let files: Vec<_> = rows(&root)
        .into_iter()
        .map(|(row, format)| (format, content(&root.join(row.path)).unwrap()))
        .filter(|(_, bytes)| small(bytes))
        .collect();
    let mut random = Random(1);
    for _ in 0..wanted {
        let (format, bytes) = &files[random.below(files.len())];
        let mut mutant = bytes.clone();
        let at = random.below(mutant.len());
        match random.below(3) {
            0 => mutant[at] = random.below(256) as u8,
            1 => mutant.truncate(at),
            _ => {
                let (_, other) = &files[random.below(files.len())];
                mutant.truncate(at);
                mutant.extend_from_slice(&other[random.below(other.len())..]);
            }
        }
        crate::hostile::survive(*format, &mutant).unwrap();
    }
    println!("{wanted} mutants of {} files", files.len());
}

/// Every file that loads is written as GLB and read back: flat and smooth, with
/// a field as colours. With `TESSGRAPH_GLB_DIR` the files are kept there, for
/// the Khronos validator to judge.
#[test]
fn what_loads_is_written_as_glb() {
    let Some(root) = corpus() else { return };
    let keep = std::env::var_os("TESSGRAPH_GLB_DIR").map(PathBuf::from);
    let mut written = 0;
    for (row, format) in rows(&root) {
        let Ok(loaded) = load(&root.join(&row.path), format) else {
            continue;
        };
        let mesh = &loaded.mesh;
        // A face of so many corners takes quadratic time to cut.
        if mesh.topology().faces().any(|face| face.len() > 5000) {
            continue;
        }
        let numbers = (0..mesh.face_count()).map(|face| face as f64).collect();
        let field = Field::new(Domain::Face, Quantity::Number, numbers).unwrap();
        let colors = GlbColors::Field {
            field: &field,
            name: "face",
            range: None,
        };
        for (normals, colors) in [
            (GlbNormals::Flat, GlbColors::Attribute),
            (GlbNormals::Smooth, colors),
        ] {
            let options = GlbOptions {
                normals,
                colors,
                name: Some("corpus"),
                extras: None,
            };
            match write_glb(mesh, &options, &Unmonitored) {
                Ok(glb) => {
                    check_glb(mesh, &glb.bytes, &row.path);
                    if let Some(folder) = &keep {
                        std::fs::write(folder.join(format!("{written}.glb")), &glb.bytes).unwrap();
                    }
                    written += 1;
                }
                Err(error) => {
                    assert_eq!(error.fault().unwrap().kind, FaultKind::NotFinite, "{error}");
                }
            }
        }
    }
    println!("{written} GLB files");
}

/// The file holds the triangles of `mesh`, to seven digits of its size.
fn check_glb(mesh: &Mesh, bytes: &[u8], path: &str) {
    let again = read(
        Format::Glb,
        "x.glb",
        bytes,
        &mut no_files,
        &ReadOptions::default(),
        &Unmonitored,
    );
    let triangles = mesh.triangle_vertices(&mesh.triangles());
    if triangles.is_empty() {
        assert_eq!(again.unwrap_err().fault().unwrap().kind, FaultKind::Empty);
        return;
    }
    let again = again.unwrap().mesh;
    assert_eq!(again.face_count(), triangles.len(), "{path}");
    if mesh.materials().labels().len() > 1 {
        return;
    }
    let tolerance = mesh.diagonal() * 1e-6;
    for (face, triangle) in triangles.iter().enumerate() {
        for (a, b) in again.face(face).iter().zip(triangle) {
            let (a, b) = (
                again.positions()[*a as usize],
                mesh.positions()[*b as usize],
            );
            assert!((a - b).length() <= tolerance, "{path}: {a} instead of {b}");
        }
    }
}
