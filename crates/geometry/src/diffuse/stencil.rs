//! The neighbours of each vertex and how much they count.

use glam::DVec2;

use crate::math::{PI, cos, sin};
use crate::mesh::{AttributeValues, Domain};
use crate::topology::NO_EDGE;
use crate::{Directions, GeometryError, Mesh};

/// What anisotropic diffusion is measured against.
#[derive(Debug, Clone, Copy)]
pub enum Grain<'a> {
    /// The u and v of a corner attribute of 2D vectors, by its name.
    Layer(&'a str),
    /// Along (u) and across (v) the direction at the edge's ends.
    Along(&'a Directions),
}

/// Diffusion that prefers one sense of a grain.
///
/// Edge weight a = (cos t, sin t) · (|du|, |dv|) / |(du, dv)|, t = (1 + strength)
/// π / 4, and a = 1 at strength 0. Edges without extent count as diagonal.
#[derive(Debug, Clone, Copy)]
pub struct Anisotropy<'a> {
    /// What u and v are.
    pub grain: Grain<'a>,
    /// -1 diffuses over edges along u only, 1 along v only, 0 over all alike.
    pub strength: f64,
}

/// Neighbours of each vertex in compressed rows, with weights or all alike.
#[derive(Debug)]
pub(super) struct Stencil {
    offsets: Vec<u32>,
    neighbours: Vec<u32>,
    /// One per neighbour; empty where all are 1.
    weights: Vec<f64>,
}

impl Stencil {
    /// Neighbours over mesh edges.
    pub(super) fn edges(
        mesh: &Mesh,
        anisotropy: Option<&Anisotropy<'_>>,
    ) -> Result<Self, GeometryError> {
        let edges = mesh.topology().adjacency().edges();
        let weights = match anisotropy {
            Some(anisotropy) => edge_weights(mesh, anisotropy)?,
            None => Vec::new(),
        };
        Ok(Self::gather(mesh.vertex_count(), edges, &weights))
    }

    /// Neighbours over triangle edges, with cotangent weights not below 0.
    pub(super) fn cotangent(mesh: &Mesh) -> Self {
        let (edges, weights) = cotangent_edges(mesh);
        Self::gather(mesh.vertex_count(), &edges, &weights)
    }

    /// Rows of both ends of each edge, in the order of edges.
    fn gather(vertex_count: usize, edges: &[[u32; 2]], edge_weights: &[f64]) -> Self {
        let mut offsets = vec![0u32; vertex_count + 1];
        for &vertex in edges.as_flattened() {
            offsets[vertex as usize + 1] += 1;
        }
        for vertex in 0..vertex_count {
            offsets[vertex + 1] += offsets[vertex];
        }
        let mut next = offsets.clone();
        let mut neighbours = vec![0; 2 * edges.len()];
        let mut weights = vec![0.0; 2 * edge_weights.len()];
        for (edge, &[a, b]) in edges.iter().enumerate() {
            for (from, to) in [(a, b), (b, a)] {
                let at = next[from as usize] as usize;
                next[from as usize] += 1;
                neighbours[at] = to;
                if let Some(weight) = weights.get_mut(at) {
                    *weight = edge_weights[edge];
                }
            }
        }
        Self {
            offsets,
            neighbours,
            weights,
        }
    }

    /// The neighbours of `vertex` and their weights, which are empty where all are 1.
    #[inline]
    pub(super) fn row(&self, vertex: usize) -> (&[u32], &[f64]) {
        let range = self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize;
        let weights = self.weights.get(range.clone()).unwrap_or(&[]);
        (&self.neighbours[range], weights)
    }
}

