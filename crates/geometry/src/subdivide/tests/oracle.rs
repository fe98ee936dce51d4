//! A naive Catmull-Clark refinement, as the textbook writes it.

use std::collections::BTreeMap;

use super::*;

/// A mesh as lists, with sharpness by edge and vertex; borders are sharp.
struct Plain {
    points: Vec<DVec3>,
    faces: Vec<Vec<usize>>,
    creases: BTreeMap<[usize; 2], f64>,
    corners: Vec<f64>,
}

fn key(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

impl Plain {
    fn of(mesh: &Mesh, boundary: Boundary) -> Self {
        let faces: Vec<Vec<usize>> = mesh
            .topology()
            .faces()
            .map(|f| f.iter().map(|&v| v as usize).collect())
            .collect();
        let mut creases = BTreeMap::new();
        let given = match mesh.attribute(CREASE, Domain::Corner).map(|a| a.values()) {
            Some(AttributeValues::Number(values)) => values.to_vec(),
            _ => vec![0.0; mesh.corner_count()],
        };
        let mut corner = 0;
        for face in &faces {
            for k in 0..face.len() {
                creases.insert(key(face[k], face[(k + 1) % face.len()]), given[corner]);
                corner += 1;
            }
        }
        let mut corners = match mesh
            .attribute(CORNER_SHARPNESS, Domain::Vertex)
            .map(|a| a.values())
        {
            Some(AttributeValues::Number(values)) => values.to_vec(),
            _ => vec![0.0; mesh.vertex_count()],
        };
        for (vertex, sharpness) in corners.iter_mut().enumerate() {
            let count = faces.iter().filter(|face| face.contains(&vertex)).count();
            if count == 1 && boundary == Boundary::EdgeAndCorner {
                *sharpness = f64::INFINITY;
            }
        }
        let points = mesh.positions().to_vec();
        let mut plain = Self {
            points,
            faces,
            creases,
            corners,
        };
        let on_border: Vec<_> = plain
            .creases
            .keys()
            .copied()
            .filter(|&edge| plain.faces_of(edge).len() == 1)
            .collect();
        for edge in on_border {
            plain.creases.insert(edge, f64::INFINITY);
        }
        plain
    }

    fn faces_of(&self, edge: [usize; 2]) -> Vec<usize> {
        let has = |face: &Vec<usize>| {
            (0..face.len()).any(|k| key(face[k], face[(k + 1) % face.len()]) == edge)
        };
        (0..self.faces.len())
            .filter(|&f| has(&self.faces[f]))
            .collect()
    }

    fn centre(&self, face: usize) -> DVec3 {
        let face = &self.faces[face];
        face.iter()
            .fold(DVec3::ZERO, |sum, &v| sum + self.points[v])
            / face.len() as f64
    }

    fn vertex_by(&self, v: usize, corner: f64, edges: &[(usize, f64)]) -> DVec3 {
        let here = self.points[v];
        let sharp: Vec<_> = edges.iter().filter(|e| e.1 > 0.0).collect();
        if corner > 0.0 || sharp.len() > 2 {
            return here;
        }
        if let [a, b] = sharp[..] {
            return here * 0.75 + (self.points[a.0] + self.points[b.0]) * 0.125;
        }
        let n = edges.len() as f64;
        let faces: Vec<_> = (0..self.faces.len())
            .filter(|&f| self.faces[f].contains(&v))
            .collect();
        let q = faces.iter().fold(DVec3::ZERO, |s, &f| s + self.centre(f)) / n;
        let middle = |e: &(usize, f64)| (here + self.points[e.0]) / 2.0;
        let r = edges.iter().fold(DVec3::ZERO, |s, e| s + middle(e)) / n;
        q / n + r * 2.0 / n + here * (n - 3.0) / n
    }

    fn refined(&self) -> Self {
        let less = |s: f64| (s - 1.0).max(0.0);
        let mut points: Vec<DVec3> = (0..self.points.len())
            .map(|v| {
                let edges: Vec<(usize, f64)> = self
                    .creases
                    .iter()
                    .filter(|(e, _)| e.contains(&v))
                    .map(|(e, &s)| (e[0] + e[1] - v, s))
                    .collect();
                let after: Vec<_> = edges.iter().map(|&(e, s)| (e, less(s))).collect();
                let parent = self.vertex_by(v, self.corners[v], &edges);
                let child = self.vertex_by(v, less(self.corners[v]), &after);
                let mut ending: Vec<f64> = edges.iter().map(|e| e.1).collect();
                ending.push(self.corners[v]);
                ending.retain(|&s| s > 0.0 && s <= 1.0);
                if ending.is_empty() {
                    return parent;
                }
                let weight = ending.iter().fold(0.0, |a, b| a + b) / ending.len() as f64;
                parent * weight + child * (1.0 - weight)
            })
            .collect();
        let mut creases = BTreeMap::new();
        let mut of_edge = BTreeMap::new();
        for (&[a, b], &sharpness) in &self.creases {
            let crease = (self.points[a] + self.points[b]) / 2.0;
            let point = match self.faces_of([a, b])[..] {
                [f, g] => {
                    let smooth = crease / 2.0 + (self.centre(f) + self.centre(g)) / 4.0;
                    smooth.lerp(crease, sharpness.min(1.0))
                }
                _ => crease,
            };
            of_edge.insert([a, b], points.len());
            for end in [a, b] {
                creases.insert(key(end, points.len()), less(sharpness));
            }
            points.push(point);
        }
        let mut faces = Vec::new();
        for (f, face) in self.faces.iter().enumerate() {
            let centre = points.len();
            points.push(self.centre(f));
            for k in 0..face.len() {
                let n = face.len();
                let next = of_edge[&key(face[k], face[(k + 1) % n])];
                let last = of_edge[&key(face[(k + n - 1) % n], face[k])];
                creases.entry(key(next, centre)).or_insert(0.0);
                faces.push(vec![face[k], next, centre, last]);
            }
        }
        let mut corners: Vec<_> = self.corners.iter().map(|&s| less(s)).collect();
        corners.resize(points.len(), 0.0);
        Self {
            points,
            faces,
            creases,
            corners,
        }
    }
}

/// Compares one level after the other; distances count in units of the mesh.
pub(super) fn check(mesh: &Mesh, boundary: Boundary, up_to: u32) {
    let tolerance = 1e-13 * mesh.diagonal().max(1.0);
    let mut plain = Plain::of(mesh, boundary);
    for level in 1..=up_to {
        plain = plain.refined();
        let fine = run(
            mesh,
            Options {
                boundary,
                ..levels(level)
            },
        )
        .mesh;
        assert_eq!(fine.vertex_count(), plain.points.len());
        let distance = set_distance(fine.positions(), &plain.points);
        assert!(distance < tolerance, "level {level}: {distance}");
        let centres = |faces: &mut dyn Iterator<Item = Vec<usize>>, points: &[DVec3]| -> Vec<_> {
            faces
                .map(|f| f.iter().fold(DVec3::ZERO, |s, &v| s + points[v]) / 4.0)
                .collect()
        };
        let ours = fine
            .topology()
            .faces()
            .map(|f| f.iter().map(|&v| v as usize).collect());
        let ours = centres(&mut ours.into_iter(), fine.positions());
        let theirs = centres(&mut plain.faces.iter().cloned(), &plain.points);
        assert!(set_distance(&ours, &theirs) < tolerance);
    }
}

#[test]
fn smooth_and_mixed_meshes_agree_with_the_textbook() {
    for boundary in [Boundary::EdgeOnly, Boundary::EdgeAndCorner] {
        check(&cube(), boundary, 3);
        check(&mixed(), boundary, 3);
    }
}

#[test]
fn sharpness_of_every_kind_agrees_with_the_textbook() {
    let cases: [&[([u32; 2], f64)]; 5] = [
        &[([1, 3], 0.4)],
        &[([1, 3], 2.5), ([3, 7], 1.0)],
        &[([0, 1], 11.0), ([1, 3], 1.7), ([1, 5], 0.2)],
        &[([0, 1], 3.0), ([1, 3], 3.0), ([3, 2], 3.0), ([2, 0], 3.0)],
        &[([4, 5], 1.0), ([5, 7], 2.0), ([7, 6], 0.5), ([1, 5], 0.7)],
    ];
    for creases in cases {
        check(&with_creases(cube(), creases), Boundary::EdgeOnly, 3);
    }
    check(
        &with_corners(cube(), &[(0, 0.3), (3, 1.0), (7, 2.6), (4, 12.0)]),
        Boundary::EdgeOnly,
        3,
    );
    let mesh = with_creases(mixed(), &[([1, 2], 1.3), ([2, 4], 0.6), ([4, 3], 4.0)]);
    check(
        &with_corners(mesh, &[(4, 0.8), (8, 1.5)]),
        Boundary::EdgeOnly,
        3,
    );
}
