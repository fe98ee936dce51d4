//! Which coarse face each fine face comes from, and where in it it lies.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec2;

use crate::GeometryError;
use crate::mesh::{AttributeValues, Domain, Mesh};
use crate::topology::Topology;

/// Face attribute that holds the parent of each fine face.
pub const PARENT: &str = "parent";

/// The fine faces of every coarse face, as grids.
///
/// The fine faces of a parent follow each other. A 4-sided parent is one grid
/// of side × side cells, side = 2^levels, in row-major order: cell (i, j) is the
/// (j · side + i)-th, u (with i) runs from the parent's corner 0 to its corner
/// 1, v (with j) from corner 0 to corner 3, and every cell's own corners do the
/// same. A parent with n sides is n grids of 2^(levels - 1), one per corner in
/// order: its u runs along the edge that leaves the corner, its v along the one
/// that arrives.
///
/// Everything is read off the order of faces, so a mesh that kept its faces and
/// its `parent` attribute through other operations has its parents back with
/// [`Parents::of_mesh`].
#[derive(Debug, Clone)]
pub struct Parents {
    topology: Arc<Topology>,
    patches: Vec<Patch>,
}

/// The fine faces of one parent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Patch {
    parent: u32,
    start: u32,
    end: u32,
    /// Cells along each side of the patch's grids; 0 when it has none.
    side: u32,
}

/// A square block of fine faces and its vertices.
#[derive(Debug, Clone, Copy)]
pub struct Grid<'a> {
    topology: &'a Topology,
    start: usize,
    side: usize,
}

impl Parents {
    pub(super) fn new(
        topology: Arc<Topology>,
        sides_and_counts: impl Iterator<Item = (usize, usize)>,
    ) -> Self {
        let mut start = 0;
        let patches = (0u32..)
            .zip(sides_and_counts)
            .map(|(parent, (side, count))| {
                let patch = Patch {
                    parent,
                    start: start as u32,
                    end: (start + count) as u32,
                    side: side as u32,
                };
                start += count;
                patch
            })
            .collect();
        Self { topology, patches }
    }

    /// Finds the parents of a mesh by its face attribute `parent`: each run of
    /// faces with the same value is a patch, and its grids are checked face by
    /// face. A patch that has lost faces has no grid. Cost: O(faces).
    ///
    /// # Errors
    /// [`GeometryError::NoAttribute`] without such an attribute of whole
    /// numbers; [`GeometryError::OutOfRange`] for a value below 0 or above 2³².
    pub fn of_mesh(mesh: &Mesh) -> Result<Self, GeometryError> {
        let attribute = mesh.attribute(PARENT, Domain::Face);
        let Some(AttributeValues::Integer(of_face)) = attribute.map(|a| a.values()) else {
            let attributes = mesh.attributes().iter();
            return Err(GeometryError::NoAttribute {
                name: PARENT.into(),
                wanted: "face integer",
                available: attributes.map(|other| other.name().into()).collect(),
            });
        };
        let topology = Arc::clone(mesh.topology());
        let mut patches = Vec::new();
        let mut start = 0;
        for run in of_face.chunk_by(|a, b| a == b) {
            let parent = u32::try_from(run[0]).map_err(|_| GeometryError::OutOfRange {
                what: "the parent of a face",
                value: run[0] as f64,
                requirement: "it must be a face number from 0",
            })?;
            let end = start + run.len();
            patches.push(Patch {
                parent,
                start: start as u32,
                end: end as u32,
                side: grid_side(&topology, start..end) as u32,
            });
            start = end;
        }
        Ok(Self { topology, patches })
    }

    /// The fine faces.
    pub fn topology(&self) -> &Arc<Topology> {
        &self.topology
    }

    /// How many patches there are: one per coarse face.
    pub fn len(&self) -> usize {
        self.patches.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.patches.is_empty()
    }

    /// The coarse face a patch comes from; its own number after subdividing.
    pub fn parent(&self, patch: usize) -> u32 {
        self.patches[patch].parent
    }

    /// The fine faces of a patch.
    pub fn faces(&self, patch: usize) -> Range<usize> {
        let Patch { start, end, .. } = self.patches[patch];
        start as usize..end as usize
    }

    /// How many grids a patch has: 1 if its parent is 4-sided, else as many as
    /// the parent has sides; 0 for a polygon at level 0 and for a patch that
    /// has lost faces.
    pub fn grid_count(&self, patch: usize) -> usize {
        match self.patches[patch].side as usize {
            0 => 0,
            side => self.faces(patch).len() / (side * side),
        }
    }

