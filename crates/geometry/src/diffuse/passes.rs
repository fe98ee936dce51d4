//! The explicit schemes: pass after pass over the neighbours.

use glam::DVec3;

use super::side::Cones;
use super::stencil::Stencil;
use crate::math::unit_or_zero;
use crate::monitor::Quiet;
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
        parallel::fill(&mut next, &Quiet(monitor), |vertex, out| {
            let own = field[vertex];
            let k = share(vertex);
            let blend = match sum_of(stencil, vertex, &field) {
                // Times the total weight, as only the sense of the blend counts.
                Some((sum, total)) if k > 0.0 => {
                    let blend = own * ((1.0 - k) * total) + sum * k;
                    match unit {
                        true => unit_or(blend, own),
                        false => blend / total,
                    }
                }
                _ => own,
            };
            *out = match cones {
                Some(cones) => cones.limit(vertex, blend),
                None => blend,
            };
        })?;
        std::mem::swap(&mut field, &mut next);
        monitor.progress(u64::from(pass) + 1, u64::from(iterations));
    }
    Ok(field)
}

/// The weighted sum of the neighbours and their weights' total; `None` where
/// no neighbour counts.
#[inline]
fn sum_of(stencil: &Stencil, vertex: usize, field: &[DVec3]) -> Option<(DVec3, f64)> {
    let (neighbours, weights) = stencil.row(vertex);
    let mut sum = DVec3::ZERO;
    if weights.is_empty() {
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

/// `vector` at unit length, or `otherwise` where it vanishes.
#[inline]
fn unit_or(vector: DVec3, otherwise: DVec3) -> DVec3 {
    let squared = vector.length_squared();
    if squared > VANISHED {
        vector * (1.0 / squared.sqrt())
    } else {
        otherwise
    }
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
