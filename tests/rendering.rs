//! `render` and outputs that are pictures, from outside.

use std::path::Path;

use tempfile::TempDir;
use tessgraph_io::read_luminance;

use crate::support::bytes_of;
use crate::support::program::with_graphs;

const GRAPH: &str = r#"Graph(version: 1, units: Mm,
    params: {"top": Number(default: 500, unit: Length)},
    nodes: {
        "base": Grid(cells: (4, 3), size: (1000, 500)),
        "rise": EvaluateField(mesh: "base", value: "x * top / 1000"),
        "way": ConstantDirection(mesh: "base", vector: (0, 0, 1)),
        "roof": DisplaceVertices(mesh: "base", directions: "way", distance: "rise"),
        "painted": ColorByField(mesh: "roof", field: "rise"),
        "size": MeasureMesh(mesh: "roof"),
    },
    outputs: {"size.json": "size", "out/roof.png": "painted", "roof.obj": "roof"})"#;

fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("g.ron"), GRAPH).expect("written");
    folder
}

/// Runs the program in a folder's stead; its status and what it told.
fn tessgraph(folder: &Path, arguments: &[&str]) -> (u8, String) {
    let at = |name: &&str| match name.contains(['/', '.']) && !name.contains(',') {
        true => folder.join(name).to_string_lossy().into_owned(),
        false => (*name).to_owned(),
    };
    let arguments = std::iter::once("tessgraph".to_owned()).chain(arguments.iter().map(at));
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let status = tessgraph::run(arguments, &mut out, &mut err);
    assert!(out.is_empty());
    (status, String::from_utf8_lossy(&err).into_owned())
}

/// The share of a picture that is not paper, on its left and its right half.
fn ink(path: &Path) -> [f64; 2] {
    let bytes = bytes_of(path);
    let picture = read_luminance(&bytes, "picture.png").expect("a sound PNG");
    let dark = |u: f64, v: f64| f64::from(u8::from(picture.at(u, v) < 0.99));
    let half = |left: f64| {
        let places =
            (0..50 * 50).map(|k| (left + f64::from(k % 50) / 100.0, f64::from(k / 50) / 50.0));
        places.map(|(u, v)| dark(u + 0.005, v + 0.01)).sum::<f64>() / 2500.0
    };
    [half(0.0), half(0.5)]
}

#[test]
fn a_graph_its_meshes_and_a_mesh_file_are_drawn() {
    let folder = folder();
    let at = folder.path();
    let (status, told) = tessgraph(at, &["run", "g.ron"]);
    assert_eq!(status, 0, "{told}");
    let first = bytes_of(&at.join("out/roof.png"));
    for arguments in [
        &["render", "g.ron", "-o", "a.png", "--result", "painted"][..],
        &[
            "render", "g.ron", "-o", "b.png", "--result", "roof", "--view", "top",
        ],
        &["render", "roof.obj", "-o", "c.png", "--view", "top"],
    ] {
        let (status, told) = tessgraph(at, arguments);
        assert_eq!((status, told.as_str()), (0, ""), "{arguments:?}");
        assert!(ink(&at.join(arguments[3])).iter().all(|share| *share > 0.1));
    }
    let read = |name: &str| bytes_of(&at.join(name));
    let (drawn, texts) = without_texts(&read("a.png"));
    assert_eq!(drawn, first, "an output is drawn as `render` draws it");
    // And says besides what it is of.
    let texts = String::from_utf8(texts).expect("text");
    assert!(texts.contains("Title\0\0\0\0\0g.ron · painted"), "{texts}");
    assert!(texts.contains("Parameters\0\0\0\0\0top = "), "{texts}");
    // The file is in millimetres; that makes no difference to what fills the picture.
    let [one, other] = ["b.png", "c.png"].map(|name| ink(&at.join(name)));
    assert!({ one.iter().zip(other) }.all(|(one, other)| (one - other).abs() < 0.002));
}

/// A PNG without its texts, and the bodies of these.
fn without_texts(png: &[u8]) -> (Vec<u8>, Vec<u8>) {
    let (head, mut rest) = png.split_at(8);
    let (mut picture, mut texts) = (head.to_vec(), Vec::new());
    while let Some((length, _)) = rest.split_first_chunk::<4>() {
        // Beside its body a chunk has its length, its name and a checksum.
        let (chunk, next) = rest.split_at(12 + u32::from_be_bytes(*length) as usize);
        if &chunk[4..8] == b"iTXt" {
            texts.extend_from_slice(&chunk[8..chunk.len() - 4]);
        } else {
            picture.extend_from_slice(chunk);
        }
        rest = next;
    }
    (picture, texts)
}

