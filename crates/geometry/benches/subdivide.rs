//! Catmull-Clark subdivision, adjacency of the coarse mesh included.

use tessgraph_bench::{Arrays, Bench, limits, shapes};
use tessgraph_geometry::subdivide::{Options, subdivide};
use tessgraph_geometry::{Mesh, Unmonitored};

fn main() {
    let bench = Bench::new("Subdivision");
    let inputs = [
        ("Catmull-Clark, grid", shapes::sheet(64, 64)),
        (
            "Catmull-Clark, irregular torus",
            shapes::irregular_torus(64),
        ),
    ];
    for (kernel, (positions, faces)) in inputs {
        let arrays = Arrays::new();
        arrays
            .floats("positions", &positions)
            .indices("quads", &faces);
        for levels in bench.sizes([3, 4, 5]) {
            let count = faces.len() << (2 * levels);
            arrays.indices("levels", &[[levels]]);
            let options = Options {
                levels,
                ..Default::default()
            };
            // Positions, corners, face offsets, the parent of each face.
            let bytes = count * (24 + 16 + 4 + 8);
            bench
                .case(kernel, count, "faces")
                .ours(
                    || Mesh::from_faces(positions.clone(), &faces).expect("a mesh"),
                    |mesh| subdivide(&mesh, options, &Unmonitored).expect("it is manifold"),
                )
                .outside("opensubdiv", "subdivide", &arrays)
                .limit("first touch of the result", limits::first_touch(bytes))
                .reused_limit("streaming write of it", limits::streaming_write(bytes))
                .run();
        }
    }
}
