//! Several components in one array: which face takes which, and how.

use tessgraph_geometry::{AttributeValues, Domain, Mesh};

use crate::support::{self, Ran};

/// Results of nodes behind a 4 by 3 grid with its normals and two boxes.
fn ran(array: &str) -> Ran {
    let ran = Ran::nodes(&body(array), &[]);
    let found = &ran.evaluation.diagnostics;
    assert!(ran.evaluation.is_ok(), "{}", support::shown(found));
    ran
}

fn body(array: &str) -> String {
    format!(
        "\"base\": Grid(cells: [4, 3], size: [4, 3]),
        \"normals\": VertexNormals(mesh: \"base\"),
        \"low\": Cuboid(size: [1, 1, 0.1]),
        \"high\": Cuboid(size: [1, 1, 0.5]),
        \"wall\": Cuboid(size: [1, 0.1, 1]),
        \"number\": EvaluateField(mesh: \"base\", on: Faces, value: \"index\"),
        \"thirds\": EvaluateField(mesh: \"base\", on: Faces, value: \"index % 3 - 1\"),
        \"even\": EvaluateField(mesh: \"base\", on: Faces, value: \"index % 2\"),
        \"along\": EvaluateField(mesh: \"base\", on: Faces, value: \"x / 4\"),
        \"array\": ArrayComponents(base: \"base\", directions: \"normals\", {array})"
    )
}

/// (base face, component) of each piece.
fn placed(mesh: &Mesh) -> Vec<(i64, i64)> {
    let values = |name: &str| match mesh.attribute(name, Domain::Face).map(|a| a.values()) {
        Some(AttributeValues::Integer(values)) => values.to_vec(),
        other => panic!("{name}: {other:?}"),
    };
    let mut pairs: Vec<_> = values("base_face")
        .into_iter()
        .zip(values("component"))
        .collect();
    pairs.dedup();
    pairs
}

const TWO: &str = "components: [\"low\", \"high\"]";

#[test]
fn by_index() {
    let ran = ran(&format!("{TWO}, choose: Index, index: \"thirds\""));
    let expected: Vec<_> = (0..12)
        .filter(|f| f % 3 > 0)
        .map(|f| (f, f % 3 - 1))
        .collect();
    assert_eq!(placed(&ran.mesh("array")), expected);
    assert_eq!(ran.number("array.placed") as usize, 8);
}

#[test]
fn along_a_gradient_and_only_some() {
    let ran = ran(&format!(
        "{TWO}, choose: Gradient, gradient: \"along\", only: \"even\""
    ));
    let expected: Vec<_> = (0..12)
        .filter(|f| f % 2 == 1)
        .map(|f| (f, i64::from(f % 4 >= 2)))
        .collect();
    assert_eq!(placed(&ran.mesh("array")), expected);
}

#[test]
fn at_random() {
    let choice = |more: &str| placed(&ran(&format!("{TWO}, choose: Random{more}")).mesh("array"));
    assert!(
        choice(", weights: [0, 2]")
            .iter()
            .all(|&(_, component)| component == 1)
    );
    assert_eq!(choice(", seed: 3"), choice(", seed: 3"));
    assert_ne!(choice(", seed: 3"), choice(", seed: 4"));
    let kept = choice(", seed: 3, only: \"even\"");
    let all = choice(", seed: 3");
    assert!(kept.len() == 6 && kept.iter().all(|pair| all.contains(pair)));
}

#[test]
fn by_material() {
    let base = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\n\
                usemtl glass\nf 1 2 6 5\nusemtl stone\nf 2 3 7 6\nusemtl other\nf 3 4 8 7\n";
    let nodes = body(&format!(
        "{TWO}, choose: Material, materials: [\"stone\", \"glass\"]"
    ))
    .replace(
        "Grid(cells: [4, 3], size: [4, 3])",
        "ReadMesh(path: \"base.obj\")",
    );
    let ran = Ran::nodes(&nodes, &[("base.obj", base)]);
    assert_eq!(placed(&ran.mesh("array")), [(0, 1), (1, 0)]);
}

