//! Joining vertices: those at the same place, or a given list of pairs.

mod coincident;
mod near;

use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;

use crate::parallel::in_order;
use crate::rebuild::{Sources, rebuild};
use crate::{GeometryError, Mesh, Monitor, Topology, parallel};

/// A mesh after vertices were joined.
#[derive(Debug, Clone)]
pub struct Welded {
    /// The mesh. Surviving vertices keep their order.
    pub mesh: Mesh,
    /// Vertices that were joined to another one.
    pub joined: usize,
    /// Faces dropped because fewer than three corners were left of them.
    pub dropped_faces: usize,
    /// The old index of each vertex that is left.
    pub vertex_sources: Vec<u32>,
}

/// Joins vertices that are at most `distance` (metres) apart.
///
/// Vertices form clusters: the transitive closure of all pairs within the
/// distance, so the result does not depend on the order in which pairs are
/// found. Each cluster becomes its vertex of lowest index, which keeps its
/// position and attributes. Distance 0 joins exactly equal positions. Corners
/// that repeat within a face are dropped, and faces with fewer than three left;
/// that also removes faces shorter than the distance, so keep it well below the
/// smallest feature. Cost: O(vertices · log vertices) for positions that are not
/// crowded far below `distance`.
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored, weld_vertices};
/// let soup = Mesh::from_faces(
///     vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
///     &[[0, 1, 2], [3, 4, 5]],
/// )?;
/// let welded = weld_vertices(&soup, 0.0, &Unmonitored)?;
/// assert_eq!((welded.mesh.vertex_count(), welded.joined), (4, 2));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::OutOfRange`] for a distance that is negative or not
/// finite, [`GeometryError::Cancelled`].
pub fn weld_vertices(
    mesh: &Mesh,
    distance: f64,
    monitor: &dyn Monitor,
) -> Result<Welded, GeometryError> {
    check_distance(distance)?;
    let target = clusters(mesh.positions(), distance, monitor)?;
    merge_vertices(mesh, &target, monitor)
}

/// [`weld_vertices`] for vertices on open borders and those of no face only: what
/// is inside a surface stays, however close it lies.
///
/// # Errors
/// As there.
pub fn weld_border_vertices(
    mesh: &Mesh,
    distance: f64,
    monitor: &dyn Monitor,
) -> Result<Welded, GeometryError> {
    check_distance(distance)?;
    let adjacency = mesh.topology().adjacency_with(monitor)?;
    let is_open = |&vertex: &u32| {
        let vertex = vertex as usize;
        adjacency.is_boundary_vertex(vertex) || adjacency.vertex_corners(vertex).is_empty()
    };
    let open: Vec<u32> = (0..mesh.vertex_count() as u32).filter(is_open).collect();
    let positions: Vec<DVec3> = open
        .iter()
        .map(|&vertex| mesh.positions()[vertex as usize])
        .collect();
    let lowest = clusters(&positions, distance, monitor)?;
    let mut target: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
    for (&vertex, lowest) in open.iter().zip(lowest) {
        target[vertex as usize] = open[lowest as usize];
    }
    merge_vertices(mesh, &target, monitor)
}

fn check_distance(distance: f64) -> Result<(), GeometryError> {
    if distance >= 0.0 && distance.is_finite() {
        return Ok(());
    }
    Err(GeometryError::OutOfRange {
        what: "the distance",
        value: distance,
        requirement: "it must be finite and not negative",
    })
}

/// Joins every vertex to `target[vertex]`, which must be its own target and not
/// be above it.
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub(crate) fn merge_vertices(
    mesh: &Mesh,
    target: &[u32],
    monitor: &dyn Monitor,
) -> Result<Welded, GeometryError> {
    let (mut new, mut vertices) = (vec![0; target.len()], Vec::new());
    in_order(target.len(), monitor, |v| {
        let target = target[v] as usize;
        new[v] = if target == v {
            vertices.push(v as u32);
            vertices.len() as u32 - 1
        } else {
            new[target]
        };
    })?;
    let renamed = Renamed::new(mesh, &new, vertices.len(), monitor)?;
    let new_count = vertices.len();
    let positions = parallel::map(new_count, monitor, |v| {
        mesh.positions()[vertices[v] as usize]
    })?;
    let dropped_faces = mesh.face_count() - renamed.topology.face_count();
    let sources = Sources {
        faces: renamed.faces,
        corners: renamed.corners,
        vertices: Some(vertices),
    };
    Ok(Welded {
        mesh: rebuild(mesh, positions, renamed.topology, &sources)?,
        joined: mesh.vertex_count() - new_count,
        dropped_faces,
        vertex_sources: sources.vertices.unwrap_or_default(),
    })
}

