//! Meshes cut by a plane.

use glam::DVec3;
use rayon::prelude::*;

use crate::parallel::CHUNK;
use crate::{GeometryError, Mesh, Monitor};

/// A plane: the places x with `normal · x = at`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit vector.
    pub normal: DVec3,
    /// Distance from the origin along the normal, in metres.
    pub at: f64,
}

/// A straight piece of a cut: where the plane crosses a triangle of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutSegment {
    /// Where it begins; seen against the normal the body lies to the left.
    pub from: DVec3,
    /// Where it ends.
    pub to: DVec3,
    /// The face that is cut.
    pub face: u32,
    /// Whether its outline comes back to where it began.
    pub is_closed: bool,
}

/// The cut of a mesh by a plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// In the order of faces and their triangles.
    pub segments: Vec<CutSegment>,
    /// Outlines that come back to where they began.
    pub closed: usize,
    /// Outlines that end somewhere, at borders of the mesh: the body is open there.
    pub open: usize,
}

impl Plane {
    /// How far a place is from the plane, positive on the side of the normal.
    pub fn distance(&self, place: DVec3) -> f64 {
        self.normal.dot(place) - self.at
    }
}

impl Section {
    /// Cuts a mesh. Its surface is that of [`Mesh::triangles`]; a place on the plane
    /// counts as above it, so that a cut through vertices or along faces is the one
    /// just below them and its outlines close wherever the mesh does.
    ///
    /// Each segment runs along `normal × n` for the normal n of its triangle. Its
    /// ends are found on the sides of triangles from the lower vertex to the
    /// higher, so that neighbours meet in the same place to the last bit.
    ///
    /// Cost: O(corners) on all threads, and O(s log s) for s segments.
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`] when `monitor` asks to stop.
    pub fn cut(mesh: &Mesh, plane: Plane, monitor: &dyn Monitor) -> Result<Self, GeometryError> {
        let faces = mesh.face_count();
        let chunks = (0..faces.div_ceil(CHUNK)).into_par_iter().map(|chunk| {
            monitor.check()?;
            let faces = chunk * CHUNK..faces.min((chunk + 1) * CHUNK);
            let mut pieces = Vec::new();
            let crossed = faces.filter(|&face| is_crossed(mesh, plane, face));
            mesh.for_triangles(crossed, |face, triangle| {
                pieces.extend(cut_triangle(mesh, plane, face, triangle));
            });
            Ok(pieces)
        });
        let pieces: Vec<Vec<Piece>> = chunks.collect::<Result<_, GeometryError>>()?;
        Ok(Self::join(&pieces.concat()))
    }

    /// Tells outlines that close from those that do not.
    fn join(pieces: &[Piece]) -> Self {
        let mut ends: Vec<(Side, u32)> = Vec::with_capacity(2 * pieces.len());
        for (piece, index) in pieces.iter().zip(0..) {
            ends.extend(piece.sides.map(|side| (side, index)));
        }
        ends.sort_unstable();
        let mut outlines = Outlines::new(pieces.len());
        for meeting in ends.chunk_by(|one, other| one.0 == other.0) {
            for pair in meeting.windows(2) {
                outlines.unite(pair[0].1, pair[1].1);
            }
        }
        let mut is_open = vec![false; pieces.len()];
        for meeting in ends.chunk_by(|one, other| one.0 == other.0) {
            if meeting.len() % 2 == 1 {
                is_open[outlines.root(meeting[0].1) as usize] = true;
            }
        }
        let mut section = Self::default();
        for (piece, index) in pieces.iter().zip(0..) {
            let root = outlines.root(index);
            if root == index {
                *if is_open[root as usize] {
                    &mut section.open
                } else {
                    &mut section.closed
                } += 1;
            }
            section.segments.push(CutSegment {
                from: piece.from,
                to: piece.to,
                face: piece.face,
                is_closed: !is_open[root as usize],
            });
        }
        section
    }

    /// Length of all outlines, in metres.
    pub fn length(&self) -> f64 {
        let lengths = self.segments.iter();
        lengths.map(|piece| piece.from.distance(piece.to)).sum()
    }

    /// Area within the closed outlines, in square metres: ½ Σ (from × to) · normal,
    /// about the first place. Holes count negatively, and where bodies overlap the
    /// area counts for each of them.
    pub fn area(&self, normal: DVec3) -> f64 {
        let closed = self.segments.iter().filter(|piece| piece.is_closed);
        let about = self
            .segments
            .first()
            .map_or(DVec3::ZERO, |first| first.from);
        let doubled = closed.map(|piece| (piece.from - about).cross(piece.to - about).dot(normal));
        doubled.sum::<f64>() / 2.0
    }

    /// The place of the cut that is closest to `near`: an end of a segment if one is
    /// within `snap` metres, else a place within a segment. `None` of an empty cut.
    ///
    /// Cost: O(segments).
    pub fn closest(&self, near: DVec3, snap: f64) -> Option<DVec3> {
        let least = |places: &mut dyn Iterator<Item = DVec3>| {
            places.min_by(|one, other| {
                let squared = |place: &DVec3| place.distance_squared(near);
                squared(one).total_cmp(&squared(other))
            })
        };
        let ends = &mut self
            .segments
            .iter()
            .flat_map(|piece| [piece.from, piece.to]);
        let end = least(ends)?;
        if end.distance(near) <= snap {
            return Some(end);
        }
        least(&mut self.segments.iter().map(|piece| piece.closest(near)))
    }
}

impl CutSegment {
    /// The place within the segment that is closest to `near`.
    fn closest(&self, near: DVec3) -> DVec3 {
        let along = self.to - self.from;
        let squared = along.length_squared();
        if squared == 0.0 {
            return self.from;
        }
        let share = (near - self.from).dot(along) / squared;
        self.from + along * share.clamp(0.0, 1.0)
    }
}

/// A side of a triangle: its lower vertex and its higher one.
type Side = (u32, u32);

/// A segment, and the sides that its ends lie on.
#[derive(Clone, Copy)]
struct Piece {
    from: DVec3,
    to: DVec3,
    face: u32,
    sides: [Side; 2],
}

fn is_above(mesh: &Mesh, plane: Plane, vertex: u32) -> bool {
    plane.distance(mesh.positions()[vertex as usize]) >= 0.0
}

/// Whether a face has vertices on both sides.
fn is_crossed(mesh: &Mesh, plane: Plane, face: usize) -> bool {
    let vertices = mesh.face(face);
    let above = vertices.iter().filter(|&&v| is_above(mesh, plane, v));
    (1..vertices.len()).contains(&above.count())
}

/// Where a plane crosses a triangle, which is given by its corners.
fn cut_triangle(mesh: &Mesh, plane: Plane, face: usize, corners: [u32; 3]) -> Option<Piece> {
    let vertices = corners.map(|corner| mesh.topology().corners()[corner as usize]);
    let above = vertices.map(|vertex| is_above(mesh, plane, vertex));
    let mut ends = [None; 2];
    for k in 0..3 {
        let next = (k + 1) % 3;
        if above[k] != above[next] {
            // The border of the triangle goes down where the segment begins.
            let (a, b) = (vertices[k], vertices[next]);
            ends[usize::from(above[next])] = Some((a.min(b), a.max(b)));
        }
    }
    let [first, last] = [ends[0]?, ends[1]?];
    let crossing = |(low, high): Side| {
        let [low, high] = [low, high].map(|vertex| mesh.positions()[vertex as usize]);
        let (d, e) = (plane.distance(low), plane.distance(high));
        low + (high - low) * (d / (d - e))
    };
    Some(Piece {
        from: crossing(first),
        to: crossing(last),
        face: face as u32,
        sides: [first, last],
    })
}

/// Which segments belong together: a forest in which each leads to its outline.
struct Outlines(Vec<u32>);

impl Outlines {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&mut self, mut index: u32) -> u32 {
        while self.0[index as usize] != index {
            let above = self.0[self.0[index as usize] as usize];
            self.0[index as usize] = above;
            index = above;
        }
        index
    }

    /// The lower of two roots becomes that of both.
    fn unite(&mut self, one: u32, other: u32) {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other) as usize] = one.min(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::primitives::{cuboid, grid};
    use crate::{join, test_shapes};

    fn cut(mesh: &Mesh, normal: DVec3, at: f64) -> Section {
        Section::cut(mesh, Plane { normal, at }, &Unmonitored).unwrap()
    }

    #[test]
    fn a_box_is_cut_in_a_rectangle() {
        let body = cuboid(DVec3::new(2.0, 3.0, 4.0), [2, 3, 4], false).unwrap();
        let section = cut(&body, DVec3::Z, 1.5);
        assert_eq!((section.closed, section.open), (1, 0));
        assert!((section.length() - 10.0).abs() < 1e-12);
        assert!((section.area(DVec3::Z) - 6.0).abs() < 1e-12);
        // From the other side the same area, and across the corner a triangle.
        assert!((cut(&body, DVec3::NEG_Z, -1.5).area(DVec3::NEG_Z) - 6.0).abs() < 1e-12);
        let normal = DVec3::ONE.normalize();
        let corner = cut(&body, normal, 1.0 / 3f64.sqrt());
        assert!((corner.area(normal) - 3f64.sqrt() / 2.0).abs() < 1e-12);
        assert!((corner.length() - 3.0 * 2f64.sqrt()).abs() < 1e-12);
        assert_eq!(cut(&body, DVec3::Z, 5.0), Section::default());
    }

    #[test]
    fn planes_through_vertices_and_faces_cut_just_below_them() {
        let body = cuboid(DVec3::ONE, [2, 2, 2], false).unwrap();
        for (at, area) in [(0.0, 0.0), (0.5, 1.0), (1.0, 1.0)] {
            let section = cut(&body, DVec3::Z, at);
            assert_eq!(
                (section.closed, section.open),
                (usize::from(area > 0.0), 0),
                "{at}"
            );
            assert!((section.area(DVec3::Z) - area).abs() < 1e-15, "{at}");
        }
    }

    #[test]
    fn open_skins_and_solids_are_told_apart() {
        let skin = test_shapes::cylinder(12, 3);
        let across = cut(&skin, DVec3::X, 0.1);
        assert_eq!((across.closed, across.open), (0, 2));
        assert!(across.area(DVec3::X).abs() < 1e-15);
        let around = cut(&skin, DVec3::Z, 0.4);
        assert_eq!((around.closed, around.open), (1, 0));
        let sheet = grid([3, 1], glam::DVec2::ONE, false).unwrap();
        let body = cuboid(DVec3::ONE, [1, 1, 1], true).unwrap();
        let both = join(&[&sheet, &body]).unwrap();
        let section = cut(&both, DVec3::X, 0.2);
        assert_eq!((section.closed, section.open), (1, 1));
        assert!((section.area(DVec3::X) - 1.0).abs() < 1e-12);
        assert!((section.length() - 5.0).abs() < 1e-12);
    }

    #[test]
    fn places_of_the_cut_are_corners_where_one_is_near() {
        let body = cuboid(DVec3::new(2.0, 2.0, 2.0), [1, 1, 1], false).unwrap();
        let section = cut(&body, DVec3::Z, 1.0);
        let near = DVec3::new(0.01, 0.02, 1.0);
        assert_eq!(section.closest(near, 0.1), Some(DVec3::Z));
        let side = section.closest(near, 0.001).unwrap();
        assert!(side.distance(DVec3::new(0.0, 0.02, 1.0)) < 1e-15);
        assert_eq!(Section::default().closest(near, 0.1), None);
    }
}