/// How far the vertices of a component lie from the rim of the 4 by 3 grid.
fn from_rim(mesh: &Mesh, component: i64) -> Vec<f64> {
    let of_face = match mesh
        .attribute("component", Domain::Face)
        .map(|a| a.values())
    {
        Some(AttributeValues::Integer(values)) => values.to_vec(),
        other => panic!("{other:?}"),
    };
    let faces = (0..mesh.face_count()).filter(|&face| of_face[face] == component);
    let vertices = faces.flat_map(|face| mesh.face(face));
    let places = vertices.map(|&vertex| mesh.positions()[vertex as usize]);
    places
        .map(|p| {
            let (x, y) = (p.x.min(4.0 - p.x), p.y.min(3.0 - p.y));
            x.min(y)
        })
        .collect()
}

#[test]
fn walls_stand_on_the_border() {
    let border = "component: \"low\", border_component: \"wall\", fit: Unit";
    let by_face = body(border);
    let by_parent = body(&format!("{border}, domain: Parent")).replace(
        "\"base\": Grid(cells: [4, 3], size: [4, 3])",
        "\"plan\": Grid(cells: [4, 3], size: [4, 3]),
         \"base\": SubdivideQuad(mesh: \"plan\", levels: 1, scheme: Bilinear)",
    );
    for nodes in [by_face, by_parent] {
        let mesh = Ran::nodes(&nodes, &[]).mesh("array");
        let walls = placed(&mesh).iter().filter(|pair| pair.1 == 1).count();
        assert_eq!(walls, 10);
        let far = from_rim(&mesh, 1);
        let farthest = far.iter().copied().fold(0.0, f64::max);
        assert!((farthest - 0.1).abs() < 1e-12, "{farthest}");
    }
    let straight = ran(&format!("{border}, turn_border: false"));
    let far = from_rim(&straight.mesh("array"), 1);
    assert!(far.iter().any(|&distance| distance > 0.4));
}

#[test]
fn corners_take_another_component_than_sides() {
    let ran = ran("component: \"low\", border_components: [\"wall\", \"high\"]");
    // Rows of four: corners have two border edges, sides one.
    let expected = [2, 1, 1, 2, 1, 0, 0, 1, 2, 1, 1, 2];
    let expected: Vec<(i64, i64)> = (0..).zip(expected).collect();
    assert_eq!(placed(&ran.mesh("array")), expected);
}

/// The grid's faces as fans of four triangles each.
fn fans(array: &str) -> Mesh {
    let nodes = body(array).replace(
        "\"base\": Grid(cells: [4, 3], size: [4, 3])",
        "\"plan\": Grid(cells: [4, 3], size: [4, 3]), \"base\": FanFaces(mesh: \"plan\")",
    );
    let ran = Ran::nodes(&nodes, &[]);
    let found = &ran.evaluation.diagnostics;
    assert!(ran.evaluation.is_ok(), "{}", support::shown(found));
    Mesh::clone(&ran.mesh("array"))
}

#[test]
fn triangles_of_a_fan_choose_alike() {
    for choose in [
        "choose: Random, seed: 3",
        "choose: Index, index: \"even\"",
        "choose: Gradient, gradient: \"along\", randomness: 0.7",
    ] {
        let differing = |per: &str| {
            let mesh = fans(&format!("{TWO}, {choose}{per}"));
            let placed = placed(&mesh);
            assert_eq!(placed.len(), 48);
            let fans = placed.chunks(4);
            fans.filter(|fan| fan.iter().any(|one| one.1 != fan[0].1))
                .count()
        };
        assert!(differing("") > 0, "{choose}: each for itself");
        assert_eq!(differing(", per: Source"), 0, "{choose}");
    }
    // Not all fans take the same.
    let alike = placed(&fans(&format!(
        "{TWO}, choose: Random, seed: 3, per: Source"
    )));
    let high = alike.iter().filter(|pair| pair.1 == 1).count();
    assert!(high > 0 && high < 48, "{high}");
}

