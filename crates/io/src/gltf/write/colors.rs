//! Vertex colours as they are stored.

use glam::DVec3;
use serde_json::{Value, json};
use tessgraph_geometry::{Domain, Field, GeometryError, Mesh, glam};

use super::GlbColors;
use crate::error::IoError;
use crate::gltf::{mesh_colors, place_in_range, viridis};

/// A stored colour: linear red, green, blue and opacity.
pub(super) type Color = [u16; 4];

/// Colours by element.
#[derive(Default)]
pub(super) enum Of {
    #[default]
    Nothing,
    Vertices(Vec<Color>),
    Faces(Vec<Color>),
}

/// Colours, and what the file says about them.
#[derive(Default)]
pub(super) struct Colors {
    pub(super) of: Of,
    pub(super) extras: Option<Value>,
}

/// Colours of `mesh` by the rule of `colors`.
///
/// # Errors
/// When there are not as many as the mesh has elements.
pub(super) fn resolve(mesh: &Mesh, colors: &GlbColors<'_>) -> Result<Colors, IoError> {
    let of = match *colors {
        GlbColors::None => Of::Nothing,
        GlbColors::Attribute => match mesh_colors(mesh) {
            Some((Domain::Face, colors)) => Of::Faces(store(colors)),
            Some((_, colors)) => Of::Vertices(store(colors)),
            None => Of::Nothing,
        },
        GlbColors::Vertices(colors) => {
            check_count(mesh, Domain::Vertex, colors)?;
            Of::Vertices(store(colors))
        }
        GlbColors::Faces(colors) => {
            check_count(mesh, Domain::Face, colors)?;
            Of::Faces(store(colors))
        }
        GlbColors::Field { field, name, range } => return of_field(mesh, field, name, range),
    };
    Ok(Colors { of, extras: None })
}

fn check_count(mesh: &Mesh, domain: Domain, colors: &[DVec3]) -> Result<(), IoError> {
    let (expected, actual) = (mesh.element_count(domain), colors.len());
    if expected == actual {
        return Ok(());
    }
    let name = "color".to_owned();
    Err(GeometryError::AttributeLength {
        name,
        domain,
        expected,
        actual,
    }
    .into())
}

fn of_field(
    mesh: &Mesh,
    field: &Field,
    name: &str,
    range: Option<(f64, f64)>,
) -> Result<Colors, IoError> {
    field.check(mesh, field.domain())?;
    let range = range.or_else(|| field.range()).unwrap_or_default();
    let color = |&value: &f64| stored(viridis(place_in_range(value, range)));
    let colors = field.values().iter().map(color).collect();
    let extras = (!field.values().is_empty()).then(|| {
        json!({
            "field": {
                "name": name,
                "quantity": field.quantity().to_string(),
                "range": [range.0, range.1],
                "colormap": "viridis",
            }
        })
    });
    let of = if field.domain() == Domain::Face {
        Of::Faces(colors)
    } else {
        Of::Vertices(colors)
    };
    Ok(Colors { of, extras })
}

fn store(colors: &[DVec3]) -> Vec<Color> {
    colors.iter().map(|&color| stored(color)).collect()
}

fn stored(color: DVec3) -> Color {
    let part = |value: f64| (value.clamp(0.0, 1.0) * 65535.0).round() as u16;
    [part(color.x), part(color.y), part(color.z), u16::MAX]
}
