//! Lets `ron` judge the syntax, and says what it found in our words.

use std::ops::Range;
use std::sync::Arc;

use ron::error::{Error, Position, SpannedError};
use serde::de::IgnoredAny;

use super::foreign;
use super::raw::Item;
use super::walk::{Stop, walk};
use crate::diagnostic::{Diagnostic, Source};
use crate::names::shown;

/// The places of everything in the text, or its first mistake of syntax.
pub(super) fn parse(source: &Arc<Source>) -> Result<Item, Box<Diagnostic>> {
    let text = source.text();
    if let Err(error) = ron::Options::default().from_str::<IgnoredAny>(text) {
        return Err(Box::new(match foreign::recognise(text) {
            Some(found) => {
                Diagnostic::error("not_a_graph", source, found.span, found.message, "here")
                    .with_help(found.help)
            }
            None => translate(source, &error),
        }));
    }
    walk(text).map_err(|stop| {
        Box::new(match stop {
            Stop::Unexpected(at) => {
                let span = character_at(text, at);
                Diagnostic::error("syntax", source, span, "this is not understood", "here")
                    .with_help("write it in a simpler way")
            }
            Stop::TooMany => {
                let message = "the graph file holds more than two million values";
                Diagnostic::error("too_large", source, 0..0, message, "in this file")
                    .with_help("keep large data in meshes and tables, and read them with nodes")
            }
        })
    })
}

fn translate(source: &Arc<Source>, error: &SpannedError) -> Diagnostic {
    let text = source.text();
    let at = offset(text, error.span.end);
    let at_end = text[at..].trim().is_empty();
    let is_open = !matches!(
        error.code,
        Error::UnclosedBlockComment | Error::ExpectedStringEnd
    );
    if at_end
        && is_open
        && let Some((open, sign)) = unclosed_bracket(text)
    {
        let message = format!("the file ends before this `{sign}` is closed");
        let close = match sign {
            '(' => ')',
            '[' => ']',
            _ => '}',
        };
        return Diagnostic::error("syntax", source, open..open + 1, message, "never closed")
            .with_help(format!("add a `{close}`; was the file only half written?"));
    }
    let (message, help) = describe(&error.code);
    let span = match error.code {
        Error::UnclosedBlockComment => last_comment(text),
        Error::ExpectedStringEnd => string_start(text, at),
        Error::NoSuchExtension(ref name) if text[..at].contains(name.as_str()) => {
            let start = text[..at].rfind(name.as_str()).unwrap_or(at);
            start..start + name.len()
        }
        _ => character_at(text, at),
    };
    let error = Diagnostic::error("syntax", source, span, message, "here");
    match help {
        Some(help) => error.with_help(help),
        None => error,
    }
}

/// What the error says, and a way out.
fn describe(error: &Error) -> (String, Option<&'static str>) {
    let plain = |text: &str, help| (text.to_owned(), Some(help));
    match error {
        Error::ExpectedComma => plain("expected a comma or a closing bracket", "add a `,`"),
        Error::ExpectedMapColon => plain("expected a colon", "write `name: value`"),
        Error::ExpectedArrayEnd => plain("expected `]`", "close the list with `]`"),
        Error::ExpectedMapEnd => plain("expected `}`", "close the map with `}`"),
        Error::ExpectedStructLikeEnd | Error::ExpectedOptionEnd => {
            plain("expected `)`", "close the bracket with `)`")
        }
        Error::ExpectedStringEnd => plain("this text is never closed", "add a `\"`"),
        Error::UnclosedBlockComment => plain("this comment is never closed", "add `*/`"),
        Error::ExpectedIdentifier => plain(
            "expected a name",
            "names of fields are written without quotes",
        ),
        Error::TrailingCharacters => plain(
            "the graph ends before this",
            "remove what follows, or move it inside",
        ),
        Error::ExceededRecursionLimit => plain(
            "brackets are nested too deeply",
            "no graph needs more than a few levels",
        ),
        Error::Eof => plain("the file ends too early", "was it only half written?"),
        Error::InvalidEscape(_) => plain(
            "this escape is not known in a text",
            "a backslash is written `\\\\`; a path may use `/`",
        ),
        Error::UnexpectedChar(character) => {
            let shown = character.escape_debug();
            (
                format!("`{shown}` is not expected here"),
                Some("write a value"),
            )
        }
        Error::NoSuchExtension(name) => (
            format!("there is no RON extension `{}`", shown(name)),
            Some("remove this line"),
        ),
        other => (
            shown_sentence(&other.to_string()),
            Some("see the RON syntax: `name: value`"),
        ),
    }
}

