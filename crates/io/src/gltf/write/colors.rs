//! Vertex colours as they are stored.

use glam::DVec3;
use serde_json::{Value, json};
use tessgraph_geometry::{AttributeValues, Domain, Field, GeometryError, Mesh, glam};

use super::GlbColors;
use crate::error::IoError;
use crate::gltf::viridis;

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
        GlbColors::Attribute => {
            let on = |domain| mesh.attribute("color", domain).map(|color| color.values());
            match (on(Domain::Vertex), on(Domain::Face)) {
                (Some(AttributeValues::Vector3(colors)), _) => Of::Vertices(store(colors)),
                (_, Some(AttributeValues::Vector3(colors))) => Of::Faces(store(colors)),
                _ => Of::Nothing,
            }
        }
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
    let spread = || {
        let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
        field
            .values()
            .iter()
            .fold((low, high), |(low, high), &value| {
                (low.min(value), high.max(value))
            })
    };
    let (low, high) = range.unwrap_or_else(spread);
    // Halved, so that the difference of huge numbers stays finite. A field
    // without spread takes the middle colour.
    let along = |value: f64| match high * 0.5 - low * 0.5 {
        half if half > 0.0 => (value * 0.5 - low * 0.5) / half,
        _ => 0.5,
    };
    let colors = field
        .values()
        .iter()
        .map(|&value| stored(viridis(along(value))))
        .collect();
    let extras = (!field.values().is_empty()).then(|| {
        json!({
            "field": {
                "name": name,
                "quantity": field.quantity().to_string(),
                "range": [low, high],
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
