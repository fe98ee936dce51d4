//! Which vertices make which faces, and who neighbours whom.

mod adjacency;
mod boundary;
mod fans;

use std::sync::{Arc, OnceLock};

pub use adjacency::{Adjacency, NO_EDGE};
pub(crate) use boundary::{BoundaryWalk, next_in_face, previous_in_face, walks as boundary_walks};

use crate::buffer::Buffer;
use crate::digest::{Digest, Hasher};
use crate::{GeometryError, Monitor, Unmonitored, parallel};

/// The faces of a mesh as corners in compressed rows, with lazy adjacency.
///
/// Face `f` has the corners `offsets[f]..offsets[f + 1]`; corner `c` is at vertex
/// `corners[c]`. Meshes of equal topology share one value, and with it the
/// adjacency, which is built once on first use.
#[derive(Debug)]
pub struct Topology {
    vertex_count: usize,
    offsets: Buffer<u32>,
    corners: Buffer<u32>,
    adjacency: OnceLock<Adjacency>,
    boundary_loops: OnceLock<Vec<Vec<u32>>>,
    digest: OnceLock<Digest>,
}

impl Topology {
    /// Faces given by row offsets and corner vertices.
    ///
    /// `offsets` starts with 0, ends with the number of corners and has one
    /// entry more than there are faces. A face may name a vertex twice (real
    /// files do); the edge between equal neighbours does not count as an edge.
    ///
    /// # Errors
    /// [`GeometryError::TooFewCorners`], [`GeometryError::IndexOutOfRange`],
    /// [`GeometryError::TooMany`]; [`GeometryError::Invalid`] for broken offsets.
    pub fn new(
        vertex_count: usize,
        offsets: Vec<u32>,
        corners: Vec<u32>,
    ) -> Result<Self, GeometryError> {
        check_counts(vertex_count, &offsets, &corners)?;
        if !are_faces(vertex_count, &offsets, &corners) {
            check_faces(vertex_count, &offsets, &corners)?;
        }
        Ok(Self::of(vertex_count, offsets.into(), corners.into()))
    }

    /// [`Topology::new`] for faces that are known to be sound, because they were
    /// made from sound ones: they are not looked at again.
    ///
    /// # Errors
    /// As [`Topology::new`] where there are too many.
    pub(crate) fn of_sound(
        vertex_count: usize,
        offsets: Vec<u32>,
        corners: Vec<u32>,
    ) -> Result<Self, GeometryError> {
        check_counts(vertex_count, &offsets, &corners)?;
        debug_assert!(are_faces(vertex_count, &offsets, &corners), "sound faces");
        Ok(Self::of(vertex_count, offsets.into(), corners.into()))
    }

    fn of(vertex_count: usize, offsets: Buffer<u32>, corners: Buffer<u32>) -> Self {
        Self {
            vertex_count,
            offsets,
            corners,
            adjacency: OnceLock::new(),
            boundary_loops: OnceLock::new(),
            digest: OnceLock::new(),
        }
    }

    /// Where faces of `sides` corners start that have `corner_count` together.
    pub(crate) fn even_offsets(
        corner_count: usize,
        sides: usize,
    ) -> Result<Vec<u32>, GeometryError> {
        parallel::map(corner_count / sides + 1, &Unmonitored, |face| {
            (face * sides) as u32
        })
    }

    /// Faces that all have `sides` corners, listed one after the other.
    ///
    /// # Errors
    /// As [`Topology::new`].
    pub fn uniform(
        vertex_count: usize,
        sides: usize,
        corners: Vec<u32>,
    ) -> Result<Self, GeometryError> {
        Self::new(
            vertex_count,
            Self::even_offsets(corners.len(), sides)?,
            corners,
        )
    }

    /// The same faces of other vertices, whose offsets are shared.
    ///
    /// # Errors
    /// As [`Topology::new`].
    pub(crate) fn renamed(
        &self,
        vertex_count: usize,
        corners: Vec<u32>,
    ) -> Result<Self, GeometryError> {
        assert_eq!(corners.len(), self.corner_count(), "the same faces");
        if !are_faces(vertex_count, &self.offsets, &corners) {
            check_faces(vertex_count, &self.offsets, &corners)?;
        }
        Ok(Self::of(vertex_count, self.offsets.clone(), corners.into()))
    }

