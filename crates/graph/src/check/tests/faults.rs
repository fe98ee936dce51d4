//! Files that are no graphs, or broken ones.

use std::time::{Duration, Instant};

use super::*;

fn first(bytes: &[u8]) -> Diagnostic {
    let start = Instant::now();
    let problems = load("g.ron", bytes, NODES, &LoadOptions::default()).unwrap_err();
    assert!(
        start.elapsed() < Duration::from_secs(1),
        "took {:?}",
        start.elapsed()
    );
    check_form(&problems);
    problems.into_iter().next().unwrap()
}

#[test]
fn broken_syntax_is_pointed_at() {
    let cases = [
        "Graph(version: 1, nodes: {\"a\": Grid(",
        "Graph(version: 1, nodes: {\"a\": Grid()",
        "Graph(version: 1, nodes: {\"a\" Grid()})",
        "Graph(version: 1 nodes: {})",
        "Graph(version: 1, nodes: {\"a: Grid()})",
        "Graph(version: 1, nodes: {\"a\": ReadMesh(path: r#\"abc\")})",
        "Graph(version: 1) trailing",
        "Graph(version: 1, /* /* */ nodes: {})",
        "Graph(version: 1, nodes: {\"a\": ReadMesh(path: \"C:\\qq\")})",
        "Graph(version: 1, nodes: [)",
        "#![enable(magic)]\nGraph(version: 1)",
        "Graph(version: 1, nodes: {\"a\": @})",
    ];
    let said: Vec<String> = cases
        .iter()
        .map(|case| format!("{case}\n{}\n", problems(case)))
        .collect();
    insta::assert_snapshot!(said.join(""));
}

#[test]
fn what_is_no_graph_is_named() {
    let cases = [
        "(nodes: [(id: \"a\u{1b}[2Jb\")])",
        "(aaaa)",
        "()",
        "Graph()",
        "Graph",
        "42",
        "{\"nodes\": []}",
        "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n",
        "nodes:\n  - a\n",
        "Graph(version: 1,\n<<<<<<< HEAD\n    units: M,\n=======\n    units: Cm,\n>>>>>>> other\n)",
        "Study(version: 1, graph: \"a.ron\")",
        "Garph(version: 1)",
        "Graph(nodes: {})",
        "Graph(version: 2, anything: [(goes)])",
        "Graph(version: 0)",
        "Graph(version: \"1\")",
        "Graph(version: 1, nodse: {}, units: Inch, nodes: [], units: M)",
    ];
    let said: Vec<String> = cases
        .iter()
        .map(|case| format!("{}\n{}\n", case.escape_debug(), problems(case)))
        .collect();
    insta::assert_snapshot!(said.join(""));
}

#[test]
fn nesting_of_any_depth_is_refused_in_time() {
    let start = "Graph(version: 1, nodes: {\"a\": Grid(cells: ";
    for open in ["(", "[", "{", "Some(", "{0:", "[[({\"a\":"] {
        for text in [
            open.repeat(100_000),
            format!("{start}{}", open.repeat(100_000)),
        ] {
            let problem = first(text.as_bytes());
            assert_eq!(problem.code, "syntax", "{}", problem.message);
        }
    }
    let comment = format!("{}{}", "/*".repeat(100_000), "*/".repeat(100_000));
    assert_eq!(first(comment.as_bytes()).code, "syntax");
    let brackets = format!("{}1{}", "(".repeat(100_000), ")".repeat(100_000));
    for expression in [
        brackets,
        "(".repeat(30_000),
        "-".repeat(30_000),
        "1^".repeat(15_000),
    ] {
        let text = format!(
            "Graph(version: 1, nodes: {{\"a\": Rotate(mesh: \"a\", angle: \"{expression}\")}})"
        );
        assert_eq!(first(text.as_bytes()).code, "no_outputs");
        let problems = load("g.ron", text.as_bytes(), NODES, &LoadOptions::default()).unwrap_err();
        assert!(
            problems
                .iter()
                .any(|problem| problem.code == "bad_expression")
        );
    }
}

#[test]
fn huge_names_and_numbers_stay_out_of_messages() {
    let huge = "a".repeat(1_000_000);
    for text in [
        format!("({huge})"),
        format!("({huge}: 1)"),
        format!("{huge}(version: 1)"),
        format!("Graph(version: 1, units: {huge})"),
        format!("Graph(version: 1, nodes: {{\"{huge}\": {huge}({huge}: {huge})}})"),
        format!("Graph(version: 1, nodes: {{\"a\": Rotate(mesh: \"{huge}\", angle: \"{huge}\")}})"),
        format!(
            "Graph(version: 1, outputs: {{\"{}\": \"b\"}})",
            "a/".repeat(500_000)
        ),
        format!("Graph(version: {})", "9".repeat(5000)),
        format!("#![enable({huge})] ()"),
    ] {
        let problems = load("g.ron", text.as_bytes(), NODES, &LoadOptions::default()).unwrap_err();
        check_form(&problems);
        for problem in problems {
            let help = problem.help.unwrap_or_default();
            assert!(
                problem.message.len() + help.len() < 1000,
                "{}",
                problem.message
            );
        }
    }
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    assert_eq!(first(b"").code, "empty");
    assert_eq!(first(b"\xef\xbb\xbf").code, "empty");
    assert_eq!(
        first(b"(nodes: [(id: \"\xff\xfe\")])").message,
        "the graph file is not UTF-8: byte 15 is 0xff"
    );
    assert_eq!(first(b"(nodes\0: [])").labels[0].span, 6..7);
    let binary: Vec<u8> = (0..=255).cycle().take(4096).collect();
    assert_eq!(first(&binary).code, "encoding");
}
