//! The picture as text for Graphviz.

use std::fmt::Write as _;

use super::model::{Picture, Role};

/// The picture in the DOT language.
pub(crate) fn dot(picture: &Picture) -> String {
    let mut out = format!(
        "digraph {} {{\n  rankdir=LR;\n  node [shape=box, style=\"rounded,filled\", \
         fontname=\"monospace\"];\n",
        quoted(&picture.title)
    );
    for (index, item) in picture.boxes.iter().enumerate() {
        let (fill, line) = item.role.light();
        let shape = match item.role {
            Role::Parameter => ", style=\"rounded,filled,dashed\"",
            Role::Output => ", shape=note, style=filled",
            _ => "",
        };
        let _ = writeln!(
            out,
            "  b{index} [label={}, tooltip={}, fillcolor=\"{fill}\", color=\"{line}\"{shape}];",
            quoted(&item.lines.join("\n")),
            quoted(&item.tip),
        );
    }
    for edge in &picture.edges {
        let label = match edge.label.as_str() {
            "" => String::new(),
            label => format!(" [label={}]", quoted(label)),
        };
        let _ = writeln!(out, "  b{} -> b{}{label};", edge.from, edge.to);
    }
    out.push_str("}\n");
    out
}

/// A quoted string: only `"` and `\` mean something in it.
fn quoted(text: &str) -> String {
    let mut safe = String::from("\"");
    for character in text.chars() {
        match character {
            '"' => safe.push_str("\\\""),
            '\\' => safe.push_str("\\\\"),
            '\n' => safe.push_str("\\n"),
            other => safe.push(other),
        }
    }
    safe.push('"');
    safe
}
