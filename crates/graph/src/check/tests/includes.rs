//! Graphs that include graphs.

use std::fmt::Write as _;

use super::registry::NODES;
use crate::check::{LoadOptions, Loaded, load_with};
use crate::plan::{Origin, Plan, ResultRef};
use crate::world::MemoryWorld;
use crate::{Diagnostic, Value};

/// A part that takes a mesh and a thickness, in millimetres.
const PART: &str = r#"Graph(
    version: 1,
    units: Mm,
    inputs: {
        "mesh": Mesh(),
        "thickness": Number(default: 20, min: 1, max: 500, unit: Length),
        "passes": Integer(default: 2, min: 0),
    },
    nodes: {
        "directions": SmoothNormals(mesh: "mesh", iterations: "passes"),
        "even": CompensateThickness(mesh: "mesh", directions: "directions", thickness: "thickness"),
        "all": JoinMeshes(meshes: ["mesh"]),
    },
    results: {"mesh": "all", "directions": "even", "error": "even.max_error"},
)"#;

fn loaded(files: &[(&str, &str)], text: &str, set: &[(&str, &str)]) -> Loaded {
    let mut world = MemoryWorld::default();
    for (path, content) in files {
        world.insert(*path, content.as_bytes());
    }
    let options = super::options(set);
    load_with("graphs/main.ron", text.as_bytes(), NODES, &options, &world)
}

/// A main graph in metres around these nodes.
fn main_graph(nodes: &str, output: &str) -> String {
    format!(
        "Graph(version: 1, params: {{\"t\": 0.03, \"n\": 2}}, nodes: {{\
         \"base\": Grid(cells: (1, 1)),\n{nodes}}}, outputs: {{\"out.obj\": \"{output}\"}})"
    )
}

fn plan(nodes: &str, output: &str) -> Plan {
    let text = main_graph(nodes, output);
    let loaded = loaded(&[("parts/part.ron", PART)], &text, &[]);
    loaded
        .plan
        .unwrap_or_else(|problems| panic!("{}", shown(&problems)))
}

/// Problems with all their places, each with its file.
fn shown(problems: &[Diagnostic]) -> String {
    let mut out = String::new();
    for problem in problems {
        let _ = writeln!(out, "{}: {}", problem.code, problem.message);
        let own = problem.labels.iter().map(|label| (&problem.source, label));
        let other = problem
            .elsewhere
            .iter()
            .map(|place| (&place.source, &place.label));
        for (source, label) in own.chain(other) {
            let (line, column) = source.position(label.span.start);
            let part: Vec<&str> = source.text()[label.span.clone()]
                .split_whitespace()
                .collect();
            let (name, part) = (source.name(), part.join(" "));
            let part: String = part.chars().take(60).collect();
            let _ = writeln!(out, "  {name}:{line}:{column} {part} <- {}", label.message);
        }
        let _ = writeln!(out, "  help: {}", problem.help.as_deref().unwrap_or("none"));
    }
    out
}

fn problems(files: &[(&str, &str)], text: &str) -> String {
    match loaded(files, text, &[]).plan {
        Ok(_) => panic!("{text}\nis accepted"),
        Err(problems) => {
            assert!(problems.iter().all(|problem| problem.help.is_some()));
            shown(&problems)
        }
    }
}

fn names(plan: &Plan) -> Vec<&str> {
    plan.nodes.iter().map(|node| node.name.as_str()).collect()
}

/// An input of a node: a value, or the results it takes by name.
fn input(plan: &Plan, node: &str, input: &str) -> String {
    let node = &plan.nodes[plan.node_index(node).unwrap()];
    let place = node.spec.inputs.iter().position(|spec| spec.name == input);
    let name = |result: &ResultRef| {
        let node = &plan.nodes[result.node];
        format!("{}.{}", node.name, node.spec.outputs[result.result].name)
    };
    match &node.inputs[place.unwrap()].origin {
        Origin::Constant(value) => value.summary(),
        origin => origin
            .results()
            .iter()
            .map(name)
            .collect::<Vec<_>>()
            .join(" "),
    }
}

