//! Directions along which components are displaced (§3.1, §3.2).

mod change;
mod make;

use std::sync::Arc;

use glam::DVec3;

pub use change::{blend_directions, scale_directions};
pub use make::{constant_direction, directions_from_attribute, face_normal_directions};

use crate::buffer::Buffer;
use crate::digest::{Digest, Hasher};
use crate::topology::Topology;
use crate::{GeometryError, Mesh};

/// Where directions come from, which decides how heights are scaled along them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DirectionSource {
    /// From the surface itself (normals, smoothed or not): heights may be scaled
    /// by cell size.
    Surface,
    /// From a target surface: the target sets the size, nothing else scales it.
    Target,
}

/// Displacement per unit of signed height, one pair of vectors per vertex.
///
/// A component point at height w sits at `P + w * outward` when w >= 0 and at
/// `P + w * inward` when w < 0; the two differ once thickness has been
/// compensated on each side apart (§3.2). Directions belong to the topology
/// they were made for.
#[derive(Debug, Clone)]
pub struct Directions {
    topology: Arc<Topology>,
    outward: Buffer<DVec3>,
    inward: Buffer<DVec3>,
    source: DirectionSource,
    compensated: bool,
}

impl Directions {
    /// Directions with equal vectors on both sides, one per vertex of `mesh`.
    ///
    /// # Errors
    /// [`GeometryError::NonFiniteValue`] or a length that is not the vertex count.
    pub fn new(
        mesh: &Mesh,
        vectors: Vec<DVec3>,
        source: DirectionSource,
    ) -> Result<Self, GeometryError> {
        check_vectors(mesh.topology(), &vectors)?;
        let outward = Buffer::from(vectors);
        let topology = Arc::clone(mesh.topology());
        Ok(Self {
            topology,
            inward: outward.clone(),
            outward,
            source,
            compensated: false,
        })
    }

    /// Compensated directions: `outward` for heights >= 0, `inward` below,
    /// both of one vector per vertex (§3.2).
    ///
    /// # Errors
    /// As [`Directions::new`].
    pub fn compensated(
        &self,
        outward: Vec<DVec3>,
        inward: Vec<DVec3>,
    ) -> Result<Self, GeometryError> {
        check_vectors(&self.topology, &outward)?;
        check_vectors(&self.topology, &inward)?;
        Ok(Self {
            topology: Arc::clone(&self.topology),
            outward: outward.into(),
            inward: inward.into(),
            source: self.source,
            compensated: true,
        })
    }

    /// Directions from what their getters gave earlier; without `inward` both
    /// sides share one buffer.
    ///
    /// # Errors
    /// As [`Directions::new`].
    pub fn from_parts(
        topology: Arc<Topology>,
        outward: Vec<DVec3>,
        inward: Option<Vec<DVec3>>,
        source: DirectionSource,
        compensated: bool,
    ) -> Result<Self, GeometryError> {
        check_vectors(&topology, &outward)?;
        if let Some(inward) = &inward {
            check_vectors(&topology, inward)?;
        }
        let outward = Buffer::from(outward);
        Ok(Self {
            topology,
            inward: inward.map_or_else(|| outward.clone(), Buffer::from),
            outward,
            source,
            compensated,
        })
    }

    /// The faces and vertices these directions were made for.
    pub fn topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    /// Displacement per unit of height above the surface, one per vertex.
    pub fn outward(&self) -> &Buffer<DVec3> {
        &self.outward
    }

    /// Displacement per unit of height below the surface, one per vertex.
    pub fn inward(&self) -> &Buffer<DVec3> {
        &self.inward
    }

    /// The vectors for the side of a signed height.
    pub fn side(&self, height: f64) -> &Buffer<DVec3> {
        if height < 0.0 {
            &self.inward
        } else {
            &self.outward
        }
    }

    /// Where they come from.
    pub fn source(&self) -> DirectionSource {
        self.source
    }

    /// Whether a thickness compensation is already in their lengths.
    pub fn is_compensated(&self) -> bool {
        self.compensated
    }

    /// Whether both sides use the same vectors.
    pub fn is_symmetric(&self) -> bool {
        self.outward == self.inward
    }

    /// Checks that these directions were made for the faces of `mesh`.
    ///
    /// # Errors
    /// [`GeometryError::OtherTopology`] with the counts of both.
    pub fn check(&self, mesh: &Mesh) -> Result<(), GeometryError> {
        mesh.topology().check_same(&self.topology, "the directions")
    }

    /// Content digest: topology, vectors of both sides, source and flag.
    pub fn digest(&self) -> Digest {
        Hasher::new()
            .text("directions")
            .digest(self.topology.digest())
            .digest(self.outward.digest())
            .digest(self.inward.digest())
            .number(self.source as u64)
            .number(u64::from(self.compensated))
            .finish()
    }
}

fn check_vectors(topology: &Topology, vectors: &[DVec3]) -> Result<(), GeometryError> {
    let domain = crate::mesh::Domain::Vertex;
    let expected = topology.vertex_count();
    if vectors.len() != expected {
        return Err(GeometryError::FieldLength {
            domain,
            expected,
            actual: vectors.len(),
        });
    }
    match vectors.iter().position(|vector| !vector.is_finite()) {
        Some(index) => Err(GeometryError::NonFiniteValue {
            what: "the direction",
            domain,
            index,
        }),
        None => Ok(()),
    }
}
