//! Smooth normals: diffusion of a direction field over the mesh (§3.1).

mod implicit;
mod passes;
mod side;
mod stencil;
#[cfg(test)]
mod tests;

use glam::DVec3;

pub use passes::diverging_vertices;
pub use side::{Inverted, inverted};
pub use stencil::{Anisotropy, Grain};

use crate::math::unit_or_zero;
use crate::mesh::Domain;
use crate::{Amount, Directions, GeometryError, Mesh, Monitor};
use side::Cones;
use stencil::Stencil;

/// Which vertices a vertex is averaged with, and how much each counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Laplacian {
    /// Neighbours over mesh edges, all alike.
    #[default]
    Uniform,
    /// Neighbours over edges of [`Mesh::triangles`], weighted by
    /// (cot α + cot β) / 2 of the angles opposite (Pinkall and Polthier 1993);
    /// negative weights count as 0. Depends less on how the mesh is cut.
    Cotangent,
}

/// How long diffused directions are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Lengths {
    /// One.
    #[default]
    Unit,
    /// As long as at the start, each vertex its own: only senses are diffused.
    Keep,
    /// Diffused together with their senses, as vectors: those of opposite
    /// directions cancel.
    Diffuse,
}

/// How directions are diffused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// n_i <- normalize((1 - k_i) n_i + k_i mean_j n_j), k_i = diffusion ·
    /// weight_i, `iterations` times. Stable for every mesh.
    Mean {
        /// Passes; n then m of them are n + m.
        iterations: u32,
        /// Share of the neighbours' mean, 0..=1. At 1 a checkerboard on a quad
        /// grid never fades.
        diffusion: f64,
        /// Which neighbours.
        laplacian: Laplacian,
    },
    /// n_i <- n_i + step · weight_i · sum_j (n_j - n_i) over mesh edges,
    /// normalised after the last pass only: the step of a public add-on.
    /// Grows without bound at vertices that [`diverging_vertices`] names.
    EdgeSum {
        /// Passes.
        iterations: u32,
        /// Share of each difference, 0..=1; that add-on's is 0.2.
        step: f64,
        /// Turns a result round that points against the vertex normal.
        flip_inverted: bool,
    },
    /// (M + distance² C) n = M n0, M the vertices' barycentric areas and C the
    /// cotangent stiffness: one implicit step of heat flow. The same spread on
    /// a coarse and a fine mesh, stable for every distance.
    Implicit {
        /// Length in metres over which directions spread.
        distance: f64,
    },
}

impl Default for Scheme {
    fn default() -> Self {
        Self::Mean {
            iterations: 10,
            diffusion: 0.5,
            laplacian: Laplacian::Uniform,
        }
    }
}

/// Settings of [`diffuse`].
#[derive(Debug, Clone)]
pub struct DiffuseOptions<'a> {
    /// How directions are diffused.
    pub scheme: Scheme,
    /// Per vertex 0..=1: 0 keeps its direction, 1 diffuses it fully.
    pub weights: Amount,
    /// Prefers neighbours along or across a grain; for neighbours over mesh
    /// edges only.
    pub anisotropy: Option<Anisotropy<'a>>,
    /// Keeps every direction in front of all faces round its vertex.
    pub keep_side: bool,
    /// How long the results are.
    pub lengths: Lengths,
}

impl Default for DiffuseOptions<'_> {
    fn default() -> Self {
        Self {
            scheme: Scheme::default(),
            weights: Amount::Constant(1.0),
            anisotropy: None,
            keep_side: false,
            lengths: Lengths::Unit,
        }
    }
}

