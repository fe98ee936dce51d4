//! Input that is wrong but no reason to stop: each is named in a warning, and
//! nothing becomes NaN. What must stop a run is in tests/suite/errors.

use proptest::prelude::*;
use tessgraph_graph::Value;

use crate::support::Ran;

/// Runs nodes and checks that some warning holds all of `parts`.
fn warned(body: &str, parts: &[&str]) -> Ran {
    let ran = Ran::nodes(body, &[]);
    assert_finite(&ran);
    let warnings = ran.warnings();
    let holds = |warning: &String| parts.iter().all(|part| warning.contains(part));
    assert!(warnings.iter().any(holds), "{parts:?} in {warnings:#?}");
    ran
}

/// Checks every number of every result that is there.
fn assert_finite(ran: &Ran) {
    for (node, planned) in ran.plan.nodes.iter().enumerate() {
        for result in 0..planned.spec.outputs.len() {
            let place = tessgraph_graph::plan::ResultRef { node, result };
            let name = || {
                format!(
                    "{}.{}",
                    planned.spec.name, planned.spec.outputs[result].name
                )
            };
            match ran.evaluation.value(place) {
                Some(Value::Number(number)) => assert!(number.is_finite(), "{}", name()),
                Some(Value::Mesh(mesh)) => {
                    assert!(mesh.positions().iter().all(|p| p.is_finite()), "{}", name());
                }
                Some(Value::Field(field)) => {
                    assert!(field.values().iter().all(|v| v.is_finite()), "{}", name());
                }
                Some(Value::Directions(directions)) => {
                    let all = directions
                        .outward()
                        .iter()
                        .chain(directions.inward().iter());
                    assert!(all.into_iter().all(|d| d.is_finite()), "{}", name());
                }
                _ => {}
            }
        }
    }
}

#[test]
fn tangential_directions_are_limited_and_named() {
    warned(
        r#""base": Grid(cells: [2, 2]),
        "along": ConstantDirection(mesh: "base", vector: (1, 0, 0.001)),
        "out": CompensateThickness(mesh: "base", directions: "along", thickness: 0.1, mode: Local)"#,
        &[
            "vertices 0, 1, 2, 3, 4, 5, 6, 7",
            "nearly tangential",
            "limited",
        ],
    );
}

#[test]
fn inverted_thickness_is_counted() {
    // An arch of more than a half circle: many passes make all directions parallel.
    warned(
        r#""arch": ParametricSurface(x: "sin(5 * u - 2.5)", y: "v", z: "cos(5 * u - 2.5)", cells: [12, 2]),
        "out": SmoothNormals(mesh: "arch", iterations: 4000)"#,
        &["against", "faces"],
    );
}

#[test]
fn components_beyond_their_square_are_named() {
    warned(
        r#""base": Grid(cells: [2, 2]),
        "normals": VertexNormals(mesh: "base"),
        "box": Cuboid(size: [1.5, 1, 0.2]),
        "out": ArrayComponents(base: "base", component: "box", directions: "normals", fit: Unit)"#,
        &["outside the unit square", "FitComponent", "vertices"],
    );
}

#[test]
fn arrays_and_meshes_of_nothing_are_warned_of() {
    let ran = warned(
        r#""base": Grid(cells: [2, 2]),
        "normals": VertexNormals(mesh: "base"),
        "box": Cuboid(size: [1, 1, 0.2]),
        "out": ArrayComponents(base: "base", component: "box", directions: "normals", only: 0)"#,
        &["no component was placed"],
    );
    assert_eq!(ran.count("out.placed"), 0);
    // Said once, where the mesh becomes empty.
    let ran = warned(
        r#""base": Grid(cells: [2, 2]),
        "none": DeleteFaces(mesh: "base", faces: 1),
        "out": Transform(mesh: "none", translate: (1, 0, 0))"#,
        &["none: ", "mesh without faces"],
    );
    assert_eq!(ran.warnings().len(), 1, "{:?}", ran.warnings());
}

#[test]
fn two_walls_have_room_for_half_their_gap() {
    // Gap 1.6, thickness 1 between them: no place behind the other wall counts.
    let ran = warned(
        r#""low": Grid(cells: [4, 4], size: [4, 4], centre: true),
        "above": Transform(mesh: "low", translate: (0, 0, 1.6)),
        "high": FlipFaces(mesh: "above"),
        "walls": JoinMeshes(meshes: ["low", "high"]),
        "normals": VertexNormals(mesh: "walls"),
        "room": MaxOffset(mesh: "walls", limit: 10),
        "out": CompensateThickness(mesh: "walls", directions: "normals", thickness: 1, inward: 0.5, mode: Global)"#,
        &[
            "outward, no solution at 50 of 50 vertices",
            "reaches 0.8 m of 1 m",
        ],
    );
    assert_eq!(ran.count("out.unsolved"), 50);
    // All of them on the outer side, and each in the field; half the way inward is free.
    assert_eq!(ran.count("out.outward_unsolved"), 50);
    assert_eq!(ran.count("out.inward_unsolved"), 0);
    let statuses = |name: &str| match ran.value(name) {
        Value::Field(field) => field.values().to_vec(),
        other => panic!("{name} is {:?}", other.kind()),
    };
    assert!(
        statuses("out.outward_status")
            .iter()
            .all(|status| (status - 3.0).abs() < 0.5)
    );
    assert!(
        statuses("out.inward_status")
            .iter()
            .all(|status| status.abs() < 1.5)
    );
    assert!((ran.number("room.min_outward") - 0.8).abs() < 1e-9);
    let Value::Directions(found) = ran.value("out.directions") else {
        panic!("directions");
    };
    for direction in found.outward().iter() {
        assert!((direction.length() - 0.8).abs() < 1e-6, "{direction}");
    }
}

