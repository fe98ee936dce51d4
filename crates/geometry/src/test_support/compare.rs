//! Whether two meshes are the same up to the order of vertices and faces.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::Mesh;
use crate::sets::Sets;

/// Asserts equal counts, a one-to-one match of vertices within `tolerance` times
/// the bounding box's diagonal, and equal faces as cyclic lists of matched
/// vertices.
///
/// Vertices of both meshes that lie within the tolerance of each other form one
/// place, which must have as many of the one as of the other; so coincident
/// vertices match whichever of them a face names.
pub(crate) fn assert_same_mesh(ours: &Mesh, theirs: &Mesh, tolerance: f64) {
    assert_eq!(
        (ours.vertex_count(), ours.face_count()),
        (theirs.vertex_count(), theirs.face_count()),
        "vertices and faces"
    );
    let reach = tolerance * theirs.diagonal();
    let places = places([ours.positions(), theirs.positions()], reach);
    let count = ours.vertex_count();
    let mut balance: BTreeMap<u32, i64> = BTreeMap::new();
    for (vertex, &place) in places.iter().enumerate() {
        *balance.entry(place).or_default() += if vertex < count { 1 } else { -1 };
    }
    let lonely: Vec<_> = balance.iter().filter(|(_, sum)| **sum != 0).collect();
    if let Some(&(&place, _)) = lonely.first() {
        let vertex = places.iter().position(|&p| p == place).unwrap();
        let (mesh, index) = if vertex < count {
            (ours, vertex)
        } else {
            (theirs, vertex - count)
        };
        let whose = if vertex < count { "our" } else { "their" };
        panic!(
            "{} places without a match within {reach:e}, the first at {whose} vertex {index}: {}",
            lonely.len(),
            mesh.positions()[index]
        );
    }
    let ours = faces(ours, &places[..count]);
    let theirs = faces(theirs, &places[count..]);
    let differing = ours.iter().zip(&theirs).filter(|(a, b)| a != b).count();
    assert_eq!(differing, 0, "faces differ");
}

/// One number for all positions within reach of each other, over both lists.
fn places(lists: [&[DVec3]; 2], reach: f64) -> Vec<u32> {
    let all: Vec<DVec3> = lists.concat();
    let mut order: Vec<u32> = (0..all.len() as u32).collect();
    order.sort_by(|&a, &b| all[a as usize].x.total_cmp(&all[b as usize].x));
    let mut sets = Sets::new(all.len());
    for (k, &i) in order.iter().enumerate() {
        let here = all[i as usize];
        for &j in &order[k + 1..] {
            let there = all[j as usize];
            if there.x - here.x > reach {
                break;
            }
            if here.distance(there) <= reach {
                sets.join(i, j);
            }
        }
    }
    (0..all.len() as u32).map(|i| sets.root(i)).collect()
}

/// All faces as lists of places that start at their lowest, sorted.
fn faces(mesh: &Mesh, places: &[u32]) -> Vec<Vec<u32>> {
    let cyclic = |face: &[u32]| {
        let face: Vec<u32> = face.iter().map(|&v| places[v as usize]).collect();
        let rotation = |k: usize| [&face[k..], &face[..k]].concat();
        (0..face.len()).map(rotation).min().unwrap_or_default()
    };
    let mut faces: Vec<_> = mesh.topology().faces().map(cyclic).collect();
    faces.sort_unstable();
    faces
}

/// Asserts that every edge has two faces which pass it in opposite senses.
pub(crate) fn assert_closed(mesh: &Mesh) {
    let adjacency = mesh.topology().adjacency();
    for edge in 0..adjacency.edge_count() {
        let corners = adjacency.edge_corners(edge);
        assert_eq!(corners.len(), 2, "faces at edge {:?}", adjacency.edge(edge));
        let [a, b] = [corners[0], corners[1]].map(|c| mesh.topology().corners()[c as usize]);
        assert_ne!(a, b, "sense of edge {:?}", adjacency.edge(edge));
    }
}

/// Vertices - edges + faces.
pub(crate) fn euler(mesh: &Mesh) -> i64 {
    let edges = mesh.topology().adjacency().edge_count();
    mesh.vertex_count() as i64 - edges as i64 + mesh.face_count() as i64
}

/// Volume inside a closed mesh, by the divergence theorem over its triangles.
pub(crate) fn volume(mesh: &Mesh) -> f64 {
    let triangles = mesh.triangles();
    let sum: f64 = mesh
        .triangle_vertices(&triangles)
        .iter()
        .map(|t| t.map(|v| mesh.positions()[v as usize]))
        .map(|[a, b, c]| a.dot(b.cross(c)))
        .sum();
    sum / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{cuboid, torus};

    fn quads(order: [[u32; 4]; 2], places: [usize; 6]) -> Mesh {
        let place = |k: usize| [(k % 3) as f64, (k / 3) as f64, 0.0];
        Mesh::from_faces(places.map(place).to_vec(), &order).unwrap()
    }

    #[test]
    fn order_does_not_matter() {
        let a = quads([[0, 1, 4, 3], [1, 2, 5, 4]], [0, 1, 2, 3, 4, 5]);
        let b = quads([[3, 2, 1, 4], [0, 3, 4, 5]], [0, 5, 2, 1, 4, 3]);
        assert_same_mesh(&a, &b, 1e-9);
    }

    #[test]
    #[should_panic(expected = "faces differ")]
    fn turning_a_face_over_matters() {
        let a = quads([[0, 1, 4, 3], [1, 2, 5, 4]], [0, 1, 2, 3, 4, 5]);
        let b = quads([[0, 1, 4, 3], [4, 5, 2, 1]], [0, 1, 2, 3, 4, 5]);
        assert_same_mesh(&a, &b, 1e-9);
    }

    #[test]
    #[should_panic(expected = "without a match")]
    fn moving_a_vertex_matters() {
        let a = cuboid(1.0, 1.0, 0.0, 1.0);
        let moved = a
            .positions()
            .iter()
            .map(|p| *p * if p.x > 0.5 { 1.0001 } else { 1.0 });
        let b = a.with_positions(moved.collect()).unwrap();
        assert_same_mesh(&a, &b, 1e-5);
    }

    #[test]
    fn measures_of_known_solids() {
        let solid = cuboid(2.0, 3.0, -1.0, 1.5);
        assert_closed(&solid);
        assert_eq!(euler(&solid), 2);
        assert!((volume(&solid) - 15.0).abs() < 1e-12);
        assert_eq!(euler(&torus(8, 5, 3.0, 1.0)), 0);
    }
}
