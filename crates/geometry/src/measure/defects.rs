//! What is unsound about a mesh, by element.

use crate::normals::newell;
use crate::{Adjacency, Mesh, Topology, parallel};

/// Faces whose area is below this share of the squared extent are degenerate.
const DEGENERATE_AREA: f64 = 1e-12;

/// How many elements of a kind are named.
const NAMED: usize = 8;

/// Elements of one kind of defect: how many, and the first of them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Found {
    /// How many there are.
    pub count: usize,
    /// The first eight, in order: vertices, faces, or edges of the topology's
    /// adjacency.
    pub first: Vec<u32>,
}

impl Found {
    /// Those of `0..total` that `holds` names. Cost: O(total).
    pub(super) fn among(total: usize, holds: impl Fn(usize) -> bool + Sync) -> Self {
        let step = |mut found: Self, index: usize| {
            if holds(index) {
                found.add(index as u32);
            }
            found
        };
        parallel::reduce(total, Self::default, step, Self::followed_by)
    }

    fn add(&mut self, index: u32) {
        self.count += 1;
        if self.first.len() < NAMED {
            self.first.push(index);
        }
    }

    fn followed_by(mut self, later: Self) -> Self {
        self.count += later.count;
        let room = NAMED - self.first.len();
        self.first.extend(later.first.into_iter().take(room));
        self
    }

    /// "4, 7 and 3 more", each element shown by `name`.
    fn list(&self, name: impl Fn(u32) -> String) -> String {
        let listed: Vec<_> = self.first.iter().map(|&index| name(index)).collect();
        let more = match self.count - self.first.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("{}{more}", listed.join(", "))
    }
}

/// What is unsound about a mesh; see [`find_defects`].
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Defects {
    /// Edges of more than two faces.
    pub nonmanifold_edges: Found,
    /// Vertices where faces meet that share no edge there (bow ties).
    pub nonmanifold_vertices: Found,
    /// Edges of two faces that both run along it in the same sense, so that one
    /// of the faces is turned inside out.
    pub inconsistent_edges: Found,
    /// Faces that name a vertex twice, or whose area is not above 10⁻¹² times
    /// the square of the mesh's largest extent.
    pub degenerate_faces: Found,
    /// Faces with the same vertices as an earlier one, in any order.
    pub duplicate_faces: Found,
    /// Vertices of no face.
    pub isolated_vertices: Found,
}

/// Everything that is unsound about a mesh. Nothing of it is forbidden: many
/// operations work on such meshes, and those that do not refuse them by name.
///
/// Cost: O(corners · log valence), and the mesh's adjacency.
///
/// ```
/// use tessgraph_geometry::{Mesh, measure::find_defects};
/// let square = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Mesh::from_faces(square, &[&[0, 1, 2][..], &[2, 0, 1]])?;
/// let found = find_defects(&mesh);
/// assert_eq!(found.duplicate_faces.first, [1]);
/// assert_eq!(found.isolated_vertices.first, [3]);
/// assert_eq!(found.sentences(mesh.topology())[1], "1 face repeats another: 1");
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn find_defects(mesh: &Mesh) -> Defects {
    let topology = mesh.topology();
    let adjacency = topology.adjacency();
    let corners = topology.corners();
    let edges = |holds: &(dyn Fn(&[u32]) -> bool + Sync)| {
        Found::among(adjacency.edge_count(), |edge| {
            holds(adjacency.edge_corners(edge))
        })
    };
    Defects {
        nonmanifold_edges: edges(&|sides| sides.len() > 2),
        nonmanifold_vertices: Found::among(mesh.vertex_count(), |v| topology.fan_count(v) > 1),
        inconsistent_edges: edges(&|sides| match *sides {
            [a, b] => corners[a as usize] == corners[b as usize],
            _ => false,
        }),
        degenerate_faces: degenerate_faces(mesh),
        duplicate_faces: duplicate_faces(topology, adjacency),
        isolated_vertices: Found::among(mesh.vertex_count(), |vertex| {
            adjacency.vertex_corners(vertex).is_empty()
        }),
    }
}

impl Defects {
    /// Each defect in words, with the first elements: "2 faces without area: 4, 9".
    ///
    /// `topology` is the mesh's. Cost: O(what is named).
    pub fn sentences(&self, topology: &Topology) -> Vec<String> {
        let edge = |index: u32| {
            let [a, b] = topology.adjacency().edges()[index as usize];
            format!("{a}-{b}")
        };
        let plain = |index: u32| index.to_string();
        let told = |found: &Found, one: &str, many: &str, name: &dyn Fn(u32) -> String| {
            let words = if found.count == 1 { one } else { many };
            (found.count > 0).then(|| format!("{} {words}: {}", found.count, found.list(name)))
        };
        let sentences = [
            told(
                &self.nonmanifold_edges,
                "edge has more than two faces",
                "edges have more than two faces",
                &edge,
            ),
            told(
                &self.nonmanifold_vertices,
                "vertex joins faces that share no edge",
                "vertices join faces that share no edge",
                &plain,
            ),
            told(
                &self.inconsistent_edges,
                "edge lies between faces of opposite sense",
                "edges lie between faces of opposite sense",
                &edge,
            ),
            told(
                &self.degenerate_faces,
                "face has no area",
                "faces have no area",
                &plain,
            ),
            told(
                &self.duplicate_faces,
                "face repeats another",
                "faces repeat another",
                &plain,
            ),
            told(
                &self.isolated_vertices,
                "vertex belongs to no face",
                "vertices belong to no face",
                &plain,
            ),
        ];
        sentences.into_iter().flatten().collect()
    }
}

