//! Rules of the house, held by tests.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use tessgraph_graph::reference;
use tessgraph_nodes::NODES;

use crate::support::{text_of, workspace};

fn metadata(arguments: &[&str]) -> Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version=1", "--locked"])
        .args(arguments)
        .current_dir(workspace())
        .output()
        .expect("cargo runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("metadata is JSON")
}

/// The platform the tests run on; crates for others are not downloaded.
fn host() -> String {
    let output = Command::new("rustc")
        .arg("-vV")
        .output()
        .expect("rustc runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = text.lines().find_map(|line| line.strip_prefix("host: "));
    line.expect("rustc names its host").to_owned()
}

fn texts<'a>(value: &'a Value, key: &str) -> Vec<&'a Value> {
    value[key]
        .as_array()
        .map(|items| items.iter().collect())
        .unwrap_or_default()
}

/// Our crates, and those of them that each may depend on.
const HOUSE: &[(&str, &[&str])] = &[
    ("tessgraph-geometry", &[]),
    ("tessgraph-macros", &[]),
    ("tessgraph-pages", &[]),
    ("tessgraph-bench", &["tessgraph-pages"]),
    ("tessgraph-io", &["tessgraph-geometry"]),
    ("tessgraph-graph", &["tessgraph-geometry"]),
    (
        "tessgraph-nodes",
        &[
            "tessgraph-geometry",
            "tessgraph-graph",
            "tessgraph-io",
            "tessgraph-macros",
        ],
    ),
    ("tessgraph-view", &["tessgraph-geometry", "tessgraph-graph"]),
    ("tessgraph-render", &["tessgraph-geometry", "tessgraph-io"]),
    (
        "tessgraph",
        &[
            "tessgraph-geometry",
            "tessgraph-graph",
            "tessgraph-io",
            "tessgraph-nodes",
            "tessgraph-pages",
            "tessgraph-render",
            "tessgraph-view",
        ],
    ),
];

#[test]
fn dependencies_point_one_way() {
    let allowed: BTreeMap<_, _> = HOUSE.iter().copied().collect();
    let metadata = metadata(&["--no-deps"]);
    let mut seen = 0;
    for package in texts(&metadata, "packages") {
        let name = package["name"].as_str().expect("packages have names");
        let Some(allowed) = allowed.get(name) else {
            assert_eq!(
                name, "tessgraph-tests",
                "a crate without a place in the house"
            );
            continue;
        };
        seen += 1;
        for dependency in texts(package, "dependencies") {
            let other = dependency["name"]
                .as_str()
                .expect("dependencies have names");
            let ours = other.starts_with("tessgraph");
            let test_only = dependency["kind"].as_str() == Some("dev");
            assert!(
                !ours || test_only || allowed.contains(&other),
                "{name} must not depend on {other}"
            );
        }
    }
    assert_eq!(seen, allowed.len());
}

#[test]
fn licences_of_dependencies_are_allowed() {
    let deny = text_of(&workspace().join("deny.toml"));
    let list = deny
        .split("allow = [")
        .nth(1)
        .and_then(|rest| rest.split(']').next());
    let allowed: BTreeSet<&str> = list
        .expect("deny.toml lists licences")
        .split('"')
        .skip(1)
        .step_by(2)
        .collect();
    for package in texts(&metadata(&["--filter-platform", &host()]), "packages") {
        let name = package["name"].as_str().expect("packages have names");
        let licence = package["license"]
            .as_str()
            .unwrap_or_default()
            .replace('/', " OR ");
        // Every term of an AND needs one allowed alternative of its OR.
        let fine = licence.replace(['(', ')'], "").split(" AND ").all(|term| {
            term.split(" OR ")
                .any(|alternative| allowed.contains(alternative.trim()))
        });
        assert!(fine, "{name} is licensed as `{licence}`");
    }
}

#[test]
fn every_node_file_is_listed_once() {
    let source = workspace().join("crates/nodes/src");
    let files: BTreeSet<String> = std::fs::read_dir(&source)
        .expect("crates/nodes/src")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_file() && !path.ends_with("lib.rs"))
        .map(|path| {
            path.file_stem()
                .expect("a name")
                .to_string_lossy()
                .replace('_', "")
        })
        .collect();
    let names: BTreeSet<String> = NODES.iter().map(|spec| spec.name.to_lowercase()).collect();
    assert_eq!(names.len(), NODES.len(), "a node is listed twice");
    assert_eq!(files, names);
}

#[test]
fn specs_are_sound() {
    let is_name = |name: &str| {
        name.starts_with(|c: char| c.is_ascii_lowercase())
            && name
                .chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
    };
    for spec in NODES {
        let first = reference::first_line(spec.doc);
        assert!(
            first.len() <= 80 && first.ends_with('.'),
            "{}: {first}",
            spec.name
        );
        for output in spec.outputs {
            let faults = output.faults.unwrap_or_default();
            let is_count = output.kind == tessgraph_graph::Kind::Integer;
            assert!(output.faults.is_none() || is_count, "{}", output.name);
            assert!(faults.iter().all(|name| spec.input(name).is_some()));
        }
        for input in spec.inputs {
            let place = format!("{}.{}", spec.name, input.name);
            assert!(is_name(input.name), "{place}");
            assert!(input.doc.ends_with('.'), "{place}: {}", input.doc);
            if let Some(default) = input.default {
                let value = default();
                let kind = value.kind();
                assert!(
                    input.kind.accepts(kind)
                        || matches!(
                            input.kind,
                            tessgraph_graph::Kind::Path | tessgraph_graph::Kind::List(_)
                        ),
                    "{place}: the default is {kind:?}"
                );
                if let tessgraph_graph::Value::Choice(name) = value {
                    assert!(
                        input.choices.iter().any(|choice| choice.name == name),
                        "{place}"
                    );
                }
            }
            if let Some((choice, values)) = input.only_with {
                let other = spec
                    .input(choice)
                    .unwrap_or_else(|| panic!("{place}: {choice}"));
                for value in values {
                    assert!(
                        other.choices.iter().any(|c| c.name == *value),
                        "{place}: {value}"
                    );
                }
            }
        }
        assert!(!spec.outputs.is_empty(), "{}", spec.name);
        for output in spec.outputs {
            assert!(is_name(output.name), "{}.{}", spec.name, output.name);
        }
    }
}

#[test]
fn the_reference_of_nodes_is_current() {
    let page = text_of(&workspace().join("docs/nodes.md"));
    assert!(
        page == reference::markdown(NODES),
        "docs/nodes.md is stale: `cargo run -- nodes --markdown > docs/nodes.md`"
    );
}

#[test]
fn only_the_program_prints() {
    for name in ["geometry", "io", "graph", "macros", "nodes"] {
        visit(
            &workspace().join("crates").join(name).join("src"),
            &mut |path, text| {
                let code = text.split("#[cfg(test)]").next().unwrap_or_default();
                let lines = code
                    .lines()
                    .filter(|line| !line.trim_start().starts_with("//"));
                for line in lines {
                    let prints = line.contains("println!") || line.contains("print!(");
                    let is_test = path.components().any(|part| {
                        let part = part.as_os_str().to_string_lossy();
                        part.contains("test") || part.contains("corpus") || part.contains("hostile")
                    });
                    assert!(!prints || is_test, "{}: {line}", path.display());
                }
            },
        );
    }
}

fn visit(folder: &Path, look: &mut dyn FnMut(&Path, &str)) {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            visit(&path, look);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            look(&path, &text_of(&path));
        }
    }
}
