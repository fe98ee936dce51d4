//! Shapes and files for this crate's tests.

use glam::DVec3;

use crate::math::{PI, TAU, cos, sin};
use crate::normals::{NormalWeights, vertex_normals};
use crate::test_support::peer_case;
use crate::{DirectionSource, Directions, Mesh, Unmonitored};

/// A quad grid of `nx` by `ny` cells over the unit square, placed by `f(x, y)`.
pub(crate) fn grid(nx: u32, ny: u32, f: impl Fn(f64, f64) -> [f64; 3]) -> Mesh {
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    for j in 0..=ny {
        for i in 0..=nx {
            positions.push(f(
                f64::from(i) / f64::from(nx),
                f64::from(j) / f64::from(ny),
            ));
            if i < nx && j < ny {
                let v = j * (nx + 1) + i;
                faces.push([v, v + 1, v + nx + 2, v + nx + 1]);
            }
        }
    }
    Mesh::from_faces(positions, &faces).unwrap()
}

/// An open polyhedral cylinder round z, radius 1, height `rings`, normals outward.
pub(crate) fn cylinder(sides: u32, rings: u32) -> Mesh {
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    for z in 0..=rings {
        for k in 0..sides {
            let angle = TAU * f64::from(k) / f64::from(sides);
            positions.push([cos(angle), sin(angle), f64::from(z)]);
            if z < rings {
                let (a, b) = (z * sides + k, z * sides + (k + 1) % sides);
                faces.push([a, b, b + sides, a + sides]);
            }
        }
    }
    Mesh::from_faces(positions, &faces).unwrap()
}

/// A unit sphere of quads, and triangles at the poles, normals outward.
pub(crate) fn sphere(sides: u32, rings: u32) -> Mesh {
    let mut positions = vec![[0.0, 0.0, -1.0]];
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for ring in 1..rings {
        let polar = PI * f64::from(ring) / f64::from(rings);
        for k in 0..sides {
            let angle = TAU * f64::from(k) / f64::from(sides);
            let (x, y) = (cos(angle), sin(angle));
            positions.push([sin(polar) * x, sin(polar) * y, -cos(polar)]);
        }
    }
    let top = positions.len() as u32;
    positions.push([0.0, 0.0, 1.0]);
    let at = |ring: u32, k: u32| 1 + (ring - 1) * sides + k % sides;
    for k in 0..sides {
        faces.push(vec![0, at(1, k + 1), at(1, k)]);
        for ring in 1..rings - 1 {
            faces.push(vec![
                at(ring, k),
                at(ring, k + 1),
                at(ring + 1, k + 1),
                at(ring + 1, k),
            ]);
        }
        faces.push(vec![top, at(rings - 1, k), at(rings - 1, k + 1)]);
    }
    Mesh::from_faces(positions, &faces).unwrap()
}

/// Angle-weighted vertex normals as directions.
pub(crate) fn normals(mesh: &Mesh) -> Directions {
    let normals = vertex_normals(mesh, NormalWeights::Angle, true, &Unmonitored).unwrap();
    directions(mesh, normals)
}

pub(crate) fn directions(mesh: &Mesh, vectors: Vec<DVec3>) -> Directions {
    Directions::new(mesh, vectors, DirectionSource::Surface).unwrap()
}

/// The same faces with vertex `v` renamed to `names[v]`.
pub(crate) fn renumbered(mesh: &Mesh, names: &[u32]) -> Mesh {
    let mut positions = vec![[0.0; 3]; names.len()];
    for (place, &name) in mesh.positions().iter().zip(names) {
        positions[name as usize] = place.to_array();
    }
    let faces: Vec<Vec<u32>> = mesh
        .topology()
        .faces()
        .map(|face| face.iter().map(|&v| names[v as usize]).collect())
        .collect();
    Mesh::from_faces(positions, &faces).unwrap()
}

/// A file of the recorded cases in tests/peer, as a mesh; `None`, said aloud,
/// where they are not there.
pub(crate) fn case(path: &str) -> Option<Mesh> {
    let (folder, file) = path.split_once('/').unwrap();
    Some(peer_case(folder)?.mesh(file.trim_end_matches(".obj")))
}