#[test]
fn fields_are_drawn_with_a_range_and_parameters_can_be_set() {
    let folder = folder();
    let at = folder.path();
    let draw = |name: &str, more: &[&str]| {
        let arguments = [
            &[
                "render", "g.ron", "-o", name, "--result", "roof", "--field", "rise",
            ],
            more,
        ]
        .concat();
        let (status, told) = tessgraph(at, &arguments);
        assert_eq!((status, told.as_str()), (0, ""), "{arguments:?}");
        bytes_of(&at.join(name))
    };
    let whole = draw("a.png", &[]);
    // In millimetres, as the graph is: the range that the field has anyhow.
    assert_eq!(draw("b.png", &["--range", "0,500"]), whole);
    assert_ne!(draw("c.png", &["--range", "0,250"]), whole);
    assert_ne!(draw("d.png", &["--set", "top=100"]), whole);
    assert_ne!(draw("e.png", &["--no-edges"]), whole);
    let small = draw("f.png", &["--size", "300x200"]);
    assert_eq!(&small[16..24], &[0, 0, 1, 44, 0, 0, 0, 200]);
}

/// Arguments, the status they end with, and parts of what is told.
const REFUSED: &[(&[&str], u8, [&str; 2])] = &[
    (
        &["render", "g.ron", "-o", "x.png", "--result", "rof"],
        2,
        ["no mesh `rof`", "`roof`"],
    ),
    (
        &["render", "g.ron", "-o", "x.png", "--result", "size"],
        2,
        ["no mesh `size`", "`base`"],
    ),
    (
        &["render", "g.ron", "-o", "x.png", "--field", "ris"],
        2,
        ["no field `ris`", "`rise`"],
    ),
    (
        &["render", "a.obj", "-o", "x.png", "--field", "rise"],
        2,
        ["no field `rise`", "no numeric"],
    ),
    (
        &["render", "a.obj", "-o", "x.png", "--result", "roof"],
        2,
        ["neither results", "name a graph"],
    ),
    (
        &["render", "a.obj", "-o", "a.obj"],
        2,
        ["would replace", "another file"],
    ),
    (
        &["render", "no.obj", "-o", "x.png"],
        1,
        ["cannot read", "name a mesh file"],
    ),
    (
        &["render", "g.ron", "-o", "x.png", "--view", "under"],
        2,
        ["no view", "1,-2,0.5"],
    ),
    (
        &["render", "g.ron", "-o", "x.png", "--size", "9x9"],
        2,
        ["1200x800", "16384"],
    ),
    (
        &[
            "render", "g.ron", "-o", "x.png", "--field", "rise", "--range", "2,1",
        ],
        2,
        ["0,1.5", "smaller"],
    ),
    (
        &["render", "g.ron", "-o", "x.png", "--set", "top=wide"],
        2,
        ["top", "number"],
    ),
];

#[test]
fn what_cannot_be_drawn_is_told_with_what_can() {
    let folder = folder();
    let at = folder.path();
    std::fs::write(at.join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    for (arguments, status, parts) in REFUSED {
        let (found, told) = tessgraph(at, arguments);
        assert_eq!(found, *status, "{arguments:?}: {told}");
        assert!(
            parts.iter().all(|part| told.contains(part)),
            "{arguments:?}: {told}"
        );
        assert!(!at.join("x.png").exists(), "{arguments:?}");
    }
}

#[test]
fn every_shipped_graph_can_be_drawn() {
    let folder = with_graphs();
    for entry in std::fs::read_dir(folder.path()).expect("the graphs") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            let picture = path.with_extension("png");
            let [path, picture] = [&path, &picture].map(|path| path.to_string_lossy().into_owned());
            let arguments = ["render", &path, "-o", &picture, "--size", "300x200"];
            let (status, told) = tessgraph(Path::new(""), &arguments);
            assert_eq!(status, 0, "{path}: {told}");
            assert!(
                ink(Path::new(&picture)).iter().sum::<f64>() > 0.02,
                "{path}"
            );
        }
    }
}
