//! Places on the limit surface (Halstead, Kass and DeRose 1993).

use crate::topology::Topology;
use crate::{GeometryError, Monitor, parallel};

use super::cage::Cage;
use super::refine::{beside, smooth_mask};
use super::rules::{Rule, Transition, crease_mask};
use super::sharpness::decayed;
use super::tiles::Tiles;
use super::value::{Value, blend, limit, middle, moved, zeroed};

/// The limits of the points of tiles after `level` refinements of the cage.
///
/// Exact everywhere: inside tiles, on creases and borders by the cubic
/// B-spline's (1 4 1)/6, at vertices by the left eigenvector of the subdivision
/// matrix. Where finite sharpness is left, and at the end of a crease, the ring
/// round the point is refined further on its own until it has settled.
pub(super) fn project<T: Value>(
    cage: &Cage,
    side: usize,
    level: u32,
    values: &[T],
    monitor: &dyn Monitor,
) -> Result<Vec<T>, GeometryError> {
    let tiles = Tiles::new(&cage.topology, side);
    let mut out = zeroed(tiles.point_count());
    let (vertices, edges, faces) = tiles.split(&mut out);
    parallel::fill_rows(vertices, 1, monitor, Ring::default, |ring, vertex, out| {
        out[0] = vertex_limit(cage, &tiles, level, values, vertex, ring);
    })?;
    parallel::fill_rows(
        edges,
        tiles.edge_len(),
        monitor,
        || (),
        |(), edge, out| {
            let sharpness = cage.sharpness.edge(edge, level);
            for (k, point) in out.iter_mut().enumerate() {
                *point = edge_limit(&tiles, edge, k + 1, sharpness, values);
            }
        },
    )?;
    let scratch = || vec![T::default(); (side + 1) * (side + 1)];
    parallel::fill_rows(
        faces,
        tiles.face_len(),
        monitor,
        scratch,
        |tile, face, out| {
            tiles.load(face, values, tile);
            tile_limit(tile, side, out);
        },
    )?;
    Ok(out)
}

fn tile_limit<T: Value>(tile: &[T], side: usize, out: &mut [T]) {
    let row = side + 1;
    for (j, out) in out.chunks_exact_mut(side - 1).enumerate() {
        let column = |i: usize| {
            let below = j * row + i;
            limit(tile[below], tile[below + row], tile[below + 2 * row])
        };
        for (i, point) in out.iter_mut().enumerate() {
            *point = limit(column(i), column(i + 1), column(i + 2));
        }
    }
}

/// The limit of the point at place `t` inside an edge, where three rows of
/// three points decide.
fn edge_limit<T: Value>(
    tiles: &Tiles<'_>,
    edge: usize,
    t: usize,
    mut sharpness: f64,
    values: &[T],
) -> T {
    let line = |at: &dyn Fn(usize) -> usize| [t - 1, t, t + 1].map(|t| values[at(t)]);
    let mut here = line(&|t| tiles.on_edge(edge, t));
    if let [left, right] = *tiles.cage.adjacency().edge_corners(edge)
        && sharpness.is_finite()
    {
        let mut left = line(&|t| beside(tiles, left, t));
        let mut right = line(&|t| beside(tiles, right, t));
        while sharpness > 0.0 {
            let across: [T; 3] = std::array::from_fn(|k| {
                blend(moved(left[k], here[k], right[k]), here[k], sharpness)
            });
            left = refine_three(std::array::from_fn(|k| middle(left[k], here[k])));
            right = refine_three(std::array::from_fn(|k| middle(right[k], here[k])));
            here = refine_three(across);
            sharpness = decayed(sharpness, 1);
        }
        here = std::array::from_fn(|k| limit(left[k], here[k], right[k]));
    }
    limit(here[0], here[1], here[2])
}

/// The middle of three in a row and its two new neighbours.
fn refine_three<T: Value>([a, b, c]: [T; 3]) -> [T; 3] {
    [middle(a, b), moved(a, b, c), middle(b, c)]
}

/// A vertex and the quads round it, with what is left of their sharpness.
#[derive(Default)]
struct Ring<T> {
    here: T,
    vertex_sharpness: f64,
    edges: Vec<(T, f64)>,
    /// Opposite corner of each quad, and which two edges the quad lies between.
    quads: Vec<(T, [usize; 2])>,
    next: Vec<T>,
}

/// Refinements after which a ring counts as settled: the slowest rings in use
/// (valence 1000) shrink by 0.8 each time, and 0.8^160 is below 1e-15.
const SETTLED: usize = 160;

