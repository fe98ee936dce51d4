//! Faults 41 and 45 to 58: meshes that are legal and still trouble.

use glam::DVec3;
use tessgraph_geometry::Mesh;

use super::desk::{Desk, Done};
use crate::support::Ran;

/// Reads `mesh`, offsets it along its normals and subdivides it.
fn worked(mesh: &str) -> (Desk, Done) {
    let desk = Desk::with(
        "Graph(version: 1, nodes: {
            \"a\": ReadMesh(path: \"a.obj\"),
            \"n\": VertexNormals(mesh: \"a\"),
            \"shell\": OffsetMesh(mesh: \"a\", directions: \"n\", outward: 0.1),
            \"fine\": SubdivideQuad(mesh: \"a\", levels: 1),
        }, outputs: {\"shell.obj\": \"shell\", \"fine.obj\": \"fine\"})",
    );
    desk.write("a.obj", mesh);
    let done = desk.go();
    done.sound();
    for name in ["shell.obj", "fine.obj"] {
        if desk.path(name).is_file() {
            let text = String::from_utf8(desk.content(name)).expect("a text");
            assert!(
                !text.to_lowercase().contains("nan") && !text.contains("inf"),
                "{text}"
            );
        }
    }
    (desk, done)
}

#[track_caller]
fn says(done: &Done, words: &[&str]) {
    for words in words {
        assert!(done.err.contains(words), "no `{words}` in {}", done.err);
    }
}

/// A wavy roof carrying a component along smoothed, compensated directions.
fn facade(scale: f64, moved: f64) -> Vec<DVec3> {
    let ran = Ran::nodes(
        &format!(
            "\"flat\": Grid(cells: (6, 5), size: (6, 5)),
             \"wave\": DisplaceVertices(mesh: \"flat\", directions: \"up\", distance: \"h\"),
             \"up\": ConstantDirection(mesh: \"flat\", vector: (0, 0, 1)),
             \"h\": EvaluateField(mesh: \"flat\", on: Vertices, value: \"0.4*sin(x) + 0.3*cos(y)\"),
             \"base\": Transform(mesh: \"wave\", scale: ({scale}, {scale}, {scale}), translate: ({moved}, {moved}, {moved})),
             \"fine\": SubdivideQuad(mesh: \"base\", levels: 1),
             \"s\": SmoothNormals(mesh: \"fine\", iterations: 5),
             \"c\": CompensateThickness(mesh: \"fine\", directions: \"s\", thickness: {}, mode: Global, tolerance: 1e-12),
             \"part\": Cuboid(),
             \"fit\": FitComponent(component: \"part\", height: {}),
             \"out\": ArrayComponents(base: \"fine\", component: \"fit\", directions: \"c\")",
            0.1 * scale,
            0.1 * scale
        ),
        &[],
    );
    ran.mesh("out").positions().to_vec()
}

#[test]
fn f041_far_from_the_origin_tiny_and_huge() {
    let here = facade(1.0, 0.0);
    for scale in [1e-6, 1e6, 1e12] {
        let other = facade(scale, 0.0);
        for (a, b) in here.iter().zip(&other) {
            assert!((*a * scale - *b).length() <= 1e-9 * scale * 8.0, "{a} {b}");
        }
    }
    for far in [1e7, 1e12] {
        let other = facade(1.0, far);
        assert_eq!(here.len(), other.len());
        for (a, b) in here.iter().zip(&other) {
            let gap = (*a + DVec3::splat(far) - *b).length();
            assert!(gap <= 1e-9 * far, "{gap} at {far}");
        }
    }
}

#[test]
fn f045_faces_that_do_not_agree() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n";
    let (_, flipped) = worked(&format!("{square}f 1 2 3 4\nf 2 3 6 5\n"));
    says(
        &flipped,
        &[
            "1 edge lies between faces of opposite sense: 1-2",
            "FlipFaces",
        ],
    );
    let (_, twice) = worked(&format!("{square}f 1 2 3 4\nf 1 2 3 4\n"));
    says(&twice, &["1 face repeats another: 1"]);
    let (_, back) = worked(&format!("{square}f 1 2 3 4\nf 4 3 2 1\n"));
    says(&back, &["1 face repeats another: 1"]);
    let three = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    let (desk, three) = worked(three);
    says(
        &three,
        &["1 edge has more than two faces: 0-1", "split the mesh"],
    );
    assert!(!desk.path("fine.obj").exists());
    let bow = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n";
    says(
        &worked(bow).1,
        &["1 vertex joins faces that share no edge: 0"],
    );
    let crossed = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n";
    says(
        &worked(crossed).1,
        &["1 face has no area: 0", "no normal at vertices 0, 1, 2, 3"],
    );
    // A Moebius band of three quads.
    let band = "v 1 0 -1\nv 1 0 1\nv -1 1 -1\nv -1 1 1\nv -1 -1 -1\nv -1 -1 1\n\
                f 1 2 4 3\nf 3 4 6 5\nf 5 6 1 2\n";
    says(&worked(band).1, &["opposite sense"]);
}

