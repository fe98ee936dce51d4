//! What is wrong with a graph, as data; only the command line prints it.

use std::ops::Range;
use std::sync::Arc;

/// A text that diagnostics point into.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    name: String,
    text: String,
}

impl Source {
    /// A text with the name a reader knows it by: its path as given.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            text: text.into(),
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The whole character at byte `at`; nothing at the end of the text, or inside
    /// a character.
    pub fn character(&self, at: usize) -> Range<usize> {
        let rest = self.text.get(at..).unwrap_or_default();
        at..at + rest.chars().next().map_or(0, char::len_utf8)
    }

    /// Line and column of a byte offset, both from 1; columns count characters.
    /// Cost: O(offset).
    pub fn position(&self, offset: usize) -> (usize, usize) {
        let mut end = offset.min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let before = &self.text[..end];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
        (line, before[line_start..].chars().count() + 1)
    }
}

/// How serious a diagnostic is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The graph cannot be run, or an output cannot be made.
    Error,
    /// The result stands, but deserves a look.
    Warning,
}

/// A place in the text with a remark.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Bytes of the text.
    pub span: Range<usize>,
    /// The remark.
    pub message: String,
}

/// A place in a text of its own, with a remark.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The text.
    pub source: Arc<Source>,
    /// Where in it, and the remark.
    pub label: Label,
}

/// One thing that is wrong, with its place and a way out.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// A stable name for this kind of problem: `wrong_kind`.
    pub code: &'static str,
    /// How serious it is.
    pub severity: Severity,
    /// What is wrong.
    pub message: String,
    /// The text it is in.
    pub source: Arc<Source>,
    /// The place, first, and any other places that explain it. Empty when the
    /// problem has no place in the text.
    pub labels: Vec<Label>,
    /// Places in other texts that explain it: where a graph was included, or
    /// what another graph declares.
    pub elsewhere: Vec<Place>,
    /// What to do about it.
    pub help: Option<String>,
    /// The node it is about, if it is about one.
    pub node: Option<String>,
}

impl Diagnostic {
    /// An error at `span` of `source`, with a remark at the place.
    pub fn error(
        code: &'static str,
        source: &Arc<Source>,
        span: Range<usize>,
        message: impl Into<String>,
        remark: impl Into<String>,
    ) -> Self {
        Self {
            code,
            severity: Severity::Error,
            message: message.into(),
            source: Arc::clone(source),
            labels: vec![Label {
                span,
                message: remark.into(),
            }],
            elsewhere: Vec::new(),
            help: None,
            node: None,
        }
    }

    /// Adds another place that explains the problem.
    #[must_use]
    pub fn with_label(mut self, span: Range<usize>, message: impl Into<String>) -> Self {
        self.labels.push(Label {
            span,
            message: message.into(),
        });
        self
    }

    /// Adds places in other texts.
    #[must_use]
    pub fn with_places(mut self, places: impl IntoIterator<Item = Place>) -> Self {
        self.elsewhere.extend(places);
        self
    }

    /// Adds a way out.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Says which node it is about.
    #[must_use]
    pub fn with_node(mut self, node: impl Into<String>) -> Self {
        self.node = Some(node.into());
        self
    }
}
