//! Outputs: settled before a run, written after it.

mod encode;
mod format;
mod tables;
mod target;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use tessgraph_geometry::digest::Digest;
use tessgraph_graph::{Diagnostic, Plan, Value};

pub(crate) use target::{Folders, Target, targets};

use crate::atomic::write_if_changed;
use crate::places::is_same_file;
use crate::text::printable;
use encode::{Encoded, Failure, encode};
use target::onto_input;

/// An output that was written, or was there already.
#[derive(Debug, Clone)]
pub(crate) struct WrittenOutput {
    /// Its path as written in the graph.
    pub(crate) name: String,
    /// Its path for people: from where they are.
    pub(crate) shown: String,
    /// Bytes of the file.
    pub(crate) bytes: u64,
    /// Whether the file was replaced; if not, it held these bytes already.
    pub(crate) changed: bool,
    /// What the format could not hold, a sentence each without a full stop.
    pub(crate) lost: Vec<String>,
}

/// Writes a value to its place; `read` are the files that the run read.
///
/// # Errors
/// When it cannot be written; whatever was at the place is then untouched.
pub(crate) fn write(
    plan: &Plan,
    target: &Target,
    value: &Value,
    provenance: Option<Digest>,
    read: &BTreeSet<PathBuf>,
) -> Result<WrittenOutput, Box<Diagnostic>> {
    let name = printable(&target.name);
    let fail = |message: String| {
        let span = target.span.clone();
        Box::new(Diagnostic::error(
            "output_failed",
            &plan.source,
            span,
            message,
            "",
        ))
    };
    let Encoded { files, warnings } =
        encode(plan, target, value, provenance).map_err(|failure| {
            let Failure { message, help } = failure;
            let mut diagnostic = fail(format!("cannot write `{name}`: {message}"));
            diagnostic.help = help;
            diagnostic
        })?;
    let (mut bytes, mut changed) = (0, false);
    for (path, content) in &files {
        if let Some(input) = read.iter().find(|input| is_same_file(input, path)) {
            return Err(Box::new(onto_input(plan, target, input)));
        }
        changed |= write_if_changed(path, content)
            .map_err(|error| fail(format!("cannot write {}: {error}", shown(path))))?;
        if *path == target.path {
            bytes = content.len() as u64;
        }
    }
    Ok(WrittenOutput {
        name: target.name.clone(),
        shown: shown(&target.path),
        bytes,
        changed,
        lost: warnings,
    })
}

/// A path from the current folder, if it lies below it.
fn shown(path: &Path) -> String {
    let here = Path::new(".").canonicalize().ok();
    let below = here.and_then(|here| path.strip_prefix(here).ok());
    printable(&below.unwrap_or(path).to_string_lossy()).into_owned()
}
