//! Which component goes where, and where its elements start in the output.

use super::{ArrayDomain, ArrayOptions, NO_COMPONENT, Piece, faces};
use crate::{Domain, GeometryError, Mesh, Monitor, Topology};

/// How much an array would hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ArrayCounts {
    /// Components placed.
    pub placed: u64,
    /// Vertices, before neighbours are joined.
    pub vertices: u64,
    /// Faces.
    pub faces: u64,
    /// Corners.
    pub corners: u64,
    /// Bytes of positions, faces, provenance and the components' attributes.
    pub bytes: u64,
}

/// Counts what [`super::array_components`] would make, without making it.
///
/// `components` as they are given to the array, `choose` as in
/// [`ArrayOptions::choose`] over `cells` faces or parents with `turns` ignored;
/// a cell that turns out to have no grid makes the true figure smaller, and
/// faces of a [`crate::Fit::Cell`] are counted. Cost: O(cells).
///
/// # Errors
/// [`GeometryError::TooMany`] when 32-bit indices cannot name the result;
/// those of [`super::array_components`] for `choose`.
pub fn array_counts(
    components: &[&Mesh],
    cells: usize,
    choose: Option<&[u32]>,
) -> Result<ArrayCounts, GeometryError> {
    let times = count_choices(components.len(), cells, choose)?;
    let mut total = [0u128; 5];
    for (component, &times) in components.iter().zip(&times) {
        let [v, f, c] = [
            component.vertex_count(),
            component.face_count(),
            component.corner_count(),
        ];
        let carried: usize = component
            .attributes()
            .iter()
            .map(|a| value_bytes(a.values()) * component.element_count(a.domain()))
            .sum();
        // Position, offset and corner indices, and three whole numbers per face.
        let bytes = 24 * v + (4 + 3 * 8) * f + 4 * c + carried;
        for (sum, one) in total.iter_mut().zip([1, v, f, c, bytes]) {
            *sum += u128::from(times) * one as u128;
        }
    }
    for (what, count) in [
        ("vertices of the array", total[1]),
        ("corners of the array", total[3]),
    ] {
        let limit = u128::from(u32::MAX - 1);
        if count > limit {
            return Err(GeometryError::TooMany { what, count, limit });
        }
    }
    let [placed, vertices, faces, corners, bytes] =
        total.map(|n| u64::try_from(n).unwrap_or(u64::MAX));
    Ok(ArrayCounts {
        placed,
        vertices,
        faces,
        corners,
        bytes,
    })
}

fn value_bytes(values: &crate::AttributeValues) -> usize {
    match values {
        crate::AttributeValues::Integer(_) | crate::AttributeValues::Number(_) => 8,
        crate::AttributeValues::Vector2(_) => 16,
        crate::AttributeValues::Vector3(_) => 24,
    }
}

/// How often each component is placed.
fn count_choices(
    components: usize,
    cells: usize,
    choose: Option<&[u32]>,
) -> Result<Vec<u64>, GeometryError> {
    if components == 0 {
        return Err(GeometryError::Empty {
            what: "the array",
            missing: "component",
        });
    }
    let mut times = vec![0; components];
    let Some(choose) = choose else {
        times[0] = cells as u64;
        return Ok(times);
    };
    if choose.len() != cells {
        return Err(GeometryError::FieldLength {
            domain: Domain::Face,
            expected: cells,
            actual: choose.len(),
        });
    }
    for (cell, &component) in choose.iter().enumerate() {
        match times.get_mut(component as usize) {
            Some(times) => *times += 1,
            None if component == NO_COMPONENT => {}
            None => {
                return Err(GeometryError::Invalid(format!(
                    "{} asks for component {component}, but there are {components}, \
                     counted from 0",
                    faces(&[cell as u32])
                )));
            }
        }
    }
    Ok(times)
}

/// One component on one face or parent.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placement {
    /// The face or parent.
    pub(super) cell: u32,
    pub(super) component: u32,
    pub(super) turns: u8,
}

