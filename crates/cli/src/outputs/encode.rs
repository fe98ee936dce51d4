//! From values to the bytes of files.

use std::path::PathBuf;

use serde_json::{Map, Value as Json, json};
use tessgraph_geometry::digest::Digest;
use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::{Attribute, AttributeValues, Domain, Mesh, Monitor, Quantity};
use tessgraph_graph::{Plan, Units, Value};
use tessgraph_io::{
    Format, GlbNormals, GlbOptions, IoError, ObjOptions, PlyOptions, StlOptions, Written,
    write_glb, write_mtl, write_obj, write_ply, write_stl,
};

use super::format::FileFormat;
use super::tables::{csv_text, json_text};
use super::target::Target;
use crate::interrupt;
use crate::json::number;

/// The files of one output.
pub(super) struct Encoded {
    /// Where each goes, and its bytes; an OBJ file's materials come before it.
    pub(super) files: Vec<(PathBuf, Vec<u8>)>,
    /// What the format could not hold.
    pub(super) warnings: Vec<String>,
}

/// Why a value has no bytes.
pub(super) struct Failure {
    pub(super) message: String,
    pub(super) help: Option<String>,
}

/// Stops writers when the user asks for it.
struct UntilInterrupt;

impl Monitor for UntilInterrupt {
    fn cancelled(&self) -> bool {
        interrupt::is_requested()
    }
}

/// The bytes of an output. OBJ, STL and PLY carry no unit and are written in
/// the graph's; glTF is in metres, and remembers what it was made from.
pub(super) fn encode(
    plan: &Plan,
    target: &Target,
    value: &Value,
    provenance: Option<Digest>,
) -> Result<Encoded, Failure> {
    let quantity = plan.result_spec(target.result).quantity;
    let text = match (target.format, value) {
        (FileFormat::Mesh(format), Value::Mesh(mesh)) => {
            return encode_mesh(plan, target, format, mesh, provenance);
        }
        (FileFormat::Json, value) => json_text(value, quantity, plan.units),
        (FileFormat::Csv, value) => csv_text(value, plan.units),
        _ => None,
    };
    let Some(text) = text else {
        // Kinds were checked before the run; this is a node that broke its word.
        let message = format!("the node gave {} instead", value.kind().label());
        return Err(Failure {
            message,
            help: None,
        });
    };
    let files = vec![(target.path.clone(), text.into_bytes())];
    Ok(Encoded {
        files,
        warnings: Vec::new(),
    })
}

fn encode_mesh(
    plan: &Plan,
    target: &Target,
    format: Format,
    mesh: &Mesh,
    provenance: Option<Digest>,
) -> Result<Encoded, Failure> {
    let scaled = if format.is_metric() {
        None
    } else {
        in_units(mesh, plan.units)?
    };
    let mesh = scaled.as_ref().unwrap_or(mesh);
    let monitor = &UntilInterrupt;
    let mut files = Vec::new();
    let Written { bytes, warnings } = match format {
        Format::Glb | Format::Gltf => {
            let name = target
                .path
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy();
            let options = GlbOptions {
                normals: shading(mesh),
                name: Some(&name),
                extras: Some(origin(plan, provenance)),
                ..GlbOptions::default()
            };
            write_glb(mesh, &options, monitor)
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
            files.extend(library.map(|path| (path, write_mtl(mesh))));
            write_obj(mesh, &options, monitor)
        }
        Format::Stl => write_stl(mesh, &StlOptions::default(), monitor),
        Format::Ply => write_ply(mesh, &PlyOptions::default(), monitor),
    }
    .map_err(failure)?;
    files.push((target.path.clone(), bytes));
    Ok(Encoded { files, warnings })
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

fn failure(error: IoError) -> Failure {
    match error.fault() {
        Some(fault) => Failure {
            message: fault.cause.clone(),
            help: Some(fault.help.clone()),
        },
        None => Failure {
            message: error.to_string(),
            help: None,
        },
    }
}

/// The mesh with its lengths in `units`; `None` if they are metres already.
fn in_units(mesh: &Mesh, units: Units) -> Result<Option<Mesh>, Failure> {
    if units == Units::M {
        return Ok(None);
    }
    let written = |metres: f64| units.from_si(metres, Quantity::Length);
    let positions = mesh.positions().iter();
    let positions = positions
        .map(|p| DVec3::new(written(p.x), written(p.y), written(p.z)))
        .collect();
    let scaled = mesh.with_positions(positions);
    scaled.map(Some).map_err(|error| Failure {
        message: error.to_string(),
        help: None,
    })
}

/// What a file was made from: version, digest of the graph and its inputs, and
/// the parameters as they were in this run.
fn origin(plan: &Plan, provenance: Option<Digest>) -> Json {
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
            "graph_digest": provenance.map(|digest| digest.to_string()),
            "parameters": parameters.collect::<Map<_, _>>(),
        }
    })
}