#[test]
fn faces_turn_to_the_border_or_with_their_fan() {
    let nodes = |rotate: &str| {
        let body = format!(
            "\"plan\": Grid(cells: [4, 3], size: [4, 3], centre: false),
             \"fan\": FanFaces(mesh: \"plan\"),
             \"out\": {rotate}"
        );
        Mesh::clone(&Ran::nodes(&body, &[]).mesh("out"))
    };
    let turned = nodes("RotateFaces(mesh: \"plan\", by: Border)");
    for face in 0..12 {
        let [a, b] = [0, 1].map(|k| turned.positions()[turned.face(face)[k] as usize]);
        let both = |x: f64, y: f64, at: f64| (x - at).abs() + (y - at).abs() < 1e-12;
        let on_rim = both(a.x, b.x, 0.0) || both(a.x, b.x, 4.0);
        let on_rim = on_rim || both(a.y, b.y, 0.0) || both(a.y, b.y, 3.0);
        assert_eq!(on_rim, ![5, 6].contains(&face), "face {face}");
    }
    // Triangle k of a fan starts at corner k of its face, turned by the same number.
    let plan = nodes("FanFaces(mesh: \"plan\")");
    let turns = |per: &str| {
        let mesh = nodes(&format!(
            "RotateFaces(mesh: \"fan\", by: Random, seed: 5{per})"
        ));
        let turn = |face: usize| {
            let first = plan.face(face)[0];
            mesh.face(face).iter().position(|&vertex| vertex == first)
        };
        (0..48).map(turn).collect::<Vec<_>>()
    };
    let differing = |turns: &[Option<usize>]| {
        turns
            .chunks(4)
            .filter(|fan| fan.iter().any(|one| *one != fan[0]))
            .count()
    };
    assert!(differing(&turns("")) > 6);
    let alike = turns(", per: Source");
    assert_eq!(differing(&alike), 0);
    assert!(alike.iter().any(|turn| *turn != alike[0]), "{alike:?}");
}

#[test]
fn attributes_come_along() {
    let nodes = body("component: \"low\", carry: [\"sun\"]").replace(
        "\"base\": Grid(cells: [4, 3], size: [4, 3])",
        "\"plan\": Grid(cells: [4, 3], size: [4, 3]),
         \"east\": EvaluateField(mesh: \"plan\", value: \"2 * x\"),
         \"base\": SetAttribute(mesh: \"plan\", name: \"sun\", field: \"east\")",
    );
    let mesh = Ran::nodes(&nodes, &[]).mesh("array");
    let Some(AttributeValues::Number(sun)) =
        mesh.attribute("sun", Domain::Vertex).map(|a| a.values())
    else {
        panic!("no sun");
    };
    for (value, p) in sun.iter().zip(mesh.positions().iter()) {
        assert!((value - 2.0 * p.x).abs() < 1e-12);
    }
}

#[test]
fn parents_without_four_sides_are_counted() {
    let cage = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 4 0 0\nv 5 1 0\nv 4 2 0\n\
                f 1 2 3 4\nf 2 5 6 7 3\n";
    let nodes = body("component: \"low\", domain: Parent").replace(
        "\"base\": Grid(cells: [4, 3], size: [4, 3])",
        "\"cage\": ReadMesh(path: \"cage.obj\"), \"base\": SubdivideQuad(mesh: \"cage\", levels: 2)",
    );
    let ran = Ran::nodes(&nodes, &[("cage.obj", cage)]);
    assert_eq!(ran.number("array.placed") as usize, 1);
    assert_eq!(ran.number("array.skipped_parents") as usize, 1);
    let warnings = ran.warnings().concat();
    assert!(warnings.contains("have not four sides"), "{warnings}");
}

#[test]
fn what_cannot_be_chosen_is_said() {
    for (array, expected) in [
        ("fit: Unit", "there is no component"),
        ("component: \"low\", components: [\"high\"]", "not both"),
        ("components: [\"low\", \"high\"]", "say how to choose"),
        (
            "components: [\"low\", \"high\"], choose: Index",
            "needs `index`",
        ),
        (
            "components: [\"low\", \"high\"], choose: Index, index: \"number\"",
            "asks for component 2",
        ),
        (
            "components: [\"low\", \"high\"], choose: Random, weights: [1]",
            "1 weights for 2 components",
        ),
        (
            "components: [\"low\", \"high\"], choose: Material, materials: [\"a\"]",
            "1 materials for 2 components",
        ),
        (
            "component: \"low\", border_component: \"wall\", border_components: [\"high\"]",
            "either `border_component` or `border_components`",
        ),
        (
            "components: [\"low\", \"high\"], choose: Random, per: Source",
            "no `source_face`",
        ),
        ("component: \"low\", domain: Parent", "parent"),
        ("component: \"low\", carry: [\"nothing\"]", "nothing"),
    ] {
        let ran = Ran::nodes(&body(array), &[]);
        let said = support::shown(&ran.evaluation.diagnostics);
        assert!(said.contains(expected), "{array}: {said}");
    }
}
