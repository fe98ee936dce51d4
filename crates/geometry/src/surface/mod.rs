//! A mesh as a surface: closest places and ray hits, by a tree of boxes.

mod boxes;
mod build;
mod closest;
mod follow;
mod leaf;
mod node;
mod order;
mod ray;
mod rim;
#[cfg(test)]
mod tests;
mod triangle;
mod turned;

use std::sync::{Arc, OnceLock};

use glam::DVec3;

pub(crate) use boxes::{BoxTree, overlap};
pub(crate) use closest::ANYWHERE;
pub use closest::{Closest, Feature};
pub use follow::Followed;
pub use ray::{Facing, Hit};
pub use rim::Border;
pub(crate) use rim::{Measured, Piece};

use crate::buffer::Buffer;
use crate::topology::{NO_EDGE, Topology};
use crate::{GeometryError, Mesh, Monitor};
use leaf::Leaf;
pub(crate) use leaf::{Lanes, WIDTH};
use node::Node;
use rim::Rim;
use triangle::Triangle;
use turned::Turned;

/// The triangles of a mesh, sorted so that the closest is found fast.
///
/// The surface is that of [`Mesh::triangles`]. The tree is a bounding volume
/// hierarchy with four children a node and four triangles a leaf; its shape
/// depends on the mesh alone, and so does every answer: of equally close
/// triangles the one with the lowest number counts. Takes about 250 bytes a
/// triangle.
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored, glam::DVec3, surface::Surface};
/// let square = Mesh::from_faces(
///     vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
///     &[[0, 1, 2, 3]],
/// )?;
/// let surface = Surface::new(&square, &Unmonitored)?;
/// let closest = surface.closest(DVec3::new(0.5, 0.25, 3.0));
/// assert_eq!(closest.distance, 3.0);
/// assert_eq!(closest.point, DVec3::new(0.5, 0.25, 0.0));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
#[derive(Debug)]
pub struct Surface {
    topology: Arc<Topology>,
    positions: Buffer<DVec3>,
    /// Corner numbers of each triangle.
    corners: Vec<[u32; 3]>,
    /// The face of each triangle.
    faces: Vec<u32>,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    turned: Vec<Turned>,
    root: u32,
    /// The largest magnitude of a coordinate.
    largest: f64,
    rim: OnceLock<Rim>,
}

/// Coordinates whose distances can still be squared.
const LARGEST: f64 = 1e150;

impl Surface {
    /// Sorts the triangles of `mesh` into a tree.
    ///
    /// Cost: O(triangles · log triangles), about 0.3 s a million on two cores.
    ///
    /// # Errors
    /// [`GeometryError::Empty`] for a mesh without faces,
    /// [`GeometryError::OutOfRange`] for coordinates above 1e150,
    /// [`GeometryError::TooMany`] above 2³¹ triangles, [`GeometryError::Cancelled`].
    pub fn new(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Self, GeometryError> {
        let largest = |largest: f64, place: &DVec3| largest.max(place.abs().max_element());
        let largest = mesh.positions().iter().fold(0.0, largest);
        if largest > LARGEST {
            return Err(GeometryError::OutOfRange {
                what: "the largest coordinate of the surface",
                value: largest,
                requirement: "squares of distances need it below 1e150",
            });
        }
        // Asked for by closest places, which are found inside loops.
        mesh.topology().adjacency_with(monitor)?;
        let triangles = mesh.triangles_with(monitor)?;
        let count = triangles.corners.len();
        if count == 0 {
            return Err(GeometryError::Empty {
                what: "the surface",
                missing: "faces",
            });
        }
        if count >= node::LEAF as usize {
            return Err(GeometryError::TooMany {
                what: "triangles of a surface",
                count: count as u128,
                limit: u128::from(node::LEAF - 1),
            });
        }
        let mut surface = Self {
            topology: Arc::clone(mesh.topology()),
            positions: mesh.positions().clone(),
            corners: triangles.corners,
            faces: triangles.faces,
            nodes: Vec::new(),
            leaves: Vec::new(),
            turned: Vec::new(),
            root: 0,
            largest,
            rim: OnceLock::new(),
        };
        let tree = build::build(count, |k| surface.triangle(k), monitor)?;
        surface.nodes = tree.nodes;
        surface.leaves = tree.leaves;
        surface.turned = tree.turned;
        surface.root = tree.root;
        Ok(surface)
    }

    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.corners.len()
    }

    /// The faces of the mesh the surface was made of.
    pub fn topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    /// Position of each vertex of that mesh.
    pub fn positions(&self) -> &Buffer<DVec3> {
        &self.positions
    }

    /// The largest magnitude of a coordinate: the scale of rounding.
    pub(crate) fn largest_coordinate(&self) -> f64 {
        self.largest
    }

    /// The three vertices of a triangle.
    ///
    /// # Panics
    /// If there is no such triangle.
    pub fn triangle_vertices(&self, triangle: u32) -> [u32; 3] {
        self.corners[triangle as usize].map(|corner| self.topology.corners()[corner as usize])
    }

    /// The triangles of a face, as a range of their numbers.
    ///
    /// # Panics
    /// If there is no such face.
    pub fn face_triangles(&self, face: u32) -> std::ops::Range<u32> {
        let start = self.faces.partition_point(|&of| of < face);
        let count = self.topology.face(face as usize).len() - 2;
        start as u32..(start + count) as u32
    }

    /// Whether a feature lies on the border: an edge with one face, or an end of one.
    pub fn is_border(&self, feature: Feature) -> bool {
        let adjacency = self.topology.adjacency();
        match feature {
            Feature::Face => false,
            Feature::Edge(edge) => adjacency.is_boundary_edge(edge as usize),
            Feature::Vertex(vertex) => adjacency.is_boundary_vertex(vertex as usize),
        }
    }

    pub(crate) fn triangle(&self, triangle: u32) -> Triangle {
        let vertices = self.triangle_vertices(triangle);
        Triangle(vertices.map(|vertex| self.positions[vertex as usize]))
    }

    /// The mesh edge between corners `i` and `j` (0..3) of a triangle; `None`
    /// for a diagonal inside the polygon.
    fn edge_between(&self, triangle: u32, i: usize, j: usize) -> Option<u32> {
        let corners = self.corners[triangle as usize];
        let (a, b) = (corners[i], corners[j]);
        let range = self
            .topology
            .corner_range(self.faces[triangle as usize] as usize);
        let follows = |a: u32, b: u32| {
            let next = a as usize + 1;
            b as usize == if next == range.end { range.start } else { next }
        };
        let leaving = if follows(a, b) {
            a
        } else if follows(b, a) {
            b
        } else {
            return None;
        };
        let edge = self.topology.adjacency().corner_edges()[leaving as usize];
        (edge != NO_EDGE).then_some(edge)
    }
}
