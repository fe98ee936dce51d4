//! From values to the bytes of files.

use std::borrow::Cow;
use std::io;
use std::path::PathBuf;

use serde_json::{Map, Value as Json, json};
use tessgraph_geometry::digest::{Digest, Hasher};
use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::{Attribute, AttributeValues, Domain, GeometryError, Mesh, Quantity};
use tessgraph_graph::{Plan, Units, Value};
use tessgraph_io::{
    Format, GlbNormals, GlbOptions, IoError, ObjOptions, PlyOptions, StlOptions, write_glb_to,
    write_mtl, write_obj_to, write_ply_to, write_png, write_stl_to,
};
use tessgraph_render::{DrawOptions, draw};

use super::format::FileFormat;
use super::tables::{csv_text, json_text};
use super::target::Target;
use crate::interrupt::UntilInterrupt;
use crate::json::number;

/// The first line of a material library: a file that begins otherwise is not
/// ours to replace.
pub(super) const LIBRARY_MARK: &[u8] = b"# written by tessgraph\n";

/// A file of an output; an OBJ file's materials come before it.
pub(super) struct EncodedFile<'a> {
    /// Where it goes.
    pub(super) path: PathBuf,
    pub(super) content: Content<'a>,
}

/// What a file holds.
pub(super) enum Content<'a> {
    Bytes(Vec<u8>),
    /// A mesh, which is encoded while it is written.
    Mesh(Box<MeshContent<'a>>),
}

/// A mesh and how it is written.
pub(super) struct MeshContent<'a> {
    mesh: Cow<'a, Mesh>,
    options: MeshOptions,
}

enum MeshOptions {
    Glb {
        normals: GlbNormals,
        name: String,
        extras: Json,
    },
    Obj(ObjOptions),
    Stl,
    Ply,
}

/// Why a value has no bytes, or they were not taken.
#[derive(Debug)]
pub(super) enum Failure {
    Encoding(IoError),
    Other(String),
    Sink(io::Error),
}

impl Failure {
    /// What is wrong, and what to do about it.
    pub(super) fn into_words(self) -> (String, Option<String>) {
        match self {
            Self::Encoding(error) => match error.fault() {
                Some(fault) => (fault.cause.clone(), Some(fault.help.clone())),
                None => (error.to_string(), None),
            },
            Self::Other(message) => (message, None),
            Self::Sink(error) => (error.to_string(), None),
        }
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Sink(error)
    }
}

impl From<IoError> for Failure {
    fn from(error: IoError) -> Self {
        match error {
            IoError::NotTaken { kind, message } => Self::Sink(io::Error::new(kind, message)),
            error => Self::Encoding(error),
        }
    }
}

/// The files of an output. OBJ, STL and PLY carry no unit and are written in
/// the graph's; glTF is in metres, and remembers what it was made from.
pub(super) fn encode<'a>(
    plan: &Plan,
    target: &Target,
    value: &'a Value,
    provenance: Digest,
) -> Result<Vec<EncodedFile<'a>>, Failure> {
    let quantity = plan.result_spec(target.result).quantity;
    let bytes = match (target.format, value) {
        (FileFormat::Mesh(format), Value::Mesh(mesh)) => {
            return encode_mesh(plan, target, format, mesh, provenance);
        }
        (FileFormat::Png, Value::Mesh(mesh)) => Some(picture(mesh)?),
        (FileFormat::Json, value) => json_text(value, quantity, plan.units).map(String::into_bytes),
        (FileFormat::Csv, value) => csv_text(value, plan.units).map(String::into_bytes),
        _ => None,
    };
    // Kinds were checked before the run; this is a node that broke its word.
    let instead = || Failure::Other(format!("the node gave {} instead", value.kind().label()));
    let file = EncodedFile {
        path: target.path.clone(),
        content: Content::Bytes(bytes.ok_or_else(instead)?),
    };
    Ok(vec![file])
}

/// What a target's bytes depend on: the value, how it is written, and for a GLB
/// what it says of its origin.
pub(super) fn made_from(plan: &Plan, target: &Target, value: Digest, provenance: Digest) -> Digest {
    let quantity = plan.result_spec(target.result).quantity;
    let mut hasher = Hasher::new();
    hasher
        .text(env!("CARGO_PKG_VERSION"))
        .text(target.format.name())
        .number(target.format.version().into())
        .float(plan.units.metres())
        .text(&quantity.to_string())
        .digest(value);
    if target.format == FileFormat::Mesh(Format::Glb) {
        hasher
            .digest(provenance)
            .number(plan.parameters.len() as u64);
        for parameter in &plan.parameters {
            hasher
                .text(&parameter.name)
                .digest(parameter.value.digest());
        }
    }
    hasher.finish()
}

/// A picture as [`DrawOptions`] has it by default: the colours are the mesh's own.
fn picture(mesh: &Mesh) -> Result<Vec<u8>, Failure> {
    let picture = draw(mesh, &DrawOptions::default(), &UntilInterrupt);
    let picture = picture.map_err(|error| Failure::Other(error.to_string()))?;
    Ok(write_png(picture.size(), picture.pixels(), &[]))
}

