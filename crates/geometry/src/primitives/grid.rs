//! A flat grid of quads.

use glam::{DVec2, DVec3};

use super::{check_size, parametric_surface, quad_bytes};
use crate::{GeometryError, Mesh, Unmonitored};

/// A flat grid of quads in the xy plane, facing up, with a corner attribute `uv`.
///
/// `cells` along x and y, `size` in metres. The lowest corner is at the origin,
/// or the middle is if `center`. Vertices and faces are in rows, x fastest; u
/// runs along x, v along y. Cost: O(cells).
///
/// # Errors
/// [`GeometryError::OutOfRange`] without cells or for a size that is not above
/// 0; [`GeometryError::TooMany`] before anything is allocated.
///
/// ```
/// use tessgraph_geometry::{glam::DVec2, primitives::grid};
/// let roof = grid([8, 4], DVec2::new(16.0, 8.0), true)?;
/// assert_eq!((roof.vertex_count(), roof.face_count()), (45, 32));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn grid(cells: [usize; 2], size: DVec2, center: bool) -> Result<Mesh, GeometryError> {
    check_size("the size of the grid", &size.to_array())?;
    let shift = if center { 0.5 } else { 0.0 };
    let place = |u: f64, v: f64| DVec3::new((u - shift) * size.x, (v - shift) * size.y, 0.0);
    parametric_surface(cells, [false, false], place, &Unmonitored)
}

/// Bytes that [`grid`] takes for its result, to ask for before it is made.
pub fn grid_bytes(cells: [usize; 2]) -> u128 {
    let [x, y] = cells.map(|count| count as u128);
    quad_bytes((x + 1).saturating_mul(y + 1), x.saturating_mul(y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{AttributeValues, Domain};

    #[test]
    fn rows_run_along_x_and_face_up() {
        let mesh = grid([3, 2], DVec2::new(6.0, 2.0), false).expect("valid");
        assert_eq!(mesh.positions()[5], DVec3::new(2.0, 1.0, 0.0));
        assert_eq!(mesh.face(4), [5, 6, 10, 9]);
        let normals = crate::normals::face_normals(&mesh, &Unmonitored).expect("not cancelled");
        assert!(normals.iter().all(|&normal| normal == DVec3::Z));
    }

    #[test]
    fn centre_is_the_origin() {
        let mesh = grid([2, 2], DVec2::new(6.0, 2.0), true).expect("valid");
        let bounds = (DVec3::new(-3.0, -1.0, 0.0), DVec3::new(3.0, 1.0, 0.0));
        assert_eq!(mesh.bounds(), Some(bounds));
    }

    #[test]
    fn uv_spans_the_unit_square() {
        let mesh = grid([2, 1], DVec2::ONE, false).expect("valid");
        let uv = mesh.attribute("uv", Domain::Corner).expect("has uv");
        let AttributeValues::Vector2(uv) = uv.values() else {
            panic!("uv holds {}s", uv.values().type_name());
        };
        let second = [(0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0)].map(DVec2::from);
        assert_eq!(uv[4..], second);
    }

    #[test]
    fn impossible_grids_are_refused() {
        let size = DVec2::ONE;
        assert!(matches!(
            grid([usize::MAX, 100_000], size, false),
            Err(GeometryError::TooMany { .. })
        ));
        assert!(matches!(
            grid([0, 1], size, false),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            grid([1, 1], DVec2::new(1.0, f64::NAN), false),
            Err(GeometryError::OutOfRange { .. })
        ));
    }
}
