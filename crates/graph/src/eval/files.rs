//! The files of one run: each read once, so that a run never mixes an old and
//! a new version of a file.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tessgraph_geometry::digest::Digest;

use crate::world::{FileError, World};

/// Remembers what was read during one run.
pub(super) struct RunFiles<'a> {
    world: &'a dyn World,
    files: Mutex<BTreeMap<String, Arc<ReadFile>>>,
}

/// A file as it was when first asked for.
struct ReadFile {
    bytes: Result<Arc<[u8]>, FileError>,
    digest: Option<Digest>,
}

impl<'a> RunFiles<'a> {
    pub(super) fn new(world: &'a dyn World) -> Self {
        Self {
            world,
            files: Mutex::default(),
        }
    }

    /// Digest of the file's content; `None` if it cannot be read.
    pub(super) fn digest(&self, path: &str) -> Option<Digest> {
        self.file(path).digest
    }

    fn file(&self, path: &str) -> Arc<ReadFile> {
        if let Some(file) = self.lock().get(path) {
            return Arc::clone(file);
        }
        // Not under the lock: hashing runs on the thread pool, and a thread that
        // waits there may take up a node that reads a file. If two threads read
        // the same file, the version of the first one to finish counts for all.
        let bytes = self.world.read(path);
        let digest = bytes.as_ref().ok().map(|bytes| Digest::of(bytes));
        let file = Arc::new(ReadFile { bytes, digest });
        Arc::clone(self.lock().entry(path.to_owned()).or_insert(file))
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<String, Arc<ReadFile>>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl World for RunFiles<'_> {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, FileError> {
        self.file(path).bytes.clone()
    }
}
