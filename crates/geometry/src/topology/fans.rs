//! How the faces round a vertex hang together.

use super::{NO_EDGE, Topology, next_in_face};
use crate::sets::Sets;

/// Edges a vertex may have before finding its fans needs the heap.
const USUAL_VALENCE: usize = 32;

impl Topology {
    /// How many groups of faces meet at `vertex` that share no edge there: one
    /// on a surface, two where two sheets touch in a point (a bow tie), none at
    /// an isolated vertex. Cost: O(valence · log valence).
    pub fn fan_count(&self, vertex: usize) -> usize {
        let adjacency = self.adjacency();
        let corners = adjacency.vertex_corners(vertex);
        if corners.len() <= 1 {
            return corners.len();
        }
        let edges = adjacency.vertex_edges(vertex);
        let (mut few, mut many);
        let parents: &mut [u32] = if edges.len() <= USUAL_VALENCE {
            few = [0; USUAL_VALENCE];
            &mut few[..edges.len()]
        } else {
            many = vec![0; edges.len()];
            &mut many
        };
        for (place, parent) in (0u32..).zip(parents.iter_mut()) {
            *parent = place;
        }
        let mut fans = edges.len();
        for &corner in corners {
            let Some(pair) = self.edges_beside(corner) else {
                continue;
            };
            // Edges are listed ascending.
            let [a, b] = pair.map(|edge| {
                let place = edges.partition_point(|&other| other < edge);
                root(parents, place as u32)
            });
            if a != b {
                parents[a.max(b) as usize] = a.min(b);
                fans -= 1;
            }
        }
        fans.max(1)
    }

    /// The vertex of each corner once vertices are split by fans of faces, and
    /// the old vertex of each of these. Faces hang together across the edges that
    /// `joins` (by their numbers); those with other than two faces never join.
    /// Fans keep the order of vertices and, at one vertex, of their first corners.
    ///
    /// The two faces of an edge must pass it in opposite senses
    /// ([`Topology::check_oriented`]). Cost: O(corners).
    pub(crate) fn split_fans(&self, joins: impl Fn(usize) -> bool) -> (Vec<u32>, Vec<u32>) {
        let adjacency = self.adjacency();
        let mut fans = Sets::new(self.corner_count());
        for edge in (0..adjacency.edge_count()).filter(|&edge| joins(edge)) {
            if let [c, d] = *adjacency.edge_corners(edge) {
                // Opposite senses: each starts where the other one ends.
                fans.join(c, next_in_face(self, d));
                fans.join(d, next_in_face(self, c));
            }
        }
        let mut corner_vertex = vec![0; self.corner_count()];
        let mut sources = Vec::new();
        for vertex in 0..self.vertex_count() {
            // Ascending corners meet the root of a fan, its lowest, first.
            for &corner in adjacency.vertex_corners(vertex) {
                let root = fans.root(corner);
                if root == corner {
                    corner_vertex[corner as usize] = sources.len() as u32;
                    sources.push(vertex as u32);
                } else {
                    corner_vertex[corner as usize] = corner_vertex[root as usize];
                }
            }
        }
        (corner_vertex, sources)
    }

    /// The edges before and after a corner in its face, passing over repeated
    /// vertices; `None` if the face has no edge at all.
    fn edges_beside(&self, corner: u32) -> Option<[u32; 2]> {
        let adjacency = self.adjacency();
        let range = self.corner_range(adjacency.corner_faces()[corner as usize] as usize);
        let (here, sides) = (corner as usize - range.start, range.len());
        let edge_at = |k: usize| adjacency.corner_edges()[range.start + k % sides];
        let real = |edge: &u32| *edge != NO_EDGE;
        let after = (0..sides).map(|k| edge_at(here + k)).find(real)?;
        let before = (1..=sides).map(|k| edge_at(here + sides - k)).find(real)?;
        Some([before, after])
    }
}

/// The representative of a group, halving the path on the way.
fn root(parents: &mut [u32], mut place: u32) -> u32 {
    while parents[place as usize] != place {
        let above = parents[parents[place as usize] as usize];
        parents[place as usize] = above;
        place = above;
    }
    place
}

#[cfg(test)]
mod tests {
    use crate::Mesh;

    #[test]
    fn sheets_that_touch_in_a_point_are_counted() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
        let positions = corners.map(|(x, y)| [x, y, 0.0]).to_vec();
        let mesh = Mesh::from_faces(positions, &[[0, 1, 2], [0, 3, 4]]).expect("valid");
        let fans: Vec<_> = (0..5).map(|v| mesh.topology().fan_count(v)).collect();
        assert_eq!(fans, [2, 1, 1, 1, 1]);
    }

    #[test]
    fn a_large_closed_fan_is_one() {
        let n = 100u32;
        let positions = (0..=n).map(|k| [f64::from(k), 0.0, 0.0]).collect();
        let faces: Vec<_> = (0..n).map(|k| [n, k, (k + 1) % n]).collect();
        let mesh = Mesh::from_faces(positions, &faces).expect("valid");
        assert_eq!(mesh.topology().fan_count(n as usize), 1);
    }

    #[test]
    fn repeated_vertices_do_not_tear_a_fan() {
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = Mesh::from_faces(positions, &[vec![0, 1, 1, 2], vec![1, 0, 2]]).expect("valid");
        assert_eq!(mesh.topology().fan_count(1), 1);
    }
}
