//! Diagnostics for people and for programs.

mod human;
mod json;

use std::sync::Arc;

use tessgraph_graph::{Diagnostic, Severity, Source};

pub(crate) use human::{plain_text, print};
pub(crate) use json::lines;

/// An error about a file as a whole, or about no file when `name` is empty.
pub(crate) fn without_place(
    code: &'static str,
    name: &str,
    message: impl Into<String>,
) -> Diagnostic {
    Diagnostic {
        code,
        severity: Severity::Error,
        message: message.into(),
        source: Arc::new(Source::new(name, "")),
        labels: Vec::new(),
        elsewhere: Vec::new(),
        help: None,
        node: None,
    }
}

/// How many of `diagnostics` are errors.
pub(crate) fn error_count(diagnostics: &[Diagnostic]) -> usize {
    diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.severity == Severity::Error)
        .count()
}
