//! Large graphs in little time, and mutilated ones without a panic.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use proptest::prelude::*;

use super::*;

fn chain(count: usize, last: &str) -> String {
    let mut nodes = String::new();
    for index in 0..count {
        let needed = if index + 1 < count {
            format!("n{}", index + 1)
        } else {
            last.to_owned()
        };
        let _ = writeln!(nodes, "\"n{index}\": JoinMeshes(meshes: [\"{needed}\"]),");
    }
    format!(
        "Graph(version: 1, nodes: {{{nodes} \"m\": Grid(cells: (1, 1))}}, \
         outputs: {{\"o.glb\": \"n0\"}})"
    )
}

fn timed<T>(work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    assert!(
        start.elapsed() < Duration::from_secs(8),
        "took {:?}",
        start.elapsed()
    );
    result
}

#[test]
fn a_chain_of_100_000_nodes_is_checked() {
    let plan = timed(|| plan(&chain(100_000, "m")));
    assert_eq!(plan.nodes[0].name, "m");
    assert_eq!(plan.nodes[100_000].name, "n0");
}

#[test]
fn a_cycle_of_1000_nodes_is_printed_whole() {
    let problems = problems(&chain(1000, "n0"));
    assert!(problems.starts_with("cycle: "));
    assert!((0..1000).all(|index| problems.contains(&format!("`n{index}` -> "))));
}

#[test]
fn a_hundred_thousand_mistakes_are_all_reported() {
    let nodes: String = (0..100_000)
        .map(|index| format!("\"n{index}\": SmoothNormals(mesh: \"m{index}\"),\n"))
        .collect();
    let text = format!("Graph(version: 1, nodes: {{{nodes}}}, outputs: {{\"a.obj\": \"n1\"}})");
    let options = LoadOptions::default();
    let problems = timed(|| load("g.ron", text.as_bytes(), NODES, &options).unwrap_err());
    assert_eq!(problems.len(), 100_000);
}

#[test]
fn a_node_with_100_000_inputs_is_checked() {
    let inputs = vec!["\"m\""; 100_000].join(", ");
    let text = format!(
        "Graph(version: 1, nodes: {{\"m\": Grid(cells: (1, 1)), \
         \"a\": JoinMeshes(meshes: [{inputs}])}}, outputs: {{\"a.obj\": \"a\"}})"
    );
    assert_eq!(
        timed(|| plan(&text)).nodes[1].inputs[0]
            .origin
            .results()
            .len(),
        100_000
    );
    let inputs: String = (0..100_000).map(|index| format!("i{index}: 1, ")).collect();
    let text = format!("Graph(version: 1, nodes: {{\"m\": Grid({inputs})}})");
    let options = LoadOptions::default();
    let problems = timed(|| load("g.ron", text.as_bytes(), NODES, &options).unwrap_err());
    assert_eq!(problems.len(), 100_002);
}

