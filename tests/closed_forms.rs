//! Results that are known exactly.

use std::fmt::Write as _;

use glam::DVec3;
use tessgraph_geometry::Mesh;
use tessgraph_geometry::math::{PI, TAU, cos, sin};

use crate::support::Ran;

/// Relative accuracy asked of closed forms.
const EXACT: f64 = 1e-12;

/// A mesh as OBJ text with all digits.
fn obj(positions: &[DVec3], faces: &[Vec<usize>]) -> String {
    let mut text = String::new();
    for p in positions {
        let _ = writeln!(text, "v {:?} {:?} {:?}", p.x, p.y, p.z);
    }
    for face in faces {
        let corners: Vec<String> = face.iter().map(|v| (v + 1).to_string()).collect();
        let _ = writeln!(text, "f {}", corners.join(" "));
    }
    text
}

/// Compensates `directions` of the mesh `base.obj` and measures where they lead,
/// outward and inward.
fn offset_errors(base: &str, directions: &str, extra: &[(&str, &str)]) -> (f64, f64) {
    let body = format!(
        r#""base": ReadMesh(path: "base.obj"),
        {directions},
        "even": CompensateThickness(mesh: "base", directions: "dirs", thickness: 0.125, tolerance: 1e-12),
        "up": DisplaceVertices(mesh: "base", directions: "even", distance: 0.125),
        "down": DisplaceVertices(mesh: "base", directions: "even", distance: -0.125),
        "top": MeasureThickness(mesh: "up", base: "base", thickness: 0.125),
        "bottom": MeasureThickness(mesh: "down", base: "base", thickness: 0.125)"#
    );
    let files: Vec<(&str, &str)> = [("base.obj", base)]
        .into_iter()
        .chain(extra.iter().copied())
        .collect();
    let ran = Ran::nodes(&body, &files);
    assert_eq!(ran.count("even.unsolved"), 0, "{:?}", ran.warnings());
    (
        ran.number("top.max_error") / 0.125,
        ran.number("bottom.max_error") / 0.125,
    )
}

fn assert_exact((top, bottom): (f64, f64)) {
    assert!(
        top <= EXACT && bottom <= EXACT,
        "outward {top:e}, inward {bottom:e}"
    );
}

