//! Meshes made from numbers: grids, boxes and surfaces given by a formula.

mod cuboid;
mod grid;
mod surface;

pub use cuboid::{cuboid, cuboid_bytes};
pub use grid::{grid, grid_bytes};
pub use surface::parametric_surface;

use crate::GeometryError;

/// Corner attribute that holds texture coordinates.
pub const UV: &str = "uv";

fn check_size(what: &'static str, size: &[f64]) -> Result<(), GeometryError> {
    let valid = |value: &f64| *value > 0.0 && value.is_finite();
    match size.iter().copied().find(|value| !valid(value)) {
        Some(value) => Err(GeometryError::OutOfRange {
            what,
            value,
            requirement: "it must be above 0 and finite",
        }),
        None => Ok(()),
    }
}

fn check_cells(cells: &[usize], least: usize) -> Result<(), GeometryError> {
    match cells.iter().find(|&&count| count < least) {
        Some(&count) => Err(GeometryError::OutOfRange {
            what: "the number of cells",
            value: count as f64,
            requirement: match least {
                1 => "it must be at least 1",
                _ => "it must be at least 3 where the surface closes",
            },
        }),
        None => Ok(()),
    }
}

/// Bytes of a mesh of quads with texture coordinates at its corners.
fn quad_bytes(vertices: u128, faces: u128) -> u128 {
    // Position; vertex and uv of a corner; offset of a face.
    let face = 4 * (4 + 16) + 4;
    let faces = faces.saturating_mul(face);
    vertices.saturating_mul(24).saturating_add(faces)
}

/// Refuses what 32-bit indices cannot number, before anything is allocated.
fn check_counts(vertices: u128, faces: u128) -> Result<(), GeometryError> {
    let limit = u128::from(u32::MAX - 1);
    let corners = faces.saturating_mul(4);
    for (what, count) in [("vertices", vertices), ("corners", corners)] {
        if count > limit {
            return Err(GeometryError::TooMany { what, count, limit });
        }
    }
    Ok(())
}
