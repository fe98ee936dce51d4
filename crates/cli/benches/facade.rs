//! Whole facades, from a graph file to a GLB file, by the program itself.

use std::path::Path;
use std::process::{Command, Stdio};

use tessgraph_bench::{Bench, shapes};

/// A graph that brings `ring.obj` onto `base.obj`.
fn graph(nodes: &str, directions: &str, array: &str) -> String {
    format!(
        r#"Graph(version: 1, units: M, nodes: {{
    "base": ReadMesh(path: "base.obj"),
    "ring": ReadMesh(path: "ring.obj"),
    "normals": VertexNormals(mesh: "base"),
    {nodes}
    "facade": ArrayComponents(base: "base", component: "ring", directions: "{directions}"{array}),
}}, outputs: {{ "out/facade.glb": "facade" }})
"#
    )
}

/// Writes the files of all cases at one size.
fn write_inputs(folder: &Path, size: u32) -> std::io::Result<()> {
    let smooth = r#""smooth": SmoothNormals(mesh: "base", iterations: 50),"#;
    let even = r#""smooth": SmoothNormals(mesh: "base", iterations: 10),
    "even": CompensateThickness(mesh: "base", directions: "smooth", thickness: 0.25),"#;
    std::fs::write(
        folder.join("base.obj"),
        shapes::obj(&shapes::sheet(size, size)),
    )?;
    std::fs::write(folder.join("ring.obj"), shapes::obj(&shapes::ring(10)))?;
    let graphs = [
        ("plain", graph("", "normals", "")),
        ("smooth", graph(smooth, "smooth", "")),
        ("even", graph(even, "even", "")),
        ("joined", graph("", "normals", ", join: Weld")),
    ];
    for (name, text) in graphs {
        std::fs::write(folder.join(name).with_extension("ron"), text)?;
    }
    Ok(())
}

fn main() -> std::io::Result<()> {
    let bench = Bench::new("Whole facades, a component of 100 vertices and 100 faces");
    let folder = tempfile::tempdir()?;
    let kernels = [
        ("facade to GLB", "plain"),
        ("facade, 50 smoothing passes", "smooth"),
        ("facade, even thickness", "even"),
        ("facade, neighbours joined", "joined"),
    ];
    for size in bench.sizes([128u32, 256, 512]) {
        write_inputs(folder.path(), size)?;
        for (kernel, name) in kernels {
            let vertices = (100 * size * size) as usize;
            let command = |threads: usize| {
                let mut command = Command::new(env!("CARGO_BIN_EXE_tessgraph"));
                let graph = folder.path().join(name).with_extension("ron");
                command.arg("run").arg(graph);
                command.args(["--no-cache", "--threads", &threads.to_string()]);
                command.stdout(Stdio::null()).stderr(Stdio::null());
                // An output whose content has not changed is not written again.
                let _ = std::fs::remove_dir_all(folder.path().join("out"));
                command
            };
            bench
                .case(kernel, vertices, "vertices")
                .program(command)
                .run();
        }
    }
    Ok(())
}
