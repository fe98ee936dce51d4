//! Lines and columns of byte offsets.

use std::ops::Range;

/// Where the lines of a text begin: many offsets are found in one text.
#[derive(Debug)]
pub struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

/// A line and a column, both from 1; columns count characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position {
    /// The line.
    pub line: usize,
    /// The column.
    pub column: usize,
}

impl<'a> Lines<'a> {
    /// The lines of `text`. Cost: O(text), once.
    pub fn of(text: &'a str) -> Self {
        let feeds = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let starts = std::iter::once(0)
            .chain(feeds.map(|(at, _)| at + 1))
            .collect();
        Self { text, starts }
    }

    /// Where `offset` is; offsets outside the text are at its end. Cost: O(line).
    pub fn position(&self, offset: usize) -> Position {
        let offset = self.boundary(offset);
        let line = self.starts.partition_point(|&start| start <= offset);
        let column = self.text[self.starts[line - 1]..offset].chars().count() + 1;
        Position { line, column }
    }

    /// The bytes of the lines that `span` touches, and the number of the first.
    pub fn around(&self, span: &Range<usize>) -> (Range<usize>, usize) {
        let first = self
            .starts
            .partition_point(|&start| start <= self.boundary(span.start));
        let start = self.starts[first - 1];
        let last = self.boundary(span.end.max(span.start));
        let end = self.text[last..]
            .find('\n')
            .map_or(self.text.len(), |feed| last + feed);
        (start..end, first)
    }

    /// The text of some bytes.
    ///
    /// # Panics
    /// If they lie outside the text, or not between characters.
    pub fn text(&self, bytes: Range<usize>) -> &'a str {
        &self.text[bytes]
    }

    /// `span` inside the text and between characters.
    pub fn valid(&self, span: &Range<usize>) -> Range<usize> {
        let start = self.boundary(span.start);
        start..self.boundary(span.end).max(start)
    }

    fn boundary(&self, offset: usize) -> usize {
        self.text.floor_char_boundary(offset.min(self.text.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = "façade\n  é x";
        let lines = Lines::of(text);
        let at = |offset| {
            let Position { line, column } = lines.position(offset);
            (line, column)
        };
        assert_eq!(at(0), (1, 1));
        assert_eq!(at(text.find("ade").unwrap()), (1, 4));
        assert_eq!(at(text.find('x').unwrap()), (2, 5));
        assert_eq!(at(10_000), (2, 6));
        assert_eq!(Lines::of("").position(0), Position { line: 1, column: 1 });
    }

    #[test]
    fn agrees_with_the_engine() {
        let text = "a\nßé\r\n\nend";
        let source = crate::Source::new("x", text);
        for offset in 0..text.len() + 3 {
            let Position { line, column } = Lines::of(text).position(offset);
            assert_eq!((line, column), source.position(offset), "at {offset}");
        }
    }

    #[test]
    fn whole_lines_around_a_span() {
        let lines = Lines::of("one\ntwo\nthree\n");
        assert_eq!(lines.around(&(5..6)), (4..7, 2));
        assert_eq!(lines.around(&(5..9)), (4..13, 2));
        assert_eq!(lines.around(&(99..99)), (14..14, 4));
        assert_eq!(lines.valid(&(9..200)), 9..14);
    }
}
