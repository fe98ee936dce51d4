//! The explicit schemes: pass after pass over the neighbours.

use glam::DVec3;

use super::side::Cones;
use super::stencil::Stencil;
use crate::math::unit_or_zero;
use crate::monitor::Quiet;
use crate::vectors::widened;
use crate::{GeometryError, Mesh, Monitor, parallel};

/// Lowest valence at which the edge-sum scheme grows without bound at step 0.2.
///
/// A vertex of valence m has an eigenvalue of at least m + 1, and the scheme
/// is stable while step times eigenvalue is at most 2.
const DIVERGING_VALENCE: usize = 10;

/// Vertices at which [`super::Scheme::EdgeSum`] diverges at step 0.2: those of
/// valence 10 and more, ascending.
pub fn diverging_vertices(mesh: &Mesh) -> Vec<u32> {
    let adjacency = mesh.topology().adjacency();
    (0..mesh.vertex_count())
        .filter(|&vertex| adjacency.vertex_edges(vertex).len() >= DIVERGING_VALENCE)
        .map(|vertex| vertex as u32)
        .collect()
}

/// What the passes have in common.
pub(super) struct Rule<'a> {
    pub(super) iterations: u32,
    /// Whether directions are brought to unit length; else their lengths are
    /// diffused with them.
    pub(super) unit: bool,
    /// What directions are kept within.
    pub(super) cones: Option<&'a Cones<'a>>,
}

/// `iterations` times n <- normalize((1 - k) n + k mean), within the cones.
pub(super) fn mean(
    mut field: Vec<DVec3>,
    stencil: &Stencil,
    share: impl Fn(usize) -> f64 + Sync,
    rule: &Rule<'_>,
    monitor: &dyn Monitor,
) -> Result<Vec<DVec3>, GeometryError> {
    let &Rule {
        iterations,
        unit,
        cones,
    } = rule;
    if let (0, Some(cones)) = (iterations, cones) {
        return cones.limit_all(field, monitor);
    }
    let mut next = vec![DVec3::ZERO; field.len()];
    for pass in 0..iterations {
        let blend = |vertex: usize| blend(vertex, &field, stencil, share(vertex));
        parallel::fill_chunks(&mut next, &Quiet(monitor), |first, out| {
            if unit {
                widened(
                    #[inline(always)]
                    || unit_pass(first, out, &field, blend),
                );
            } else {
                for (vertex, out) in (first..).zip(out.iter_mut()) {
                    *out = blend(vertex).map_or(field[vertex], |(blend, total)| blend / total);
                }
            }
            if let Some(cones) = cones {
                for (vertex, out) in (first..).zip(out) {
                    *out = cones.limit(vertex, *out);
                }
            }
        })?;
        std::mem::swap(&mut field, &mut next);
        monitor.progress(u64::from(pass) + 1, u64::from(iterations));
    }
    Ok(field)
}

/// (1 - k) n + k mean times the neighbours' total weight, and that total; `None`
/// where nothing is blended.
#[inline(always)]
fn blend(vertex: usize, field: &[DVec3], stencil: &Stencil, share: f64) -> Option<(DVec3, f64)> {
    match sum_of(stencil, vertex, field) {
        Some((sum, total)) if share > 0.0 => {
            let blend = field[vertex] * ((1.0 - share) * total) + sum * share;
            Some((blend, total))
        }
        _ => None,
    }
}

/// Vertices whose blends are brought to unit length together: roots and
/// divisions side by side take little more time than one.
const BLOCK: usize = 16;

/// One pass over the vertices from `first` on, to unit length: of a blend only
/// its sense counts. One that vanishes leaves the direction as it is.
#[inline(always)]
fn unit_pass(
    first: usize,
    out: &mut [DVec3],
    field: &[DVec3],
    blend: impl Fn(usize) -> Option<(DVec3, f64)>,
) {
    for (block, out) in out.chunks_mut(BLOCK).enumerate() {
        let first = first + block * BLOCK;
        let own = &field[first..first + out.len()];
        let [mut x, mut y, mut z] = [[0.0; BLOCK]; 3];
        for k in 0..own.len() {
            let blend = blend(first + k).map_or(DVec3::ZERO, |(blend, _)| blend);
            [x[k], y[k], z[k]] = blend.to_array();
        }
        let mut scale = [0.0; BLOCK];
        for (k, scale) in scale.iter_mut().enumerate() {
            let squared = x[k] * x[k] + y[k] * y[k] + z[k] * z[k];
            *scale = if squared > VANISHED {
                1.0 / squared.sqrt()
            } else {
                0.0
            };
        }
        for (k, (out, &own)) in out.iter_mut().zip(own).enumerate() {
            *out = if scale[k] > 0.0 {
                DVec3::new(x[k], y[k], z[k]) * scale[k]
            } else {
                own
            };
        }
    }
}

