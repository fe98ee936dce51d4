//! Closest places of a surface.

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh;
use tessgraph_bench::{Arrays, Bench, shapes, shuffle};
use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::surface::Surface;
use tessgraph_geometry::{Mesh, Unmonitored};

/// How far points move between two questions, in edge lengths.
const REACH: f64 = 0.1;

fn vectors(points: Vec<[f64; 3]>) -> Vec<DVec3> {
    points.into_iter().map(DVec3::from).collect()
}

fn main() {
    let bench = Bench::new("Closest places; queries 1 to 10 edge lengths from the surface");
    for size in bench.sizes([177, 354, 707]) {
        let (positions, faces) = shapes::sheet(size, size);
        let triangles = shapes::triangles(&faces);
        let mesh = Mesh::from_faces(positions.clone(), &triangles).expect("a mesh");
        mesh.topology().adjacency();
        bench
            .case("tree of a surface", triangles.len(), "triangles")
            .ours(
                || (),
                |()| Surface::new(&mesh, &Unmonitored).expect("a surface"),
            )
            .run();
        let surface = Surface::new(&mesh, &Unmonitored).expect("a surface");
        let corners = positions.iter().map(|&place| Vector::from(place)).collect();
        let arrays = Arrays::new();
        arrays.floats("positions", &positions);
        arrays.indices("triangles", &triangles);
        let meshes = Meshes {
            surface: &surface,
            peer: TriMesh::new(corners, triangles.clone()).expect("a mesh"),
            arrays,
        };
        let twice = [positions.clone(), positions].concat();
        let mut points = shapes::scattered(&twice, 1.0, 10.0, 1);
        points.truncate(triangles.len());
        let ordered = vectors(points.clone());
        compare(&bench, "closest place, in mesh order", &meshes, &ordered);
        ask_again(&bench, &surface, &ordered);
        shuffle(&mut points, 2);
        let shuffled = vectors(points);
        compare(&bench, "closest place, shuffled", &meshes, &shuffled);
    }
}

/// The same surface for all.
struct Meshes<'a> {
    surface: &'a Surface,
    peer: TriMesh,
    arrays: Arrays,
}

fn compare(bench: &Bench, kernel: &str, meshes: &Meshes<'_>, points: &[DVec3]) {
    let Meshes {
        surface,
        peer,
        arrays,
    } = meshes;
    let places: Vec<[f64; 3]> = points.iter().map(|point| point.to_array()).collect();
    arrays.floats("points", &places);
    bench
        .case(kernel, points.len(), "queries")
        .ours(
            || (),
            |()| {
                surface
                    .closest_all(points, &Unmonitored)
                    .expect("nobody stops it")
            },
        )
        .peer("parry3d f64", || {
            let one =
                |point: &DVec3| peer.project_local_point(Vector::from(point.to_array()), true);
            points.iter().map(|point| one(point).point.x).sum::<f64>()
        })
        .outside("fcpw", "closest", arrays)
        .outside("libigl", "closest", arrays)
        .run();
}

/// The same queries, each point moved by up to a tenth of an edge length.
fn ask_again(bench: &Bench, surface: &Surface, points: &[DVec3]) {
    let places: Vec<[f64; 3]> = points.iter().map(|point| point.to_array()).collect();
    let moved = vectors(shapes::scattered(&places, 0.0, REACH, 3));
    let follow = || surface.follow(points, REACH, &Unmonitored);
    bench
        .case("closest place, to be asked again", points.len(), "queries")
        .ours(|| (), |()| follow().expect("nobody stops it"))
        .run();
    let followed = follow().expect("nobody stops it");
    bench
        .case(
            "closest place, again after a small move",
            moved.len(),
            "queries",
        )
        .ours(
            || (),
            |()| {
                followed
                    .closest(&moved, &Unmonitored)
                    .expect("nobody stops it")
            },
        )
        .run();
}
