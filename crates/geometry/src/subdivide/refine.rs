//! One Catmull-Clark refinement of dense tiles (Catmull and Clark 1978).

use crate::{GeometryError, Monitor, parallel};

use super::cage::Cage;
use super::rules::{Rule, Transition, crease_mask};
use super::tiles::Tiles;
use super::value::{Value, blend, middle, moved, refine_line, zeroed};

/// Values of the points of tiles of side 2m from those of side m, after `level`
/// refinements of the cage.
///
/// Inside a tile everything is regular and smooth: the masks are products of
/// the cubic B-spline's (1 1)/2 and (1 6 1)/8. Along a cage edge the same holds
/// with the crease mixed in; only the cage's vertices need their whole ring.
pub(super) fn refine<T: Value>(
    cage: &Cage,
    side: usize,
    level: u32,
    values: &[T],
    monitor: &dyn Monitor,
) -> Result<Vec<T>, GeometryError> {
    let tiles = Tiles::new(&cage.topology, side);
    let fine = Tiles::new(&cage.topology, 2 * side);
    let mut out = zeroed(fine.point_count());
    let (vertices, edges, faces) = fine.split(&mut out);
    parallel::fill(vertices, monitor, |vertex, point| {
        *point = vertex_point(cage, &tiles, level, values, vertex);
    })?;
    let line = || vec![T::default(); side + 1];
    parallel::fill_rows(edges, fine.edge_len(), monitor, line, |line, edge, out| {
        let sharpness = cage.sharpness.edge(edge, level);
        load_edge(&tiles, edge, sharpness, values, line);
        refine_line(line, out);
    })?;
    let scratch = || (vec![T::default(); (side + 1) * (side + 1)], line());
    parallel::fill_rows(
        faces,
        fine.face_len(),
        monitor,
        scratch,
        |(tile, line), face, out| {
            tiles.load(face, values, tile);
            refine_tile(tile, side, line, out);
        },
    )?;
    Ok(out)
}

/// The points inside a tile of twice the side, row by row.
fn refine_tile<T: Value>(tile: &[T], side: usize, line: &mut [T], out: &mut [T]) {
    let row = |j: usize| &tile[j * (side + 1)..(j + 1) * (side + 1)];
    for (k, out) in out.chunks_exact_mut(2 * side - 1).enumerate() {
        let j = k.div_ceil(2);
        if k % 2 == 0 {
            for (i, value) in line.iter_mut().enumerate() {
                *value = middle(row(j)[i], row(j + 1)[i]);
            }
        } else {
            let (below, here, above) = (row(j - 1), row(j), row(j + 1));
            for (i, value) in line.iter_mut().enumerate() {
                *value = moved(below[i], here[i], above[i]);
            }
        }
        refine_line(line, out);
    }
}

/// The line along an edge as it is before refining lengthwise: across the edge
/// already moved towards the neighbouring rows, as far as it is smooth.
fn load_edge<T: Value>(
    tiles: &Tiles<'_>,
    edge: usize,
    sharpness: f64,
    values: &[T],
    line: &mut [T],
) {
    let across = |here: T, left: usize, right: usize| {
        blend(moved(values[left], here, values[right]), here, sharpness)
    };
    let (side, inside) = (tiles.side, tiles.edge_line(edge));
    let [first, last] = tiles.cage.adjacency().edge(edge);
    line[0] = values[first as usize];
    line[side] = values[last as usize];
    for (t, value) in line[..side].iter_mut().enumerate().skip(1) {
        *value = values[inside.at(t)];
    }
    let &[left, right] = tiles.cage.adjacency().edge_corners(edge) else {
        return;
    };
    if sharpness >= 1.0 {
        return;
    }
    for t in [0, side] {
        let beside = |corner| beside(tiles, corner, t);
        line[t] = across(line[t], beside(left), beside(right));
    }
    if side >= 2 {
        let [left, right] = [left, right].map(|corner| tiles.beside_line(corner as usize));
        for (t, value) in line[..side].iter_mut().enumerate().skip(1) {
            *value = across(*value, left.at(t), right.at(t));
        }
    }
}

/// The point beside place `t` of the edge that leaves `corner`, one cell inside
/// the corner's face; `t` counts in the edge's own sense.
pub(super) fn beside(tiles: &Tiles<'_>, corner: u32, t: usize) -> usize {
    let corner = corner as usize;
    let along = tiles.is_along(corner);
    tiles.inside(corner, if along { t } else { tiles.side - t }, 1)
}

/// Where a vertex of the cage moves.
fn vertex_point<T: Value>(
    cage: &Cage,
    tiles: &Tiles<'_>,
    level: u32,
    values: &[T],
    vertex: usize,
) -> T {
    let adjacency = cage.topology.adjacency();
    let here = values[vertex];
    let around = adjacency.vertex_edges(vertex);
    let end = |edge: u32| values[tiles.first_on_edge(edge as usize, vertex)];
    let edges = around
        .iter()
        .map(|&edge| (edge, cage.sharpness.edge(edge as usize, level)));
    let sharpness = cage.sharpness.vertex(vertex, level);
    Transition::of(sharpness, edges).apply(|rule| match rule {
        Rule::Corner => here,
        Rule::Crease(ends) => crease_mask(here, ends.map(end)),
        Rule::Smooth => {
            let ends = around.iter().fold(T::default(), |sum, &e| sum + end(e));
            let corners = adjacency.vertex_corners(vertex).iter();
            let diagonal = |corner: u32| values[tiles.inside(corner as usize, 1, 1)];
            let opposite = corners.fold(T::default(), |sum, &c| sum + diagonal(c));
            smooth_mask(here, ends, opposite, around.len())
        }
    })
}

/// The smooth mask of a vertex of valence n from the sums over its edges' other
/// ends and its quads' opposite corners: 1 - 7/4n, 3/2n², 1/4n².
pub(super) fn smooth_mask<T: Value>(here: T, ends: T, opposite: T, valence: usize) -> T {
    let n = valence as f64;
    here * (1.0 - 7.0 / (4.0 * n)) + ends * (1.5 / (n * n)) + opposite * (0.25 / (n * n))
}
