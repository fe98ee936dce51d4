//! The faces of a subdivided mesh, and what they inherit.

use crate::mesh::AttributeValues;
use crate::topology::Topology;
use crate::{GeometryError, Monitor, parallel};

use super::bilinear::bilinear;
use super::sharpness::decayed_attribute;
use super::tiles::{Line, Tiles};
use super::value::{Value, middle, zeroed};

/// The fine faces in blocks of side × side, one block per face of the cage.
///
/// When the cage is the mesh itself a block is a whole parent. When it is the
/// first refinement, a block is the part of a parent at one of its corners; the
/// four blocks of a quad together are its cells in row-major order, those of
/// another polygon are one grid each.
pub(super) struct Blocks<'a> {
    pub(super) coarse: &'a Topology,
    pub(super) tiles: Tiles<'a>,
    pub(super) refined_cage: bool,
}

/// Where a block's cells lie in its parent.
struct Place {
    parent: usize,
    /// The corner whose part this is, for a parent that is no quad.
    part: Option<usize>,
    grid_side: usize,
    first_cell: usize,
}

impl Place {
    fn cells(&self, count: usize) -> impl Iterator<Item = (usize, usize)> {
        let (first, side) = (self.first_cell, self.grid_side);
        (first..first + count).map(move |cell| (cell % side, cell / side))
    }
}

