//! From values to the bytes of files.

use std::path::PathBuf;

use serde_json::{Map, Value as Json, json};
use tessgraph_geometry::digest::{Digest, Hasher};
use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::{Attribute, AttributeValues, Domain, Mesh, Quantity};
use tessgraph_graph::{Plan, Units, Value};
use tessgraph_io::{
    Format, GlbNormals, GlbOptions, IoError, ObjOptions, PlyOptions, StlOptions, Written,
    write_glb, write_mtl, write_obj, write_ply, write_png, write_stl,
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

/// The bytes of an output. OBJ, STL and PLY carry no unit and are written in
/// the graph's; glTF is in metres, and remembers what it was made from.
pub(super) fn encode(
    plan: &Plan,
    target: &Target,
    value: &Value,
    provenance: Digest,
) -> Result<Encoded, Failure> {
    let quantity = plan.result_spec(target.result).quantity;
    let text = match (target.format, value) {
        (FileFormat::Mesh(format), Value::Mesh(mesh)) => {
            return encode_mesh(plan, target, format, mesh, provenance);
        }
        (FileFormat::Png, Value::Mesh(mesh)) => return encode_picture(target, mesh),
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
fn encode_picture(target: &Target, mesh: &Mesh) -> Result<Encoded, Failure> {
    let picture = draw(mesh, &DrawOptions::default(), &UntilInterrupt);
    let picture = picture.map_err(|error| Failure {
        message: error.to_string(),
        help: None,
    })?;
    let bytes = write_png(picture.size(), picture.pixels());
    Ok(Encoded {
        files: vec![(target.path.clone(), bytes)],
        warnings: Vec::new(),
    })
}

fn encode_mesh(
    plan: &Plan,
    target: &Target,
    format: Format,
    mesh: &Mesh,
    provenance: Digest,
) -> Result<Encoded, Failure> {
    let scaled = if format.is_metric() {
        None
    } else {
        in_units(mesh, plan.units)?
    };
    let mesh = scaled.as_ref().unwrap_or(mesh);
    let monitor = &UntilInterrupt;
    let mut files = Vec::new();
    let Written {
        bytes,
        mut warnings,
    } = match format {
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
            let materials = |path| (path, [LIBRARY_MARK, &write_mtl(mesh)].concat());
            files.extend(library.map(materials));
            write_obj(mesh, &options, monitor)
        }
        Format::Stl => write_stl(mesh, &StlOptions::default(), monitor),
        Format::Ply => write_ply(mesh, &PlyOptions::default(), monitor),
    }
    .map_err(failure)?;
    files.push((target.path.clone(), bytes));
    if mesh.vertex_count() == 0 {
        warnings.push("the mesh is empty: it has no vertices and no faces".to_owned());
    }
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
