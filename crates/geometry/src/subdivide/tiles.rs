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

/// Points at even steps through the array of all points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// The first point, at t = 1.
    first: usize,
    step: isize,
}

impl Line {
    fn new(first: usize, step: isize) -> Self {
        Self { first, step }
    }

    /// The point at `t`, from 1 on.
    #[inline]
    pub(super) fn at(self, t: usize) -> usize {
        self.first.wrapping_add_signed(self.step * (t as isize - 1))
    }
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

    /// The points inside `edge` in its own sense, `t` cells along it for
    /// 0 < t < side.
    pub(super) fn edge_line(&self, edge: usize) -> Line {
        Line::new(self.cage.vertex_count() + edge * self.edge_len(), 1)
    }

    /// The points inside the edge that leaves `corner`, `t` cells along it for
    /// 0 < t < side.
    pub(super) fn along_line(&self, corner: usize) -> Line {
        let edge = self.cage.adjacency().corner_edges()[corner] as usize;
        let line = self.edge_line(edge);
        if self.is_along(corner) || self.side < 2 {
            line
        } else {
            Line::new(line.at(self.edge_len()), -1)
        }
    }

    /// The points one cell inside the corner's face from those inside the edge
    /// that leaves `corner`, in the edge's own sense; for a side of at least 2.
    pub(super) fn beside_line(&self, corner: usize) -> Line {
        let (start, row) = (self.face_start(corner / 4), self.edge_len());
        let line = match corner % 4 {
            0 => Line::new(start, 1),
            1 => Line::new(start + row - 1, row as isize),
            2 => Line::new(start + row * row - 1, -1),
            _ => Line::new(start + row * (row - 1), -(row as isize)),
        };
        if self.is_along(corner) {
            line
        } else {
            Line::new(line.at(row), -line.step)
        }
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

    /// The lines round `face`: its first, second, third and last side, the later
    /// two against the face's sense, so that all run as its u and v do.
    pub(super) fn lines_round(&self, face: usize) -> [Line; 4] {
        let line = |k: usize| self.along_line(4 * face + k);
        let back = |line: Line| Line::new(line.at(self.edge_len()), -line.step);
        // Without points inside the edges there is nothing to turn round.
        if self.side < 2 {
            return [Line::new(0, 0); 4];
        }
        [line(0), line(1), back(line(2)), back(line(3))]
    }

    /// Copies the (side + 1)² values of `face`, borders included, row by row.
    pub(super) fn load<T: Value>(&self, face: usize, values: &[T], tile: &mut [T]) {
        let (side, row) = (self.side, self.side + 1);
        let [a, b, c, d] = std::array::from_fn(|k| values[self.cage.face(face)[k] as usize]);
        let [low, right, high, left] = self.lines_round(face);
        (tile[0], tile[side]) = (a, b);
        (tile[side * row], tile[side * row + side]) = (d, c);
        for t in 1..side {
            tile[t] = values[low.at(t)];
            tile[side * row + t] = values[high.at(t)];
        }
        let start = self.face_start(face);
        let inside = &values[start..start + self.face_len()];
        for j in 1..side {
            let line = &mut tile[j * row..(j + 1) * row];
            line[0] = values[left.at(j)];
            line[side] = values[right.at(j)];
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
