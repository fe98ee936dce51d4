//! Weights of grid vertices at each component vertex.

use glam::DVec2;

use super::Piece;

/// A place in a grid of base vertices, bilinear between four of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridPlace {
    /// The first of the four in the grid; the others are the next one, and those
    /// a row further.
    pub first: u32,
    /// How far it is from the first to the next one along u and along v, from 0 to
    /// 1; more or less beyond the grid.
    pub fraction: DVec2,
}

impl GridPlace {
    /// The place of (u, v) in a grid of side n: in the small face that holds it, the
    /// last one for u = 1 and for all beyond the grid.
    pub(super) fn new(uv: DVec2, side: u32) -> Self {
        let n = f64::from(side);
        let cell = |x: f64| (x * n).floor().clamp(0.0, n - 1.0);
        let (i, j) = (cell(uv.x), cell(uv.y));
        Self {
            first: j as u32 * (side + 1) + i as u32,
            fraction: DVec2::new(uv.x * n - i, uv.y * n - j),
        }
    }
}

/// Four grid vertices and their bilinear weights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    /// Places in the grid: (i, j), (i+1, j), (i, j+1), (i+1, j+1).
    pub(super) at: [u32; 4],
    pub(super) weight: [f64; 4],
}

impl Weights {
    /// Bilinear weights at (u, v) of a grid of side n.
    pub(super) fn new(uv: DVec2, side: u32) -> Self {
        Self::of(GridPlace::new(uv, side), side)
    }

    /// Bilinear weights of a place in a grid of side n.
    pub(super) fn of(place: GridPlace, side: u32) -> Self {
        let GridPlace { first, fraction } = place;
        let (f, g) = (fraction.x, fraction.y);
        Self {
            at: [first, first + 1, first + side + 1, first + side + 2],
            weight: [(1.0 - f) * (1.0 - g), f * (1.0 - g), (1.0 - f) * g, f * g],
        }
    }

    /// Weighted sum of what `value` says of each place in the grid.
    #[inline]
    pub(super) fn sum_by<T>(&self, value: impl Fn(usize) -> T) -> T
    where
        T: Copy + std::ops::Add<Output = T> + std::ops::Mul<f64, Output = T>,
    {
        let [a, b, c, d] = self.at.map(|at| value(at as usize));
        let [p, q, r, s] = self.weight;
        (a * p + b * q) + (c * r + d * s)
    }

    /// The grid vertex of the greatest weight, the first of equals.
    pub(super) fn nearest(&self) -> u32 {
        let mut best = 0;
        for k in 1..4 {
            if self.weight[k] > self.weight[best] {
                best = k;
            }
        }
        self.at[best]
    }
}

/// A component vertex over a grid of known side.
#[derive(Debug, Clone, Copy)]
pub(super) struct BasisPoint {
    /// Weights at (u, v).
    pub(super) place: Weights,
    /// Weights at (u', v').
    pub(super) direction: Weights,
    pub(super) uv: DVec2,
    /// w, times everything that is constant over the array.
    pub(super) height: f64,
}

/// Basis points of all vertices of a component over grids of one side.
pub(super) struct Basis {
    pub(super) component: u32,
    pub(super) side: u32,
    pub(super) points: Vec<BasisPoint>,
    /// The same weights and heights, each in a row of its own.
    pub(super) rows: Rows,
}

impl Basis {
    pub(super) fn new(pieces: &[Piece], component: u32, side: u32, factor: f64) -> Self {
        let piece = &pieces[component as usize];
        let vertices = piece.mesh.positions().iter().zip(&piece.normal_uv);
        let points = vertices.map(|(p, &normal_uv)| BasisPoint {
            place: Weights::new(p.truncate(), side),
            direction: Weights::new(normal_uv, side),
            uv: p.truncate(),
            height: p.z * factor,
        });
        let points: Vec<_> = points.collect();
        Self {
            component,
            side,
            rows: Rows::new(&points),
            points,
        }
    }
}