/// The weighted sum of the neighbours and their weights' total; `None` where
/// no neighbour counts.
#[inline(always)]
fn sum_of(stencil: &Stencil, vertex: usize, field: &[DVec3]) -> Option<(DVec3, f64)> {
    let (neighbours, weights) = stencil.row(vertex);
    let mut sum = DVec3::ZERO;
    if weights.is_empty() {
        if let &[a, b, c, d] = neighbours {
            // The usual valence, without a loop.
            let [a, b, c, d] = [a, b, c, d].map(|neighbour| field[neighbour as usize]);
            return Some((sum + a + b + c + d, 4.0));
        }
        for &neighbour in neighbours {
            sum += field[neighbour as usize];
        }
        return (!neighbours.is_empty()).then_some((sum, neighbours.len() as f64));
    }
    let mut total = 0.0;
    for (&neighbour, &weight) in neighbours.iter().zip(weights) {
        sum += field[neighbour as usize] * weight;
        total += weight;
    }
    (total > NONE).then_some((sum, total))
}

/// Weights that add up to less are the rounding of coordinates.
const NONE: f64 = 1e-9;

/// Squared sums of unit vectors below this are the rounding of a cancellation.
const VANISHED: f64 = 1e-24;

/// Passes between two looks at the magnitude, which grows at most by
/// 1 + 2 · valence in each, below 2^33.
const PASSES_PER_LOOK: u32 = 8;

/// `iterations` times n <- n + k sum (n_j - n), then to unit length if `unit`.
///
/// Every step is linear, so where the field grows it may be multiplied by a
/// power of two as a whole without changing a bit of the outcome: it never
/// overflows, however far it diverges.
pub(super) fn edge_sum(
    start: Vec<DVec3>,
    stencil: &Stencil,
    share: impl Fn(usize) -> f64 + Sync,
    rule: &Rule<'_>,
    monitor: &dyn Monitor,
) -> Result<Vec<DVec3>, GeometryError> {
    let &Rule {
        iterations, unit, ..
    } = rule;
    let mut field = start.clone();
    let mut next = vec![DVec3::ZERO; field.len()];
    for pass in 0..iterations {
        parallel::fill(&mut next, &Quiet(monitor), |vertex, out| {
            let own = field[vertex];
            let (neighbours, weights) = stencil.row(vertex);
            let mut sum = DVec3::ZERO;
            if weights.is_empty() {
                for &neighbour in neighbours {
                    sum += field[neighbour as usize] - own;
                }
            } else {
                for (&neighbour, &weight) in neighbours.iter().zip(weights) {
                    sum += (field[neighbour as usize] - own) * weight;
                }
            }
            *out = own + sum * share(vertex);
        })?;
        std::mem::swap(&mut field, &mut next);
        if unit && pass % PASSES_PER_LOOK == 0 {
            shrink(&mut field);
        }
        monitor.progress(u64::from(pass) + 1, u64::from(iterations));
    }
    if !unit {
        return Ok(field);
    }
    for (vector, &start) in field.iter_mut().zip(&start) {
        let unit = unit_or_zero(*vector);
        *vector = if unit == DVec3::ZERO { start } else { unit };
    }
    Ok(field)
}

/// Multiplies the field by 2^-512 once it is larger than 2^512.
fn shrink(field: &mut [DVec3]) {
    let large = f64::from_bits((1023 + 512) << 52);
    let largest = field.iter().fold(0.0, |largest: f64, vector| {
        largest.max(vector.abs().max_element())
    });
    if largest > large {
        field.iter_mut().for_each(|vector| *vector /= large);
    }
}
