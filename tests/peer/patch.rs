//! Patches of a subdivided base: Blender stops short of the limit surface at open
//! corners, so the components there are compared on its own subdivided base.

use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::normals::{NormalWeights, vertex_normals};
use tessgraph_geometry::subdivide::Parents;
use tessgraph_geometry::{
    ArrayDomain, ArrayOptions, DirectionSource, Directions, Fit, Interpolation, Mesh, PatchGrids,
    Unmonitored, array_components,
};

use super::case::Verdict;
use super::compare;
use crate::support::Ran;

const TOLERANCE: f64 = 1e-5;

/// Reproduced if the array over Blender's positions is theirs, and ours is the
/// same but for patches with an open corner.
pub(super) fn judge(ran: &Ran, blender: &Mesh, theirs: &Mesh) -> Verdict {
    let (base, ours) = (ran.mesh("base"), ran.mesh("result"));
    let reach = TOLERANCE * base.diagonal();
    let adjacency = base.topology().adjacency();
    let mut moved = Vec::new();
    let positions = base.positions().iter().enumerate().map(|(vertex, &p)| {
        let nearest = nearest(blender, p);
        if nearest.distance(p) > reach {
            moved.push(vertex as u32);
        }
        nearest
    });
    let positions: Vec<DVec3> = positions.collect();
    let is_corner = |&vertex: &u32| adjacency.vertex_corners(vertex as usize).len() == 1;
    if !moved.iter().all(is_corner) {
        return Verdict::Differs(format!("subdivided vertices {moved:?} are elsewhere"));
    }
    let there = base.with_positions(positions).expect("as many as before");
    let parents = Parents::of_mesh(&base).expect("a subdivided base");
    let on_theirs = array(&there, &parents, &ran.mesh("component"));
    if let Some(difference) = compare::difference(&on_theirs, theirs, TOLERANCE) {
        return Verdict::Differs(difference);
    }
    let count = ran.mesh("component").vertex_count();
    let at_corner = |patch: usize| {
        let mut vertices = parents.faces(patch).flat_map(|face| base.face(face));
        vertices.any(|vertex| moved.contains(vertex))
    };
    let pairs = ours.positions().iter().zip(on_theirs.positions().iter());
    for (vertex, (a, b)) in pairs.enumerate() {
        if a.distance(*b) > reach && !at_corner(vertex / count) {
            return Verdict::Differs(format!("vertex {vertex} is at {a}, theirs at {b}"));
        }
    }
    Verdict::Reproduced
}

fn nearest(mesh: &Mesh, p: DVec3) -> DVec3 {
    let positions = mesh.positions().iter().copied();
    let closer = |a: &DVec3, b: &DVec3| a.distance(p).total_cmp(&b.distance(p));
    positions.min_by(closer).expect("the base has vertices")
}

/// The add-on's array: vectors interpolated, heights as drawn, along normals.
fn array(base: &Mesh, parents: &Parents, component: &Mesh) -> Mesh {
    let normals = vertex_normals(base, NormalWeights::Angle, true, &Unmonitored).expect("normals");
    let normals = Directions::new(base, normals, DirectionSource::Surface).expect("one each");
    let grids = PatchGrids::of_parents(parents).expect("grids of its parents");
    let options = ArrayOptions {
        fit: Some(&Fit::Unit),
        interpolation: Interpolation::Linear,
        domain: ArrayDomain::Parent(&grids),
        ..ArrayOptions::default()
    };
    let array = array_components(base, &[component], &normals, &options, &Unmonitored);
    array.expect("an array").mesh
}
