//! PLY (Stanford): polygons with any properties, binary or ASCII.
//!
//! | in the file | in the mesh |
//! |---|---|
//! | `x y z` of a vertex | its position |
//! | `vertex_indices` of a face | its corners |
//! | `red green blue` | attribute `color`; bytes are divided by 255 |
//! | `nx ny nz` | attribute `normal` |
//! | `s t`, `u v`, `texture_u texture_v` of a vertex; `texcoord` of a face | corner attribute `uv` |
//! | `name_x name_y [name_z]` | attribute `name`, a vector |
//! | other numbers | attribute of that name |
//! | other lists of a face, one to three numbers per corner | corner attribute |

mod attributes;
mod body;
mod header;
mod write;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::{Domain, Mesh, Monitor, Topology, glam};

use crate::error::{FaultKind, IoError, Place};
use crate::{Format, Loaded, sniff};
use body::{Column, Rows, Source};
use header::Header;

pub use write::{PlyOptions, write_ply, write_ply_to};

const EXPORT: &str = "export it again";

/// Reads a PLY file.
///
/// # Errors
/// As [`crate::read()`].
pub(crate) fn read(bytes: &[u8], monitor: &dyn Monitor) -> Result<Loaded, IoError> {
    let is_ply = bytes.starts_with(b"ply") && matches!(bytes.get(3), Some(b'\n' | b'\r' | b' '));
    if !is_ply {
        return Err(sniff::wrong_content(Format::Ply, bytes));
    }
    let header = Header::parse(bytes)?;
    let mut warnings = Vec::new();
    let vertex_count = header.count("vertex");
    let (mut vertices, mut faces) = (Rows::default(), Rows::default());
    let mut source = Source::new(bytes, &header);
    for element in &header.elements {
        let rows = source.rows(element, vertex_count, monitor)?;
        match element.name.as_str() {
            "vertex" => vertices = rows,
            "face" => faces = rows,
            name => warnings.push(format!(
                "{} elements `{}` were passed over",
                element.count,
                crate::error::shorten(name)
            )),
        }
    }
    let mut mesh = Mesh::new(
        positions(&mut vertices)?,
        Arc::new(topology(&mut faces, vertex_count)?),
    )?;
    mesh = attributes::add(mesh, vertices, Domain::Vertex, &mut warnings)?;
    mesh = attributes::add(mesh, faces, Domain::Face, &mut warnings)?;
    if mesh.face_count() == 0 {
        warnings.push("the file has no faces".to_owned());
    }
    Ok(Loaded {
        mesh,
        warnings,
        boundary: None,
    })
}

fn lacks(what: &str) -> IoError {
    let cause = format!("the header lacks {what}");
    IoError::new(
        FaultKind::Syntax,
        Place::Line { line: 1, column: 1 },
        cause,
        EXPORT,
    )
}

fn positions(vertices: &mut Rows) -> Result<Vec<DVec3>, IoError> {
    let mut coordinate = |name: &str| match vertices.take(name) {
        Some(Column::Scalar { values, .. }) => Ok(values),
        _ => Err(lacks(&format!("the vertex property `{name}`"))),
    };
    let (x, y, z) = (coordinate("x")?, coordinate("y")?, coordinate("z")?);
    let rows = x.into_iter().zip(y).zip(z);
    Ok(rows.map(|((x, y), z)| DVec3::new(x, y, z)).collect())
}

/// Faces out of the list of vertex indices, whose values have been checked.
fn topology(faces: &mut Rows, vertex_count: u64) -> Result<Topology, IoError> {
    let vertex_count = usize::try_from(vertex_count).unwrap_or(usize::MAX);
    let list = header::INDEX_NAMES.iter().find_map(|name| faces.take(name));
    let (ends, values) = match list {
        Some(Column::List { ends, values, .. }) => (ends, values),
        _ if faces.count == 0 => (Vec::new(), Vec::new()),
        _ => return Err(lacks("the face property list `vertex_indices`")),
    };
    if values.len() > u32::MAX as usize - 1 {
        let cause = "the faces have more than 4294967294 corners";
        return Err(IoError::new(
            FaultKind::TooLarge,
            Place::File,
            cause,
            "split the file",
        ));
    }
    let offsets = std::iter::once(0)
        .chain(ends.into_iter().map(|end| end as u32))
        .collect();
    let corners = values.into_iter().map(|value| value as u32).collect();
    Ok(Topology::new(vertex_count, offsets, corners)?)
}