/// All placements in output order, and where the elements of each start.
pub(super) struct Layout<'a> {
    base: &'a Topology,
    domain: ArrayDomain<'a>,
    pub(super) placements: Vec<Placement>,
    pub(super) vertex_starts: Vec<u32>,
    pub(super) face_starts: Vec<u32>,
    pub(super) corner_starts: Vec<u32>,
    /// Parents without a grid that a component was chosen for.
    pub(super) skipped: usize,
}

impl<'a> Layout<'a> {
    pub(super) fn new(
        base: &'a Mesh,
        pieces: &[Piece],
        options: &ArrayOptions<'a>,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        let cells = match options.domain {
            ArrayDomain::Face => base.face_count(),
            ArrayDomain::Parent(grids) => grids.len(),
        };
        let meshes: Vec<&Mesh> = pieces.iter().map(|piece| &piece.mesh).collect();
        // Refuses what cannot be indexed or held before anything is allocated.
        let counts = array_counts(&meshes, cells, options.choose)?;
        monitor.afford(counts.bytes.into())?;
        check_turns(options.turns, cells)?;
        let mut layout = Self {
            base: base.topology(),
            domain: options.domain,
            placements: Vec::with_capacity(counts.placed as usize),
            vertex_starts: vec![0],
            face_starts: vec![0],
            corner_starts: vec![0],
            skipped: 0,
        };
        for cell in 0..cells {
            let component = options.choose.map_or(0, |choose| choose[cell]);
            if component == NO_COMPONENT {
                continue;
            }
            if layout.has_grid(cell)? {
                let turns = options.turns.map_or(0, |turns| turns[cell] % 4);
                layout.place(cell, component, turns, meshes[component as usize]);
            } else {
                layout.skipped += 1;
            }
        }
        layout.check_grids()?;
        Ok(layout)
    }

    fn has_grid(&self, cell: usize) -> Result<bool, GeometryError> {
        match self.domain {
            ArrayDomain::Parent(grids) => Ok(grids.get(cell).is_some()),
            ArrayDomain::Face => match self.base.face(cell).len() {
                3 | 4 => Ok(true),
                corners => Err(GeometryError::NotQuad {
                    face: cell,
                    corners,
                    advice: "split it with TriangulateFaces, FanFaces or SplitIntoQuads",
                }),
            },
        }
    }

    fn place(&mut self, cell: usize, component: u32, turns: u8, mesh: &Mesh) {
        fn extend(starts: &mut Vec<u32>, count: usize) {
            // The sums were checked against u32 by `array_counts`.
            let last = starts.last().copied().unwrap_or(0);
            starts.push(last + count as u32);
        }
        self.placements.push(Placement {
            cell: cell as u32,
            component,
            turns,
        });
        extend(&mut self.vertex_starts, mesh.vertex_count());
        extend(&mut self.face_starts, mesh.face_count());
        extend(&mut self.corner_starts, mesh.corner_count());
    }

    /// Grids come from elsewhere: their vertices must exist in this base.
    fn check_grids(&self) -> Result<(), GeometryError> {
        let ArrayDomain::Parent(grids) = self.domain else {
            return Ok(());
        };
        for placement in &self.placements {
            let (_, vertices) = grids.get(placement.cell as usize).unwrap_or((0, &[]));
            let vertex_count = self.base.vertex_count();
            if let Some(&index) = vertices.iter().find(|&&v| v as usize >= vertex_count) {
                return Err(GeometryError::IndexOutOfRange {
                    face: placement.cell as usize,
                    index: index as usize,
                    vertex_count,
                });
            }
        }
        Ok(())
    }

    /// Vertices of the base.
    pub(super) fn base_vertex_count(&self) -> usize {
        self.base.vertex_count()
    }

    /// Whether cells are faces of the base, not parents.
    pub(super) fn is_by_face(&self) -> bool {
        matches!(self.domain, ArrayDomain::Face)
    }

    /// Side n of the grid under a placement: 1 for a face.
    pub(super) fn side(&self, placement: usize) -> u32 {
        match self.domain {
            ArrayDomain::Face => 1,
            ArrayDomain::Parent(grids) => {
                let cell = self.placements[placement].cell as usize;
                grids.get(cell).map_or(1, |(side, _)| side)
            }
        }
    }

    /// Fills `out` with the (n + 1)² elements under a placement, row by row
    /// with u fastest, as its quarter turns put them; returns n. The elements
    /// are vertices.
    pub(super) fn grid(&self, placement: usize, out: &mut Vec<u32>) -> u32 {
        let Placement { cell, turns, .. } = self.placements[placement];
        out.clear();
        match self.domain {
            ArrayDomain::Face => out.extend(square(self.base.face(cell as usize), turns)),
            ArrayDomain::Parent(grids) => {
                let (side, vertices) = grids.get(cell as usize).unwrap_or((0, &[]));
                turned(side, vertices, turns, out);
                return side;
            }
        }
        1
    }

    /// As [`Layout::grid`] for corners; only faces have them.
    pub(super) fn corner_grid(&self, placement: usize) -> [u32; 4] {
        let Placement { cell, turns, .. } = self.placements[placement];
        let range = self.base.corner_range(cell as usize);
        let start = range.start as u32;
        let corners = [start, start + 1, start + 2, start + 3];
        square(&corners[..range.len().min(4)], turns)
    }
}

