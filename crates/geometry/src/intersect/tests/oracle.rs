//! Exact brute force over whole-number coordinates.

use std::collections::BTreeSet;

use super::{exact, intersections};
use crate::{Mesh, Unmonitored};

type Place = [i128; 3];
/// A rational place: numerators and a positive common denominator, reduced.
type Rational = [i128; 4];

fn minus(a: Place, b: Place) -> Place {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Place, b: Place) -> Place {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: Place, b: Place) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn normal(t: &[Place; 3]) -> Place {
    cross(minus(t[1], t[0]), minus(t[2], t[0]))
}

fn reduced([x, y, z, w]: Rational) -> Rational {
    let gcd = |mut a: i128, mut b: i128| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a.abs()
    };
    let divisor = gcd(gcd(x, y), gcd(z, w)) * w.signum();
    [x / divisor, y / divisor, z / divisor, w / divisor]
}

/// Whether a place in the plane of `t` is inside it or on its border.
fn inside(t: &[Place; 3], [x, y, z, w]: Rational) -> bool {
    let n = normal(t);
    (0..3).all(|k| {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        let arm = [x - a[0] * w, y - a[1] * w, z - a[2] * w];
        dot(cross(minus(b, a), arm), n) >= 0
    })
}

/// Where the segment from p to q meets a line or triangle: at n · x = c.
fn cut(p: Place, q: Place, n: Place, c: i128) -> Option<Rational> {
    let (of_p, of_q) = (dot(n, p) - c, dot(n, q) - c);
    if of_p == of_q || of_p * of_q > 0 {
        return None;
    }
    let w = of_p - of_q;
    let at = |k: usize| q[k] * of_p - p[k] * of_q;
    Some(reduced([at(0), at(1), at(2), w]))
}

/// Ends and corners of the common part of two triangles.
fn common(a: &[Place; 3], b: &[Place; 3]) -> BTreeSet<Rational> {
    let mut points = BTreeSet::new();
    for (s, t) in [(a, b), (b, a)] {
        let n = normal(t);
        for k in 0..3 {
            let (p, q) = (s[k], s[(k + 1) % 3]);
            points.extend(cut(p, q, n, dot(n, t[0])));
            if dot(n, minus(p, t[0])) == 0 {
                points.insert([p[0], p[1], p[2], 1]);
            }
            if dot(n, minus(p, t[0])) == 0 && dot(n, minus(q, t[0])) == 0 {
                for j in 0..3 {
                    let side = cross(n, minus(t[(j + 1) % 3], t[j]));
                    points.extend(cut(p, q, side, dot(side, t[j])));
                }
            }
        }
        points.retain(|&point| {
            let of = |t: &[Place; 3]| {
                let n = normal(t);
                let [x, y, z, w] = point;
                n[0] * x + n[1] * y + n[2] * z == dot(n, t[0]) * w
            };
            of(a) && of(b) && inside(a, point) && inside(b, point)
        });
    }
    points
}

fn straddles(a: &[Place; 3], b: &[Place; 3]) -> bool {
    let n = normal(b);
    let sides = a.map(|corner| dot(n, minus(corner, b[0])).signum());
    sides.contains(&1) && sides.contains(&-1)
}

struct Face {
    names: Vec<u32>,
    at: Vec<Place>,
}

impl Face {
    fn fans(&self) -> Vec<Vec<[usize; 3]>> {
        let n = self.at.len();
        let choices = if n == 3 { 1 } else { 2 };
        let fan = |c: usize| (1..n - 1).map(move |k| [c, (c + k) % n, (c + k + 1) % n]);
        (0..choices).map(|choice| fan(choice).collect()).collect()
    }

    fn triangle(&self, corners: [usize; 3]) -> Option<[Place; 3]> {
        let t = corners.map(|corner| self.at[corner]);
        (normal(&t) != [0; 3]).then_some(t)
    }
}

/// (meet, cross) of two triangles; `folds` if neighbours over an edge.
fn triangles(a: &[Place; 3], b: &[Place; 3], folds: bool) -> (bool, bool) {
    let shared: Vec<_> = a.iter().filter(|corner| b.contains(corner)).collect();
    if shared.len() == 3 {
        return (true, false);
    }
    let points = common(a, b);
    let is_shared = |p: &Rational| p[3] == 1 && shared.contains(&&[p[0], p[1], p[2]]);
    let meet = points.iter().any(|point| !is_shared(point));
    let crossing = straddles(a, b) && straddles(b, a) && points.len() > 1 && shared.len() < 2;
    (meet, crossing || (folds && shared.len() == 2 && meet))
}

