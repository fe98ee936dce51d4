//! Neighbouring components joined by topology, without any distance.

use super::Piece;
use super::layout::Layout;
use crate::weld::{Welded, merge_vertices};
use crate::{GeometryError, Mesh, Monitor};

/// What [`super::Join::Weld`] did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct JoinReport {
    /// Vertices that were joined to another one.
    pub joined: usize,
    /// Vertices on a side or corner that other components share, without a
    /// partner in each of them: the mesh stays open there.
    pub open: usize,
    /// Faces dropped because joining left fewer than three corners of them.
    pub dropped_faces: usize,
}

/// Rounding of places in the unit square: two vertices this close along a side
/// are at one place. Only (u, v, w) are compared so, never positions in space;
/// heights relative to the greatest.
const ROUNDING: f64 = 1e-9;

/// Joins component vertices that lie on the same place of a shared edge.
///
/// A vertex on a side of the square is known by (edge, place along it, height,
/// place of its direction), one at a corner by (base vertex, height): equal
/// keys have the same position by construction, so they become one vertex, the
/// first in output order, and its position is everybody's. A vertex whose
/// direction is read off its own side has no such key and stays open. Where a
/// side collapses (the edge v = 1 of a triangle) all its vertices of one height
/// are joined. Cost: O(border vertices · log).
pub(super) fn join(
    mesh: &Mesh,
    pieces: &[Piece],
    layout: &Layout<'_>,
    monitor: &dyn Monitor,
) -> Result<(Welded, JoinReport), GeometryError> {
    let (targets, open) = targets(pieces, layout);
    let welded = merge_vertices(mesh, &targets, monitor)?;
    let report = JoinReport {
        joined: welded.joined,
        open,
        dropped_faces: welded.dropped_faces,
    };
    Ok((welded, report))
}

/// For each vertex of the array the first of those it is joined with, itself if
/// there is no other; and how many vertices stay open.
pub(super) fn targets(pieces: &[Piece], layout: &Layout<'_>) -> (Vec<u32>, usize) {
    let rims = rims(pieces);
    let mut joiner = Joiner {
        target: (0..layout.vertex_starts.last().copied().unwrap_or(0)).collect(),
        open: 0,
    };
    let Borders {
        edges,
        mut corners,
        cells_at,
    } = Borders::new(&rims, layout);
    let mut rows = Vec::new();
    for group in edges.chunk_by(|a, b| a.line == b.line) {
        rows.clear();
        for edge in group {
            let placement = layout.placements[edge.placement as usize];
            let first = layout.vertex_starts[edge.placement as usize];
            let side = &rims[placement.component as usize].sides[edge.side];
            rows.extend(side.iter().map(|point| Row {
                key: point.key(edge.is_reversed),
                placement: edge.placement,
                vertex: first + point.vertex,
            }));
        }
        // Edges of a group are sorted by placement.
        let cells = group.chunk_by(|a, b| a.placement == b.placement).count();
        joiner.join(&mut rows, cells);
    }
    corners.sort_unstable_by_key(|(vertex, row)| (*vertex, row.vertex));
    for group in corners.chunk_by(|a, b| a.0 == b.0) {
        rows.clear();
        rows.extend(group.iter().map(|&(_, row)| row));
        joiner.join(&mut rows, cells_at[group[0].0 as usize] as usize);
    }
    (joiner.target, joiner.open)
}

/// (place, height, place of direction); `None` for a vertex that cannot match.
type Key = Option<(u32, u32, u32)>;

/// An output vertex on an edge or at a vertex of the base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Row {
    key: Key,
    placement: u32,
    vertex: u32,
}

struct Joiner {
    target: Vec<u32>,
    open: usize,
}

impl Joiner {
    /// Joins the rows of one edge or base vertex that have equal keys, where
    /// `cells` placements meet.
    fn join(&mut self, rows: &mut [Row], cells: usize) {
        rows.sort_unstable();
        for run in rows.chunk_by(|a, b| a.key == b.key) {
            let partners = run.chunk_by(|a, b| a.placement == b.placement).count();
            let matched = if run[0].key.is_some() { partners } else { 1 };
            if matched < cells {
                self.open += run.len();
            }
            if run[0].key.is_some() {
                for row in &run[1..] {
                    self.target[row.vertex as usize] = run[0].vertex;
                }
            }
        }
    }
}

