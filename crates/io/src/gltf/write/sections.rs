//! The binary chunk: for each primitive its vertices' parts and its triangles.

use std::ops::Range;

use bytemuck::NoUninit;
use serde_json::{Map, Value, json};

use super::parts::{Part, Parts, Source};
use crate::error::IoError;
use crate::stream::Stream;

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// A run of equal elements in the binary chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    Positions,
    Normals,
    Uvs,
    Colors,
    /// With two bytes each.
    ShortIndices,
    Indices,
}

impl Section {
    /// Its name among a primitive's attributes; none of triangles.
    fn attribute(self) -> Option<&'static str> {
        match self {
            Self::Positions => Some("POSITION"),
            Self::Normals => Some("NORMAL"),
            Self::Uvs => Some("TEXCOORD_0"),
            Self::Colors => Some("COLOR_0"),
            Self::ShortIndices | Self::Indices => None,
        }
    }

    /// The type of its components, that of its elements, and an element's bytes.
    fn layout(self) -> (u32, &'static str, usize) {
        match self {
            Self::Positions | Self::Normals => (FLOAT, "VEC3", 12),
            Self::Uvs => (FLOAT, "VEC2", 8),
            Self::Colors => (UNSIGNED_SHORT, "VEC4", 8),
            Self::ShortIndices => (UNSIGNED_SHORT, "SCALAR", 2),
            Self::Indices => (UNSIGNED_INT, "SCALAR", 4),
        }
    }

    fn count(self, part: &Part, source: &Source<'_>) -> usize {
        match self.attribute() {
            Some(_) => part.vertex_count(),
            None => 3 * part.triangle_count(source.mesh()),
        }
    }

    fn bytes(self, part: &Part, source: &Source<'_>) -> usize {
        self.layout().2 * self.count(part, source)
    }
}

/// The sections of a primitive, in the order of the file.
fn sections(part: &Part, source: &Source<'_>) -> impl Iterator<Item = Section> {
    // 65535 itself is the restart value.
    let is_short = part.vertex_count() <= usize::from(u16::MAX);
    [
        (Section::Positions, true),
        (Section::Normals, true),
        (Section::Uvs, source.has_uvs()),
        (Section::Colors, source.has_colors()),
        (Section::ShortIndices, is_short),
        (Section::Indices, !is_short),
    ]
    .into_iter()
    .filter(|section| section.1)
    .map(|section| section.0)
}

/// The parts of the JSON that say what the binary chunk holds.
#[derive(Default)]
pub(super) struct Described {
    /// Bytes of all sections, each padded to four.
    pub(super) length: usize,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
    pub(super) primitives: Vec<Value>,
}

/// Describes the binary chunk that [`write()`] writes.
pub(super) fn describe(parts: &Parts, source: &Source<'_>) -> Described {
    let mut described = Described::default();
    for (material, part) in parts.list.iter().enumerate() {
        let (mut attributes, mut indices) = (Map::new(), Value::Null);
        for section in sections(part, source) {
            let accessor = described.add(section, part, source);
            match section.attribute() {
                Some(name) => {
                    attributes.insert(name.into(), accessor.into());
                }
                None => indices = accessor.into(),
            }
        }
        let primitive = json!({
            "attributes": attributes,
            "indices": indices,
            "material": material,
        });
        described.primitives.push(primitive);
    }
    described
}

impl Described {
    /// Adds a section; gives the number of its accessor.
    fn add(&mut self, section: Section, part: &Part, source: &Source<'_>) -> usize {
        let bytes = section.bytes(part, source);
        let target = match section.attribute() {
            Some(_) => ARRAY_BUFFER,
            None => ELEMENT_ARRAY_BUFFER,
        };
        self.views.push(json!({
            "buffer": 0,
            "byteOffset": self.length,
            "byteLength": bytes,
            "target": target,
        }));
        self.length += bytes.next_multiple_of(4);
        let (component, kind, _) = section.layout();
        let mut accessor = Map::new();
        accessor.insert("bufferView".into(), (self.views.len() - 1).into());
        accessor.insert("componentType".into(), component.into());
        accessor.insert("count".into(), section.count(part, source).into());
        accessor.insert("type".into(), kind.into());
        match section {
            Section::Positions => {
                let [low, high] = part.bounds(source);
                let value = |corner: [f32; 3]| Value::from(corner.map(f64::from).to_vec());
                accessor.insert("min".into(), value(low));
                accessor.insert("max".into(), value(high));
            }
            Section::Colors => {
                accessor.insert("normalized".into(), true.into());
            }
            _ => {}
        }
        self.accessors.push(accessor.into());
        self.accessors.len() - 1
    }
}

