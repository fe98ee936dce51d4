//! The mapping itself: X = P(u, v) + w s k D(u', v').

use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DVec2, DVec3};

use super::basis::Basis;
use super::layout::Layout;
use super::patch::Patch;
use super::{ArrayOptions, Interpolation, Piece, is_relative};
use crate::fields::vertex_means;
use crate::mesh::are_finite;
use crate::normals::{NormalWeights, vertex_normals};
use crate::vectors::widened;
use crate::{Amount, Directions, Domain, GeometryError, Mesh, Monitor, math, parallel};

/// A point of the array about to be displaced.
#[derive(Debug, Clone, Copy, Default)]
pub struct ArrayPoint {
    /// Its vertex in the array, before neighbours are joined.
    pub vertex: u32,
    /// The base face (or parent) it is over.
    pub face: u32,
    /// Its place on that face.
    pub uv: DVec2,
    /// Signed height w s k in metres: how far it should be from the surface.
    pub height: f64,
    /// P(u, v), on the base surface.
    pub position: DVec3,
    /// Unit normal of the base at (u, v), interpolated from its vertices; zero
    /// unless the displacement compensates.
    pub normal: DVec3,
    /// D(u', v') of its side; of unit length for normals, zero where there is none.
    pub direction: DVec3,
}

/// Decides how far a point of the array moves along its direction.
pub trait Displace: Sync {
    /// The signed height h to use: the point goes to `position + h direction`.
    ///
    /// Called once for every point, from many threads in no particular order;
    /// the answer must depend on `point` alone.
    fn height(&self, point: &ArrayPoint) -> f64;

    /// Whether this makes up for slanted directions: then it gets normals, and
    /// directions which are compensated already must not be used.
    fn compensates(&self) -> bool {
        true
    }
}

/// Moves every point by its height along the direction as it is.
#[derive(Debug, Clone, Copy, Default)]
pub struct Straight;

impl Displace for Straight {
    #[inline]
    fn height(&self, point: &ArrayPoint) -> f64 {
        point.height
    }

    fn compensates(&self) -> bool {
        false
    }
}

/// Base and components, prepared for the loop over all output vertices.
pub(super) struct Map<'a> {
    pub(super) base: &'a Mesh,
    pub(super) layout: &'a Layout<'a>,
    pub(super) bases: Vec<Basis>,
    /// The basis of each placement.
    pub(super) basis_of: Vec<u32>,
    pub(super) outward: Vectors,
    /// `None` where both sides are the same.
    pub(super) inward: Option<Vectors>,
    /// sqrt(A) per base vertex for relative heights.
    pub(super) size: Option<Vec<f64>>,
    /// Factors that vary over the base.
    pub(super) scale: Option<&'a Amount>,
    /// Vertex normals, where the displacement wants them.
    pub(super) normals: Option<Vec<DVec3>>,
}

/// Directions in the form that is interpolated.
pub(super) struct Vectors {
    /// Unit directions, or the vectors themselves without `lengths`.
    pub(super) directions: Vec<DVec3>,
    pub(super) lengths: Option<Vec<f64>>,
}

impl Vectors {
    fn new(vectors: &[DVec3], interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::Linear => Self {
                directions: vectors.to_vec(),
                lengths: None,
            },
            Interpolation::Unit => Self {
                directions: vectors.iter().copied().map(math::unit_or_zero).collect(),
                lengths: Some(vectors.iter().map(|vector| vector.length()).collect()),
            },
        }
    }
}

/// A sum of unit vectors made that long; zero where they cancel out.
#[inline]
pub(super) fn with_length(sum: DVec3, length: f64) -> DVec3 {
    // Only opposite ones come near zero.
    let now = sum.length();
    if now > CANCELLED {
        sum * (length / now)
    } else {
        DVec3::ZERO
    }
}

/// Unit directions whose interpolation is shorter have cancelled out.
pub(super) const CANCELLED: f64 = 1e-9;

