//! Components that a mapping has turned inside out (§5).

use glam::DVec3;

use crate::Mesh;

/// Least sine of the angle between two faces of a component that is looked at:
/// shallower edges may change sides by bending alone.
const SHARP: f64 = 0.5;

/// Share of a copy's largest volume below which another is none: on a triangle
/// the side v = 1 of a component has no length.
const ROUNDING: f64 = 1e-9;

/// An edge of the component and the two faces that meet in it.
struct Hinge {
    /// Each face and its corner that the edge leaves.
    sides: [(usize, usize); 2],
    /// Sign of the volume that the edge spans with the faces' middles.
    sign: f64,
}

/// Whether each of `count` copies is inverted: somewhere folded over, or inside
/// out altogether.
///
/// A mapping that keeps the sense of space keeps the sign of every volume. So
/// an edge, together with the middles of its two faces, must span a volume of
/// the component's own sign, at each edge between faces more than 30 degrees
/// from flat. `originals` and `owners` say which face each face of the mesh is
/// a copy of, and in which copy. A flat component has no such edge. Cost:
/// O(corners + faces · log faces).
pub(super) fn inverted(
    mesh: &Mesh,
    component: &Mesh,
    originals: &[usize],
    owners: &[u32],
    count: usize,
) -> Vec<bool> {
    let hinges = hinges(component);
    let mut order: Vec<usize> = (0..originals.len()).collect();
    order.sort_unstable_by_key(|&face| (owners[face], originals[face], face));
    let mut inverted = vec![false; count];
    for copy in order.chunk_by(|&a, &b| owners[a] == owners[b]) {
        let face_of = |original: usize| {
            let found = copy.binary_search_by_key(&original, |&face| originals[face]);
            found.ok().map(|at| copy[at])
        };
        let volumes = hinges.iter().filter_map(|hinge| {
            let [(a, k), (b, l)] = hinge.sides;
            let sides = [(face_of(a)?, k), (face_of(b)?, l)];
            Some(volume(mesh, sides) * hinge.sign)
        });
        let (least, largest) = volumes.fold((0.0f64, 0.0f64), |(least, largest), volume| {
            (least.min(volume), largest.max(volume.abs()))
        });
        inverted[owners[copy[0]] as usize] = least < -ROUNDING * largest;
    }
    inverted
}

/// The edges of a component whose faces stand at an angle.
fn hinges(component: &Mesh) -> Vec<Hinge> {
    let adjacency = component.topology().adjacency();
    let offsets = component.topology().offsets();
    let place = |corner: u32| {
        let face = adjacency.corner_faces()[corner as usize] as usize;
        (face, (corner - offsets[face]) as usize)
    };
    let hinge = |edge: usize| {
        let &[a, b] = adjacency.edge_corners(edge) else {
            return None;
        };
        let sides = [place(a), place(b)];
        let [start, end] = ends(component, sides[0]);
        let [one, two] = arms(component, sides);
        let axis = (end - start).normalize_or_zero();
        let flat = |arm: DVec3| arm - axis * arm.dot(axis);
        let sine = flat(one)
            .normalize_or_zero()
            .cross(flat(two).normalize_or_zero())
            .length();
        let sign = volume(component, sides).signum();
        (sine >= SHARP).then_some(Hinge { sides, sign })
    };
    (0..adjacency.edge_count()).filter_map(hinge).collect()
}

/// Six times the signed volume of the edge that leaves the first corner and the
/// middles of both faces.
fn volume(mesh: &Mesh, sides: [(usize, usize); 2]) -> f64 {
    let [start, end] = ends(mesh, sides[0]);
    let [one, two] = arms(mesh, sides);
    (end - start).dot(one.cross(two))
}

/// From the edge's start to the middle of each face.
fn arms(mesh: &Mesh, sides: [(usize, usize); 2]) -> [DVec3; 2] {
    let [start, _] = ends(mesh, sides[0]);
    sides.map(|(face, _)| {
        let vertices = mesh.face(face);
        let arm = |&vertex: &u32| mesh.positions()[vertex as usize] - start;
        vertices.iter().map(arm).sum::<DVec3>() / vertices.len() as f64
    })
}

/// The ends of the edge that leaves a corner of a face.
fn ends(mesh: &Mesh, (face, corner): (usize, usize)) -> [DVec3; 2] {
    let vertices = mesh.face(face);
    [corner, (corner + 1) % vertices.len()].map(|k| mesh.positions()[vertices[k] as usize])
}
