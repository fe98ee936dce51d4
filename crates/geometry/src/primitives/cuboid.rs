//! A box of quads.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{UV, check_cells, check_counts, check_size, quad_bytes};
use crate::mesh::{Attribute, AttributeValues, Domain};
use crate::{GeometryError, Mesh, Topology};

/// A closed box of quads facing out, with a corner attribute `uv`.
///
/// `size` in metres and `cells` along x, y and z. The lowest corner is at the
/// origin, or the middle is if `center`. Vertices are in rows, x fastest, then
/// y, then z. Faces are side by side: bottom, top, front (-y), right (+x), back
/// (+y), left (-x), each in rows; v runs up on the four upright sides, and
/// `uv` spans the unit square on each. Cost: O(cells of the surface).
///
/// # Errors
/// [`GeometryError::OutOfRange`] without cells or for a size that is not above
/// 0; [`GeometryError::TooMany`] before anything is allocated.
///
/// ```
/// use tessgraph_geometry::{glam::DVec3, primitives::cuboid};
/// let cube = cuboid(DVec3::ONE, [1, 1, 1], false)?;
/// assert_eq!((cube.vertex_count(), cube.face_count()), (8, 6));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn cuboid(size: DVec3, cells: [usize; 3], center: bool) -> Result<Mesh, GeometryError> {
    check_size("the size of the cuboid", &size.to_array())?;
    check_cells(&cells, 1)?;
    let faces = face_count(cells);
    check_counts(faces.saturating_add(2), faces)?;
    let shell = Shell { cells };
    let shift = if center { size * 0.5 } else { DVec3::ZERO };
    let positions = shell
        .places()
        .map(|place| {
            let [u, v, w] = std::array::from_fn(|k| place[k] as f64 / cells[k] as f64);
            DVec3::new(u, v, w) * size - shift
        })
        .collect();
    let (mut corners, mut uv) = (Vec::new(), Vec::new());
    corners.reserve(4 * faces as usize);
    uv.reserve(4 * faces as usize);
    for side in SIDES {
        shell.add_side(side, &mut corners, &mut uv);
    }
    let topology = Arc::new(Topology::uniform(faces as usize + 2, 4, corners)?);
    let values = AttributeValues::Vector2(uv.into());
    Mesh::new(positions, topology)?.with_attribute(Attribute::new(UV, Domain::Corner, values))
}

/// Bytes that [`cuboid`] takes for its result, to ask for before it is made.
pub fn cuboid_bytes(cells: [usize; 3]) -> u128 {
    let faces = face_count(cells);
    quad_bytes(faces.saturating_add(2), faces)
}

fn face_count(cells: [usize; 3]) -> u128 {
    let [x, y, z] = cells.map(|count| count as u128);
    x.saturating_mul(y)
        .saturating_add(y.saturating_mul(z))
        .saturating_add(z.saturating_mul(x))
        .saturating_mul(2)
}

/// A side of the box: where its corner (0, 0) is (0 low, 1 high on each axis)
/// and along which axes u and v run, forwards or backwards.
struct Side {
    origin: [usize; 3],
    u: (usize, bool),
    v: (usize, bool),
}

const SIDES: [Side; 6] = [
    Side {
        origin: [0, 1, 0],
        u: (0, true),
        v: (1, false),
    },
    Side {
        origin: [0, 0, 1],
        u: (0, true),
        v: (1, true),
    },
    Side {
        origin: [0, 0, 0],
        u: (0, true),
        v: (2, true),
    },
    Side {
        origin: [1, 0, 0],
        u: (1, true),
        v: (2, true),
    },
    Side {
        origin: [1, 1, 0],
        u: (0, false),
        v: (2, true),
    },
    Side {
        origin: [0, 1, 0],
        u: (1, false),
        v: (2, true),
    },
];

/// The lattice points on the surface of a box of cells.
struct Shell {
    cells: [usize; 3],
}

