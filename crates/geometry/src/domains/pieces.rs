//! New faces cut out of old ones, with all that these carry.

use std::sync::Arc;

use glam::DVec3;

use crate::mesh::{Attribute, AttributeValues};
use crate::rebuild::with_labels;
use crate::{Domain, GeometryError, Mesh, Topology};

/// Face attribute that names the face of the input a face was made of.
pub const SOURCE_FACE: &str = "source_face";

/// Marks an edge that was in no face of the old mesh.
pub(super) const NEW_EDGE: u32 = u32::MAX;

/// A mesh under construction: the vertices of an old one, then new ones, and
/// faces whose corners take their values from corners of the old mesh.
pub(super) struct Pieces<'a> {
    mesh: &'a Mesh,
    positions: Vec<DVec3>,
    offsets: Vec<u32>,
    corners: Vec<u32>,
    corner_values: Vec<u32>,
    edges: Vec<u32>,
    faces: Vec<u32>,
    vertex_blends: Blends,
    corner_blends: Blends,
}

/// Weighted sums of old elements, one row each.
struct Blends {
    offsets: Vec<u32>,
    items: Vec<(u32, f64)>,
}

impl Blends {
    fn new() -> Self {
        Self {
            offsets: vec![0],
            items: Vec::new(),
        }
    }

    fn add(&mut self, items: impl Iterator<Item = (u32, f64)>) -> u32 {
        self.items.extend(items);
        self.offsets.push(self.items.len() as u32);
        self.offsets.len() as u32 - 2
    }

    fn row(&self, row: usize) -> &[(u32, f64)] {
        &self.items[self.offsets[row] as usize..self.offsets[row + 1] as usize]
    }
}

/// A corner of a new face: its vertex, where its values come from, and the old
/// corner whose edge leaves it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) vertex: u32,
    /// An old corner, or a number given by [`Pieces::blend`].
    pub(super) values: u32,
    /// An old corner, or [`NEW_EDGE`].
    pub(super) edge: u32,
}

impl<'a> Pieces<'a> {
    /// No faces yet; `corners` is how many there will be, about.
    pub(super) fn new(mesh: &'a Mesh, corners: usize) -> Self {
        let mut offsets = Vec::with_capacity(corners / 3 + 1);
        offsets.push(0);
        Self {
            mesh,
            positions: mesh.positions().to_vec(),
            offsets,
            corners: Vec::with_capacity(corners),
            corner_values: Vec::with_capacity(corners),
            edges: Vec::with_capacity(corners),
            faces: Vec::with_capacity(corners / 3),
            vertex_blends: Blends::new(),
            corner_blends: Blends::new(),
        }
    }

    /// A new vertex with the weighted sum of the values of old vertices.
    pub(super) fn vertex(
        &mut self,
        position: DVec3,
        weights: impl Iterator<Item = (u32, f64)>,
    ) -> u32 {
        self.positions.push(position);
        self.vertex_blends.add(weights);
        self.positions.len() as u32 - 1
    }

    /// Where a vertex, old or new, is.
    pub(super) fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// Values for corners: the weighted sum of those of old corners.
    pub(super) fn blend(&mut self, weights: impl Iterator<Item = (u32, f64)>) -> u32 {
        self.mesh.corner_count() as u32 + self.corner_blends.add(weights)
    }

    /// The old corner as it is, with the edge that leaves it if `keep_edge`.
    pub(super) fn old(&self, corner: usize, keep_edge: bool) -> Corner {
        Corner {
            vertex: self.mesh.topology().corners()[corner],
            values: corner as u32,
            edge: if keep_edge { corner as u32 } else { NEW_EDGE },
        }
    }

    /// A face made of the old face `source`.
    pub(super) fn face(&mut self, source: usize, corners: impl IntoIterator<Item = Corner>) {
        for corner in corners {
            self.push(corner);
        }
        self.end(source);
    }

    /// The old face `source` as it is.
    pub(super) fn keep(&mut self, source: usize) {
        for corner in self.mesh.topology().corner_range(source) {
            self.push(self.old(corner, true));
        }
        self.end(source);
    }

    /// A piece of `source` whose corners are the corners `of` of that face,
    /// counted within it; sides that were edges of it keep what these carry.
    pub(super) fn piece(&mut self, source: usize, of: &[usize]) {
        let range = self.mesh.topology().corner_range(source);
        for (k, &corner) in of.iter().enumerate() {
            let next = of[(k + 1) % of.len()];
            let keeps = (corner + 1) % range.len() == next;
            self.push(self.old(range.start + corner, keeps));
        }
        self.end(source);
    }

    /// Adds a corner to the face that [`Pieces::end`] will end.
    pub(super) fn push(&mut self, corner: Corner) {
        self.corners.push(corner.vertex);
        self.corner_values.push(corner.values);
        self.edges.push(corner.edge);
    }

    /// Ends a face made of the old face `source`.
    pub(super) fn end(&mut self, source: usize) {
        self.offsets.push(self.corners.len() as u32);
        self.faces.push(source as u32);
    }

    /// The mesh. Vertices and corners take their values, faces labels and
    /// values of their sources, and edges what they carried; a new edge has 0.
    /// With `note_source` the source is left as attribute [`SOURCE_FACE`].
    pub(super) fn finish(self, note_source: bool) -> Result<Mesh, GeometryError> {
        let topology = Topology::new(self.positions.len(), self.offsets, self.corners)?;
        let made = Mesh::new(self.positions, Arc::new(topology))?;
        let mut out = with_labels(self.mesh, made, Some(&self.faces))?;
        // Old vertices, then the new ones by their blends.
        let vertices: Vec<u32> = (0..out.vertex_count() as u32).collect();
        for attribute in self.mesh.attributes() {
            let values = match attribute.domain() {
                Domain::Face => attribute.values().gather(&self.faces),
                Domain::Corner if attribute.is_on_edges() => {
                    attribute.values().gather_or_zero(&self.edges)
                }
                Domain::Corner => blended(
                    attribute.values(),
                    self.mesh.corner_count(),
                    &self.corner_values,
                    &self.corner_blends,
                ),
                Domain::Vertex => blended(
                    attribute.values(),
                    self.mesh.vertex_count(),
                    &vertices,
                    &self.vertex_blends,
                ),
            };
            out = out.with_attribute(attribute.with_values(values))?;
        }
        if note_source {
            let sources = self.faces.iter().map(|&face| i64::from(face)).collect();
            let values = AttributeValues::Integer(sources);
            out = out.with_attribute(Attribute::new(SOURCE_FACE, Domain::Face, values))?;
        }
        Ok(out)
    }
}

/// For each of `rows` the old value of that number or, from `count` on, the
/// weighted sum of the blend.
fn blended(
    values: &AttributeValues,
    count: usize,
    rows: &[u32],
    blends: &Blends,
) -> AttributeValues {
    if blends.offsets.len() == 1 {
        return values.gather(rows);
    }
    let single: Vec<(u32, f64)> = (0..count as u32).map(|index| (index, 1.0)).collect();
    let row = |&row: &u32| match (row as usize).checked_sub(count) {
        None => std::slice::from_ref(&single[row as usize]),
        Some(blend) => blends.row(blend),
    };
    values.combine(rows.iter().map(row))
}
