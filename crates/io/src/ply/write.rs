//! Writing PLY.

use std::io;

use tessgraph_geometry::{Attribute, AttributeValues, Domain, Mesh, Monitor};

use crate::Format;
use crate::error::IoError;
use crate::stream::Stream;
use crate::write::{Text, TextOrBinary, Written, plain_name};

/// How a PLY file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PlyOptions {
    /// Binary is little endian.
    pub encoding: TextOrBinary,
}

/// Writes a mesh as PLY: polygons, positions as doubles, all attributes.
///
/// Attributes are written under the names that reading knows them by (see the
/// table in this module's source): `color` as bytes, which is what other
/// programs expect and keeps 1/255; everything else exactly, integers beyond
/// 32 bits as doubles. Materials, groups and objects have no place in PLY and
/// are named in a warning. Cost: O(size), and
/// memory for the file.
///
/// # Errors
/// [`IoError::Cancelled`].
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored};
/// let triangle = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Mesh::from_faces(triangle, &[[0, 1, 2]])?;
/// let written = tessgraph_io::write_ply(&mesh, &Default::default(), &Unmonitored)?;
/// assert!(written.bytes.starts_with(b"ply\nformat binary_little_endian 1.0\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_ply(
    mesh: &Mesh,
    options: &PlyOptions,
    monitor: &dyn Monitor,
) -> Result<Written, IoError> {
    Written::of(|sink| write_ply_to(sink, mesh, options, monitor))
}

/// [`write_ply`] to a file or another sink, with memory for some blocks of it
/// only; gives the warnings.
///
/// # Errors
/// As [`write_ply`], and [`IoError::NotTaken`]; the sink then has a part of the
/// file.
pub fn write_ply_to(
    sink: &mut dyn io::Write,
    mesh: &Mesh,
    options: &PlyOptions,
    monitor: &dyn Monitor,
) -> Result<Vec<String>, IoError> {
    let columns = |domain: Domain| {
        let attributes = mesh.attributes().iter();
        attributes
            .filter(|attribute| attribute.domain() == domain)
            .map(Output::new)
            .collect()
    };
    let widest = (0..mesh.face_count())
        .map(|face| mesh.face(face).len())
        .max()
        .unwrap_or(0);
    let writer = Writer {
        mesh,
        counts_are_bytes: widest * 3 <= 255,
        vertex: columns(Domain::Vertex),
        face: columns(Domain::Face),
        corner: columns(Domain::Corner),
    };
    let mut stream = Stream::new(sink, mesh.vertex_count() + mesh.face_count(), monitor);
    let written = stream
        .bytes(writer.header(options.encoding).as_bytes())
        .and_then(|()| match options.encoding {
            TextOrBinary::Text => writer.write::<AsciiSink>(&mut stream),
            TextOrBinary::Binary => writer.write::<BinarySink>(&mut stream),
        });
    written.map_err(|error| error.in_file("", Format::Ply))?;
    Ok(lost(mesh))
}

fn lost(mesh: &Mesh) -> Vec<String> {
    let labels = [
        ("materials", mesh.materials().is_empty()),
        ("groups", mesh.groups().is_empty()),
        ("objects", mesh.objects().is_empty()),
    ];
    let names: Vec<_> = labels
        .iter()
        .filter(|label| !label.1)
        .map(|label| label.0)
        .collect();
    if names.is_empty() {
        Vec::new()
    } else {
        vec![format!("PLY has no place for {}", names.join(", "))]
    }
}

/// An attribute as properties.
struct Output<'a> {
    values: &'a AttributeValues,
    /// One per component; lists have the first only.
    names: Vec<String>,
    kind: &'static str,
}

