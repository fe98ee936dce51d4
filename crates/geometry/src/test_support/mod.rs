//! Tools for tests: reference cases, mesh comparison, simple shapes.

mod compare;
mod obj;
mod peer;

pub(crate) use compare::{assert_closed, assert_same_mesh, euler, volume};
pub(crate) use peer::{PeerCase, peer_case};

use crate::Mesh;

/// A flat grid of nx by ny quads in z = 0, placed by `place` from whole steps.
pub(crate) fn grid(nx: u32, ny: u32, place: impl Fn(f64, f64) -> [f64; 3]) -> Mesh {
    let vertex = |i: u32, j: u32| j * (nx + 1) + i;
    let steps = (0..=ny).flat_map(|j| (0..=nx).map(move |i| (f64::from(i), f64::from(j))));
    let faces: Vec<[u32; 4]> = (0..ny)
        .flat_map(|j| (0..nx).map(move |i| (i, j)))
        .map(|(i, j)| {
            [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ]
        })
        .collect();
    Mesh::from_faces(steps.map(|(i, j)| place(i, j)).collect(), &faces).unwrap()
}

/// A torus of m by n quads, closed in both directions.
pub(crate) fn torus(m: u32, n: u32, large: f64, small: f64) -> Mesh {
    use crate::math::{TAU, cos, sin};
    let place = |k: u32| {
        let (a, b) = (
            TAU * f64::from(k % m) / f64::from(m),
            TAU * f64::from(k / m) / f64::from(n),
        );
        let r = large + small * cos(b);
        [r * cos(a), r * sin(a), small * sin(b)]
    };
    let vertex = |i: u32, j: u32| (j % n) * m + i % m;
    let faces: Vec<[u32; 4]> = (0..n)
        .flat_map(|j| (0..m).map(move |i| (i, j)))
        .map(|(i, j)| {
            [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ]
        })
        .collect();
    Mesh::from_faces((0..m * n).map(place).collect(), &faces).unwrap()
}

/// The box [0, x] x [0, y] x [low, high] of six quads facing out.
pub(crate) fn cuboid(x: f64, y: f64, low: f64, high: f64) -> Mesh {
    let corner = |k: u32| {
        let square = [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]][k as usize % 4];
        [square[0], square[1], if k < 4 { low } else { high }]
    };
    let faces = [
        [3, 2, 1, 0],
        [4, 5, 6, 7],
        [0, 1, 5, 4],
        [1, 2, 6, 5],
        [2, 3, 7, 6],
        [3, 0, 4, 7],
    ];
    Mesh::from_faces((0..8).map(corner).collect(), &faces).unwrap()
}
