//! The files of a run, with a memory of which were read.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use tessgraph_graph::world::{DiskWorld, FileError, World};

/// Files on disk; remembers where those lie that were read, so that no output
/// replaces one of them.
pub(crate) struct RecordingWorld {
    disk: DiskWorld,
    read: Mutex<BTreeSet<PathBuf>>,
}

impl RecordingWorld {
    pub(crate) fn new(disk: DiskWorld) -> Self {
        Self {
            disk,
            read: Mutex::default(),
        }
    }

    /// All files that were read so far, links followed.
    pub(crate) fn files_read(&self) -> BTreeSet<PathBuf> {
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
                .insert(place);
        }
        self.disk.read(path)
    }
}