    /// How many vertices the faces may name; some may be isolated.
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// How many faces there are.
    pub fn face_count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// How many corners all faces have together.
    pub fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// Start of each face's corners, and the corner count at the end.
    pub fn offsets(&self) -> &Buffer<u32> {
        &self.offsets
    }

    /// The vertex at each corner, face by face.
    pub fn corners(&self) -> &Buffer<u32> {
        &self.corners
    }

    /// The corners of `face` as a range into [`Topology::corners`].
    pub fn corner_range(&self, face: usize) -> std::ops::Range<usize> {
        self.offsets[face] as usize..self.offsets[face + 1] as usize
    }

    /// The vertices of `face` in order.
    pub fn face(&self, face: usize) -> &[u32] {
        &self.corners[self.corner_range(face)]
    }

    /// The faces in order, each as its vertices.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        (0..self.face_count()).map(|face| self.face(face))
    }

    /// Edges and one-rings. Cost: O(corners · log valence) once, then O(1).
    pub fn adjacency(&self) -> &Adjacency {
        self.adjacency
            .get_or_init(|| Adjacency::new(self, &Unmonitored).expect("only a monitor stops this"))
    }

    /// [`Topology::adjacency`] for an operation that may be stopped while it is
    /// built: it asks for this first. A build that was stopped leaves nothing
    /// behind; two threads that begin at once both build it, and one is kept.
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`] when `monitor` asks to stop.
    pub fn adjacency_with(&self, monitor: &dyn Monitor) -> Result<&Adjacency, GeometryError> {
        if let Some(adjacency) = self.adjacency.get() {
            return Ok(adjacency);
        }
        let built = Adjacency::new(self, monitor)?;
        Ok(self.adjacency.get_or_init(|| built))
    }

    /// Loops of boundary edges as closed lists of vertices, each walked with
    /// its faces on the left. Cost: O(corners) once, then O(1).
    ///
    /// At a vertex where several loops meet they are kept apart by walking
    /// round the faces between them. Edges with three and more faces are no
    /// boundary.
    pub fn boundary_loops(&self) -> &[Vec<u32>] {
        self.boundary_loops.get_or_init(|| boundary::loops(self))
    }

    /// Content digest: counts, offsets and corners.
    pub fn digest(&self) -> Digest {
        // As in `Buffer::digest`: nothing that may use the thread pool runs inside the cell.
        let offsets = self.offsets.digest();
        let corners = self.corners.digest();
        *self.digest.get_or_init(|| {
            Hasher::new()
                .text("topology")
                .number(self.vertex_count as u64)
                .digest(offsets)
                .digest(corners)
                .finish()
        })
    }

    /// Whether both have the same faces with the same indices.
    pub fn is_same(self: &Arc<Self>, other: &Arc<Self>) -> bool {
        Arc::ptr_eq(self, other)
            || (self.vertex_count == other.vertex_count
                && self.face_count() == other.face_count()
                && self.digest() == other.digest())
    }

    /// Checks that `other` is the same topology.
    ///
    /// # Errors
    /// [`GeometryError::OtherTopology`] saying that `what` belong elsewhere.
    pub fn check_same(
        self: &Arc<Self>,
        other: &Arc<Self>,
        what: &'static str,
    ) -> Result<(), GeometryError> {
        if self.is_same(other) {
            return Ok(());
        }
        Err(GeometryError::OtherTopology {
            what,
            theirs_vertices: other.vertex_count(),
            theirs_faces: other.face_count(),
            ours_vertices: self.vertex_count(),
            ours_faces: self.face_count(),
        })
    }

    /// Checks that no edge has more than two faces.
    ///
    /// # Errors
    /// [`GeometryError::NonManifold`] with all edges that have.
    pub fn check_manifold(&self) -> Result<(), GeometryError> {
        let adjacency = self.adjacency();
        let edges: Vec<_> = (0..adjacency.edge_count())
            .filter(|&edge| adjacency.edge_corners(edge).len() > 2)
            .map(|edge| (adjacency.edge(edge), adjacency.edge_corners(edge).len()))
            .collect();
        if edges.is_empty() {
            Ok(())
        } else {
            Err(GeometryError::NonManifold { edges })
        }
    }

    /// Checks that no face names a vertex twice in a row: every corner needs an
    /// edge that leaves it.
    ///
    /// # Errors
    /// [`GeometryError::RepeatedVertex`] with the first one.
    pub fn check_edges(&self) -> Result<(), GeometryError> {
        let adjacency = self.adjacency();
        match adjacency.corner_edges().iter().position(|&e| e == NO_EDGE) {
            Some(corner) => Err(GeometryError::RepeatedVertex {
                face: adjacency.corner_faces()[corner] as usize,
                vertex: self.corners()[corner],
            }),
            None => Ok(()),
        }
    }

    /// Checks that the two faces of each edge pass it in opposite senses.
    ///
    /// # Errors
    /// [`GeometryError::Invalid`] naming the first edge and the two faces.
    pub fn check_oriented(&self) -> Result<(), GeometryError> {
        let adjacency = self.adjacency();
        for edge in 0..adjacency.edge_count() {
            if let [c, d] = *adjacency.edge_corners(edge)
                && self.corners()[c as usize] == self.corners()[d as usize]
            {
                let [a, b] = adjacency.edge(edge);
                let [f, g] = [c, d].map(|corner| adjacency.corner_faces()[corner as usize]);
                return Err(GeometryError::Invalid(format!(
                    "faces {f} and {g} pass their edge {a}-{b} in the same sense; \
                     turn the faces round so that neighbours agree on the outside"
                )));
            }
        }
        Ok(())
    }

    /// Checks that every face has three or four corners.
    ///
    /// # Errors
    /// [`GeometryError::NotQuad`] with the first other face.
    pub fn check_quads(&self) -> Result<(), GeometryError> {
        let advice = "split it with TriangulateFaces, FanFaces or SplitIntoQuads";
        match self.faces().position(|face| face.len() > 4) {
            Some(face) => {
                let corners = self.face(face).len();
                Err(GeometryError::NotQuad {
                    face,
                    corners,
                    advice,
                })
            }
            None => Ok(()),
        }
    }
}

/// Whether 32-bit indices can name everything, and the offsets end where the
/// corners do.
fn check_counts(
    vertex_count: usize,
    offsets: &[u32],
    corners: &[u32],
) -> Result<(), GeometryError> {
    let limit = u128::from(u32::MAX - 1);
    for (what, count) in [("vertices", vertex_count), ("corners", corners.len())] {
        if count as u128 > limit {
            return Err(GeometryError::TooMany {
                what,
                count: count as u128,
                limit,
            });
        }
    }
    if offsets.first() != Some(&0) || offsets.last().map(|&n| n as usize) != Some(corners.len()) {
        return Err(GeometryError::Invalid(
            "face offsets do not span the corners".into(),
        ));
    }
    Ok(())
}

/// Whether every face has three corners or more, and every corner a vertex. Looks
/// at all of them without an early end, so that it runs at the speed of memory.
fn are_faces(vertex_count: usize, offsets: &[u32], corners: &[u32]) -> bool {
    let ends = &offsets[1..];
    let long_enough = |first: usize, ends: &[u32]| {
        let starts = &offsets[first..first + ends.len()];
        let pairs = starts.iter().zip(ends);
        pairs.fold(true, |all, (&start, &end)| {
            all & (end >= start.saturating_add(3))
        })
    };
    let in_range = |_, corners: &[u32]| {
        let vertices = corners.iter();
        vertices.fold(true, |all, &vertex| {
            all & ((vertex as usize) < vertex_count)
        })
    };
    parallel::all(ends, long_enough) && parallel::all(corners, in_range)
}

/// The first face that is none.
///
/// # Errors
/// As [`Topology::new`].
fn check_faces(vertex_count: usize, offsets: &[u32], corners: &[u32]) -> Result<(), GeometryError> {
    for (face, row) in offsets.windows(2).enumerate() {
        let count = (row[1] as usize).saturating_sub(row[0] as usize);
        if count < 3 {
            return Err(GeometryError::TooFewCorners {
                face,
                corners: count,
            });
        }
        let (start, end) = (row[0] as usize, row[1] as usize);
        let row = corners.get(start..end).unwrap_or_default();
        if let Some(&index) = row.iter().find(|&&index| index as usize >= vertex_count) {
            let index = index as usize;
            return Err(GeometryError::IndexOutOfRange {
                face,
                index,
                vertex_count,
            });
        }
    }
    Ok(())
}