/// Whether two diagonals with the same ends have wings that take turns round
/// them; `wings` are those of both.
fn alternate(ends: [Place; 2], wings: [[Place; 2]; 2]) -> bool {
    let axis = minus(ends[1], ends[0]);
    let turn = |a: Place, b: Place| dot(axis, cross(minus(a, ends[0]), minus(b, ends[0])));
    // Quarter by quarter round the axis, from the first wing on.
    let start = wings[0][0];
    let before = |a: Place, b: Place| {
        let half = |p: Place| i32::from(turn(start, p) < 0);
        match half(a).cmp(&half(b)) {
            std::cmp::Ordering::Equal => turn(a, b) > 0,
            order => order.is_lt(),
        }
    };
    let [a, b] = wings[1];
    let arm = |p: Place| cross(axis, minus(p, ends[0]));
    let level = |p: Place, q: Place| turn(p, q) == 0 && dot(arm(p), arm(q)) > 0;
    if wings[0].iter().any(|&own| level(own, a) || level(own, b)) {
        return false;
    }
    before(a, wings[0][1]) != before(b, wings[0][1])
}

/// Whether diagonals of two fans have the same ends and alternate.
fn diagonals_cross(a: &Face, in_a: &[[usize; 3]], b: &Face, in_b: &[[usize; 3]]) -> bool {
    let hinges = |face: &Face, fan: &[[usize; 3]]| -> Vec<([Place; 2], [Place; 2])> {
        let at = |corner: usize| face.at[corner];
        fan.windows(2)
            .map(|t| ([at(t[0][0]), at(t[0][2])], [at(t[0][1]), at(t[1][2])]))
            .collect()
    };
    hinges(a, in_a).iter().any(|&(ends, wings)| {
        hinges(b, in_b).iter().any(|&(others, other_wings)| {
            let same = ends == others || ends == [others[1], others[0]];
            same && alternate(ends, [wings, other_wings])
        })
    })
}

fn faces_relate(a: &Face, b: &Face) -> (bool, bool) {
    let folds = a.names.iter().filter(|name| b.names.contains(name)).count() == 2;
    let (mut meet, mut cross) = (None, true);
    for in_a in a.fans() {
        for in_b in b.fans() {
            let mut any = (false, false);
            for one in in_a.iter().filter_map(|&t| a.triangle(t)) {
                for two in in_b.iter().filter_map(|&t| b.triangle(t)) {
                    let (m, c) = triangles(&one, &two, folds);
                    any = (any.0 || m, any.1 || c);
                }
            }
            let along = diagonals_cross(a, &in_a, b, &in_b);
            any = (any.0 || along, any.1 || along);
            meet.get_or_insert(any.0);
            cross &= any.1;
        }
    }
    let meet = meet.unwrap();
    (meet && !cross, meet && cross)
}

struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 33) % limit
    }
}

/// Compares with brute force on a random mesh; says how many pairs cross and touch.
fn compare(random: &mut Random, sides: &[usize], size: u64) -> [usize; 2] {
    let vertices = 8 + random.below(8) as u32;
    let places: Vec<[f64; 3]> = (0..vertices)
        .map(|_| std::array::from_fn(|_| random.below(size) as f64))
        .collect();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    while faces.len() < 8 {
        let count = sides[random.below(sides.len() as u64) as usize];
        let mut face: Vec<u32> = Vec::new();
        while face.len() < count {
            let vertex = random.below(u64::from(vertices)) as u32;
            let place = places[vertex as usize].map(f64::to_bits);
            let differs = |&other: &u32| places[other as usize].map(f64::to_bits) != place;
            if face.iter().all(differs) {
                face.push(vertex);
            }
        }
        faces.push(face);
    }
    let mesh = Mesh::from_faces(places, &faces).unwrap();
    let found = intersections(&mesh, &exact(), &Unmonitored).unwrap();
    let face = |k: usize| Face {
        names: faces[k].clone(),
        at: faces[k]
            .iter()
            .map(|&v| mesh.positions()[v as usize].to_array().map(|x| x as i128))
            .collect(),
    };
    let (mut pairs, mut contacts) = (Vec::new(), Vec::new());
    for i in 0..faces.len() {
        for j in i + 1..faces.len() {
            let pair = [i as u32, j as u32];
            match faces_relate(&face(i), &face(j)) {
                (true, _) => contacts.push(pair),
                (_, true) => pairs.push(pair),
                _ => {}
            }
        }
    }
    assert_eq!(found.pairs, pairs, "{:?} {faces:?}", mesh.positions());
    assert_eq!(found.contacts, contacts, "{:?} {faces:?}", mesh.positions());
    [pairs.len(), contacts.len()]
}

#[test]
fn same_pairs_as_brute_force_on_random_meshes() {
    let mut random = Random(7);
    let mut total = [0; 2];
    // Few whole numbers make every degenerate position; many make none.
    for (sides, size) in [(&[3][..], 4), (&[3], 1000), (&[3, 4, 5], 10000)] {
        for _ in 0..400 {
            let counts = compare(&mut random, sides, size);
            total = [total[0] + counts[0], total[1] + counts[1]];
        }
    }
    assert!(total[0] > 2000 && total[1] > 2000, "{total:?}");
}