/// One placement at one edge of the base.
struct Edge {
    /// First, second and last vertex along the edge, from its canonical end.
    line: [u32; 3],
    placement: u32,
    side: usize,
    is_reversed: bool,
}

/// Where placements meet.
struct Borders {
    /// All edges under placements, sorted so that those of one edge of the base
    /// are together.
    edges: Vec<Edge>,
    /// All output vertices at vertices of the base, by base vertex.
    corners: Vec<(u32, Row)>,
    /// How many placements there are round each vertex of the base.
    cells_at: Vec<u32>,
}

impl Borders {
    fn new(rims: &[Rim], layout: &Layout<'_>) -> Self {
        let mut borders = Self {
            edges: Vec::with_capacity(4 * layout.placements.len()),
            corners: Vec::new(),
            cells_at: vec![0; layout.base_vertex_count()],
        };
        let mut grid = Vec::new();
        for (index, placement) in layout.placements.iter().enumerate() {
            let n = layout.grid(index, &mut grid);
            let rim = &rims[placement.component as usize];
            for (side, points) in rim.sides.iter().enumerate() {
                let line = |k: u32| grid[side_place(side, k, n) as usize];
                if (0..=n).all(|k| line(k) == line(0)) {
                    borders.add_at_vertex(line(0), points, index, layout);
                } else {
                    borders.edges.push(Edge::new(line, n, side, index));
                }
            }
            let mut ends = [0, 1, 2, 3].map(|corner| grid[corner_place(corner, n) as usize]);
            for (vertex, points) in ends.into_iter().zip(&rim.corners) {
                borders.add_at_vertex(vertex, points, index, layout);
            }
            ends.sort_unstable();
            for run in ends.chunk_by(|a, b| a == b) {
                borders.cells_at[run[0] as usize] += 1;
            }
        }
        borders
            .edges
            .sort_unstable_by_key(|edge| (edge.line, edge.placement, edge.side));
        borders
    }

    fn add_at_vertex(
        &mut self,
        vertex: u32,
        points: &[RimPoint],
        index: usize,
        layout: &Layout<'_>,
    ) {
        let first = layout.vertex_starts[index];
        self.corners.extend(points.iter().map(|point| {
            let row = Row {
                // At one vertex only the height is left to differ.
                key: (point.direction[0] != OFF_SIDE).then_some((0, point.height, 0)),
                placement: index as u32,
                vertex: first + point.vertex,
            };
            (vertex, row)
        }));
    }
}

impl Edge {
    fn new(line: impl Fn(u32) -> u32, n: u32, side: usize, placement: usize) -> Self {
        let ends = [(line(0), line(1)), (line(n), line(n - 1))];
        let is_reversed = ends[1] < ends[0];
        let [near, far] = if is_reversed {
            [ends[1], ends[0]]
        } else {
            ends
        };
        Self {
            line: [near.0, near.1, far.0],
            placement: placement as u32,
            side,
            is_reversed,
        }
    }
}

/// Grid place of the k-th vertex along a side: v = 0, u = 1, v = 1, u = 0, each
/// in the sense of ascending u or v.
fn side_place(side: usize, k: u32, n: u32) -> u32 {
    match side {
        0 => k,
        1 => k * (n + 1) + n,
        2 => n * (n + 1) + k,
        _ => k * (n + 1),
    }
}

/// Grid place of corners (0,0), (1,0), (0,1), (1,1).
fn corner_place(corner: usize, n: u32) -> u32 {
    (corner as u32 % 2) * n + (corner as u32 / 2) * n * (n + 1)
}

/// Marks a direction that is not read on the vertex's own side.
const OFF_SIDE: u32 = u32::MAX;

/// A component vertex on the rim of the square, with numbers for places and
/// heights that are equal up to rounding.
#[derive(Clone, Copy)]
struct RimPoint {
    vertex: u32,
    height: u32,
    /// Place along the side from its start and from its end.
    along: [u32; 2],
    /// Where its direction is read, likewise, or [`OFF_SIDE`].
    direction: [u32; 2],
}

impl RimPoint {
    fn key(&self, is_reversed: bool) -> Key {
        let sense = usize::from(is_reversed);
        let direction = self.direction[sense];
        (direction != OFF_SIDE).then_some((self.along[sense], self.height, direction))
    }
}