/// [`BasisPoint`]s for loops over many of them: what is of one kind in one row.
pub(super) struct Rows {
    pub(super) place: WeightRows,
    pub(super) direction: WeightRows,
    pub(super) height: Vec<f64>,
}

impl Rows {
    fn new(points: &[BasisPoint]) -> Self {
        Self {
            place: WeightRows::new(points.iter().map(|point| &point.place)),
            direction: WeightRows::new(points.iter().map(|point| &point.direction)),
            height: points.iter().map(|point| point.height).collect(),
        }
    }
}

/// The [`Weights`] of all points of a component.
pub(super) struct WeightRows {
    at: [Vec<u32>; 4],
    weight: [Vec<f64>; 4],
}

impl WeightRows {
    fn new<'a>(weights: impl Iterator<Item = &'a Weights> + Clone) -> Self {
        Self {
            at: std::array::from_fn(|k| weights.clone().map(|w| w.at[k]).collect()),
            weight: std::array::from_fn(|k| weights.clone().map(|w| w.weight[k]).collect()),
        }
    }

    /// [`Weights::sum_by`] of the points from `first` on, one for each slot, of `N`
    /// values at each place: they go through the weights together.
    #[inline(always)]
    pub(super) fn sum<const N: usize>(
        &self,
        first: usize,
        values: [&[f64]; N],
        mut out: [&mut [f64]; N],
    ) {
        let Some(count) = out.first().map(|row| row.len()) else {
            return;
        };
        for row in &mut out {
            *row = &mut std::mem::take(row)[..count];
        }
        let [p, q, r, s] = part(&self.weight, first, count);
        // A grid of a single face has the same four values for all points.
        if values.iter().all(|values| values.len() == 4) {
            let mut corners = [[0.0; 4]; N];
            for (corners, values) in corners.iter_mut().zip(values) {
                corners.copy_from_slice(values);
            }
            for k in 0..count {
                for n in 0..N {
                    let [a, b, c, d] = corners[n];
                    out[n][k] = (a * p[k] + b * q[k]) + (c * r[k] + d * s[k]);
                }
            }
            return;
        }
        let at = part(&self.at, first, count);
        for k in 0..count {
            for n in 0..N {
                let value = |corner: usize| values[n][at[corner][k] as usize];
                let (a, b, c, d) = (value(0), value(1), value(2), value(3));
                out[n][k] = (a * p[k] + b * q[k]) + (c * r[k] + d * s[k]);
            }
        }
    }
}

/// The same part of four rows. Written one by one: the closure of a `map` would
/// not be compiled for wide vectors.
#[inline(always)]
fn part<T>([a, b, c, d]: &[Vec<T>; 4], first: usize, count: usize) -> [&[T]; 4] {
    let end = first + count;
    [
        &a[first..end],
        &b[first..end],
        &c[first..end],
        &d[first..end],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn weights_reproduce_the_place(u in -1.0..2.0f64, v in -1.0..2.0f64, side in 1u32..9) {
            let weights = Weights::new(DVec2::new(u, v), side);
            let grid: Vec<DVec2> = (0..=side)
                .flat_map(|j| (0..=side).map(move |i| DVec2::new(i.into(), j.into())))
                .map(|place| place / f64::from(side))
                .collect();
            prop_assert!((weights.sum_by(|at| grid[at]) - DVec2::new(u, v)).length() < 1e-12);
            prop_assert!((weights.weight.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn grid_vertices_have_all_the_weight() {
        for side in 1..=8u32 {
            for (i, j) in (0..=side).flat_map(|j| (0..=side).map(move |i| (i, j))) {
                // Sides that are powers of two divide exactly.
                if side.is_power_of_two() {
                    let n = f64::from(side);
                    let uv = DVec2::new(f64::from(i) / n, f64::from(j) / n);
                    let weights = Weights::new(uv, side);
                    assert_eq!(weights.nearest(), j * (side + 1) + i);
                    assert!(weights.weight.contains(&1.0));
                }
            }
        }
    }
}
