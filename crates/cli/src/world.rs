//! The files of a run, with a memory of which were read.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use tessgraph_graph::world::{DiskWorld, FileError, World};

/// Where the files lie that were read, links followed, and what they were asked
/// for as.
pub(crate) type ReadFiles = BTreeMap<PathBuf, String>;

/// Files on disk; remembers where those lie that were read, so that no output
/// replaces one of them.
pub(crate) struct RecordingWorld {
    disk: DiskWorld,
    read: Mutex<ReadFiles>,
}

impl RecordingWorld {
    pub(crate) fn new(disk: DiskWorld) -> Self {
        Self {
            disk,
            read: Mutex::default(),
        }
    }

    /// Why a file could not be read, without reading it.
    pub(crate) fn problem(&self, path: &str) -> Option<FileError> {
        self.disk.file(path).err()
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
    fn read(&self, path: &str) -> Result<Arc<[u8]>, FileError> {
        if let Ok(place) = self.disk.resolve(path) {
            self.read
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .entry(place)
                .or_insert_with(|| path.to_owned());
        }
        self.disk.read(path)
    }
}
