//! Bytes per second of reading and writing, on one thread.
//!
//! `cargo bench -p tessgraph-io [-- NAME]`. The mesh is a wavy grid of
//! 1 000 000 triangles; the best of several runs counts, in processor time
//! where the system tells it. tobj reads the same OBJ bytes for comparison.
#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

use std::hint::black_box;
use std::time::Instant;

use tessgraph_geometry::{Mesh, Unmonitored};
use tessgraph_io::{
    Format, ReadOptions, no_files, read, write_glb, write_obj, write_ply, write_stl,
};

/// Best of `RUNS` runs.
const RUNS: usize = 7;

fn grid(size: u32, sides: usize) -> Mesh {
    let place = |i: u32, j: u32| {
        let (x, y) = (f64::from(i) * 0.013, f64::from(j) * 0.017);
        // Six decimals, as most programs write them.
        let z = ((x * y).fract() * 1e6).round() / 1e6;
        [(x * 1e6).round() / 1e6, (y * 1e6).round() / 1e6, z]
    };
    let rows = (0..=size)
        .flat_map(|i| (0..=size).map(move |j| place(i, j)))
        .collect();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for i in 0..size {
        for j in 0..size {
            let at = |di: u32, dj: u32| (i + di) * (size + 1) + j + dj;
            let quad = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
            if sides == 4 {
                faces.push(quad.to_vec());
            } else {
                faces.push(vec![quad[0], quad[1], quad[2]]);
                faces.push(vec![quad[0], quad[2], quad[3]]);
            }
        }
    }
    Mesh::from_faces(rows, &faces).expect("a grid is a mesh")
}

/// Seconds this thread has run on a processor: other programs do not count.
#[expect(clippy::disallowed_methods, reason = "a benchmark is no node")]
fn processor_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split(' ').next()?.parse::<f64>().ok()? * 1e-9)
}

fn measure<T>(what: &str, bytes: usize, mut run: impl FnMut() -> T) {
    if std::env::args()
        .skip(1)
        .any(|name| !name.starts_with('-') && !what.contains(&name))
    {
        return;
    }
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        let (start, before) = (Instant::now(), processor_seconds());
        black_box(run());
        let seconds = match (before, processor_seconds()) {
            (Some(before), Some(after)) => after - before,
            _ => start.elapsed().as_secs_f64(),
        };
        best = best.min(seconds);
    }
    let rate = bytes as f64 / best / 1e6;
    println!(
        "{what:<22} {:>7.1} MB  {:>8.1} ms  {rate:>7.0} MB/s",
        bytes as f64 / 1e6,
        best * 1e3
    );
}

fn measure_read(format: Format, bytes: &[u8]) {
    let options = ReadOptions::default();
    measure(&format!("read {format}"), bytes.len(), || {
        read(
            format,
            "bench",
            bytes,
            &mut no_files,
            &options,
            &Unmonitored,
        )
        .expect("it was written by us")
    });
}

fn main() {
    let mesh = grid(707, 3);
    let monitor = &Unmonitored;
    let obj = write_obj(&mesh, &Default::default(), monitor)
        .expect("OBJ")
        .bytes;
    let stl = write_stl(&mesh, &Default::default(), monitor)
        .expect("STL")
        .bytes;
    let ply = write_ply(&mesh, &Default::default(), monitor)
        .expect("PLY")
        .bytes;
    let glb = write_glb(&mesh, &Default::default(), monitor)
        .expect("GLB")
        .bytes;
    println!("{} triangles", mesh.face_count());
    measure_read(Format::Obj, &obj);
    measure("read OBJ (tobj)", obj.len(), || {
        let options = tobj::LoadOptions::default();
        tobj::load_obj_buf(&mut obj.as_slice(), &options, |_| {
            Err(tobj::LoadError::OpenFileFailed)
        })
    });
    measure_read(Format::Stl, &stl);
    measure_read(Format::Ply, &ply);
    measure_read(Format::Glb, &glb);
    measure("write OBJ", obj.len(), || {
        write_obj(&mesh, &Default::default(), monitor)
    });
    measure("write STL", stl.len(), || {
        write_stl(&mesh, &Default::default(), monitor)
    });
    measure("write PLY", ply.len(), || {
        write_ply(&mesh, &Default::default(), monitor)
    });
    measure("write GLB", glb.len(), || {
        write_glb(&mesh, &Default::default(), monitor)
    });
}
