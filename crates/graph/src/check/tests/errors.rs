//! Every mistake a graph can have, one by one, with what is said about it.

use super::*;

/// A graph with these nodes, on lines of their own, that outputs the first.
fn with_nodes(nodes: &str) -> String {
    let name = nodes.split('"').nth(1).unwrap();
    format!(
        "Graph(version: 1, units: Cm, nodes: {{\n{nodes}\n}}, outputs: {{\"o.glb\": \"{name}\"}})"
    )
}

fn with_params(params: &str) -> String {
    format!(
        "Graph(version: 1, units: Cm, params: {{\n{params}\n}}, \
         nodes: {{\"a\": Grid(cells: (1, 1))}}, outputs: {{\"o.glb\": \"a\"}})"
    )
}

/// What is said about each case, one after the other.
fn book(cases: &[String]) -> String {
    cases
        .iter()
        .map(|case| format!("{case}\n\n{}\n----\n", problems(case)))
        .collect()
}

const BASE: &str = "\"m\": Grid(cells: (1, 1)),\n\"n\": SmoothNormals(mesh: \"m\"),";

fn node_case(node: &str) -> String {
    with_nodes(&format!("{BASE}\n{node}"))
}

#[test]
fn wrong_kinds_name_both_ends() {
    let cases = [
        r#""a": SmoothNormals(mesh: "n")"#,
        r#""a": SmoothNormals(mesh: 3)"#,
        r#""a": SmoothNormals(mesh: ["m"])"#,
        r#""a": SmoothNormals(mesh: Some("m"))"#,
        r#""a": SmoothNormals(mesh: Grid(cells: (1, 1)))"#,
        r#""a": SmoothNormals(mesh: "m + 1")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "n")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: true)"#,
        r#""a": JoinMeshes(meshes: "m")"#,
        r#""a": JoinMeshes(meshes: ["m", "n"])"#,
        r#""a": Grid(cells: (1, 1), closed: 1)"#,
        r#""a": Grid(cells: (1, 1), closed: "1 + 1")"#,
        r#""a": Grid(cells: (1, 1), closed: yes)"#,
        r#""a": Grid(cells: (1, 1), origin: [0, 0, 1])"#,
        r#""a": Grid(cells: (1, 1), origin: (0, 1))"#,
        r#""a": Grid(cells: (1, 1, 1))"#,
        r#""a": Grid(cells: 1)"#,
        r#""a": ReadMesh(path: 1)"#,
        r#""a": Rotate(mesh: "m", angle: 'x')"#,
        r#""a": Require(condition: true, weights: 1)"#,
        r#""a": CompensateThickness(mesh: "m", directions: "n", thickness: "n")"#,
    ];
    insta::assert_snapshot!(book(&cases.map(node_case)));
}

#[test]
fn unknown_names_come_with_the_nearest() {
    let cases = [
        r#""a": SmoothNormal(mesh: "m")"#,
        r#""a": Frobnicate(mesh: "m")"#,
        r#""a": SmoothNormals(mehs: "m")"#,
        r#""a": SmoothNormals(mesh: "m", colour: 3)"#,
        r#""a": SmoothNormals(mesh: "mm")"#,
        r#""a": SmoothNormals(mesh: "m.mehs")"#,
        r#""a": SmoothNormals(mesh: "missing_altogether")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "2 * count")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "n.count")"#,
        r#""a": ReadMesh(path: "{level}.obj")"#,
        r#""a": ReadMesh(path: "{m}.obj"), "b": ReadMesh(path: "{m.obj")"#,
        r#""a": EvaluateField(mesh: "m", value: "x + m.area + z.b")"#,
    ];
    insta::assert_snapshot!(book(&cases.map(node_case)));
}

#[test]
fn inputs_are_given_once_and_not_forgotten() {
    let cases = [
        r#""a": CompensateThickness()"#,
        r#""a": SmoothNormals(iterations: 3)"#,
        r#""a": SmoothNormals(mesh: "m", mesh: "m")"#,
        r#""m": Grid(cells: (2, 2))"#,
        r#""A b": Grid(cells: (2, 2))"#,
        r#""not": Grid(cells: (2, 2))"#,
        r#""a": Grid"#,
        r#""a": (cells: (2, 2))"#,
        r#""a": Grid(2, 2)"#,
        r#""a": "m""#,
        r#"a: Grid()"#,
        r#"7: Grid()"#,
    ];
    insta::assert_snapshot!(book(&cases.map(node_case)));
}

#[test]
fn numbers_stay_in_their_ranges() {
    let cases = [
        r#""a": Grid(cells: (0, 1))"#,
        r#""a": Grid(cells: (1.5, "5 / 2"))"#,
        r#""a": Grid(cells: (99999999999999999999, 1e300))"#,
        r#""a": Grid(cells: (1, 1), size: 0)"#,
        r#""a": Grid(cells: (1, 1), size: "1000 * 1000")"#,
        r#""a": Grid(cells: (1, 1), size: 1e999)"#,
        r#""a": Grid(cells: (1, 1), size: NaN)"#,
        r#""a": Grid(cells: (1, 1), size: -inf)"#,
        r#""a": Grid(cells: (1, 1), size: "1 / 0")"#,
        r#""a": Grid(cells: (1, 1), origin: (1e999, 0, "0/0"))"#,
        r#""a": Rotate(mesh: "m", angle: 181)"#,
        r#""a": EvaluateField(mesh: "m", value: 1e999)"#,
    ];
    insta::assert_snapshot!(book(&cases.map(node_case)));
}

