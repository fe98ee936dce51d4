use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::Unmonitored;

fn mesh(positions: &[DVec3], faces: &[[u32; 3]]) -> Mesh {
    let positions = positions.iter().map(|p| p.to_array()).collect();
    Mesh::from_faces(positions, faces).unwrap()
}

fn surface(mesh: &Mesh) -> Surface {
    Surface::new(mesh, &Unmonitored).unwrap()
}

/// Numbers in -1..1 from a fixed sequence.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

/// Small triangles all over the cube, some of them slivers, points or doubled.
fn soup(count: usize, seed: u64) -> Mesh {
    let mut noise = Noise(seed);
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for k in 0..count {
        let at = noise.point();
        let size = if k % 13 == 0 { 1.0 } else { 0.1 };
        let corners = match k % 11 {
            7 => [at, at, at],
            8 => [at, at + DVec3::X * 0.2, at + DVec3::X * 0.1],
            9 if k > 1 => [positions[0], positions[1], positions[2]],
            _ => [at, at + noise.point() * size, at + noise.point() * size],
        };
        let first = positions.len() as u32;
        positions.extend(corners);
        faces.push([first, first + 1, first + 2]);
    }
    mesh(&positions, &faces)
}

/// Every leaf visited, no boxes: what the tree must agree with exactly.
fn brute_force(surface: &Surface, p: DVec3) -> (f64, u32) {
    let mut best = (f64::INFINITY, u32::MAX);
    for leaf in &surface.leaves {
        for (&squared, &triangle) in leaf.squared_distances(p).iter().zip(&leaf.triangles) {
            if (squared, triangle) < best {
                best = (squared, triangle);
            }
        }
    }
    (best.0.sqrt(), best.1)
}

#[test]
fn agrees_with_brute_force_exactly() {
    for count in [1, 3, 4, 5, 17, 400, 3000] {
        let surface = surface(&soup(count, count as u64));
        let mut noise = Noise(7);
        let points: Vec<_> = (0..200).map(|_| noise.point() * 1.5).collect();
        let all = surface.closest_all(&points, &Unmonitored).unwrap();
        for (&point, found) in points.iter().zip(&all) {
            assert_eq!(
                (found.distance, found.triangle),
                brute_force(&surface, point)
            );
            assert_eq!(
                *found,
                Closest {
                    leaf: found.leaf,
                    ..surface.closest(point)
                }
            );
            let reach = found.distance;
            assert!(surface.closest_within(point, reach * 1.0001).is_some());
            assert!(surface.closest_within(point, reach * 0.9999).is_none());
        }
    }
}

#[test]
fn lanes_agree_with_the_scalar_triangle() {
    let surface = surface(&soup(500, 3));
    let mut noise = Noise(9);
    for _ in 0..50 {
        let point = noise.point();
        for leaf in &surface.leaves {
            for (squared, &k) in leaf.squared_distances(point).iter().zip(&leaf.triangles) {
                let foot = surface.triangle(k).closest(point);
                assert!(((foot.point - point).length() - squared.sqrt()).abs() < 1e-14);
                let weights = foot.barycentric;
                let [a, b, c] = surface.triangle(k).0;
                let place = a * weights.x + b * weights.y + c * weights.z;
                assert!((place - foot.point).length() < 1e-12);
                assert!(weights.min_element() >= 0.0);
            }
        }
    }
}

#[test]
fn every_triangle_is_in_one_leaf_and_depth_is_bounded() {
    // Centres in a geometric series are the worst case for even bins.
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    let mut size = 1.0;
    for k in 0..900u32 {
        let at = DVec3::X * size;
        positions.extend([at, at + DVec3::Y * size, at + DVec3::Z * size]);
        faces.push([3 * k, 3 * k + 1, 3 * k + 2]);
        size *= 0.7;
    }
    let surface = surface(&mesh(&positions, &faces));
    let mut seen = vec![0; 900];
    for leaf in &surface.leaves {
        let mut own = leaf.triangles.to_vec();
        own.dedup();
        own.iter().for_each(|&k| seen[k as usize] += 1);
    }
    assert!(seen.iter().all(|&times| times == 1));
    let found = surface.closest(DVec3::X * 2.0);
    assert_eq!((found.triangle, found.distance), (0, 1.0));
}

#[test]
fn features_of_a_quad() {
    let quad = Mesh::from_faces(
        vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
        &[[0, 1, 2, 3]],
    )
    .unwrap();
    let surface = surface(&quad);
    let feature = |x, y| surface.closest(DVec3::new(x, y, 0.5)).feature;
    assert_eq!(feature(0.5, 0.5), Feature::Face);
    assert_eq!(feature(0.5, -1.0), Feature::Edge(0));
    assert_eq!(feature(-1.0, 0.5), Feature::Edge(3));
    assert_eq!(feature(2.0, 3.0), Feature::Vertex(2));
    assert!(surface.is_border(Feature::Edge(0)) && surface.is_border(Feature::Vertex(2)));
    assert!(!surface.is_border(Feature::Face));
}

