//! Faces pushed out of a surface, with walls along their edges.

use glam::DVec3;

use super::check_per_face;
use super::pieces::{Corner, NEW_EDGE, Pieces};
use super::push::Push;
use crate::offset::PART;
use crate::rebuild::keep_faces;
use crate::topology::{NO_EDGE, next_in_face};
use crate::{
    Amount, Attribute, AttributeValues, Directions, Domain, GeometryError, Mesh, Monitor, Topology,
};

/// Which faces stay joined while they are pushed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExtrudeMode {
    /// None: every face has walls of its own.
    #[default]
    Individual,
    /// Chosen neighbours: only the edges round each region get walls.
    Region,
}

/// Values of the face attribute [`PART`] of [`extrude_faces`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExtrudePart {
    /// A face that was pushed.
    Cap = 0,
    /// A wall.
    Side = 1,
    /// A face that stayed.
    Kept = 2,
}

/// Settings of [`extrude_faces`].
#[derive(Debug, Clone)]
pub struct ExtrudeOptions<'a> {
    /// Which faces stay joined.
    pub mode: ExtrudeMode,
    /// How far, in metres: a number, or one per face or per vertex; below 0
    /// against the normals.
    pub height: Amount,
    /// Where to; `None` along the normals of the faces.
    pub directions: Option<&'a Directions>,
    /// Whether the pushed faces are in the result.
    pub cap: bool,
}

/// Pushes faces by a height and puts quads along the edges that come apart.
///
/// [`ExtrudeMode::Individual`]: corner P of a face with normal N goes to P + h N.
/// [`ExtrudeMode::Region`]: chosen faces that share an edge go together, and a
/// vertex of theirs to P + h M, where the mitre M is the shortest vector with the
/// least Σ α (N · M - 1)² over the region's faces at the vertex, α their angles
/// there. Three planes are so moved by h each, exactly; M is cut at length 20,
/// as mitres of needles run to infinity. With directions D a corner goes to
/// P + h D in both modes. h is the face's or the vertex's height; for a region
/// with heights per face their mean by α. Faces whose heights are all 0 stay.
///
/// Every chosen face becomes (where `cap`) the pushed face, followed by its walls
/// (a, b, b', a') for its edges a-b: u runs along the edge, v in the direction of
/// pushing. The result is oriented as the input is, so a closed surface stays one, and
/// a height below 0 makes a recess. Walls take material, groups and values from
/// their face and its corners, and creases stay on both ends of a wall.
///
/// Vertices: the old ones still in use, then the new ones; face attributes
/// [`PART`] (an [`ExtrudePart`]) and [`super::SOURCE_FACE`]. Cost: O(corners).
///
/// ```
/// use tessgraph_geometry::{Amount, Unmonitored, glam::DVec3, primitives::cuboid};
/// use tessgraph_geometry::domains::{ExtrudeMode, ExtrudeOptions, extrude_faces};
/// let cube = cuboid(DVec3::ONE, [1; 3], false)?;
/// let options = ExtrudeOptions {
///     mode: ExtrudeMode::Individual,
///     height: Amount::Constant(0.5),
///     directions: None,
///     cap: true,
/// };
/// let cross = extrude_faces(&cube, &[true; 6], &options, &Unmonitored)?;
/// assert_eq!((cross.vertex_count(), cross.face_count()), (8 + 24, 6 + 24));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::AttributeLength`] unless `chosen` has one value per face;
/// [`GeometryError::FieldLength`] and [`GeometryError::OutOfRange`] for the height;
/// [`GeometryError::NoArea`] or [`GeometryError::NoNormal`] where there is
/// no normal to follow, [`GeometryError::ZeroDirection`] where there is no
/// direction, [`GeometryError::OtherTopology`] for directions of other faces;
/// [`GeometryError::NonManifold`] and [`GeometryError::Invalid`] (neighbours of
/// opposite orientation) for regions; [`GeometryError::Cancelled`].
pub fn extrude_faces(
    mesh: &Mesh,
    chosen: &[bool],
    options: &ExtrudeOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    check_per_face("chosen", mesh, chosen.len())?;
    let pushed = pushed_faces(mesh, chosen, &options.height)?;
    let joined = joined_edges(mesh.topology(), &pushed, options.mode)?;
    let (fans, sources) = match options.mode {
        ExtrudeMode::Region => mesh.topology().split_fans(|edge| joined[edge]),
        ExtrudeMode::Individual => {
            let corners = mesh.topology().corners().to_vec();
            ((0..corners.len() as u32).collect(), corners)
        }
    };
    let push = Push {
        mesh,
        pushed: &pushed,
        options,
        fans: &fans,
        sources: &sources,
    };
    let places = push.places(monitor)?;
    let mut pieces = Pieces::new(mesh, 5 * mesh.corner_count());
    let moved = moved_vertices(&push, &places, &mut pieces);
    let parts = build(&push, &joined, &moved, &mut pieces);
    let parts = AttributeValues::Integer(parts.into());
    let whole = pieces
        .finish(true)?
        .with_attribute(Attribute::new(PART, Domain::Face, parts))?;
    // Vertices inside regions have all their faces moved away.
    let all = (0..whole.face_count() as u32).collect();
    keep_faces(&whole, all)
}

