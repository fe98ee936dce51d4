//! The first refinement of a mesh that is not all quads.

use std::sync::Arc;

use crate::topology::Topology;
use crate::{GeometryError, Monitor, parallel};

use super::rules::{Rule, Transition, crease_mask};
use super::sharpness::Sharpness;
use super::value::{Value, blend, middle, zeroed};

/// A mesh of quads, with the sharpness it starts from.
pub(super) struct Cage {
    pub(super) topology: Arc<Topology>,
    pub(super) sharpness: Sharpness,
}

impl Cage {
    /// The quads after one refinement of any polygons: vertices are the old
    /// ones, one per edge, one per face; faces are, for each old corner in
    /// order, the quad between it, its two edges and the face's centre.
    ///
    /// The quads of a quad keep its u and v; those of other polygons start at
    /// their old corner.
    pub(super) fn of_polygons(
        coarse: &Topology,
        sharpness: &Sharpness,
    ) -> Result<Self, GeometryError> {
        let adjacency = coarse.adjacency();
        let (vertices, edges) = (coarse.vertex_count(), adjacency.edge_count());
        let mut corners = Vec::with_capacity(4 * coarse.corner_count());
        for face in 0..coarse.face_count() {
            let range = coarse.corner_range(face);
            let sides = range.len();
            let on_edge =
                |k: usize| (vertices as u32) + adjacency.corner_edges()[range.start + k % sides];
            let centre = (vertices + edges + face) as u32;
            for (k, &vertex) in coarse.face(face).iter().enumerate() {
                let mut quad = [vertex, on_edge(k), centre, on_edge(k + sides - 1)];
                if sides == 4 {
                    quad.rotate_right(k);
                }
                corners.extend_from_slice(&quad);
            }
        }
        let topology = Topology::uniform(vertices + edges + coarse.face_count(), 4, corners)?;
        let sharpness = child_sharpness(coarse, sharpness, &topology);
        Ok(Self {
            topology: Arc::new(topology),
            sharpness,
        })
    }
}

/// Both halves of an edge have what is left of its sharpness; new edges inside
/// faces and new vertices have none.
fn child_sharpness(coarse: &Topology, sharpness: &Sharpness, fine: &Topology) -> Sharpness {
    let vertices = coarse.vertex_count();
    let edges = coarse.adjacency().edge_count();
    let of_edge = |&[a, b]: &[u32; 2]| {
        let (low, high) = (a.min(b) as usize, a.max(b) as usize);
        if low < vertices && high < vertices + edges {
            sharpness.edge(high - vertices, 1)
        } else {
            0.0
        }
    };
    let fine_edges = fine.adjacency().edges().iter().map(of_edge).collect();
    let mut fine_vertices: Vec<_> = (0..vertices)
        .map(|vertex| sharpness.vertex(vertex, 1))
        .collect();
    fine_vertices.resize(fine.vertex_count(), 0.0);
    Sharpness::new(fine_edges, fine_vertices)
}

/// Values after one Catmull-Clark refinement of any polygons, numbered as
/// [`Cage::of_polygons`].
pub(super) fn refine_polygons<T: Value>(
    coarse: &Topology,
    sharpness: &Sharpness,
    values: &[T],
    monitor: &dyn Monitor,
) -> Result<Vec<T>, GeometryError> {
    let adjacency = coarse.adjacency();
    let (vertices, edges) = (coarse.vertex_count(), adjacency.edge_count());
    let mut out = zeroed(vertices + edges + coarse.face_count());
    let (vertex_points, rest) = out.split_at_mut(vertices);
    let (edge_points, face_points) = rest.split_at_mut(edges);
    parallel::fill(face_points, monitor, |face, point| {
        *point = mean(coarse.face(face), values);
    })?;
    let face_point = |corner: u32| face_points[adjacency.corner_faces()[corner as usize] as usize];
    parallel::fill(edge_points, monitor, |edge, point| {
        let [a, b] = adjacency.edge(edge).map(|v| values[v as usize]);
        let crease = middle(a, b);
        *point = match *adjacency.edge_corners(edge) {
            [left, right] => {
                let smooth = middle(crease, middle(face_point(left), face_point(right)));
                blend(smooth, crease, sharpness.edge(edge, 0))
            }
            _ => crease,
        };
    })?;
    parallel::fill(vertex_points, monitor, |vertex, point| {
        let here = values[vertex];
        let around = adjacency.vertex_edges(vertex);
        let other = |edge: u32| values[adjacency.other_end(edge as usize, vertex) as usize];
        let edges = around
            .iter()
            .map(|&edge| (edge, sharpness.edge(edge as usize, 0)));
        *point = Transition::of(sharpness.vertex(vertex, 0), edges).apply(|rule| match rule {
            Rule::Corner => here,
            Rule::Crease(ends) => crease_mask(here, ends.map(other)),
            Rule::Smooth => {
                let n = around.len() as f64;
                let ends = around.iter().fold(T::default(), |sum, &e| sum + other(e));
                let corners = adjacency.vertex_corners(vertex).iter();
                let faces = corners.fold(T::default(), |sum, &c| sum + face_point(c));
                here * ((n - 2.0) / n) + (ends + faces) * (1.0 / (n * n))
            }
        });
    })?;
    Ok(out)
}

/// Values after one linear refinement: old vertices stay, new points are means.
pub(super) fn split_polygons<T: Value>(coarse: &Topology, values: &[T]) -> Vec<T> {
    let edges = coarse.adjacency().edges().iter();
    let middles = edges.map(|&[a, b]| middle(values[a as usize], values[b as usize]));
    let centres = coarse.faces().map(|face| mean(face, values));
    values
        .iter()
        .copied()
        .chain(middles)
        .chain(centres)
        .collect()
}

fn mean<T: Value>(face: &[u32], values: &[T]) -> T {
    let sum = face
        .iter()
        .fold(T::default(), |sum, &vertex| sum + values[vertex as usize]);
    sum * (1.0 / face.len() as f64)
}
