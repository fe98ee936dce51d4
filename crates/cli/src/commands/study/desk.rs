//! A study with its graph, its variants and the folder of its results.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use tessgraph_geometry::digest::{Digest, Hasher};
use tessgraph_graph::node::NodeSpec;
use tessgraph_graph::study::{Study, StudyGraph, Variant, Variants};
use tessgraph_graph::world::{DiskWorld, FileError, World, read_plain};
use tessgraph_graph::{Diagnostic, Value};

use super::record::Record;
use crate::diagnostics::without_place;
use crate::graph_file::{LARGEST_GRAPH, folder_of};
use crate::memory;
use crate::text::printable;
use crate::world::RecordingWorld;

/// A study as it lies on disk.
pub(super) struct Desk {
    pub(super) study: Study,
    pub(super) variants: Variants,
    /// The graph's file, as the study and its path lead to it.
    pub(super) graph: PathBuf,
    /// The folder the graph is in.
    pub(super) folder: PathBuf,
    /// The folder of results.
    pub(super) out: PathBuf,
    graph_name: String,
    graph_bytes: Vec<u8>,
    registry: &'static [NodeSpec],
    allowed: Vec<PathBuf>,
    /// What was found of files by now, so that each is looked at once.
    found: Mutex<BTreeMap<String, Option<String>>>,
}

impl Desk {
    /// Reads the study and its graph.
    ///
    /// # Errors
    /// Everything that is wrong with the study, and with the parameters of its
    /// graph.
    pub(super) fn open(
        path: &Path,
        out: Option<&Path>,
        allowed: &[PathBuf],
        registry: &'static [NodeSpec],
    ) -> Result<Self, Vec<Diagnostic>> {
        let name = path.to_string_lossy();
        let bytes = read_plain(path, LARGEST_GRAPH).map_err(|reason| {
            let message = format!("cannot read the study: {reason}");
            vec![without_place("unreadable", &name, message)]
        })?;
        let study = Study::read(&name, &bytes)?;
        let graph = folder_of(path).join(study.graph());
        let graph_bytes = read_plain(&graph, LARGEST_GRAPH).map_err(|reason| {
            let message = format!(
                "cannot read the graph {}: {reason}",
                printable(study.graph())
            );
            vec![study.graph_error(message)]
        })?;
        let graph_name = graph.to_string_lossy().into_owned();
        let text = StudyGraph {
            name: &graph_name,
            bytes: &graph_bytes,
            registry,
        };
        let variants = study.variants(text)?;
        Ok(Self {
            variants,
            folder: folder_of(&graph),
            out: out.map_or_else(|| default_out(path), Path::to_path_buf),
            study,
            graph,
            graph_name,
            graph_bytes,
            registry,
            allowed: allowed.to_vec(),
            found: Mutex::default(),
        })
    }

    /// The graph as the study's functions take it.
    pub(super) fn text(&self) -> StudyGraph<'_> {
        StudyGraph {
            name: &self.graph_name,
            bytes: &self.graph_bytes,
            registry: self.registry,
        }
    }

    /// The folder of a variant below a folder of results.
    pub(super) fn folder_in(out: &Path, variant: &Variant) -> PathBuf {
        out.join("variants").join(&variant.id)
    }

    /// All values that the study gives in a variant.
    pub(super) fn values(&self, variant: &Variant) -> Vec<(String, Value)> {
        let values = self.variants.fixed.iter().chain(&variant.values);
        values.cloned().collect()
    }

    /// The files that the graph may read.
    ///
    /// # Errors
    /// When a folder is gone.
    pub(super) fn disk(&self) -> std::io::Result<DiskWorld> {
        // As in a run, what is read stands in memory twice.
        let disk = DiskWorld::new(&self.folder, &self.allowed)?;
        Ok(disk.limited(memory::limit() / 2))
    }

    /// Digest of what is asked for in a variant, without the contents of files:
    /// program, nodes, values, measures, outputs.
    pub(super) fn job(&self, variant: &Variant) -> String {
        let mut hasher = Hasher::new();
        hasher
            .text("study")
            .text(env!("CARGO_PKG_VERSION"))
            .number(self.registry.len() as u64);
        for spec in self.registry {
            hasher.text(spec.name).number(spec.version.into());
        }
        hasher.text(&variant.id);
        for (name, text) in self.study.measures() {
            hasher.text(name).text(text);
        }
        for output in self.study.keep() {
            hasher.number(1).text(output);
        }
        hasher.finish().to_string()
    }

    /// The name by which the graph's own file stands among those that matter.
    fn own_name(&self) -> String {
        let name = self.graph.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// The digest of the graph as it was read, under its name.
    pub(super) fn own_digest(&self) -> (String, Option<String>) {
        let digest = Digest::of(&self.graph_bytes).to_string();
        (self.own_name(), Some(digest))
    }

    /// The record of a variant in a folder of results if it is of this study,
    /// this graph and these files, and all it left is there.
    pub(super) fn current(&self, out: &Path, variant: &Variant) -> Option<Record> {
        let folder = Self::folder_in(out, variant);
        let record = Record::read(&folder)?;
        let agrees = record.job == self.job(variant)
            && record
                .files
                .iter()
                .all(|(path, digest)| self.digest(path) == *digest)
            && record.is_whole(&folder);
        agrees.then_some(record)
    }

    /// Digest of a file as it is on disk; each is looked at once.
    fn digest(&self, path: &str) -> Option<String> {
        let found = || self.found.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(digest) = found().get(path) {
            return digest.clone();
        }
        let digest = if path == self.own_name() {
            self.own_digest().1
        } else {
            let bytes = self.disk().ok().and_then(|disk| disk.read(path).ok());
            bytes.map(|bytes| Digest::of(&bytes).to_string())
        };
        found().insert(path.to_owned(), digest.clone());
        digest
    }

    /// Looks at files again that were looked at before.
    pub(super) fn forget_files(&self) {
        self.found
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clear();
    }
}

/// Where results go unless another folder is named.
pub(crate) fn default_out(study: &Path) -> PathBuf {
    folder_of(study)
        .join("out")
        .join(study.file_stem().unwrap_or_default())
}

/// The files of one variant, with the digest of each as it was read.
pub(super) struct DigestingWorld {
    pub(super) files: RecordingWorld,
    read: Mutex<BTreeMap<String, Option<String>>>,
}

impl DigestingWorld {
    pub(super) fn new(disk: DiskWorld) -> Self {
        Self {
            files: RecordingWorld::new(disk),
            read: Mutex::default(),
        }
    }

    /// Digests of all files that were read or looked for.
    pub(super) fn digests(&self) -> BTreeMap<String, Option<String>> {
        self.read
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

impl World for DigestingWorld {
    fn identity(&self, path: &str) -> String {
        self.files.identity(path)
    }

    fn read(&self, path: &str) -> Result<Arc<[u8]>, FileError> {
        let content = self.files.read(path);
        // Not under the lock: hashing uses the thread pool.
        let digest = content
            .as_ref()
            .ok()
            .map(|bytes| Digest::of(bytes).to_string());
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.insert(path.to_owned(), digest);
        drop(read);
        content
    }
}
