//! Edges taken away: the faces beside them become one.

use super::pieces::Pieces;
use crate::math::angle_between;
use crate::normals::face_normals;
use crate::rebuild::keep_faces;
use crate::sets::Sets;
use crate::topology::{NO_EDGE, next_in_face};
use crate::{Attribute, AttributeValues, Domain, GeometryError, Mesh, Monitor, Topology};

/// A mesh after edges were dissolved.
#[derive(Debug, Clone)]
pub struct Dissolved {
    /// The mesh.
    pub mesh: Mesh,
    /// Faces that went into another one.
    pub joined: usize,
    /// Vertices taken out of straight edges.
    pub straightened: usize,
    /// The lowest face of each group that was left as it was, because together
    /// its faces would have a hole, touch themselves or have no outline; ascending.
    pub kept: Vec<u32>,
}

/// Takes edges away, so that the faces beside them become one.
///
/// `chosen` has one value per edge of the topology. Faces joined by chosen edges
/// form a group; it becomes one polygon along its outline, with the material,
/// group and face values of its lowest face, from the first of its corners that
/// is left. Other edges between two faces of a group go as well. A group whose
/// outline is not one simple loop stays as it is. Edges of other than two faces,
/// and those between faces of opposite orientation, stay.
///
/// A vertex that lost an edge and is left between two goes too where these are
/// straight to within `straight` radians (0 keeps all but the exactly straight,
/// π takes all); vertices of no face go. Cost: O(corners).
///
/// ```
/// use std::f64::consts::PI;
/// use tessgraph_geometry::{Mesh, domains::dissolve_edges};
/// let places = [[0., 0.], [1., 0.], [2., 0.], [0., 1.], [1., 1.], [2., 1.]];
/// let places = places.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
/// let two = Mesh::from_faces(places, &[[0, 1, 4, 3], [1, 2, 5, 4]])?;
/// let chosen: Vec<bool> = two.topology().adjacency().edges().iter().map(|edge| *edge == [1, 4]).collect();
/// let one = dissolve_edges(&two, &chosen, PI / 180.0)?;
/// assert_eq!((one.mesh.face_count(), one.mesh.vertex_count()), (1, 4));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::AttributeLength`] unless `chosen` has one value per edge,
/// [`GeometryError::OutOfRange`] for an angle below 0,
/// [`GeometryError::RepeatedVertex`].
pub fn dissolve_edges(
    mesh: &Mesh,
    chosen: &[bool],
    straight: f64,
) -> Result<Dissolved, GeometryError> {
    let topology = mesh.topology();
    topology.check_edges()?;
    let adjacency = topology.adjacency();
    if chosen.len() != adjacency.edge_count() {
        return Err(GeometryError::AttributeLength {
            name: "chosen edges".into(),
            domain: Domain::Corner,
            expected: adjacency.edge_count(),
            actual: chosen.len(),
        });
    }
    if straight.is_nan() || straight < 0.0 {
        return Err(GeometryError::OutOfRange {
            what: "the angle of straight edges",
            value: straight,
            requirement: "it must not be negative",
        });
    }
    let groups = groups(topology, chosen);
    let mut outlines = Outlines::new(topology, &groups);
    let straightened = outlines.straighten(mesh, straight);
    let mut pieces = Pieces::new(mesh, mesh.corner_count());
    let mut count = 0;
    for (face, first) in &outlines.faces {
        let corners = outlines.around(*first).map(|slot| outlines.corners[slot]);
        pieces.face(
            *face as usize,
            corners.map(|corner| pieces_corner(mesh, corner)),
        );
        count += 1;
    }
    let whole = pieces.finish(false)?;
    Ok(Dissolved {
        mesh: keep_faces(&whole, (0..count).collect())?,
        joined: mesh.face_count() - count as usize,
        straightened,
        kept: outlines.kept,
    })
}

fn pieces_corner(mesh: &Mesh, corner: u32) -> super::pieces::Corner {
    super::pieces::Corner {
        vertex: mesh.topology().corners()[corner as usize],
        values: corner,
        edge: corner,
    }
}