fn encode_mesh<'a>(
    plan: &Plan,
    target: &Target,
    format: Format,
    mesh: &'a Mesh,
    provenance: Digest,
) -> Result<Vec<EncodedFile<'a>>, Failure> {
    let mesh = if format.is_metric() {
        Cow::Borrowed(mesh)
    } else {
        in_units(mesh, plan.units)?
    };
    let mut files = Vec::new();
    let options = match format {
        Format::Glb | Format::Gltf => {
            let name = target.path.file_stem().unwrap_or_default();
            MeshOptions::Glb {
                normals: shading(&mesh),
                name: name.to_string_lossy().into_owned(),
                extras: origin(plan, provenance),
            }
        }
        Format::Obj => {
            let library = target
                .material_library()
                .filter(|_| !mesh.materials().is_empty());
            let name = library.as_ref().and_then(|path| path.file_name());
            let options = ObjOptions {
                material_library: name.map(|name| name.to_string_lossy().into_owned()),
                ..ObjOptions::default()
            };
            files.extend(library.map(|path| EncodedFile {
                path,
                content: Content::Bytes([LIBRARY_MARK, &write_mtl(&mesh)].concat()),
            }));
            MeshOptions::Obj(options)
        }
        Format::Stl => MeshOptions::Stl,
        Format::Ply => MeshOptions::Ply,
    };
    files.push(EncodedFile {
        path: target.path.clone(),
        content: Content::Mesh(Box::new(MeshContent { mesh, options })),
    });
    Ok(files)
}

impl Content<'_> {
    /// Writes the content; gives what the format could not hold.
    pub(super) fn write(&self, sink: &mut dyn io::Write) -> Result<Vec<String>, Failure> {
        match self {
            Self::Bytes(bytes) => {
                sink.write_all(bytes)?;
                Ok(Vec::new())
            }
            Self::Mesh(content) => content.write(sink),
        }
    }
}

impl MeshContent<'_> {
    fn write(&self, sink: &mut dyn io::Write) -> Result<Vec<String>, Failure> {
        let (mesh, monitor) = (self.mesh.as_ref(), &UntilInterrupt);
        let mut warnings = match &self.options {
            MeshOptions::Glb {
                normals,
                name,
                extras,
            } => {
                let options = GlbOptions {
                    normals: *normals,
                    name: Some(name),
                    extras: Some(extras.clone()),
                    ..GlbOptions::default()
                };
                write_glb_to(sink, mesh, &options, monitor)
            }
            MeshOptions::Obj(options) => write_obj_to(sink, mesh, options, monitor),
            MeshOptions::Stl => write_stl_to(sink, mesh, &StlOptions::default(), monitor),
            MeshOptions::Ply => write_ply_to(sink, mesh, &PlyOptions::default(), monitor),
        }?;
        if mesh.vertex_count() == 0 {
            warnings.push("the mesh is empty: it has no vertices and no faces".to_owned());
        }
        Ok(warnings)
    }
}

/// Smooth where the face attribute `smooth` is set on any face, else flat.
fn shading(mesh: &Mesh) -> GlbNormals {
    let smooth = mesh.attribute("smooth", Domain::Face);
    let is_set = match smooth.map(Attribute::values) {
        Some(AttributeValues::Number(values)) => values.iter().any(|&value| value > 0.0),
        Some(AttributeValues::Integer(values)) => values.iter().any(|&value| value > 0),
        _ => false,
    };
    if is_set {
        GlbNormals::Smooth
    } else {
        GlbNormals::Flat
    }
}

/// The mesh with its lengths in `units`.
fn in_units(mesh: &Mesh, units: Units) -> Result<Cow<'_, Mesh>, Failure> {
    if units == Units::M {
        return Ok(Cow::Borrowed(mesh));
    }
    let written = |metres: f64| units.from_si(metres, Quantity::Length);
    let positions = mesh.positions().iter();
    let positions = positions
        .map(|p| DVec3::new(written(p.x), written(p.y), written(p.z)))
        .collect();
    let scaled = mesh.with_positions(positions);
    let failed = |error: GeometryError| Failure::Other(error.to_string());
    scaled.map(Cow::Owned).map_err(failed)
}

/// What a file was made from: version, digest of the graph and its inputs, and
/// the parameters as they were in this run.
fn origin(plan: &Plan, provenance: Digest) -> Json {
    let parameters = plan.parameters.iter().map(|parameter| {
        let value = match &parameter.value {
            Value::Bool(value) => json!(value),
            Value::Integer(value) => json!(value),
            Value::Number(value) => number(*value),
            Value::Text(text) => json!(text.as_ref()),
            Value::Choice(name) => json!(name),
            other => json!(other.summary()),
        };
        (parameter.name.clone(), value)
    });
    json!({
        "tessgraph": {
            "version": env!("CARGO_PKG_VERSION"),
            "graph_digest": provenance.to_string(),
            "parameters": parameters.collect::<Map<_, _>>(),
        }
    })
}
