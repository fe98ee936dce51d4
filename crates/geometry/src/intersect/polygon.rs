//! Two polygons: whether they cross, however their diagonals are drawn.

use glam::DVec3;

use super::hinge::{Hinge, hinges_cross, through_hinge};
use super::predicate::{Corners, crosses, extent, is_folded, meets, open_axis};
use crate::Mesh;
use crate::surface::overlap;

/// How two faces lie to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Relation {
    /// Nothing in common, or only the vertex or edge they share.
    Apart,
    /// They touch, coincide, overlap in one plane, or cross no deeper than the
    /// tolerance or only for some diagonals.
    Contact,
    /// Their insides cross.
    Crossing,
}

/// A face and the numbers of the places of its vertices.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polygon<'a> {
    positions: &'a [DVec3],
    places: &'a [u32],
    vertices: &'a [u32],
}

impl<'a> Polygon<'a> {
    /// The face of that number; `places` has one number per corner, equal where
    /// positions are.
    #[inline]
    pub(super) fn new(mesh: &'a Mesh, places: &'a [u32], face: u32) -> Self {
        let range = mesh.topology().corner_range(face as usize);
        Self {
            positions: mesh.positions(),
            vertices: &mesh.topology().corners()[range.clone()],
            places: &places[range],
        }
    }

    /// How many ways to draw diagonals are tried.
    fn choices(&self) -> usize {
        if self.vertices.len() == 3 { 1 } else { 2 }
    }

    fn triangles(&self) -> usize {
        self.vertices.len() - 2
    }

    /// How many diagonals a fan has.
    pub(super) fn diagonals(&self) -> usize {
        self.vertices.len() - 3
    }

    fn at(&self, corner: usize) -> DVec3 {
        self.positions[self.places[corner % self.places.len()] as usize]
    }

    /// Triangle `index` of the fan from corner `choice`; `None` without area.
    pub(super) fn triangle(&self, choice: usize, index: usize) -> Option<Corners> {
        let corners = [choice, choice + index + 1, choice + index + 2];
        let place = corners.map(|corner| self.places[corner % self.places.len()]);
        let at = place.map(|place| self.positions[place as usize]);
        open_axis(at)?;
        Some(Corners { at, place })
    }

    /// Diagonal `index` of the fan from corner `choice`, between triangles
    /// `index` and `index + 1`.
    pub(super) fn hinge(&self, choice: usize, index: usize) -> Hinge {
        let at = |k: usize| self.at(choice + k);
        Hinge {
            edge: [at(0), at(index + 2)],
            wings: [at(index + 1), at(index + 3)],
        }
    }

    /// Calls `visit` with the triangles of one choice whose boxes meet `bounds`
    /// until it says true.
    fn any(
        &self,
        choice: usize,
        bounds: [DVec3; 2],
        visit: impl Fn(usize, &Corners) -> bool,
    ) -> bool {
        (0..self.triangles()).any(|index| {
            self.triangle(choice, index).is_some_and(|corners| {
                overlap(bounds_of(&corners.at), bounds) && visit(index, &corners)
            })
        })
    }

    fn shared_places(&self, other: &Self) -> usize {
        let shared = |place: &&u32| other.places.contains(place);
        self.places.iter().filter(shared).count()
    }

    fn bounds(&self) -> [DVec3; 2] {
        let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        self.places.iter().fold(none, |[low, high], &place| {
            let at = self.positions[place as usize];
            [low.min(at), high.max(at)]
        })
    }

    fn shared_vertices(&self, other: &Self) -> usize {
        let shared = |vertex: &&u32| other.vertices.contains(vertex);
        self.vertices.iter().filter(shared).count()
    }
}

fn bounds_of(at: &[DVec3; 3]) -> [DVec3; 2] {
    [at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2])]
}

/// How two faces lie to each other.
///
/// They meet if the triangles of their fans from corner 0 do, and cross if some
/// do for every choice of fans from corners 0 and 1.
pub(super) fn relation(a: &Polygon<'_>, b: &Polygon<'_>, tolerance: f64) -> Relation {
    let bounds = [a.bounds(), b.bounds()];
    let meet = a.any(0, bounds[1], |_, one| {
        b.any(0, bounds_of(&one.at), |_, two| meets(one, two))
    });
    // Faces that share both ends of a diagonal may cross along it.
    let meet = meet || (a.shared_places(b) > 1 && hinges_cross(a, b, [0, 0], tolerance));
    if !meet {
        return Relation::Apart;
    }
    // Neighbours over one edge may be folded over onto each other; faces with
    // more in common coincide in part.
    let folds = a.shared_vertices(b) == 2;
    let every = (0..a.choices()).all(|in_a| {
        (0..b.choices()).all(|in_b| cross(a, b, [in_a, in_b], bounds, folds, tolerance))
    });
    if every {
        Relation::Crossing
    } else {
        Relation::Contact
    }
}

/// Whether they cross with diagonals as chosen.
fn cross(
    a: &Polygon<'_>,
    b: &Polygon<'_>,
    choices: [usize; 2],
    bounds: [[DVec3; 2]; 2],
    folds: bool,
    tolerance: f64,
) -> bool {
    a.any(choices[0], bounds[1], |_, one| {
        b.any(choices[1], bounds_of(&one.at), |_, two| {
            triangles_cross(one, two, folds, tolerance)
        })
    }) || through_hinge(a, b, choices, tolerance)
        || through_hinge(b, a, [choices[1], choices[0]], tolerance)
        || hinges_cross(a, b, choices, tolerance)
}

fn triangles_cross(one: &Corners, two: &Corners, folds: bool, tolerance: f64) -> bool {
    let shared = one
        .place
        .iter()
        .filter(|&place| two.place.contains(place))
        .count();
    match shared {
        2 => folds && is_folded(one, two),
        3 => false,
        _ if tolerance > 0.0 => {
            extent(one, two).is_some_and(|[depth, length]| depth > tolerance && length > tolerance)
        }
        _ => crosses(one, two),
    }
}
