//! Closest places of a surface.

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh;
use tessgraph_bench::{Bench, shapes, shuffle};
use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::surface::Surface;
use tessgraph_geometry::{Mesh, Unmonitored};

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
        let twice = [positions.clone(), positions.clone()].concat();
        let mut points = shapes::scattered(&twice, 1.0, 10.0, 1);
        points.truncate(2 * size as usize * size as usize);
        let ordered = vectors(points.clone());
        shuffle(&mut points, 2);
        let shuffled = vectors(points);
        let corners: Vec<Vector> = positions.iter().map(|&p| Vector::from(p)).collect();
        let peer = TriMesh::new(corners, triangles.clone()).expect("a mesh");
        for (kernel, points) in [
            ("closest place, in mesh order", &ordered),
            ("closest place, shuffled", &shuffled),
        ] {
            let peer = &peer;
            let ask = move || {
                let mut sum = 0.0;
                for &point in points.iter() {
                    let place = peer.project_local_point(Vector::from(point.to_array()), true);
                    sum += place.point.x;
                }
                sum
            };
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
                .peer("parry3d f64", ask)
                .run();
        }
    }
}
