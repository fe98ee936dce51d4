//! Where the corners of frames lie.

use glam::DVec3;

use super::frame::{FrameOptions, Inset};
use crate::math::{lerp, unit_or_zero};
use crate::normals::face_area_vectors;
use crate::topology::next_in_face;
use crate::{Amount, GeometryError, Mesh, Monitor};

/// Sine of half the sharpest angle that is mitred in full, 6 degrees: a needle's
/// mitre would run to infinity.
const SHARPEST: f64 = 0.0523;

/// Inner and outer corners of the frames of one mesh.
pub(super) struct Insets<'a> {
    mesh: &'a Mesh,
    options: &'a FrameOptions,
    /// Unit normals, one per face.
    normals: Vec<DVec3>,
    /// 2 · mean of √area / sides of the faces at each vertex, where needed.
    relative: Vec<f64>,
}

impl<'a> Insets<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        options: &'a FrameOptions,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        let most = match options.inset {
            Inset::Centre => 1.0,
            _ => f64::INFINITY,
        };
        check_width(mesh, &options.width, most)?;
        if let Some(width) = &options.border_width {
            check_width(mesh, width, f64::INFINITY)?;
        }
        let areas = face_area_vectors(mesh, monitor)?;
        let relative = match options.inset {
            Inset::Constant => Vec::new(),
            _ => relative_sizes(mesh, &areas),
        };
        let normals = areas.into_iter().map(unit_or_zero).collect();
        Ok(Self {
            mesh,
            options,
            normals,
            relative,
        })
    }

    /// Place of the hole's corner k.
    pub(super) fn inner(&self, face: usize, k: usize) -> DVec3 {
        let vertices = self.mesh.face(face);
        let count = vertices.len();
        let place = |k: usize| self.mesh.positions()[vertices[k % count] as usize];
        let at = place(k);
        let width = self.options.width.at_corner(face, vertices[k]);
        match self.options.inset {
            Inset::Centre => lerp(at, centre(count, place), width),
            inset => {
                let size = match inset {
                    Inset::Relative => self.relative[vertices[k] as usize],
                    _ => 1.0,
                };
                let before = unit_or_zero(place(k + count - 1) - at);
                let after = unit_or_zero(place(k + 1) - at);
                at + mitre(before, after, self.normals[face]) * (width * size)
            }
        }
    }

    /// The border vertex between two boundary corners that follow each other,
    /// and the place of the border ring's corner outside it. One of the two may
    /// be missing where a walk ends.
    ///
    /// # Panics
    /// If both are missing.
    pub(super) fn outer(&self, before: Option<u32>, after: Option<u32>) -> (u32, DVec3) {
        let topology = self.mesh.topology();
        let start = |corner: u32| topology.corners()[corner as usize];
        let end = |corner: u32| start(next_in_face(topology, corner));
        let given = before.or(after).expect("a vertex has an edge");
        let face = topology.adjacency().corner_faces()[given as usize] as usize;
        let vertex = after.map_or_else(|| end(given), start);
        let place = |vertex: u32| self.mesh.positions()[vertex as usize];
        let towards = |other: u32| unit_or_zero(place(other) - place(vertex));
        let (a, b) = match (before, after) {
            (Some(before), Some(after)) => (towards(start(before)), towards(end(after))),
            (Some(before), None) => (towards(start(before)), -towards(start(before))),
            (_, after) => {
                let b = after.map_or(DVec3::ZERO, |after| towards(end(after)));
                (-b, b)
            }
        };
        let width = match (&self.options.border_width, self.options.inset) {
            (Some(width), _) => width.at_corner(face, vertex),
            (None, Inset::Constant) => self.options.width.at_corner(face, vertex),
            (None, _) => {
                self.options.width.at_corner(face, vertex) * self.relative[vertex as usize]
            }
        };
        let outwards = -mitre(a, b, self.normals[face]);
        (vertex, place(vertex) + outwards * width)
    }

    /// Shares of three corners of a face that make up `position` near its
    /// corner k: exact for values linear in the face's plane.
    pub(super) fn shares(&self, face: usize, k: usize, position: DVec3) -> [(usize, f64); 3] {
        let vertices = self.mesh.face(face);
        let count = vertices.len();
        let at = self.mesh.positions()[vertices[k] as usize];
        let arm = |k: usize| self.mesh.positions()[vertices[k] as usize] - at;
        let normal = self.normals[face];
        let (before, after) = ((k + count - 1) % count, (k + 1) % count);
        let across = (k + count / 2) % count;
        // The pair of arms nearest to a right angle is the safest to measure by.
        let sine = |&(i, j): &(usize, usize)| {
            let turn = unit_or_zero(arm(i)).cross(unit_or_zero(arm(j)));
            turn.dot(normal).abs()
        };
        let pairs = [(before, after), (after, across), (across, before)];
        let (i, j) = pairs
            .into_iter()
            .reduce(|best, pair| {
                if sine(&pair) > sine(&best) {
                    pair
                } else {
                    best
                }
            })
            .unwrap_or((before, after));
        if sine(&(i, j)) < 1e-9 {
            return [(k, 1.0), (before, 0.0), (after, 0.0)];
        }
        let (x, y, d) = (arm(i), arm(j), position - at);
        let whole = x.cross(y).dot(normal);
        let (s, t) = (
            d.cross(y).dot(normal) / whole,
            x.cross(d).dot(normal) / whole,
        );
        [(k, 1.0 - s - t), (i, s), (j, t)]
    }
}

