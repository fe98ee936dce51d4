//! Diagnostics in the shape that rustc gave them.

use std::borrow::Cow;

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use tessgraph_graph::{Diagnostic, Label, Lines, Place, Severity};

use crate::console::Console;
use crate::text::{count, printable};

/// More diagnostics than these of one run help nobody.
const MOST_SHOWN: usize = 50;

/// Longer pieces of text are not quoted: lines that nobody wrote by hand.
const LONGEST_QUOTE: usize = 16 << 10;

/// Labels over more lines than these are shown on their first line.
const MOST_LINES: usize = 6;

/// More places in other texts than these are not shown: deep inclusions.
const MOST_PLACES: usize = 6;

/// Width of the snippets; fixed, so that the text never depends on the terminal.
const WIDTH: usize = 120;

/// Shows diagnostics on stderr.
pub(crate) fn print(console: &mut Console<'_>, diagnostics: &[Diagnostic]) {
    let styled = console.is_styled();
    for diagnostic in diagnostics.iter().take(MOST_SHOWN) {
        let text = render(diagnostic, styled);
        console.note(&format!("{text}\n\n"));
    }
    if diagnostics.len() > MOST_SHOWN {
        let more = count(diagnostics.len() - MOST_SHOWN, "more diagnostic");
        console.note(&format!(
            "and {more}; `check --message-format json` gives all of them\n\n"
        ));
    }
}

/// One diagnostic as plain text, without a line feed at the end.
pub(crate) fn plain_text(diagnostic: &Diagnostic) -> String {
    render(diagnostic, false)
}

/// One diagnostic as text, without a line feed at the end.
pub(super) fn render(diagnostic: &Diagnostic, styled: bool) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let name = printable(diagnostic.source.name());
    let title = level
        .primary_title(printable(&diagnostic.message))
        .id(diagnostic.code);
    let lines = Lines::of(diagnostic.source.text());
    let mut group = Group::with_title(title);
    if diagnostic.labels.is_empty() && !name.is_empty() {
        group = group.element(Origin::path(name.as_ref()));
    }
    for piece in pieces(&lines, &diagnostic.labels) {
        group = with_piece(group, piece, &name);
    }
    for place in diagnostic.elsewhere.iter().take(MOST_PLACES) {
        group = with_piece(group, elsewhere(place), place.source.name());
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(printable(help)));
    }
    let renderer = if styled {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    renderer.term_width(WIDTH).render(&[group])
}

fn with_piece<'a>(group: Group<'a>, piece: Piece<'a>, name: &str) -> Group<'a> {
    let name = printable(name).into_owned();
    match piece {
        Piece::Quote {
            text,
            line,
            annotations,
        } => group.element(
            Snippet::source(text)
                .line_start(line)
                .path(name)
                .annotations(annotations),
        ),
        Piece::Place { line, column } => {
            group.element(Origin::path(name).line(line).char_column(column))
        }
    }
}

/// A place in another text.
fn elsewhere(place: &Place) -> Piece<'_> {
    let lines = Lines::of(place.source.text());
    let label = std::slice::from_ref(&place.label);
    quote(&lines, place.label.span.clone(), label, false).unwrap_or_else(|| {
        let position = lines.position(place.label.span.start);
        Piece::Place {
            line: position.line,
            column: position.column,
        }
    })
}

/// What is shown of the text.
enum Piece<'a> {
    /// Whole lines with their labels.
    Quote {
        text: Cow<'a, str>,
        line: usize,
        annotations: Vec<Annotation<'a>>,
    },
    /// Only where it is, for lines too long to show.
    Place { line: usize, column: usize },
}

/// The text around the labels: in one piece if they are close, else one each.
fn pieces<'a>(lines: &Lines<'a>, labels: &'a [Label]) -> Vec<Piece<'a>> {
    let start = labels.iter().map(|label| label.span.start).min();
    let end = labels.iter().map(|label| label.span.end).max();
    let (Some(start), Some(end)) = (start, end) else {
        return Vec::new();
    };
    if let Some(piece) = quote(lines, start..end, labels, true) {
        return vec![piece];
    }
    let single = |(index, label): (usize, &'a Label)| {
        let label_list = std::slice::from_ref(label);
        quote(lines, label.span.clone(), label_list, index == 0).unwrap_or_else(|| {
            let position = lines.position(label.span.start);
            Piece::Place {
                line: position.line,
                column: position.column,
            }
        })
    };
    labels.iter().enumerate().map(single).collect()
}

