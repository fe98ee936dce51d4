//! Writing OBJ: all vertices in order, then the faces as polygons.

use std::io;

use glam::{DVec2, DVec3};
use tessgraph_geometry::{
    Attribute, AttributeValues, Domain, Labels, Mesh, Monitor, NO_LABEL, PROVENANCE, glam,
};

use super::materials::unique_names;
use super::tags::{CORNER, CREASE};
use crate::intern::Interner;
use crate::stream::Stream;
use crate::write::{Text, Written, plain_name};
use crate::{Format, IoError};

/// How an OBJ file is written.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ObjOptions {
    /// File name of the material library to refer to, if [`crate::write_mtl`]'s
    /// result is stored beside the file.
    pub material_library: Option<String>,
    /// OpenSubdiv's `interpolateboundary` tag, as [`crate::Loaded::boundary`].
    pub boundary: Option<i64>,
}

/// Writes a mesh as OBJ.
///
/// Vertices keep their order; faces stay polygons, with objects, groups and
/// materials. The attributes that [`crate::read()`] makes of an OBJ file are
/// written: `uv`, `normal` (equal values once), `color`, `crease`,
/// `corner_sharpness`; others are named in a warning. Numbers have the fewest
/// digits that read back exactly, so a mesh read from OBJ is written and read
/// back equal. Cost: O(corners), and
/// memory for the file.
///
/// # Errors
/// [`IoError::Cancelled`].
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored};
/// let quad = vec![[0.0, 0.0, 0.5], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Mesh::from_faces(quad, &[[0, 1, 2, 3]])?;
/// let written = tessgraph_io::write_obj(&mesh, &Default::default(), &Unmonitored)?;
/// assert!(written.bytes.starts_with(b"v 0 0 0.5\nv 1 0 0\n"));
/// assert!(written.bytes.ends_with(b"f 1 2 3 4\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_obj(
    mesh: &Mesh,
    options: &ObjOptions,
    monitor: &dyn Monitor,
) -> Result<Written, IoError> {
    Written::of(|sink| write_obj_to(sink, mesh, options, monitor))
}

/// [`write_obj`] to a file or another sink, with memory for some blocks of it
/// only; gives the warnings.
///
/// # Errors
/// As [`write_obj`], and [`IoError::NotTaken`]; the sink then has a part of the
/// file.
pub fn write_obj_to(
    sink: &mut dyn io::Write,
    mesh: &Mesh,
    options: &ObjOptions,
    monitor: &dyn Monitor,
) -> Result<Vec<String>, IoError> {
    let writer = Writer {
        stream: Stream::new(sink, mesh.vertex_count() + mesh.face_count(), monitor),
        mesh,
    };
    writer
        .write(options)
        .map_err(|error| error.in_file("", Format::Obj))
}

struct Writer<'a> {
    stream: Stream<'a>,
    mesh: &'a Mesh,
}

impl<'a> Writer<'a> {
    fn write(mut self, options: &ObjOptions) -> Result<Vec<String>, IoError> {
        if let Some(library) = &options.material_library {
            let line = format!("mtllib {}\n", plain_name(library, false));
            self.stream.bytes(line.as_bytes())?;
        }
        self.vertices()?;
        let uvs = match self.values("uv", Domain::Corner) {
            Some(AttributeValues::Vector2(uvs)) => self.uvs(uvs)?,
            _ => Vec::new(),
        };
        let normals = match self.values("normal", Domain::Corner) {
            Some(AttributeValues::Vector3(normals)) => self.normals(normals)?,
            _ => Vec::new(),
        };
        self.faces(&uvs, &normals)?;
        self.stream.bytes(&self.tags(options.boundary))?;
        Ok(self.warnings())
    }