#[test]
fn a_subgraph_stands_in_its_place() {
    let plan = plan(
        r#""panels": Subgraph(path: "parts/part.ron", with: {"mesh": "base", "thickness": "t / 2"}),
           "both": JoinMeshes(meshes: ["panels", "panels.mesh"]),"#,
        "both",
    );
    let wanted = [
        "base",
        "panels/directions",
        "panels/even",
        "panels/all",
        "both",
    ];
    assert_eq!(names(&plan), wanted);
    assert_eq!(input(&plan, "panels/even", "mesh"), "base.mesh");
    assert_eq!(
        input(&plan, "panels/even", "directions"),
        "panels/directions.directions"
    );
    // 0.03 m / 2, inside in millimetres, and in metres again.
    assert_eq!(input(&plan, "panels/even", "thickness"), "0.015");
    assert_eq!(input(&plan, "panels/directions", "iterations"), "2");
    assert_eq!(
        input(&plan, "both", "meshes"),
        "panels/all.mesh panels/all.mesh"
    );
    assert_eq!(plan.included, ["parts/part.ron"]);
    assert_eq!(plan.nodes[1].source.name(), "graphs/parts/part.ron");
    assert_eq!(plan.nodes[1].units, crate::Units::Mm);
    assert_eq!(
        plan.nodes[1].included[0].label.message,
        "included here by `panels`"
    );
}

#[test]
fn numbers_of_nodes_cross_with_their_quantity() {
    let plan = plan(
        r#""first": Subgraph(path: "parts/part.ron", with: {"mesh": "base"}),
           "second": Subgraph(path: "parts/part.ron",
               with: {"mesh": "first", "thickness": "first.error + 0.01", "passes": "n"}),"#,
        "second",
    );
    assert_eq!(
        input(&plan, "second/even", "thickness"),
        "second/thickness.value"
    );
    let node = &plan.nodes[plan.node_index("second/thickness").unwrap()];
    assert_eq!(node.spec.outputs[0].quantity, crate::Quantity::Length);
    let Origin::Expression(expression) = &node.inputs[0].origin else {
        panic!("{:?}", node.inputs[0].origin)
    };
    // 0.1 m + 0.01 m; the limits of the input hold, in the units of the graph that gives.
    let value = expression.evaluate(&|_| Value::Number(0.1)).unwrap();
    assert_eq!(value.summary(), "0.11");
    let error = expression.evaluate(&|_| Value::Number(2.0)).unwrap_err();
    assert_eq!(error, "`thickness` must be 0.001 m to 0.5 m, but is 2.01 m");
    let Origin::Expression(inner) =
        &plan.nodes[plan.node_index("second/even").unwrap()].inputs[2].origin
    else {
        panic!()
    };
    assert_eq!(
        inner.evaluate(&|_| Value::Number(0.11)).unwrap().summary(),
        "0.11"
    );
    assert_eq!(input(&plan, "second/directions", "iterations"), "2");
}