/// The lines that `span` touches with `labels` on them; `None` if that is more
/// than anybody reads.
fn quote<'a>(
    lines: &Lines<'a>,
    span: std::ops::Range<usize>,
    labels: &'a [Label],
    first_is_primary: bool,
) -> Option<Piece<'a>> {
    let (bytes, line) = lines.around(&span);
    if bytes.len() > LONGEST_QUOTE {
        return None;
    }
    let text = lines.text(bytes.clone());
    let annotation = |(index, label): (usize, &'a Label)| {
        let primary = index == 0 && first_is_primary;
        let kind = if primary {
            AnnotationKind::Primary
        } else {
            AnnotationKind::Context
        };
        let span = lines.valid(&label.span);
        let (start, end) = (span.start - bytes.start, span.end - bytes.start);
        let marked = &text[start..end];
        let end = match marked.find('\n') {
            Some(feed) if marked.matches('\n').count() >= MOST_LINES => start + feed,
            _ => end,
        };
        let annotation = kind.span(start..end);
        if label.message.is_empty() {
            annotation
        } else {
            annotation.label(printable(&label.message))
        }
    };
    let annotations = labels.iter().enumerate().map(annotation).collect();
    Some(Piece::Quote {
        text: quotable(text),
        line,
        annotations,
    })
}

/// `text` without the harmful characters that the renderer leaves in, each
/// replaced by a harmless one of as many bytes, so that spans stay right.
fn quotable(text: &str) -> Cow<'_, str> {
    let left_in = |character: char| {
        matches!(
            character,
            '\u{80}'..='\u{9f}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}'
        )
    };
    if !text.contains(left_in) {
        return Cow::Borrowed(text);
    }
    let harmless = |character: char| match (left_in(character), character.len_utf8()) {
        (false, _) => character,
        (true, 2) => '¿',
        (true, _) => char::REPLACEMENT_CHARACTER,
    };
    Cow::Owned(text.chars().map(harmless).collect())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tessgraph_graph::Source;

    use super::*;

    fn source(text: &str) -> Arc<Source> {
        Arc::new(Source::new("facade.ron", text))
    }

    #[test]
    fn shows_place_label_and_help() {
        let source = source("Graph(\n  \"é\": SmoothNormals(mesh: \"n\"),\n)\n");
        let text = source.text();
        let node = text.find("Smooth").unwrap();
        let mesh = text.find("\"n\"").unwrap();
        let diagnostic = Diagnostic::error(
            "wrong_kind",
            &source,
            mesh..mesh + 3,
            "`mesh` takes a mesh, but `n` gives directions",
            "directions",
        )
        .with_label(node..node + 13, "in this node")
        .with_help("give a mesh");
        let expected = "\
error[wrong_kind]: `mesh` takes a mesh, but `n` gives directions
 --> facade.ron:2:28
  |
2 |   \"é\": SmoothNormals(mesh: \"n\"),
  |        -------------       ^^^ directions
  |        |
  |        in this node
  |
  = help: give a mesh";
        assert_eq!(render(&diagnostic, false), expected);
    }

    #[test]
    fn a_file_as_a_whole_is_named() {
        let mut diagnostic = super::super::without_place("unreadable", "no.ron", "cannot read it");
        diagnostic.help = Some("look".to_owned());
        let text = render(&diagnostic, false);
        assert_eq!(
            text,
            "error[unreadable]: cannot read it\n--> no.ron\n = help: look"
        );
    }

    #[test]
    fn escape_codes_in_message_name_and_source_are_harmless() {
        let source = Arc::new(Source::new(
            "a\x1b[2J.ron",
            "\"x\x1b[31m\u{9b}31m\u{202e}\": 1\n",
        ));
        let diagnostic =
            Diagnostic::error("name", &source, 0..4, "bad \x1b[31mname", "he\x1b[0mre")
                .with_help("no \x07");
        let text = render(&diagnostic, false);
        assert!(!text.chars().any(crate::text::is_harmful), "{text:?}");
    }

    #[test]
    fn long_lines_and_far_places_stay_short() {
        let long = format!("a\n{}\nb: 1\n", "x".repeat(1 << 20));
        let source = source(&long);
        let end = long.len() - 5;
        let diagnostic = Diagnostic::error("code", &source, 2..2 + (1 << 20), "m", "here")
            .with_label(end..end + 1, "there");
        let text = render(&diagnostic, false);
        assert!(text.len() < 1000, "{}", text.len());
        assert!(
            text.contains("facade.ron:2:1") && text.contains("b: 1"),
            "{text}"
        );
    }

    #[test]
    fn spans_outside_the_text_do_no_harm() {
        let source = source("é");
        for span in [
            0..1,
            1..1,
            1..2,
            2..2,
            5..9,
            std::ops::Range { start: 9, end: 3 },
        ] {
            let diagnostic = Diagnostic::error("code", &source, span, "m", "here");
            assert!(render(&diagnostic, true).contains("code"));
        }
    }

    #[test]
    fn only_so_many_are_shown() {
        let diagnostics = vec![super::super::without_place("code", "a", "m"); 60];
        let (mut out, mut err) = (Vec::new(), Vec::new());
        print(&mut Console::plain(&mut out, &mut err), &diagnostics);
        let text = String::from_utf8(err).unwrap();
        assert_eq!(text.matches("error[code]").count(), 50);
        assert!(text.contains("and 10 more diagnostics"), "{text}");
    }
}