/// Corners of a face in grid order (0,0) (1,0) (0,1) (1,1). A triangle's edge
/// v = 1 is its third corner, and it does not turn.
fn square(corners: &[u32], turns: u8) -> [u32; 4] {
    match *corners {
        [a, b, c, d] => {
            let corner = |k: usize| [a, b, c, d][(k + 4 - turns as usize) % 4];
            [corner(0), corner(1), corner(3), corner(2)]
        }
        [a, b, c] => [a, b, c, c],
        // `Layout::new` lets no other face through.
        _ => [0; 4],
    }
}

/// A grid of side n after quarter turns: each puts (0, 0) where (0, 1) was.
fn turned(side: u32, vertices: &[u32], turns: u8, out: &mut Vec<u32>) {
    for j in 0..=side {
        for i in 0..=side {
            let (mut i, mut j) = (i, j);
            for _ in 0..turns {
                (i, j) = (j, side - i);
            }
            out.push(vertices[(j * (side + 1) + i) as usize]);
        }
    }
}

fn check_turns(turns: Option<&[u8]>, cells: usize) -> Result<(), GeometryError> {
    match turns {
        Some(turns) if turns.len() != cells => Err(GeometryError::FieldLength {
            domain: Domain::Face,
            expected: cells,
            actual: turns.len(),
        }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_a_grid_of_side_one_is_turning_a_quad() {
        for turns in 0..4 {
            let mut grid = Vec::new();
            turned(1, &square(&[5, 6, 7, 8], 0), turns, &mut grid);
            assert_eq!(grid, square(&[5, 6, 7, 8], turns));
        }
        assert_eq!(square(&[5, 6, 7, 8], 1), [8, 5, 7, 6]);
        assert_eq!(square(&[5, 6, 7], 1), [5, 6, 7, 7]);
    }

    #[test]
    fn four_turns_are_none() {
        let vertices: Vec<u32> = (0..9).collect();
        let mut grid = vertices.clone();
        for _ in 0..4 {
            let before = std::mem::take(&mut grid);
            turned(2, &before, 1, &mut grid);
            assert_ne!(grid, before);
        }
        assert_eq!(grid, vertices);
    }

    #[test]
    fn counts_refuse_what_indices_cannot_name() {
        let mesh = Mesh::from_faces(vec![[0.0; 3]; 4], &[&[0, 1, 2, 3]]).unwrap();
        let counts = array_counts(&[&mesh], 1000, None).unwrap();
        assert_eq!(
            (counts.vertices, counts.faces, counts.corners),
            (4000, 1000, 4000)
        );
        let error = array_counts(&[&mesh], usize::MAX, None).unwrap_err();
        assert!(matches!(error, GeometryError::TooMany { .. }));
    }
}
