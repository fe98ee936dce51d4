//! Keys: what a node's results depend on, and nothing else.

use tessgraph_geometry::digest::{Digest, Hasher};

use crate::node::{InputSpec, NodeSpec};
use crate::units::Units;
use crate::value::{Kind, Value};

/// What enters a key for one input.
pub(super) enum Part {
    /// The input was left out.
    Absent,
    /// A value, by its digest.
    Value(Digest),
    /// A file, by its content and the format its name chooses.
    File(Digest, String),
}

/// The key of a node: its kind and version, the file's units, and each input's
/// part by name.
///
/// Units decide what a mesh file's coordinates and a plain field mean, and they
/// stand in warnings, which are kept with the result. Never in a key: names of
/// nodes, paths, times, comments, layout, threads.
pub(super) fn node_key(spec: &NodeSpec, units: Units, parts: &[Part]) -> Digest {
    let mut hasher = Hasher::new();
    hasher
        .text(spec.name)
        .number(spec.version.into())
        .float(units.metres())
        .number(parts.len() as u64);
    for (input, part) in spec.inputs.iter().zip(parts) {
        hasher.text(input.name);
        match part {
            Part::Absent => hasher.number(0),
            Part::Value(digest) => hasher.number(1).digest(*digest),
            Part::File(content, format) => hasher.number(2).digest(*content).text(format),
        };
    }
    hasher.finish()
}

/// The part of a value that is known; for a path, `content` is asked for the
/// file's digest. `None` when the file cannot be read: such a node has no key.
pub(super) fn value_part(
    input: &InputSpec,
    value: &Value,
    content: impl Fn(&str) -> Option<Digest>,
) -> Option<Part> {
    match (input.kind, value) {
        (Kind::Path, Value::Text(path)) => Some(Part::File(content(path)?, format_of(path))),
        _ => Some(Part::Value(value.digest())),
    }
}

/// The extension that chooses a file's format, in lower case.
fn format_of(path: &str) -> String {
    let name = path.rsplit('/').next().unwrap_or(path);
    name.rsplit_once('.')
        .map_or(String::new(), |(_, extension)| {
            extension.to_ascii_lowercase()
        })
}
