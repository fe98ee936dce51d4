//! A graph file on disk, read and checked.

use std::path::{Path, PathBuf};

use tessgraph_graph::node::NodeSpec;
use tessgraph_graph::world::{DiskWorld, read_plain};
use tessgraph_graph::{Diagnostic, LoadOptions, Plan, load_with};

use crate::diagnostics::without_place;
use crate::memory;
use crate::world::{Listener, RecordingWorld, tell};

/// A graph written by people is some kilobytes; more than this is a mistake.
pub(crate) const LARGEST_GRAPH: u64 = 64 << 20;

/// A checked graph and the folder its files are named from.
pub(crate) struct GraphFile {
    /// The graph.
    pub(crate) plan: Plan,
    /// Its path as given.
    pub(crate) path: PathBuf,
    /// The folder it is in.
    pub(crate) folder: PathBuf,
    /// The files it may read, with a memory of those that were read, included
    /// graphs among them.
    pub(crate) world: RecordingWorld,
}

impl GraphFile {
    /// Reads and checks the graph at `path`, with parameters set as asked. Files
    /// outside its folder tree are read only below one of `allowed`.
    ///
    /// # Errors
    /// Everything that is wrong with it and the graphs it includes.
    pub(crate) fn open(
        path: &Path,
        registry: &'static [NodeSpec],
        set: &[(String, String)],
        allowed: &[PathBuf],
    ) -> Result<Self, Vec<Diagnostic>> {
        Self::open_telling(path, registry, set, allowed, None)
    }

    /// [`GraphFile::open`] with somebody who is told of every file that is read
    /// now and later, the graph file itself among them.
    pub(crate) fn open_telling(
        path: &Path,
        registry: &'static [NodeSpec],
        set: &[(String, String)],
        allowed: &[PathBuf],
        listener: Option<&Listener>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let name = path.to_string_lossy();
        let unreadable = |reason: String| {
            let message = format!("cannot read the graph: {reason}");
            let mut diagnostic = without_place("unreadable", &name, message);
            diagnostic.help = Some(match path.is_dir() {
                true => "name the graph file inside it".to_owned(),
                false => "name a graph file; `tessgraph new NAME` makes one".to_owned(),
            });
            vec![diagnostic]
        };
        let read = read_plain(path, LARGEST_GRAPH);
        if let Some(listener) = listener {
            let content = read.as_ref().ok();
            tell(
                listener,
                path,
                content.map(|bytes| bytes.as_slice().into()).as_ref(),
            );
        }
        let bytes = match read {
            Ok(bytes) => bytes,
            Err(reason) => return Err(unreadable(reason)),
        };
        let folder = folder_of(path);
        let world = match DiskWorld::new(&folder, allowed) {
            // What is read stands in memory twice: as bytes, and as what they mean.
            Ok(disk) => {
                RecordingWorld::new(disk.limited(memory::limit() / 2)).telling(listener, &folder)
            }
            Err(error) => return Err(unreadable(error.to_string())),
        };
        let options = LoadOptions { set: set.to_vec() };
        let loaded = load_with(&name, &bytes, registry, &options, &world);
        loaded.plan.map(|plan| Self {
            plan,
            path: path.to_path_buf(),
            folder,
            world,
        })
    }

    /// What tells this graph from others between runs.
    pub(crate) fn identity(&self) -> String {
        let path = &self.path;
        let full = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        full.to_string_lossy().into_owned()
    }
}

/// The folder a file is in.
pub(crate) fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    }
}
