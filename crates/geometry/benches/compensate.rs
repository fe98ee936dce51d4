//! Even thickness along slanted directions.

use tessgraph_bench::{Bench, shapes};
use tessgraph_geometry::compensate::{Compensate, CompensateOptions, compensate};
use tessgraph_geometry::diffuse::{DiffuseOptions, diffuse};
use tessgraph_geometry::normals::{NormalWeights, vertex_normals};
use tessgraph_geometry::{DirectionSource, Directions, Mesh, Unmonitored};

fn main() {
    let bench = Bench::new("Thickness compensation, both sides, 3 edge lengths");
    for size in bench.sizes([127, 255, 511]) {
        let (positions, faces) = shapes::sheet(size, size);
        let mesh = Mesh::from_faces(positions, &faces).expect("a mesh");
        let normals = vertex_normals(&mesh, NormalWeights::Angle, true, &Unmonitored);
        let normals = normals.expect("nobody stops it");
        let start = Directions::new(&mesh, normals, DirectionSource::Surface).expect("one each");
        let options = DiffuseOptions::default();
        let smooth = diffuse(&mesh, &start, &options, &Unmonitored).expect("valid settings");
        for (kernel, mode) in [
            ("CompensateThickness, local", Compensate::Local),
            ("CompensateThickness, global", Compensate::Global),
        ] {
            let options = CompensateOptions {
                mode,
                ..Default::default()
            };
            let thickness = 3.0.into();
            bench
                .case(kernel, mesh.vertex_count(), "vertices")
                .ours(
                    || (),
                    |()| {
                        let (out, inward) = (&thickness, &thickness);
                        compensate(&mesh, &smooth, out, inward, &options, &Unmonitored)
                            .expect("directions are on their side")
                    },
                )
                .run();
        }
    }
}