#[test]
fn for_each_makes_every_combination_and_joins() {
    let form = r#""family": ForEach(path: "parts/part.ron", join: JOIN, with: {"mesh": "base"},
        over: {"thickness": Linspace(from: "t", to: 0.05, count: "n"), "passes": Values(of: [0, "n + 3"])}),
        "more": JoinMeshes(meshes: TAKEN),"#;
    let joined = plan(
        &form
            .replace("JOIN", "Mesh")
            .replace("TAKEN", r#"["family"]"#),
        "more",
    );
    assert_eq!(joined.nodes.len(), 1 + 4 * 3 + 2);
    let of = |node: &str, name: &str| input(&joined, node, name);
    let pairs = (1..=4).map(|copy| {
        let thickness = of(&format!("family/{copy}/even"), "thickness");
        (
            thickness,
            of(&format!("family/{copy}/directions"), "iterations"),
        )
    });
    let pairs: Vec<_> = pairs.map(|(a, b)| format!("{a} {b}")).collect();
    assert_eq!(pairs, ["0.03 0", "0.03 5", "0.05 0", "0.05 5"]);
    assert_eq!(of("more", "meshes"), "family/mesh.mesh");
    let all: Vec<String> = (1..=4)
        .map(|copy| format!("family/{copy}/all.mesh"))
        .collect();
    assert_eq!(of("family/mesh", "meshes"), all.join(" "));

    let listed = plan(
        &form.replace("JOIN", "List").replace("TAKEN", r#""family""#),
        "more",
    );
    assert_eq!(input(&listed, "more", "meshes"), all.join(" "));
}

#[test]
fn repeat_feeds_each_pass_from_the_last() {
    let form = |times: &str| {
        let form = r#""cells": Repeat(path: "parts/part.ron", times: N, carry: "mesh", with: {"mesh": "base"}),"#;
        plan(&form.replace('N', times), "cells")
    };
    let three = form("\"n + 1\"");
    assert_eq!(three.nodes.len(), 1 + 3 * 3);
    assert_eq!(input(&three, "cells/1/all", "meshes"), "base.mesh");
    assert_eq!(input(&three, "cells/3/all", "meshes"), "cells/2/all.mesh");
    assert_eq!(
        three.nodes[three.outputs[0].result.node].name,
        "cells/3/all"
    );
    let none = form("0");
    assert_eq!(names(&none), ["base"]);
    assert_eq!(none.outputs[0].result.node, 0);
}

#[test]
fn numbers_are_carried_through_the_range_of_their_input() {
    const HALVES: &str = r#"(version: 1, inputs: {"mesh": Mesh(), "t": Number(max: 5, unit: Length)},
        nodes: {"d": SmoothNormals(mesh: "mesh"),
                "c": CompensateThickness(mesh: "mesh", directions: "d", thickness: "t")},
        results: {"t": "c.max_error"})"#;
    let text = main_graph(
        r#""r": Repeat(path: "h.ron", times: "n", carry: "t", with: {"mesh": "base", "t": 1}),
           "g": Grid(cells: (1, 1), size: "r"), "#,
        "g",
    );
    let run = |n: &str| {
        loaded(&[("h.ron", HALVES)], &text, &[("n", n)])
            .plan
            .unwrap()
    };
    let two = run("2");
    assert_eq!(input(&two, "r/1/c", "thickness"), "1");
    assert_eq!(input(&two, "r/2/c", "thickness"), "r/2/t.value");
    assert_eq!(input(&two, "r/2/t", "length"), "r/1/c.max_error");
    let Origin::Expression(carried) = &two.nodes[two.node_index("r/2/t").unwrap()].inputs[0].origin
    else {
        panic!()
    };
    let error = carried.evaluate(&|_| Value::Number(6.0)).unwrap_err();
    assert_eq!(error, "`t` must be at most 5 m, but is 6 m");
    let none = run("0");
    assert_eq!(input(&none, "g", "size"), "r/t.value");
    assert_eq!(input(&none, "r/t", "length"), "1");
}

#[test]
fn paths_are_named_from_the_file_they_stand_in() {
    const READER: &str = r#"(version: 1, inputs: {"file": Path(default: "own.obj")},
        nodes: {"m": ReadMesh(path: "{file}"), "n": ReadMesh(path: "../n.obj")}, results: {"m": "m"})"#;
    const OUTER: &str = r#"(version: 1, inputs: {"name": Text()},
        nodes: {"r": Subgraph(path: "b/reader.ron", with: {"file": "from_{name}.obj"}),
                "d": Subgraph(path: "../a/b/reader.ron")},
        results: {"m": "r", "d": "d"})"#;
    let files = [("a/b/reader.ron", READER), ("a/outer.ron", OUTER)];
    let text = main_graph(
        r#""o": Subgraph(path: "a/outer.ron", with: {"name": "x{n}"}),
           "r": Subgraph(path: "a/b/reader.ron", with: {"file": "here.obj"}),"#,
        "o",
    );
    let plan = loaded(&files, &text, &[]).plan.unwrap();
    let paths = ["o/r/m", "o/r/n", "o/d/m", "r/m"].map(|node| input(&plan, node, "path"));
    let wanted = [
        "a/from_x2.obj",
        "a/b/../n.obj",
        "a/../a/b/own.obj",
        "here.obj",
    ];
    assert_eq!(paths, wanted.map(|path| format!("{path:?}")));
    // The same file by two names is read once.
    assert_eq!(plan.included, ["a/outer.ron", "a/b/reader.ron"]);
}

