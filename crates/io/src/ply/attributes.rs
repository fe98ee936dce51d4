//! Properties as attributes.

use glam::{DVec2, DVec3};
use tessgraph_geometry::{Attribute, AttributeValues, Domain, Mesh, glam};

use super::body::{Column, Rows};
use super::header::Type;
use crate::error::{IoError, shorten};

/// Sets of properties that are one attribute.
const SETS: &[(&str, &[&str])] = &[
    ("color", &["red", "green", "blue"]),
    ("color", &["r", "g", "b"]),
    ("color", &["diffuse_red", "diffuse_green", "diffuse_blue"]),
    ("normal", &["nx", "ny", "nz"]),
    ("uv", &["s", "t"]),
    ("uv", &["u", "v"]),
    ("uv", &["texture_u", "texture_v"]),
    ("uv", &["texture_s", "texture_t"]),
];

/// Adds what is left of an element's properties to `mesh`, on `domain`; lists
/// on corners. What does not fit is named in `warnings`.
pub(super) fn add(
    mut mesh: Mesh,
    mut rows: Rows,
    domain: Domain,
    warnings: &mut Vec<String>,
) -> Result<Mesh, IoError> {
    if rows.count != mesh.element_count(domain) {
        return Ok(mesh);
    }
    while let Some((name, parts)) = take_set(&mut rows) {
        let values = vector(parts);
        mesh = put(mesh, name, domain, values, warnings)?;
    }
    for (name, column) in rows.columns {
        match column {
            Column::Scalar { kind, values } => {
                mesh = put(mesh, name, domain, single(kind, values), warnings)?;
            }
            Column::List { kind, ends, values } if domain == Domain::Face => {
                let name = if name == "texcoord" {
                    "uv".to_owned()
                } else {
                    name
                };
                match per_corner(&mesh, kind, &ends, values) {
                    Some(values) => mesh = put(mesh, name, Domain::Corner, values, warnings)?,
                    None => warnings.push(format!(
                        "the list `{}` was passed over: it has not the same one to three numbers for each corner",
                        shorten(&name)
                    )),
                }
            }
            Column::List { .. } => {
                warnings.push(format!(
                    "the vertices' list `{}` was passed over",
                    shorten(&name)
                ));
            }
        }
    }
    Ok(mesh)
}

/// Takes the next properties that belong together, in order of their vector.
fn take_set(rows: &mut Rows) -> Option<(String, Vec<Column>)> {
    let is_scalar = |name: &str| {
        rows.columns
            .iter()
            .any(|(other, column)| other == name && matches!(column, Column::Scalar { .. }))
    };
    let known = SETS
        .iter()
        .find(|(_, parts)| parts.iter().all(|part| is_scalar(part)));
    let (name, parts) = match known {
        Some((name, parts)) => (
            (*name).to_owned(),
            parts.iter().map(|&part| part.to_owned()).collect(),
        ),
        None => rows.columns.iter().find_map(|(name, _)| {
            let stem = name.strip_suffix("_x")?;
            let parts = ["_x", "_y", "_z"].map(|suffix| format!("{stem}{suffix}"));
            let count = parts.iter().take_while(|part| is_scalar(part)).count();
            (count >= 2).then(|| (stem.to_owned(), parts[..count].to_vec()))
        })?,
    };
    let columns = parts.iter().filter_map(|part| rows.take(part)).collect();
    Some((name, columns))
}

/// Two or three columns of equal length as vectors; integers are colours.
fn vector(parts: Vec<Column>) -> AttributeValues {
    let scaled = |column: Column| match column {
        Column::Scalar { kind, mut values } => {
            let full = match kind {
                Type::U8 => 255.0,
                Type::U16 => 65535.0,
                _ => 1.0,
            };
            values.iter_mut().for_each(|value| *value /= full);
            values
        }
        Column::List { .. } => Vec::new(),
    };
    let mut parts = parts.into_iter().map(scaled);
    let (x, y) = (
        parts.next().unwrap_or_default(),
        parts.next().unwrap_or_default(),
    );
    match parts.next() {
        None => AttributeValues::Vector2(
            x.into_iter()
                .zip(y)
                .map(|(x, y)| DVec2::new(x, y))
                .collect(),
        ),
        Some(z) => {
            let rows = x.into_iter().zip(y).zip(z);
            AttributeValues::Vector3(rows.map(|((x, y), z)| DVec3::new(x, y, z)).collect())
        }
    }
}

fn single(kind: Type, values: Vec<f64>) -> AttributeValues {
    if kind.is_float() {
        AttributeValues::Number(values.into())
    } else {
        AttributeValues::Integer(values.into_iter().map(|value| value as i64).collect())
    }
}

/// A list with the same one to three numbers for each corner of its face.
fn per_corner(
    mesh: &Mesh,
    kind: Type,
    ends: &[usize],
    values: Vec<f64>,
) -> Option<AttributeValues> {
    let corners = mesh.corner_count();
    if corners == 0 || !values.len().is_multiple_of(corners) {
        return None;
    }
    let width = values.len() / corners;
    let mut fits = ends.iter().zip(&mesh.topology().offsets()[1..]);
    if !fits.all(|(&end, &offset)| end == width * offset as usize) {
        return None;
    }
    Some(match width {
        1 => single(kind, values),
        2 => AttributeValues::Vector2(
            values
                .as_chunks::<2>()
                .0
                .iter()
                .map(|&uv| uv.into())
                .collect(),
        ),
        3 => AttributeValues::Vector3(
            values
                .as_chunks::<3>()
                .0
                .iter()
                .map(|&xyz| xyz.into())
                .collect(),
        ),
        _ => return None,
    })
}

/// Adds an attribute, or names it in `warnings` if it is not finite. A `uv` on
/// vertices goes on their corners, where all of the library looks for it.
fn put(
    mesh: Mesh,
    name: String,
    domain: Domain,
    values: AttributeValues,
    warnings: &mut Vec<String>,
) -> Result<Mesh, IoError> {
    let finite = match &values {
        AttributeValues::Integer(_) => true,
        AttributeValues::Number(values) => values.iter().all(|value| value.is_finite()),
        AttributeValues::Vector2(values) => values.iter().all(|value| value.is_finite()),
        AttributeValues::Vector3(values) => values.iter().all(|value| value.is_finite()),
    };
    if !finite {
        let name = shorten(&name);
        warnings.push(format!(
            "the values `{name}` are not all finite and were left out"
        ));
        return Ok(mesh);
    }
    let is_uv = name == "uv" && matches!(values, AttributeValues::Vector2(_));
    let attribute = if is_uv && domain == Domain::Vertex {
        Attribute::new(
            name,
            Domain::Corner,
            values.gather(mesh.topology().corners()),
        )
    } else {
        Attribute::new(name, domain, values)
    };
    Ok(mesh.with_attribute(attribute)?)
}
