//! Diagnostics for programs: one JSON object a line.

use serde_json::{Value, json};
use tessgraph_graph::{Diagnostic, Label, Lines, Severity};

use crate::json::line;

/// One object a line with `code`, `severity`, `message`, `file`, `line`,
/// `column`, `span`, `labels`, `elsewhere` and `help`.
///
/// `line`, `column` and `span` are those of the first label, and null when the
/// problem has no place in the text. Columns count characters from 1, spans
/// bytes from 0.
pub(crate) fn lines(diagnostics: &[Diagnostic]) -> String {
    let mut text = String::new();
    // Diagnostics of one text come in a row: its lines are found once.
    for group in
        diagnostics.chunk_by(|one, other| std::sync::Arc::ptr_eq(&one.source, &other.source))
    {
        let lines = Lines::of(group[0].source.text());
        for diagnostic in group {
            text.push_str(&line(&object(diagnostic, &lines)));
            text.push('\n');
        }
    }
    text
}

fn object(diagnostic: &Diagnostic, lines: &Lines<'_>) -> Value {
    let labels: Vec<Value> = diagnostic
        .labels
        .iter()
        .map(|label| label_object(label, lines))
        .collect();
    let elsewhere = diagnostic.elsewhere.iter().map(|place| {
        let mut object = label_object(&place.label, &Lines::of(place.source.text()));
        object["file"] = json!(place.source.name());
        object
    });
    let elsewhere: Vec<Value> = elsewhere.collect();
    let first = labels.first().cloned().unwrap_or_default();
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    json!({
        "code": diagnostic.code,
        "severity": severity,
        "message": diagnostic.message,
        "file": diagnostic.source.name(),
        "line": first["line"],
        "column": first["column"],
        "span": first["span"],
        "labels": labels,
        "elsewhere": elsewhere,
        "help": diagnostic.help,
    })
}

fn label_object(label: &Label, lines: &Lines<'_>) -> Value {
    let position = lines.position(label.span.start);
    json!({
        "message": label.message,
        "line": position.line,
        "column": position.column,
        "span": [label.span.start, label.span.end],
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tessgraph_graph::Source;

    use super::*;

    #[test]
    fn has_the_documented_shape() {
        let source = Arc::new(Source::new("g.ron", "é\né: x y"));
        let diagnostic = Diagnostic::error("code", &source, 7..8, "what", "here")
            .with_label(9..10, "there")
            .with_help("do");
        let expected = concat!(
            r#"{"code":"code","severity":"error","message":"what","file":"g.ron","line":2,"#,
            r#""column":4,"span":[7,8],"labels":[{"message":"here","line":2,"column":4,"#,
            r#""span":[7,8]},{"message":"there","line":2,"column":6,"span":[9,10]}],"#,
            r#""elsewhere":[],"help":"do"}"#,
            "\n"
        );
        assert_eq!(lines(&[diagnostic]), expected);
    }

    #[test]
    fn without_a_place_the_place_is_null() {
        let text = lines(&[super::super::without_place("code", "g.ron", "m")]);
        let object: Value = serde_json::from_str(&text).unwrap();
        assert!(object["line"].is_null() && object["span"].is_null() && object["help"].is_null());
        assert_eq!(object["labels"], json!([]));
    }
}
