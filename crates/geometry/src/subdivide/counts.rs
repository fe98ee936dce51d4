//! How large a subdivided mesh will be, before anything is allocated.

use crate::GeometryError;
use crate::mesh::{AttributeValues, Domain, Mesh};
use crate::topology::Topology;

/// Elements of a subdivided mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Vertices, isolated ones included.
    pub vertices: u128,
    /// Edges.
    pub edges: u128,
    /// Faces.
    pub faces: u128,
    /// Corners of all faces.
    pub corners: u128,
    /// Bytes of the mesh with its attributes, the parents' included.
    pub bytes: u128,
}

/// The most vertices or corners a mesh can number.
const LIMIT: u128 = (u32::MAX - 1) as u128;

/// Elements `mesh` would have after `levels` refinements, by formula.
///
/// With V, E, F, C vertices, edges, faces and corners of the mesh and
/// h = 2^(levels - 1), there are C·h² faces and
/// V + E + F + (2E + C)(h - 1) + C(h - 1)² vertices. Cost: that of the mesh's
/// adjacency; nothing of the result's size is allocated.
///
/// # Errors
/// [`GeometryError::TooMany`] when 32-bit indices cannot number them.
///
/// ```
/// use tessgraph_geometry::{primitives, subdivide};
/// let cube = primitives::cuboid(tessgraph_geometry::glam::DVec3::ONE, [1, 1, 1], true)?;
/// assert_eq!(subdivide::subdivided_counts(&cube, 3)?.vertices, 386);
/// assert!(subdivide::subdivided_counts(&cube, 15).is_err());
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn subdivided_counts(mesh: &Mesh, levels: u32) -> Result<Counts, GeometryError> {
    let mut counts = count(mesh.topology(), levels);
    counts.bytes = bytes(mesh, &counts);
    for (what, count) in [("vertices", counts.vertices), ("corners", counts.corners)] {
        if count > LIMIT {
            let limit = LIMIT;
            return Err(GeometryError::TooMany { what, count, limit });
        }
    }
    Ok(counts)
}

fn count(topology: &Topology, levels: u32) -> Counts {
    let edges = topology.adjacency().edge_count() as u128;
    let (vertices, faces, corners) = (
        topology.vertex_count() as u128,
        topology.face_count() as u128,
        topology.corner_count() as u128,
    );
    if levels == 0 {
        return Counts {
            vertices,
            edges,
            faces,
            corners,
            bytes: 0,
        };
    }
    // Beyond 40 levels the exact number no longer matters and must not overflow.
    let h = 1u128 << (levels - 1).min(40);
    let spokes = 2 * edges + corners;
    let fine = corners * h * h;
    Counts {
        vertices: vertices + edges + faces + spokes * (h - 1) + corners * (h - 1) * (h - 1),
        edges: spokes * h + 2 * corners * h * (h - 1),
        faces: fine,
        corners: 4 * fine,
        bytes: 0,
    }
}

fn bytes(mesh: &Mesh, counts: &Counts) -> u128 {
    // Position; vertex of a corner; row offset and parent of a face.
    let (mut vertex, mut corner, mut face) = (24, 4, 4 + 8);
    for attribute in mesh.attributes() {
        let size = match attribute.values() {
            AttributeValues::Integer(_) | AttributeValues::Number(_) => 8,
            AttributeValues::Vector2(_) => 16,
            AttributeValues::Vector3(_) => 24,
        };
        match attribute.domain() {
            Domain::Vertex => vertex += size,
            Domain::Corner => corner += size,
            Domain::Face => face += size,
        }
    }
    let labels = [
        mesh.materials().is_empty(),
        mesh.groups().is_empty(),
        mesh.objects().is_empty(),
    ];
    face += 4 * labels.iter().filter(|&&empty| !empty).count() as u128;
    counts.vertices * vertex + counts.corners * corner + counts.faces * face
}
