//! Input meshes: positions and faces, the same in every run.

use crate::random;

/// Positions and quads.
pub type Quads = (Vec<[f64; 3]>, Vec<[u32; 4]>);

/// A wavy sheet of `nx` by `ny` cells, each one unit wide.
pub fn sheet(nx: u32, ny: u32) -> Quads {
    let row = nx + 1;
    let place = |v: u32| {
        let (x, y) = (f64::from(v % row), f64::from(v / row));
        // Parabolas end to end: a smooth wave without trigonometry.
        let wave = |t: f64| {
            let t = t.fract() * 2.0 - 1.0;
            t * (1.0 - t.abs())
        };
        [x, y, 40.0 * wave(x / 173.0) + 30.0 * wave(y / 131.0)]
    };
    let quad = |cell: u32| {
        let v = cell / nx * row + cell % nx;
        [v, v + 1, v + row + 1, v + row]
    };
    (
        (0..row * (ny + 1)).map(place).collect(),
        (0..nx * ny).map(quad).collect(),
    )
}

/// A closed torus of `n` by `n` quads, every sixteenth of them replaced by a
/// smaller quad and the four round it: vertices of valence 3 and 5.
pub fn irregular_torus(n: u32) -> Quads {
    let mut positions: Vec<[f64; 3]> = Vec::new();
    for v in 0..n * n {
        let ([x, y], [r, z]) = (circle(v % n, n), circle(v / n, n));
        let radius = 10.0 + 4.0 * r;
        positions.push([x * radius, y * radius, 4.0 * z]);
    }
    let mut faces = Vec::new();
    for cell in 0..n * n {
        let (i, j) = (cell % n, cell / n);
        let at = |i: u32, j: u32| j % n * n + i % n;
        let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if i % 4 != 0 || j % 4 != 0 {
            faces.push(quad);
            continue;
        }
        let first = positions.len() as u32;
        let corners = quad.map(|v| positions[v as usize]);
        let centre: [f64; 3] =
            std::array::from_fn(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 4.0);
        for corner in corners {
            positions.push(std::array::from_fn(|k| (corner[k] + centre[k]) / 2.0));
        }
        for k in 0..4 {
            let next = (k + 1) % 4;
            faces.push([quad[k], quad[next], first + next as u32, first + k as u32]);
        }
        faces.push([first, first + 1, first + 2, first + 3]);
    }
    (positions, faces)
}

/// A ring that lies in the unit square: `n` by `n` vertices and as many quads.
pub fn ring(n: u32) -> Quads {
    let place = |v: u32| {
        let ([x, y], [r, z]) = (circle(v % n, n), circle(v / n, n));
        let radius = 0.375 + 0.125 * r;
        [0.5 + x * radius, 0.5 + y * radius, 0.125 + 0.125 * z]
    };
    let quad = |cell: u32| {
        let (i, j) = (cell % n, cell / n);
        let at = |i: u32, j: u32| j % n * n + i % n;
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    };
    (
        (0..n * n).map(place).collect(),
        (0..n * n).map(quad).collect(),
    )
}

/// Place `k` of `n` on the unit circle, by its rational form: the same
/// everywhere, without trigonometry.
fn circle(k: u32, n: u32) -> [f64; 2] {
    let turn = 4.0 * f64::from(k) / f64::from(n);
    let (quarter, s) = (turn as usize % 4, turn.fract());
    let (x, y) = ((1.0 - s * s) / (1.0 + s * s), 2.0 * s / (1.0 + s * s));
    [[x, y], [-y, x], [-x, -y], [y, -x]][quarter]
}

/// Each quad as two triangles.
pub fn triangles(quads: &[[u32; 4]]) -> Vec<[u32; 3]> {
    quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect()
}

/// A point for each of `places` moved by `low..high` in a random direction,
/// as fixed by `seed`.
pub fn scattered(places: &[[f64; 3]], low: f64, high: f64, seed: u64) -> Vec<[f64; 3]> {
    let one = |(index, place): (usize, &[f64; 3])| {
        let draw = |k: u64| random(seed, 4 * index as u64 + k);
        let way: [f64; 3] = std::array::from_fn(|k| 2.0 * draw(k as u64) - 1.0);
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-9);
        let distance = low + (high - low) * draw(3);
        std::array::from_fn(|k| place[k] + way[k] / length * distance)
    };
    places.iter().enumerate().map(one).collect()
}

/// A mesh as the text of an OBJ file.
pub fn obj((positions, faces): &Quads) -> String {
    use std::fmt::Write as _;
    let mut text = String::new();
    for [x, y, z] in positions {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for face in faces {
        let [a, b, c, d] = face.map(|v| v + 1);
        let _ = writeln!(text, "f {a} {b} {c} {d}");
    }
    text
}
