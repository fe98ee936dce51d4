//! Why a run takes place.

use std::path::PathBuf;

use crate::outputs::shown;

/// Why a run takes place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Cause {
    /// A file has changed.
    File(PathBuf),
    /// Somebody wants it, in words.
    Asked(String),
}

impl Cause {
    /// For people.
    pub(crate) fn text(&self) -> String {
        match self {
            Self::File(path) => shown(path),
            Self::Asked(words) => words.clone(),
        }
    }
}
