//! Polygon meshes in flat, shared arrays.

mod attribute;
mod labels;
mod triangles;

use std::fmt;
use std::sync::Arc;

use glam::DVec3;

pub use attribute::{Attribute, AttributeValues, SEAM};
pub use labels::{Labels, Material, NO_LABEL};
pub use triangles::Triangles;

use crate::buffer::Buffer;
use crate::digest::{Digest, Hasher};
use crate::topology::Topology;
use crate::{GeometryError, parallel};

/// The elements of a mesh that can carry values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Domain {
    /// One value per vertex.
    Vertex,
    /// One value per face.
    Face,
    /// One value per corner, the place where a face meets a vertex. A value per
    /// edge is stored on the corners the edge leaves, both sides agreeing.
    Corner,
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Vertex => "vertex",
            Self::Face => "face",
            Self::Corner => "corner",
        })
    }
}

/// A polygon mesh: positions, faces, attributes, materials and groups.
///
/// Immutable; every change makes a new mesh that shares the buffers it did not
/// touch. Positions are in metres, z is up. Vertices that no face names are
/// kept, because a target surface is matched by index (§3.1).
///
/// ```
/// use tessgraph_geometry::Mesh;
/// let quad = Mesh::from_faces(
///     vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
///     &[&[0, 1, 2, 3]],
/// )?;
/// assert_eq!((quad.vertex_count(), quad.face_count()), (4, 1));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Mesh {
    positions: Buffer<DVec3>,
    topology: Arc<Topology>,
    attributes: Vec<Attribute>,
    materials: Labels<Material>,
    groups: Labels<Vec<String>>,
    objects: Labels<String>,
}

impl Mesh {
    /// A mesh of `positions`, one per vertex of `topology`, without attributes.
    ///
    /// # Errors
    /// [`GeometryError::NonFiniteVertex`], or [`GeometryError::AttributeLength`]
    /// when the counts differ.
    pub fn new(positions: Vec<DVec3>, topology: Arc<Topology>) -> Result<Self, GeometryError> {
        check_positions(&positions, &topology)?;
        Ok(Self::of(positions, topology))
    }

    /// [`Mesh::new`] for positions that are known to be finite: they are not
    /// looked at again.
    ///
    /// # Errors
    /// As [`Mesh::new`] for another count of them.
    pub(crate) fn of_finite(
        positions: Vec<DVec3>,
        topology: Arc<Topology>,
    ) -> Result<Self, GeometryError> {
        check_position_count(&positions, &topology)?;
        debug_assert!(are_finite(&positions), "finite positions");
        Ok(Self::of(positions, topology))
    }

    fn of(positions: Vec<DVec3>, topology: Arc<Topology>) -> Self {
        Self {
            positions: positions.into(),
            topology,
            attributes: Vec::new(),
            materials: Labels::default(),
            groups: Labels::default(),
            objects: Labels::default(),
        }
    }

    /// A mesh from coordinate triples and faces given as lists of vertices.
    ///
    /// # Errors
    /// As [`Mesh::new`] and [`Topology::new`].
    pub fn from_faces<F: AsRef<[u32]>>(
        positions: Vec<[f64; 3]>,
        faces: &[F],
    ) -> Result<Self, GeometryError> {
        let mut offsets = vec![0];
        let mut corners = Vec::new();
        for face in faces {
            corners.extend_from_slice(face.as_ref());
            offsets.push(corners.len() as u32);
        }
        let topology = Topology::new(positions.len(), offsets, corners)?;
        Self::new(
            positions.into_iter().map(DVec3::from).collect(),
            Arc::new(topology),
        )
    }