    /// The k-th grid of a patch.
    ///
    /// # Panics
    /// If `k` is not below [`Parents::grid_count`].
    pub fn grid(&self, patch: usize, k: usize) -> Grid<'_> {
        assert!(k < self.grid_count(patch), "patch {patch} has no grid {k}");
        let side = self.patches[patch].side as usize;
        Grid {
            topology: &self.topology,
            start: self.faces(patch).start + k * side * side,
            side,
        }
    }

    /// The one grid of a patch whose parent is 4-sided; `None` for others.
    pub fn whole_grid(&self, patch: usize) -> Option<Grid<'_>> {
        (self.grid_count(patch) == 1).then(|| self.grid(patch, 0))
    }

    /// The patch of a fine face. Cost: O(log patches).
    pub fn patch_of(&self, face: usize) -> usize {
        let after = |patch: &Patch| patch.end as usize <= face;
        self.patches.partition_point(after)
    }

    /// The grid of its patch a fine face lies in, and the lowest and highest
    /// (u, v) of its cell there; `None` if the patch has no grid.
    pub fn rectangle(&self, face: usize) -> Option<(usize, [DVec2; 2])> {
        let patch = self.patch_of(face);
        let side = self.patches.get(patch)?.side as usize;
        if side == 0 {
            return None;
        }
        let local = face - self.faces(patch).start;
        let (grid, cell) = (local / (side * side), local % (side * side));
        let low = DVec2::new((cell % side) as f64, (cell / side) as f64);
        let step = 1.0 / side as f64;
        Some((grid, [low * step, (low + 1.0) * step]))
    }

    /// Bytes of the patches in memory.
    pub fn byte_size(&self) -> usize {
        size_of_val(self.patches.as_slice())
    }
}

impl Grid<'_> {
    /// Cells along each side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// The fine face of cell (i, j), each below [`Grid::side`].
    pub fn face(&self, i: usize, j: usize) -> usize {
        self.start + j * self.side + i
    }

    /// The vertex at (i, j), each in 0..=side: u = i / side, v = j / side.
    pub fn vertex(&self, i: usize, j: usize) -> u32 {
        let (column, row) = (i.min(self.side - 1), j.min(self.side - 1));
        let corner = [[0, 1], [3, 2]][j - row][i - column];
        self.topology.face(self.face(column, row))[corner]
    }

    /// All (side + 1)² vertices, row by row.
    pub fn vertices(&self) -> impl Iterator<Item = u32> {
        let row = self.side + 1;
        (0..row * row).map(move |k| self.vertex(k % row, k / row))
    }

    /// Whether neighbouring cells share the vertices that a grid's do.
    fn is_regular(&self) -> bool {
        let quad = |i: usize, j: usize| self.topology.face(self.face(i, j));
        let cells = (0..self.side * self.side).map(|k| (k % self.side, k / self.side));
        cells.clone().all(|(i, j)| quad(i, j).len() == 4)
            && cells.into_iter().all(|(i, j)| {
                let here = quad(i, j);
                let left = i == 0 || {
                    let left = quad(i - 1, j);
                    [left[1], left[2]] == [here[0], here[3]]
                };
                let below = j == 0 || {
                    let below = quad(i, j - 1);
                    [below[3], below[2]] == [here[0], here[1]]
                };
                left && below
            })
    }
}

/// The side of the largest grids that fill these faces; 0 if none do.
fn grid_side(topology: &Topology, faces: Range<usize>) -> usize {
    let count = faces.len();
    let sides = (0..=8).rev().map(|level| 1usize << level);
    let fits = |&side: &usize| {
        count.is_multiple_of(side * side)
            && faces.clone().step_by(side * side).all(|start| {
                Grid {
                    topology,
                    start,
                    side,
                }
                .is_regular()
            })
    };
    // Loose quads are no patch of anything: one cell is a grid only by itself.
    let lone = |side: &usize| *side > 1 || count == 1 || is_fan(topology, faces.clone());
    sides.filter(lone).find(fits).unwrap_or(0)
}

/// Whether the faces are the quads round one centre, their third corners: a
/// polygon's parts after one level.
fn is_fan(topology: &Topology, faces: Range<usize>) -> bool {
    let centre = topology.face(faces.start).get(2);
    faces.len() >= 3
        && faces
            .into_iter()
            .all(|face| topology.face(face).get(2) == centre)
}