/// Edges on which the edge attribute `name` is at least `at_least`, on one side
/// of theirs or the other; one value per edge.
///
/// # Errors
/// [`GeometryError::NoAttribute`] unless there is a corner attribute of numbers.
pub fn edges_by_attribute(
    mesh: &Mesh,
    name: &str,
    at_least: f64,
) -> Result<Vec<bool>, GeometryError> {
    let value: Box<dyn Fn(usize) -> f64 + '_> =
        match mesh.attribute(name, Domain::Corner).map(Attribute::values) {
            Some(AttributeValues::Number(values)) => Box::new(|corner| values[corner]),
            Some(AttributeValues::Integer(values)) => Box::new(|corner| values[corner] as f64),
            _ => {
                let available = mesh.attributes().iter().map(|a| a.name().to_owned());
                return Err(GeometryError::NoAttribute {
                    name: name.to_owned(),
                    wanted: "number edge",
                    available: available.collect(),
                });
            }
        };
    let adjacency = mesh.topology().adjacency();
    let of_edge = |edge: usize| {
        let mut sides = adjacency.edge_corners(edge).iter();
        sides.any(|&corner| value(corner as usize) >= at_least)
    };
    Ok((0..adjacency.edge_count()).map(of_edge).collect())
}

/// Edges between two faces whose normals differ by at most `angle` radians; one
/// value per edge. Faces without area have no normal, and their edges stay.
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub fn edges_within_angle(
    mesh: &Mesh,
    angle: f64,
    monitor: &dyn Monitor,
) -> Result<Vec<bool>, GeometryError> {
    let normals = face_normals(mesh, monitor)?;
    let adjacency = mesh.topology().adjacency();
    let flat = |edge: usize| {
        let [a, b] = *adjacency.edge_corners(edge) else {
            return false;
        };
        let [a, b] =
            [a, b].map(|corner| normals[adjacency.corner_faces()[corner as usize] as usize]);
        a != glam::DVec3::ZERO && b != glam::DVec3::ZERO && angle_between(a, b) <= angle
    };
    Ok((0..adjacency.edge_count()).map(flat).collect())
}

/// The corner on the other side of `corner`'s edge, where that has two faces of
/// one orientation.
fn across(topology: &Topology, corner: u32) -> Option<u32> {
    let adjacency = topology.adjacency();
    let edge = adjacency.corner_edges()[corner as usize];
    if edge == NO_EDGE {
        return None;
    }
    let [a, b] = *adjacency.edge_corners(edge as usize) else {
        return None;
    };
    let opposite = topology.corners()[a as usize] != topology.corners()[b as usize];
    opposite.then_some(if a == corner { b } else { a })
}

/// For each face the lowest face of its group.
fn groups(topology: &Topology, chosen: &[bool]) -> Vec<u32> {
    let adjacency = topology.adjacency();
    let mut sets = Sets::new(topology.face_count());
    for corner in 0..topology.corner_count() as u32 {
        let edge = adjacency.corner_edges()[corner as usize];
        if edge == NO_EDGE || !chosen[edge as usize] {
            continue;
        }
        if let Some(other) = across(topology, corner) {
            let [a, b] = [corner, other].map(|c| adjacency.corner_faces()[c as usize]);
            sets.join(a, b);
        }
    }
    (0..topology.face_count() as u32)
        .map(|face| sets.root(face))
        .collect()
}

/// The faces of the result, each a ring of slots that can be taken out.
struct Outlines {
    /// The lowest old face of each, and the slot of its first corner.
    faces: Vec<(u32, u32)>,
    /// For each slot its old corner, the slots before and after, and its face's
    /// index in `faces`.
    corners: Vec<u32>,
    before: Vec<u32>,
    after: Vec<u32>,
    face: Vec<u32>,
    /// Corners left of each face.
    counts: Vec<u32>,
    kept: Vec<u32>,
}