    /// The same faces, attributes, materials and groups at other positions.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn with_positions(&self, positions: Vec<DVec3>) -> Result<Self, GeometryError> {
        check_positions(&positions, &self.topology)?;
        Ok(Self {
            positions: positions.into(),
            ..self.clone()
        })
    }

    /// The same mesh with the faces of another one, which are the same: so that both
    /// share them, and what is built about them.
    ///
    /// # Errors
    /// [`GeometryError::OtherTopology`] if they are not the same.
    pub fn sharing(&self, topology: &Arc<Topology>) -> Result<Self, GeometryError> {
        self.topology.check_same(topology, "the faces")?;
        Ok(Self {
            topology: Arc::clone(topology),
            ..self.clone()
        })
    }

    /// The same mesh with `attribute` added, replacing one of the same name and
    /// domain in its place.
    ///
    /// # Errors
    /// [`GeometryError::AttributeLength`] or [`GeometryError::NonFiniteValue`].
    pub fn with_attribute(mut self, attribute: Attribute) -> Result<Self, GeometryError> {
        attribute.check(self.element_count(attribute.domain()))?;
        let same = |other: &Attribute| {
            other.name() == attribute.name() && other.domain() == attribute.domain()
        };
        match self.attributes.iter().position(same) {
            Some(place) => self.attributes[place] = attribute,
            None => self.attributes.push(attribute),
        }
        Ok(self)
    }

    /// The same mesh without any attributes.
    pub fn without_attributes(mut self) -> Self {
        self.attributes.clear();
        self
    }

    /// The same mesh with materials, one label per face.
    ///
    /// # Errors
    /// [`GeometryError::AttributeLength`] when there are not as many labels as faces.
    pub fn with_materials(mut self, materials: Labels<Material>) -> Result<Self, GeometryError> {
        materials.check("material", self.face_count())?;
        self.materials = materials;
        Ok(self)
    }

    /// The same mesh with group names, one set of names per face.
    ///
    /// # Errors
    /// [`GeometryError::AttributeLength`] when there are not as many labels as faces.
    pub fn with_groups(mut self, groups: Labels<Vec<String>>) -> Result<Self, GeometryError> {
        groups.check("group", self.face_count())?;
        self.groups = groups;
        Ok(self)
    }

    /// The same mesh with object names, one per face.
    ///
    /// # Errors
    /// [`GeometryError::AttributeLength`] when there are not as many labels as faces.
    pub fn with_objects(mut self, objects: Labels<String>) -> Result<Self, GeometryError> {
        objects.check("object", self.face_count())?;
        self.objects = objects;
        Ok(self)
    }

    /// Position of each vertex in metres.
    pub fn positions(&self) -> &Buffer<DVec3> {
        &self.positions
    }

    /// The faces, shared with every mesh that has the same.
    pub fn topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    /// How many vertices there are, isolated ones included.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// How many faces there are.
    pub fn face_count(&self) -> usize {
        self.topology.face_count()
    }

    /// How many corners all faces have together.
    pub fn corner_count(&self) -> usize {
        self.topology.corner_count()
    }

    /// How many elements a domain has.
    pub fn element_count(&self, domain: Domain) -> usize {
        match domain {
            Domain::Vertex => self.vertex_count(),
            Domain::Face => self.face_count(),
            Domain::Corner => self.corner_count(),
        }
    }

    /// The vertices of `face` in order.
    pub fn face(&self, face: usize) -> &[u32] {
        self.topology.face(face)
    }

    /// All attributes in the order they were added.
    pub fn attributes(&self) -> &[Attribute] {
        &self.attributes
    }

    /// The attribute of that name and domain.
    pub fn attribute(&self, name: &str, domain: Domain) -> Option<&Attribute> {
        self.attributes
            .iter()
            .find(|other| other.name() == name && other.domain() == domain)
    }

    /// The material of each face.
    pub fn materials(&self) -> &Labels<Material> {
        &self.materials
    }

    /// The set of group names of each face.
    pub fn groups(&self) -> &Labels<Vec<String>> {
        &self.groups
    }

    /// The object name of each face.
    pub fn objects(&self) -> &Labels<String> {
        &self.objects
    }

    /// Smallest and largest coordinates of all vertices; `None` without vertices.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let first = *self.positions.first()?;
        Some(
            self.positions
                .iter()
                .fold((first, first), |(low, high), p| (low.min(*p), high.max(*p))),
        )
    }

    /// Length of the bounding box's diagonal in metres; 0 without vertices.
    pub fn diagonal(&self) -> f64 {
        self.bounds()
            .map_or(0.0, |(low, high)| (high - low).length())
    }

    /// Content digest of everything the mesh holds. Cost: O(size) once per buffer.
    pub fn digest(&self) -> Digest {
        let mut hasher = Hasher::new();
        hasher
            .text("mesh")
            .digest(self.positions.digest())
            .digest(self.topology.digest());
        hasher.number(self.attributes.len() as u64);
        for attribute in &self.attributes {
            attribute.feed(&mut hasher);
        }
        self.materials.feed(&mut hasher, Material::feed);
        self.groups.feed(&mut hasher, |names, hasher| {
            hasher.number(names.len() as u64);
            for name in names {
                hasher.text(name);
            }
        });
        self.objects.feed(&mut hasher, |name, hasher| {
            hasher.text(name);
        });
        hasher.finish()
    }

    /// Calls `visit` with the address and size in bytes of every buffer, so
    /// that memory shared between meshes can be counted once.
    pub fn visit_buffers(&self, visit: &mut dyn FnMut(usize, usize)) {
        visit(self.positions.address(), self.positions.byte_size());
        visit(
            self.topology.offsets().address(),
            self.topology.offsets().byte_size(),
        );
        visit(
            self.topology.corners().address(),
            self.topology.corners().byte_size(),
        );
        for attribute in &self.attributes {
            let (address, bytes) = attribute.storage();
            visit(address, bytes);
        }
        for labels in [
            self.materials.of_face(),
            self.groups.of_face(),
            self.objects.of_face(),
        ] {
            visit(labels.address(), labels.byte_size());
        }
    }
}

fn check_position_count(positions: &[DVec3], topology: &Topology) -> Result<(), GeometryError> {
    if positions.len() == topology.vertex_count() {
        return Ok(());
    }
    Err(GeometryError::AttributeLength {
        name: "position".into(),
        domain: Domain::Vertex,
        expected: topology.vertex_count(),
        actual: positions.len(),
    })
}

fn check_positions(positions: &[DVec3], topology: &Topology) -> Result<(), GeometryError> {
    check_position_count(positions, topology)?;
    if parallel::all(positions, |_, positions| are_finite(positions)) {
        return Ok(());
    }
    match positions.iter().position(|position| !position.is_finite()) {
        Some(vertex) => Err(GeometryError::NonFiniteVertex { vertex }),
        None => Ok(()),
    }
}

/// Whether all coordinates are finite. Looks at all of them without an early
/// end, so that it runs at the speed of memory.
#[inline(always)]
pub(crate) fn are_finite(positions: &[DVec3]) -> bool {
    let all = positions.iter().flat_map(|position| position.to_array());
    all.fold(true, |finite, x| finite & x.is_finite())
}
