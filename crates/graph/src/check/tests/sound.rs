//! Graphs that are sound, and the plans they become.

use super::*;
use crate::plan::{Origin, ResultRef};
use crate::value::Value;

const FACADE: &str = r#"
// A facade with everything in it.
#![enable(implicit_some)]
Graph(
    version: 1,
    units: Cm,
    params: {
        "thickness": Number(default: 12, min: 2, max: 40, unit: Length, about: "panel depth"),
        "levels": Integer(default: 2, min: 0, max: 6),
        "smooth": 20, // a bare value
        "mode": Choice(default: Local, of: [Local, Global]),
        "variant": Text(default: "a"),
    },
    nodes: {
        "facade": SmoothNormals(mesh: "surface", iterations: "smooth * 2"),
        "surface": Grid(cells: (8, "levels + 1"), size: "thickness * 10", origin: (0, -1, "thickness")),
        "roof": ReadMesh(path: "roof_{variant}_{levels}{{x}}.obj"),
        "even": CompensateThickness(
            mesh: "surface", directions: "facade", thickness: "thickness", mode: "mode",
            tolerance: 1e-3,
        ),
        "all": JoinMeshes(meshes: ["roof", "surface.mesh"]),
        "turned": Rotate(mesh: "all", angle: "even.max_error + 45", label: r"as {{is}}"),
        "check": Require(condition: "even.all_solved and even.solved > 3"),
        "waves": EvaluateField(mesh: "all", value: "thickness + x * 2 + curvature + even.max_error"),
        "bumpy": CompensateThickness(mesh: "all", directions: "even", thickness: "waves", mode: Global),
    },
    outputs: { "out/facade.glb": "turned", "out/even.json": "even.max_error" },
)
"#;

fn origin<'p>(plan: &'p Plan, node: &str, input: &str) -> &'p Origin {
    let node = &plan.nodes[plan.node_index(node).unwrap()];
    let place = node
        .spec
        .inputs
        .iter()
        .position(|spec| spec.name == input)
        .unwrap();
    &node.inputs[place].origin
}

fn constant(plan: &Plan, node: &str, input: &str) -> String {
    match origin(plan, node, input) {
        Origin::Constant(value) => value.summary(),
        other => panic!("{input} of {node} is {other:?}"),
    }
}

#[test]
fn literals_and_parameters_become_si_values() {
    let plan = plan(FACADE);
    assert_eq!(constant(&plan, "surface", "size"), "1.2");
    assert_eq!(
        constant(&plan, "surface", "cells"),
        "list of 2\n[0]\n8\n[1]\n3\n"
    );
    assert_eq!(constant(&plan, "surface", "origin"), "(0, -0.01, 0.12)");
    assert_eq!(constant(&plan, "surface", "closed"), "false");
    assert_eq!(constant(&plan, "facade", "iterations"), "40");
    assert_eq!(constant(&plan, "even", "thickness"), "0.12");
    assert_eq!(constant(&plan, "even", "mode"), "Local");
    assert_eq!(constant(&plan, "bumpy", "mode"), "Global");
    assert_eq!(constant(&plan, "roof", "path"), "\"roof_a_2{x}.obj\"");
    assert_eq!(constant(&plan, "turned", "label"), "\"as {is}\"");
}

#[test]
fn nodes_stand_after_what_they_need_and_else_in_file_order() {
    let plan = plan(FACADE);
    let names: Vec<&str> = plan.nodes.iter().map(|node| node.name.as_str()).collect();
    let wanted = [
        "surface", "facade", "roof", "even", "all", "turned", "check", "waves", "bumpy",
    ];
    assert_eq!(names, wanted);
    for (place, node) in plan.nodes.iter().enumerate() {
        let results = node.inputs.iter().flat_map(|input| input.origin.results());
        assert!(
            results.into_iter().all(|result| result.node < place),
            "{}",
            node.name
        );
    }
    assert_eq!(plan.outputs[1].path, "out/even.json");
    let even = plan.node_index("even").unwrap();
    assert_eq!(
        plan.outputs[1].result,
        ResultRef {
            node: even,
            result: 1
        }
    );
}