#[test]
fn rays_agree_with_brute_force() {
    let surface = surface(&soup(2000, 5));
    let mut noise = Noise(11);
    let mut hits = 0;
    for k in 0..300 {
        let facing = [Facing::Any, Facing::Front, Facing::Back][k % 3];
        let (origin, direction) = (noise.point() * 2.0, noise.point());
        let found = surface.first_hit(origin, direction, 0.1, 5.0, facing);
        let expected = (0..surface.triangle_count() as u32)
            .filter_map(|k| {
                let triangle = surface.triangle(k);
                let (normal, _) = triangle.plane()?;
                let slope = normal.dot(direction);
                let counts = match facing {
                    Facing::Any => true,
                    Facing::Front => slope < 0.0,
                    Facing::Back => slope > 0.0,
                };
                let at = (triangle.0[0] - origin).dot(normal) / slope;
                let place = origin + direction * at;
                let inside = (triangle.closest(place).point - place).length() < 1e-12;
                (counts && (0.1..=5.0).contains(&at) && inside).then_some((at, k))
            })
            .min_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(found.map(|hit| hit.triangle), expected.map(|hit| hit.1));
        if let (Some(found), Some(expected)) = (found, expected) {
            hits += 1;
            assert!((found.at - expected.0).abs() < 1e-12);
        }
    }
    assert!(hits > 20, "{hits}");
}

#[test]
fn rays_through_edges_and_vertices_hit() {
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    for y in 0..9u32 {
        for x in 0..9u32 {
            positions.push(DVec3::new(f64::from(x) * 0.1, f64::from(y) * 0.3, 0.0));
            if x < 8 && y < 8 {
                let v = y * 9 + x;
                faces.extend([[v, v + 1, v + 10], [v, v + 10, v + 9]]);
            }
        }
    }
    let surface = surface(&mesh(&positions, &faces));
    for from in &positions {
        let hit = surface.first_hit(*from + DVec3::Z, -DVec3::Z, 0.0, 2.0, Facing::Front);
        assert_eq!(hit.map(|hit| hit.at), Some(1.0));
        assert!(
            surface
                .first_hit(*from + DVec3::Z, -DVec3::Z, 0.0, 2.0, Facing::Back)
                .is_none()
        );
    }
}

/// An L-shaped plate of three unit squares, the notch at (1..2, 1..2).
fn plate() -> Surface {
    let mut positions = Vec::new();
    for y in 0..3 {
        for x in 0..3 {
            positions.push([f64::from(x), f64::from(y), 0.0]);
        }
    }
    let faces = [[0u32, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6]];
    surface(&Mesh::from_faces(positions, &faces).unwrap())
}

#[test]
fn the_extension_of_a_flat_plate_is_its_plane() {
    let plate = plate();
    let at = |x, y| plate.distance(DVec3::new(x, y, 0.25), Border::Extend);
    for (x, y, rim) in [(0.5, 0.5, false), (0.5, -2.0, true), (3.0, 0.5, true)] {
        assert_eq!(at(x, y), (0.25, rim));
    }
    // Beyond the convex corners strips leave a gap, which the sector fills.
    assert_eq!(at(-1.0, -2.0), (0.25, true));
    assert_eq!(at(3.0, -0.5), (0.25, true));
    // In the notch the strips overlap.
    assert_eq!(at(1.5, 1.5), (0.25, true));
    let clipped = plate.distance(DVec3::new(-3.0, -4.0, 0.0), Border::Clip);
    assert_eq!(clipped, (5.0, true));
}

#[test]
fn coordinates_too_large_to_square_are_refused() {
    let huge = mesh(&[DVec3::ZERO, DVec3::X * 1e200, DVec3::Y], &[[0, 1, 2]]);
    let refused = Surface::new(&huge, &Unmonitored);
    assert!(matches!(refused, Err(GeometryError::OutOfRange { .. })));
}

#[test]
fn a_mesh_without_faces_is_no_surface() {
    let empty = Mesh::from_faces(vec![[0.0; 3]], &[] as &[[u32; 3]]).unwrap();
    assert!(matches!(
        Surface::new(&empty, &Unmonitored),
        Err(GeometryError::Empty { .. })
    ));
}

