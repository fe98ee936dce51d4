//! Fields computed from a mesh: random, by size, by distance, by curvature.

mod area;
mod curvature;
mod distance;
mod jet;
mod max_offset;

pub(crate) use area::vertex_means;
pub use area::{face_areas, mean_face_areas};
pub use curvature::{Curvature, curvature};
pub use distance::{distances_to_points, distances_to_surface, places};
pub use max_offset::{MaxOffset, max_offset};

use crate::mesh::Domain;
use crate::random::uniform;
use crate::{Field, GeometryError, Mesh, Quantity};

/// Random numbers between `low` and `high`, one per element of `domain`.
///
/// Each depends on the seed and the element's number alone, so other elements
/// may come and go. Cost: O(elements).
///
/// # Errors
/// [`GeometryError::OutOfRange`] where `low` is not finite and not below `high`
/// or equal to it; those of [`Field::new`].
pub fn random(
    mesh: &Mesh,
    domain: Domain,
    seed: u64,
    low: f64,
    high: f64,
) -> Result<Field, GeometryError> {
    if !(low <= high && (high - low).is_finite()) {
        return Err(GeometryError::OutOfRange {
            what: "the smallest random number",
            value: low,
            requirement: "it must be finite and not above the largest",
        });
    }
    let count = mesh.element_count(domain);
    let one = |index: usize| low + (high - low) * uniform(seed, index as i64);
    Field::new(domain, Quantity::Number, (0..count).map(one).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::grid;

    #[test]
    fn random_numbers_fill_their_range_and_depend_on_the_seed() {
        let mesh = grid(60, 60, |x, y| [x, y, 0.0]);
        let field = random(&mesh, Domain::Face, 3, -2.0, 4.0).unwrap();
        let values = field.values();
        assert!(values.iter().all(|value| (-2.0..4.0).contains(value)));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        assert!((mean - 1.0).abs() < 0.1, "{mean}");
        let other = random(&mesh, Domain::Face, 4, -2.0, 4.0).unwrap();
        let equal = values
            .iter()
            .zip(other.values().iter())
            .filter(|(a, b)| a.total_cmp(b).is_eq());
        assert_eq!(equal.count(), 0);
        let smaller = random(&grid(2, 2, |x, y| [x, y, 0.0]), Domain::Face, 3, -2.0, 4.0).unwrap();
        assert_eq!(smaller.values()[..], values[..4]);
        assert!(random(&mesh, Domain::Face, 3, 1.0, 0.0).is_err());
    }
}