/// Faces after vertices were joined, and the old faces and corners they are;
/// `None` where nothing collapsed and these are the same.
struct Renamed {
    topology: Topology,
    faces: Option<Vec<u32>>,
    corners: Option<Vec<u32>>,
}

impl Renamed {
    /// The faces of `mesh` with each vertex called `new[vertex]`, of `count` names.
    fn new(
        mesh: &Mesh,
        new: &[u32],
        count: usize,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        let collapses = AtomicBool::new(false);
        let mut corners = parallel::zeroed(mesh.corner_count());
        let offsets = mesh.topology().offsets();
        parallel::fill_runs(
            &mut corners,
            offsets,
            monitor,
            || (),
            |(), face, slots| {
                let mut previous = new[mesh.face(face)[slots.len() - 1] as usize];
                for (slot, &vertex) in slots.iter_mut().zip(mesh.face(face)) {
                    *slot = new[vertex as usize];
                    if *slot == previous {
                        collapses.store(true, Ordering::Relaxed);
                    }
                    previous = *slot;
                }
            },
        )?;
        if collapses.into_inner() {
            return Self::collapsed(mesh, new, count, monitor);
        }
        Ok(Self {
            topology: mesh.topology().renamed(count, corners)?,
            faces: None,
            corners: None,
        })
    }

    /// The same where corners, and perhaps faces, are left out.
    fn collapsed(
        mesh: &Mesh,
        new: &[u32],
        count: usize,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        let renamed = |vertex: u32| new[vertex as usize];
        let counts = parallel::map(mesh.face_count(), monitor, |face| {
            let kept = kept_corners(mesh.face(face), renamed).count();
            if kept < 3 { 0 } else { kept as u32 }
        })?;
        let (mut faces, mut offsets) = (Vec::new(), vec![0]);
        for (&count, face) in counts.iter().zip(0u32..) {
            if count > 0 {
                faces.push(face);
                offsets.push(offsets[offsets.len() - 1] + count);
            }
        }
        let mut sources = parallel::zeroed(offsets[faces.len()] as usize);
        parallel::fill_runs(
            &mut sources,
            &offsets,
            monitor,
            || (),
            |(), run, slots| {
                let face = faces[run] as usize;
                let start = mesh.topology().corner_range(face).start;
                let kept = kept_corners(mesh.face(face), renamed);
                for (slot, corner) in slots.iter_mut().zip(kept) {
                    *slot = (start + corner) as u32;
                }
            },
        )?;
        let corners = parallel::map(sources.len(), monitor, |corner| {
            renamed(mesh.topology().corners()[sources[corner] as usize])
        })?;
        Ok(Self {
            topology: Topology::new(count, offsets, corners)?,
            faces: (faces.len() < mesh.face_count()).then_some(faces),
            corners: Some(sources),
        })
    }
}

/// The corners of a face that are left when its vertices are renamed: of
/// neighbours at one vertex the first, counted from corner 0.
fn kept_corners(face: &[u32], renamed: impl Fn(u32) -> u32) -> impl Iterator<Item = usize> {
    let is_kept = move |&corner: &usize| {
        let (first, here) = (renamed(face[0]), renamed(face[corner]));
        // The end of the list may lead back to corner 0.
        corner == 0
            || here != renamed(face[corner - 1])
                && !(here == first && face[corner..].iter().all(|&v| renamed(v) == first))
    };
    (0..face.len()).filter(is_kept)
}