impl<'a> Map<'a> {
    pub(super) fn new(
        base: &'a Mesh,
        directions: &Directions,
        pieces: &[Piece],
        layout: &'a Layout<'a>,
        options: &ArrayOptions<'a>,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        if let Some(scale) = options.scale {
            scale.check(base, Domain::Vertex)?;
            let (low, high) = scale.range();
            if !(low.is_finite() && high.is_finite()) {
                return Err(GeometryError::OutOfRange {
                    what: "the scale",
                    value: if low.is_finite() { high } else { low },
                    requirement: "it must be finite",
                });
            }
        }
        let relative = is_relative(options.height, directions);
        let size = relative.then(|| vertex_sizes(base, monitor)).transpose()?;
        let constant = match options.scale {
            Some(Amount::Constant(scale)) => *scale,
            _ => 1.0,
        };
        let (bases, basis_of) = make_bases(pieces, layout, |component, side| {
            let of_grid = if relative { f64::from(side) } else { 1.0 };
            pieces[component as usize].height_scale * of_grid * constant
        });
        let vectors = |side: &[DVec3]| Vectors::new(side, options.interpolation);
        Ok(Self {
            base,
            layout,
            bases,
            basis_of,
            outward: vectors(directions.outward()),
            inward: (!directions.is_symmetric()).then(|| vectors(directions.inward())),
            size,
            normals: None,
            scale: options
                .scale
                .filter(|scale| matches!(scale, Amount::Field(_))),
        })
    }

    /// The same with normals for displacements that want them.
    pub(super) fn with_normals(mut self, monitor: &dyn Monitor) -> Result<Self, GeometryError> {
        let weights = NormalWeights::Angle;
        self.normals = Some(vertex_normals(self.base, weights, true, monitor)?);
        Ok(self)
    }

    /// What heights are multiplied by at each vertex of the base, one by one.
    pub(super) fn factors(&self) -> Vec<Vec<f64>> {
        let vertices = 0..self.base.vertex_count();
        let scale = self
            .scale
            .map(|scale| vertices.map(|v| scale.at(v)).collect());
        self.size.clone().into_iter().chain(scale).collect()
    }

    /// The directions of both sides, the second where it is another.
    pub(super) fn into_vectors(self) -> (Vectors, Option<Vectors>) {
        (self.outward, self.inward)
    }

    /// Positions of all output vertices, before neighbours are joined; all of
    /// them are finite.
    pub(super) fn positions<D: Displace + ?Sized>(
        &self,
        displace: &D,
        monitor: &dyn Monitor,
    ) -> Result<Vec<DVec3>, GeometryError> {
        let starts = &self.layout.vertex_starts;
        let count = starts.last().map_or(0, |&count| count as usize);
        let mut out: Vec<DVec3> = parallel::zeroed(count);
        let overflows = AtomicBool::new(false);
        parallel::fill_runs(
            &mut out,
            starts,
            monitor,
            Patch::default,
            |patch, run, slots| {
                patch.gather(self, run);
                let basis = &self.bases[self.basis_of[run] as usize];
                let first = ArrayPoint {
                    vertex: starts[run],
                    face: self.layout.placements[run].cell,
                    ..ArrayPoint::default()
                };
                widened(
                    #[inline(always)]
                    || {
                        patch.place(basis, first, displace, slots);
                        if !are_finite(slots) {
                            overflows.store(true, Ordering::Relaxed);
                        }
                    },
                );
            },
        )?;
        if overflows.into_inner()
            && let Some(vertex) = out.iter().position(|point| !point.is_finite())
        {
            return Err(GeometryError::NonFiniteVertex { vertex });
        }
        Ok(out)
    }
}

/// One basis for each component and side of grid in use, and which of them
/// each placement has.
fn make_bases(
    pieces: &[Piece],
    layout: &Layout<'_>,
    factor: impl Fn(u32, u32) -> f64,
) -> (Vec<Basis>, Vec<u32>) {
    let mut bases: Vec<Basis> = Vec::new();
    let mut basis_of = Vec::with_capacity(layout.placements.len());
    for (index, placement) in layout.placements.iter().enumerate() {
        let (component, side) = (placement.component, layout.side(index));
        let same = |basis: &Basis| (basis.component, basis.side) == (component, side);
        // Neighbours mostly share their basis, and there are few of them.
        let last = basis_of
            .last()
            .copied()
            .filter(|&last: &u32| same(&bases[last as usize]));
        let found = last.or_else(|| bases.iter().position(same).map(|k| k as u32));
        basis_of.push(found.unwrap_or_else(|| {
            bases.push(Basis::new(pieces, component, side, factor(component, side)));
            bases.len() as u32 - 1
        }));
    }
    (bases, basis_of)
}

/// sqrt(A) per vertex, A the mean area of the faces round it; 0 without faces.
fn vertex_sizes(base: &Mesh, monitor: &dyn Monitor) -> Result<Vec<f64>, GeometryError> {
    let mut sizes = vertex_means(base, monitor)?;
    sizes.iter_mut().for_each(|size| *size = size.sqrt());
    Ok(sizes)
}
