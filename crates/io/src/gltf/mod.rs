//! glTF 2.0: meshes of a scene, as JSON with buffers or in one binary file.
//!
//! Reading takes the mesh instances of the default scene, applies the node
//! transforms and turns y up to z up. The JSON's parts are parsed one by one
//! with the `gltf` crate's types, and everything they claim is checked here
//! before it is used: its own validator trusts counts and node trees.
//! Vertices are those of the accessors, instance by instance; nothing is
//! welded.

mod accessor;
mod assemble;
mod buffers;
mod colormap;
mod container;
mod document;
mod geometry;
mod scene;
mod write;

#[cfg(test)]
mod tests;

use tessgraph_geometry::Monitor;

use crate::error::{FaultKind, IoError, Place};
use crate::{Format, Loaded, ReadOptions, Resolve, sniff, text};
use accessor::Accessors;
use buffers::Buffers;
use document::{Document, JsonPlace};

pub use colormap::{mesh_colors, place_in_range, viridis};
pub use write::{GlbColors, GlbNormals, GlbOptions, write_glb, write_glb_to};

/// Reads a binary glTF file.
///
/// # Errors
/// As [`crate::read()`].
pub(crate) fn read_glb(
    name: &str,
    bytes: &[u8],
    resolve: &mut Resolve<'_>,
    options: &ReadOptions,
    monitor: &dyn Monitor,
) -> Result<Loaded, IoError> {
    if !bytes.starts_with(b"glTF") && (bytes.is_empty() || !b"glTF".starts_with(bytes)) {
        return Err(sniff::wrong_content(Format::Glb, bytes));
    }
    let mut warnings = Vec::new();
    let chunks = container::split(bytes, &mut warnings)?;
    let place = JsonPlace::Byte(chunks.json_start);
    let input = Input {
        name,
        json: chunks.json,
        place,
        binary: chunks.binary,
    };
    read(input, resolve, options, monitor, warnings)
}

/// Reads a JSON glTF file.
///
/// # Errors
/// As [`crate::read()`].
pub(crate) fn read_gltf(
    name: &str,
    bytes: &[u8],
    resolve: &mut Resolve<'_>,
    options: &ReadOptions,
    monitor: &dyn Monitor,
) -> Result<Loaded, IoError> {
    let json = text::without_bom(bytes);
    if !json.trim_ascii_start().starts_with(b"{") {
        return Err(sniff::wrong_content(Format::Gltf, bytes));
    }
    let mut warnings = Vec::new();
    if json.len() < bytes.len() {
        warnings.push("the file starts with a byte order mark, which glTF forbids".to_owned());
    }
    let input = Input {
        name,
        json,
        place: JsonPlace::Line,
        binary: None,
    };
    read(input, resolve, options, monitor, warnings)
}

/// The parts of a glTF file.
struct Input<'a> {
    name: &'a str,
    json: &'a [u8],
    place: JsonPlace,
    binary: Option<&'a [u8]>,
}

fn read(
    input: Input<'_>,
    resolve: &mut Resolve<'_>,
    options: &ReadOptions,
    monitor: &dyn Monitor,
    mut warnings: Vec<String>,
) -> Result<Loaded, IoError> {
    let document = Document::parse(input.json, input.place)?;
    document.check_extensions()?;
    let instances = scene::instances(&document, &mut warnings)?;
    let buffers = Buffers::new(&document, input.name, input.binary, resolve);
    let budget = Budget::new(options.memory_limit);
    let accessors = Accessors::new(&document, buffers, budget);
    let mesh = assemble::assemble(&document, accessors, &instances, monitor, &mut warnings)?;
    Ok(Loaded {
        mesh,
        warnings,
        boundary: None,
    })
}

/// Memory that may still be used.
struct Budget {
    left: u64,
    limit: u64,
}

impl Budget {
    fn new(limit: u64) -> Self {
        Self { left: limit, limit }
    }

    /// Takes `bytes` before they are allocated.
    fn take(&mut self, bytes: u64, pointer: &str) -> Result<(), IoError> {
        match self.left.checked_sub(bytes) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => {
                let cause = format!("the mesh would need more than {} MiB", self.limit >> 20);
                Err(fault(
                    FaultKind::TooLarge,
                    pointer,
                    cause,
                    "raise the memory limit, or read a smaller file",
                ))
            }
        }
    }
}

/// An error at a value of the JSON.
fn fault(kind: FaultKind, pointer: &str, cause: impl Into<String>, help: &str) -> IoError {
    IoError::new(kind, Place::Pointer(pointer.to_owned()), cause, help)
}

/// What to do about a file that breaks the rules.
const EXPORT: &str = "export it again, or check it with the Khronos glTF validator";