#[test]
fn expressions_are_pointed_into() {
    let cases = [
        r#""a": SmoothNormals(mesh: "m", iterations: "2 + ")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "(2 + 3")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "2 3")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "2 m")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "1 < 2 < 3")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "1 < 2")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "1 + (2 < 3)")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "not 3")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "if(1 < 2, 3, 4 < 5)")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "sine(2)")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "clamp(2)")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "2 ** 3")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "\u{32} + é")"#,
        r#""a": SmoothNormals(mesh: "m", iterations: "aa + bb")"#,
        r#""a": EvaluateField(mesh: "m", value: "x > 1")"#,
        r#""x": EvaluateField(mesh: "m", value: "x + 1")"#,
    ];
    insta::assert_snapshot!(book(&cases.map(node_case)));
}

#[test]
fn choices_are_among_their_names() {
    let node = |inputs: &str| {
        let node = "\"a\": CompensateThickness(mesh: \"m\", directions: \"n\", thickness: 1, ";
        let params = "\"which\": Choice(default: Local, of: [Local, Other]), \"t\": 3";
        node_case(&format!("{node}{inputs})"))
            .replace("nodes:", &format!("params: {{{params}}}, nodes:"))
    };
    let cases = [
        "mode: Globl",
        "mode: \"Global\"",
        "mode: \"which\"",
        "mode: \"t\"",
        "mode: \"nothing\"",
        "mode: 3",
        "mode: Local, tolerance: 0.1",
        "tolerance: -1",
    ];
    insta::assert_snapshot!(book(&cases.map(node)));
}

#[test]
fn cycles_are_printed_whole() {
    let cases = [
        r#""a": SmoothNormals(mesh: "a")"#,
        r#""a": JoinMeshes(meshes: ["a"])"#,
        "\"a\": JoinMeshes(meshes: [\"b\"]),\n\"b\": JoinMeshes(meshes: [\"c\"]),\n\
         \"c\": JoinMeshes(meshes: [\"m\", \"a\"]),\n\"d\": JoinMeshes(meshes: [\"a\"])",
    ];
    insta::assert_snapshot!(book(&cases.map(node_case)));
}

#[test]
fn parameters_are_declared_in_full() {
    let cases = [
        r#""p": Number()"#,
        r#""p": Number(3)"#,
        r#""p": Number(default: "3")"#,
        r#""p": Number(default: 1, minimum: 3, min: 0, min: 1)"#,
        r#""p": Number(default: 1, min: 2, unit: Length)"#,
        r#""p": Number(default: 1, min: 3, max: 2)"#,
        r#""p": Number(default: NaN)"#,
        r#""p": Number(default: 1, min: inf, unit: Metre, about: 3)"#,
        r#""p": Integer(default: 1.5)"#,
        r#""p": Choice(default: A)"#,
        r#""p": Choice(default: C, of: [A, B, "B", A])"#,
        r#""p": Choice(default: "A", of: [A])"#,
        r#""p": Numbr(default: 1)"#,
        r#""p": Global"#,
        r#""p": [1, 2]"#,
        r#""p": 1, "p": 2, "a": 3, "pi": 4, "P": 5"#,
    ];
    insta::assert_snapshot!(book(&cases.map(with_params)));
}

#[test]
fn outputs_are_files_inside_the_folder() {
    let graph = |outputs: &str| {
        format!("Graph(version: 1, nodes: {{\"a\": Grid(cells: (1, 1))}}{outputs})")
    };
    let cases = [
        "",
        ", outputs: {}",
        ", outputs: {\"/dev/sda\": \"a\", \"../a.glb\": \"a\", \"out/\": \"a\", \"\": \"a\"}",
        ", outputs: {\"a.glb\": \"a\", \"b/../a.glb\": \"a\"}",
        ", outputs: {\"a\": \"a\", \"a/b.glb\": \"a\"}",
        ", outputs: {\"a.glb\": \"b\", \"b.glb\": \"a.x\", \"c.glb\": 3, 4: \"a\"}",
        ", outputs: \"a\"",
        ", outputs: {\"a.glb\": \"a\"}, results: {\"r\": \"x\", \"R\": \"a\"}",
        ", outputs: {\"a.glb\": \"a\"}, inputs: {\"mesh\": Mesh(), \"t\": Number()}",
    ];
    insta::assert_snapshot!(book(&cases.map(graph)));
}

#[test]
fn overrides_name_the_argument() {
    let text = with_params(
        r#""thickness": Number(default: 12, min: 2, max: 40, unit: Length), "n": 3, "flag": true,
           "mode": Choice(default: A, of: [A, B])"#,
    );
    let sets = [
        ("thicknes", "1"),
        ("thickness", "1"),
        ("thickness", "0,12"),
        ("n", "2.5"),
        ("n", "many"),
        ("flag", "yes"),
        ("mode", "C"),
        ("n", "99999999999999999999"),
    ];
    let said = sets.map(|(name, value)| problems_with(&text, &[(name, value)]));
    insta::assert_snapshot!(said.join(""));
}

#[test]
fn all_problems_are_reported_at_once() {
    let text = with_nodes(
        "\"a\": SmoothNormals(mesh: \"x\", iterations: \"1 +\"),\n\"a\": Grid(),\n\
         \"c\": Nothing(),\n\"d\": SmoothNormals(mesh: \"c\", iterations: -1)",
    );
    insta::assert_snapshot!(problems(&text));
}
