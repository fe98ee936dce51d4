//! Attributes and labels of the subdivided mesh.

use crate::mesh::{Attribute, AttributeValues, Domain, Mesh};
use crate::{GeometryError, Monitor};

use super::Scheme;
use super::corners;
use super::faces::Blocks;
use super::refiner::Refiner;
use super::sharpness::{CORNER_SHARPNESS, CREASE, decayed_attribute};
use crate::mesh::SEAM;

/// Gives `fine` everything `coarse` carries: vertex attributes by the masks of
/// positions, corner attributes bilinear, face attributes and labels from the
/// parent. Sharpness is what is left of it, so that subdividing can go on.
pub(super) fn inherit(
    coarse: &Mesh,
    fine: Mesh,
    refiner: &Refiner,
    blocks: &Blocks<'_>,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    let parents: Vec<u32> = if has_face_values(coarse) {
        blocks.parents(monitor)?
    } else {
        Vec::new()
    };
    let mut fine = fine
        .with_materials(coarse.materials().gather(&parents))?
        .with_groups(coarse.groups().gather(&parents))?
        .with_objects(coarse.objects().gather(&parents))?;
    for attribute in coarse.attributes() {
        let values = match (attribute.domain(), attribute.name()) {
            (Domain::Face, _) => attribute.values().gather(&parents),
            (Domain::Vertex, CORNER_SHARPNESS) => left_at_vertices(attribute, refiner, &fine),
            (Domain::Vertex, _) => at_vertices(attribute.values(), refiner, monitor)?,
            (Domain::Corner, CREASE) => {
                let level = consumed_levels(refiner);
                left_on_edges(attribute, level, blocks, monitor)?
            }
            // Nothing uses a seam up.
            (Domain::Corner, SEAM) => left_on_edges(attribute, 0, blocks, monitor)?,
            (Domain::Corner, _) if corners::are_smooth(attribute, refiner.options) => {
                corners::smooth(coarse, attribute, refiner.options, monitor)?
            }
            (Domain::Corner, _) => blocks.corner_values(attribute.values(), monitor)?,
        };
        fine = fine.with_attribute(attribute.with_values(values))?;
    }
    Ok(fine)
}

/// Whether fine faces have anything to take from their parents.
fn has_face_values(mesh: &Mesh) -> bool {
    let on_faces = |attribute: &Attribute| attribute.domain() == Domain::Face;
    mesh.attributes().iter().any(on_faces)
        || !mesh.materials().is_empty()
        || !mesh.groups().is_empty()
        || !mesh.objects().is_empty()
}

/// Bilinear refinement uses no sharpness, so none is used up.
fn consumed_levels(refiner: &Refiner) -> u32 {
    match refiner.options.scheme {
        Scheme::CatmullClark => refiner.options.levels,
        Scheme::Bilinear => 0,
    }
}

/// Vertex values of the refined mesh, by the same masks as its positions; whole
/// numbers are those of the nearest coarse vertex.
pub(super) fn at_vertices(
    values: &AttributeValues,
    refiner: &Refiner,
    monitor: &dyn Monitor,
) -> Result<AttributeValues, GeometryError> {
    Ok(match values {
        AttributeValues::Integer(_) => values.gather(&refiner.nearest_vertices(monitor)?),
        AttributeValues::Number(values) => {
            AttributeValues::Number(refiner.run(values, monitor)?.into())
        }
        AttributeValues::Vector2(values) => {
            AttributeValues::Vector2(refiner.run(values, monitor)?.into())
        }
        AttributeValues::Vector3(values) => {
            AttributeValues::Vector3(refiner.run(values, monitor)?.into())
        }
    })
}

/// Sharpness stays on the parts of coarse edges; any other type of value than a
/// number is no sharpness.
fn left_on_edges(
    attribute: &Attribute,
    level: u32,
    blocks: &Blocks<'_>,
    monitor: &dyn Monitor,
) -> Result<AttributeValues, GeometryError> {
    let left = match attribute.values() {
        AttributeValues::Number(values) => {
            blocks.edge_sharpness(&|corner| values[corner], level, monitor)?
        }
        AttributeValues::Integer(values) => {
            blocks.edge_sharpness(&|corner| values[corner] as f64, level, monitor)?
        }
        other => return blocks.corner_values(other, monitor),
    };
    Ok(AttributeValues::Number(left.into()))
}

/// Sharpness stays with the coarse vertices, which come first in the fine mesh.
fn left_at_vertices(attribute: &Attribute, refiner: &Refiner, fine: &Mesh) -> AttributeValues {
    let level = consumed_levels(refiner);
    let numbers = attribute.values().numbers();
    let mut left = numbers.unwrap_or_else(|| vec![0.0; attribute.values().len()]);
    for sharpness in &mut left {
        *sharpness = decayed_attribute(*sharpness, level);
    }
    left.resize(fine.vertex_count(), 0.0);
    AttributeValues::Number(left.into())
}
