//! Surfaces thickened along directions into closed shells (figure 9).

use glam::DVec3;

use crate::rebuild::{Sources, rebuild};
use crate::{
    Amount, Attribute, AttributeValues, Directions, Domain, GeometryError, Mesh, Monitor, Topology,
    parallel,
};

/// Name of the face attribute that tells outer, inner and side faces apart.
pub const PART: &str = "part";

/// Values of the face attribute [`PART`] of [`offset_mesh`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i64)]
pub enum ShellPart {
    /// The outer surface, on the side the directions point to.
    Outer = 0,
    /// The inner surface, facing the other way.
    Inner = 1,
    /// The strip along an open border.
    Side = 2,
}

/// Thickens `base` along `directions` into a closed shell (figure 9).
///
/// The outer surface is P + t_out D_out, the inner one P - t_in D_in with its
/// faces reversed; open borders are closed by one quad per border edge. A base
/// without borders becomes two shells, one inside the other; with `inward` 0
/// the base itself is the bottom. The result is closed and consistently
/// oriented: every edge has two faces of opposite sense. A vertex that several
/// borders pass is split, one copy for each fan of faces.
///
/// `outward` and `inward` are in metres times the directions' length, numbers
/// or one per vertex, not negative. With compensated directions they are
/// thicknesses.
///
/// Order: outer vertices, inner vertices; outer faces, inner faces, side quads
/// (a_in, b_in, b_out, a_out) by border edge a-b. Vertices without faces are
/// left out. Attributes, materials and groups are carried; a side takes them
/// from the face at its edge, and face attribute [`PART`] holds a [`ShellPart`].
/// Cost: O(corners).
///
/// # Errors
/// [`GeometryError::OtherTopology`], [`GeometryError::OutOfRange`] for thicknesses
/// that are negative, not finite or nowhere positive,
/// [`GeometryError::NonManifold`], [`GeometryError::Invalid`] for neighbours of
/// opposite orientation, [`GeometryError::Cancelled`]; those of [`Amount::check`].
pub fn offset_mesh(
    base: &Mesh,
    directions: &Directions,
    outward: &Amount,
    inward: &Amount,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    directions.check(base)?;
    check_thickness(base, outward, inward)?;
    base.topology().adjacency_with(monitor)?;
    base.topology().check_manifold()?;
    base.topology().check_oriented()?;
    let (corner_vertex, sources) = base.topology().split_fans(|_| true);
    let positions = both_sides(base, directions, [outward, inward], &sources, monitor)?;
    let shell = Shell::new(base, &corner_vertex, sources);
    let parts = AttributeValues::Integer(shell.parts.into());
    let topology = Topology::new(positions.len(), shell.offsets, shell.corners)?;
    let sources = Sources {
        vertices: Some(shell.vertex_source),
        faces: Some(shell.face_source),
        corners: Some(shell.corner_source),
    };
    rebuild(base, positions, topology, &sources)?.with_attribute(Attribute::new(
        PART,
        Domain::Face,
        parts,
    ))
}

fn check_thickness(base: &Mesh, outward: &Amount, inward: &Amount) -> Result<(), GeometryError> {
    for (what, amount) in [
        ("the outward thickness", outward),
        ("the inward thickness", inward),
    ] {
        amount.check(base, Domain::Vertex)?;
        let (low, high) = amount.range();
        if low < 0.0 || !low.is_finite() || !high.is_finite() {
            return Err(GeometryError::OutOfRange {
                what,
                value: if low < 0.0 { low } else { high },
                requirement: "it must be finite and not negative",
            });
        }
    }
    if outward.range().1 > 0.0 || inward.range().1 > 0.0 {
        return Ok(());
    }
    Err(GeometryError::OutOfRange {
        what: "the thickness",
        value: 0.0,
        requirement: "outward or inward must be positive",
    })
}

fn both_sides(
    base: &Mesh,
    directions: &Directions,
    [outward, inward]: [&Amount; 2],
    sources: &[u32],
    monitor: &dyn Monitor,
) -> Result<Vec<DVec3>, GeometryError> {
    let count = sources.len();
    parallel::map(2 * count, monitor, |i| {
        let vertex = sources[i % count] as usize;
        let position = base.positions()[vertex];
        if i < count {
            position + directions.outward()[vertex] * outward.at(vertex)
        } else {
            position - directions.inward()[vertex] * inward.at(vertex)
        }
    })
}

/// Faces of the closed shell, and where everything comes from.
struct Shell {
    offsets: Vec<u32>,
    corners: Vec<u32>,
    parts: Vec<i64>,
    vertex_source: Vec<u32>,
    face_source: Vec<u32>,
    corner_source: Vec<u32>,
}

impl Shell {
    fn new(base: &Mesh, corner_vertex: &[u32], vertices: Vec<u32>) -> Self {
        let topology = base.topology();
        let shift = vertices.len() as u32;
        let mut shell = Self {
            offsets: vec![0],
            corners: Vec::with_capacity(2 * corner_vertex.len()),
            parts: Vec::with_capacity(2 * topology.face_count()),
            vertex_source: [vertices.as_slice(), &vertices].concat(),
            face_source: Vec::with_capacity(2 * topology.face_count()),
            corner_source: Vec::with_capacity(2 * corner_vertex.len()),
        };
        for face in 0..topology.face_count() {
            let range = topology.corner_range(face);
            let corners = range.start as u32..range.end as u32;
            let at = |c: u32| (corner_vertex[c as usize], c);
            shell.push(face as u32, ShellPart::Outer, corners.map(at));
        }
        for face in 0..topology.face_count() {
            let range = topology.corner_range(face);
            // Reversed, and still starting at the first corner.
            let rest = (range.start as u32 + 1..range.end as u32).rev();
            let corners = std::iter::once(range.start as u32).chain(rest);
            let at = |c: u32| (corner_vertex[c as usize] + shift, c);
            shell.push(face as u32, ShellPart::Inner, corners.map(at));
        }
        shell.push_sides(topology, corner_vertex, shift);
        shell
    }

    fn push_sides(&mut self, topology: &Topology, corner_vertex: &[u32], shift: u32) {
        let adjacency = topology.adjacency();
        for edge in 0..adjacency.edge_count() {
            let [a] = *adjacency.edge_corners(edge) else {
                continue;
            };
            let face = adjacency.corner_faces()[a as usize];
            let range = topology.corner_range(face as usize);
            let b = if a as usize + 1 == range.end {
                range.start as u32
            } else {
                a + 1
            };
            let outer = |c: u32| (corner_vertex[c as usize], c);
            let inner = |c: u32| (corner_vertex[c as usize] + shift, c);
            let quad = [inner(a), inner(b), outer(b), outer(a)];
            self.push(face, ShellPart::Side, quad.into_iter());
        }
    }

    fn push(&mut self, face: u32, part: ShellPart, corners: impl Iterator<Item = (u32, u32)>) {
        for (vertex, source) in corners {
            self.corners.push(vertex);
            self.corner_source.push(source);
        }
        self.offsets.push(self.corners.len() as u32);
        self.face_source.push(face);
        self.parts.push(part as i64);
    }
}

#[cfg(test)]
mod tests;