impl<'a> Output<'a> {
    fn new(attribute: &'a Attribute) -> Self {
        let values = attribute.values();
        let on_corner = attribute.domain() == Domain::Corner;
        let name = plain_name(attribute.name(), true);
        let parts = |parts: &[&str]| parts.iter().map(|&part| part.to_owned()).collect();
        let suffixed = |suffixes: &[&str]| {
            suffixes
                .iter()
                .map(|suffix| format!("{name}{suffix}"))
                .collect()
        };
        let (names, kind) = match (name.as_str(), values) {
            ("uv", AttributeValues::Vector2(_)) if on_corner => (parts(&["texcoord"]), "double"),
            ("uv", AttributeValues::Vector2(_)) => (parts(&["s", "t"]), "double"),
            ("color", AttributeValues::Vector3(_)) if !on_corner => {
                (parts(&["red", "green", "blue"]), "uchar")
            }
            ("normal", AttributeValues::Vector3(_)) if !on_corner => {
                (parts(&["nx", "ny", "nz"]), "double")
            }
            (_, AttributeValues::Integer(values)) => {
                let small = values.iter().all(|&value| i32::try_from(value).is_ok());
                (vec![name], if small { "int" } else { "double" })
            }
            (_, AttributeValues::Number(_)) => (vec![name], "double"),
            _ if on_corner => (vec![name], "double"),
            (_, AttributeValues::Vector2(_)) => (suffixed(&["_x", "_y"]), "double"),
            (_, AttributeValues::Vector3(_)) => (suffixed(&["_x", "_y", "_z"]), "double"),
        };
        Self {
            values,
            names,
            kind,
        }
    }

    fn declare(&self, header: &mut String) {
        for name in &self.names {
            header.push_str(&format!("property {} {name}\n", self.kind));
        }
    }

    fn declare_list(&self, counts: &str, header: &mut String) {
        for name in &self.names {
            header.push_str(&format!("property list {counts} {} {name}\n", self.kind));
        }
    }

    fn width(&self) -> usize {
        match self.values {
            AttributeValues::Integer(_) | AttributeValues::Number(_) => 1,
            AttributeValues::Vector2(_) => 2,
            AttributeValues::Vector3(_) => 3,
        }
    }

    fn put<S: Sink>(&self, index: usize, sink: &mut S) {
        match self.values {
            AttributeValues::Integer(values) => self.number(values[index] as f64, sink),
            AttributeValues::Number(values) => self.number(values[index], sink),
            AttributeValues::Vector2(values) => {
                values[index]
                    .to_array()
                    .into_iter()
                    .for_each(|value| self.number(value, sink));
            }
            AttributeValues::Vector3(values) => {
                values[index]
                    .to_array()
                    .into_iter()
                    .for_each(|value| self.number(value, sink));
            }
        }
    }

    #[inline]
    fn number<S: Sink>(&self, value: f64, sink: &mut S) {
        match self.kind {
            "uchar" => sink.byte((value.clamp(0.0, 1.0) * 255.0).round() as u8),
            "int" => sink.int(value as i32),
            _ => sink.double(value),
        }
    }
}

struct Writer<'a> {
    mesh: &'a Mesh,
    counts_are_bytes: bool,
    vertex: Vec<Output<'a>>,
    face: Vec<Output<'a>>,
    corner: Vec<Output<'a>>,
}

