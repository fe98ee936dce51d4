//! What the colours of a picture mean.

use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::{Domain, Field, GeometryError, Mesh};
use tessgraph_io::{mesh_colors, place_in_range, viridis};

use crate::legend::Legend;

/// What the colours of a picture mean.
#[derive(Debug, Clone, Copy)]
pub enum Paint<'a> {
    /// The attribute `color` of vertices or faces in linear light, where there is
    /// one, else the base colour of each face's material, else that of plaster.
    Materials,
    /// A field, from dark blue (low) to yellow (high), with a legend.
    Field(FieldPaint<'a>),
}

/// A field as colours.
#[derive(Debug, Clone, Copy)]
pub struct FieldPaint<'a> {
    /// One number per vertex or face.
    pub field: &'a Field,
    /// What the legend says it is.
    pub title: &'a str,
    /// The numbers shown dark blue and yellow; the field's least and greatest
    /// where left out.
    pub range: Option<(f64, f64)>,
    /// What the legend multiplies numbers by, from SI units to those it names.
    pub factor: f64,
}

/// The colour of what has none: warm and light, so that shades show.
const PLASTER: DVec3 = DVec3::new(0.80, 0.755, 0.66);

/// The colours of a mesh in linear light.
pub(crate) struct Colors<'a> {
    of: Of,
    painted: Option<(FieldPaint<'a>, (f64, f64))>,
}

enum Of {
    Everything(DVec3),
    Faces(Vec<DVec3>),
    Vertices(Vec<DVec3>),
    /// Where in the map each vertex is: a colour is looked up after interpolating.
    Along(Vec<f64>),
}

impl<'a> Colors<'a> {
    pub(crate) fn of(mesh: &Mesh, paint: &Paint<'a>) -> Result<Self, GeometryError> {
        match paint {
            Paint::Materials => Ok(Self {
                of: of_materials(mesh),
                painted: None,
            }),
            Paint::Field(painted) => of_field(mesh, painted),
        }
    }

    /// Whether colours change inside a triangle.
    pub(crate) fn vary(&self) -> bool {
        matches!(self.of, Of::Vertices(_) | Of::Along(_))
    }

    /// The colour of a triangle of `face` at barycentric coordinates.
    pub(crate) fn at(&self, face: u32, vertices: [u32; 3], weights: [f64; 3]) -> DVec3 {
        let shares = || vertices.iter().zip(weights);
        match &self.of {
            Of::Everything(color) => *color,
            Of::Faces(colors) => colors[face as usize],
            Of::Vertices(colors) => shares().map(|(&v, share)| colors[v as usize] * share).sum(),
            Of::Along(along) => {
                viridis(shares().map(|(&v, share)| along[v as usize] * share).sum())
            }
        }
    }

    pub(crate) fn legend(&self) -> Option<Legend> {
        self.painted.as_ref().map(|(painted, (low, high))| Legend {
            title: painted.title.to_owned(),
            low: low * painted.factor,
            high: high * painted.factor,
        })
    }
}

fn of_materials(mesh: &Mesh) -> Of {
    match mesh_colors(mesh) {
        Some((Domain::Face, colors)) => return Of::Faces(colors.to_vec()),
        Some((_, colors)) => return Of::Vertices(colors.to_vec()),
        None => {}
    }
    if mesh.materials().is_empty() {
        return Of::Everything(PLASTER);
    }
    let color = |face| {
        let material = mesh.materials().get(face);
        material.map_or(PLASTER, |material| {
            let [red, green, blue, _] = material.base_color.map(f64::from);
            DVec3::new(red, green, blue)
        })
    };
    Of::Faces((0..mesh.face_count()).map(color).collect())
}

fn of_field<'a>(mesh: &Mesh, painted: &FieldPaint<'a>) -> Result<Colors<'a>, GeometryError> {
    let field = painted.field;
    field.check(mesh, field.domain())?;
    let values = field.values();
    let range = painted.range.or_else(|| field.range()).unwrap_or_default();
    let along = |value: &f64| place_in_range(*value, range);
    let of = match field.domain() {
        Domain::Face => Of::Faces(values.iter().map(|value| viridis(along(value))).collect()),
        _ => Of::Along(values.iter().map(along).collect()),
    };
    Ok(Colors {
        of,
        painted: Some((*painted, range)),
    })
}
