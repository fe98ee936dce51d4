//! OpenSubdiv's kept baselines: the shapes with their tags, and what they
//! become after each refinement.
//!
//! Not covered: the three `catmark_square_hedit` shapes, whose vertex edits
//! move single points of a level by hand; that is out of scope.

use std::path::{Path, PathBuf};

use super::*;

/// What the tests need of an OBJ file with OpenSubdiv's tags.
struct Shape {
    mesh: Mesh,
    boundary: Boundary,
    has_edits: bool,
}

/// `t NAME ints/floats/strings values...`: values by kind, in that order.
fn tag_values(words: &[&str]) -> (Vec<u32>, Vec<f64>) {
    let counts: Vec<usize> = words[0]
        .split('/')
        .map(|n| n.parse().expect("a count"))
        .collect();
    let (whole, rest) = words[1..].split_at(counts[0]);
    let whole = whole
        .iter()
        .map(|n| n.parse().expect("an integer"))
        .collect();
    let real = rest[..counts[1]]
        .iter()
        .map(|n| n.parse().expect("a number"))
        .collect();
    (whole, real)
}

fn parse(text: &str) -> Shape {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    let (mut creases, mut corners) = (Vec::new(), Vec::new());
    let (mut boundary, mut has_edits) = (Boundary::EdgeOnly, false);
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["v", x, y, z, ..] => {
                positions.push([x, y, z].map(|n| n.parse::<f64>().expect("a coordinate")));
            }
            ["f", ref corners @ ..] => {
                let vertex = |word: &&str| {
                    let first = word.split('/').next().unwrap_or(word);
                    first.parse::<u32>().expect("an index") - 1
                };
                faces.push(corners.iter().map(vertex).collect::<Vec<_>>());
            }
            ["t", "crease", ref rest @ ..] => {
                let (ends, sharpness) = tag_values(rest);
                creases.push(([ends[0], ends[1]], sharpness[0]));
            }
            ["t", "corner", ref rest @ ..] => {
                let (vertices, sharpness) = tag_values(rest);
                corners.push((vertices[0], sharpness[0]));
            }
            ["t", "interpolateboundary", ref rest @ ..] => {
                boundary = match tag_values(rest).0[0] {
                    1 => Boundary::EdgeAndCorner,
                    _ => Boundary::EdgeOnly,
                };
            }
            ["t", "vertexedit", ..] => has_edits = true,
            _ => {}
        }
    }
    let mesh = Mesh::from_faces(positions, &faces).expect("valid");
    Shape {
        mesh: with_corners(with_creases(mesh, &creases), &corners),
        boundary,
        has_edits,
    }
}

/// The folder of test meshes, if this machine has it.
fn corpus() -> Option<PathBuf> {
    let given = std::env::var_os("TESSGRAPH_CORPUS").map(PathBuf::from);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let beside = ["../shared/corpus", "../../shared/corpus"].map(|place| root.join(place));
    let found = given.into_iter().chain(beside).find(|place| place.is_dir());
    if found.is_none() {
        println!("SKIPPED: no corpus; set TESSGRAPH_CORPUS to its folder");
    }
    found
}

#[expect(clippy::disallowed_methods, reason = "a test reads its own corpus")]
fn read(path: &Path) -> String {
    std::fs::read_to_string(path).expect("readable")
}

fn obj_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "obj"))
        .collect();
    files.sort();
    files
}

/// Every shape OpenSubdiv tests with, two levels against the textbook: valence
/// 2 to 360, holes, creases that end and meet. Faces that are holes are kept.
#[test]
fn every_shape_agrees_with_the_textbook_or_is_refused() {
    let Some(corpus) = corpus() else {
        return;
    };
    let (mut agreed, mut others) = (0, Vec::new());
    for path in obj_files(&corpus.join("quad/opensubdiv")) {
        let name = path.file_stem().and_then(|s| s.to_str()).expect("a name");
        let Shape { mesh, boundary, .. } = parse(&read(&path));
        let topology = mesh.topology();
        let touching = (0..mesh.vertex_count()).any(|vertex| topology.fan_count(vertex) > 1);
        match subdivide(&mesh, levels(1), &Unmonitored) {
            Ok(_) if !touching => {
                println!("{name}");
                super::oracle::check(&mesh, boundary, if mesh.face_count() > 200 { 1 } else { 2 });
                super::limits::check_levels(&mesh, boundary, 1e-12 * mesh.diagonal());
                agreed += 1;
            }
            Ok(_) => others.push(format!("{name}: sheets touch")),
            Err(error) => others.push(format!("{name}: {error}")),
        }
    }
    println!("{agreed} agree; {others:#?}");
    assert!(agreed >= 30 && others.len() <= 5, "{others:?}");
}

#[test]
fn every_baseline_is_met() {
    let Some(corpus) = corpus() else {
        return;
    };
    let files = obj_files(&corpus.join("quad/opensubdiv_baseline"));
    let (mut met, mut skipped) = (0, Vec::new());
    for path in &files {
        let stem = path.file_stem().and_then(|s| s.to_str()).expect("a name");
        let (shape, level) = stem.split_once("_level").expect("NAME_levelK");
        let source = corpus.join(format!("quad/opensubdiv/{shape}.obj"));
        let given = parse(&read(&source));
        if given.has_edits {
            skipped.push(stem);
            continue;
        }
        let options = Options {
            boundary: given.boundary,
            ..levels(level.parse::<u32>().expect("a level") + 1)
        };
        let ours = run(&given.mesh, options).mesh;
        let theirs = parse(&read(path)).mesh;
        assert_eq!(ours.vertex_count(), theirs.vertex_count(), "{stem}");
        assert_eq!(ours.face_count(), theirs.face_count(), "{stem}");
        let distance = set_distance(ours.positions(), theirs.positions());
        assert!(distance < 1e-6, "{stem}: {distance}");
        met += 1;
    }
    println!(
        "{met} baselines met; vertex edits not covered: {}",
        skipped.join(", ")
    );
    assert!(met + skipped.len() == files.len() && met >= 30);
}