fn vertex_limit<T: Value>(
    cage: &Cage,
    tiles: &Tiles<'_>,
    level: u32,
    values: &[T],
    vertex: usize,
    ring: &mut Ring<T>,
) -> T {
    ring.load(cage, tiles, level, values, vertex);
    while ring.is_decaying() {
        ring.refine();
    }
    match ring.rule() {
        Rule::Corner => ring.here,
        Rule::Crease(ends) => {
            let [a, b] = ends.map(|edge| ring.edges[edge as usize].0);
            limit(a, ring.here, b)
        }
        Rule::Smooth if ring.edges.iter().any(|&(_, sharpness)| sharpness > 0.0) => ring.settle(),
        Rule::Smooth => {
            let n = ring.edges.len() as f64;
            let ends = ring.edges.iter().fold(T::default(), |sum, e| sum + e.0);
            let opposite = ring.quads.iter().fold(T::default(), |sum, q| sum + q.0);
            (ring.here * (n * n) + ends * 4.0 + opposite) * (1.0 / (n * (n + 5.0)))
        }
    }
}

impl<T: Value> Ring<T> {
    fn load(&mut self, cage: &Cage, tiles: &Tiles<'_>, level: u32, values: &[T], vertex: usize) {
        let adjacency = cage.topology.adjacency();
        let around = adjacency.vertex_edges(vertex);
        self.here = values[vertex];
        self.vertex_sharpness = cage.sharpness.vertex(vertex, level);
        self.edges.clear();
        self.edges.extend(around.iter().map(|&edge| {
            let edge = edge as usize;
            let end = values[tiles.first_on_edge(edge, vertex)];
            (end, cage.sharpness.edge(edge, level))
        }));
        // Edges are listed ascending.
        let place = |edge: u32| around.partition_point(|&other| other < edge);
        self.quads.clear();
        self.quads
            .extend(adjacency.vertex_corners(vertex).iter().map(|&corner| {
                let between = corner_edges(&cage.topology, corner).map(place);
                (values[tiles.inside(corner as usize, 1, 1)], between)
            }));
    }

    fn is_decaying(&self) -> bool {
        let finite = |sharpness: f64| sharpness > 0.0 && sharpness.is_finite();
        finite(self.vertex_sharpness) || self.edges.iter().any(|edge| finite(edge.1))
    }

    fn numbered(&self) -> impl Iterator<Item = (u32, f64)> + Clone {
        (0u32..).zip(self.edges.iter().map(|edge| edge.1))
    }

    fn rule(&self) -> Rule {
        Rule::of(self.vertex_sharpness, self.numbered())
    }

    /// The same ring one refinement later: a ring of quads maps onto itself.
    fn refine(&mut self) {
        let ends = self.edges.iter().fold(T::default(), |sum, e| sum + e.0);
        let opposite = self.quads.iter().fold(T::default(), |sum, q| sum + q.0);
        let transition = Transition::of(self.vertex_sharpness, self.numbered());
        let here = transition.apply(|rule| match rule {
            Rule::Corner => self.here,
            Rule::Crease(ends) => {
                crease_mask(self.here, ends.map(|edge| self.edges[edge as usize].0))
            }
            Rule::Smooth => smooth_mask(self.here, ends, opposite, self.edges.len()),
        });
        self.next.clear();
        self.next.resize(self.edges.len(), T::default());
        for (point, [a, b]) in &mut self.quads {
            let sum = self.here + self.edges[*a].0 + self.edges[*b].0 + *point;
            *point = sum * 0.25;
            for edge in [*a, *b] {
                self.next[edge] = self.next[edge] + *point;
            }
        }
        for ((end, sharpness), faces) in self.edges.iter_mut().zip(&self.next) {
            let crease = middle(self.here, *end);
            // Two quads share a smooth edge, so half their sum is their mean.
            *end = blend(middle(crease, *faces * 0.5), crease, *sharpness);
            *sharpness = decayed(*sharpness, 1);
        }
        self.here = here;
        self.vertex_sharpness = decayed(self.vertex_sharpness, 1);
    }

    /// Refines until the whole ring has shrunk to the vertex's limit.
    fn settle(&mut self) -> T {
        for _ in 0..SETTLED {
            let before = self.here;
            self.refine();
            let spread = self.edges.iter().map(|edge| edge.0.gap(self.here));
            // The vertex moves less than the ring is wide, and no further.
            if spread.fold(before.gap(self.here), f64::max) == 0.0 {
                break;
            }
        }
        self.here
    }
}

/// The edges before and after a corner of a quad.
fn corner_edges(cage: &Topology, corner: u32) -> [u32; 2] {
    let edges = cage.adjacency().corner_edges();
    let before = if corner.is_multiple_of(4) {
        corner + 3
    } else {
        corner - 1
    };
    [edges[before as usize], edges[corner as usize]]
}
