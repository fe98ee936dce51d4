//! Boundary loops.

use super::{NO_EDGE, Topology};

/// A walk along a border with the faces on its left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct BoundaryWalk {
    /// The corners whose outgoing edges are walked, in order.
    pub(crate) corners: Vec<u32>,
    /// Whether the walk came back to where it began; in non-manifold or
    /// inconsistently oriented surroundings it may just end.
    pub(crate) closed: bool,
}

/// Walks all borders, each from its lowest boundary corner.
pub(crate) fn walks(topology: &Topology) -> Vec<BoundaryWalk> {
    let adjacency = topology.adjacency();
    let corner_edges = adjacency.corner_edges();
    let is_boundary = |corner: u32| {
        let edge = corner_edges[corner as usize];
        edge != NO_EDGE && adjacency.is_boundary_edge(edge as usize)
    };
    let mut visited = vec![false; topology.corner_count()];
    let mut walks = Vec::new();
    for start in 0..topology.corner_count() as u32 {
        if visited[start as usize] || !is_boundary(start) {
            continue;
        }
        let mut corners = Vec::new();
        let mut corner = start;
        let closed = loop {
            visited[corner as usize] = true;
            corners.push(corner);
            match next_boundary_corner(topology, corner, &is_boundary) {
                Some(next) if visited[next as usize] => break next == start,
                Some(next) => corner = next,
                None => break false,
            }
        };
        walks.push(BoundaryWalk { corners, closed });
    }
    walks
}

/// All walks as the vertices they start edges from.
pub(super) fn loops(topology: &Topology) -> Vec<Vec<u32>> {
    let vertex = |&corner: &u32| topology.corners()[corner as usize];
    walks(topology)
        .iter()
        .map(|walk| walk.corners.iter().map(vertex).collect())
        .collect()
}

/// The boundary corner at the far end of `corner`'s edge, found by turning
/// round that vertex through the faces between the two boundary edges.
fn next_boundary_corner(
    topology: &Topology,
    corner: u32,
    is_boundary: &impl Fn(u32) -> bool,
) -> Option<u32> {
    let adjacency = topology.adjacency();
    let mut at = next_in_face(topology, corner);
    // A vertex cannot be turned round more often than it has corners.
    let turns = adjacency
        .vertex_corners(topology.corners()[at as usize] as usize)
        .len();
    for _ in 0..=turns {
        if is_boundary(at) {
            return Some(at);
        }
        let edge = adjacency.corner_edges()[at as usize];
        if edge == NO_EDGE {
            return None;
        }
        let [a, b] = *adjacency.edge_corners(edge as usize) else {
            return None;
        };
        let twin = if a == at { b } else { a };
        if topology.corners()[twin as usize] == topology.corners()[at as usize] {
            return None;
        }
        at = next_in_face(topology, twin);
    }
    None
}

/// The corner after `corner` in its face.
pub(crate) fn next_in_face(topology: &Topology, corner: u32) -> u32 {
    let face = topology.adjacency().corner_faces()[corner as usize] as usize;
    let range = topology.corner_range(face);
    let next = corner as usize + 1;
    (if next == range.end { range.start } else { next }) as u32
}

/// The corner before `corner` in its face.
pub(crate) fn previous_in_face(topology: &Topology, corner: u32) -> u32 {
    let face = topology.adjacency().corner_faces()[corner as usize] as usize;
    let range = topology.corner_range(face);
    let at = if corner as usize == range.start {
        range.end as u32
    } else {
        corner
    };
    at - 1
}