impl Outlines {
    fn new(topology: &Topology, groups: &[u32]) -> Self {
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); groups.len()];
        for (face, &group) in groups.iter().enumerate() {
            members[group as usize].push(face as u32);
        }
        let mut outlines = Self {
            faces: Vec::new(),
            corners: Vec::new(),
            before: Vec::new(),
            after: Vec::new(),
            face: Vec::new(),
            counts: Vec::new(),
            kept: Vec::new(),
        };
        // A group that stays keeps its faces in their places.
        let mut alone = vec![false; groups.len()];
        for face in 0..groups.len() {
            let group = members[groups[face] as usize].as_slice();
            let own = || {
                topology
                    .corner_range(face)
                    .map(|corner| corner as u32)
                    .collect()
            };
            if group.len() == 1 || alone[face] {
                outlines.push(face as u32, own());
            } else if group[0] as usize == face {
                match outline(topology, groups, group) {
                    Some(corners) => outlines.push(face as u32, corners),
                    None => {
                        outlines.kept.push(face as u32);
                        group.iter().for_each(|&face| alone[face as usize] = true);
                        outlines.push(face as u32, own());
                    }
                }
            }
        }
        outlines
    }

    fn push(&mut self, face: u32, corners: Vec<u32>) {
        let first = self.corners.len() as u32;
        let count = corners.len() as u32;
        self.face
            .extend(std::iter::repeat_n(self.faces.len() as u32, corners.len()));
        self.faces.push((face, first));
        self.counts.push(count);
        self.before
            .extend((0..count).map(|k| first + (k + count - 1) % count));
        self.after
            .extend((0..count).map(|k| first + (k + 1) % count));
        self.corners.extend(corners);
    }

    /// The slots of a face from `first` on.
    fn around(&self, first: u32) -> impl Iterator<Item = usize> + '_ {
        let mut next = Some(first);
        std::iter::from_fn(move || {
            let slot = next?;
            let after = self.after[slot as usize];
            next = (after != first).then_some(after);
            Some(slot as usize)
        })
    }

    /// Takes out the vertices that lost an edge and lie between two others that
    /// are straight; how many.
    fn straighten(&mut self, mesh: &Mesh, straight: f64) -> usize {
        let topology = mesh.topology();
        let vertex = |corner: u32| topology.corners()[corner as usize];
        let mut slots: Vec<Vec<u32>> = vec![Vec::new(); mesh.vertex_count()];
        for (slot, &corner) in self.corners.iter().enumerate() {
            slots[vertex(corner) as usize].push(slot as u32);
        }
        let adjacency = topology.adjacency();
        let mut gone = 0;
        for (index, slots) in slots.iter().enumerate() {
            let lost = slots.len() < adjacency.vertex_corners(index).len();
            if lost && self.goes(mesh, index, slots, straight) {
                slots.iter().for_each(|&slot| self.take_out(slot as usize));
                gone += 1;
            }
        }
        gone
    }

    /// Whether the vertex lies between two edges only, straight ones, and no face
    /// would be left with fewer than three corners.
    fn goes(&self, mesh: &Mesh, vertex: usize, slots: &[u32], straight: f64) -> bool {
        let at = |slot: u32| mesh.topology().corners()[self.corners[slot as usize] as usize];
        let ends = |slot: u32| {
            let (a, b) = (
                at(self.before[slot as usize]),
                at(self.after[slot as usize]),
            );
            [a.min(b), a.max(b)]
        };
        let Some((&first, others)) = slots.split_first() else {
            return false;
        };
        let [a, b] = ends(first);
        let spare = |&slot: &u32| self.counts[self.face[slot as usize] as usize] > 3;
        if a == b || others.iter().any(|&slot| ends(slot) != [a, b]) || !slots.iter().all(spare) {
            return false;
        }
        let place = |vertex: u32| mesh.positions()[vertex as usize];
        let here = mesh.positions()[vertex];
        angle_between(here - place(a), place(b) - here) <= straight
    }

    fn take_out(&mut self, slot: usize) {
        let (before, after, face) = (
            self.before[slot],
            self.after[slot],
            self.face[slot] as usize,
        );
        self.after[before as usize] = after;
        self.before[after as usize] = before;
        self.counts[face] -= 1;
        if self.faces[face].1 == slot as u32 {
            self.faces[face].1 = after;
        }
    }
}

