//! Joining vertices at the same place, and near each other.

use tessgraph_bench::{Arrays, Bench, random, shapes};
use tessgraph_geometry::{Mesh, Unmonitored, weld_vertices};

fn main() {
    let bench = Bench::new("Welding a soup of quads");
    for size in bench.sizes([400, 800, 1580]) {
        let (positions, faces) = shapes::sheet(size, size);
        let apart = |jitter: f64| {
            let corners = faces.as_flattened().iter().zip(0..);
            let moved = corners.map(|(&v, corner): (&u32, u64)| {
                let shift = |k| jitter * (random(k, corner) - 0.5);
                let [x, y, z] = positions[v as usize];
                [x + shift(1), y + shift(2), z + shift(3)]
            });
            let quads: Vec<[u32; 4]> = (0..faces.len() as u32)
                .map(|face| std::array::from_fn(|k| 4 * face + k as u32))
                .collect();
            Mesh::from_faces(moved.collect(), &quads).expect("a mesh")
        };
        let exact = apart(0.0);
        let count = exact.vertex_count();
        let indices: Vec<u32> = exact.topology().corners().to_vec();
        // meshoptimizer compares the bytes of vertices; f32 as it is used to.
        let small: Vec<[f32; 3]> = exact
            .positions()
            .iter()
            .map(|p| p.to_array().map(|x| x as f32))
            .collect();
        let places = |mesh: &Mesh| -> Vec<[f64; 3]> {
            mesh.positions()
                .iter()
                .map(|place| place.to_array())
                .collect()
        };
        let arrays = Arrays::new();
        arrays.floats("points", &places(&exact));
        bench
            .case("weld, exact", count, "vertices")
            .ours(
                || (),
                |()| weld_vertices(&exact, 0.0, &Unmonitored).expect("a distance"),
            )
            .peer("meshoptimizer f32", || {
                meshopt::generate_vertex_remap(&small, Some(&indices))
            })
            .outside("trimesh", "weld", &arrays)
            .run();
        let near = apart(1e-3);
        arrays
            .floats("points", &places(&near))
            .floats("distance", &[[2e-3]]);
        bench
            .case("weld, by distance", count, "vertices")
            .ours(
                || (),
                |()| weld_vertices(&near, 2e-3, &Unmonitored).expect("a distance"),
            )
            .outside("scipy", "weld_near", &arrays)
            .run();
    }
}
