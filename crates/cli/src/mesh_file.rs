//! A mesh file named on the command line.

use std::path::Path;
use std::sync::Arc;

use tessgraph_graph::world::{DiskWorld, World as _, read_plain};
use tessgraph_graph::{Diagnostic, Label, Severity, Source};
use tessgraph_io::{Format, IoError, Loaded, Place, ReadOptions, ResolveError};

use crate::commands::{Context, FAILED, USAGE};
use crate::diagnostics::{print, without_place};
use crate::graph_file::folder_of;
use crate::interrupt::{INTERRUPTED, UntilInterrupt};
use crate::memory::{default_limit, set_limit};
use crate::text::printable;

/// Reads the mesh at `path`, sets the memory limit, and shows what is wrong.
///
/// # Errors
/// The exit status, with the reason shown.
pub(crate) fn open(path: &Path, cx: &mut Context<'_, '_>) -> Result<(Format, Loaded), u8> {
    let name = path.to_string_lossy();
    let Some(format) = Format::from_name(&name) else {
        let message = format!("`{}` is no mesh file by its extension", printable(&name));
        let help = "files end in .obj, .gltf, .glb, .stl or .ply".to_owned();
        return Err(cx.fail(USAGE, "unknown_format", message, Some(help)));
    };
    let loaded = load(path, format).map_err(|error| match error {
        None => INTERRUPTED,
        Some(diagnostic) => {
            print(cx.console, &[*diagnostic]);
            FAILED
        }
    })?;
    let warnings: Vec<Diagnostic> = loaded
        .warnings
        .iter()
        .map(|text| warning(&name, text))
        .collect();
    print(cx.console, &warnings);
    Ok((format, loaded))
}

/// The mesh, or why it cannot be had; `None` when the user asked to stop.
fn load(path: &Path, format: Format) -> Result<Loaded, Option<Box<Diagnostic>>> {
    let shown = path.to_string_lossy();
    let unreadable = |reason: String| {
        let message = format!("cannot read the mesh: {reason}");
        let diagnostic = without_place("unreadable", &shown, message);
        Some(Box::new(
            diagnostic.with_help("name a mesh file that you may read"),
        ))
    };
    let limit = default_limit();
    set_limit(limit);
    let bytes = read_plain(path, limit / 2).map_err(&unreadable)?;
    let world =
        DiskWorld::new(&folder_of(path), &[]).map_err(|error| unreadable(error.to_string()))?;
    let mut resolve = |relative: &str| {
        world
            .read(relative)
            .map_err(|error| ResolveError::Failed(error.reason))
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let options = ReadOptions {
        memory_limit: limit,
        ..ReadOptions::default()
    };
    tessgraph_io::read(
        format,
        &name,
        &bytes,
        &mut resolve,
        &options,
        &UntilInterrupt,
    )
    .map_err(|error| fault(&error, path, &name, &bytes).map(Box::new))
}

/// A reader's fault, shown at its line where the file has lines.
fn fault(error: &IoError, path: &Path, name: &str, bytes: &[u8]) -> Option<Diagnostic> {
    let fault = error.fault()?;
    let file = path.with_file_name(&fault.file);
    let file = if fault.file == name { path } else { &file };
    let file = file.to_string_lossy();
    let mut diagnostic = match fault.place {
        Place::Line { line, column } if fault.file == name => {
            let text = String::from_utf8_lossy(bytes);
            match offset(&text, line, column) {
                Some(at) => {
                    let mut diagnostic = without_place("bad_mesh", &file, &fault.cause);
                    diagnostic.source = Arc::new(Source::new(file.as_ref(), text.as_ref()));
                    diagnostic.labels = vec![Label {
                        span: diagnostic.source.character(at),
                        message: String::new(),
                    }];
                    diagnostic
                }
                None => without_place("bad_mesh", &format!("{file}{}", fault.place), &fault.cause),
            }
        }
        _ => without_place("bad_mesh", &format!("{file}{}", fault.place), &fault.cause),
    };
    diagnostic.help = Some(fault.help.clone());
    Some(diagnostic)
}

/// The byte at a line and a column, both counted from 1.
fn offset(text: &str, line: usize, column: usize) -> Option<usize> {
    let mut start = 0;
    for _ in 1..line {
        start += text[start..].find('\n')? + 1;
    }
    let length = text[start..].find('\n').unwrap_or(text.len() - start);
    let (at, _) = text[start..start + length]
        .char_indices()
        .nth(column.checked_sub(1)?)?;
    Some(start + at)
}

fn warning(name: &str, text: &str) -> Diagnostic {
    let mut diagnostic = without_place("mesh_warning", name, text);
    diagnostic.severity = Severity::Warning;
    diagnostic
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_become_bytes() {
        let text = "é\nab é x\n";
        assert_eq!(offset(text, 1, 1), Some(0));
        assert_eq!(offset(text, 2, 6), Some(text.find('x').unwrap()));
        assert_eq!(offset(text, 2, 7), None);
        assert_eq!(offset(text, 4, 1), None);
        assert_eq!(offset(text, 1, 0), None);
    }
}
