//! Faces of a mesh that cross each other.

use tessgraph_bench::{Arrays, Bench, shapes};
use tessgraph_geometry::intersect::intersections;
use tessgraph_geometry::{Mesh, Unmonitored};

fn main() {
    let bench = Bench::new("Self-intersection");
    for size in bench.sizes([176, 353, 706]) {
        let (positions, faces) = shapes::sheet(size, size);
        let single = Mesh::from_faces(positions.clone(), &shapes::triangles(&faces));
        let single = single.expect("a mesh");
        // The sheet once more, leaning: it crosses the first along many lines.
        let half = size / 2;
        let (mut both, mut quads) = shapes::sheet(size, half);
        let (other, more) = shapes::sheet(size, half);
        let first = both.len() as u32;
        let lean = 0.03;
        both.extend(
            other
                .iter()
                .map(|&[x, y, z]| [x + 0.31, y + 0.17, z + lean * (y - f64::from(half) / 2.0)]),
        );
        quads.extend(more.iter().map(|quad| quad.map(|v| v + first)));
        let double = Mesh::from_faces(both, &shapes::triangles(&quads)).expect("a mesh");
        for (kernel, mesh) in [
            ("CheckIntersections, one sheet", &single),
            ("CheckIntersections, two sheets crossing", &double),
        ] {
            let places: Vec<[f64; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
            let corners = mesh.topology().corners();
            let arrays = Arrays::new();
            arrays
                .floats("positions", &places)
                .indices("triangles", corners.as_chunks::<3>().0);
            bench
                .case(kernel, mesh.face_count(), "triangles")
                .ours(
                    || (),
                    |()| intersections(mesh, &Default::default(), &Unmonitored).expect("finite"),
                )
                .outside("meshlib", "intersect", &arrays)
                .run();
        }
    }
}
