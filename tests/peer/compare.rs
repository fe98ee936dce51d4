//! Whether two meshes are the same up to the order of vertices and faces.

use std::collections::BTreeMap;

use glam::DVec3;
use tessgraph_geometry::Mesh;

/// How the meshes differ; `None` if they have equal counts, a one-to-one match
/// of vertices within `tolerance` of the bounding box's diagonal, and equal
/// faces as cyclic lists under that match.
///
/// Vertices that lie within the tolerance of each other form one place. Several
/// pieces may have a vertex at the same place; so faces are compared piece by
/// piece, which settles whose vertex is whose.
pub(super) fn difference(ours: &Mesh, theirs: &Mesh, tolerance: f64) -> Option<String> {
    let counts = |mesh: &Mesh| (mesh.vertex_count(), mesh.face_count());
    if counts(ours) != counts(theirs) {
        let ((v, f), (w, g)) = (counts(ours), counts(theirs));
        return Some(format!(
            "{v} vertices and {f} faces here, {w} and {g} there"
        ));
    }
    let reach = tolerance * theirs.diagonal();
    let places = places(
        &[ours.positions().as_slice(), theirs.positions()].concat(),
        reach,
    );
    let (here, there) = places.split_at(ours.vertex_count());
    let mut balance: BTreeMap<u32, i64> = BTreeMap::new();
    here.iter()
        .for_each(|place| *balance.entry(*place).or_default() += 1);
    there
        .iter()
        .for_each(|place| *balance.entry(*place).or_default() -= 1);
    let unmatched = balance.values().filter(|sum| **sum != 0).count();
    if unmatched > 0 {
        let lonely = |place: &&u32| balance[place] > 0;
        let first = here.iter().find(lonely);
        let vertex = here
            .iter()
            .position(|place| Some(place) == first)
            .unwrap_or(0);
        return Some(format!(
            "{unmatched} places without a match within {reach:e}; ours at vertex {vertex}: {}",
            ours.positions()[vertex]
        ));
    }
    let (ours, theirs) = (pieces(ours, here), pieces(theirs, there));
    let differing = ours.iter().zip(&theirs).filter(|(a, b)| a != b).count();
    (ours != theirs).then(|| format!("{differing} of {} pieces have other faces", ours.len()))
}

/// One number for all positions within reach of each other.
fn places(positions: &[DVec3], reach: f64) -> Vec<u32> {
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by(|&a, &b| positions[a].x.total_cmp(&positions[b].x));
    let mut sets = Sets::new(positions.len());
    for (k, &i) in order.iter().enumerate() {
        for &j in &order[k + 1..] {
            if positions[j].x - positions[i].x > reach {
                break;
            }
            if positions[i].distance(positions[j]) <= reach {
                sets.join(i, j);
            }
        }
    }
    (0..positions.len()).map(|i| sets.root(i) as u32).collect()
}

/// For each connected piece its faces as lists of places, each starting at its
/// lowest; faces and pieces sorted.
fn pieces(mesh: &Mesh, places: &[u32]) -> Vec<Vec<Vec<u32>>> {
    let mut sets = Sets::new(mesh.vertex_count());
    for face in mesh.topology().faces() {
        face.iter()
            .for_each(|&vertex| sets.join(face[0] as usize, vertex as usize));
    }
    let mut pieces: BTreeMap<usize, Vec<Vec<u32>>> = BTreeMap::new();
    for face in mesh.topology().faces() {
        let around: Vec<u32> = face.iter().map(|&vertex| places[vertex as usize]).collect();
        let rotated = |k: usize| [&around[k..], &around[..k]].concat();
        let cyclic = (0..around.len()).map(rotated).min().unwrap_or_default();
        pieces
            .entry(sets.root(face[0] as usize))
            .or_default()
            .push(cyclic);
    }
    let mut pieces: Vec<_> = pieces.into_values().collect();
    pieces.iter_mut().for_each(|faces| faces.sort_unstable());
    pieces.sort_unstable();
    pieces
}

/// Disjoint sets of indices.
struct Sets {
    parent: Vec<usize>,
}

impl Sets {
    fn new(count: usize) -> Self {
        Self {
            parent: (0..count).collect(),
        }
    }

    fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }
}
