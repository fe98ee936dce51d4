//! Diagnostics as the page is told them.

use tessgraph_graph::{Diagnostic, Label, Lines, Severity};
use tessgraph_view::protocol::{Problem, ProblemLabel};

use crate::diagnostics::plain_text;

/// More of them than these of one run help nobody.
const MOST: usize = 200;

/// Diagnostics as the page is told them.
pub(super) fn problems(diagnostics: &[Diagnostic]) -> Vec<Problem> {
    diagnostics.iter().take(MOST).map(problem).collect()
}

fn problem(diagnostic: &Diagnostic) -> Problem {
    let lines = Lines::of(diagnostic.source.text());
    let label = |label: &Label| {
        let span = lines.valid(&label.span);
        let position = lines.position(span.start);
        ProblemLabel {
            message: label.message.clone(),
            line: position.line,
            column: position.column,
            span: [span.start, span.end],
        }
    };
    let labels: Vec<ProblemLabel> = diagnostic.labels.iter().map(label).collect();
    let first = labels.first();
    Problem {
        code: diagnostic.code.to_owned(),
        severity: match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        }
        .to_owned(),
        message: diagnostic.message.clone(),
        file: diagnostic.source.name().to_owned(),
        line: first.map_or(1, |label| label.line),
        column: first.map_or(1, |label| label.column),
        span: first.map_or([0, 0], |label| label.span),
        labels,
        help: diagnostic.help.clone(),
        rendered: plain_text(diagnostic),
    }
}
