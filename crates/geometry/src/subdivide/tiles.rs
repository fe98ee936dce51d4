//! How the points of refined quads are numbered.

use crate::topology::Topology;

use super::value::Value;

/// The numbering of points when every quad of a cage is cut into side × side
/// cells: first the cage's vertices, then the points inside each edge (in edge
/// order, along the edge's sense), then the points inside each face (in face
/// order, row by row, u fastest).
///
/// Everything about one face is one dense block, so that refinement runs over
/// rows of memory and needs no adjacency of its own.
#[derive(Clone, Copy)]
pub(super) struct Tiles<'a> {
    pub(super) cage: &'a Topology,
    pub(super) side: usize,
}

impl<'a> Tiles<'a> {
    pub(super) fn new(cage: &'a Topology, side: usize) -> Self {
        Self { cage, side }
    }

    /// Points inside an edge.
    pub(super) fn edge_len(&self) -> usize {
        self.side - 1
    }

    /// Points inside a face.
    pub(super) fn face_len(&self) -> usize {
        self.edge_len() * self.edge_len()
    }

    /// All points.
    pub(super) fn point_count(&self) -> usize {
        self.faces_start() + self.cage.face_count() * self.face_len()
    }

    fn faces_start(&self) -> usize {
        self.cage.vertex_count() + self.cage.adjacency().edge_count() * self.edge_len()
    }

    /// Where the points inside `face` start.
    pub(super) fn face_start(&self, face: usize) -> usize {
        self.faces_start() + face * self.face_len()
    }

    /// The point `t` cells along `edge`, from its first end.
    pub(super) fn on_edge(&self, edge: usize, t: usize) -> usize {
        let [a, b] = self.cage.adjacency().edge(edge);
        if t == 0 {
            a as usize
        } else if t == self.side {
            b as usize
        } else {
            self.cage.vertex_count() + edge * self.edge_len() + t - 1
        }
    }

    /// The first point along `edge` seen from its end `vertex`.
    pub(super) fn first_on_edge(&self, edge: usize, vertex: usize) -> usize {
        let starts_here = self.cage.adjacency().edge(edge)[0] as usize == vertex;
        self.on_edge(edge, if starts_here { 1 } else { self.side - 1 })
    }

    /// Whether the edge that leaves `corner` was first named in that sense.
    pub(super) fn is_along(&self, corner: usize) -> bool {
        let edge = self.cage.adjacency().corner_edges()[corner];
        self.cage.adjacency().edge(edge as usize)[0] == self.cage.corners()[corner]
    }

    /// The point `t` cells along the edge that leaves `corner`.
    pub(super) fn along_side(&self, corner: usize, t: usize) -> usize {
        let edge = self.cage.adjacency().corner_edges()[corner] as usize;
        let t = if self.is_along(corner) {
            t
        } else {
            self.side - t
        };
        self.on_edge(edge, t)
    }

    /// The point of `face` at grid place (i, j), both in 0..=side.
    pub(super) fn at(&self, face: usize, i: usize, j: usize) -> usize {
        let (side, corner) = (self.side, 4 * face);
        if j == 0 {
            self.along_side(corner, i)
        } else if i == side {
            self.along_side(corner + 1, j)
        } else if j == side {
            self.along_side(corner + 2, side - i)
        } else if i == 0 {
            self.along_side(corner + 3, side - j)
        } else {
            self.face_start(face) + (j - 1) * self.edge_len() + i - 1
        }
    }

    /// The point `t` cells along and `depth` cells inside the edge that leaves
    /// `corner`, in the corner's face.
    pub(super) fn inside(&self, corner: usize, t: usize, depth: usize) -> usize {
        let side = self.side;
        let (i, j) = match corner % 4 {
            0 => (t, depth),
            1 => (side - depth, t),
            2 => (side - t, side - depth),
            _ => (depth, side - t),
        };
        self.at(corner / 4, i, j)
    }

    /// Copies the (side + 1)² values of `face`, borders included, row by row.
    pub(super) fn load<T: Value>(&self, face: usize, values: &[T], tile: &mut [T]) {
        let (side, row) = (self.side, self.side + 1);
        for t in 0..=side {
            tile[t] = values[self.at(face, t, 0)];
            tile[side * row + t] = values[self.at(face, t, side)];
        }
        let start = self.face_start(face);
        let inside = &values[start..start + self.face_len()];
        for j in 1..side {
            let line = &mut tile[j * row..(j + 1) * row];
            line[0] = values[self.at(face, 0, j)];
            line[side] = values[self.at(face, side, j)];
            line[1..side].copy_from_slice(&inside[(j - 1) * (side - 1)..j * (side - 1)]);
        }
    }

    /// Cuts an array of one value per point into those of vertices, edges and faces.
    pub(super) fn split<'s, T>(
        &self,
        values: &'s mut [T],
    ) -> (&'s mut [T], &'s mut [T], &'s mut [T]) {
        let (vertices, rest) = values.split_at_mut(self.cage.vertex_count());
        let (edges, faces) = rest.split_at_mut(self.faces_start() - self.cage.vertex_count());
        (vertices, edges, faces)
    }
}