/// Elements that [`write()`] counts for the monitor.
pub(super) fn element_count(parts: &Parts, source: &Source<'_>) -> usize {
    let of_part = |part: &Part| {
        let runs = |section: Section| match section.attribute() {
            Some(_) => part.run_count(),
            None => part.face_count(),
        };
        sections(part, source).map(runs).sum::<usize>()
    };
    parts.list.iter().map(of_part).sum()
}

/// Writes the binary chunk's content.
pub(super) fn write(
    parts: &Parts,
    source: &Source<'_>,
    stream: &mut Stream<'_>,
) -> Result<(), IoError> {
    for part in &parts.list {
        for section in sections(part, source) {
            write_section(section, part, parts.numbers(), source, stream)?;
            let bytes = section.bytes(part, source);
            stream.bytes(&[0; 4][..bytes.next_multiple_of(4) - bytes])?;
        }
    }
    Ok(())
}

fn write_section(
    section: Section,
    part: &Part,
    numbers: &[u32],
    source: &Source<'_>,
    stream: &mut Stream<'_>,
) -> Result<(), IoError> {
    match section {
        Section::Positions => vertices(part, source, stream, |_, corners, out| {
            corners.for_each(|corner| out.push(source.position(corner)));
        }),
        Section::Normals => vertices(part, source, stream, |face, corners, out| {
            let normal = source.normal(face, corners.start);
            out.extend(corners.map(|_| normal));
        }),
        Section::Uvs => vertices(part, source, stream, |_, corners, out| {
            corners.for_each(|corner| out.push(source.uv(corner)));
        }),
        Section::Colors => vertices(part, source, stream, |face, corners, out| {
            corners.for_each(|corner| out.push(source.color(face, corner)));
        }),
        Section::ShortIndices => triangles(part, numbers, source, stream, |vertex| vertex as u16),
        Section::Indices => triangles(part, numbers, source, stream, |vertex| vertex),
    }
}

/// Writes what `of_run` gives for the face and the corners of each run of vertices.
fn vertices<T: NoUninit, const N: usize>(
    part: &Part,
    source: &Source<'_>,
    stream: &mut Stream<'_>,
    of_run: impl Fn(usize, Range<usize>, &mut Vec<[T; N]>) + Sync,
) -> Result<(), IoError> {
    stream.elements(part.run_count(), |runs, out| {
        let mut values = Vec::with_capacity(4 * runs.len());
        part.for_runs(source.mesh(), runs, |face, corners| {
            of_run(face, corners, &mut values);
        });
        put(values.as_flattened(), out);
    })
}

fn triangles<T: NoUninit>(
    part: &Part,
    numbers: &[u32],
    source: &Source<'_>,
    stream: &mut Stream<'_>,
    index: impl Fn(u32) -> T + Sync,
) -> Result<(), IoError> {
    stream.elements(part.face_count(), |faces, out| {
        let mut values = Vec::with_capacity(2 * faces.len());
        part.for_triangles(source.mesh(), numbers, faces, |triangle| {
            values.push(triangle.map(&index));
        });
        put(values.as_flattened(), out);
    })
}

/// Appends numbers, the low byte first.
fn put<T: NoUninit>(values: &[T], out: &mut Vec<u8>) {
    let start = out.len();
    out.extend_from_slice(bytemuck::cast_slice(values));
    if cfg!(target_endian = "big") {
        let written = out[start..].chunks_exact_mut(size_of::<T>());
        written.for_each(<[u8]>::reverse);
    }
}