/// For each position the lowest index of its cluster: the transitive closure of
/// all pairs within `distance`.
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub(crate) fn clusters(
    positions: &[DVec3],
    distance: f64,
    monitor: &dyn Monitor,
) -> Result<Vec<u32>, GeometryError> {
    if distance <= 0.0 {
        return coincident::lowest(positions, monitor);
    }
    let mut sets = near::sets(positions, distance, monitor)?;
    let mut lowest = vec![0; positions.len()];
    in_order(positions.len(), monitor, |i| {
        lowest[i] = sets.root(i as u32);
    })?;
    Ok(lowest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::sets::Sets;
    use proptest::prelude::*;

    fn brute(positions: &[DVec3], distance: f64) -> Vec<u32> {
        let mut sets = Sets::new(positions.len());
        for i in 0..positions.len() {
            for j in 0..i {
                if positions[i].distance_squared(positions[j]) <= distance * distance {
                    sets.join(i as u32, j as u32);
                }
            }
        }
        (0..positions.len() as u32).map(|i| sets.root(i)).collect()
    }

    proptest! {
        #[test]
        fn clusters_are_the_closure_of_near_pairs(
            // A coarse lattice makes exact coincidences and borderline distances common.
            places in prop::collection::vec(prop::array::uniform3(-12i32..12), 1..60),
            distance in prop::sample::select(vec![0.0, 0.1, 0.25, 0.3, 0.45]),
        ) {
            let positions: Vec<DVec3> = places
                .iter()
                .map(|p| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2])) * 0.125)
                .collect();
            prop_assert_eq!(clusters(&positions, distance, &Unmonitored).unwrap(), brute(&positions, distance));
        }
    }

    #[test]
    fn negative_zero_is_zero() {
        let places = [DVec3::new(0.0, 1.0, 0.0), DVec3::new(-0.0, 1.0, -0.0)];
        assert_eq!(clusters(&places, 0.0, &Unmonitored).unwrap(), [0, 0]);
    }

    #[test]
    fn chains_join_to_the_lowest_index_and_slivers_go() {
        let strip = Mesh::from_faces(
            vec![
                [0., 0., 0.],
                [1., 0., 0.],
                [1., 1e-5, 0.],
                [1., 2e-5, 0.],
                [0., 1., 0.],
            ],
            &[&[0, 1, 2, 3, 4][..], &[1, 2, 3]],
        )
        .unwrap();
        let welded = weld_vertices(&strip, 1.1e-5, &Unmonitored).unwrap();
        assert_eq!(welded.mesh.face(0), [0, 1, 2]);
        assert_eq!(welded.mesh.positions()[1], DVec3::new(1.0, 0.0, 0.0));
        assert_eq!((welded.joined, welded.dropped_faces), (2, 1));
        assert_eq!(welded.vertex_sources, [0, 1, 4]);
    }

    #[test]
    fn a_corner_that_repeats_at_the_end_of_a_face_is_dropped() {
        let quad = Mesh::from_faces(
            vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 0., 0.]],
            &[&[0, 1, 2, 3]],
        )
        .unwrap();
        assert_eq!(
            weld_vertices(&quad, 0.0, &Unmonitored)
                .unwrap()
                .mesh
                .face(0),
            [0, 1, 2]
        );
    }

    #[test]
    fn at_borders_only_what_is_open_is_joined() {
        // Two fans of four triangles whose centres and whose sides lie close.
        let around = |x: f64| {
            let places = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]];
            places.map(|[u, v]| [u + x, v, 0.0])
        };
        let mut places = [around(0.0), around(1.0)].concat();
        // A bump that lies over the other's centre.
        places[4] = [1.5, 0.5, 0.0];
        let fan = |first: u32| [0, 1, 2, 3].map(|k| [first + k, first + (k + 1) % 4, first + 4]);
        let faces = [fan(0), fan(5)].concat();
        let mesh = Mesh::from_faces(places, &faces).unwrap();
        let all = weld_vertices(&mesh, 0.0, &Unmonitored).unwrap();
        assert_eq!((all.joined, all.mesh.vertex_count()), (3, 7));
        let open = weld_border_vertices(&mesh, 0.0, &Unmonitored).unwrap();
        assert_eq!((open.joined, open.mesh.vertex_count()), (2, 8));
        assert_eq!(open.mesh.face(4), [1, 5, 7]);
        assert!(weld_border_vertices(&mesh, f64::NAN, &Unmonitored).is_err());
    }

    #[test]
    fn distances_without_meaning_are_refused() {
        let quad = Mesh::from_faces(vec![[0.0; 3]; 3], &[&[0, 1, 2]]).unwrap();
        for distance in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(weld_vertices(&quad, distance, &Unmonitored).is_err());
        }
    }
}
