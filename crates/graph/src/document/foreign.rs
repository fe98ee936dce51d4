//! Recognises texts of other formats, to say what they are.

use std::ops::Range;

/// What a text is instead of a graph: its place, what to say, what to do.
pub(super) struct Foreign {
    pub(super) span: Range<usize>,
    pub(super) message: &'static str,
    pub(super) help: &'static str,
}

/// What `text`, which is no graph, seems to be.
pub(super) fn recognise(text: &str) -> Option<Foreign> {
    let start = text.len() - text.trim_start().len();
    let first_line = first_line(text, start);
    let found = |span, message, help| {
        Some(Foreign {
            span,
            message,
            help,
        })
    };
    if text[start..].starts_with("version https://git-lfs") {
        let message = "this is a git-lfs pointer, not the graph file itself";
        return found(first_line, message, "fetch the file with `git lfs pull`");
    }
    if let Some(span) = merge_marker(text) {
        let message = "the file holds git merge conflict markers";
        return found(
            span,
            message,
            "choose one of the two versions and remove the markers",
        );
    }
    if text[start..].starts_with('<') {
        let message = "this looks like HTML or XML, not like a graph";
        return found(
            first_line,
            message,
            "was a web page saved instead of the file?",
        );
    }
    if looks_like_json(&text[start..]) {
        let message = "this looks like JSON; graphs are written in RON";
        return found(
            first_line,
            message,
            "write `Graph(version: 1, nodes: {...})`",
        );
    }
    if looks_like_yaml(text) {
        let message = "this looks like YAML; graphs are written in RON";
        return found(
            first_line,
            message,
            "write `Graph(version: 1, nodes: {...})`",
        );
    }
    let mesh = ["v ", "vn ", "o ", "mtllib ", "solid "]
        .iter()
        .any(|word| text[start..].starts_with(word));
    if mesh {
        let message = "this looks like a mesh, not like a graph";
        return found(
            first_line,
            message,
            "read it in a graph with `ReadMesh(path: ...)`",
        );
    }
    None
}

fn first_line(text: &str, start: usize) -> Range<usize> {
    // A file of one line may have millions of characters.
    let line = text[start..].lines().next().unwrap_or_default();
    let length = line.char_indices().nth(80).map_or(line.len(), |(at, _)| at);
    start..start + length
}

fn merge_marker(text: &str) -> Option<Range<usize>> {
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        if line.starts_with("<<<<<<< ") || line.starts_with(">>>>>>> ") {
            return Some(start..start + line.trim_end().len());
        }
        start += line.len();
    }
    None
}

/// An object with a quoted key, or a list of such.
fn looks_like_json(text: &str) -> bool {
    let inner = text.trim_start_matches(['[', '{', ' ', '\n', '\r', '\t']);
    text.starts_with(['{', '[']) && (inner.starts_with('"') || inner.starts_with(['}', ']']))
}

/// A document marker, or a first line like `nodes:`.
fn looks_like_yaml(text: &str) -> bool {
    let mut lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    lines.next().is_some_and(|line| {
        let key = line
            .split(": ")
            .next()
            .unwrap_or(line)
            .trim_end_matches(':');
        let is_key = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || c == '_');
        line.starts_with("---") || line.starts_with("%YAML") || (is_key && line.len() > key.len())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_named() {
        let cases = [
            (
                "version https://git-lfs.github.com/spec/v1\noid sha256:4d\n",
                "git-lfs",
            ),
            ("{\"nodes\": []}", "JSON"),
            ("[\n  {\"a\": 1}]", "JSON"),
            ("---\nnodes:\n", "YAML"),
            ("nodes:\n  a: 1\n", "YAML"),
            ("Graph(\n<<<<<<< HEAD\n  version: 1,\n=======\n", "merge"),
            ("<!DOCTYPE html>", "HTML"),
            ("v 0 0 0\nv 1 0 0\n", "mesh"),
        ];
        for (text, word) in cases {
            let found = recognise(text).unwrap_or_else(|| panic!("{text} is not recognised"));
            assert!(found.message.contains(word), "{text}: {}", found.message);
            assert!(text.get(found.span).is_some());
        }
        assert!(recognise("Graph(version: 1, nodes: {\"a\" 1})").is_none());
        assert!(recognise("(version: 1)").is_none());
    }
}
