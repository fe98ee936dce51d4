//! Normals of a smooth surface from the vertices of its mesh.

use glam::DVec3;

use crate::Mesh;
use crate::math::unit_or_zero;

/// Coefficients of a cubic without its constant: x, y, x², xy, y², x³, x²y, xy², y³.
const TERMS: usize = 9;

/// Largest root mean square distance of the vertices to the cubic, as a share of
/// the neighbourhood's radius, for the surface to count as smooth there.
const SMOOTH: f64 = 0.02;

/// Smallest pivot, as a share of the largest, for the vertices to say all terms.
const PIVOT: f64 = 1e-7;

/// The normal at `vertex` of the cubic (3-jet) that fits the vertices of two rings
/// of faces best (Cazals and Pouget 2005): with faces of size h its error is
/// O(h³) on a smooth surface, that of a weighted mean of face normals O(h²), and
/// O(h) where faces differ in size.
///
/// `normal` is a unit normal to start from; it is returned where the surface is
/// not smooth, at folds and corners, or the vertices are too few or too regular
/// to tell. Vertices weigh by the inverse square of their distance. Cost: O(size
/// of the neighbourhood).
pub(super) fn jet_normal(mesh: &Mesh, vertex: usize, normal: DVec3, ring: &mut Vec<u32>) -> DVec3 {
    two_rings(mesh, vertex, ring);
    let at = mesh.positions()[vertex];
    let arms = || ring.iter().map(|&v| mesh.positions()[v as usize] - at);
    let radius = arms().map(DVec3::length).fold(0.0, f64::max);
    if ring.len() < TERMS + 1 || radius == 0.0 {
        return normal;
    }
    let one = unit_or_zero(normal.any_orthonormal_vector());
    let two = normal.cross(one);
    let row = |arm: DVec3| {
        let arm = arm / radius;
        let (x, y) = (arm.dot(one), arm.dot(two));
        let terms = [
            x,
            y,
            x * x,
            x * y,
            y * y,
            x * x * x,
            x * x * y,
            x * y * y,
            y * y * y,
        ];
        // Vertices at the same place say nothing about it.
        let weight = if arm == DVec3::ZERO {
            0.0
        } else {
            1.0 / arm.length_squared()
        };
        (terms, arm.dot(normal), weight)
    };
    let mut sums = [[0.0; TERMS + 1]; TERMS];
    for (terms, height, weight) in arms().map(row) {
        for (i, sums) in sums.iter_mut().enumerate() {
            for (j, &term) in terms.iter().enumerate() {
                sums[j] += weight * terms[i] * term;
            }
            sums[TERMS] += weight * terms[i] * height;
        }
    }
    let Some(jet) = solve(sums) else {
        return normal;
    };
    let misses = arms().map(row).map(|(terms, height, _)| {
        let found: f64 = terms.iter().zip(jet).map(|(term, by)| term * by).sum();
        (found - height) * (found - height)
    });
    if misses.sum::<f64>() > SMOOTH * SMOOTH * ring.len() as f64 {
        return normal;
    }
    unit_or_zero(normal - one * jet[0] - two * jet[1])
}

/// The vertices of the faces that share a vertex with the faces round `vertex`,
/// without itself, ascending.
fn two_rings(mesh: &Mesh, vertex: usize, ring: &mut Vec<u32>) {
    ring.clear();
    let adjacency = mesh.topology().adjacency();
    let faces = |vertex: usize| {
        let corners = adjacency.vertex_corners(vertex).iter();
        corners.map(|&corner| adjacency.corner_faces()[corner as usize] as usize)
    };
    for face in faces(vertex) {
        for &near in mesh.face(face) {
            for face in faces(near as usize) {
                ring.extend_from_slice(mesh.face(face));
            }
        }
    }
    ring.sort_unstable();
    ring.dedup();
    ring.retain(|&other| other as usize != vertex);
}

/// Solves symmetric equations, the right side in the last column, by elimination
/// with the largest diagonal first; `None` where they do not say enough.
fn solve(mut rows: [[f64; TERMS + 1]; TERMS]) -> Option<[f64; TERMS]> {
    let mut done = [false; TERMS];
    let mut largest = 0.0;
    for _ in 0..TERMS {
        let free = (0..TERMS).filter(|&k| !done[k]);
        let pivot = free.reduce(|a, b| if rows[b][b] > rows[a][a] { b } else { a })?;
        let size = rows[pivot][pivot];
        largest = f64::max(largest, size);
        if size.is_nan() || size <= PIVOT * largest {
            return None;
        }
        done[pivot] = true;
        let by = rows[pivot];
        for k in (0..TERMS).filter(|&k| k != pivot) {
            let share = rows[k][pivot] / size;
            for (cell, by) in rows[k].iter_mut().zip(by) {
                *cell -= share * by;
            }
        }
    }
    Some(std::array::from_fn(|k| rows[k][TERMS] / rows[k][k]))
}
