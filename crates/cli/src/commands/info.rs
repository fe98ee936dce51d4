//! `info`: what is in a mesh file.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value as Json, json};
use tessgraph_geometry::intersect::{IntersectOptions, Intersections, intersections};
use tessgraph_geometry::measure::{MeshMeasures, measure_mesh};
use tessgraph_geometry::{GeometryError, Mesh, Topology};
use tessgraph_graph::six_digits;
use tessgraph_io::Format;

use super::{Context, FAILED, OK};
use crate::diagnostics::{print, without_place};
use crate::interrupt::{INTERRUPTED, UntilInterrupt};
use crate::json::{number, pretty};
use crate::mesh_file;
use crate::text::{Align, count, table};

/// Tells what is in a mesh file
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The mesh file: OBJ, glTF, GLB, STL or PLY
    mesh: PathBuf,
    /// Gives the figures as JSON
    #[arg(long)]
    json: bool,
    /// Counts the pairs of faces that cross, by the rule of CheckIntersections
    #[arg(long)]
    intersections: bool,
}

/// Carries the command out.
pub(crate) fn info(args: &InfoArgs, cx: &mut Context<'_, '_>) -> u8 {
    let name = args.mesh.to_string_lossy();
    let (format, loaded) = match mesh_file::open(&args.mesh, cx) {
        Ok(opened) => opened,
        Err(status) => return status,
    };
    let crossings = match args
        .intersections
        .then(|| crossings(&loaded.mesh))
        .transpose()
    {
        Ok(crossings) => crossings,
        Err(GeometryError::Cancelled) => return INTERRUPTED,
        Err(error) => {
            let message = format!("cannot look for crossing faces: {error}");
            print(cx.console, &[without_place("bad_mesh", &name, message)]);
            return FAILED;
        }
    };
    let measures = measure_mesh(&loaded.mesh);
    if !measures.is_finite() {
        let message = "its coordinates are so large that its area or volume overflows";
        let diagnostic = without_place("too_large", &name, message);
        let help = "scale the mesh down in the program that made it";
        print(cx.console, &[diagnostic.with_help(help)]);
        return FAILED;
    }
    let text = if args.json {
        pretty(&measures_json(&measures, crossings.as_ref()))
    } else {
        page(&measures, &loaded.mesh, crossings.as_ref(), format)
    };
    cx.console.data(&text);
    OK
}

fn crossings(mesh: &Mesh) -> Result<Intersections, GeometryError> {
    intersections(mesh, &IntersectOptions::default(), &UntilInterrupt)
}

/// The documented object: counts as written in the file, lengths as in the file
/// (metres for glTF).
fn measures_json(measures: &MeshMeasures, crossings: Option<&Intersections>) -> Json {
    let point = |point: [f64; 3]| Json::Array(point.map(number).to_vec());
    let bounds = measures
        .bounds
        .map(|(low, high)| json!([point(low.into()), point(high.into())]));
    json!({
        "vertices": measures.vertices,
        "edges": measures.edges,
        "faces": measures.faces,
        "triangles": measures.triangles,
        "euler": measures.euler,
        "components": measures.components,
        "boundary_edges": measures.boundary_edges,
        "boundary_loops": measures.boundary_loops,
        "nonmanifold_edges": measures.nonmanifold_edges,
        "isolated_vertices": measures.isolated_vertices,
        "degenerate_faces": measures.degenerate_faces,
        "bounds": bounds,
        "area": number(measures.area),
        "volume": measures.volume.map_or(Json::Null, number),
        "intersections": crossings.map(|found| found.pairs.len()),
    })
}

/// The figures for people, with what they mean.
fn page(
    measures: &MeshMeasures,
    mesh: &Mesh,
    crossings: Option<&Intersections>,
    format: Format,
) -> String {
    let unit = if format.is_metric() { " m" } else { "" };
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let mut rows = vec![
        row("vertices", measures.vertices.to_string()),
        row("edges", measures.edges.to_string()),
        row("faces", measures.faces.to_string()),
        row("triangles", measures.triangles.to_string()),
        row("euler", measures.euler.to_string()),
        row("components", measures.components.to_string()),
    ];
    if let Some((low, high)) = measures.bounds {
        let size = (high - low).to_array().map(six_digits).join(" x ");
        rows.push(row("size", format!("{size}{unit}")));
        for (name, point) in [("lowest", low), ("highest", high)] {
            rows.push(row(
                name,
                format!("({})", point.to_array().map(six_digits).join(", ")),
            ));
        }
    }
    let power = |exponent: &str| {
        if unit.is_empty() {
            String::new()
        } else {
            format!("{unit}{exponent}")
        }
    };
    rows.push(row(
        "area",
        format!("{}{}", six_digits(measures.area), power("²")),
    ));
    if let Some(volume) = measures.volume {
        rows.push(row(
            "volume",
            format!("{}{}", six_digits(volume), power("³")),
        ));
    }
    let mut text = table(&rows, &[Align::Left, Align::Left]);
    text.push('\n');
    for line in verdicts(measures, mesh.topology())
        .into_iter()
        .chain(crossings.map(crossing_verdict))
    {
        let _ = writeln!(text, "{line}");
    }
    text
}

/// "3 pairs of faces cross; 2 more only touch or overlap".
fn crossing_verdict(found: &Intersections) -> String {
    let cross = match found.pairs.len() {
        0 => "no two faces cross".to_owned(),
        1 => "1 pair of faces crosses".to_owned(),
        pairs => format!("{pairs} pairs of faces cross"),
    };
    match found.contacts.len() {
        0 => cross,
        1 => format!("{cross}; 1 more only touches or overlaps"),
        contacts => format!("{cross}; {contacts} more only touch or overlap"),
    }
}

/// What the figures say about the mesh's soundness, the main thing first.
fn verdicts(measures: &MeshMeasures, topology: &Topology) -> Vec<String> {
    let mut lines = Vec::new();
    if measures.faces == 0 {
        lines.push("no faces: a point cloud or an empty mesh".to_owned());
    } else if measures.boundary_edges > 0 {
        let (loops, edges) = (
            count(measures.boundary_loops, "boundary loop"),
            count(measures.boundary_edges, "edge"),
        );
        lines.push(format!("open: {loops} of {edges}; it encloses no volume"));
    } else if let Some(volume) = measures.volume {
        let sense = if volume < 0.0 {
            ", but turned inside out: its faces point inwards"
        } else {
            ""
        };
        lines.push(format!("closed{sense}"));
    }
    lines.extend(measures.defects.sentences(topology));
    lines
}