/// The vertices of a component on each side without its ends, and at each corner.
#[derive(Default)]
struct Rim {
    sides: [Vec<RimPoint>; 4],
    corners: [Vec<RimPoint>; 4],
}

fn rims(pieces: &[Piece]) -> Vec<Rim> {
    let vertices = || {
        pieces.iter().flat_map(|piece| {
            let heights = piece
                .mesh
                .positions()
                .iter()
                .map(|p| p.z * piece.height_scale);
            piece
                .mesh
                .positions()
                .iter()
                .zip(&piece.normal_uv)
                .zip(heights)
        })
    };
    let places = vertices().flat_map(|((p, uv), _)| [p.x, p.y, uv.x, uv.y]);
    let places = Levels::new(
        places.flat_map(|x| [x, 1.0 - x]).chain([0.0, 1.0]),
        ROUNDING,
    );
    let heights = vertices().map(|(_, height)| height).chain([0.0]);
    let highest = heights.clone().fold(0.0, |high: f64, h| high.max(h.abs()));
    let heights = Levels::new(heights, ROUNDING * highest);
    let rim = |piece: &Piece| {
        let mut rim = Rim::default();
        for (vertex, p) in piece.mesh.positions().iter().enumerate() {
            let height = heights.of(p.z * piece.height_scale);
            let flat = height == heights.of(0.0);
            // In the surface the direction makes no difference.
            let read = if flat {
                p.truncate()
            } else {
                piece.normal_uv[vertex]
            };
            let place = [p.x, p.y].map(|x| places.both(x));
            let read = [read.x, read.y].map(|x| places.both(x));
            rim.add(vertex as u32, height, place, read, places.both(0.0));
        }
        rim
    };
    pieces.iter().map(rim).collect()
}

impl Rim {
    /// Files a vertex under the side or corner it is on, if any. Places are
    /// numbers from both ends; `ends` are those of 0 and 1.
    fn add(
        &mut self,
        vertex: u32,
        height: u32,
        place: [[u32; 2]; 2],
        read: [[u32; 2]; 2],
        ends: [u32; 2],
    ) {
        // Along each axis: at its start, at its end, in between, or outside.
        let end_of = |x: [u32; 2]| ends.iter().position(|&end| x[0] == end);
        let inside = |x: [u32; 2]| ends[0] < x[0] && x[0] < ends[1];
        let point = |along: [u32; 2], direction: [u32; 2]| RimPoint {
            vertex,
            height,
            along,
            direction,
        };
        let [u, v] = place;
        match (end_of(u), end_of(v)) {
            (Some(i), Some(j)) => {
                let same = read[0][0] == u[0] && read[1][0] == v[0];
                let direction = if same { [0; 2] } else { [OFF_SIDE; 2] };
                self.corners[2 * j + i].push(point([0; 2], direction));
            }
            (None, Some(j)) if inside(u) => {
                let same = read[1][0] == v[0];
                let direction = if same { read[0] } else { [OFF_SIDE; 2] };
                self.sides[[0, 2][j]].push(point(u, direction));
            }
            (Some(i), None) if inside(v) => {
                let same = read[0][0] == u[0];
                let direction = if same { read[1] } else { [OFF_SIDE; 2] };
                self.sides[[3, 1][i]].push(point(v, direction));
            }
            _ => {}
        }
    }
}

/// Numbers for values that are equal up to rounding, ascending.
struct Levels(Vec<f64>);

impl Levels {
    fn new(values: impl Iterator<Item = f64>, rounding: f64) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_unstable_by(f64::total_cmp);
        let mut last = f64::NEG_INFINITY;
        values.retain(|&value| {
            let is_new = value - last > rounding;
            last = value;
            is_new
        });
        Self(values)
    }

    /// The number of a value this was made with.
    fn of(&self, value: f64) -> u32 {
        // Each level is known by its lowest value. -0 sorts below 0 there, and
        // equals it here.
        self.0
            .partition_point(|&level| level <= value)
            .saturating_sub(1) as u32
    }

    /// The numbers of a place from both ends of its side.
    fn both(&self, place: f64) -> [u32; 2] {
        [self.of(place), self.of(1.0 - place)]
    }
}
