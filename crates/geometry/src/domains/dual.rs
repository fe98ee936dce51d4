//! The dual of a mesh: a vertex for each face, a face for each vertex.

use super::fan::{edge_weights, weighted_mean};
use super::pieces::{Corner, NEW_EDGE, Pieces};
use crate::rebuild::keep_faces;
use crate::topology::{next_in_face, previous_in_face};
use crate::{Attribute, AttributeValues, Domain, GeometryError, Mesh, Topology};

/// Face attribute that names the vertex of the input a face was made of.
pub const SOURCE_VERTEX: &str = "source_vertex";

/// What becomes of the vertices on open borders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DualBorder {
    /// They get a face too, cut off by the border: it runs through the middles
    /// of their two border edges and the vertex itself, so the dual covers what
    /// the mesh covers.
    #[default]
    Closed,
    /// They get no face: the dual ends with the faces round inner vertices.
    Open,
}

/// A dual mesh.
#[derive(Debug, Clone)]
pub struct Dual {
    /// The mesh, with face attribute [`SOURCE_VERTEX`].
    pub mesh: Mesh,
    /// Inner vertices with fewer than three faces, which cannot become a
    /// polygon, ascending.
    pub skipped: Vec<u32>,
}

/// The dual of `mesh`: a vertex in every face, and round every vertex a face.
///
/// The vertex of a face is its length-weighted centre, as in [`super::fan_faces`].
/// The face of an inner vertex joins the centres of the faces round it in
/// counterclockwise order, starting from the lowest of its corners; so it has
/// as many corners as the vertex has edges, and the orientation is kept. On a
/// closed mesh vertices and faces change places and the Euler number stays;
/// the dual of the dual has the counts of the mesh. A vertex that several fans
/// of faces meet in gets a face for each.
///
/// Order: border vertices that are kept, then centres by face, then middles of
/// border edges by edge; faces by vertex. Values on vertices and corners are
/// interpolated (a centre has the weighted mean of its face); materials, groups
/// and face values are those of the lowest face round the vertex. Border edges
/// keep their creases, others are dropped. Cost: O(corners).
///
/// ```
/// use tessgraph_geometry::{glam::DVec3, primitives::cuboid};
/// use tessgraph_geometry::domains::{DualBorder, dual};
/// let octahedron = dual(&cuboid(DVec3::ONE, [1; 3], false)?, DualBorder::Closed)?.mesh;
/// assert_eq!((octahedron.vertex_count(), octahedron.face_count()), (6, 8));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::NonManifold`] naming the edges, [`GeometryError::Invalid`] for
/// neighbours of opposite orientation, [`GeometryError::RepeatedVertex`].
pub fn dual(mesh: &Mesh, border: DualBorder) -> Result<Dual, GeometryError> {
    let topology = mesh.topology();
    topology.check_manifold()?;
    topology.check_oriented()?;
    topology.check_edges()?;
    let mut pieces = Pieces::new(mesh, 2 * mesh.corner_count());
    let centres: Vec<Corner> = (0..mesh.face_count())
        .map(|face| centre(mesh, face, &mut pieces))
        .collect();
    let middles = match border {
        DualBorder::Closed => middles(mesh, &mut pieces),
        DualBorder::Open => Vec::new(),
    };
    let mut made = Vec::with_capacity(mesh.vertex_count());
    let mut skipped = Vec::new();
    for fan in fans(topology) {
        let source = fan.lowest_face(topology);
        if !fan.closed {
            if border == DualBorder::Closed {
                let around = fan.cut_off(topology, &pieces, &centres, &middles);
                pieces.face(source, around);
                made.push(i64::from(fan.vertex));
            }
        } else if fan.corners.len() < 3 {
            skipped.push(fan.vertex);
        } else {
            pieces.face(source, fan.centres(topology, &centres));
            made.push(i64::from(fan.vertex));
        }
    }
    let made = AttributeValues::Integer(made.into());
    let whole =
        pieces
            .finish(false)?
            .with_attribute(Attribute::new(SOURCE_VERTEX, Domain::Face, made))?;
    let all = (0..whole.face_count() as u32).collect();
    Ok(Dual {
        mesh: keep_faces(&whole, all)?,
        skipped,
    })
}

/// The vertex at the centre of a face.
fn centre(mesh: &Mesh, face: usize, pieces: &mut Pieces<'_>) -> Corner {
    let vertices = mesh.face(face);
    let place = |k: usize| mesh.positions()[vertices[k] as usize];
    let mut weights = Vec::new();
    edge_weights(vertices.len(), place, &mut weights);
    let shares = || weights.iter().copied();
    let position = weighted_mean(vertices.len(), place, &weights);
    let start = mesh.topology().offsets()[face];
    Corner {
        vertex: pieces.vertex(position, vertices.iter().copied().zip(shares())),
        values: pieces.blend((start..).zip(shares())),
        edge: NEW_EDGE,
    }
}

