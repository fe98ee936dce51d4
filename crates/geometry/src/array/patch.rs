//! The points of one placement, many at a time.

use glam::DVec3;

use super::basis::{Basis, WeightRows};
use super::map::{ArrayPoint, CANCELLED, Displace, Map, Vectors};
use crate::math;

/// Points computed together: their rows stay in the fastest cache.
const BLOCK: usize = 64;

/// A number for each point of a block.
type Row = [f64; BLOCK];

/// A vector for each point of a block, coordinate by coordinate.
type Triple = [Row; 3];

/// Base values under one placement, and room for the points of a block.
///
/// Loops run over rows of numbers and not over points, so that they become
/// vector instructions.
#[derive(Default)]
pub(super) struct Patch {
    grid: Vec<u32>,
    positions: Triples,
    outward: PatchVectors,
    inward: Option<PatchVectors>,
    size: Option<Vec<f64>>,
    scale: Option<Vec<f64>>,
    normals: Option<Triples>,
    rows: Box<Rows>,
}

struct Rows {
    positions: Triple,
    directions: Triple,
    inward: Triple,
    normals: Triple,
    heights: Row,
    factors: Row,
}

impl Default for Rows {
    fn default() -> Self {
        const ZEROS: Row = [0.0; BLOCK];
        Self {
            positions: [ZEROS; 3],
            directions: [ZEROS; 3],
            inward: [ZEROS; 3],
            normals: [ZEROS; 3],
            heights: ZEROS,
            factors: ZEROS,
        }
    }
}

/// Vectors of a grid, coordinate by coordinate.
#[derive(Default)]
struct Triples([Vec<f64>; 3]);

#[derive(Default)]
struct PatchVectors {
    directions: Triples,
    /// `None` for linear interpolation.
    lengths: Option<Vec<f64>>,
}

impl Patch {
    /// Takes the values under a placement instead of those of an earlier one.
    pub(super) fn gather(&mut self, map: &Map<'_>, placement: usize) {
        map.layout.grid(placement, &mut self.grid);
        let grid = &self.grid;
        self.positions.gather(grid, map.base.positions());
        self.outward.gather(grid, &map.outward);
        if let Some(inward) = &map.inward {
            self.inward.get_or_insert_default().gather(grid, inward);
        }
        if let Some(size) = &map.size {
            gather(self.size.get_or_insert_default(), grid, |at| size[at]);
        }
        if let Some(scale) = map.scale {
            gather(self.scale.get_or_insert_default(), grid, |at| scale.at(at));
        }
        if let Some(normals) = &map.normals {
            self.normals.get_or_insert_default().gather(grid, normals);
        }
    }

    /// The points of a component over this patch; `first` says which vertex of
    /// the array the first one is, and over which face they are.
    #[inline(always)]
    pub(super) fn place<D: Displace + ?Sized>(
        &mut self,
        basis: &Basis,
        mut first: ArrayPoint,
        displace: &D,
        out: &mut [DVec3],
    ) {
        for (block, out) in out.chunks_mut(BLOCK).enumerate() {
            let start = block * BLOCK;
            let rows = &mut *self.rows;
            let (place, heights) = (&basis.rows.place, &mut rows.heights[..out.len()]);
            heights.copy_from_slice(&basis.rows.height[start..start + out.len()]);
            for factors in [&self.size, &self.scale].into_iter().flatten() {
                let row = &mut rows.factors[..out.len()];
                place.sum(start, [factors], [&mut *row]);
                for (height, factor) in heights.iter_mut().zip(row) {
                    *height *= *factor;
                }
            }
            self.positions
                .sum(place, start, out.len(), &mut rows.positions);
            if let Some(normals) = &self.normals {
                normals.sum(place, start, out.len(), &mut rows.normals);
            }
            let direction = &basis.rows.direction;
            let lengths = &mut rows.factors[..out.len()];
            self.outward
                .at(direction, start, lengths, &mut rows.directions);
            if let Some(inward) = &self.inward
                && heights.iter().any(|&height| height < 0.0)
            {
                inward.at(direction, start, lengths, &mut rows.inward);
                for (outward, inward) in rows.directions.iter_mut().zip(&rows.inward) {
                    for (k, height) in heights.iter().enumerate() {
                        outward[k] = if *height < 0.0 { inward[k] } else { outward[k] };
                    }
                }
            }
            for (k, height) in heights.iter_mut().enumerate() {
                let at = |triple: &Triple| DVec3::from(triple.each_ref().map(|row| row[k]));
                *height = displace.height(&ArrayPoint {
                    uv: basis.points[start + k].uv,
                    height: *height,
                    position: at(&rows.positions),
                    // All zero, unless there are normals.
                    normal: math::unit_or_zero(at(&rows.normals)),
                    direction: at(&rows.directions),
                    ..first
                });
                first.vertex += 1;
            }
            let ([px, py, pz], [dx, dy, dz]) = (&rows.positions, &rows.directions);
            for (k, (out, height)) in out.iter_mut().zip(heights).enumerate() {
                *out = DVec3::new(
                    px[k] + dx[k] * *height,
                    py[k] + dy[k] * *height,
                    pz[k] + dz[k] * *height,
                );
            }
        }
    }
}

impl Triples {
    fn gather(&mut self, grid: &[u32], vectors: &[DVec3]) {
        for (axis, values) in self.0.iter_mut().enumerate() {
            gather(values, grid, |vertex| vectors[vertex][axis]);
        }
    }

    /// The sums of `count` points from `first` on.
    #[inline(always)]
    fn sum(&self, weights: &WeightRows, first: usize, count: usize, out: &mut Triple) {
        let ([x, y, z], [to_x, to_y, to_z]) = (&self.0, out);
        let out = [&mut to_x[..count], &mut to_y[..count], &mut to_z[..count]];
        weights.sum(first, [x, y, z], out);
    }
}

impl PatchVectors {
    fn gather(&mut self, grid: &[u32], vectors: &Vectors) {
        self.directions.gather(grid, &vectors.directions);
        if let Some(lengths) = &vectors.lengths {
            gather(self.lengths.get_or_insert_default(), grid, |at| lengths[at]);
        }
    }

    /// The interpolated directions of as many points as `lengths` has room for;
    /// made that long as [`super::map::with_length`] does it, where lengths are
    /// interpolated apart.
    #[inline(always)]
    fn at(&self, weights: &WeightRows, first: usize, lengths: &mut [f64], out: &mut Triple) {
        self.directions.sum(weights, first, lengths.len(), out);
        let Some(values) = &self.lengths else {
            return;
        };
        weights.sum(first, [values], [&mut *lengths]);
        let [x, y, z] = out;
        for (k, length) in lengths.iter().enumerate() {
            let now = (x[k] * x[k] + y[k] * y[k] + z[k] * z[k]).sqrt();
            let factor = length / now;
            let is_there = now > CANCELLED;
            x[k] = if is_there { x[k] * factor } else { 0.0 };
            y[k] = if is_there { y[k] * factor } else { 0.0 };
            z[k] = if is_there { z[k] * factor } else { 0.0 };
        }
    }
}

fn gather(out: &mut Vec<f64>, grid: &[u32], value: impl Fn(usize) -> f64) {
    out.clear();
    out.extend(grid.iter().map(|&vertex| value(vertex as usize)));
}
