//! Bilinear refinement: more cells on the same surface.

use crate::{GeometryError, Monitor, parallel};

use super::cage::Cage;
use super::tiles::Tiles;
use super::value::{Value, blend, zeroed};

/// Values of the points of tiles, bilinear between the corners of each quad.
pub(super) fn interpolate<T: Value>(
    cage: &Cage,
    side: usize,
    values: &[T],
    monitor: &dyn Monitor,
) -> Result<Vec<T>, GeometryError> {
    let tiles = Tiles::new(&cage.topology, side);
    let step = 1.0 / side as f64;
    let mut out = zeroed(tiles.point_count());
    let (vertices, edges, faces) = tiles.split(&mut out);
    vertices.copy_from_slice(values);
    let nothing = || ();
    parallel::fill_rows(
        edges,
        tiles.edge_len(),
        monitor,
        nothing,
        |(), edge, out| {
            let [a, b] = cage.topology.adjacency().edge(edge);
            let (a, b) = (values[a as usize], values[b as usize]);
            for (k, point) in out.iter_mut().enumerate() {
                *point = blend(a, b, (k + 1) as f64 * step);
            }
        },
    )?;
    parallel::fill_rows(
        faces,
        tiles.face_len(),
        monitor,
        nothing,
        |(), face, out| {
            let corners: [T; 4] =
                std::array::from_fn(|k| values[cage.topology.face(face)[k] as usize]);
            for (k, point) in out.iter_mut().enumerate() {
                let (i, j) = (k % (side - 1) + 1, k / (side - 1) + 1);
                *point = bilinear(corners, i as f64 * step, j as f64 * step);
            }
        },
    )?;
    Ok(out)
}

/// The value at (u, v) between those at (0,0), (1,0), (1,1) and (0,1).
pub(super) fn bilinear<T: Value>([a, b, c, d]: [T; 4], u: f64, v: f64) -> T {
    blend(blend(a, b, u), blend(d, c, u), v)
}
