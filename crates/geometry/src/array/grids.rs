//! Patches of a subdivided mesh: the small faces of one coarse face as a grid.

use crate::GeometryError;
use crate::subdivide::Parents;

/// For each coarse face, its grid of vertices in the subdivided mesh.
///
/// A grid of side n has (n + 1)² vertices, row by row with u fastest: vertex
/// (i, j) at u = i / n, v = j / n is entry j (n + 1) + i. Coarse faces without
/// four sides have no grid.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PatchGrids {
    sides: Vec<u32>,
    starts: Vec<u32>,
    vertices: Vec<u32>,
}

impl PatchGrids {
    /// No patches yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The patches of a subdivided mesh in their order; those without one whole
    /// grid, from parents that have not four sides, stay empty.
    ///
    /// # Errors
    /// As [`PatchGrids::push`], which no parents cause.
    pub fn of_parents(parents: &Parents) -> Result<Self, GeometryError> {
        let (mut grids, mut vertices) = (Self::new(), Vec::new());
        for patch in 0..parents.len() {
            vertices.clear();
            let grid = parents.whole_grid(patch).map(|grid| {
                vertices.extend(grid.vertices());
                grid.side() as u32
            });
            grids.push(grid.map(|side| (side, vertices.as_slice())))?;
        }
        Ok(grids)
    }

    /// Adds the next coarse face: its side n and its (n + 1)² vertices, or
    /// `None` for a face without four sides.
    ///
    /// # Errors
    /// [`GeometryError::Invalid`] when the count does not fit the side.
    pub fn push(&mut self, grid: Option<(u32, &[u32])>) -> Result<(), GeometryError> {
        let (side, vertices) = grid.unwrap_or((0, &[]));
        let expected = if grid.is_some() {
            u64::from(side).saturating_add(1).saturating_pow(2)
        } else {
            0
        };
        if grid.is_some() && side == 0 || vertices.len() as u64 != expected {
            return Err(GeometryError::Invalid(format!(
                "the grid of parent {} has side {side} and {} vertices; side n needs (n + 1)²",
                self.sides.len(),
                vertices.len()
            )));
        }
        self.starts.push(self.vertices.len() as u32);
        self.sides.push(side);
        self.vertices.extend_from_slice(vertices);
        Ok(())
    }

    /// How many coarse faces there are, those without a grid included.
    pub fn len(&self) -> usize {
        self.sides.len()
    }

    /// Whether there are no coarse faces.
    pub fn is_empty(&self) -> bool {
        self.sides.is_empty()
    }

    /// The side n of a coarse face's grid and its vertices; `None` if it has none.
    ///
    /// # Panics
    /// If there is no such coarse face.
    pub fn get(&self, parent: usize) -> Option<(u32, &[u32])> {
        let (side, start) = (self.sides[parent], self.starts[parent] as usize);
        let count = (side as usize + 1).pow(2);
        (side > 0).then(|| (side, &self.vertices[start..start + count]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_come_back_as_given() {
        let mut grids = PatchGrids::new();
        grids.push(Some((1, &[4, 5, 6, 7]))).unwrap();
        grids.push(None).unwrap();
        grids.push(Some((2, &[0, 1, 2, 3, 4, 5, 6, 7, 8]))).unwrap();
        assert_eq!(grids.len(), 3);
        assert_eq!(grids.get(0), Some((1, &[4, 5, 6, 7][..])));
        assert_eq!(grids.get(1), None);
        assert_eq!(grids.get(2).unwrap().0, 2);
    }

    #[test]
    fn counts_must_fit_the_side() {
        let mut grids = PatchGrids::new();
        assert!(grids.push(Some((2, &[0, 1, 2, 3]))).is_err());
        assert!(grids.push(Some((0, &[0]))).is_err());
        assert!(grids.push(Some((u32::MAX, &[0]))).is_err());
        assert!(grids.is_empty());
    }
}
