//! Counts, area and volume of a mesh, sound or not.

use glam::DVec3;

use super::defects::{Defects, Found, find_defects};
use crate::parallel::{self, in_order};
use crate::sets::Sets;
use crate::{GeometryError, Mesh, Monitor, Topology};

/// What there is to say about a mesh in numbers; see [`measure_mesh`].
#[derive(Debug, Clone, PartialEq)]
pub struct MeshMeasures {
    /// Vertices, isolated ones included.
    pub vertices: usize,
    /// Edges: pairs of different vertices that follow each other in a face.
    pub edges: usize,
    /// Faces as stored, polygons not split.
    pub faces: usize,
    /// Triangles the faces make: corners less two for each face.
    pub triangles: usize,
    /// Vertices of faces - edges + faces.
    pub euler: i64,
    /// Pieces joined by edges, isolated vertices not counted.
    pub components: usize,
    /// Edges of one face only.
    pub boundary_edges: usize,
    /// Pieces that the boundary edges make, joined at their vertices: on a
    /// manifold mesh its boundary loops.
    pub boundary_loops: usize,
    /// Edges of more than two faces.
    pub nonmanifold_edges: usize,
    /// Vertices where faces meet that share no edge there (bow ties).
    pub nonmanifold_vertices: usize,
    /// Edges of two faces that both run along it in the same sense, so that one
    /// of the faces is turned inside out.
    pub inconsistent_edges: usize,
    /// Vertices of no face.
    pub isolated_vertices: usize,
    /// Faces that name a vertex twice, or whose area is not above 10⁻¹² times
    /// the square of the mesh's largest extent.
    pub degenerate_faces: usize,
    /// Faces with the same vertices as an earlier one, in any order.
    pub duplicate_faces: usize,
    /// The elements behind the six counts above.
    pub defects: Defects,
    /// Smallest and largest coordinates in metres; `None` without vertices.
    pub bounds: Option<(DVec3, DVec3)>,
    /// Area of the triangles of [`Mesh::triangles`] in m².
    pub area: f64,
    /// Enclosed volume in m³, negative if the faces point inwards; `None` for a
    /// mesh without faces and where a boundary, a non-manifold or an
    /// inconsistent edge leaves inside and outside undefined.
    pub volume: Option<f64>,
}

impl MeshMeasures {
    /// Whether extent, area and volume are finite: with coordinates beyond about
    /// 1e100 m they overflow.
    pub fn is_finite(&self) -> bool {
        let extent = self
            .bounds
            .is_none_or(|(low, high)| (high - low).is_finite());
        extent && self.area.is_finite() && self.volume.is_none_or(f64::is_finite)
    }
}

/// Measures a mesh of any quality. Cost: O(corners · log valence).
///
/// Sums run in fixed chunks and about the middle of the bounds, so they do not
/// depend on the number of threads and keep their digits far from the origin.
///
/// ```
/// use tessgraph_geometry::{glam::DVec3, measure::measure_mesh, primitives::cuboid};
/// let measures = measure_mesh(&cuboid(DVec3::new(1.0, 2.0, 3.0), [1, 1, 1], true)?);
/// assert_eq!((measures.euler, measures.boundary_loops), (2, 0));
/// assert_eq!(measures.volume, Some(6.0));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn measure_mesh(mesh: &Mesh) -> MeshMeasures {
    let topology = mesh.topology();
    let adjacency = topology.adjacency();
    let defects = find_defects(mesh);
    let boundary = Found::among(adjacency.edge_count(), |edge| {
        adjacency.is_boundary_edge(edge)
    });
    let used = mesh.vertex_count() - defects.isolated_vertices.count;
    let bounds = mesh.bounds();
    let (area, volume) = area_and_volume(mesh, bounds);
    let unclear = [
        &boundary,
        &defects.nonmanifold_edges,
        &defects.inconsistent_edges,
    ];
    let closed = unclear.iter().all(|edges| edges.count == 0);
    MeshMeasures {
        vertices: mesh.vertex_count(),
        edges: adjacency.edge_count(),
        faces: mesh.face_count(),
        triangles: mesh.corner_count() - 2 * mesh.face_count(),
        euler: used as i64 - adjacency.edge_count() as i64 + mesh.face_count() as i64,
        components: components(topology),
        boundary_edges: boundary.count,
        boundary_loops: boundary_pieces(topology),
        nonmanifold_edges: defects.nonmanifold_edges.count,
        nonmanifold_vertices: defects.nonmanifold_vertices.count,
        inconsistent_edges: defects.inconsistent_edges.count,
        isolated_vertices: defects.isolated_vertices.count,
        degenerate_faces: defects.degenerate_faces.count,
        duplicate_faces: defects.duplicate_faces.count,
        defects,
        bounds,
        area,
        volume: (closed && mesh.face_count() > 0).then_some(volume),
    }
}

/// Pieces joined by edges, of vertices that have faces.
fn components(topology: &Topology) -> usize {
    let adjacency = topology.adjacency();
    let mut sets = Sets::new(topology.vertex_count());
    for &[a, b] in adjacency.edges() {
        sets.join(a, b);
    }
    sets.count_roots(|vertex| !adjacency.vertex_corners(vertex).is_empty())
}

/// The piece of each face, as the lowest vertex of the piece: faces with a vertex
/// in common are of one piece. Cost: O(corners).
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub(crate) fn pieces_of_faces(
    topology: &Topology,
    monitor: &dyn Monitor,
) -> Result<Vec<u32>, GeometryError> {
    let mut sets = Sets::new(topology.vertex_count());
    in_order(topology.face_count(), monitor, |index| {
        let face = topology.face(index);
        for &vertex in &face[1..] {
            sets.join(face[0], vertex);
        }
    })?;
    let mut pieces = vec![0; topology.face_count()];
    in_order(pieces.len(), monitor, |index| {
        pieces[index] = sets.root(topology.face(index)[0]);
    })?;
    Ok(pieces)
}

