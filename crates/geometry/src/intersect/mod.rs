//! Faces of a mesh that cross each other, found by exact predicates.

mod filter;
mod hinge;
mod polygon;
mod predicate;
mod sieve;
#[cfg(test)]
mod tests;

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::array::PANEL;
use crate::measure::pieces_of_faces;
use crate::mesh::{AttributeValues, Domain};
use crate::parallel::{self, in_order};
use crate::surface::BoxTree;
use crate::weld::clusters;
use crate::{Field, GeometryError, Mesh, Monitor, Quantity};
use polygon::{Polygon, Relation, relation};
use sieve::Sieve;

/// Which pairs of faces are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Between {
    /// Faces of different components.
    Components,
    /// Faces of one component.
    Inside,
    /// All faces.
    #[default]
    All,
}

/// Settings of [`intersections`].
#[derive(Debug, Clone, Copy, Default)]
pub struct IntersectOptions {
    /// Which pairs are looked at.
    pub between: Between,
    /// Crossings not deeper or not longer than this are contacts, in metres;
    /// 0 for exact. `None` for 10⁻⁶ of the bounding box's diagonal.
    pub tolerance: Option<f64>,
}

/// Faces that cross or touch.
#[derive(Debug, Clone)]
pub struct Intersections {
    /// Pairs of faces whose insides cross, the lower first, ascending.
    pub pairs: Vec<[u32; 2]>,
    /// Pairs of faces that touch, coincide or overlap in one plane, and that are
    /// not neighbours with nothing but a vertex or edge in common.
    pub contacts: Vec<[u32; 2]>,
    /// Pairs of different components with faces that cross, ascending; numbered
    /// from 0 by their first face.
    pub component_pairs: Vec<[u32; 2]>,
    /// How many components there are.
    pub components: usize,
    /// Faces in at least one of `pairs`, ascending.
    pub faces: Vec<u32>,
    /// How many others each face crosses.
    pub field: Field,
    /// The tolerance that was used, in metres.
    pub tolerance: f64,
}

/// Coordinates up to here keep the exact predicates from overflowing.
const LARGEST: f64 = 1e75;

/// Share of the bounding box's diagonal that is the tolerance left out.
const TOLERANCE: f64 = 1e-6;

/// Finds the pairs of faces whose insides cross.
///
/// A polygon above a triangle has no one surface, so a pair counts only if it
/// crosses under each choice of both polygons' diagonals: the fans from corners
/// 0 and 1. A crossing not deeper than the tolerance, or whose segment is not
/// longer, is a contact; its depth is the least distance that would separate
/// the two triangles along the normal of either. Touching and coincident faces
/// and those that overlap in one plane are contacts. Neighbours that only share
/// a vertex or an edge are neither; a face folded over exactly onto its
/// neighbour crosses it. Vertices at equal positions count as one, so a mesh
/// need not be welded.
///
/// A component is a panel where the faces have integer attribute [`PANEL`],
/// else a connected piece.
///
/// Signs are exact (Shewchuk 1997, triangles as in Guigue and Devillers 2003);
/// depth and length are floating point. Triangles without area meet nothing.
/// Cost: O(faces · log faces + pairs of faces whose boxes meet).
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored, intersect::intersections};
/// let crossed = Mesh::from_faces(
///     vec![[0., 0., 0.], [4., 0., 0.], [0., 4., 0.], [1., 1., -1.], [1., 1., 1.], [9., 9., 1.]],
///     &[[0, 1, 2], [3, 4, 5]],
/// )?;
/// let found = intersections(&crossed, &Default::default(), &Unmonitored)?;
/// assert_eq!(found.pairs, [[0, 1]]);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::OutOfRange`] for a negative tolerance or coordinates above
/// 10⁷⁵, [`GeometryError::Cancelled`].
pub fn intersections(
    mesh: &Mesh,
    options: &IntersectOptions,
    monitor: &dyn Monitor,
) -> Result<Intersections, GeometryError> {
    let tolerance = options.tolerance.unwrap_or(mesh.diagonal() * TOLERANCE);
    check(mesh, tolerance)?;
    let (component, components) = components(mesh, monitor)?;
    let mut found = Found::default();
    if mesh.face_count() > 0 {
        let same = |a: u32, b: u32| component[a as usize] == component[b as usize];
        found = search(
            mesh,
            #[inline(always)]
            |a, b| match options.between {
                Between::Components => !same(a, b),
                Between::Inside => same(a, b),
                Between::All => true,
            },
            tolerance,
            monitor,
        )?;
    }
    let mut component_pairs: Vec<[u32; 2]> = found
        .pairs
        .iter()
        .map(|pair| pair.map(|face| component[face as usize]))
        .filter(|[a, b]| a != b)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    component_pairs.sort_unstable();
    component_pairs.dedup();
    let mut counts = vec![0.0; mesh.face_count()];
    for &face in found.pairs.iter().flatten() {
        counts[face as usize] += 1.0;
    }
    let faces = (0..mesh.face_count() as u32)
        .filter(|&face| counts[face as usize] > 0.0)
        .collect();
    Ok(Intersections {
        pairs: found.pairs,
        contacts: found.contacts,
        component_pairs,
        components,
        faces,
        field: Field::new(Domain::Face, Quantity::Number, counts)?,
        tolerance,
    })
}