/// Diffuses `start` over `mesh` (§3.1): directions whose lines cross less, of unit
/// length unless [`Lengths`] say otherwise.
///
/// Isolated vertices keep their vectors; a vertex of a face that starts
/// without direction takes its neighbours'. Where neighbours cancel a
/// direction exactly it stays. Cost: O(edges · iterations); for `Implicit`
/// O(edges · distance / edge length).
///
/// ```
/// use tessgraph_geometry::diffuse::{DiffuseOptions, diffuse};
/// use tessgraph_geometry::{DirectionSource, Directions, Mesh, Unmonitored, glam::DVec3};
/// let quad = Mesh::from_faces(
///     vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
///     &[[0, 1, 2, 3]],
/// )?;
/// let mut vectors = vec![DVec3::Z; 4];
/// vectors[0] = DVec3::new(0.6, 0.0, 0.8);
/// let start = Directions::new(&quad, vectors, DirectionSource::Surface)?;
/// let smooth = diffuse(&quad, &start, &DiffuseOptions::default(), &Unmonitored)?;
/// assert!(smooth.outward()[0].x < 0.3 && smooth.outward()[2].x > 0.1);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::Compensated`], [`GeometryError::OtherTopology`],
/// [`GeometryError::OutOfRange`] for settings and weights, the errors of
/// [`Amount::check`]; [`GeometryError::NoAttribute`] for a missing layer,
/// [`GeometryError::NonFiniteValue`] where `EdgeSum` lets lengths grow beyond the
/// range of numbers,
/// [`GeometryError::NoConvergence`] from `Implicit`, [`GeometryError::Cancelled`].
pub fn diffuse(
    mesh: &Mesh,
    start: &Directions,
    options: &DiffuseOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Directions, GeometryError> {
    check(mesh, start, options)?;
    mesh.topology().adjacency_with(monitor)?;
    let cones = if options.keep_side {
        Some(Cones::new(mesh, monitor)?)
    } else {
        None
    };
    let field = match options.lengths {
        Lengths::Diffuse => start.outward().to_vec(),
        Lengths::Unit | Lengths::Keep => start.outward().iter().map(|&v| unit_once(v)).collect(),
    };
    let field = by_scheme(mesh, field, options, cones.as_ref(), monitor)?;
    let field = match (&cones, options.scheme) {
        // `Mean` keeps the side in every pass.
        (Some(cones), Scheme::EdgeSum { .. } | Scheme::Implicit { .. }) => {
            cones.limit_all(field, monitor)?
        }
        _ => field,
    };
    let field = match options.lengths {
        Lengths::Keep => {
            let pairs = field.iter().zip(start.outward().iter());
            pairs.map(|(unit, start)| *unit * start.length()).collect()
        }
        Lengths::Unit | Lengths::Diffuse => field,
    };
    Directions::new(mesh, field, start.source())
}

/// The field after all passes, or the one step.
fn by_scheme(
    mesh: &Mesh,
    field: Vec<DVec3>,
    options: &DiffuseOptions<'_>,
    cones: Option<&Cones<'_>>,
    monitor: &dyn Monitor,
) -> Result<Vec<DVec3>, GeometryError> {
    let unit = options.lengths != Lengths::Diffuse;
    let (weights, anisotropy) = (&options.weights, options.anisotropy.as_ref());
    let rule = |iterations| passes::Rule {
        iterations,
        unit,
        cones,
    };
    Ok(match options.scheme {
        Scheme::Mean {
            iterations,
            diffusion,
            laplacian,
        } => {
            let stencil = match laplacian {
                Laplacian::Uniform => Stencil::edges(mesh, anisotropy)?,
                Laplacian::Cotangent => Stencil::cotangent(mesh),
            };
            let share = |vertex: usize| diffusion * weights.at(vertex);
            passes::mean(field, &stencil, share, &rule(iterations), monitor)?
        }
        Scheme::EdgeSum {
            iterations,
            step,
            flip_inverted,
        } => {
            let stencil = Stencil::edges(mesh, anisotropy)?;
            let share = |vertex: usize| step * weights.at(vertex);
            let mut field = passes::edge_sum(field, &stencil, share, &rule(iterations), monitor)?;
            if flip_inverted {
                side::flip(mesh, &mut field, monitor)?;
            }
            field
        }
        Scheme::Implicit { distance } => {
            let solved = implicit::solve(mesh, &field, distance, weights, monitor)?;
            match unit {
                true => implicit::to_unit(solved, &field),
                false => solved,
            }
        }
    })
}

/// `vector` at unit length, but left alone where it is one up to rounding, so
/// that what one call gives is taken by the next as it is.
fn unit_once(vector: DVec3) -> DVec3 {
    if (vector.length_squared() - 1.0).abs() <= 1e-14 {
        vector
    } else {
        unit_or_zero(vector)
    }
}

fn check(
    mesh: &Mesh,
    start: &Directions,
    options: &DiffuseOptions<'_>,
) -> Result<(), GeometryError> {
    start.check(mesh)?;
    if start.is_compensated() {
        return Err(GeometryError::Compensated {
            operation: "SmoothNormals",
        });
    }
    options.weights.check(mesh, Domain::Vertex)?;
    let (low, high) = options.weights.range();
    // Of an empty field the range is inverted, and nothing is wrong.
    for weight in [low, high] {
        if mesh.vertex_count() > 0 {
            in_unit_range("the weight", weight)?;
        }
    }
    match options.scheme {
        Scheme::Mean { diffusion, .. } => in_unit_range("the diffusion", diffusion)?,
        Scheme::EdgeSum { step, .. } => in_unit_range("the step", step)?,
        Scheme::Implicit { distance } if !(distance >= 0.0 && distance.is_finite()) => {
            return Err(GeometryError::OutOfRange {
                what: "the distance",
                value: distance,
                requirement: "it must be finite and not negative",
            });
        }
        Scheme::Implicit { .. } => {}
    }
    let over_edges = matches!(
        options.scheme,
        Scheme::EdgeSum { .. }
            | Scheme::Mean {
                laplacian: Laplacian::Uniform,
                ..
            }
    );
    if options.anisotropy.is_some() && !over_edges {
        return Err(GeometryError::Invalid(
            "anisotropy weighs mesh edges; it needs the scheme Mean with the Laplacian \
             Uniform, or EdgeSum"
                .into(),
        ));
    }
    Ok(())
}

fn in_unit_range(what: &'static str, value: f64) -> Result<(), GeometryError> {
    if (0.0..=1.0).contains(&value) {
        return Ok(());
    }
    Err(GeometryError::OutOfRange {
        what,
        value,
        requirement: "it must be from 0 to 1",
    })
}
