//! Tests of subdivision against closed forms, a naive oracle and OpenSubdiv.
#![expect(clippy::float_cmp, reason = "copied values must not change at all")]

mod baseline;
mod closed;
mod corners;
mod inherit;
mod limits;
mod oracle;
mod order;
mod properties;

use glam::DVec3;

use super::{
    Boundary, CORNER_SHARPNESS, CREASE, CornerRule, Options, Positions, Scheme, Subdivision,
    subdivide,
};
use crate::mesh::{Attribute, AttributeValues, Domain, Mesh};
use crate::{GeometryError, Unmonitored};

fn run(mesh: &Mesh, options: Options) -> Subdivision {
    subdivide(mesh, options, &Unmonitored).expect("can be subdivided")
}

fn levels(levels: u32) -> Options {
    Options {
        levels,
        ..Options::default()
    }
}

/// Sets the sharpness of edges, on every corner that leaves them.
fn with_creases(mesh: Mesh, edges: &[([u32; 2], f64)]) -> Mesh {
    let mut sharpness = vec![0.0; mesh.corner_count()];
    for face in 0..mesh.face_count() {
        let range = mesh.topology().corner_range(face);
        let vertices = mesh.face(face);
        for k in 0..vertices.len() {
            let (a, b) = (vertices[k], vertices[(k + 1) % vertices.len()]);
            for &([x, y], value) in edges {
                if (a.min(b), a.max(b)) == (x.min(y), x.max(y)) {
                    sharpness[range.start + k] = value;
                }
            }
        }
    }
    let values = AttributeValues::Number(sharpness.into());
    let attribute = Attribute::new(CREASE, Domain::Corner, values);
    mesh.with_attribute(attribute).expect("one per corner")
}

fn with_corners(mesh: Mesh, vertices: &[(u32, f64)]) -> Mesh {
    let mut sharpness = vec![0.0; mesh.vertex_count()];
    for &(vertex, value) in vertices {
        sharpness[vertex as usize] = value;
    }
    let values = AttributeValues::Number(sharpness.into());
    let attribute = Attribute::new(CORNER_SHARPNESS, Domain::Vertex, values);
    mesh.with_attribute(attribute).expect("one per vertex")
}

/// Half-size 1, vertex (x, y, z) at number x + 2y + 4z with 0 for -1.
fn cube() -> Mesh {
    crate::primitives::cuboid(DVec3::splat(2.0), [1, 1, 1], true).expect("valid")
}

/// A strip of a triangle, a bent quad, a pentagon and another quad, with borders.
fn mixed() -> Mesh {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.1, 0.2],
        [1.1, 1.0, -0.1],
        [2.2, 0.0, 0.3],
        [2.0, 1.2, 0.0],
        [3.0, -0.5, 0.1],
        [3.8, 0.4, 0.6],
        [3.1, 1.4, 0.2],
        [2.6, 2.5, 0.9],
        [1.2, 2.2, 0.4],
    ];
    let faces: [&[u32]; 4] = [&[0, 1, 2], &[1, 3, 4, 2], &[4, 3, 5, 6, 7], &[2, 4, 8, 9]];
    Mesh::from_faces(positions, &faces).expect("valid")
}

/// The largest distance of a point of `ours` to the nearest of `theirs`, and of
/// theirs to ours.
fn set_distance(ours: &[DVec3], theirs: &[DVec3]) -> f64 {
    let one_way = |from: &[DVec3], to: &[DVec3]| {
        let nearest = |p: &DVec3| {
            to.iter()
                .map(|q| p.distance(*q))
                .fold(f64::INFINITY, f64::min)
        };
        from.iter().map(nearest).fold(0.0, f64::max)
    };
    one_way(ours, theirs).max(one_way(theirs, ours))
}
