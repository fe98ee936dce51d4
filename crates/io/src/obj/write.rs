//! Writing OBJ: all vertices in order, then the faces as polygons.

use glam::{DVec2, DVec3};
use tessgraph_geometry::{
    Attribute, AttributeValues, Domain, Labels, Mesh, Monitor, NO_LABEL, PROVENANCE, glam,
};

use super::materials::unique_names;
use super::tags::{CORNER, CREASE};
use crate::intern::Interner;
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

/// Elements between two looks at the monitor.
const POLL: usize = 1 << 14;

/// Writes a mesh as OBJ.
///
/// Vertices keep their order; faces stay polygons, with objects, groups and
/// materials. The attributes that [`crate::read()`] makes of an OBJ file are
/// written: `uv`, `normal` (equal values once), `color`, `crease`,
/// `corner_sharpness`; others are named in a warning. Numbers have the fewest
/// digits that read back exactly, so a mesh read from OBJ is written and read
/// back equal. Cost: O(corners).
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
    let writer = Writer {
        out: Text::with_capacity(64 + 40 * mesh.vertex_count() + 8 * mesh.corner_count()),
        mesh,
        monitor,
    };
    writer
        .write(options)
        .map_err(|error| error.in_file("", Format::Obj))
}

struct Writer<'a> {
    out: Text,
    mesh: &'a Mesh,
    monitor: &'a dyn Monitor,
}