impl Blocks<'_> {
    fn cell_count(&self) -> usize {
        self.tiles.side * self.tiles.side
    }

    /// All fine faces.
    pub(super) fn face_count(&self) -> usize {
        self.tiles.cage.face_count() * self.cell_count()
    }

    fn parent(&self, block: usize) -> usize {
        if self.refined_cage {
            self.coarse.adjacency().corner_faces()[block] as usize
        } else {
            block
        }
    }

    fn place(&self, block: usize) -> Place {
        let parent = self.parent(block);
        let range = self.coarse.corner_range(parent);
        let corner = block.saturating_sub(range.start);
        let side = self.tiles.side;
        let (part, grid_side, first_cell) = match (self.refined_cage, range.len()) {
            (false, _) => (None, side, 0),
            (true, 4) => (None, 2 * side, corner * self.cell_count()),
            (true, _) => (Some(corner), side, 0),
        };
        Place {
            parent,
            part,
            grid_side,
            first_cell,
        }
    }

    /// The parent of every fine face, as the kind of number that is wanted.
    pub(super) fn parents<N: bytemuck::Zeroable + Copy + Send + From<u32>>(
        &self,
        monitor: &dyn Monitor,
    ) -> Result<Vec<N>, GeometryError> {
        let mut parents: Vec<N> = bytemuck::zeroed_vec(self.face_count());
        let nothing = || ();
        parallel::fill_rows(
            &mut parents,
            self.cell_count(),
            monitor,
            nothing,
            |(), block, row| {
                row.fill(N::from(self.parent(block) as u32));
            },
        )?;
        Ok(parents)
    }

    /// The vertices of all fine faces, four each; u and v run as in the parent.
    pub(super) fn corners(&self, monitor: &dyn Monitor) -> Result<Vec<u32>, GeometryError> {
        let mut corners = vec![0; 4 * self.face_count()];
        let len = 4 * self.cell_count();
        let line = || vec![0; self.tiles.side + 1];
        let lines = || (line(), line());
        parallel::fill_rows(
            &mut corners,
            len,
            monitor,
            lines,
            |(low, high), block, row| {
                let place = self.place(block);
                if place.grid_side == self.tiles.side {
                    self.write_tile(block, low, high, row);
                } else {
                    for ((i, j), face) in
                        place.cells(self.cell_count()).zip(row.chunks_exact_mut(4))
                    {
                        let at = |i, j| self.in_four_tiles(place.parent, i, j);
                        face.copy_from_slice(&[
                            at(i, j),
                            at(i + 1, j),
                            at(i + 1, j + 1),
                            at(i, j + 1),
                        ]);
                    }
                }
            },
        )?;
        Ok(corners)
    }

    /// The cells of one tile, from its lines of points two by two.
    fn write_tile(&self, tile: usize, low: &mut Vec<u32>, high: &mut Vec<u32>, out: &mut [u32]) {
        let side = self.tiles.side;
        let [first, second, third, last] = std::array::from_fn(|k| self.tiles.cage.face(tile)[k]);
        let [below, right, above, left] = self.tiles.lines_round(tile);
        let border = |line: Line, ends: [u32; 2], points: &mut [u32]| {
            (points[0], points[side]) = (ends[0], ends[1]);
            for (t, point) in points[..side].iter_mut().enumerate().skip(1) {
                *point = line.at(t) as u32;
            }
        };
        let load = |j: usize, line: &mut [u32]| {
            if j == 0 {
                border(below, [first, second], line);
            } else if j == side {
                border(above, [last, third], line);
            } else {
                line[0] = left.at(j) as u32;
                line[side] = right.at(j) as u32;
                let start = (self.tiles.face_start(tile) + (j - 1) * (side - 1)) as u32;
                for (point, index) in line[1..side].iter_mut().zip(start..) {
                    *point = index;
                }
            }
        };
        load(0, low);
        for (j, row) in out.chunks_exact_mut(4 * side).enumerate() {
            load(j + 1, high);
            let pairs = low.windows(2).zip(high.windows(2));
            for (face, (below, above)) in row.chunks_exact_mut(4).zip(pairs) {
                face.copy_from_slice(&[below[0], below[1], above[1], above[0]]);
            }
            std::mem::swap(low, high);
        }
    }

    /// A grid point of a quad that is cut into four tiles.
    fn in_four_tiles(&self, parent: usize, i: usize, j: usize) -> u32 {
        let half = self.tiles.side;
        let (right, upper) = (usize::from(i > half), usize::from(j > half));
        let tile = [[0, 1], [3, 2]][upper][right] + self.coarse.corner_range(parent).start;
        self.tiles.at(tile, i - right * half, j - upper * half) as u32
    }

    /// Corner values of the fine faces, bilinear inside each parent; whole
    /// numbers are those of the nearest corner.
    pub(super) fn corner_values(
        &self,
        values: &AttributeValues,
        monitor: &dyn Monitor,
    ) -> Result<AttributeValues, GeometryError> {
        Ok(match values {
            AttributeValues::Integer(values) => {
                AttributeValues::Integer(self.nearest(values, monitor)?.into())
            }
            AttributeValues::Number(values) => {
                AttributeValues::Number(self.linear(values, monitor)?.into())
            }
            AttributeValues::Vector2(values) => {
                AttributeValues::Vector2(self.linear(values, monitor)?.into())
            }
            AttributeValues::Vector3(values) => {
                AttributeValues::Vector3(self.linear(values, monitor)?.into())
            }
        })
    }

    fn linear<T: Value>(
        &self,
        values: &[T],
        monitor: &dyn Monitor,
    ) -> Result<Vec<T>, GeometryError> {
        let mut out = zeroed(4 * self.face_count());
        let len = 4 * self.cell_count();
        parallel::fill_rows(
            &mut out,
            len,
            monitor,
            || (),
            |(), block, row| {
                let place = self.place(block);
                let quad = self.quad_values(&place, values);
                let step = 1.0 / place.grid_side as f64;
                let at = |i: usize, j: usize| bilinear(quad, i as f64 * step, j as f64 * step);
                let cells = place.cells(self.cell_count());
                for ((i, j), face) in cells.zip(row.chunks_exact_mut(4)) {
                    face.copy_from_slice(&[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            },
        )?;
        Ok(out)
    }

    /// The values at the four corners of a place's grid.
    fn quad_values<T: Value>(&self, place: &Place, values: &[T]) -> [T; 4] {
        let face = &values[self.coarse.corner_range(place.parent)];
        let Some(part) = place.part else {
            return std::array::from_fn(|k| face[k]);
        };
        let sides = face.len();
        let sum = face.iter().fold(T::default(), |sum, &value| sum + value);
        [
            face[part],
            middle(face[part], face[(part + 1) % sides]),
            sum * (1.0 / sides as f64),
            middle(face[(part + sides - 1) % sides], face[part]),
        ]
    }

    fn nearest(&self, values: &[i64], monitor: &dyn Monitor) -> Result<Vec<i64>, GeometryError> {
        let mut out = vec![0; 4 * self.face_count()];
        let len = 4 * self.cell_count();
        parallel::fill_rows(
            &mut out,
            len,
            monitor,
            || (),
            |(), block, row| {
                let place = self.place(block);
                let start = self.coarse.corner_range(place.parent).start;
                let side = place.grid_side;
                let cells = place.cells(self.cell_count());
                for ((i, j), face) in cells.zip(row.chunks_exact_mut(4)) {
                    let quadrant = [[0, 1], [3, 2]][2 * j / side][2 * i / side];
                    face.fill(values[start + place.part.unwrap_or(quadrant)]);
                }
            },
        )?;
        Ok(out)
    }

    /// What is left of the sharpness of the parents' edges after `level`
    /// refinements, on the corners of the fine faces; 0 inside parents.
    pub(super) fn edge_sharpness(
        &self,
        sharpness: &(impl Fn(usize) -> f64 + Sync),
        level: u32,
        monitor: &dyn Monitor,
    ) -> Result<Vec<f64>, GeometryError> {
        let mut out = zeroed(4 * self.face_count());
        let len = 4 * self.cell_count();
        parallel::fill_rows(
            &mut out,
            len,
            monitor,
            || (),
            |(), block, row| {
                let place = self.place(block);
                let range = self.coarse.corner_range(place.parent);
                let left =
                    |k: usize| decayed_attribute(sharpness(range.start + k % range.len()), level);
                let (last, part) = (place.grid_side - 1, place.part);
                let cells = place.cells(self.cell_count());
                for ((i, j), face) in cells.zip(row.chunks_exact_mut(4)) {
                    let first = part.unwrap_or(0);
                    let border = [
                        (j == 0).then_some(first),
                        (i == last && part.is_none()).then_some(1),
                        (j == last && part.is_none()).then_some(2),
                        (i == 0).then_some(first + range.len() - 1),
                    ];
                    for (slot, edge) in face.iter_mut().zip(border) {
                        *slot = edge.map_or(0.0, left);
                    }
                }
            },
        )?;
        Ok(out)
    }
}
