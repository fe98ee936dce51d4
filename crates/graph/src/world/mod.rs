//! Where files come from: a disk, or memory in tests.

mod plain;

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use plain::plain_file;
pub use plain::read_plain;

/// The files a graph can read, by path relative to its folder.
pub trait World: Sync {
    /// The whole content of a file.
    ///
    /// # Errors
    /// When it does not exist, may not be read, or is not a plain file.
    fn read(&self, path: &str) -> Result<Arc<[u8]>, FileError>;

    /// A name that two paths share if and only if they lead to one file.
    fn identity(&self, path: &str) -> String {
        tidy(path)
    }
}

/// Why a file could not be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileError {
    /// The path as asked for.
    pub path: String,
    /// The reason, in words.
    pub reason: String,
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot read `{}`: {}", self.path, self.reason)
    }
}

impl std::error::Error for FileError {}

/// Files on disk, inside a graph's folder tree and the folders allowed besides.
#[derive(Debug, Clone)]
pub struct DiskWorld {
    root: PathBuf,
    allowed: Vec<PathBuf>,
    largest: u64,
}

impl DiskWorld {
    /// Files under `root`, the graph's folder, or under one of `allowed`.
    ///
    /// # Errors
    /// When a folder does not exist.
    pub fn new(root: &Path, allowed: &[PathBuf]) -> std::io::Result<Self> {
        let root = root.canonicalize()?;
        let allowed = allowed
            .iter()
            .map(|path| path.canonicalize())
            .collect::<Result<_, _>>()?;
        let largest = u64::MAX;
        Ok(Self {
            root,
            allowed,
            largest,
        })
    }

    /// The same, but files above so many bytes are refused before they are read.
    #[must_use]
    pub fn limited(self, largest: u64) -> Self {
        Self { largest, ..self }
    }

    /// The file that `path` means, with symbolic links followed.
    ///
    /// # Errors
    /// When there is none, or it lies outside what may be read.
    pub fn resolve(&self, path: &str) -> Result<PathBuf, FileError> {
        let fail = |reason: String| FileError {
            path: path.to_owned(),
            reason,
        };
        if path.is_empty() {
            return Err(fail("the path is empty".to_owned()));
        }
        let full = self.root.join(path);
        let found = full.canonicalize().map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => {
                fail("there is no such file in the graph's folder".to_owned())
            }
            _ => fail(error.to_string()),
        })?;
        if self
            .allowed
            .iter()
            .chain([&self.root])
            .any(|folder| found.starts_with(folder))
        {
            Ok(found)
        } else {
            Err(fail(format!(
                "it lies outside the graph's folder; allow it with `--allow {}`",
                found.parent().unwrap_or(&found).display()
            )))
        }
    }

    /// The plain file that `path` means, as [`DiskWorld::resolve`] finds it.
    ///
    /// # Errors
    /// As there, and when it is something else than a plain file.
    pub fn file(&self, path: &str) -> Result<PathBuf, FileError> {
        let found = self.resolve(path)?;
        let fail = |reason: String| FileError {
            path: path.to_owned(),
            reason,
        };
        plain_file(&found).map_err(fail)?;
        Ok(found)
    }
}

impl World for DiskWorld {
    fn identity(&self, path: &str) -> String {
        let found = self.root.join(path).canonicalize();
        found.map_or_else(|_| tidy(path), |found| found.to_string_lossy().into_owned())
    }

    fn read(&self, path: &str) -> Result<Arc<[u8]>, FileError> {
        let found = self.resolve(path)?;
        let fail = |reason: String| FileError {
            path: path.to_owned(),
            reason,
        };
        let bytes = read_plain(&found, self.largest).map_err(fail)?;
        Ok(bytes.into())
    }
}

/// Files held in memory.
#[derive(Debug, Clone, Default)]
pub struct MemoryWorld {
    files: BTreeMap<String, Arc<[u8]>>,
}

impl MemoryWorld {
    /// Adds or replaces a file.
    pub fn insert(&mut self, path: impl Into<String>, content: impl Into<Arc<[u8]>>) {
        self.files.insert(path.into(), content.into());
    }
}

impl World for MemoryWorld {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, FileError> {
        self.files
            .get(&tidy(path))
            .cloned()
            .ok_or_else(|| FileError {
                path: path.to_owned(),
                reason: "there is no such file".to_owned(),
            })
    }
}

/// The path without `.` and with `..` resolved by text.
fn tidy(path: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for component in Path::new(path).components() {
        match component {
            Component::Normal(part) => parts.extend(part.to_str()),
            Component::ParentDir => {
                parts.pop();
            }
            _ => {}
        }
    }
    parts.join("/")
}