/// The faces that are chosen and have a height other than 0.
fn pushed_faces(mesh: &Mesh, chosen: &[bool], height: &Amount) -> Result<Vec<bool>, GeometryError> {
    height.check_corners(mesh)?;
    if let Amount::Constant(value) = *height
        && !value.is_finite()
    {
        return Err(GeometryError::OutOfRange {
            what: "the height",
            value,
            requirement: "it must be finite",
        });
    }
    let rises = |face: usize| {
        let mut vertices = mesh.face(face).iter();
        vertices.any(|&vertex| height.at_corner(face, vertex) != 0.0)
    };
    let faces = chosen.iter().enumerate();
    Ok(faces.map(|(face, &chosen)| chosen && rises(face)).collect())
}

/// For each edge whether its faces stay joined there while they are pushed.
fn joined_edges(
    topology: &Topology,
    pushed: &[bool],
    mode: ExtrudeMode,
) -> Result<Vec<bool>, GeometryError> {
    let adjacency = topology.adjacency();
    if mode == ExtrudeMode::Individual {
        return Ok(vec![false; adjacency.edge_count()]);
    }
    topology.check_manifold()?;
    topology.check_oriented()?;
    let moves = |&corner: &u32| pushed[adjacency.corner_faces()[corner as usize] as usize];
    Ok((0..adjacency.edge_count())
        .map(|edge| {
            let corners = adjacency.edge_corners(edge);
            corners.len() == 2 && corners.iter().all(moves)
        })
        .collect())
}

/// The new vertex of each fan of pushed corners; `NO_EDGE` for other corners'.
fn moved_vertices(push: &Push<'_>, places: &[DVec3], pieces: &mut Pieces<'_>) -> Vec<u32> {
    let mut moved = vec![NO_EDGE; push.sources.len()];
    let corner_faces = push.mesh.topology().adjacency().corner_faces();
    let mut in_use = vec![false; push.sources.len()];
    for (corner, &face) in corner_faces.iter().enumerate() {
        in_use[push.fans[corner] as usize] |= push.pushed[face as usize];
    }
    for (fan, moved) in moved.iter_mut().enumerate().filter(|(fan, _)| in_use[*fan]) {
        let from = std::iter::once((push.sources[fan], 1.0));
        *moved = pieces.vertex(places[fan], from);
    }
    moved
}

/// All faces; returns the part of each.
fn build(push: &Push<'_>, joined: &[bool], moved: &[u32], pieces: &mut Pieces<'_>) -> Vec<i64> {
    let topology = push.mesh.topology();
    let edges = topology.adjacency().corner_edges();
    let mut parts = Vec::with_capacity(push.mesh.face_count());
    for face in 0..push.mesh.face_count() {
        if !push.pushed[face] {
            pieces.keep(face);
            parts.push(ExtrudePart::Kept as i64);
            continue;
        }
        let range = topology.corner_range(face);
        let up = |corner: usize, pieces: &Pieces<'_>, keep_edge: bool| Corner {
            vertex: moved[push.fans[corner] as usize],
            ..pieces.old(corner, keep_edge)
        };
        if push.options.cap {
            for corner in range.clone() {
                pieces.push(up(corner, pieces, true));
            }
            pieces.end(face);
            parts.push(ExtrudePart::Cap as i64);
        }
        for corner in range {
            let edge = edges[corner];
            if edge == NO_EDGE || joined[edge as usize] {
                continue;
            }
            let next = next_in_face(topology, corner as u32) as usize;
            let wall = [
                pieces.old(corner, true),
                pieces.old(next, false),
                // Left towards a', so that the moved edge carries what a-b does.
                Corner {
                    edge: corner as u32,
                    ..up(next, pieces, false)
                },
                Corner {
                    edge: NEW_EDGE,
                    ..up(corner, pieces, false)
                },
            ];
            pieces.face(face, wall);
            parts.push(ExtrudePart::Side as i64);
        }
    }
    parts
}

#[cfg(test)]
mod tests;
