//! Checks of whole graphs against a small registry.

mod errors;
mod faults;
mod includes;
mod registry;
mod sound;
mod stress;

use std::fmt::Write as _;

use super::{LoadOptions, load};
use crate::{Diagnostic, Plan};
use registry::NODES;

/// The plan of a graph that must be sound.
fn plan(text: &str) -> Plan {
    plan_with(text, &[])
}

fn plan_with(text: &str, set: &[(&str, &str)]) -> Plan {
    match load("test.ron", text.as_bytes(), NODES, &options(set)) {
        Ok(plan) => plan,
        Err(problems) => panic!("{text}\nis refused:\n{}", render(text, &problems)),
    }
}

/// The problems of a graph that must be refused, as text.
fn problems(text: &str) -> String {
    problems_with(text, &[])
}

fn problems_with(text: &str, set: &[(&str, &str)]) -> String {
    match load("test.ron", text.as_bytes(), NODES, &options(set)) {
        Ok(_) => panic!("{text}\nis accepted"),
        Err(problems) => {
            check_form(&problems);
            render(text, &problems)
        }
    }
}

fn options(set: &[(&str, &str)]) -> LoadOptions {
    let owned = set
        .iter()
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
    LoadOptions {
        set: owned.collect(),
    }
}

/// What every diagnostic must be: placed inside its text, with a way out, and
/// harmless on a terminal.
fn check_form(problems: &[Diagnostic]) {
    assert!(!problems.is_empty());
    for problem in problems {
        assert!(problem.help.is_some(), "no help: {}", problem.message);
        let texts = [&problem.message, problem.help.as_ref().unwrap()];
        let remarks = problem.labels.iter().map(|label| &label.message);
        for text in texts.into_iter().chain(remarks) {
            assert!(
                !text.is_empty() && !text.chars().any(char::is_control),
                "{text:?}"
            );
        }
        for label in &problem.labels {
            let text = problem.source.text();
            assert!(
                text.get(label.span.clone()).is_some(),
                "{label:?} is outside the text"
            );
        }
    }
    let places = problems
        .iter()
        .map(|problem| problem.labels.first().map(|label| label.span.start));
    assert!(places.is_sorted(), "not in the order of their places");
}

/// One line for each problem, each of its places, and its help.
fn render(text: &str, problems: &[Diagnostic]) -> String {
    let mut out = String::new();
    for problem in problems {
        let _ = writeln!(out, "{}: {}", problem.code, problem.message);
        for label in &problem.labels {
            let (line, column) = problem.source.position(label.span.start);
            let part = text.get(label.span.clone()).unwrap_or("(other text)");
            let part = part.split_whitespace().collect::<Vec<_>>().join(" ");
            let _ = writeln!(out, "  {line}:{column} {part} <- {}", label.message);
        }
        let _ = writeln!(out, "  help: {}", problem.help.as_deref().unwrap_or("none"));
    }
    out
}