    fn values(&self, name: &str, domain: Domain) -> Option<&'a AttributeValues> {
        self.mesh.attribute(name, domain).map(Attribute::values)
    }

    fn vertices(&mut self) -> Result<(), IoError> {
        let colors = match self.values("color", Domain::Vertex) {
            Some(AttributeValues::Vector3(colors)) => Some(colors.as_slice()),
            _ => None,
        };
        let positions = self.mesh.positions();
        self.stream.elements(positions.len(), |vertices, out| {
            let mut out = Text::at_end_of(out);
            for vertex in vertices {
                out.text("v");
                triple(&mut out, positions[vertex]);
                if let Some(colors) = colors {
                    triple(&mut out, colors[vertex]);
                }
                out.text("\n");
            }
        })
    }

    /// Writes distinct texture coordinates; the number of each corner's, from 1.
    fn uvs(&mut self, uvs: &[DVec2]) -> Result<Vec<u32>, IoError> {
        let mut distinct = Interner::new();
        let numbers = uvs
            .iter()
            .map(|uv| distinct.number([uv.x.to_bits(), uv.y.to_bits()]) + 1)
            .collect();
        let keys = distinct.keys();
        self.stream.elements(keys.len(), |chosen, out| {
            let mut out = Text::at_end_of(out);
            for &[u, v] in &keys[chosen] {
                out.text("vt ").float(f64::from_bits(u));
                out.text(" ").float(f64::from_bits(v)).text("\n");
            }
        })?;
        Ok(numbers)
    }

    /// Writes distinct normals; the number of each corner's, from 1.
    fn normals(&mut self, normals: &[DVec3]) -> Result<Vec<u32>, IoError> {
        let mut distinct = Interner::new();
        let numbers = normals
            .iter()
            .map(|normal| distinct.number(normal.to_array().map(f64::to_bits)) + 1)
            .collect();
        let keys = distinct.keys();
        self.stream.elements(keys.len(), |chosen, out| {
            let mut out = Text::at_end_of(out);
            for key in &keys[chosen] {
                out.text("vn");
                triple(&mut out, DVec3::from(key.map(f64::from_bits)));
                out.text("\n");
            }
        })?;
        Ok(numbers)
    }

    fn faces(&mut self, uvs: &[u32], normals: &[u32]) -> Result<(), IoError> {
        let mesh = self.mesh;
        let objects: Vec<_> = names(mesh.objects(), |name| plain_name(name, false));
        let groups: Vec<_> = names(mesh.groups(), |names| {
            let plain: Vec<_> = names.iter().map(|name| plain_name(name, true)).collect();
            plain.join(" ")
        });
        let labels = [
            ("o", mesh.objects().of_face(), objects),
            ("g", mesh.groups().of_face(), groups),
            (
                "usemtl",
                mesh.materials().of_face(),
                unique_names(mesh.materials()),
            ),
        ];
        self.stream.elements(mesh.face_count(), |faces, out| {
            let mut out = Text::at_end_of(out);
            for face in faces {
                for (keyword, of_face, names) in &labels {
                    let label = |face: usize| of_face.get(face).copied().unwrap_or(NO_LABEL);
                    let before = face.checked_sub(1).map_or(NO_LABEL, label);
                    if label(face) == before {
                        continue;
                    }
                    out.text(keyword);
                    if let Some(name) = names.get(label(face) as usize) {
                        out.text(" ").text(name);
                    }
                    out.text("\n");
                }
                self::face(&mut out, mesh, face, uvs, normals);
            }
        })
    }

    /// OpenSubdiv's tags for sharp edges, sharp vertices and the border rule.
    fn tags(&self, boundary: Option<i64>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut out = Text::at_end_of(&mut bytes);
        let mesh = self.mesh;
        if let Some(AttributeValues::Number(sharpness)) = self.values(CREASE, Domain::Corner) {
            let mut written = Interner::new();
            for face in 0..mesh.face_count() {
                let vertices = mesh.face(face);
                for (k, corner) in mesh.topology().corner_range(face).enumerate() {
                    let (a, b) = (
                        u64::from(vertices[k]),
                        u64::from(vertices[(k + 1) % vertices.len()]),
                    );
                    let before = written.keys().len();
                    if sharpness[corner] > 0.0
                        && written.number([a.min(b), a.max(b)]) as usize == before
                    {
                        out.text("t crease 2/1/0 ").integer(a).text(" ").integer(b);
                        out.text(" ").float(sharpness[corner]).text("\n");
                    }
                }
            }
        }
        if let Some(AttributeValues::Number(sharpness)) = self.values(CORNER, Domain::Vertex) {
            for (vertex, &value) in sharpness.iter().enumerate().filter(|item| *item.1 > 0.0) {
                out.text("t corner 1/1/0 ").integer(vertex as u64);
                out.text(" ").float(value).text("\n");
            }
        }
        if let Some(rule) = boundary {
            out.text(&format!("t interpolateboundary 1/0/0 {rule}\n"));
        }
        bytes
    }

    fn warnings(&self) -> Vec<String> {
        let written = |attribute: &&Attribute| {
            matches!(
                (attribute.name(), attribute.domain(), attribute.values()),
                ("uv", Domain::Corner, AttributeValues::Vector2(_))
                    | ("normal", Domain::Corner, AttributeValues::Vector3(_))
                    | ("color", Domain::Vertex, AttributeValues::Vector3(_))
                    | (CREASE, Domain::Corner, AttributeValues::Number(_))
                    | (CORNER, Domain::Vertex, AttributeValues::Number(_))
            )
        };
        let lost = self
            .mesh
            .attributes()
            .iter()
            .filter(|attribute| !written(attribute));
        lost_attributes(lost, Format::Obj)
    }
}

#[inline]
fn triple(out: &mut Text<'_>, value: DVec3) {
    out.text(" ").float(value.x);
    out.text(" ").float(value.y);
    out.text(" ").float(value.z);
}

#[inline]
fn face(out: &mut Text<'_>, mesh: &Mesh, face: usize, uvs: &[u32], normals: &[u32]) {
    let topology = mesh.topology();
    out.text("f");
    for corner in topology.corner_range(face) {
        let vertex = topology.corners()[corner];
        out.text(" ").integer(u64::from(vertex) + 1);
        match (uvs.get(corner), normals.get(corner)) {
            (None, None) => {}
            (Some(&uv), None) => {
                out.text("/").integer(uv.into());
            }
            (None, Some(&normal)) => {
                out.text("//").integer(normal.into());
            }
            (Some(&uv), Some(&normal)) => {
                out.text("/").integer(uv.into());
                out.text("/").integer(normal.into());
            }
        }
    }
    out.text("\n");
}

/// One warning that names the attributes a format has no place for, except for
/// those that only record where elements come from.
pub(crate) fn lost_attributes<'a>(
    lost: impl Iterator<Item = &'a Attribute>,
    format: Format,
) -> Vec<String> {
    let names: Vec<_> = lost
        .filter(|attribute| !PROVENANCE.contains(&attribute.name()))
        .map(|attribute| format!("`{}`", attribute.name()))
        .collect();
    let noun = match names.len() {
        0 => return Vec::new(),
        1 => "attribute",
        _ => "attributes",
    };
    let names = names.join(", ");
    vec![format!("{format} has no place for the {noun} {names}")]
}

fn names<L>(labels: &Labels<L>, name: impl Fn(&L) -> String) -> Vec<String> {
    labels.labels().iter().map(name).collect()
}