#[test]
fn f046_faces_without_area() {
    for mesh in [
        "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n",
        "v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\n",
        "v 5 5 5\nv 5 5 5\nv 5 5 5\nv 5 5 5\nf 1 2 3 4\n",
    ] {
        says(
            &worked(mesh).1,
            &["1 face has no area: 0", "no normal at vert"],
        );
    }
}

#[test]
fn f047_vertices_of_no_face() {
    let (desk, done) = worked("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 2 3 4\n");
    says(&done, &["2 vertices belong to no face: 0, 4"]);
    let copy = Desk::nodes("\"out\": ReadMesh(path: \"a.obj\")");
    copy.write("a.obj", desk.content("a.obj"));
    copy.go().made();
    let text = String::from_utf8(copy.content("out/o.obj")).expect("a text");
    assert!(text.contains("f 2 3 4"), "indices moved: {text}");
}

#[test]
fn f048_f049_f050_odd_but_sound() {
    use std::fmt::Write as _;
    let mut wheel = String::from("v 0 0 0.2\n");
    for k in 0..500 {
        let angle = f64::from(k) * std::f64::consts::TAU / 500.0;
        let (x, y) = (
            tessgraph_geometry::math::cos(angle),
            tessgraph_geometry::math::sin(angle),
        );
        let _ = writeln!(wheel, "v {x} {y} 0");
    }
    for k in 0..500 {
        let _ = writeln!(wheel, "f 1 {} {}", k + 2, (k + 1) % 500 + 2);
    }
    worked(&wheel).1.made();
    let two = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\n";
    worked(two).1.made();
    // Two cubes of a solid, all sides drawn: the one between stands twice.
    let mut cubes = String::new();
    for x in 0..3 {
        for (y, z) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let _ = writeln!(cubes, "v {x} {y} {z}");
        }
    }
    for at in [0, 4] {
        for side in [
            [1, 2, 3, 4],
            [5, 8, 7, 6],
            [1, 5, 6, 2],
            [2, 6, 7, 3],
            [3, 7, 8, 4],
            [4, 8, 5, 1],
        ] {
            let [a, b, c, d] = side.map(|corner| corner + at);
            let _ = writeln!(cubes, "f {a} {b} {c} {d}");
        }
    }
    says(
        &worked(&cubes).1,
        &["more than two faces", "repeats another"],
    );
}

