//! New meshes made of elements of an old one, with all that these carry.

use std::sync::Arc;

use glam::DVec3;

use crate::{Domain, GeometryError, Labels, Mesh, Topology};

/// For each element of a new mesh, the element of the old mesh it comes from;
/// `None` where they are the same, so that buffers can be shared.
#[derive(Default)]
pub(crate) struct Sources {
    pub(crate) vertices: Option<Vec<u32>>,
    pub(crate) faces: Option<Vec<u32>>,
    pub(crate) corners: Option<Vec<u32>>,
}

impl Sources {
    fn of(&self, domain: Domain) -> Option<&[u32]> {
        match domain {
            Domain::Vertex => self.vertices.as_deref(),
            Domain::Face => self.faces.as_deref(),
            Domain::Corner => self.corners.as_deref(),
        }
    }
}

/// A mesh of `positions` and `topology` whose elements take their attributes,
/// materials, groups and objects from elements of `mesh`.
///
/// # Errors
/// As [`Mesh::new`].
pub(crate) fn rebuild(
    mesh: &Mesh,
    positions: Vec<DVec3>,
    topology: Topology,
    sources: &Sources,
) -> Result<Mesh, GeometryError> {
    let bare = Mesh::new(positions, Arc::new(topology))?;
    let mut out = with_labels(mesh, bare, sources.faces.as_deref())?;
    for attribute in mesh.attributes() {
        let attribute = match sources.of(attribute.domain()) {
            Some(source) => attribute.with_values(attribute.values().gather(source)),
            None => attribute.clone(),
        };
        out = out.with_attribute(attribute)?;
    }
    Ok(out)
}

/// `out` with the materials, groups and objects of `mesh`'s faces `source`, or
/// of all in order.
pub(crate) fn with_labels(
    mesh: &Mesh,
    out: Mesh,
    source: Option<&[u32]>,
) -> Result<Mesh, GeometryError> {
    fn take<L: Clone>(labels: &Labels<L>, source: Option<&[u32]>) -> Labels<L> {
        source.map_or_else(|| labels.clone(), |source| labels.gather(source))
    }
    out.with_materials(take(mesh.materials(), source))?
        .with_groups(take(mesh.groups(), source))?
        .with_objects(take(mesh.objects(), source))
}

/// Marks a vertex that has no place in the new mesh.
pub(crate) const DROPPED: u32 = u32::MAX;

/// Numbers the elements that are kept, in order: their new indices
/// ([`DROPPED`] for the others), and the old index of each new one.
pub(crate) fn renumber(kept: &[bool]) -> (Vec<u32>, Vec<u32>) {
    let mut old = Vec::new();
    let new = kept
        .iter()
        .zip(0u32..)
        .map(|(&keep, index)| {
            if !keep {
                return DROPPED;
            }
            old.push(index);
            old.len() as u32 - 1
        })
        .collect();
    (new, old)
}

/// The mesh of the given faces of `mesh`, in that order, and of the vertices
/// they use, in their old order.
///
/// # Errors
/// As [`Mesh::new`].
pub(crate) fn keep_faces(mesh: &Mesh, faces: Vec<u32>) -> Result<Mesh, GeometryError> {
    let mut used = vec![false; mesh.vertex_count()];
    let mut corner_source = Vec::new();
    let mut offsets = vec![0];
    for &face in &faces {
        let range = mesh.topology().corner_range(face as usize);
        corner_source.extend(range.start as u32..range.end as u32);
        offsets.push(corner_source.len() as u32);
        for &vertex in mesh.face(face as usize) {
            used[vertex as usize] = true;
        }
    }
    let (new, vertices) = renumber(&used);
    let corners = corner_source
        .iter()
        .map(|&corner| new[mesh.topology().corners()[corner as usize] as usize])
        .collect();
    let positions = vertices
        .iter()
        .map(|&vertex| mesh.positions()[vertex as usize])
        .collect();
    let topology = Topology::new(vertices.len(), offsets, corners)?;
    let sources = Sources {
        vertices: Some(vertices),
        faces: Some(faces),
        corners: Some(corner_source),
    };
    rebuild(mesh, positions, topology, &sources)
}
