//! Takes values on a coarse mesh's vertices to the fine mesh's.

use std::sync::Arc;

use crate::mesh::Mesh;
use crate::topology::Topology;
use crate::{GeometryError, Monitor, parallel};

use super::cage::{Cage, refine_polygons, split_polygons};
use super::faces::Blocks;
use super::sharpness::Sharpness;
use super::tiles::Tiles;
use super::value::Value;
use super::{Options, Positions, Scheme, bilinear, limit, refine};

/// Everything about a subdivision that does not depend on the values refined.
pub(super) struct Refiner {
    pub(super) options: Options,
    coarse: Arc<Topology>,
    cage: Cage,
    /// The mesh's own sharpness, when the cage is its first refinement.
    before_cage: Option<Sharpness>,
}

impl Refiner {
    pub(super) fn new(
        mesh: &Mesh,
        options: Options,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        let coarse = Arc::clone(mesh.topology());
        coarse.check_manifold()?;
        coarse.check_edges()?;
        let sharpness = Sharpness::read(mesh, options.boundary, monitor)?;
        let (cage, before_cage) = if coarse.faces().all(|face| face.len() == 4) {
            let topology = Arc::clone(&coarse);
            (
                Cage {
                    topology,
                    sharpness,
                },
                None,
            )
        } else {
            (Cage::of_polygons(&coarse, &sharpness)?, Some(sharpness))
        };
        Ok(Self {
            options,
            coarse,
            cage,
            before_cage,
        })
    }

    /// How often the tiles of the cage are halved.
    fn tile_levels(&self) -> u32 {
        let at_cage = u32::from(self.before_cage.is_some());
        self.options.levels.saturating_sub(at_cage)
    }

    /// The numbering of the finest points.
    fn tiles(&self) -> Tiles<'_> {
        Tiles::new(&self.cage.topology, 1 << self.tile_levels())
    }

    pub(super) fn blocks(&self) -> Blocks<'_> {
        Blocks {
            coarse: &self.coarse,
            tiles: self.tiles(),
            refined_cage: self.before_cage.is_some(),
        }
    }

    /// Fine vertices.
    pub(super) fn vertex_count(&self) -> usize {
        if self.options.levels == 0 {
            self.coarse.vertex_count()
        } else {
            self.tiles().point_count()
        }
    }

    /// Values at the fine vertices from `values` at the coarse ones.
    pub(super) fn run<T: Value>(
        &self,
        values: &[T],
        monitor: &dyn Monitor,
    ) -> Result<Vec<T>, GeometryError> {
        let Options {
            scheme,
            levels,
            positions,
            ..
        } = self.options;
        let stays = scheme == Scheme::Bilinear || positions == Positions::Refined;
        if levels == 0 && stays {
            return Ok(values.to_vec());
        }
        let on_cage: Vec<T>;
        let start = match (&self.before_cage, scheme) {
            (None, _) => values,
            (Some(_), Scheme::Bilinear) => {
                on_cage = split_polygons(&self.coarse, values);
                &on_cage
            }
            (Some(sharpness), Scheme::CatmullClark) => {
                on_cage = refine_polygons(&self.coarse, sharpness, values, monitor)?;
                &on_cage
            }
        };
        let tile_levels = self.tile_levels();
        if scheme == Scheme::Bilinear {
            return bilinear::interpolate(&self.cage, 1 << tile_levels, start, monitor);
        }
        let mut refined: Option<Vec<T>> = None;
        for level in 0..tile_levels {
            let from = refined.as_deref().unwrap_or(start);
            refined = Some(refine::refine(
                &self.cage,
                1 << level,
                level,
                from,
                monitor,
            )?);
        }
        let mut finest = match (refined, positions) {
            (Some(refined), Positions::Refined) => refined,
            (None, Positions::Refined) => start.to_vec(),
            (refined, Positions::Limit) => {
                let from = refined.as_deref().unwrap_or(start);
                limit::project(&self.cage, 1 << tile_levels, tile_levels, from, monitor)?
            }
        };
        finest.truncate(self.vertex_count());
        Ok(finest)
    }

    /// The coarse vertex nearest to each fine one, counted in cells; of equally
    /// near ones the first.
    pub(super) fn nearest_vertices(
        &self,
        monitor: &dyn Monitor,
    ) -> Result<Vec<u32>, GeometryError> {
        let mut on_cage: Vec<u32> = (0..self.coarse.vertex_count() as u32).collect();
        if self.options.levels == 0 {
            return Ok(on_cage);
        }
        if self.before_cage.is_some() {
            let edges = self.coarse.adjacency().edges().iter();
            on_cage.extend(edges.map(|edge| edge[0]));
            on_cage.extend(self.coarse.faces().map(|face| face[0]));
        }
        let tiles = self.tiles();
        let side = tiles.side;
        let mut out = vec![0; tiles.point_count()];
        let (vertices, edges, faces) = tiles.split(&mut out);
        vertices.copy_from_slice(&on_cage);
        let nothing = || ();
        parallel::fill_rows(
            edges,
            tiles.edge_len(),
            monitor,
            nothing,
            |(), edge, out| {
                let ends = tiles.cage.adjacency().edge(edge);
                for (k, slot) in out.iter_mut().enumerate() {
                    *slot = on_cage[ends[usize::from(2 * (k + 1) > side)] as usize];
                }
            },
        )?;
        parallel::fill_rows(
            faces,
            tiles.face_len(),
            monitor,
            nothing,
            |(), face, out| {
                let quad = tiles.cage.face(face);
                for (k, slot) in out.iter_mut().enumerate() {
                    let (i, j) = (k % (side - 1) + 1, k / (side - 1) + 1);
                    let far = |t: usize| usize::from(2 * t > side);
                    *slot = on_cage[quad[[[0, 1], [3, 2]][far(j)][far(i)]] as usize];
                }
            },
        )?;
        Ok(out)
    }
}
