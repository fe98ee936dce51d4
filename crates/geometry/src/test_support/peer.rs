//! Cases that were run through the paper's own add-on.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::obj;
use crate::Mesh;

/// One case: its meshes by name, read on demand.
pub(crate) struct PeerCase {
    folder: PathBuf,
}

/// The case of that name, or `None`, said aloud, where the cases are missing.
pub(crate) fn peer_case(name: &str) -> Option<PeerCase> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join("../../tests/peer/cases").join(name);
    if folder.is_dir() {
        return Some(PeerCase { folder });
    }
    println!("skipped: {} is missing", folder.display());
    None
}

impl PeerCase {
    /// The mesh in `name`.obj.
    pub(crate) fn mesh(&self, name: &str) -> Mesh {
        obj::parse(&self.text(&format!("{name}.obj")))
    }

    /// The numbers of a file with one on each line.
    pub(crate) fn numbers(&self, file: &str) -> Vec<f64> {
        self.text(file)
            .lines()
            .map(|line| line.parse().unwrap())
            .collect()
    }

    /// The whole numbers of a file with a comma between them, by line.
    pub(crate) fn rows(&self, file: &str) -> Vec<Vec<u32>> {
        let text = self.text(file);
        let rows = text.lines().filter(|line| !line.starts_with('#'));
        rows.map(|line| line.split(',').map(|word| word.parse().unwrap()).collect())
            .collect()
    }

    fn text(&self, file: &str) -> String {
        let mut text = String::new();
        let path = self.folder.join(file);
        File::open(&path)
            .unwrap()
            .read_to_string(&mut text)
            .unwrap();
        text
    }
}