/// The mitre of a corner for width 1: into the face whose corner list comes from
/// direction `before` and goes on to `after` (unit vectors from the corner), in
/// the plane of `normal`.
fn mitre(before: DVec3, after: DVec3, normal: DVec3) -> DVec3 {
    let (before, after) = match (before == DVec3::ZERO, after == DVec3::ZERO) {
        (true, _) => (-after, after),
        (_, true) => (before, -before),
        _ => (before, after),
    };
    let across = after - before;
    // Half of |b - a| is the sine of half the angle between unit vectors.
    let sine = 0.5 * across.length();
    unit_or_zero(normal.cross(across)) / sine.max(SHARPEST)
}

/// The mean of the corners; of a triangle the incentre, its corners weighted by
/// the opposite edges.
fn centre(count: usize, place: impl Fn(usize) -> DVec3) -> DVec3 {
    let origin = place(0);
    if count == 3 {
        let edge = |k: usize| place(k + 1).distance(place(k + 2));
        let total = edge(0) + edge(1) + edge(2);
        if total > 0.0 {
            let (b, c) = (edge(1) / total, edge(2) / total);
            return origin + (place(1) - origin) * b + (place(2) - origin) * c;
        }
    }
    let sum = (0..count).fold(DVec3::ZERO, |sum, k| sum + (place(k) - origin));
    origin + sum / count as f64
}

fn check_width(mesh: &Mesh, width: &Amount, most: f64) -> Result<(), GeometryError> {
    width.check_corners(mesh)?;
    let (low, high) = width.range();
    let value = if low >= 0.0 { high } else { low };
    let empty = matches!(width, Amount::Field(field) if field.values().is_empty());
    if empty || (low >= 0.0 && high <= most && high.is_finite()) {
        return Ok(());
    }
    Err(GeometryError::OutOfRange {
        what: "the width",
        value,
        requirement: "it must be finite and not negative, and with `Centre` at most 1",
    })
}

/// 2 · mean of √area / sides over the faces at each vertex, in metres.
fn relative_sizes(mesh: &Mesh, areas: &[DVec3]) -> Vec<f64> {
    let adjacency = mesh.topology().adjacency();
    let size = |face: u32| {
        let area = 0.5 * areas[face as usize].length();
        area.sqrt() / mesh.face(face as usize).len() as f64
    };
    let at_vertex = |vertex: usize| {
        let corners = adjacency.vertex_corners(vertex);
        let faces = corners
            .iter()
            .map(|&corner| adjacency.corner_faces()[corner as usize]);
        let sum = faces.map(size).fold(0.0, |sum, size| sum + size);
        2.0 * sum / corners.len().max(1) as f64
    };
    (0..mesh.vertex_count()).map(at_vertex).collect()
}