#[test]
fn expressions_convert_at_their_border() {
    let plan = plan(FACADE);
    let Origin::Expression(angle) = origin(&plan, "turned", "angle") else {
        panic!()
    };
    // 0.1 m is 10 cm; 10 + 45 degrees.
    let value = angle.evaluate(&|_| Value::Number(0.1)).unwrap();
    assert_eq!(value.summary(), "0.959931");
    // 2 m is 200 cm: 245 degrees are more than half a turn.
    let error = angle.evaluate(&|_| Value::Number(2.0)).unwrap_err();
    assert_eq!(error, "`angle` must be at most 180°, but is 245°");
    let error = angle
        .evaluate(&|_| Value::Number(f64::INFINITY))
        .unwrap_err();
    assert!(error.contains("no finite number"), "{error}");
}

#[test]
fn conditions_are_computed_from_results() {
    let plan = plan(FACADE);
    let Origin::Expression(condition) = origin(&plan, "check", "condition") else {
        panic!()
    };
    let solved = |count: i64| {
        let get = move |result: ResultRef| match result.result {
            2 => Value::Integer(count),
            _ => Value::Bool(true),
        };
        condition.evaluate(&get).unwrap().summary()
    };
    assert_eq!(
        (solved(3), solved(4)),
        ("false".to_owned(), "true".to_owned())
    );
}

#[test]
fn formulas_see_the_units_of_the_file() {
    let plan = plan(FACADE);
    let Origin::Formula(template) = origin(&plan, "waves", "value") else {
        panic!()
    };
    let formula = template.bind(&|_| Value::Number(0.5)).unwrap();
    assert_eq!(formula.names(), ["x", "curvature"]);
    assert_eq!(formula.attribute_names(), ["curvature"]);
    assert!(formula.uses("x") && !formula.uses("y"));
    // 12 + 2 * 100 + 7 + 50 cm at x = 1 m, where the attribute is 7.
    let metres = formula.evaluate(&[1.0, 7.0]);
    assert!((metres - 2.69).abs() < 1e-12, "{metres}");
}

#[test]
fn an_input_waits_for_another_choice_of_a_parameter() {
    let unused = plan(FACADE);
    assert!(matches!(
        origin(&unused, "even", "tolerance"),
        Origin::Absent
    ));
    let used = plan_with(FACADE, &[("mode", "Global")]);
    assert_eq!(constant(&used, "even", "tolerance"), "0.001");
}

#[test]
fn parameters_are_set_from_outside() {
    let set = [
        ("thickness", "13"),
        ("levels", "3"),
        ("variant", "b c"),
        ("levels", "4"),
    ];
    let plan = plan_with(FACADE, &set);
    assert_eq!(constant(&plan, "even", "thickness"), "0.13");
    assert_eq!(constant(&plan, "roof", "path"), "\"roof_b c_4{x}.obj\"");
    let values: Vec<String> = plan
        .parameters
        .iter()
        .map(|param| param.value.summary())
        .collect();
    assert_eq!(values, ["13", "4", "20", "\"Local\"", "\"b c\""]);
}

#[test]
fn a_graph_whose_inputs_have_defaults_runs_by_itself() {
    let text = r#"(version: 1, inputs: {"n": Integer(default: 3)}, results: {"mesh": "a"},
        nodes: {"a": Grid(cells: ("n", "n"))}, outputs: {"a.obj": "a"})"#;
    assert_eq!(
        constant(&plan(text), "a", "cells"),
        "list of 2\n[0]\n3\n[1]\n3\n"
    );
}

#[test]
fn a_reference_of_the_same_quantity_is_taken_as_it_is() {
    let text = r#"Graph(version: 1, units: In, nodes: {
        "a": Grid(cells: [1, 1]),
        "n": SmoothNormals(mesh: "a"),
        "c": CompensateThickness(mesh: "a", directions: "n", thickness: 1),
        "b": Grid(cells: [1, 1], size: "c.max_error"),
    }, outputs: {"b.obj": "b"})"#;
    let plan = plan(text);
    let Origin::Expression(size) = origin(&plan, "b", "size") else {
        panic!()
    };
    for metres in [0.1, 0.3, 1.0 / 3.0, 7e-5] {
        let Value::Number(same) = size.evaluate(&|_| Value::Number(metres)).unwrap() else {
            panic!()
        };
        assert_eq!(same.to_bits(), metres.to_bits());
    }
    assert_eq!(
        size.evaluate(&|_| Value::Number(0.0)).unwrap_err(),
        "`size` must be above 0 in and at most 39370.1 in, but is 0 in"
    );
}
