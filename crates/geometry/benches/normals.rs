//! Vertex normals.

use tessgraph_bench::{Bench, limits, shapes};
use tessgraph_geometry::normals::{NormalWeights, vertex_normals};
use tessgraph_geometry::{Mesh, Unmonitored};

fn main() {
    let bench = Bench::new("Normals");
    for size in bench.sizes([255, 511, 999]) {
        let (positions, faces) = shapes::sheet(size, size);
        let mesh = Mesh::from_faces(positions, &faces).expect("a mesh");
        mesh.topology().adjacency();
        for (kernel, weights) in [
            ("vertex normals, by angle", NormalWeights::Angle),
            ("vertex normals, by area", NormalWeights::Area),
        ] {
            // Reads positions and corners, writes face and vertex normals.
            let moved = mesh.vertex_count() * (24 + 16 + 24 + 24);
            bench
                .case(kernel, mesh.vertex_count(), "vertices")
                .ours(
                    || (),
                    |()| {
                        vertex_normals(&mesh, weights, true, &Unmonitored).expect("nobody stops it")
                    },
                )
                .reused_limit("copying what is moved", limits::copy(moved / 2))
                .run();
        }
        let cold = || {
            let (positions, faces) = shapes::sheet(size, size);
            Mesh::from_faces(positions, &faces).expect("a mesh")
        };
        bench
            .case("adjacency", mesh.vertex_count(), "vertices")
            .ours(cold, |mesh| {
                mesh.topology()
                    .adjacency_with(&Unmonitored)
                    .expect("nobody stops it");
                mesh
            })
            .run();
    }
}