proptest! {
    #[test]
    fn distance_follows_scale_and_shift(
        seed in 0u64..1000, scale in 0.01..100.0f64, x in -9.0..9.0f64,
    ) {
        let mesh = soup(60, seed);
        let shift = DVec3::new(x, -x, 2.0 * x);
        let moved = mesh.positions().iter().map(|&p| p * scale + shift).collect();
        let moved = surface(&mesh.with_positions(moved).unwrap());
        let here = surface(&mesh);
        let point = Noise(seed).point() * 2.0;
        let distance = moved.closest(point * scale + shift).distance;
        prop_assert!((distance - here.closest(point).distance * scale).abs() < 1e-12 * (scale + 30.0));
    }

    #[test]
    fn distance_changes_no_faster_than_the_point_moves(seed in 0u64..1000, step in 0.0..0.5f64) {
        let surface = surface(&soup(100, seed));
        let mut noise = Noise(seed + 1);
        let (a, b) = (noise.point(), noise.point() * step);
        let difference = surface.closest(a).distance - surface.closest(a + b).distance;
        prop_assert!(difference.abs() <= b.length() + 1e-12);
    }
}

#[test]
fn searches_from_anywhere_agree() {
    let sheet = crate::test_shapes::grid(40, 40, |x, y| [9.0 * x, 9.0 * y, x * x - 3.0 * y * x]);
    for mesh in [sheet, soup(900, 4)] {
        let surface = surface(&mesh);
        let mut noise = Noise(11);
        let points: Vec<_> = (0..500).map(|_| noise.point() * 6.0).collect();
        let all = surface.closest_all(&points, &Unmonitored).unwrap();
        for (&point, found) in points.iter().zip(all) {
            assert_eq!(found, surface.closest(point));
            assert_eq!(
                (found.distance, found.triangle),
                brute_force(&surface, point)
            );
        }
    }
}

/// Points that stay, go as far as was said, and farther, up to where no list of
/// theirs holds; and lists cut short, of points with very many triangles about.
#[test]
fn followed_points_are_found_however_far_they_go() {
    let sheet = crate::test_shapes::grid(40, 40, |x, y| [9.0 * x, 9.0 * y, x * x - 3.0 * y * x]);
    let sphere = crate::test_shapes::sphere(40, 24);
    for mesh in [sheet, soup(900, 4), sphere] {
        let surface = surface(&mesh);
        let mut noise = Noise(11);
        // The first is as far from all of a sphere.
        let points = (0..400).map(|k| noise.point() * if k == 0 { 0.0 } else { 6.0 });
        let points: Vec<_> = points.collect();
        for reach in [0.0, 0.1, 3.0] {
            let followed = surface.follow(&points, reach, &Unmonitored).unwrap();
            let all = surface.closest_all(&points, &Unmonitored).unwrap();
            assert_eq!(followed.places(), all);
            for step in [0.0, 0.05, 0.2, 4.0] {
                let moved: Vec<_> = points.iter().map(|&p| p + noise.point() * step).collect();
                let found = followed.closest(&moved, &Unmonitored).unwrap();
                assert_eq!(found, surface.closest_all(&moved, &Unmonitored).unwrap());
            }
        }
    }
}

/// A million questions, each answered by looking at everything.
#[test]
#[ignore = "takes a quarter of a minute; run with --release"]
fn a_million_queries_agree_with_brute_force() {
    let fold = |x: f64, y: f64| [9.0 * x, 9.0 * y, (x * 4.0).fract().min(0.7) * y];
    let meshes = [
        crate::test_shapes::grid(31, 31, fold),
        crate::test_shapes::sphere(40, 24),
        crate::test_shapes::cylinder(60, 12),
        soup(2000, 21),
    ];
    let mut noise = Noise(23);
    for mesh in meshes {
        let surface = surface(&mesh);
        assert!(surface.triangle_count() <= 2000);
        // Every third on a lattice, where many triangles are equally close.
        let points: Vec<_> = (0..250_000)
            .map(|k| {
                let point = noise.point() * 3.0;
                if k % 3 == 0 {
                    (point * 8.0).round() / 8.0
                } else {
                    point
                }
            })
            .collect();
        let all = surface.closest_all(&points, &Unmonitored).unwrap();
        let followed = surface.follow(&points, 0.1, &Unmonitored).unwrap();
        let again = followed.closest(&points, &Unmonitored).unwrap();
        assert_eq!(all, again);
        let nearby = |&point: &DVec3| point + noise.point() * 0.15;
        let moved: Vec<_> = points.iter().map(nearby).collect();
        let again = followed.closest(&moved, &Unmonitored).unwrap();
        assert_eq!(again, surface.closest_all(&moved, &Unmonitored).unwrap());
        let wrong = |(&point, found): (&DVec3, &Closest)| {
            (found.distance, found.triangle) != brute_force(&surface, point)
        };
        assert_eq!(
            points.iter().zip(&all).filter(|&pair| wrong(pair)).count(),
            0
        );
    }
}
