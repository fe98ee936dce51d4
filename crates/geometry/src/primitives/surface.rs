//! Surfaces given by a function of u and v.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{UV, check_cells, check_counts, quad_bytes};
use crate::mesh::{Attribute, AttributeValues, Domain};
use crate::{GeometryError, Mesh, Monitor, Topology, parallel};

/// Quads on the surface `f(u, v)`, u and v in 0..=1, with a corner attribute `uv`.
///
/// `cells` along u and v. Where `closed` the last row of cells joins the first
/// and `f` is not asked for 1, so it should repeat there; open rows reach 1
/// exactly. Vertices and faces are in rows, u fastest; corner 0 of a face is its
/// lowest (u, v), its edge to corner 1 runs along u, to corner 3 along v, so the
/// normal is that of ∂f/∂u × ∂f/∂v. `uv` does not wrap: the cells at a seam end
/// at 1. Cost: one call of `f` per vertex, in parallel.
///
/// # Errors
/// [`GeometryError::NonFiniteSurface`] with the (u, v) where `f` is NaN or
/// infinite; [`GeometryError::OutOfRange`] with no cells, or fewer than 3 where
/// closed; [`GeometryError::TooMany`] and
/// [`GeometryError::OutOfMemory`] before anything is allocated;
/// [`GeometryError::Cancelled`].
///
/// ```
/// use tessgraph_geometry::{Unmonitored, glam::DVec3, math, primitives::parametric_surface};
/// let tube = |u: f64, v: f64| {
///     let angle = u * math::TAU;
///     DVec3::new(math::cos(angle), math::sin(angle), 5.0 * v)
/// };
/// let mesh = parametric_surface([32, 10], [true, false], tube, &Unmonitored)?;
/// assert_eq!(mesh.topology().boundary_loops().len(), 2);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn parametric_surface(
    cells: [usize; 2],
    closed: [bool; 2],
    f: impl Fn(f64, f64) -> DVec3 + Sync,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    for (count, closed) in cells.iter().zip(closed) {
        check_cells(&[*count], if closed { 3 } else { 1 })?;
    }
    let points = |k: usize| cells[k] as u128 + u128::from(!closed[k]);
    // Two counts below 2⁶⁵ may overflow even 128 bits only in theory.
    let vertices = points(0).saturating_mul(points(1));
    let faces = (cells[0] as u128).saturating_mul(cells[1] as u128);
    check_counts(vertices, faces)?;
    monitor.afford(quad_bytes(vertices, faces))?;
    let (columns, rows) = (points(0) as usize, points(1) as usize);
    let parameter = |k: usize, cell: usize| cell as f64 / cells[k] as f64;
    let positions = parallel::map(columns * rows, monitor, |k| {
        f(parameter(0, k % columns), parameter(1, k / columns))
    })?;
    if let Some(k) = positions.iter().position(|position| !position.is_finite()) {
        return Err(GeometryError::NonFiniteSurface {
            u: parameter(0, k % columns),
            v: parameter(1, k / columns),
        });
    }
    let faces = cells[0] * cells[1];
    let mut corners = vec![0u32; 4 * faces];
    let mut uv = vec![DVec2::ZERO; 4 * faces];
    let around = |face: usize| {
        let (i, j) = (face % cells[0], face / cells[0]);
        [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
    };
    parallel::fill_rows(
        &mut corners,
        4,
        monitor,
        || (),
        |(), face, out| {
            let vertex = |(i, j)| (j % rows * columns + i % columns) as u32;
            out.copy_from_slice(&around(face).map(vertex));
        },
    )?;
    parallel::fill_rows(
        &mut uv,
        4,
        monitor,
        || (),
        |(), face, out| {
            out.copy_from_slice(
                &around(face).map(|(i, j)| DVec2::new(parameter(0, i), parameter(1, j))),
            );
        },
    )?;
    let topology = Arc::new(Topology::uniform(positions.len(), 4, corners)?);
    let values = AttributeValues::Vector2(uv.into());
    Mesh::new(positions, topology)?.with_attribute(Attribute::new(UV, Domain::Corner, values))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{TAU, cos, sin};
    use crate::measure::measure_mesh;
    use crate::{Unmonitored, normals};

    fn torus(cells: [usize; 2]) -> Mesh {
        let place = |u: f64, v: f64| {
            let (u, v) = (u * TAU, v * TAU);
            let r = 3.0 + cos(v);
            DVec3::new(r * cos(u), r * sin(u), sin(v))
        };
        parametric_surface(cells, [true, true], place, &Unmonitored).expect("finite")
    }

    #[test]
    fn a_torus_is_closed_and_faces_out() {
        let mesh = torus([48, 24]);
        let measures = measure_mesh(&mesh);
        assert_eq!((measures.euler, measures.boundary_edges), (0, 0));
        // V = 2 π² R r², less what the chords cut off.
        let volume = measures.volume.expect("closed");
        assert!(
            (volume / (TAU * TAU / 2.0 * 3.0) - 1.0).abs() < 0.02,
            "{volume}"
        );
    }

    #[test]
    fn uv_does_not_wrap_at_the_seam() {
        let mesh = torus([5, 3]);
        let uv = mesh.attribute(UV, Domain::Corner).expect("has uv").values();
        let AttributeValues::Vector2(uv) = uv else {
            panic!("uv is no pair");
        };
        for (face, quad) in uv.chunks_exact(4).enumerate() {
            let size = quad[2] - quad[0];
            let cell = DVec2::new(0.2, 1.0 / 3.0);
            assert!(
                (size - cell).abs().max_element() < 1e-12,
                "face {face}: {size}"
            );
        }
    }

    #[test]
    fn closed_in_v_only_is_a_tube_along_u() {
        let place = |u: f64, v: f64| DVec3::new(u, cos(v * TAU), sin(v * TAU));
        let mesh = parametric_surface([4, 7], [false, true], place, &Unmonitored).expect("finite");
        assert_eq!((mesh.vertex_count(), mesh.face_count()), (35, 28));
        assert_eq!(mesh.topology().boundary_loops().len(), 2);
        // ∂f/∂u × ∂f/∂v points to the axis here.
        let normals = normals::face_normals(&mesh, &Unmonitored).expect("not cancelled");
        for (face, normal) in normals.iter().enumerate() {
            let centre = mesh.face(face).iter().fold(DVec3::ZERO, |sum, &vertex| {
                sum + mesh.positions()[vertex as usize] * 0.25
            });
            let out = DVec3::new(0.0, centre.y, centre.z);
            assert!(normal.dot(out) < -0.8, "face {face}: {normal}");
        }
    }

    #[test]
    fn a_place_that_is_not_finite_is_named() {
        let place = |u: f64, v: f64| DVec3::new(u, v, 1.0 / (u - 0.5));
        let error = parametric_surface([4, 4], [false, false], place, &Unmonitored);
        let expected = GeometryError::NonFiniteSurface { u: 0.5, v: 0.0 };
        assert_eq!(error.err(), Some(expected));
    }

    #[test]
    fn two_cells_cannot_close() {
        let place = |u: f64, v: f64| DVec3::new(u, v, 0.0);
        let mesh = parametric_surface([2, 4], [true, false], place, &Unmonitored);
        assert!(matches!(mesh, Err(GeometryError::OutOfRange { value, .. }) if value < 3.0));
    }
}