/// Anisotropic weight of every mesh edge.
fn edge_weights(mesh: &Mesh, anisotropy: &Anisotropy<'_>) -> Result<Vec<f64>, GeometryError> {
    let strength = anisotropy.strength;
    if !(-1.0..=1.0).contains(&strength) {
        return Err(GeometryError::OutOfRange {
            what: "the anisotropy",
            value: strength,
            requirement: "it must be from -1 to 1",
        });
    }
    let extents = match anisotropy.grain {
        Grain::Layer(name) => layer_extents(mesh, name)?,
        Grain::Along(grain) => grain_extents(mesh, grain)?,
    };
    let angle = (1.0 + strength) * PI / 4.0;
    // Exact at both ends, where the other sense must not count at all.
    let pull = if strength >= 1.0 {
        DVec2::Y
    } else if strength <= -1.0 {
        DVec2::X
    } else {
        DVec2::new(cos(angle), sin(angle))
    };
    let weigh = |extent: DVec2| {
        if strength.abs() > 0.0 {
            pull.dot(
                extent
                    .try_normalize()
                    .unwrap_or(DVec2::splat(0.5f64.sqrt())),
            )
        } else {
            1.0
        }
    };
    Ok(extents.into_iter().map(weigh).collect())
}

/// (|du|, |dv|) of each edge, added up over the faces that have it.
fn layer_extents(mesh: &Mesh, name: &str) -> Result<Vec<DVec2>, GeometryError> {
    let layer = mesh.attribute(name, Domain::Corner).map(|a| a.values());
    let Some(AttributeValues::Vector2(uvs)) = layer else {
        let available = mesh.attributes().iter().map(|a| a.name().to_owned());
        return Err(GeometryError::NoAttribute {
            name: name.to_owned(),
            wanted: "2D vector corner",
            available: available.collect(),
        });
    };
    let topology = mesh.topology();
    let adjacency = topology.adjacency();
    let mut extents = vec![DVec2::ZERO; adjacency.edge_count()];
    for face in 0..mesh.face_count() {
        let range = topology.corner_range(face);
        for corner in range.clone() {
            let edge = adjacency.corner_edges()[corner];
            if edge != NO_EDGE {
                let next = if corner + 1 == range.end {
                    range.start
                } else {
                    corner + 1
                };
                extents[edge as usize] += (uvs[next] - uvs[corner]).abs();
            }
        }
    }
    Ok(extents)
}

/// Lengths of each edge along and across the mean direction of its ends.
fn grain_extents(mesh: &Mesh, grain: &Directions) -> Result<Vec<DVec2>, GeometryError> {
    grain.check(mesh)?;
    let (positions, vectors) = (mesh.positions(), grain.outward());
    let edges = mesh.topology().adjacency().edges().iter();
    let extent = |&[a, b]: &[u32; 2]| {
        let (a, b) = (a as usize, b as usize);
        let arm = positions[b] - positions[a];
        // A grain has no sense: its ends are added with equal ones.
        let sense = if vectors[a].dot(vectors[b]) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let mean = crate::math::unit_or_zero(vectors[a] + vectors[b] * sense);
        DVec2::new(arm.dot(mean).abs(), arm.cross(mean).length())
    };
    Ok(edges.map(extent).collect())
}

/// Edges of all triangles with (cot α + cot β) / 2, each edge once, in the
/// order of its lower and then upper vertex; weights below 0 are 0.
pub(super) fn cotangent_edges(mesh: &Mesh) -> (Vec<[u32; 2]>, Vec<f64>) {
    let positions = mesh.positions();
    let triangles = mesh.triangle_vertices(&mesh.triangles());
    let mut parts: Vec<([u32; 2], f64)> = Vec::with_capacity(3 * triangles.len());
    for triangle in &triangles {
        for k in 0..3 {
            let [apex, i, j] = [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
            let (to_i, to_j) = (
                positions[i as usize] - positions[apex as usize],
                positions[j as usize] - positions[apex as usize],
            );
            let area2 = to_i.cross(to_j).length();
            // A triangle without area has no angles and couples nothing.
            let cotangent = to_i.dot(to_j) / area2;
            if i != j && cotangent.is_finite() {
                parts.push(([i.min(j), i.max(j)], 0.5 * cotangent));
            }
        }
    }
    // Stable: the parts of an edge are added in the order of triangles.
    parts.sort_by_key(|&(edge, _)| edge);
    let sum = |run: &[([u32; 2], f64)]| {
        let total: f64 = run.iter().map(|&(_, part)| part).sum();
        (run[0].0, total.max(0.0))
    };
    parts.chunk_by(|a, b| a.0 == b.0).map(sum).unzip()
}
