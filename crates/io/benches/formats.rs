//! Reading and writing files, in bytes of the file.

use std::fs::File;
use std::io::Write;

use tempfile::TempDir;
use tessgraph_bench::{Arrays, Bench, limits, shapes};
use tessgraph_geometry::{Mesh, Unmonitored};
use tessgraph_io::{
    Format, ReadOptions, no_files, read, write_glb_to, write_obj_to, write_ply_to, write_stl_to,
};

/// Six decimals, as most programs write them.
fn rounded(place: [f64; 3]) -> [f64; 3] {
    place.map(|x| (x * 1e6).round() / 1e6)
}

fn write_to(format: Format, mesh: &Mesh, sink: &mut dyn Write) {
    let monitor = &Unmonitored;
    match format {
        Format::Obj => write_obj_to(sink, mesh, &Default::default(), monitor),
        Format::Stl => write_stl_to(sink, mesh, &Default::default(), monitor),
        Format::Ply => write_ply_to(sink, mesh, &Default::default(), monitor),
        _ => write_glb_to(sink, mesh, &Default::default(), monitor),
    }
    .expect("a mesh of finite places, and room for it");
}

fn written(format: Format, mesh: &Mesh) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_to(format, mesh, &mut bytes);
    bytes
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

/// A new file, so that no old content is in the way.
fn sink(folder: &TempDir) -> File {
    let path = folder.path().join("written");
    let _ = std::fs::remove_file(&path);
    File::create(path).expect("a file")
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
    let folder = tempfile::tempdir().expect("a folder");
    for size in bench.sizes([177, 354, 707]) {
        let (positions, faces) = shapes::sheet(size, size);
        let positions: Vec<[f64; 3]> = positions
            .into_iter()
            .map(|[x, y, z]| rounded([x * 0.013, y * 0.017, z * 0.05]))
            .collect();
        let faces = shapes::triangles(&faces);
        let arrays = Arrays::new();
        arrays
            .floats("positions", &positions)
            .indices("triangles", &faces);
        let mesh = Mesh::from_faces(positions, &faces).expect("a mesh");
        for format in [Format::Obj, Format::Stl, Format::Ply, Format::Glb] {
            let bytes = written(format, &mesh);
            let kind = format!("{format}").to_lowercase();
            arrays.file(&format!("file.{kind}"), &bytes);
            reading(&bench, format, &kind, &bytes, &arrays);
            writing(&bench, format, &kind, &mesh, &arrays, &folder);
        }
    }
}

fn reading(bench: &Bench, format: Format, kind: &str, bytes: &[u8], arrays: &Arrays) {
    let work = format!("read_{kind}");
    let mut case = bench
        .case(&format!("read {format}"), bytes.len(), "bytes")
        .in_bytes()
        .ours(|| (), |()| parse(format, bytes));
    case = match format {
        Format::Obj => case
            .peer("tobj", || {
                let options = tobj::LoadOptions::default();
                tobj::load_obj_buf(&mut &*bytes, &options, |_| {
                    Err(tobj::LoadError::OpenFileFailed)
                })
            })
            .reused_limit("finding newlines", || {
                memchr::memchr_iter(b'\n', bytes).count()
            }),
        Format::Stl => case
            .peer("stl_io", || {
                let mut cursor = std::io::Cursor::new(bytes);
                stl_io::read_stl(&mut cursor)
            })
            .reused_limit("copying", limits::copy(bytes.len())),
        _ => case.reused_limit("copying", limits::copy(bytes.len())),
    };
    if format != Format::Glb {
        case = case.outside("meshlib", &work, arrays);
    }
    case.outside("trimesh", &work, arrays).run();
}

fn writing(
    bench: &Bench,
    format: Format,
    kind: &str,
    mesh: &Mesh,
    arrays: &Arrays,
    folder: &TempDir,
) {
    let (bytes, work) = (written(format, mesh), format!("write_{kind}"));
    let facets = facets(mesh);
    let mut case = bench
        .case(&format!("write {format}"), bytes.len(), "bytes")
        .in_bytes()
        .ours(
            || sink(folder),
            |mut file| write_to(format, mesh, &mut file),
        )
        .outside("trimesh", &work, arrays);
    if format != Format::Glb {
        case = case.outside("meshlib", &work, arrays);
    }
    if format == Format::Stl {
        case = case.peer("stl_io", || {
            let mut out = std::io::BufWriter::new(sink(folder));
            stl_io::write_stl(&mut out, facets.iter())
        });
    }
    case.reused_limit("write() of the file", || sink(folder).write_all(&bytes))
        .run();
}
