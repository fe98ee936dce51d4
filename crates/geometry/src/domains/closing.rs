//! What closing holes and joining borders share: which borders, and what the new
//! faces look like.

use crate::mesh::{Attribute, AttributeValues, Domain, Labels, Material, NO_LABEL};
use crate::subdivide::CREASE;
use crate::topology::BoundaryWalk;
use crate::{Amount, GeometryError, Mesh};

/// For each walk whether `only`, a number or one per vertex or face, is at least
/// 0.5 all along it.
pub(super) fn chosen_walks(
    mesh: &Mesh,
    walks: &[BoundaryWalk],
    only: &Amount,
) -> Result<Vec<bool>, GeometryError> {
    only.check_corners(mesh)?;
    let topology = mesh.topology();
    let faces = topology.adjacency().corner_faces();
    let within = |&corner: &u32| {
        let (corner, vertices) = (corner as usize, topology.corners());
        only.at_corner(faces[corner] as usize, vertices[corner]) >= 0.5
    };
    Ok(walks
        .iter()
        .map(|walk| walk.corners.iter().all(within))
        .collect())
}

/// The mesh with the material of that name on all faces from `first` on; a new
/// one where the mesh has none of the name.
pub(super) fn with_material(
    mesh: Mesh,
    first: usize,
    name: Option<&str>,
) -> Result<Mesh, GeometryError> {
    let Some(name) = name else {
        return Ok(mesh);
    };
    let mut labels = mesh.materials().labels().to_vec();
    let known = labels.iter().position(|material| material.name == name);
    let label = known.unwrap_or_else(|| {
        labels.push(Material::named(name));
        labels.len() - 1
    });
    let mut of_face = mesh.materials().of_face().to_vec();
    of_face.resize(mesh.face_count(), NO_LABEL);
    of_face[first..].fill(label as u32);
    mesh.with_materials(Labels::new(labels, of_face)?)
}

/// The mesh with at least `sharpness` on the edges that leave `corners`.
pub(super) fn with_crease(
    mesh: Mesh,
    corners: impl Iterator<Item = u32>,
    sharpness: f64,
) -> Result<Mesh, GeometryError> {
    if !(sharpness >= 0.0 && sharpness.is_finite()) {
        return Err(GeometryError::OutOfRange {
            what: "the crease",
            value: sharpness,
            requirement: "it must be finite and not negative",
        });
    }
    if sharpness == 0.0 {
        return Ok(mesh);
    }
    let mut values = match mesh
        .attribute(CREASE, Domain::Corner)
        .map(Attribute::values)
    {
        Some(AttributeValues::Number(values)) => values.to_vec(),
        _ => vec![0.0; mesh.corner_count()],
    };
    let adjacency = mesh.topology().adjacency();
    for corner in corners {
        let edge = adjacency.corner_edges()[corner as usize];
        for &side in adjacency.edge_corners(edge as usize) {
            let value: &mut f64 = &mut values[side as usize];
            *value = value.max(sharpness);
        }
    }
    let values = AttributeValues::Number(values.into());
    mesh.with_attribute(Attribute::new(CREASE, Domain::Corner, values))
}