const SEED: &str = r##"// é
Graph(version: 1, units: Mm, params: {"t": Number(default: 1.5, max: 3, unit: Length), "k": true,
    "c": Choice(default: Local, of: [Local, Global])}, nodes: {
    "m": Grid(cells: (2, "1 + 1"), origin: (0, -1e3, "t / 2")),
    "n": SmoothNormals(mesh: "m", iterations: "if(k and t > 1, min(3, 4), 2 ^ 3)"),
    "e": CompensateThickness(mesh: "m", directions: "n", thickness: "f", mode: "c"),
    "f": EvaluateField(mesh: "m", value: r#"sin(x) + uv * t"#), /* /* nested */ */
    "r": Rotate(mesh: "m", angle: "e.max_error", label: "\u{e9} {t} \x41 {{"),
    "j": JoinMeshes(meshes: ["r", "m.mesh"]),
}, outputs: {"out/j.glb": "j", "e.json": "e.solved"})
"##;

/// Pieces that matter to some part of the reader.
const PIECES: [&str; 24] = [
    "(", ")", "[", "]", "{", "}", ",", ":", "\"", "\\", "r#\"", "/*", "*/", "//", "\n", "é",
    "\u{200e}", "1e999", "Some(", "m", "^", "'", "b\"", "..",
];

fn mutated() -> impl Strategy<Value = Vec<u8>> {
    let edit = (
        0..SEED.len(),
        0..4usize,
        0..PIECES.len(),
        0..40usize,
        any::<u8>(),
    );
    proptest::collection::vec(edit, 1..5).prop_map(|edits| {
        let mut bytes = SEED.as_bytes().to_vec();
        for (place, action, piece, length, byte) in edits {
            let place = place.min(bytes.len());
            let end = (place + length).min(bytes.len());
            match action {
                0 => drop(bytes.splice(place..end, PIECES[piece].bytes())),
                1 => drop(bytes.splice(place..place, PIECES[piece].bytes())),
                2 => drop(bytes.drain(place..end)),
                _ => drop(bytes.splice(place..(place + 1).min(bytes.len()), [byte])),
            }
        }
        bytes
    })
}

/// Values that RON accepts wherever a text or a number may stand.
const VALUES: [&str; 28] = [
    "\"m\"",
    "\"n\"",
    "\"e.solved\"",
    "\"e.nothing\"",
    "\"t\"",
    "\"c\"",
    "\"j\"",
    "\"\"",
    "\"t * (2 +\"",
    "\"\\u{74} + é\"",
    "r#\"x + \"y\"\"#",
    "\"{t} {no}\"",
    "\"a\\\n  b\"",
    "-1e999",
    "NaN",
    "0",
    "2.5",
    "[\"m\", 1]",
    "(1, 2)",
    "(1, \"t\", x: 3)",
    "Some(\"m\")",
    "{1: 2}",
    "Local",
    "true",
    "'x'",
    "1..2",
    "b\"x\"",
    "Foo(a: /* ) */ 1)",
];

/// The places of texts and numbers in the seed.
fn literals() -> Vec<std::ops::Range<usize>> {
    let mut places = Vec::new();
    let mut at = SEED.find("Graph").unwrap();
    while let Some(length) = SEED[at..].find(|c: char| c == '"' || c.is_ascii_digit()) {
        let start = at + length;
        let rest = &SEED[start + 1..];
        at = match SEED.as_bytes()[start] {
            b'"' => start + 2 + rest.find('"').unwrap(),
            _ => {
                start
                    + 1
                    + rest
                        .find(|c: char| !c.is_ascii_alphanumeric() && c != '.')
                        .unwrap()
            }
        };
        places.push(start..at);
    }
    places
}

/// The seed with some of its texts and numbers replaced by other values.
fn replaced() -> impl Strategy<Value = String> {
    let places = literals();
    let edit = (0..places.len(), 0..VALUES.len());
    proptest::collection::btree_map(edit.0, edit.1, 1..5).prop_map(move |edits| {
        let mut text = SEED.to_owned();
        for (place, value) in edits.into_iter().rev() {
            text.replace_range(places[place].clone(), VALUES[value]);
        }
        text
    })
}

/// Whether the problems were found by looking at the graph, not at its syntax.
fn are_about_the_graph(problems: &[Diagnostic]) -> bool {
    !matches!(
        problems[0].code,
        "syntax" | "encoding" | "not_a_graph" | "bad_version"
    )
}

#[test]
fn replaced_values_reach_the_checks() {
    use proptest::strategy::ValueTree as _;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let reached = (0..200).filter(|_| {
        let text = replaced().new_tree(&mut runner).unwrap().current();
        let options = LoadOptions::default();
        load("g.ron", text.as_bytes(), NODES, &options)
            .map_or_else(|e| are_about_the_graph(&e), |_| true)
    });
    // Or the property below would say nothing about the checks.
    let reached = reached.count();
    assert!(reached > 120, "only {reached} of 200 get past the syntax");
}

#[test]
fn the_seed_is_sound() {
    plan(SEED);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutations_give_a_plan_or_placed_problems(bytes in mutated()) {
        if let Err(problems) = load("g.ron", &bytes, NODES, &LoadOptions::default()) {
            check_form(&problems);
        }
    }

    #[test]
    fn wrong_values_give_a_plan_or_placed_problems(text in replaced()) {
        if let Err(problems) = load("g.ron", text.as_bytes(), NODES, &LoadOptions::default()) {
            check_form(&problems);
            prop_assert!(problems.iter().all(|problem| problem.message != "this is not understood"));
        }
    }

    #[test]
    fn what_ron_accepts_is_walked_without_surprise(bytes in mutated()) {
        // The walk follows `ron`; where they disagreed it would say so.
        if let Err(problems) = load("g.ron", &bytes, NODES, &LoadOptions::default()) {
            prop_assert!(problems.iter().all(|problem| problem.message != "this is not understood"));
        }
    }
}

#[test]
fn what_is_no_graph_is_pointed_at_by_whole_characters() {
    for text in ["ҳt", "é", "☃(version: 1)", "é(", "\u{1f3db}", "1é"] {
        let problems = load("g.ron", text.as_bytes(), NODES, &LoadOptions::default());
        check_form(&problems.unwrap_err());
        check_form(&crate::study::Study::read("s.ron", text.as_bytes()).unwrap_err());
    }
}