/// A component and its other (u', v'): a second OBJ file, and a glTF with two sets.
const QUAD: &str = "v 0 0 0.5\nv 1 0 0.5\nv 1 1 0.5\nv 0 1 0.5\nf 1 2 3 4\n";

/// The quad as glTF: (x, y) as the first set, (1/4, 1/4) throughout as the second.
fn two_layers() -> String {
    let buffer = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAAAAAAIC/AAAAAAAAAAAAAIC/AAAAAAAAAAAAAIA/\
                  AAAAAAAAgD8AAIA/AAAAAAAAgD8AAIA+AABAPwAAgD4AAEA/AACAPgAAQD8AAIA+AABAPwAAAQACAAAAAgADAA==";
    let view = |offset: usize, length: usize| {
        format!(r#"{{"buffer": 0, "byteOffset": {offset}, "byteLength": {length}}}"#)
    };
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"mesh": 0, "translation": [0, 0.5, 0]}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2}}, "indices": 3}}]}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, -1], "max": [1, 0, 0]}},
            {{"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}},
            {{"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"}},
            {{"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}}],
        "bufferViews": [{}, {}, {}, {}],
        "buffers": [{{"byteLength": 124, "uri": "data:application/octet-stream;base64,{buffer}"}}]}}"#,
        view(0, 48),
        view(48, 32),
        view(80, 32),
        view(112, 12),
    )
}

#[test]
fn places_of_directions_come_from_other_files() {
    // Directions lean by x / 2, so a plate at height 1/2 read at u' moves by u' / 4.
    let body = |component: &str, evaluated: &str| {
        format!(
            r#""base": Grid(cells: [1, 1]),
        "target": ParametricSurface(x: "u + u / 2", y: "v", z: "1", cells: [1, 1]),
        "dirs": TargetDirections(mesh: "base", target: "target"),
        "part": {component},
        "layer": ReadMesh(path: "layer.obj"),
        "placed": EvaluateNormalsUV(component: "part", {evaluated}),
        "out": ArrayComponents(base: "base", component: "placed", directions: "dirs", fit: Unit, interpolation: Linear)"#
        )
    };
    let layer = "v 9 9 9\nv 8 9 9\nv 9 8 9\nv 7 7 7\nvt 0.25 0.25\nf 1/1 2/1 3/1 4/1\n";
    let gltf = two_layers();
    let files = [
        ("part.obj", QUAD),
        ("layer.obj", layer),
        ("part.gltf", gltf.as_str()),
    ];
    let shifts = |component: &str, evaluated: &str| -> Vec<f64> {
        let ran = Ran::nodes(&body(component, evaluated), &files);
        let mut places: Vec<[f64; 3]> = ran
            .mesh("out")
            .positions()
            .iter()
            .map(|p| p.to_array())
            .collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        places.iter().map(|p| p[0]).collect()
    };
    let check = |found: Vec<f64>, expected: [f64; 4]| {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    };
    let obj = r#"ReadMesh(path: "part.obj")"#;
    let both = r#"ReadMesh(path: "part.gltf")"#;
    check(
        shifts(obj, r#"source: Scale, factor: 1"#),
        [0.0, 0.0, 1.25, 1.25],
    );
    check(
        shifts(obj, r#"layer_of: "layer""#),
        [0.0625, 0.0625, 1.0625, 1.0625],
    );
    // Of the glTF's sets the second is constant; of the first, v counts from below.
    check(
        shifts(both, r#"layer: "uv1""#),
        [0.0625, 0.0625, 1.0625, 1.0625],
    );
    check(shifts(both, r#"layer: "uv""#), [0.0, 0.0, 1.25, 1.25]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn no_result_is_ever_nan(
        steep in 0.0f64..30.0, flat in 0.0f64..1.2, thickness in 0.0f64..3.0, levels in 0u32..2,
        iterations in 0u32..60, lean in -1.0f64..1.0, local: bool,
    ) {
        // Folds, faces without area, repeated places and thicknesses that do not fit.
        let mode = if local { "Local" } else { "Global" };
        let body = format!(
            r#""base": ParametricSurface(x: "2 * max(u - {flat}, 0)", y: "v", z: "{steep} * abs(u - 0.5) * v", cells: [4, 3]),
            "fine": SubdivideQuad(mesh: "base", levels: {levels}),
            "normals": VertexNormals(mesh: "fine"),
            "smooth": SmoothNormals(mesh: "fine", iterations: {iterations}),
            "up": ConstantDirection(mesh: "fine", vector: ({lean}, 0, 1)),
            "mixed": BlendDirections(mesh: "fine", a: "smooth", b: "up", amount: 0.5),
            "even": CompensateThickness(mesh: "fine", directions: "mixed", thickness: {thickness}, mode: {mode}),
            "shell": OffsetMesh(mesh: "fine", directions: "even", outward: {thickness}),
            "box": Cuboid(size: [1, 1, 0.3]),
            "array": ArrayComponents(base: "fine", component: "box", directions: "even", height: Relative),
            "size": MeasureMesh(mesh: "array"),
            "depth": MeasureThickness(mesh: "array", base: "fine", thickness: 0.3),
            "planar": CheckPlanarity(mesh: "array"),
            "bent": MeasureDistortion(mesh: "array", component: "box"),
            "curve": CurvatureField(mesh: "fine"),
            "room": MaxOffset(mesh: "fine", limit: 5),
            "dual": DualMesh(mesh: "fine"),
            "walls": ExtrudeFaces(mesh: "fine", height: 0.2, mode: Region)"#
        );
        assert_finite(&Ran::nodes(&body, &[]));
    }
}
