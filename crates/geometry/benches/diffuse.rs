//! Smooth normals: diffusion of a direction field.

use tessgraph_bench::{Arrays, Bench, limits, shapes};
use tessgraph_geometry::diffuse::{DiffuseOptions, Laplacian, Scheme, diffuse};
use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::normals::{NormalWeights, vertex_normals};
use tessgraph_geometry::{DirectionSource, Directions, Mesh, Unmonitored};

const PASSES: u32 = 50;

fn mean(laplacian: Laplacian) -> Scheme {
    Scheme::Mean {
        iterations: PASSES,
        diffusion: 0.5,
        laplacian,
    }
}

fn main() {
    let bench = Bench::new("Diffusion, 50 passes; per vertex and pass");
    let schemes = [
        ("SmoothNormals, mean", mean(Laplacian::Uniform)),
        ("SmoothNormals, cotangent", mean(Laplacian::Cotangent)),
        (
            "SmoothNormals, edge sum",
            Scheme::EdgeSum {
                iterations: PASSES,
                step: 0.2,
                flip_inverted: false,
            },
        ),
    ];
    for size in bench.sizes([255, 511, 999]) {
        let (positions, faces) = shapes::sheet(size, size);
        let mesh = Mesh::from_faces(positions, &faces).expect("a mesh");
        let normals = vertex_normals(&mesh, NormalWeights::Angle, true, &Unmonitored);
        let normals: Vec<DVec3> = normals.expect("nobody stops it");
        let start = Directions::new(&mesh, normals, DirectionSource::Surface).expect("one each");
        let field: Vec<[f64; 3]> = start.outward().iter().map(|d| d.to_array()).collect();
        let adjacency = mesh.topology().adjacency();
        let edges: Vec<[u32; 2]> = (0..adjacency.edge_count())
            .map(|edge| adjacency.edge(edge))
            .collect();
        let arrays = Arrays::new();
        arrays.floats("directions", &field).indices("edges", &edges);
        for (kernel, scheme) in schemes {
            let options = DiffuseOptions {
                scheme,
                ..Default::default()
            };
            let count = mesh.vertex_count() * PASSES as usize;
            let mut pass = limits::copy(mesh.vertex_count() * 24);
            let mut case = bench.case(kernel, count, "vertices x passes").ours(
                || (),
                |()| diffuse(&mesh, &start, &options, &Unmonitored).expect("valid settings"),
            );
            if kernel == "SmoothNormals, mean" {
                case = case.outside("scipy", "diffuse", &arrays);
            }
            case.reused_limit("copying the field each pass", move || {
                (0..PASSES).for_each(|_| pass());
            })
            .run();
        }
    }
}
