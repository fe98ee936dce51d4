//! Every node's example runs, and its result is what a person judged right.

use tessgraph_graph::plan::ResultRef;
use tessgraph_nodes::NODES;

use crate::support::{self, Ran, workspace};

/// The RON example of a node's doc comment.
fn example(doc: &str) -> Option<&str> {
    let start = doc.find("```ron\n")? + "```ron\n".len();
    Some(&doc[start..start + doc[start..].find("```")?])
}

/// The example as a runnable graph: examples leave their outputs out.
fn runnable(example: &str) -> String {
    let body = example
        .trim_end()
        .strip_suffix("})")
        .expect("examples end with their nodes");
    format!("{body}}}, outputs: {{\"out.json\": \"out\"}})")
}

#[test]
fn every_node_has_an_example_of_itself() {
    for spec in NODES {
        let text = example(spec.doc).unwrap_or_else(|| panic!("{} has no example", spec.name));
        assert!(text.contains(&format!(": {}(", spec.name)), "{}", spec.name);
        assert!(text.contains("\"out\": "), "{}", spec.name);
    }
}

#[test]
fn examples() {
    let world = support::world_of(&workspace().join("graphs"));
    for spec in NODES {
        let text = runnable(example(spec.doc).expect("checked above"));
        let ran = Ran::run(support::load(spec.name, &text), &world);
        let node = ran.plan.node_index("out").expect("checked above");
        let named = |(result, output): (usize, &tessgraph_graph::node::OutputSpec)| {
            (output.name.to_owned(), ResultRef { node, result })
        };
        let results: Vec<_> = spec.outputs.iter().enumerate().map(named).collect();
        insta::with_settings!({snapshot_suffix => spec.name, omit_expression => true}, {
            insta::assert_snapshot!("example", ran.summary(&results));
        });
    }
}
