//! Edges and one-rings, in compressed rows.

use bytemuck::Zeroable;

use super::Topology;
use crate::parallel::{in_order, zeroed};
use crate::{GeometryError, Monitor};

/// Marks a corner whose outgoing edge joins a vertex to itself.
pub const NO_EDGE: u32 = u32::MAX;

/// Edges of a topology and what is incident to edges and vertices.
///
/// Edges are numbered by the first corner they leave, in corner order, so that
/// the numbering depends on the order of faces only.
#[derive(Debug)]
pub struct Adjacency {
    edges: Vec<[u32; 2]>,
    corner_edge: Vec<u32>,
    corner_face: Vec<u32>,
    edge_corners: Rows,
    vertex_corners: Rows,
    vertex_edges: Rows,
}

/// Lists of unequal length, one after the other.
#[derive(Debug, Default)]
struct Rows<T = u32> {
    offsets: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy + Zeroable> Rows<T> {
    /// Sorts items into rows, stable in the order of `places` that `pair` gives
    /// a (row, item) for.
    fn gather(
        count: usize,
        places: usize,
        monitor: &dyn Monitor,
        pair: impl Fn(usize) -> Option<(u32, T)>,
    ) -> Result<Self, GeometryError> {
        let mut offsets = vec![0u32; count + 1];
        in_order(places, monitor, |place| {
            if let Some((row, _)) = pair(place) {
                offsets[row as usize + 1] += 1;
            }
        })?;
        in_order(count, monitor, |row| offsets[row + 1] += offsets[row])?;
        let mut next = offsets.clone();
        let mut items = zeroed(offsets[count] as usize);
        in_order(places, monitor, |place| {
            if let Some((row, item)) = pair(place) {
                items[next[row as usize] as usize] = item;
                next[row as usize] += 1;
            }
        })?;
        Ok(Self { offsets, items })
    }

    fn row(&self, row: usize) -> &[T] {
        &self.items[self.offsets[row] as usize..self.offsets[row + 1] as usize]
    }
}

impl Adjacency {
    pub(super) fn new(topology: &Topology, monitor: &dyn Monitor) -> Result<Self, GeometryError> {
        let corners = topology.corners();
        let mut corner_face = Vec::with_capacity(corners.len());
        let mut next = Vec::with_capacity(corners.len());
        in_order(topology.face_count(), monitor, |index| {
            let face = topology.face(index);
            corner_face.extend(std::iter::repeat_n(index as u32, face.len()));
            next.extend_from_slice(&face[1..]);
            next.push(face[0]);
        })?;
        let vertices = topology.vertex_count();
        // What does not need each other is made side by side.
        let (numbered, vertex_corners) = rayon::join(
            || number_edges(vertices, corners, &next, monitor),
            || {
                Rows::gather(vertices, corners.len(), monitor, |corner| {
                    Some((corners[corner], corner as u32))
                })
            },
        );
        let (edges, corner_edge) = numbered?;
        let (edge_corners, vertex_edges) = rayon::join(
            || {
                Rows::gather(edges.len(), corners.len(), monitor, |corner| {
                    let edge = corner_edge[corner];
                    (edge != NO_EDGE).then_some((edge, corner as u32))
                })
            },
            || {
                Rows::gather(vertices, 2 * edges.len(), monitor, |end| {
                    Some((edges[end / 2][end % 2], (end / 2) as u32))
                })
            },
        );
        let (vertex_corners, edge_corners) = (vertex_corners?, edge_corners?);
        let vertex_edges = vertex_edges?;
        Ok(Self {
            edges,
            corner_edge,
            corner_face,
            edge_corners,
            vertex_corners,
            vertex_edges,
        })
    }

    /// How many edges there are.
    pub fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// All edges as vertex pairs, each in the sense of its first corner.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The two vertices of an edge, in the sense of its first corner.
    pub fn edge(&self, edge: usize) -> [u32; 2] {
        self.edges[edge]
    }

