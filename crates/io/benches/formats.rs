//! Reading and writing files, in bytes of the file.

use tessgraph_bench::{Bench, limits, shapes};
use tessgraph_geometry::{Mesh, Unmonitored};
use tessgraph_io::{
    Format, ReadOptions, no_files, read, write_glb, write_obj, write_ply, write_stl,
};

/// Six decimals, as most programs write them.
fn rounded(place: [f64; 3]) -> [f64; 3] {
    place.map(|x| (x * 1e6).round() / 1e6)
}

fn written(format: Format, mesh: &Mesh) -> Vec<u8> {
    let monitor = &Unmonitored;
    match format {
        Format::Obj => write_obj(mesh, &Default::default(), monitor),
        Format::Stl => write_stl(mesh, &Default::default(), monitor),
        Format::Ply => write_ply(mesh, &Default::default(), monitor),
        _ => write_glb(mesh, &Default::default(), monitor),
    }
    .expect("a mesh of finite places")
    .bytes
}

fn parse(format: Format, bytes: &[u8]) -> Mesh {
    let options = ReadOptions::default();
    read(
        format,
        "bench",
        bytes,
        &mut no_files,
        &options,
        &Unmonitored,
    )
    .expect("it was written by us")
    .mesh
}

/// What binary STL holds, in the form that stl_io writes.
fn facets(mesh: &Mesh) -> Vec<stl_io::Triangle> {
    let place = |v: u32| {
        let p = mesh.positions()[v as usize];
        stl_io::Vector::new(p.to_array().map(|x| x as f32))
    };
    let facet = |face: &[u32]| stl_io::Triangle {
        normal: stl_io::Vector::new([0.0, 0.0, 1.0]),
        vertices: [place(face[0]), place(face[1]), place(face[2])],
    };
    mesh.topology().faces().map(facet).collect()
}

fn main() {
    let bench = Bench::new("Files of triangles; elements are bytes of the file");
    for size in bench.sizes([177, 354, 707]) {
        let (positions, faces) = shapes::sheet(size, size);
        let positions = positions
            .into_iter()
            .map(|[x, y, z]| rounded([x * 0.013, y * 0.017, z * 0.05]));
        let mesh = Mesh::from_faces(positions.collect(), &shapes::triangles(&faces));
        let mesh = mesh.expect("a mesh");
        let facets = facets(&mesh);
        for format in [Format::Obj, Format::Stl, Format::Ply, Format::Glb] {
            let bytes = written(format, &mesh);
            let (read, write) = (format!("read {format}"), format!("write {format}"));
            let mut case = bench
                .case(&read, bytes.len(), "bytes")
                .in_bytes()
                .ours(|| (), |()| parse(format, &bytes));
            case = match format {
                Format::Obj => case
                    .peer("tobj", || {
                        let options = tobj::LoadOptions::default();
                        tobj::load_obj_buf(&mut bytes.as_slice(), &options, |_| {
                            Err(tobj::LoadError::OpenFileFailed)
                        })
                    })
                    .limit("finding newlines", || {
                        memchr::memchr_iter(b'\n', &bytes).count()
                    }),
                Format::Stl => case
                    .peer("stl_io", || {
                        let mut cursor = std::io::Cursor::new(&bytes);
                        stl_io::read_stl(&mut cursor)
                    })
                    .limit("copying", limits::copy(bytes.len())),
                _ => case.limit("copying", limits::copy(bytes.len())),
            };
            case.run();
            let mut case = bench
                .case(&write, bytes.len(), "bytes")
                .in_bytes()
                .ours(|| (), |()| written(format, &mesh));
            if format == Format::Stl {
                case = case.peer("stl_io", || {
                    let mut out = std::io::Cursor::new(Vec::new());
                    stl_io::write_stl(&mut out, facets.iter()).map(|()| out)
                });
            }
            case.limit("first touch of the file", limits::first_touch(bytes.len()))
                .run();
        }
    }
}