/// The corners along the outline of a group of faces, from the lowest; `None`
/// unless it is one loop that passes every vertex once.
fn outline(topology: &Topology, groups: &[u32], members: &[u32]) -> Option<Vec<u32>> {
    let faces = topology.adjacency().corner_faces();
    let group = groups[members[0] as usize];
    let is_inner = |corner: u32| {
        across(topology, corner)
            .is_some_and(|other| groups[faces[other as usize] as usize] == group)
    };
    let vertex = |corner: u32| topology.corners()[corner as usize];
    let corners = members
        .iter()
        .flat_map(|&face| topology.corner_range(face as usize));
    let mut rim: Vec<(u32, u32)> = corners
        .map(|corner| corner as u32)
        .filter(|&corner| !is_inner(corner))
        .map(|corner| (vertex(corner), corner))
        .collect();
    let first = rim.iter().map(|&(_, corner)| corner).min()?;
    rim.sort_unstable();
    if rim.windows(2).any(|pair| pair[0].0 == pair[1].0) {
        return None;
    }
    let mut around = vec![first];
    loop {
        let end = vertex(next_in_face(topology, around[around.len() - 1]));
        let next = rim.binary_search_by_key(&end, |&(vertex, _)| vertex).ok()?;
        match rim[next].1 {
            corner if corner == first => break,
            // Each vertex starts one edge, so a walk that returns does so at its start.
            corner => around.push(corner),
        }
        if around.len() > rim.len() {
            return None;
        }
    }
    (around.len() == rim.len()).then_some(around)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::math::PI;
    use crate::mesh::SEAM;
    use crate::test_shapes::grid;

    /// All edges between faces.
    fn inner(mesh: &Mesh) -> Vec<bool> {
        let adjacency = mesh.topology().adjacency();
        (0..adjacency.edge_count())
            .map(|edge| !adjacency.is_boundary_edge(edge))
            .collect()
    }

    #[test]
    fn a_flat_grid_becomes_one_quad_or_one_polygon() {
        let mesh = grid(4, 3, |x, y| [x, y, 0.0]);
        let one = dissolve_edges(&mesh, &inner(&mesh), 0.01).unwrap();
        assert_eq!((one.joined, one.straightened), (11, 10));
        assert_eq!(one.mesh.face_count(), 1);
        let places: Vec<_> = one
            .mesh
            .face(0)
            .iter()
            .map(|&v| one.mesh.positions()[v as usize])
            .collect();
        let (w, h) = (places[1].x, places[2].y);
        assert_eq!(
            places.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>(),
            [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)]
        );
        // Uneven heights along the rim: only what is straight goes.
        let wavy = grid(4, 3, |x, y| [x, y, 0.2 * x * x]);
        let one = dissolve_edges(&wavy, &inner(&wavy), 1e-9).unwrap();
        // The three vertices inside each bent side stay, and the four corners.
        assert_eq!(one.mesh.face(0).len(), 4 + 2 * 3);
    }

    #[test]
    fn edges_inside_a_group_go_and_others_stay() {
        // Two quads of four: those round one edge only.
        let mesh = grid(2, 2, |x, y| [x, y, 0.0]);
        let edges = mesh.topology().adjacency().edges();
        let chosen: Vec<bool> = edges.iter().map(|edge| *edge == [1, 4]).collect();
        let half = dissolve_edges(&mesh, &chosen, 0.01).unwrap();
        assert_eq!((half.joined, half.mesh.face_count()), (1, 3));
        // Vertex 1 was on the rim; vertex 4 still has three edges.
        assert_eq!((half.straightened, half.mesh.vertex_count()), (1, 8));
        assert_eq!(half.mesh.face(0).len(), 5);
        // Three of the four spokes join all faces, and the fourth goes with them.
        let spokes: Vec<bool> = edges
            .iter()
            .map(|edge| edge.contains(&4) && *edge != [4, 7])
            .collect();
        let all = dissolve_edges(&mesh, &spokes, 0.01).unwrap();
        assert_eq!(all.mesh.face(0).len(), 4);
    }

    #[test]
    fn what_would_have_a_hole_or_no_outline_stays() {
        // A ring of eight quads round a hole.
        let mesh = grid(3, 3, |x, y| [x, y, 0.0]);
        let mut hole = vec![false; 9];
        hole[4] = true;
        let ring = super::super::delete_faces(&mesh, &hole).unwrap();
        let kept = dissolve_edges(&ring, &inner(&ring), PI).unwrap();
        assert_eq!(
            (kept.kept.as_slice(), kept.joined, kept.mesh.face_count()),
            (&[0][..], 0, 8)
        );
        let closed = crate::primitives::cuboid(glam::DVec3::ONE, [1; 3], false).unwrap();
        let kept = dissolve_edges(&closed, &inner(&closed), PI).unwrap();
        assert_eq!(
            (kept.kept.as_slice(), kept.mesh.face_count()),
            (&[0][..], 6)
        );
    }

    #[test]
    fn edges_are_chosen_by_angle_and_attribute() {
        // A roof: flat but for its ridge at x = 1/2 of its width.
        let roof = grid(4, 1, |x, y| [x, y, (x - 0.5).abs()]);
        let chosen = edges_within_angle(&roof, 0.01, &Unmonitored).unwrap();
        let two = dissolve_edges(&roof, &chosen, 0.01).unwrap();
        assert_eq!((two.mesh.face_count(), two.mesh.vertex_count()), (2, 6));
        let values = AttributeValues::Number(vec![0.0; 15].into_iter().chain([1.0]).collect());
        let marked = roof
            .clone()
            .with_attribute(Attribute::new(SEAM, Domain::Corner, values))
            .unwrap();
        let chosen = edges_by_attribute(&marked, SEAM, 0.5).unwrap();
        assert_eq!(chosen.iter().filter(|&&chosen| chosen).count(), 1);
        let missing = edges_by_attribute(&roof, SEAM, 0.5).unwrap_err();
        assert!(missing.to_string().contains("`seam`"), "{missing}");
    }
}