    /// The edge that leaves each corner towards the next one of its face, or
    /// [`NO_EDGE`] where both are the same vertex.
    pub fn corner_edges(&self) -> &[u32] {
        &self.corner_edge
    }

    /// The face of each corner.
    pub fn corner_faces(&self) -> &[u32] {
        &self.corner_face
    }

    /// The corners an edge leaves, ascending: one at a boundary, two inside.
    pub fn edge_corners(&self, edge: usize) -> &[u32] {
        self.edge_corners.row(edge)
    }

    /// The corners at a vertex, ascending.
    pub fn vertex_corners(&self, vertex: usize) -> &[u32] {
        self.vertex_corners.row(vertex)
    }

    /// The edges at a vertex, ascending; their number is its valence.
    pub fn vertex_edges(&self, vertex: usize) -> &[u32] {
        self.vertex_edges.row(vertex)
    }

    /// The vertices joined to `vertex` by an edge, by ascending edge: its one-ring.
    pub fn one_ring(&self, vertex: usize) -> impl ExactSizeIterator<Item = u32> {
        self.vertex_edges(vertex)
            .iter()
            .map(move |&edge| self.other_end(edge as usize, vertex))
    }

    /// The end of `edge` that is not `vertex`.
    pub fn other_end(&self, edge: usize, vertex: usize) -> u32 {
        let [a, b] = self.edges[edge];
        if a as usize == vertex { b } else { a }
    }

    /// Whether exactly one face has this edge.
    pub fn is_boundary_edge(&self, edge: usize) -> bool {
        self.edge_corners(edge).len() == 1
    }

    /// Whether a boundary edge ends at this vertex.
    pub fn is_boundary_vertex(&self, vertex: usize) -> bool {
        self.vertex_edges(vertex)
            .iter()
            .any(|&edge| self.is_boundary_edge(edge as usize))
    }

    /// Bytes of the adjacency in memory.
    pub fn byte_size(&self) -> usize {
        let rows = [&self.edge_corners, &self.vertex_corners, &self.vertex_edges];
        let in_rows: usize = rows
            .iter()
            .map(|rows| rows.offsets.len() + rows.items.len())
            .sum();
        4 * (2 * self.edges.len() + self.corner_edge.len() + self.corner_face.len() + in_rows)
    }
}

/// Numbers undirected edges by their first corner and tells each corner its edge.
///
/// Corners are bucketed by their edge's lower vertex and sorted within the
/// bucket by the upper one, so the cost is O(corners · log valence).
fn number_edges(
    vertex_count: usize,
    from: &[u32],
    to: &[u32],
    monitor: &dyn Monitor,
) -> Result<(Vec<[u32; 2]>, Vec<u32>), GeometryError> {
    // With its upper vertex in front, a corner is sorted as one number.
    let mut buckets = Rows::gather(vertex_count, from.len(), monitor, |corner| {
        let (a, b) = (from[corner], to[corner]);
        let item = u64::from(a.max(b)) << 32 | corner as u64;
        (a != b).then_some((a.min(b), item))
    })?;
    let mut first_corner = vec![NO_EDGE; from.len()];
    in_order(vertex_count, monitor, |vertex| {
        let bounds = buckets.offsets[vertex] as usize..buckets.offsets[vertex + 1] as usize;
        let bucket = &mut buckets.items[bounds];
        bucket.sort_unstable();
        for run in bucket.chunk_by(|&a, &b| a >> 32 == b >> 32) {
            for &item in run {
                first_corner[item as u32 as usize] = run[0] as u32;
            }
        }
    })?;
    let mut edges = Vec::new();
    let mut corner_edge = vec![NO_EDGE; from.len()];
    in_order(from.len(), monitor, |corner| match first_corner[corner] {
        NO_EDGE => {}
        first if first as usize == corner => {
            corner_edge[corner] = edges.len() as u32;
            edges.push([from[corner], to[corner]]);
        }
        first => corner_edge[corner] = corner_edge[first as usize],
    })?;
    Ok((edges, corner_edge))
}