impl Shell {
    /// All points in order: x fastest, then y, then z.
    fn places(&self) -> impl Iterator<Item = [usize; 3]> {
        let [x, y, z] = self.cells;
        (0..=z).flat_map(move |k| {
            (0..=y).flat_map(move |j| {
                // Inside the box's height and depth only the two ends of a row count.
                let step = if k % z == 0 || j % y == 0 { 1 } else { x };
                (0..=x).step_by(step).map(move |i| [i, j, k])
            })
        })
    }

    /// The number of a point in that order.
    fn index(&self, [i, j, k]: [usize; 3]) -> u32 {
        let [x, y, z] = self.cells;
        let (full, ring) = ((x + 1) * (y + 1), 2 * (x + y));
        let layer = match k {
            0 => 0,
            _ => full + (k - 1) * ring,
        };
        let within = if k.is_multiple_of(z) || j == 0 {
            j * (x + 1) + i
        } else if j == y {
            (x + 1) + 2 * (y - 1) + i
        } else {
            (x + 1) + 2 * (j - 1) + usize::from(i == x)
        };
        (layer + within) as u32
    }

    fn add_side(&self, side: Side, corners: &mut Vec<u32>, uv: &mut Vec<DVec2>) {
        let (columns, rows) = (self.cells[side.u.0], self.cells[side.v.0]);
        let place = |i: usize, j: usize| {
            let mut place: [usize; 3] = std::array::from_fn(|k| side.origin[k] * self.cells[k]);
            for (t, (axis, forwards)) in [(i, side.u), (j, side.v)] {
                place[axis] = if forwards { t } else { self.cells[axis] - t };
            }
            self.index(place)
        };
        for j in 0..rows {
            for i in 0..columns {
                for (i, j) in [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)] {
                    corners.push(place(i, j));
                    uv.push(DVec2::new(
                        i as f64 / columns as f64,
                        j as f64 / rows as f64,
                    ));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::measure_mesh;

    #[test]
    fn boxes_are_closed_and_have_their_volume() {
        for cells in [[1, 1, 1], [1, 2, 3], [4, 1, 2], [3, 3, 1], [5, 4, 3]] {
            let size = DVec3::new(2.0, 3.0, 5.0);
            let mesh = cuboid(size, cells, true).expect("valid");
            let measures = measure_mesh(&mesh);
            assert_eq!(
                (measures.euler, measures.boundary_edges),
                (2, 0),
                "{cells:?}"
            );
            assert_eq!(measures.isolated_vertices + measures.inconsistent_edges, 0);
            let volume = measures.volume.expect("closed");
            assert!((volume - 30.0).abs() < 1e-12, "{volume}");
            assert!((measures.area - 62.0).abs() < 1e-12);
            assert_eq!(mesh.bounds(), Some((-size / 2.0, size / 2.0)));
        }
    }

    #[test]
    fn upright_sides_have_v_up() {
        let mesh = cuboid(DVec3::ONE, [2, 2, 2], false).expect("valid");
        for face in 8..mesh.face_count() {
            let [p0, _, _, p3] =
                [0, 1, 2, 3].map(|k| mesh.positions()[mesh.face(face)[k] as usize]);
            assert_eq!(p3 - p0, DVec3::Z * 0.5, "face {face}");
        }
    }

    #[test]
    fn points_are_numbered_in_their_order() {
        let shell = Shell { cells: [3, 4, 5] };
        for (number, place) in (0u32..).zip(shell.places()) {
            assert_eq!(shell.index(place), number, "{place:?}");
        }
        assert_eq!(shell.places().count(), 2 * (12 + 20 + 15) + 2);
    }

    #[test]
    fn a_box_too_large_is_refused() {
        let mesh = cuboid(DVec3::ONE, [usize::MAX, usize::MAX, 1], false);
        assert!(matches!(mesh, Err(GeometryError::TooMany { .. })));
    }
}
