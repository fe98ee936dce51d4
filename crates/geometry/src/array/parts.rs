//! What an array is put together from, for whoever draws it without making it.

use glam::{DVec2, DVec3};

use super::basis::{GridPlace, Weights};
use super::layout::Layout;
use super::map::{Map, Vectors};
use super::{ArrayOptions, Join, Piece, check_directions, pieces_of, weld};
use crate::buffer::Buffer;
use crate::{Directions, GeometryError, Mesh, Monitor};

/// A vertex of a component over grids of one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartPoint {
    /// Where (u, v) lies in the grid.
    pub place: GridPlace,
    /// Where (u', v') lies in it.
    pub direction: GridPlace,
    /// Vertices in a row of the grid: n + 1 for a grid of side n.
    pub row: u32,
    /// w in metres, times everything that is constant over the array.
    pub height: f64,
}

/// Directions of one side of the base, in the form that is interpolated.
#[derive(Debug, Clone, PartialEq)]
pub struct PartVectors {
    /// Unit directions, or the vectors themselves without `lengths`; one per
    /// vertex of the base.
    pub directions: Vec<DVec3>,
    /// Their lengths, interpolated apart; `None` for linear interpolation.
    pub lengths: Option<Vec<f64>>,
}

/// An array before it is made: the component's points once, and the base's
/// values under each placement. [`ArrayParts::position`] is the formula of
/// [`super::array_components`] over them.
#[derive(Debug, Clone)]
pub struct ArrayParts {
    /// The points of all components, component by component.
    pub points: Vec<PartPoint>,
    /// The base's vertices under each placement, row by row with u fastest.
    pub grids: Vec<u32>,
    /// Where the grid of each placement begins.
    pub grid_starts: Vec<u32>,
    /// The placement and the point of each vertex of the array.
    pub vertices: Vec<[u32; 2]>,
    /// Positions of the base.
    pub positions: Buffer<DVec3>,
    /// Directions for heights from 0 on.
    pub outward: PartVectors,
    /// Directions for heights below 0; `None` where they are the same.
    pub inward: Option<PartVectors>,
    /// Factors on heights per vertex of the base, interpolated one by one and then
    /// multiplied: its size for relative heights, and the scale if it varies.
    pub factors: Vec<Vec<f64>>,
}

/// Takes an array apart that [`super::array_components`] would make of the same
/// arguments: its vertices are those of that array, in the same order.
///
/// Cost: O(vertices of the array), a fraction of making it.
///
/// # Errors
/// As [`super::array_components`].
pub fn array_parts(
    base: &Mesh,
    components: &[&Mesh],
    directions: &Directions,
    options: &ArrayOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<ArrayParts, GeometryError> {
    directions.check(base)?;
    let pieces = pieces_of(components, directions, options)?;
    let layout = Layout::new(base, &pieces, options, monitor)?;
    if !options.allow_zero_directions {
        check_directions(directions, &pieces, &layout)?;
    }
    let map = Map::new(base, directions, &pieces, &layout, options, monitor)?;
    let (points, basis_starts) = points(&map, &pieces);
    let targets = match options.join {
        Join::None => None,
        Join::Weld => Some(weld::targets(&pieces, &layout).0),
    };
    let mut vertices = Vec::new();
    let mut vertex = 0;
    for (placement, &basis) in (0u32..).zip(&map.basis_of) {
        let count = map.bases[basis as usize].points.len();
        for point in (0..count as u32).map(|point| basis_starts[basis as usize] + point) {
            // Of joined vertices the first one stands for all.
            let stands = targets
                .as_ref()
                .is_none_or(|targets| targets[vertex as usize] == vertex);
            if stands {
                vertices.push([placement, point]);
            }
            vertex += 1;
        }
    }
    let (mut grids, mut grid_starts, mut grid) = (Vec::new(), Vec::new(), Vec::new());
    for placement in 0..layout.placements.len() {
        layout.grid(placement, &mut grid);
        grid_starts.push(grids.len() as u32);
        grids.extend_from_slice(&grid);
    }
    let factors = map.factors();
    let (outward, inward) = map.into_vectors();
    Ok(ArrayParts {
        points,
        grids,
        grid_starts,
        vertices,
        positions: base.positions().clone(),
        outward: outward.into(),
        inward: inward.map(PartVectors::from),
        factors,
    })
}

/// The points of all bases, and where those of each begin.
fn points(map: &Map<'_>, pieces: &[Piece]) -> (Vec<PartPoint>, Vec<u32>) {
    let (mut points, mut starts) = (Vec::new(), Vec::new());
    for basis in &map.bases {
        starts.push(points.len() as u32);
        let normal_uv = &pieces[basis.component as usize].normal_uv;
        let place = |uv: DVec2| GridPlace::new(uv, basis.side);
        points.extend(
            basis
                .points
                .iter()
                .zip(normal_uv)
                .map(|(point, &normal_uv)| PartPoint {
                    place: place(point.uv),
                    direction: place(normal_uv),
                    row: basis.side + 1,
                    height: point.height,
                }),
        );
    }
    (points, starts)
}

impl From<Vectors> for PartVectors {
    fn from(vectors: Vectors) -> Self {
        Self {
            directions: vectors.directions,
            lengths: vectors.lengths,
        }
    }
}

impl ArrayParts {
    /// Where a vertex of the array lies when all heights are `factor` times what
    /// they are: X = P(u, v) + factor w s k D(u', v').
    ///
    /// # Panics
    /// If there is no such vertex.
    pub fn position(&self, vertex: usize, factor: f64) -> DVec3 {
        let [placement, point] = self.vertices[vertex];
        let point = &self.points[point as usize];
        let start = self.grid_starts[placement as usize] as usize;
        let grid = &self.grids[start..];
        let place = Weights::of(point.place, point.row - 1);
        let height = self.factors.iter().fold(factor * point.height, |h, of| {
            h * place.sum_by(|at| of[grid[at] as usize])
        });
        let side = match &self.inward {
            Some(inward) if height < 0.0 => inward,
            _ => &self.outward,
        };
        let direction = Weights::of(point.direction, point.row - 1);
        let sum = direction.sum_by(|at| side.directions[grid[at] as usize]);
        let direction = match &side.lengths {
            Some(lengths) => {
                let length = direction.sum_by(|at| lengths[grid[at] as usize]);
                super::map::with_length(sum, length)
            }
            None => sum,
        };
        place.sum_by(|at| self.positions[grid[at] as usize]) + direction * height
    }
}
