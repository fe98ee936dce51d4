//! Where the corners of extruded faces go.

use glam::DVec3;

use super::extrude::{ExtrudeMode, ExtrudeOptions};
use crate::math::symmetric_axes;
use crate::normals::{corner_angle, face_normals};
use crate::{GeometryError, Mesh, Monitor, parallel};

/// Longest mitre for height 1: of planes that meet at less than 6 degrees.
const LONGEST: f64 = 20.0;

/// Share of the largest eigenvalue below which the planes at a vertex count as
/// one: those of faces within 0.001 degrees of each other.
const FLAT: f64 = 1e-10;

/// Corners that move together, and how.
pub(super) struct Push<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) options: &'a ExtrudeOptions<'a>,
    /// Which faces move, one value per face.
    pub(super) pushed: &'a [bool],
    /// The fan of each corner.
    pub(super) fans: &'a [u32],
    /// The vertex of each fan.
    pub(super) sources: &'a [u32],
}

impl Push<'_> {
    /// Where each fan goes; fans of faces that do not move, anywhere.
    pub(super) fn places(&self, monitor: &dyn Monitor) -> Result<Vec<DVec3>, GeometryError> {
        if let Some(directions) = self.options.directions {
            directions.check(self.mesh)?;
        }
        let normals = face_normals(self.mesh, monitor)?;
        let ways = parallel::map(self.sources.len(), monitor, |fan| self.way(fan, &normals))?;
        self.check(&ways, &normals)?;
        let positions = self.mesh.positions();
        let place = |(way, &vertex): (&DVec3, &u32)| positions[vertex as usize] + *way;
        Ok(ways.iter().zip(self.sources).map(place).collect())
    }

    /// The corners of pushed faces in a fan.
    fn corners(&self, fan: usize) -> impl Iterator<Item = u32> {
        let adjacency = self.mesh.topology().adjacency();
        let at = adjacency.vertex_corners(self.sources[fan] as usize);
        at.iter().copied().filter(move |&corner| {
            let face = adjacency.corner_faces()[corner as usize];
            self.fans[corner as usize] as usize == fan && self.pushed[face as usize]
        })
    }

    /// How far and where to a fan moves; zero where nothing says so.
    fn way(&self, fan: usize, normals: &[DVec3]) -> DVec3 {
        let faces = self.mesh.topology().adjacency().corner_faces();
        let vertex = self.sources[fan];
        let (mut planes, mut normal) = ([[0.0; 3]; 3], DVec3::ZERO);
        let (mut rise, mut angles) = (0.0, 0.0);
        for corner in self.corners(fan) {
            let face = faces[corner as usize] as usize;
            let height = self.options.height.at_corner(face, vertex);
            if self.options.mode == ExtrudeMode::Individual && self.options.directions.is_none() {
                return normals[face] * height;
            }
            let angle = corner_angle(self.mesh, corner);
            rise += angle * height;
            angles += angle;
            normal += normals[face] * angle;
            let plane = normals[face].to_array();
            for (i, row) in planes.iter_mut().enumerate() {
                for (j, cell) in row.iter_mut().enumerate() {
                    *cell += plane[i] * plane[j] * angle;
                }
            }
        }
        let height = if angles > 0.0 { rise / angles } else { 0.0 };
        match self.options.directions {
            Some(directions) => directions.side(height)[vertex as usize] * height,
            None => mitre(planes, normal) * height,
        }
    }

    /// Names what cannot move although it has a height.
    fn check(&self, ways: &[DVec3], normals: &[DVec3]) -> Result<(), GeometryError> {
        let faces = self.mesh.topology().adjacency().corner_faces();
        let stuck = |fan: &usize| {
            ways[*fan] == DVec3::ZERO
                && self.corners(*fan).any(|corner| {
                    let face = faces[corner as usize] as usize;
                    self.options.height.at_corner(face, self.sources[*fan]) != 0.0
                })
        };
        let mut vertices: Vec<u32> = (0..ways.len())
            .filter(stuck)
            .map(|fan| self.sources[fan])
            .collect();
        if vertices.is_empty() {
            return Ok(());
        }
        if self.options.directions.is_some() {
            vertices.sort_unstable();
            vertices.dedup();
            return Err(GeometryError::ZeroDirection { vertices });
        }
        if self.options.mode == ExtrudeMode::Region {
            vertices.sort_unstable();
            vertices.dedup();
            return Err(GeometryError::NoNormal { vertices });
        }
        let flat =
            |face: &u32| self.pushed[*face as usize] && normals[*face as usize] == DVec3::ZERO;
        let faces = (0..self.mesh.face_count() as u32).filter(flat).collect();
        Err(GeometryError::NoArea { faces })
    }
}

/// The shortest vector with the least Σ α (N · M - 1)², from Σ α N Nᵀ and Σ α N;
/// cut at [`LONGEST`]. Zero where the normals cancel out or there are none.
fn mitre(planes: [[f64; 3]; 3], normal: DVec3) -> DVec3 {
    let (sizes, axes) = symmetric_axes(planes);
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let along = |(size, axis): (f64, DVec3)| {
        if size > most * FLAT {
            axis * (axis.dot(normal) / size)
        } else {
            DVec3::ZERO
        }
    };
    let mitre: DVec3 = sizes.into_iter().zip(axes).map(along).sum();
    mitre.clamp_length_max(LONGEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(normals: &[DVec3]) -> DVec3 {
        let mut planes = [[0.0; 3]; 3];
        for normal in normals {
            let n = normal.to_array();
            for (i, row) in planes.iter_mut().enumerate() {
                for (j, cell) in row.iter_mut().enumerate() {
                    *cell += n[i] * n[j];
                }
            }
        }
        mitre(planes, normals.iter().sum())
    }

    #[test]
    fn planes_move_by_one_each() {
        let lean = DVec3::new(0.6, 0.0, 0.8);
        assert!((of(&[DVec3::Z]) - DVec3::Z).length() < 1e-15);
        assert!((of(&[DVec3::X, DVec3::Y, DVec3::Z]) - DVec3::ONE).length() < 1e-14);
        let found = of(&[DVec3::Z, lean, DVec3::Y]);
        for normal in [DVec3::Z, lean, DVec3::Y] {
            assert!((found.dot(normal) - 1.0).abs() < 1e-14, "{found}");
        }
        // Two planes: the shortest vector lies across their edge.
        let found = of(&[DVec3::Z, lean]);
        assert!(found.y.abs() < 1e-15 && (found.dot(lean) - 1.0).abs() < 1e-14);
        // Almost one plane: no jump to the side.
        let hair = DVec3::new(1e-6, 0.0, 1.0).normalize();
        assert!((of(&[DVec3::Z, hair]) - DVec3::Z).length() < 1e-5);
    }

    #[test]
    fn needles_are_cut_and_opposite_planes_give_nothing() {
        let [a, b] = [1.0, -1.0].map(|x| DVec3::new(x, 0.0, 0.01).normalize());
        assert!((of(&[a, b]).length() - LONGEST).abs() < 1e-12);
        assert!(of(&[DVec3::Z, DVec3::NEG_Z]).length() < 1e-15);
        assert_eq!(of(&[]), DVec3::ZERO);
    }
}