/// Pieces of boundary edges, joined at their vertices.
fn boundary_pieces(topology: &Topology) -> usize {
    let adjacency = topology.adjacency();
    let mut sets = Sets::new(topology.vertex_count());
    let mut on_boundary = vec![false; topology.vertex_count()];
    for (edge, &[a, b]) in adjacency.edges().iter().enumerate() {
        if adjacency.is_boundary_edge(edge) {
            sets.join(a, b);
            on_boundary[a as usize] = true;
            on_boundary[b as usize] = true;
        }
    }
    sets.count_roots(|vertex| on_boundary[vertex])
}

/// Area of all triangles, and the volume they enclose if they enclose one:
/// a sixth of the sum of a · (b × c) about the middle of the bounds.
fn area_and_volume(mesh: &Mesh, bounds: Option<(DVec3, DVec3)>) -> (f64, f64) {
    let middle = bounds.map_or(DVec3::ZERO, |(low, high)| low * 0.5 + high * 0.5);
    let triangles = mesh.triangle_vertices(&mesh.triangles());
    let step = |(area, volume): (f64, f64), index: usize| {
        let [a, b, c] = triangles[index].map(|vertex| mesh.positions()[vertex as usize] - middle);
        let cross = (b - a).cross(c - a);
        (area + cross.length(), volume + a.dot(cross))
    };
    let merge = |a: (f64, f64), b: (f64, f64)| (a.0 + b.0, a.1 + b.1);
    let (area, volume) = parallel::reduce(triangles.len(), || (0.0, 0.0), step, merge);
    (area / 2.0, volume / 6.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitives::{cuboid, grid};
    use glam::DVec2;

    fn mesh(positions: &[[f64; 3]], faces: &[&[u32]]) -> Mesh {
        Mesh::from_faces(positions.to_vec(), faces).expect("valid")
    }

    const SQUARE: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn nothing_measures_nothing() {
        let measures = measure_mesh(&mesh(&[], &[]));
        assert_eq!((measures.euler, measures.components), (0, 0));
        assert_eq!((measures.volume, measures.bounds), (None, None));
    }

    #[test]
    fn an_open_grid_has_a_loop_and_no_volume() {
        let measures = measure_mesh(&grid([3, 2], DVec2::new(3.0, 2.0), false).expect("valid"));
        assert_eq!(
            (measures.edges, measures.triangles, measures.euler),
            (17, 12, 1)
        );
        assert_eq!((measures.boundary_edges, measures.boundary_loops), (10, 1));
        assert_eq!((measures.area, measures.volume), (6.0, None));
    }

    #[test]
    fn volume_keeps_its_digits_far_away() {
        let cube = cuboid(DVec3::ONE, [2, 2, 2], false).expect("valid");
        let far = DVec3::new(5e6, -3e6, 1e6);
        let moved = cube.positions().iter().map(|&p| p + far).collect();
        let measures = measure_mesh(&cube.with_positions(moved).expect("finite"));
        assert!((measures.volume.expect("closed") - 1.0).abs() < 1e-8);
    }

    #[test]
    fn an_inside_out_box_has_negative_volume() {
        let cube = cuboid(DVec3::ONE, [1, 1, 1], false).expect("valid");
        let faces: Vec<Vec<u32>> = (0..6)
            .map(|face| cube.face(face).iter().rev().copied().collect())
            .collect();
        let positions = cube.positions().iter().map(|p| p.to_array()).collect();
        let turned = Mesh::from_faces(positions, &faces).expect("valid");
        assert_eq!(measure_mesh(&turned).volume, Some(-1.0));
    }

    #[test]
    fn faults_are_counted_apart() {
        // 0 1 2 3 a square; its copy turned round; a triangle of repeated
        // vertices; a fin on edge 0-1; vertex 5 of no face.
        let mut positions = SQUARE.to_vec();
        positions.extend([[0.5, 0.0, 1.0], [9.0, 9.0, 9.0]]);
        let all = mesh(
            &positions,
            &[&[0, 1, 2, 3], &[3, 2, 1, 0], &[0, 1, 1], &[0, 1, 4]],
        );
        let measures = measure_mesh(&all);
        assert_eq!(measures.duplicate_faces, 1);
        assert_eq!(measures.degenerate_faces, 1);
        assert_eq!(measures.nonmanifold_edges, 1);
        assert_eq!(measures.isolated_vertices, 1);
        assert_eq!((measures.components, measures.boundary_edges), (1, 2));
        assert_eq!(measures.volume, None);
    }

    #[test]
    fn a_flipped_neighbour_is_inconsistent() {
        let mut positions = SQUARE.to_vec();
        positions.extend([[2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]);
        let measures = measure_mesh(&mesh(&positions, &[&[0, 1, 2, 3], &[1, 2, 5, 4]]));
        assert_eq!(
            (measures.inconsistent_edges, measures.nonmanifold_edges),
            (1, 0)
        );
    }

    #[test]
    fn a_bow_tie_is_a_nonmanifold_vertex_and_one_piece() {
        let mut positions = SQUARE.to_vec();
        positions.extend([[2.0, 1.0, 0.0], [2.0, 2.0, 0.0], [1.0, 2.0, 0.0]]);
        let measures = measure_mesh(&mesh(&positions, &[&[0, 1, 2, 3], &[2, 4, 5, 6]]));
        assert_eq!((measures.nonmanifold_vertices, measures.components), (1, 1));
        assert_eq!((measures.boundary_edges, measures.boundary_loops), (8, 1));
    }
}
