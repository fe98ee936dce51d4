//! Faces chosen by where they are, and faces taken away.

use std::collections::VecDeque;

use super::check_per_face;
use crate::rebuild::keep_faces;
use crate::topology::NO_EDGE;
use crate::{GeometryError, Mesh};

/// Whole coordinates (i, j) of each face in the grid that the quads make.
///
/// The lowest face of each connected piece is (0, 0), with i along its u and j
/// along its v. From there coordinates spread over edges, breadth first and in
/// corner order: i grows by one across the side u = 1 and so on, whichever way the
/// neighbour's corners are numbered. i + j odd is a checker, i modulo n stripes.
/// Round a vertex with other than four quads no such grid exists, so patterns
/// break somewhere; through other polygons they go on by the nearest side.
/// Cost: O(corners).
pub fn cells(mesh: &Mesh) -> Vec<[i64; 2]> {
    // Across sides 0 to 3 of a quad: v = 0, u = 1, v = 1, u = 0.
    const STEPS: [[i64; 2]; 4] = [[0, -1], [1, 0], [0, 1], [-1, 0]];
    let topology = mesh.topology();
    let adjacency = topology.adjacency();
    let side = |face: usize, k: usize| k * 4 / mesh.face(face).len();
    let mut found = vec![None; mesh.face_count()];
    let mut queue = VecDeque::new();
    for first in 0..mesh.face_count() {
        if found[first].is_some() {
            continue;
        }
        found[first] = Some([0, 0]);
        queue.push_back((first, [0, 0], 0));
        while let Some((face, [i, j], turn)) = queue.pop_front() {
            for (k, corner) in topology.corner_range(face).enumerate() {
                let edge = adjacency.corner_edges()[corner];
                if edge == NO_EDGE {
                    continue;
                }
                let direction = (side(face, k) + turn) % 4;
                for &twin in adjacency.edge_corners(edge as usize) {
                    let other = adjacency.corner_faces()[twin as usize] as usize;
                    if found[other].is_some() {
                        continue;
                    }
                    let step = STEPS[direction];
                    let cell = [i + step[0], j + step[1]];
                    found[other] = Some(cell);
                    let entered = side(other, twin as usize - topology.corner_range(other).start);
                    queue.push_back((other, cell, (direction + 6 - entered) % 4));
                }
            }
        }
    }
    found.into_iter().map(Option::unwrap_or_default).collect()
}

/// Which faces are at an open border: with 0 `rings` those that have a border
/// edge; each ring more adds the faces that share a vertex with those before.
/// Cost: O(corners · rings).
pub fn faces_within(mesh: &Mesh, rings: u32) -> Vec<bool> {
    let topology = mesh.topology();
    let adjacency = topology.adjacency();
    let at_border = |face: usize| {
        topology.corner_range(face).any(|corner| {
            let edge = adjacency.corner_edges()[corner];
            edge != NO_EDGE && adjacency.is_boundary_edge(edge as usize)
        })
    };
    let mut chosen: Vec<bool> = (0..mesh.face_count()).map(at_border).collect();
    for _ in 0..rings {
        let mut touched = vec![false; mesh.vertex_count()];
        for (face, _) in chosen.iter().enumerate().filter(|(_, chosen)| **chosen) {
            for &vertex in mesh.face(face) {
                touched[vertex as usize] = true;
            }
        }
        let touches = |face: usize| mesh.face(face).iter().any(|&v| touched[v as usize]);
        let grown: Vec<bool> = (0..mesh.face_count()).map(touches).collect();
        if grown == chosen {
            break;
        }
        chosen = grown;
    }
    chosen
}

/// The mesh without the `chosen` faces (one value per face) and without the
/// vertices that no face is left to use. What is left keeps its order and all it
/// carries. Cost: O(corners).
///
/// # Errors
/// [`GeometryError::AttributeLength`] unless `chosen` has one value per face.
pub fn delete_faces(mesh: &Mesh, chosen: &[bool]) -> Result<Mesh, GeometryError> {
    check_per_face("chosen", mesh, chosen.len())?;
    let left = (0u32..).zip(chosen).filter(|(_, gone)| !**gone);
    keep_faces(mesh, left.map(|(face, _)| face).collect())
}
