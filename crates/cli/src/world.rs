//! The files of a run, with a memory of which were read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use tessgraph_graph::world::{DiskWorld, FileError, World};

/// Where the files lie that were read, links followed, and what they were asked
/// for as.
pub(crate) type ReadFiles = BTreeMap<PathBuf, String>;

/// Is told of everything that is read as soon as it is: the absolute path, links
/// not followed, and the content, if there is a file that may be read.
pub(crate) type Listener = Arc<dyn Fn(PathBuf, Option<Arc<[u8]>>) + Send + Sync>;

/// Files on disk; remembers where those lie that were read, so that no output
/// replaces one of them.
pub(crate) struct RecordingWorld {
    disk: DiskWorld,
    read: Mutex<ReadFiles>,
    /// Who is told, and the folder that paths are taken from.
    listener: Option<(Listener, PathBuf)>,
}

impl RecordingWorld {
    pub(crate) fn new(disk: DiskWorld) -> Self {
        Self {
            disk,
            read: Mutex::default(),
            listener: None,
        }
    }

    /// Why a file could not be read, without reading it.
    pub(crate) fn problem(&self, path: &str) -> Option<FileError> {
        self.disk.file(path).err()
    }

    /// The same files, taken from `folder`; `listener` is told what is read.
    pub(crate) fn telling(mut self, listener: Option<&Listener>, folder: &Path) -> Self {
        self.listener = listener.map(|listener| (Arc::clone(listener), folder.to_owned()));
        self
    }

    /// All files that were read so far.
    pub(crate) fn files_read(&self) -> ReadFiles {
        self.read
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

impl World for RecordingWorld {
    fn identity(&self, path: &str) -> String {
        self.disk.identity(path)
    }

    fn read(&self, path: &str) -> Result<Arc<[u8]>, FileError> {
        if let Ok(place) = self.disk.resolve(path) {
            self.read
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .entry(place)
                .or_insert_with(|| path.to_owned());
        }
        let content = self.disk.read(path);
        if let Some((listener, folder)) = &self.listener {
            tell(listener, &folder.join(path), content.as_ref().ok());
        }
        content
    }
}

/// Tells a listener of a file by its absolute path.
pub(crate) fn tell(listener: &Listener, path: &Path, content: Option<&Arc<[u8]>>) {
    // Only an empty path is none: that names no file.
    if let Ok(path) = std::path::absolute(path) {
        listener(path, content.map(Arc::clone));
    }
}
