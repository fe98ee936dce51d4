//! A node's only door to the world.

use std::sync::{Arc, Mutex, PoisonError};

use tessgraph_geometry::Monitor;
use tessgraph_geometry::digest::Digest;

use super::NodeError;
use crate::units::Units;
use crate::value::FilePath;
use crate::world::World;

/// The way out where a file cannot be read.
const FILE_HELP: &str =
    "name a plain file that you may read; paths begin at the folder of the graph file";

/// A file that a node found only while reading another: a material library, a
/// glTF buffer. Its result depends on it too.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct FileUse {
    /// Which of the node's path inputs names the file it was found in.
    pub input: usize,
    /// The path from that file's folder.
    pub relative: String,
    /// Digest of the content; `None` if there was no such file.
    pub content: Option<Digest>,
}

impl FileUse {
    /// Where the file is when it was found in the file at `path`.
    pub fn beside(&self, path: &str) -> String {
        beside(path, &self.relative)
    }
}

/// The path `relative` taken from the folder of `path`.
fn beside(path: &str, relative: &str) -> String {
    match path.rsplit_once('/') {
        Some((folder, _)) => format!("{folder}/{relative}"),
        None => relative.to_owned(),
    }
}

/// What a node may use besides its inputs: files, warnings, progress.
///
/// Shared by reference, so that parallel loops inside a node can use it.
pub struct EvalCx<'a> {
    world: &'a dyn World,
    monitor: &'a dyn Monitor,
    units: Units,
    paths: Vec<String>,
    warnings: Mutex<Vec<String>>,
    files: Mutex<Vec<FileUse>>,
}

impl<'a> EvalCx<'a> {
    /// A context for one evaluation of one node whose path inputs are `paths`.
    pub fn new(
        world: &'a dyn World,
        monitor: &'a dyn Monitor,
        units: Units,
        paths: Vec<String>,
    ) -> Self {
        let (warnings, files) = (Mutex::default(), Mutex::default());
        Self {
            world,
            monitor,
            units,
            paths,
            warnings,
            files,
        }
    }

    /// The content of a file named by a path input.
    ///
    /// # Errors
    /// When it cannot be read, saying why.
    pub fn read(&self, path: &FilePath) -> Result<Arc<[u8]>, NodeError> {
        self.world
            .read(path.as_str())
            .map_err(|error| NodeError::new(error.to_string()).with_help(FILE_HELP))
    }

    /// The content of a file named inside another file: `relative` is taken
    /// from the folder of `path`. It becomes a dependency even if it is missing,
    /// so that making it later is noticed.
    ///
    /// # Errors
    /// When it cannot be read, saying why.
    pub fn read_beside(&self, path: &FilePath, relative: &str) -> Result<Arc<[u8]>, NodeError> {
        let result = self.world.read(&beside(path.as_str(), relative));
        let content = result.as_ref().ok().map(|bytes| Digest::of(bytes));
        let input = self
            .paths
            .iter()
            .position(|other| other == path.as_str())
            .unwrap_or(0);
        let used = FileUse {
            input,
            relative: relative.to_owned(),
            content,
        };
        self.files
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(used);
        result.map_err(|error| NodeError::new(error.to_string()))
    }

    /// Tells the user something that does not stop the work; kept with the
    /// result and shown again whenever the result is reused.
    pub fn warn(&self, message: impl Into<String>) {
        self.warnings
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(message.into());
    }

    /// Progress and cancellation, for the loops of `geometry`.
    pub fn monitor(&self) -> &dyn Monitor {
        self.monitor
    }

    /// The units of the graph file, for messages.
    pub fn units(&self) -> Units {
        self.units
    }

    /// A length in metres as text in the file's units: "12 cm".
    pub fn length(&self, metres: f64) -> String {
        self.units.length_text(metres)
    }

    /// Everything that was warned of, and the further files that were read.
    pub fn finish(self) -> (Vec<String>, Vec<FileUse>) {
        let warnings = self
            .warnings
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        let mut files = self
            .files
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        files.sort();
        files.dedup();
        (warnings, files)
    }
}