fn check(mesh: &Mesh, tolerance: f64) -> Result<(), GeometryError> {
    if !(tolerance >= 0.0 && tolerance.is_finite()) {
        return Err(GeometryError::OutOfRange {
            what: "the tolerance",
            value: tolerance,
            requirement: "it must be finite and not negative",
        });
    }
    let largest = |largest: f64, place: &DVec3| largest.max(place.abs().max_element());
    let largest = mesh.positions().iter().fold(0.0, largest);
    if largest > LARGEST {
        return Err(GeometryError::OutOfRange {
            what: "the largest coordinate",
            value: largest,
            requirement: "exact intersections need it below 1e75",
        });
    }
    Ok(())
}

/// The component of each face, numbered by first face, and how many there are:
/// the panels of face attribute [`PANEL`], else the connected pieces.
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub(crate) fn components(
    mesh: &Mesh,
    monitor: &dyn Monitor,
) -> Result<(Vec<u32>, usize), GeometryError> {
    let panels = mesh.attribute(PANEL, Domain::Face).map(|a| a.values());
    match panels {
        Some(AttributeValues::Integer(panels)) => number(panels, monitor),
        _ => {
            let pieces = pieces_of_faces(mesh.topology(), monitor)?;
            number_few(&pieces, mesh.vertex_count(), monitor)
        }
    }
}

/// Equal names below `count` as equal numbers, from 0 in the order they first occur.
fn number_few(
    names: &[u32],
    count: usize,
    monitor: &dyn Monitor,
) -> Result<(Vec<u32>, usize), GeometryError> {
    let mut number_of = vec![u32::MAX; count];
    let (mut numbers, mut next) = (vec![0; names.len()], 0);
    in_order(names.len(), monitor, |index| {
        let number = &mut number_of[names[index] as usize];
        if *number == u32::MAX {
            *number = next;
            next += 1;
        }
        numbers[index] = *number;
    })?;
    Ok((numbers, next as usize))
}

/// [`number_few`] for any names.
fn number(names: &[i64], monitor: &dyn Monitor) -> Result<(Vec<u32>, usize), GeometryError> {
    let mut order: Vec<u32> = (0..names.len() as u32).collect();
    parallel::sort_by_key(&mut order, monitor, |&index| (names[index as usize], index))?;
    let mut first = vec![0; names.len()];
    for run in order.chunk_by(|&a, &b| names[a as usize] == names[b as usize]) {
        for &index in run {
            first[index as usize] = run[0];
        }
    }
    let mut numbers = vec![0; names.len()];
    let mut count = 0;
    in_order(names.len(), monitor, |index| {
        if first[index] as usize == index {
            numbers[index] = count;
            count += 1;
        } else {
            numbers[index] = numbers[first[index] as usize];
        }
    })?;
    Ok((numbers, count as usize))
}

/// Pairs by relation.
#[derive(Debug, Default)]
struct Found {
    pairs: Vec<[u32; 2]>,
    contacts: Vec<[u32; 2]>,
}

/// Looks at all wanted pairs whose boxes meet.
fn search(
    mesh: &Mesh,
    wanted: impl Fn(u32, u32) -> bool + Sync,
    tolerance: f64,
    monitor: &dyn Monitor,
) -> Result<Found, GeometryError> {
    let places = clusters(mesh.positions(), 0.0, monitor)?;
    let places = parallel::map(mesh.corner_count(), monitor, |corner| {
        places[mesh.topology().corners()[corner] as usize]
    })?;
    let tree = BoxTree::new(&face_boxes(mesh, monitor)?, monitor)?;
    let parts = tree.parts();
    let done = AtomicU64::new(0);
    let found: Vec<Found> = parts
        .par_iter()
        .map(|&part| {
            monitor.check()?;
            let mut sieve = Sieve::new(mesh.positions());
            let of_face = |face: u32| &places[mesh.topology().corner_range(face as usize)];
            tree.walk(
                part,
                monitor,
                #[inline(always)]
                |met| {
                    for &[a, b] in met {
                        if wanted(a, b) {
                            sieve.take([a, b], [of_face(a), of_face(b)]);
                        }
                    }
                },
            )?;
            sieve.finish();
            let mut found = Found::default();
            for pair in sieve.doubtful {
                let [a, b] = pair.map(|face| Polygon::new(mesh, &places, face));
                match relation(&a, &b, tolerance) {
                    Relation::Apart => {}
                    Relation::Contact => found.contacts.push(pair),
                    Relation::Crossing => found.pairs.push(pair),
                }
            }
            let before = done.fetch_add(1, Ordering::Relaxed);
            monitor.progress(before + 1, parts.len() as u64);
            Ok(found)
        })
        .collect::<Result<_, GeometryError>>()?;
    let mut all = Found::default();
    for part in found {
        all.pairs.extend(part.pairs);
        all.contacts.extend(part.contacts);
    }
    all.pairs.par_sort_unstable();
    all.contacts.par_sort_unstable();
    Ok(all)
}

/// Lowest and highest corner of each face.
fn face_boxes(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Vec<[DVec3; 2]>, GeometryError> {
    parallel::map(mesh.face_count(), monitor, |face| {
        let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        mesh.face(face).iter().fold(none, |[low, high], &vertex| {
            let place = mesh.positions()[vertex as usize];
            [low.min(place), high.max(place)]
        })
    })
}