impl Writer<'_> {
    fn write(mut self, options: &ObjOptions) -> Result<Written, IoError> {
        if let Some(library) = &options.material_library {
            self.out
                .text("mtllib ")
                .text(&plain_name(library, false))
                .text("\n");
        }
        self.vertices()?;
        let uvs = match self.values("uv", Domain::Corner) {
            Some(AttributeValues::Vector2(uvs)) => self.uvs(&uvs.clone())?,
            _ => Vec::new(),
        };
        let normals = match self.values("normal", Domain::Corner) {
            Some(AttributeValues::Vector3(normals)) => self.normals(&normals.clone())?,
            _ => Vec::new(),
        };
        self.faces(&uvs, &normals)?;
        self.tags(options.boundary);
        let warnings = self.warnings();
        Ok(Written {
            bytes: self.out.into_bytes(),
            warnings,
        })
    }

    fn values(&self, name: &str, domain: Domain) -> Option<&AttributeValues> {
        self.mesh.attribute(name, domain).map(Attribute::values)
    }

    /// Looks at the monitor now and then.
    fn poll(&self, index: usize) -> Result<(), IoError> {
        if index.is_multiple_of(POLL) {
            self.monitor.check()?;
            let total = (self.mesh.vertex_count() + self.mesh.face_count()) as u64;
            self.monitor.progress(index as u64, total);
        }
        Ok(())
    }

    fn vertices(&mut self) -> Result<(), IoError> {
        let mesh = self.mesh;
        let colors = match self.values("color", Domain::Vertex) {
            Some(AttributeValues::Vector3(colors)) => Some(colors.clone()),
            _ => None,
        };
        for (vertex, place) in mesh.positions().iter().enumerate() {
            self.poll(vertex)?;
            self.out.text("v");
            self.triple(*place);
            if let Some(colors) = &colors {
                self.triple(colors[vertex]);
            }
            self.out.text("\n");
        }
        Ok(())
    }

    #[inline]
    fn triple(&mut self, value: DVec3) {
        self.out
            .text(" ")
            .float(value.x)
            .text(" ")
            .float(value.y)
            .text(" ")
            .float(value.z);
    }

    /// Writes distinct texture coordinates; the number of each corner's, from 1.
    fn uvs(&mut self, uvs: &[DVec2]) -> Result<Vec<u32>, IoError> {
        let mut distinct = Interner::new();
        let numbers = uvs
            .iter()
            .map(|uv| distinct.number([uv.x.to_bits(), uv.y.to_bits()]) + 1)
            .collect();
        for (index, &[u, v]) in distinct.keys().iter().enumerate() {
            self.poll(index)?;
            self.out
                .text("vt ")
                .float(f64::from_bits(u))
                .text(" ")
                .float(f64::from_bits(v));
            self.out.text("\n");
        }
        Ok(numbers)
    }

    /// Writes distinct normals; the number of each corner's, from 1.
    fn normals(&mut self, normals: &[DVec3]) -> Result<Vec<u32>, IoError> {
        let mut distinct = Interner::new();
        let numbers = normals
            .iter()
            .map(|normal| distinct.number(normal.to_array().map(f64::to_bits)) + 1)
            .collect();
        for (index, &key) in distinct.keys().iter().enumerate() {
            self.poll(index)?;
            self.out.text("vn");
            self.triple(DVec3::from(key.map(f64::from_bits)));
            self.out.text("\n");
        }
        Ok(numbers)
    }

    fn faces(&mut self, uvs: &[u32], normals: &[u32]) -> Result<(), IoError> {
        let mesh = self.mesh;
        let objects: Vec<_> = names(mesh.objects(), |name| plain_name(name, false));
        let groups: Vec<_> = names(mesh.groups(), |names| {
            let plain: Vec<_> = names.iter().map(|name| plain_name(name, true)).collect();
            plain.join(" ")
        });
        let materials = unique_names(mesh.materials());
        let mut current = [NO_LABEL; 3];
        for face in 0..mesh.face_count() {
            self.poll(face)?;
            let labels = [
                ("o", mesh.objects().of_face(), &objects),
                ("g", mesh.groups().of_face(), &groups),
                ("usemtl", mesh.materials().of_face(), &materials),
            ];
            for ((keyword, of_face, names), current) in labels.into_iter().zip(&mut current) {
                let label = of_face.get(face).copied().unwrap_or(NO_LABEL);
                if label != *current {
                    *current = label;
                    self.out.text(keyword);
                    if let Some(name) = names.get(label as usize) {
                        self.out.text(" ").text(name);
                    }
                    self.out.text("\n");
                }
            }
            self.face(face, uvs, normals);
        }
        Ok(())
    }

    #[inline]
    fn face(&mut self, face: usize, uvs: &[u32], normals: &[u32]) {
        let topology = self.mesh.topology();
        self.out.text("f");
        for corner in topology.corner_range(face) {
            self.out
                .text(" ")
                .integer(u64::from(topology.corners()[corner]) + 1);
            match (uvs.get(corner), normals.get(corner)) {
                (None, None) => {}
                (Some(&uv), None) => {
                    self.out.text("/").integer(uv.into());
                }
                (None, Some(&normal)) => {
                    self.out.text("//").integer(normal.into());
                }
                (Some(&uv), Some(&normal)) => {
                    self.out
                        .text("/")
                        .integer(uv.into())
                        .text("/")
                        .integer(normal.into());
                }
            }
        }
        self.out.text("\n");
    }

    /// OpenSubdiv's tags for sharp edges, sharp vertices and the border rule.
    fn tags(&mut self, boundary: Option<i64>) {
        let mesh = self.mesh;
        if let Some(AttributeValues::Number(sharpness)) = self.values(CREASE, Domain::Corner) {
            let sharpness = sharpness.clone();
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
                        self.out
                            .text("t crease 2/1/0 ")
                            .integer(a)
                            .text(" ")
                            .integer(b);
                        self.out.text(" ").float(sharpness[corner]).text("\n");
                    }
                }
            }
        }
        if let Some(AttributeValues::Number(sharpness)) = self.values(CORNER, Domain::Vertex) {
            let sharp = sharpness.clone();
            for (vertex, &value) in sharp.iter().enumerate().filter(|item| *item.1 > 0.0) {
                self.out.text("t corner 1/1/0 ").integer(vertex as u64);
                self.out.text(" ").float(value).text("\n");
            }
        }
        if let Some(rule) = boundary {
            self.out
                .text(&format!("t interpolateboundary 1/0/0 {rule}\n"));
        }
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