/// A flat base of two by two faces with a component carried along `directions`.
fn carried(component: &str, directions: &str) -> Ran {
    Ran::nodes(
        &format!(
            "\"base\": Grid(cells: (2, 2), size: (2, 2)),\n\"n\": VertexNormals(mesh: \"base\"),\n\
             {directions}\n\"part\": {component},\n\
             \"out\": ArrayComponents(base: \"base\", component: \"part\", directions: \"n\")"
        ),
        &[
            ("low.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
            ("none.obj", "v 0 0 0\n"),
            (
                "uv.obj",
                "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 5 -3\nvt 7 9\nf 1/1 2/2 3/1\n",
            ),
        ],
    )
}

fn errors(ran: &Ran) -> String {
    crate::support::shown(&ran.evaluation.diagnostics)
}

fn finite(mesh: &Mesh) -> bool {
    mesh.positions().iter().all(|position| position.is_finite())
}

#[test]
fn f051_f052_f053_f054_targets_that_do_not_fit() {
    let aimed = |target: &str| {
        Ran::nodes(
            &format!(
                "\"base\": Grid(cells: (2, 2), size: (2, 2)),\n\"target\": {target},\n\
                 \"d\": TargetDirections(mesh: \"base\", target: \"target\"),\n\
                 \"out\": CompensateThickness(mesh: \"base\", directions: \"d\", thickness: 0.1)"
            ),
            &[(
                "other.obj",
                "v 0 0 1\nv 1 0 1\nv 2 0 1\nv 0 1 1\nv 1 1 1\nv 2 1 1\nv 0 2 1\nv 1 2 1\nv 2 2 1\n\
                 f 1 2 5 4\nf 2 3 6 5\nf 5 6 9 8\nf 4 5 8 7\n",
            )],
        )
    };
    assert!(
        errors(&aimed("Grid(cells: (3, 2))")).contains("12"),
        "counts"
    );
    let other = errors(&aimed("ReadMesh(path: \"other.obj\")"));
    assert!(other.contains("face 2"), "{other}");
    let same = errors(&aimed("Grid(cells: (2, 2), size: (2, 2))"));
    assert!(same.contains("vertices 0, 1, 2"), "{same}");
    let below = errors(&aimed("Transform(mesh: \"base\", translate: (0, 0, -1))"));
    assert!(below.contains("0, 1, 2"), "{below}");
    let beside = errors(&aimed("Transform(mesh: \"base\", translate: (1, 0, 0))"));
    assert!(
        beside.contains("no solution at 3 of 9 vertices: 0, 3, 6"),
        "{beside}"
    );
}

#[test]
fn f055_open_borders_do_not_diverge() {
    let ran = Ran::nodes(
        "\"flat\": Grid(cells: (4, 4), size: (4, 4)),\n\
         \"tilt\": ConstantDirection(mesh: \"flat\", vector: (1, 0, 1)),\n\
         \"c\": CompensateThickness(mesh: \"flat\", directions: \"tilt\", thickness: 0.5, mode: Global),\n\
         \"out\": OffsetMesh(mesh: \"flat\", directions: \"c\", outward: 0.5)",
        &[],
    );
    let mesh = ran.mesh("out");
    let (low, high) = mesh.bounds().expect("vertices");
    assert!(
        low.x >= -0.75 && high.x <= 5.25 && high.z <= 0.75,
        "{low} {high}"
    );
}

#[test]
fn f056_components_that_do_not_fit() {
    let none = carried("ReadMesh(path: \"none.obj\")", "");
    let told = format!("{}{:?}", errors(&none), none.warnings());
    assert!(!told.trim_matches(['[', ']']).is_empty(), "silence");
    let open = carried("ReadMesh(path: \"low.obj\")", "");
    assert_eq!(open.mesh("out").face_count(), 4);
    let wide = carried("ReadMesh(path: \"uv.obj\")", "");
    assert!(finite(&wide.mesh("out")));
    let no_uv = Ran::nodes(
        "\"part\": ReadMesh(path: \"low.obj\"),\n\
         \"out\": EvaluateNormalsUV(component: \"part\", source: UvLayer)",
        &[("low.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")],
    );
    assert!(errors(&no_uv).contains("uv"), "{}", errors(&no_uv));
}

#[test]
fn f057_faces_that_are_not_quads() {
    let five = Ran::nodes(
        "\"base\": ReadMesh(path: \"five.obj\"),\n\"n\": VertexNormals(mesh: \"base\"),\n\
         \"part\": Cuboid(),\n\
         \"out\": ArrayComponents(base: \"base\", component: \"part\", directions: \"n\")",
        &[(
            "five.obj",
            "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv 0 1 0\nv 2 -1 0\nf 1 2 3 4 5\nf 1 6 2\n",
        )],
    );
    let told = errors(&five);
    for words in ["face 0", "5", "FanFaces", "SplitIntoQuads"] {
        assert!(told.contains(words), "no `{words}` in {told}");
    }
}

#[test]
fn f058_ten_thousand_passes() {
    let ran = Ran::nodes(
        "\"flat\": Grid(cells: (8, 8), size: (8, 8)),\n\
         \"up\": ConstantDirection(mesh: \"flat\", vector: (0, 0, 1)),\n\
         \"h\": EvaluateField(mesh: \"flat\", on: Vertices, value: \"3*sin(2*x)\"),\n\
         \"wave\": DisplaceVertices(mesh: \"flat\", directions: \"up\", distance: \"h\"),\n\
         \"s\": SmoothNormals(mesh: \"wave\", iterations: 10000),\n\
         \"out\": OffsetMesh(mesh: \"wave\", directions: \"s\", outward: 1)",
        &[],
    );
    let (shell, wave) = (ran.mesh("out"), ran.mesh("wave"));
    let count = wave.vertex_count();
    for (vertex, base) in wave.positions().iter().enumerate() {
        let moved = [vertex, vertex + count].map(|k| shell.positions().get(k).copied());
        let length = moved.into_iter().flatten().map(|p| (p - *base).length());
        assert!(
            length.clone().any(|length| (length - 1.0).abs() < 1e-12),
            "vertex {vertex}"
        );
    }
}