impl Writer<'_> {
    fn header(&self, encoding: TextOrBinary) -> String {
        let mesh = self.mesh;
        let counts = if self.counts_are_bytes {
            "uchar"
        } else {
            "uint"
        };
        let index = if mesh.vertex_count() > i32::MAX as usize {
            "uint"
        } else {
            "int"
        };
        let format = match encoding {
            TextOrBinary::Text => "ascii",
            TextOrBinary::Binary => "binary_little_endian",
        };
        let mut header = format!(
            "ply\nformat {format} 1.0\ncomment written by tessgraph\nelement vertex {}\n",
            mesh.vertex_count()
        );
        header.push_str("property double x\nproperty double y\nproperty double z\n");
        self.vertex
            .iter()
            .for_each(|output| output.declare(&mut header));
        header.push_str(&format!("element face {}\n", mesh.face_count()));
        header.push_str(&format!("property list {counts} {index} vertex_indices\n"));
        self.face
            .iter()
            .for_each(|output| output.declare(&mut header));
        self.corner
            .iter()
            .for_each(|output| output.declare_list(counts, &mut header));
        header.push_str("end_header\n");
        header
    }

    /// Writes all rows.
    fn write<S: Sink>(&self, stream: &mut Stream<'_>) -> Result<(), IoError> {
        stream.elements(self.mesh.vertex_count(), |vertices, out| {
            let mut sink = S::at_end_of(std::mem::take(out));
            for vertex in vertices {
                let place = self.mesh.positions()[vertex].to_array();
                place.into_iter().for_each(|value| sink.double(value));
                let columns = self.vertex.iter();
                columns.for_each(|column| column.put(vertex, &mut sink));
                sink.end_row();
            }
            *out = sink.into_bytes();
        })?;
        stream.elements(self.mesh.face_count(), |faces, out| {
            let mut sink = S::at_end_of(std::mem::take(out));
            faces.for_each(|face| self.face_row(face, &mut sink));
            *out = sink.into_bytes();
        })
    }

    #[inline]
    fn face_row<S: Sink>(&self, face: usize, sink: &mut S) {
        let vertices = self.mesh.face(face);
        self.count(vertices.len(), sink);
        vertices.iter().for_each(|&vertex| sink.index(vertex));
        let columns = self.face.iter();
        columns.for_each(|column| column.put(face, sink));
        for column in &self.corner {
            self.count(vertices.len() * column.width(), sink);
            let corners = self.mesh.topology().corner_range(face);
            corners.for_each(|corner| column.put(corner, sink));
        }
        sink.end_row();
    }

    #[inline]
    fn count<S: Sink>(&self, count: usize, sink: &mut S) {
        if self.counts_are_bytes {
            sink.byte(count as u8);
        } else {
            sink.index(count as u32);
        }
    }
}

/// Where values go.
trait Sink {
    fn at_end_of(bytes: Vec<u8>) -> Self;
    fn byte(&mut self, value: u8);
    fn int(&mut self, value: i32);
    fn index(&mut self, value: u32);
    fn double(&mut self, value: f64);
    fn end_row(&mut self);
    fn into_bytes(self) -> Vec<u8>;
}

struct BinarySink {
    out: Vec<u8>,
}

impl Sink for BinarySink {
    fn at_end_of(out: Vec<u8>) -> Self {
        Self { out }
    }

    #[inline]
    fn byte(&mut self, value: u8) {
        self.out.push(value);
    }

    #[inline]
    fn int(&mut self, value: i32) {
        self.out.extend_from_slice(&value.to_le_bytes());
    }

    #[inline]
    fn index(&mut self, value: u32) {
        self.out.extend_from_slice(&value.to_le_bytes());
    }

    #[inline]
    fn double(&mut self, value: f64) {
        self.out.extend_from_slice(&value.to_le_bytes());
    }

    fn end_row(&mut self) {}

    fn into_bytes(self) -> Vec<u8> {
        self.out
    }
}

struct AsciiSink {
    out: Vec<u8>,
    /// Whether the next value is the first of its row.
    first: bool,
}

impl AsciiSink {
    fn part(&mut self) -> Text<'_> {
        if !std::mem::replace(&mut self.first, false) {
            self.out.push(b' ');
        }
        Text::at_end_of(&mut self.out)
    }
}

impl Sink for AsciiSink {
    fn at_end_of(out: Vec<u8>) -> Self {
        Self { out, first: true }
    }

    fn byte(&mut self, value: u8) {
        self.part().integer(value.into());
    }

    fn int(&mut self, value: i32) {
        self.part().float(value.into());
    }

    fn index(&mut self, value: u32) {
        self.part().integer(value.into());
    }

    fn double(&mut self, value: f64) {
        self.part().float(value);
    }

    fn end_row(&mut self) {
        self.out.push(b'\n');
        self.first = true;
    }

    fn into_bytes(self) -> Vec<u8> {
        self.out
    }
}
