//! `view`: what the page is told, and what becomes of what it asks for.

mod editing;
mod following;
mod latency;
mod pages;
mod previewing;
mod sharing;
mod showing;

use std::path::Path;

use crate::support::text_of;

/// A grid of `n` times `m` faces, measured.
const GRAPH: &str = r#"// é: a grid
Graph(
    version: 1,
    units: Cm,
    params: {
        "n": 3, // columns
        "m": Integer(default: 2, min: 1, max: 9, about: "rows"),
        "width": Number(default: 100.0, /* keep me */ min: 1, max: 900, unit: Length),
    },
    nodes: {
        "grid": Grid(size: ["width", 100], cells: ["n", "m"]),
        "flat": CheckPlanarity(mesh: "grid"),
        "few": Require(condition: "n < 100", message: "too many columns"),
    },
    outputs: {"grid.obj": "grid", "flat.json": "flat", "few.json": "few"},
)
"#;

/// A folder with a graph of that text.
fn folder_with(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder.path().join("g.ron"), text);
    folder
}

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).expect("written");
}

fn graph_in(folder: &tempfile::TempDir) -> String {
    text_of(&folder.path().join("g.ron"))
}
