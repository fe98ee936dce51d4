//! OpenSubdiv's subdivision tags: `t name ints/floats/strings values...`.

use std::collections::HashMap;

use tessgraph_geometry::{Attribute, AttributeValues, Domain, Mesh};

use super::parse::Parser;
use crate::error::{FaultKind, IoError};
use crate::text;
use crate::warnings::Counted;

/// The attribute of crease sharpness, on the corners that edges leave.
pub(super) const CREASE: &str = "crease";
/// The attribute of vertex sharpness.
pub(super) const CORNER: &str = "corner_sharpness";

/// Sharp edges and vertices as the file names them, counted from 0.
#[derive(Debug, Default)]
pub(super) struct Tags {
    /// Two end vertices, sharpness, place in the file.
    creases: Vec<([i64; 2], f64, usize)>,
    /// Vertex, sharpness, place in the file.
    corners: Vec<(i64, f64, usize)>,
    /// `interpolateboundary`.
    pub(super) boundary: Option<i64>,
}

impl Tags {
    /// Adds the tags of the part of the file behind this one.
    pub(super) fn append(&mut self, part: &Self) {
        self.creases.extend_from_slice(&part.creases);
        self.corners.extend_from_slice(&part.corners);
        self.boundary = part.boundary.or(self.boundary);
    }
}

/// The numbers of one tag.
struct Values {
    ints: Vec<i64>,
    floats: Vec<f64>,
}

impl Values {
    /// The sharpness of the `k`-th element: one for each, or one for all.
    fn sharpness(&self, k: usize) -> Option<f64> {
        let index = if self.floats.len() > 1 { k } else { 0 };
        self.floats.get(index).map(|sharpness| sharpness.max(0.0))
    }
}

impl Parser<'_> {
    /// Reads a `t` statement. One that cannot be understood is counted: other
    /// programs use the letter differently.
    pub(super) fn tag(&mut self, start: usize) {
        self.scanner.skip_blanks();
        let name = self.scanner.word();
        let Some(values) = self.tag_values() else {
            self.said.passed_over.bad_tags.note(start);
            return;
        };
        match name {
            b"crease" => {
                for (k, ends) in values.ints.chunks_exact(2).enumerate() {
                    if let Some(sharpness) = values.sharpness(k) {
                        self.said
                            .tags
                            .creases
                            .push(([ends[0], ends[1]], sharpness, start));
                    }
                }
            }
            b"corner" => {
                for (k, &vertex) in values.ints.iter().enumerate() {
                    if let Some(sharpness) = values.sharpness(k) {
                        self.said.tags.corners.push((vertex, sharpness, start));
                    }
                }
            }
            b"interpolateboundary" => {
                self.said.tags.boundary = values.ints.first().copied().or(self.said.tags.boundary);
            }
            _ => self.said.passed_over.other_tags.note(start),
        }
    }

    /// `ints/floats/strings`, then as many integers and floats.
    fn tag_values(&mut self) -> Option<Values> {
        self.scanner.skip_blanks();
        let ints = self.scanner.integer()?;
        let mut counts = [ints, 0, 0];
        for count in &mut counts[1..] {
            if self.scanner.peek() == Some(b'/') {
                self.scanner.at += 1;
                *count = self.scanner.integer()?;
            }
        }
        let mut values = Values {
            ints: Vec::new(),
            floats: Vec::new(),
        };
        for _ in 0..counts[0] {
            if !self.scanner.more() {
                return None;
            }
            values.ints.push(self.scanner.integer()?);
        }
        for _ in 0..counts[1] {
            if !self.scanner.more() {
                return None;
            }
            values.floats.push(self.scanner.number().ok()?);
        }
        Some(values)
    }
}

/// `mesh` with the sharpness that `tags` give it.
///
/// A crease between vertices that no face joins by an edge is counted in
/// `warnings`; a vertex that does not exist is an error.
pub(super) fn apply(
    tags: &Tags,
    mut mesh: Mesh,
    bytes: &[u8],
    warnings: &mut Vec<String>,
) -> Result<Mesh, IoError> {
    let count = mesh.vertex_count();
    let vertex = |index: i64, at: usize| match usize::try_from(index) {
        Ok(vertex) if vertex < count => Ok(vertex as u32),
        _ => Err(IoError::new(
            FaultKind::OutOfRange,
            text::place(bytes, at),
            format!("the tag names vertex {index}, but there are {count}, counted from 0"),
            "correct the tag",
        )),
    };
    if !tags.corners.is_empty() {
        let mut sharpness = vec![0.0; count];
        for &(index, value, at) in &tags.corners {
            sharpness[vertex(index, at)? as usize] = value;
        }
        let values = AttributeValues::Number(sharpness.into());
        mesh = mesh.with_attribute(Attribute::new(CORNER, Domain::Vertex, values))?;
    }
    if tags.creases.is_empty() {
        return Ok(mesh);
    }
    let mut of_edge = HashMap::new();
    for &(ends, value, at) in &tags.creases {
        let ends = [vertex(ends[0], at)?, vertex(ends[1], at)?];
        of_edge.insert(
            [ends[0].min(ends[1]), ends[0].max(ends[1])],
            (value, at, false),
        );
    }
    let mut sharpness = vec![0.0; mesh.corner_count()];
    for face in 0..mesh.face_count() {
        let vertices = mesh.face(face);
        for (k, corner) in mesh.topology().corner_range(face).enumerate() {
            let (a, b) = (vertices[k], vertices[(k + 1) % vertices.len()]);
            if let Some((value, _, found)) = of_edge.get_mut(&[a.min(b), a.max(b)]) {
                sharpness[corner] = *value;
                *found = true;
            }
        }
    }
    let mut lost: Vec<usize> = of_edge
        .values()
        .filter(|edge| !edge.2)
        .map(|edge| edge.1)
        .collect();
    lost.sort_unstable();
    let mut counted = Counted::default();
    lost.iter().for_each(|&at| counted.note(at));
    let what = [
        "crease is on no edge and was left out",
        "creases are on no edge and were left out",
    ];
    counted.report(bytes, what, warnings);
    let values = AttributeValues::Number(sharpness.into());
    Ok(mesh.with_attribute(Attribute::new(CREASE, Domain::Corner, values))?)
}