#[test]
fn order_and_forward_references_do_not_matter() {
    let plan = plan(
        r#""last": Subgraph(path: "parts/part.ron", with: {"mesh": "middle"}),
           "middle": JoinMeshes(meshes: ["first"]),
           "first": Subgraph(path: "parts/part.ron", with: {"mesh": "base"}),"#,
        "last",
    );
    assert_eq!(input(&plan, "last/all", "meshes"), "middle.mesh");
    assert_eq!(input(&plan, "middle", "meshes"), "first/all.mesh");
}

#[test]
fn mistakes_of_all_files_are_found_at_once() {
    const BROKEN: &str = "Graph(version: 1,\n inputs: {\"mesh\": Mesh(), \"t\": Number(unit: Length, max: 1)},\n \
        nodes: {\"a\": SmothNormals(mesh: \"mesh\"), \"b\": Grid(cells: (0, 1), size: \"t\")},\n \
        results: {\"a\": \"nothing\"})";
    let text = main_graph(
        r#""one": ForEach(path: "broken.ron", over: {"t": Values(of: [0.5, 0.25])}, with: {"mesh": "base"}),
           "two": Subgraph(path: "broken.ron", with: {"mesch": "base", "t": 3}),
           "three": Subgraph(path: "missing.ron"),
           "four": Subgraph(path: "syntax.ron"),
           "five": Subgraph(path: "parts/part.ron", with: {"mesh": "t", "thickness": "Thick", "passes": 0.5}),
           "six": Subgraph(path: "parts/part.ron", with: {"mesh": "base.x"}, witth: 1),
           "seven": Repeat(path: "parts/part.ron", times: -1, carry: "mash", with: {"mesh": "base"}),
           "eight": Repeat(times: "five.error", carry: 3),
           "lists": ForEach(path: "list.ron", over: {"i": Values(of: [1, 2])}, with: {"mesh": "base"}),
           "nine": ForEach(path: "parts/part.ron", over: {"mesh": Values(of: [1]), "passes": Grid()}, join: Meshes),"#,
        "base",
    );
    const LIST: &str = "(version: 1, inputs: {\"mesh\": Mesh(), \"i\": 1}, nodes: {\"s\": SplitParts(mesh: \"mesh\")}, results: {\"s\": \"s\"})";
    let files = [
        ("broken.ron", BROKEN),
        ("list.ron", LIST),
        ("syntax.ron", "Graph(version: 1,\n nodes: {\n"),
        ("parts/part.ron", PART),
    ];
    insta::assert_snapshot!(problems(&files, &text));
    let loaded = loaded(&files, &text, &[]);
    let wanted = [
        "broken.ron",
        "missing.ron",
        "syntax.ron",
        "parts/part.ron",
        "list.ron",
    ];
    assert_eq!(loaded.included, wanted);
}