#[test]
fn a_plane_at_any_tilt_is_offset_exactly() {
    let place = |i: usize, j: usize| {
        let (x, y) = (i as f64 * 0.25 - 0.7, j as f64 * 0.3);
        DVec3::new(x, y * 0.8, 0.4 * x + y * 0.6)
    };
    let mut positions = Vec::new();
    for j in 0..5 {
        positions.extend((0..6).map(|i| place(i, j)));
    }
    let at = |i: usize, j: usize| j * 6 + i;
    let mut faces = Vec::new();
    for j in 0..4 {
        faces.extend((0..5).map(|i| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    }
    // Every direction leans another way, up to 50 degrees from the normal.
    let normal = DVec3::new(-0.4, -0.6 / 0.8, 1.0).normalize();
    let lean = |k: usize| {
        DVec3::new(
            sin(k as f64),
            cos(2.0 * k as f64),
            0.3 * sin(3.0 * k as f64),
        )
    };
    let moved = positions
        .iter()
        .enumerate()
        .map(|(k, p)| *p + normal + 0.7 * lean(k));
    let target = obj(&moved.collect::<Vec<_>>(), &faces);
    let directions = r#""target": ReadMesh(path: "target.obj"),
        "dirs": TargetDirections(mesh: "base", target: "target")"#;
    let base = obj(&positions, &faces);
    assert_exact(offset_errors(&base, directions, &[("target.obj", &target)]));
}

#[test]
fn a_polyhedral_cylinder_is_offset_exactly() {
    let (sides, rows) = (64, 6);
    let mut positions = Vec::new();
    for row in 0..=rows {
        let around = (0..sides).map(|k| {
            let angle = TAU * k as f64 / sides as f64;
            DVec3::new(cos(angle), sin(angle), 0.4 * row as f64)
        });
        positions.extend(around);
    }
    let mut faces = Vec::new();
    for row in 0..rows {
        let at = |k: usize, row: usize| row * sides + k % sides;
        faces.extend((0..sides).map(|k| {
            vec![
                at(k, row),
                at(k + 1, row),
                at(k + 1, row + 1),
                at(k, row + 1),
            ]
        }));
    }
    let base = obj(&positions, &faces);
    assert_exact(offset_errors(
        &base,
        r#""dirs": VertexNormals(mesh: "base")"#,
        &[],
    ));
}

#[test]
fn a_polyhedral_sphere_is_offset_exactly() {
    let (rings, sides) = (16, 24);
    let mut positions = vec![DVec3::Z];
    for ring in 1..rings {
        let polar = PI * ring as f64 / rings as f64;
        positions.extend((0..sides).map(|k| {
            let angle = TAU * k as f64 / sides as f64;
            DVec3::new(sin(polar) * cos(angle), sin(polar) * sin(angle), cos(polar))
        }));
    }
    positions.push(DVec3::NEG_Z);
    let at = |k: usize, ring: usize| 1 + (ring - 1) * sides + k % sides;
    let mut faces: Vec<Vec<usize>> = (0..sides)
        .map(|k| vec![0, at(k, 1), at(k + 1, 1)])
        .collect();
    for ring in 1..rings - 1 {
        faces.extend((0..sides).map(|k| {
            vec![
                at(k, ring),
                at(k, ring + 1),
                at(k + 1, ring + 1),
                at(k + 1, ring),
            ]
        }));
    }
    let south = positions.len() - 1;
    faces.extend((0..sides).map(|k| vec![at(k, rings - 1), south, at(k + 1, rings - 1)]));
    let base = obj(&positions, &faces);
    assert_exact(offset_errors(
        &base,
        r#""dirs": VertexNormals(mesh: "base")"#,
        &[],
    ));
}

#[test]
fn subdivision_counts_follow_the_formula() {
    // V' = V + E + F, E' = 2 E + 4 F, F' = 4 F for quads, at every level.
    let cases = [
        (r#""cage": Cuboid(size: [2, 2, 2], cells: [2, 3, 1])"#, 2),
        (r#""cage": Grid(cells: [3, 2])"#, 1),
        (
            r#""cage": ParametricSurface(x: "(3 + cos(v * tau)) * cos(u * tau)",
                y: "(3 + cos(v * tau)) * sin(u * tau)", z: "sin(v * tau)",
                cells: [7, 4], closed_u: true, closed_v: true)"#,
            0,
        ),
    ];
    for (cage, euler) in cases {
        for scheme in ["CatmullClark", "Bilinear"] {
            let mut expected: Option<[i64; 3]> = None;
            for levels in 0..4 {
                let body = format!(
                    "{cage},\n\"fine\": SubdivideQuad(mesh: \"cage\", levels: {levels}, scheme: {scheme}),\n\
                     \"size\": MeasureMesh(mesh: \"fine\")"
                );
                let ran = Ran::nodes(&body, &[]);
                let counts =
                    ["vertices", "edges", "faces"].map(|name| ran.count(&format!("size.{name}")));
                assert_eq!(counts, expected.unwrap_or(counts), "{cage} level {levels}");
                assert_eq!(ran.count("size.euler"), euler);
                let [v, e, f] = counts;
                expected = Some([v + e + f, 2 * e + 4 * f, 4 * f]);
            }
        }
    }
}

/// Every edge has two faces, which pass it in opposite senses.
fn is_closed(mesh: &Mesh) -> bool {
    let adjacency = mesh.topology().adjacency();
    (0..adjacency.edge_count()).all(|edge| {
        let from = |corner: u32| mesh.topology().corners()[corner as usize];
        matches!(*adjacency.edge_corners(edge), [a, b] if from(a) != from(b))
    })
}

const TORUS: &str = r#""torus": ParametricSurface(x: "(3 + cos(v * tau)) * cos(u * tau)",
        y: "(3 + cos(v * tau)) * sin(u * tau)", z: "sin(v * tau)",
        cells: [12, 8], closed_u: true, closed_v: true),
    "normals": VertexNormals(mesh: "torus"),
    "ring": ReadMesh(path: "ring.obj"),
    "fitted": FitComponent(component: "ring", height: 0.2)"#;

#[test]
fn a_welded_torus_is_closed_and_an_unwelded_one_is_not() {
    let ring = crate::support::text_of(&crate::support::workspace().join("graphs/meshes/ring.obj"));
    let array = |join: &str| {
        let body = format!(
            "{TORUS},\n\"array\": ArrayComponents(base: \"torus\", component: \"fitted\", \
             directions: \"normals\", fit: Unit, join: {join})"
        );
        let ran = Ran::nodes(&body, &[("ring.obj", &ring)]);
        (ran.mesh("array"), ran.count("array.unmatched"))
    };
    let (welded, unmatched) = array("Weld");
    assert!(is_closed(&welded));
    assert_eq!(unmatched, 0);
    // Each of the 96 base vertices and faces gives 2 and 8 vertices of its own.
    assert_eq!(
        (welded.vertex_count(), welded.face_count()),
        (96 * 10, 96 * 12)
    );
    assert!(!is_closed(&array("None").0));
}

#[test]
fn a_thickened_flat_grid_has_the_volume_of_a_box() {
    let ran = Ran::nodes(
        r#""base": Grid(cells: [7, 5], size: [3.5, 2]),
        "normals": VertexNormals(mesh: "base"),
        "slab": OffsetMesh(mesh: "base", directions: "normals", outward: 0.3, inward: 0.1),
        "size": MeasureMesh(mesh: "slab")"#,
        &[],
    );
    let volume = ran.number("size.volume");
    assert!(
        (volume - 3.5 * 2.0 * 0.4).abs() <= EXACT * volume,
        "{volume}"
    );
    let area = ran.number("size.area");
    assert!(
        (area - 2.0 * (7.0 + 0.4 * 5.5)).abs() <= EXACT * area,
        "{area}"
    );
    assert!(is_closed(&ran.mesh("slab")));
}

#[test]
fn the_same_facade_in_centimetres_is_the_same_facade() {
    let in_units = |units: &str, size: f64, t: f64| {
        let text = format!(
            r#"Graph(version: 1, units: {units}, nodes: {{
                "base": ParametricSurface(x: "{size:?} * u", y: "{size:?} * v",
                    z: "{size:?} * 0.1 * sin(u * tau)", cells: [6, 5]),
                "normals": VertexNormals(mesh: "base"),
                "field": EvaluateField(mesh: "base", value: "{t:?} * (1 + x / {size:?})"),
                "slab": OffsetMesh(mesh: "base", directions: "normals", outward: "field"),
            }}, outputs: {{"out.obj": "slab"}})"#
        );
        Ran::graph(&text, &[]).mesh("slab")
    };
    let (metres, centimetres) = (in_units("M", 4.0, 0.25), in_units("Cm", 400.0, 25.0));
    for (a, b) in metres
        .positions()
        .iter()
        .zip(centimetres.positions().iter())
    {
        assert!((*a - *b).length() <= 4.0 * EXACT, "{a} and {b}");
    }
}

#[test]
fn a_length_that_passes_through_an_attribute_keeps_its_size() {
    let text = r#"Graph(version: 1, units: Mm, nodes: {
        "base": Grid(cells: [4, 2], size: [4000, 2000]),
        "up": VertexNormals(mesh: "base"),
        "far": DistanceField(mesh: "base", points: [(0, 0, 0)]),
        "kept": SetAttribute(mesh: "base", name: "distance", field: "far"),
        "again": EvaluateField(mesh: "kept", value: "distance + 0"),
        "straight": DisplaceVertices(mesh: "base", directions: "up", distance: "far"),
        "around": DisplaceVertices(mesh: "base", directions: "up", distance: "again"),
    }, outputs: {"a.obj": "straight", "b.obj": "around"})"#;
    let ran = Ran::graph(text, &[]);
    let (straight, around) = (ran.mesh("straight"), ran.mesh("around"));
    let corner = straight.positions()[straight.vertex_count() - 1];
    assert!((corner.z - 20f64.sqrt()).abs() < EXACT, "{corner}");
    for (a, b) in straight.positions().iter().zip(around.positions().iter()) {
        assert!((*a - *b).length() < EXACT, "{a} and {b}");
    }
}
