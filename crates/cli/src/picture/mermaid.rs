//! The picture as Mermaid text, which many documentation tools draw.

use std::fmt::Write as _;

use super::model::{Picture, Role};

/// The picture as a Mermaid flowchart.
pub(crate) fn mermaid(picture: &Picture) -> String {
    let mut out = String::from("flowchart LR\n");
    for (index, item) in picture.boxes.iter().enumerate() {
        let lines: Vec<String> = item.lines.iter().map(|line| escape(line)).collect();
        let label = lines.join("<br/>");
        let (open, close) = match item.role {
            Role::Parameter => ("([", "])"),
            Role::Output => ("[/", "/]"),
            _ => ("[", "]"),
        };
        let class = item.role.name();
        let _ = writeln!(out, "  b{index}{open}\"{label}\"{close}:::{class}");
    }
    for edge in &picture.edges {
        let label = match edge.label.as_str() {
            "" => String::new(),
            label => format!("|\"{}\"|", escape(label)),
        };
        let _ = writeln!(out, "  b{} -->{label} b{}", edge.from, edge.to);
    }
    for role in Role::ALL {
        if picture.boxes.iter().any(|item| item.role == role) {
            let (fill, line) = role.light();
            let name = role.name();
            let _ = writeln!(
                out,
                "  classDef {name} fill:{fill},stroke:{line},color:#1a1a1a"
            );
        }
    }
    out
}

/// Text within quotes; Mermaid has escapes of its own, by number. Everything
/// that it, or the HTML it makes, could take for more than text is one.
fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '"' | '#' | '&' | '<' | '>' | '`' | '\\' | ';' | '%' => {
                let _ = write!(safe, "#{};", u32::from(character));
            }
            other => safe.push(other),
        }
    }
    safe
}