#[test]
fn circles_are_printed_as_chains() {
    const A: &str = r#"(version: 1, nodes: {"b": Subgraph(path: "b.ron")}, results: {"m": "b"})"#;
    const B: &str =
        r#"(version: 1, nodes: {"a": Subgraph(path: "./x/../a.ron")}, results: {"m": "a"})"#;
    let files = [("sub/a.ron", A), ("sub/b.ron", B), ("parts/part.ron", PART)];
    let mut book = problems(
        &files,
        &main_graph(r#""a": Subgraph(path: "sub/a.ron"),"#, "a"),
    );
    book.push_str(&problems(
        &[],
        &main_graph(r#""me": Subgraph(path: "main.ron"),"#, "base"),
    ));
    let each_other = r#"
        "one": Subgraph(path: "parts/part.ron", with: {"mesh": "two"}),
        "two": Subgraph(path: "parts/part.ron", with: {"mesh": "one.mesh"}),"#;
    book.push_str(&problems(&files, &main_graph(each_other, "base")));
    let through_a_node = r#"
        "one": Subgraph(path: "parts/part.ron", with: {"mesh": "back"}),
        "back": JoinMeshes(meshes: ["one"]),"#;
    book.push_str(&problems(&files, &main_graph(through_a_node, "base")));
    insta::assert_snapshot!(book);
}

#[test]
fn too_much_is_refused_before_it_is_made() {
    let ten = |inner: &str| {
        format!(
            "(version: 1, inputs: {{\"i\": Integer(default: 0)}}, nodes: {{\"g\": Grid(cells: (1, 1)),\
             \"x\": ForEach(path: \"{inner}\", over: {{\"i\": Linspace(from: 1, to: 10, count: 10)}})}},\
             results: {{\"m\": \"g\"}})"
        )
    };
    let names: Vec<String> = (0..11).map(|level| format!("{level}.ron")).collect();
    let mut texts: Vec<String> = names[1..].iter().map(|inner| ten(inner)).collect();
    texts.push(r#"(version: 1, inputs: {"i": Integer()}, nodes: {"g": Grid(cells: (1, 1))}, results: {"m": "g"})"#.to_owned());
    let levels: Vec<(&str, &str)> = names
        .iter()
        .map(String::as_str)
        .zip(texts.iter().map(String::as_str))
        .collect();
    let start = std::time::Instant::now();
    let forms = [
        r#""x": Repeat(path: "parts/part.ron", times: 1000000000, carry: "mesh", with: {"mesh": "base"}),"#,
        r#""x": ForEach(path: "parts/part.ron", with: {"mesh": "base"},
              over: {"passes": Linspace(from: 0, to: 1, count: 1e9)}),"#,
        r#""x": ForEach(path: "parts/part.ron", with: {"mesh": "base"},
              over: {"passes": Linspace(from: 0, to: 999, count: 1000), "thickness": Random(from: 0.1, to: 0.2, count: 1000)}),"#,
        r#""x": Subgraph(path: "0.ron"),"#,
    ];
    let mut book = String::new();
    for form in forms {
        let files: Vec<_> = levels
            .iter()
            .copied()
            .chain([("parts/part.ron", PART)])
            .collect();
        book.push_str(&problems(&files, &main_graph(form, "base")));
    }
    let deep: Vec<(String, String)> = (0..40)
        .map(|level| {
            let text = format!(
                "(version: 1, nodes: {{\"x\": Subgraph(path: \"d{}.ron\")}}, results: {{\"m\": \"x\"}})",
                level + 1
            );
            (format!("d{level}.ron"), text)
        })
        .collect();
    let files: Vec<(&str, &str)> = deep
        .iter()
        .map(|(name, text)| (name.as_str(), text.as_str()))
        .collect();
    let found = problems(
        &files,
        &main_graph(r#""x": Subgraph(path: "d0.ron"),"#, "base"),
    );
    book.push_str(found.lines().next().unwrap());
    insta::assert_snapshot!(book);
    // Without the limits this would take days.
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn a_required_number_can_be_set_from_outside() {
    let text = br#"(version: 1, inputs: {"n": Integer()}, nodes: {"g": Grid(cells: ("n", 1))},
        outputs: {"g.obj": "g"})"#;
    let load = |set| load_with("m.ron", text, NODES, &set, &MemoryWorld::default()).plan;
    assert_eq!(
        load(LoadOptions::default()).unwrap_err()[0].code,
        "not_runnable"
    );
    let plan = load(super::options(&[("n", "4")])).unwrap();
    assert_eq!(input(&plan, "g", "cells"), "list of 2\n[0]\n4\n[1]\n1\n");
}
