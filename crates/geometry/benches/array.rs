//! Components arrayed over a base.

use tessgraph_bench::{Bench, limits, shapes};
use tessgraph_geometry::normals::{NormalWeights, vertex_normals};
use tessgraph_geometry::{
    ArrayOptions, DirectionSource, Directions, Interpolation, Join, Mesh, Unmonitored,
    array_components,
};

fn main() {
    let bench = Bench::new("Arrays of a component of 100 vertices and 100 faces");
    let (positions, faces) = shapes::ring(10);
    let component = Mesh::from_faces(positions, &faces).expect("a mesh");
    for size in bench.sizes([125, 250, 500]) {
        let (positions, faces) = shapes::sheet(size, size);
        let base = Mesh::from_faces(positions, &faces).expect("a mesh");
        let normals = vertex_normals(&base, NormalWeights::Angle, true, &Unmonitored);
        let normals = normals.expect("nobody stops it");
        let up = Directions::new(&base, normals, DirectionSource::Surface).expect("one each");
        let linear = ArrayOptions {
            interpolation: Interpolation::Linear,
            ..Default::default()
        };
        let weld = ArrayOptions {
            join: Join::Weld,
            ..Default::default()
        };
        for (kernel, options) in [
            ("ArrayComponents", ArrayOptions::default()),
            ("ArrayComponents, linear directions", linear),
            ("ArrayComponents, joined", weld),
        ] {
            let count = faces.len() * component.vertex_count();
            let per_face = faces.len() * component.face_count();
            // Positions; corners, offsets and two whole numbers a face.
            let bytes = 24 * count + per_face * (16 + 4 + 16);
            bench
                .case(kernel, count, "vertices")
                .ours(
                    || (),
                    |()| {
                        array_components(&base, &[&component], &up, &options, &Unmonitored)
                            .expect("a base of quads")
                    },
                )
                .limit("first touch of the result", limits::first_touch(bytes))
                .reused_limit("streaming write of it", limits::streaming_write(bytes))
                .run();
        }
    }
}