/// A message of `ron`, cut and freed of control characters.
fn shown_sentence(text: &str) -> String {
    text.split(' ').map(shown).collect::<Vec<_>>().join(" ")
}

/// The byte offset of a line and column, both from 1, columns in characters.
fn offset(text: &str, position: Position) -> usize {
    let mut start = 0;
    for _ in 1..position.line {
        match text[start..].find('\n') {
            Some(length) => start += length + 1,
            None => return text.len(),
        }
    }
    let mut characters = text[start..].char_indices();
    characters
        .nth(position.col.saturating_sub(1))
        .map_or(text.len(), |(at, _)| start + at)
}

/// The character at `at`; the empty place at the end of the text.
fn character_at(text: &str, at: usize) -> Range<usize> {
    let length = text
        .get(at..)
        .and_then(|rest| rest.chars().next())
        .map_or(0, char::len_utf8);
    at.min(text.len())..at.min(text.len()) + length
}

/// From the quote before `at` to the end of its line, or a part of it.
fn string_start(text: &str, at: usize) -> Range<usize> {
    let start = text[..at].rfind('"').unwrap_or(at);
    let line = text[start..].lines().next().unwrap_or_default();
    let length = line.char_indices().nth(80).map_or(line.len(), |(at, _)| at);
    start..start + length
}

fn last_comment(text: &str) -> Range<usize> {
    let start = Scan::new(text).run().comment.unwrap_or(0);
    start..(start + 2).min(text.len())
}

/// The innermost bracket that is still open at the end of the text.
fn unclosed_bracket(text: &str) -> Option<(usize, char)> {
    Scan::new(text).run().open.last().copied()
}

/// A rough reading of a broken text: brackets outside of texts and comments.
#[derive(Default)]
struct Scan<'a> {
    text: &'a str,
    open: Vec<(usize, char)>,
    /// Where a comment starts that never ends.
    comment: Option<usize>,
}

impl<'a> Scan<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            text,
            ..Self::default()
        }
    }

    fn run(mut self) -> Self {
        let mut at = 0;
        while let Some(length) = self.text[at..].find(['"', '/', '(', '[', '{', ')', ']', '}']) {
            at += length;
            at = self.sign(at);
        }
        self
    }

    /// Deals with the sign at `at`; where to go on.
    fn sign(&mut self, at: usize) -> usize {
        let rest = &self.text[at..];
        if rest.starts_with('"') {
            return self.string(at);
        }
        if rest.starts_with("//") {
            return at + rest.find('\n').unwrap_or(rest.len());
        }
        if rest.starts_with("/*") {
            return self.block_comment(at);
        }
        match rest.chars().next() {
            Some(sign @ ('(' | '[' | '{')) => self.open.push((at, sign)),
            Some(')' | ']' | '}') => drop(self.open.pop()),
            _ => {}
        }
        at + 1
    }

    /// The end of the text that starts with the quote at `at`.
    fn string(&self, at: usize) -> usize {
        let before = &self.text[..at];
        let hashes = before.len() - before.trim_end_matches('#').len();
        if before[..at - hashes].ends_with('r') {
            let ending = format!("\"{}", "#".repeat(hashes));
            let end = self.text[at + 1..].find(&ending);
            return end.map_or(self.text.len(), |length| at + 1 + length + ending.len());
        }
        let mut escaped = false;
        for (length, character) in self.text[at + 1..].char_indices() {
            if character == '"' && !escaped {
                return at + 1 + length + 1;
            }
            escaped = character == '\\' && !escaped;
        }
        self.text.len()
    }

    fn block_comment(&mut self, start: usize) -> usize {
        let (mut level, mut at) = (0, start);
        while let Some(length) = self.text[at..].find(['/', '*']) {
            at += length;
            if self.text[at..].starts_with("/*") {
                (level, at) = (level + 1, at + 2);
            } else if self.text[at..].starts_with("*/") {
                (level, at) = (level - 1, at + 2);
                if level == 0 {
                    return at;
                }
            } else {
                at += 1;
            }
        }
        self.comment = Some(start);
        self.text.len()
    }
}
