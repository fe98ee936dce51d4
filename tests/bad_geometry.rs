//! Geometry that a method cannot take: named with element ids, as an error or a
//! warning, and never NaN in a result.

use crate::support::{self, Ran};

/// A unit square of 2 by 2 quads; vertex 4 is its middle.
const PLATE: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\n\
                     f 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\nf 5 6 9 8\n";

/// What a graph over the plate, and another mesh, says: errors and warnings.
fn said(nodes: &str, other: &str) -> String {
    let body = format!("\"base\": ReadMesh(path: \"base.obj\"),\n{nodes}");
    let ran = Ran::nodes(&body, &[("base.obj", PLATE), ("other.obj", other)]);
    let errors = support::shown(&ran.evaluation.diagnostics);
    format!("{}\n{errors}", ran.warnings().join("\n"))
}

/// The plate with its middle vertex elsewhere.
fn with_middle(place: &str) -> String {
    PLATE.replace("v 1 1 0\n", &format!("v {place}\n"))
}

fn assert_says(nodes: &str, other: &str, expected: &[&str]) {
    let said = said(nodes, other);
    for part in expected {
        assert!(said.contains(part), "{part:?} is not in: {said}");
    }
    assert!(!said.contains("NaN"), "{said}");
}

const TOWARDS: &str = "\"other\": ReadMesh(path: \"other.obj\"),
    \"towards\": TargetDirections(mesh: \"base\", target: \"other\")";

#[test]
fn targets_of_other_topology_and_without_distance() {
    let turned = PLATE.replace("f 2 3 6 5", "f 3 6 5 2");
    assert_says(TOWARDS, &turned, &["face 1"]);
    let lifted = PLATE.replace(" 0\n", " 1\n");
    let touching = lifted.replace("v 1 1 1\n", "v 1 1 0\n");
    assert_says(TOWARDS, &touching, &["vertex 4 has no direction"]);
    assert!(said(TOWARDS, &lifted).trim().is_empty());
}

#[test]
fn tangential_and_inverted_directions() {
    let compensated = |mode: &str| {
        format!(
            "{TOWARDS},\n\"even\": CompensateThickness(mesh: \"base\", directions: \"towards\", \
             thickness: 0.1, mode: {mode})"
        )
    };
    let lifted = PLATE.replace(" 0\n", " 1\n");
    let sideways = lifted.replace("v 1 1 1\n", "v 2 1 0.0001\n");
    assert_says(
        &compensated("Local"),
        &sideways,
        &["vertices 4", "tangential"],
    );
    let below = lifted.replace("v 1 1 1\n", "v 1 1 -1\n");
    for mode in ["Local", "Global"] {
        assert_says(
            &compensated(mode),
            &below,
            &["vertex 4", "against the surface normal"],
        );
    }
    // Along the plate no length reaches the thickness: named, and finite.
    let flat = lifted.replace("v 1 1 1\n", "v 1.5 1 0\n");
    assert_says(&compensated("Global"), &flat, &["at vertices 4"]);
}

#[test]
fn faces_that_are_no_quads_and_edges_of_three_faces() {
    let array = "\"other\": ReadMesh(path: \"other.obj\"),
        \"normals\": VertexNormals(mesh: \"other\"),
        \"box\": Cuboid(size: [1, 1, 0.2]),
        \"array\": ArrayComponents(base: \"other\", component: \"box\", directions: \"normals\")";
    let pentagon = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nv 3 0 0\nf 1 2 3 4 5\nf 2 6 3\n";
    assert_says(array, pentagon, &["face 0", "SplitIntoQuads"]);
    let fine =
        "\"other\": ReadMesh(path: \"other.obj\"), \n\"fine\": SubdivideQuad(mesh: \"other\")";
    let three = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 -1 0\nv 1 -1 0\nv 0 0 1\nv 1 0 1\n\
                 f 1 2 3 4\nf 2 1 5 6\nf 1 2 8 7\n";
    assert_says(fine, three, &["0", "1", "more than two faces"]);
}

#[test]
fn normals_that_cancel_out() {
    // Two faces back to back: no normal at any of their vertices.
    let nodes = "\"other\": ReadMesh(path: \"other.obj\"),
        \"normals\": VertexNormals(mesh: \"other\"),
        \"moved\": OffsetMesh(mesh: \"other\", directions: \"normals\", outward: 0.1)";
    let back_to_back = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 4 3 2 1\n";
    assert_says(nodes, back_to_back, &["no normal at vertices 0, 1, 2, 3"]);
}

#[test]
fn meshes_with_a_spike_stay_finite() {
    for place in ["1 1 1e6", "1 1 -1e-9", "0 0 0", "1 0 0"] {
        let nodes = "\"other\": ReadMesh(path: \"other.obj\"),
            \"smooth\": SmoothNormals(mesh: \"other\", iterations: 50),
            \"moved\": DisplaceVertices(mesh: \"other\", directions: \"smooth\", distance: 0.1)";
        let body = format!("\"base\": Grid(),\n{nodes}");
        let ran = Ran::nodes(&body, &[("other.obj", &with_middle(place))]);
        let found = &ran.evaluation.diagnostics;
        assert!(ran.evaluation.is_ok(), "{place}: {}", support::shown(found));
        let moved = ran.mesh("moved");
        assert!(moved.positions().iter().all(|p| p.is_finite()), "{place}");
    }
}

#[test]
fn thicknesses_whose_squares_overflow() {
    // Found by fuzzing: the mean of the squared differences was infinite.
    let measured = "\"out\": MeasureThickness(mesh: \"base\", base: \"base\", thickness: 1e300)";
    assert_says(measured, PLATE, &["squares overflow"]);
}
