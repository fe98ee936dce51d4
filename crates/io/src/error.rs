//! What can be wrong with a file, and where.

use std::{fmt, io};

use tessgraph_geometry::GeometryError;

use crate::Format;

/// Why a mesh could not be read or written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The caller's monitor asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// What a file is written to does not take it: a full disk, a closed pipe.
    #[error("{message}")]
    NotTaken {
        /// What the system calls it.
        kind: io::ErrorKind,
        /// The system's words.
        message: String,
    },
    /// The file's content, or the mesh to be written, cannot be used.
    #[error(transparent)]
    Fault(Box<Fault>),
}

/// One fault: which file, where in it, what is wrong and what to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Name of the file as the caller or the referring file gave it; empty
    /// while writing, where only the caller knows it.
    pub file: String,
    /// The format it was read or written as.
    pub format: Option<Format>,
    /// Where in the file.
    pub place: Place,
    /// The kind of fault, for programs.
    pub kind: FaultKind,
    /// What is wrong, without a full stop.
    pub cause: String,
    /// What a person can do about it, without a full stop.
    pub help: String,
}

/// Where in a file a fault is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A character of a text file.
    Line {
        /// Counted from 1.
        line: usize,
        /// Counted from 1, in characters.
        column: usize,
    },
    /// A byte of a binary file, counted from 0.
    Byte(u64),
    /// A value of a JSON file, as a JSON pointer (RFC 6901).
    Pointer(String),
}

/// The kinds of fault, for callers that treat them differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FaultKind {
    /// The content is another format than the name says.
    WrongContent,
    /// There is nothing in the file.
    Empty,
    /// The text or structure breaks the format's rules.
    Syntax,
    /// The file ends before its content does.
    Truncated,
    /// An index or offset points outside what it counts.
    OutOfRange,
    /// A number is NaN, infinite or beyond the format's reach.
    NotFinite,
    /// A legal feature that is not read.
    Unsupported,
    /// More than the memory limit or 32-bit indices allow.
    TooLarge,
    /// A reference that leads out of the file's folder.
    UnsafeReference,
    /// A file this one needs could not be had.
    Unresolved,
    /// The elements do not make a mesh.
    Mesh,
}

impl IoError {
    pub(crate) fn new(
        kind: FaultKind,
        place: Place,
        cause: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self::Fault(Box::new(Fault {
            file: String::new(),
            format: None,
            place,
            kind,
            cause: cause.into(),
            help: help.into(),
        }))
    }

    /// Names the file where no inner step has done so already.
    pub(crate) fn in_file(mut self, name: &str, format: Format) -> Self {
        if let Self::Fault(fault) = &mut self {
            if fault.file.is_empty() {
                fault.file = name.to_owned();
            }
            fault.format.get_or_insert(format);
        }
        self
    }

    /// The fault, unless the operation was cancelled or its sink failed.
    pub fn fault(&self) -> Option<&Fault> {
        match self {
            Self::Cancelled | Self::NotTaken { .. } => None,
            Self::Fault(fault) => Some(fault),
        }
    }
}

impl From<GeometryError> for IoError {
    fn from(error: GeometryError) -> Self {
        let kind = match &error {
            GeometryError::Cancelled => return Self::Cancelled,
            GeometryError::TooMany { .. } => FaultKind::TooLarge,
            GeometryError::NonFiniteVertex { .. } | GeometryError::NonFiniteValue { .. } => {
                FaultKind::NotFinite
            }
            _ => FaultKind::Mesh,
        };
        let help = "repair the mesh in the program that made it and export it again";
        Self::new(kind, Place::File, error.to_string(), help)
    }
}

impl Fault {
    /// File, place and cause, without the way out, which is in `help`.
    pub fn message(&self) -> String {
        match (self.file.is_empty(), &self.place) {
            (true, Place::File) => self.cause.clone(),
            (_, place) => format!("{}{place}: {}", shorten(&self.file), self.cause),
        }
    }
}

impl std::error::Error for Fault {}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.message(), self.help)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line { line, column } => write!(f, ":{line}:{column}"),
            Self::Byte(byte) => write!(f, ": byte {byte}"),
            Self::Pointer(pointer) => write!(f, ": {pointer}"),
        }
    }
}

/// Characters of a quoted piece of a file that a message shows.
const SHOWN: usize = 60;

/// Text out of a file, fit for a message: control characters escaped, so that
/// they never reach a terminal, and at most 60 characters.
pub(crate) fn shorten(text: &str) -> String {
    let mut out = String::new();
    for (count, c) in text.chars().enumerate() {
        if count == SHOWN {
            out.push('…');
            break;
        }
        if c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c) {
            out.extend(c.escape_default());
        } else {
            out.push(c);
        }
    }
    out
}

/// [`shorten`] for bytes that may not be UTF-8, in backticks.
pub(crate) fn quote(bytes: &[u8]) -> String {
    let part = &bytes[..bytes.len().min(4 * SHOWN + 4)];
    format!("`{}`", shorten(&String::from_utf8_lossy(part)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn message_has_file_place_cause_and_help() {
        let place = Place::Line { line: 3, column: 7 };
        let error = IoError::new(FaultKind::Syntax, place, "cause", "help");
        let error = error.in_file("a.obj", Format::Obj);
        assert_eq!(error.to_string(), "a.obj:3:7: cause; help");
    }

    #[test]
    fn without_a_file_there_is_only_the_cause() {
        let error = IoError::new(FaultKind::TooLarge, Place::File, "cause", "help");
        assert_eq!(error.to_string(), "cause; help");
    }

    #[test]
    fn an_inner_file_keeps_its_name() {
        let error = IoError::new(FaultKind::Syntax, Place::Byte(4), "cause", "help");
        let error = error
            .in_file("inner.bin", Format::Gltf)
            .in_file("outer.gltf", Format::Gltf);
        assert_eq!(error.to_string(), "inner.bin: byte 4: cause; help");
    }

    #[test]
    fn quoted_text_is_short_and_without_escapes() {
        let quoted = quote(&[b'a'; 1000]);
        assert!(quoted.chars().count() < 70);
        assert!(!quote(b"\x1b[31mred").contains('\x1b'));
    }
}