/// For each edge the vertex at its middle, left towards the edge's second half;
/// `None` for edges that are no border.
fn middles(mesh: &Mesh, pieces: &mut Pieces<'_>) -> Vec<Option<Corner>> {
    let topology = mesh.topology();
    let adjacency = topology.adjacency();
    (0..adjacency.edge_count())
        .map(|edge| {
            let [corner] = *adjacency.edge_corners(edge) else {
                return None;
            };
            let ends = [corner, next_in_face(topology, corner)];
            let vertices = ends.map(|end| topology.corners()[end as usize]);
            let [a, b] = vertices.map(|vertex| mesh.positions()[vertex as usize]);
            Some(Corner {
                vertex: pieces.vertex(a.midpoint(b), vertices.map(|v| (v, 0.5)).into_iter()),
                values: pieces.blend(ends.map(|end| (end, 0.5)).into_iter()),
                edge: corner,
            })
        })
        .collect()
}

/// The corners of one fan of faces at a vertex, counterclockwise.
struct Fan {
    vertex: u32,
    corners: Vec<u32>,
    /// Whether the last face is the neighbour of the first one.
    closed: bool,
}

/// All fans, by vertex and, at one vertex, by their lowest corner.
fn fans(topology: &Topology) -> impl Iterator<Item = Fan> {
    let mut seen = vec![false; topology.corner_count()];
    let adjacency = topology.adjacency();
    let at = |vertex: usize| adjacency.vertex_corners(vertex).iter().copied();
    (0..topology.vertex_count())
        .flat_map(at)
        .filter_map(move |corner| {
            if seen[corner as usize] {
                return None;
            }
            let fan = Fan::round(topology, corner);
            for &corner in &fan.corners {
                seen[corner as usize] = true;
            }
            Some(fan)
        })
}

impl Fan {
    /// The fan that `corner` belongs to, from there on if it is closed, else from
    /// the border.
    fn round(topology: &Topology, corner: u32) -> Self {
        let mut first = corner;
        while let Some(before) = clockwise(topology, first) {
            first = before;
            if first == corner {
                break;
            }
        }
        let mut corners = vec![first];
        let mut last = first;
        let closed = loop {
            match counterclockwise(topology, last) {
                None => break false,
                Some(next) if next == first => break true,
                Some(next) => last = next,
            }
            corners.push(last);
        };
        Self {
            vertex: topology.corners()[corner as usize],
            corners,
            closed,
        }
    }

    fn lowest_face(&self, topology: &Topology) -> usize {
        // Corners are numbered face by face.
        let lowest = self.corners.iter().copied().fold(u32::MAX, u32::min);
        topology.adjacency().corner_faces()[lowest as usize] as usize
    }

    fn centres<'a>(
        &'a self,
        topology: &'a Topology,
        centres: &'a [Corner],
    ) -> impl Iterator<Item = Corner> + 'a {
        let faces = topology.adjacency().corner_faces();
        let centre = |&corner: &u32| centres[faces[corner as usize] as usize];
        self.corners.iter().map(centre)
    }

    /// The polygon of an open fan: the vertex, the middle of its first border
    /// edge, the centres, the middle of the last one.
    fn cut_off(
        &self,
        topology: &Topology,
        pieces: &Pieces<'_>,
        centres: &[Corner],
        middles: &[Option<Corner>],
    ) -> Vec<Corner> {
        let edges = topology.adjacency().corner_edges();
        let middle = |corner: u32| middles[edges[corner as usize] as usize];
        let first = self.corners[0];
        let last = previous_in_face(topology, self.corners[self.corners.len() - 1]);
        let away = middle(first).map(|middle| Corner {
            edge: NEW_EDGE,
            ..middle
        });
        std::iter::once(pieces.old(first as usize, true))
            .chain(away)
            .chain(self.centres(topology, centres))
            .chain(middle(last))
            .collect()
    }
}

/// The corner at the same vertex in the next face counterclockwise.
fn counterclockwise(topology: &Topology, corner: u32) -> Option<u32> {
    twin(topology, previous_in_face(topology, corner))
}

/// The corner at the same vertex in the next face clockwise.
fn clockwise(topology: &Topology, corner: u32) -> Option<u32> {
    twin(topology, corner).map(|twin| next_in_face(topology, twin))
}

/// The corner from which the other face of `corner`'s edge leaves along it.
fn twin(topology: &Topology, corner: u32) -> Option<u32> {
    let adjacency = topology.adjacency();
    let edge = adjacency.corner_edges()[corner as usize] as usize;
    match *adjacency.edge_corners(edge) {
        [a, b] => Some(if a == corner { b } else { a }),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