fn degenerate_faces(mesh: &Mesh) -> Found {
    let extent = mesh
        .bounds()
        .map_or(0.0, |(low, high)| (high - low).max_element());
    let least = DEGENERATE_AREA * extent * extent;
    Found::among(mesh.face_count(), |face| {
        let vertices = mesh.face(face);
        let places = vertices
            .iter()
            .map(|&vertex| mesh.positions()[vertex as usize]);
        newell(places).length() / 2.0 <= least || repeats(vertices)
    })
}

/// Whether a vertex occurs twice. Faces are short, apart from a few.
fn repeats(vertices: &[u32]) -> bool {
    const SHORT: usize = 16;
    if vertices.len() <= SHORT {
        return (1..vertices.len()).any(|k| vertices[..k].contains(&vertices[k]));
    }
    let mut sorted = vertices.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}

/// Faces beyond the first of each set of vertices.
///
/// Equal faces have the same lowest vertex, so each vertex compares only the
/// faces it is the lowest of.
fn duplicate_faces(topology: &Topology, adjacency: &Adjacency) -> Found {
    #[derive(Default)]
    struct Tally {
        duplicates: Vec<u32>,
        sorted: Vec<u32>,
        // Face, and where its sorted vertices are.
        rows: Vec<(u32, std::ops::Range<usize>)>,
    }
    let step = |mut tally: Tally, vertex: usize| {
        let Tally {
            duplicates,
            sorted,
            rows,
        } = &mut tally;
        sorted.clear();
        rows.clear();
        for &corner in adjacency.vertex_corners(vertex) {
            let face = adjacency.corner_faces()[corner as usize];
            let vertices = topology.face(face as usize);
            let again = rows.last().is_some_and(|(last, _)| *last == face);
            if !again && vertices.iter().all(|&other| other as usize >= vertex) {
                let start = sorted.len();
                sorted.extend_from_slice(vertices);
                sorted[start..].sort_unstable();
                rows.push((face, start..sorted.len()));
            }
        }
        rows.sort_unstable_by(|(a, x), (b, y)| {
            (&sorted[x.clone()], a).cmp(&(&sorted[y.clone()], b))
        });
        let pairs = rows.windows(2);
        let equal = pairs.filter(|pair| sorted[pair[0].1.clone()] == sorted[pair[1].1.clone()]);
        duplicates.extend(equal.map(|pair| pair[1].0));
        tally
    };
    let merge = |mut a: Tally, b: Tally| {
        a.duplicates.extend(b.duplicates);
        a
    };
    let count = topology.vertex_count();
    let mut faces = parallel::reduce(count, Tally::default, step, merge).duplicates;
    faces.sort_unstable();
    let mut found = Found::default();
    for face in faces {
        found.add(face);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(faces: &[&[u32]]) -> Mesh {
        let places = (0..8).map(|k| [f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)]);
        Mesh::from_faces(places.collect(), faces).expect("valid")
    }

    fn sentences(faces: &[&[u32]]) -> Vec<String> {
        let mesh = mesh(faces);
        find_defects(&mesh).sentences(mesh.topology())
    }

    #[test]
    fn a_sound_mesh_has_none() {
        let cube: [&[u32]; 6] = [
            &[0, 2, 3, 1],
            &[4, 5, 7, 6],
            &[0, 1, 5, 4],
            &[2, 6, 7, 3],
            &[0, 4, 6, 2],
            &[1, 3, 7, 5],
        ];
        assert_eq!(sentences(&cube), [""; 0]);
    }

    #[test]
    fn every_kind_names_its_elements() {
        let told = sentences(&[&[0, 1, 2], &[2, 1, 0], &[0, 1, 4], &[1, 0, 1]]);
        assert_eq!(
            told,
            [
                "1 edge has more than two faces: 0-1",
                "1 face has no area: 3",
                "1 face repeats another: 1",
                "4 vertices belong to no face: 3, 5, 6, 7",
            ]
        );
        let told = sentences(&[&[0, 1, 3, 2], &[1, 3, 7, 5], &[6, 7, 4]]);
        assert_eq!(
            told,
            [
                "1 vertex joins faces that share no edge: 7",
                "1 edge lies between faces of opposite sense: 1-3",
            ]
        );
    }

    #[test]
    fn at_most_eight_are_named() {
        let faces: Vec<&[u32]> = vec![&[0, 1, 2]; 11];
        let found = find_defects(&mesh(&faces)).duplicate_faces;
        assert_eq!((found.count, found.first.len()), (10, 8));
        let told = sentences(&faces);
        assert!(
            told.contains(&"10 faces repeat another: 1, 2, 3, 4, 5, 6, 7, 8 and 2 more".to_owned()),
            "{told:?}"
        );
    }

    #[test]
    fn a_long_face_that_repeats_is_found() {
        let ring: Vec<u32> = (0..20).chain([3]).collect();
        assert!(repeats(&ring) && !repeats(&ring[..20]));
    }
}
