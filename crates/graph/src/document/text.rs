//! Strings of a graph file: what they say, and where each character stands.

use std::ops::Range;

/// A string with its escapes undone and the places it comes from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Text {
    pub(crate) value: String,
    /// The whole string in the file, quotes included.
    pub(crate) span: Range<usize>,
    /// Starts of runs without escapes: offset in the value, offset in the file.
    runs: Vec<(usize, usize)>,
}

impl Text {
    /// The string at `span` of `source`; `None` if there is none.
    pub(super) fn read(source: &str, span: &Range<usize>) -> Option<Self> {
        let written = source.get(span.clone())?;
        let value: String = ron::from_str(written).ok()?;
        let quote = written.find('"')? + 1;
        let start = span.start + quote;
        if written.starts_with('r') || !written.contains('\\') {
            return Some(Self {
                value,
                span: span.clone(),
                runs: vec![(0, start)],
            });
        }
        let inner = written.get(quote..written.len().checked_sub(1)?)?;
        let runs = runs(inner, start, value.len()).unwrap_or_default();
        Some(Self {
            value,
            span: span.clone(),
            runs,
        })
    }

    /// The place of a part of the value in the file; of the whole string where
    /// it cannot be told.
    pub(crate) fn part(&self, part: Range<usize>) -> Range<usize> {
        let (Some(start), Some(end)) = (self.place(part.start), self.place(part.end)) else {
            return self.span.clone();
        };
        start.min(end)..end.max(start)
    }

    fn place(&self, offset: usize) -> Option<usize> {
        let run = self
            .runs
            .partition_point(|(start, _)| *start <= offset)
            .checked_sub(1)?;
        let (start, place) = self.runs[run];
        let place = place + (offset - start);
        // An offset inside an escape of several bytes has no place of its own.
        let limit = self
            .runs
            .get(run + 1)
            .map_or(self.span.end, |(_, next)| *next);
        Some(place.min(limit))
    }
}

/// Where runs of plain characters start, for a string with escapes whose value
/// has `length` bytes; `None` if the two do not fit together.
fn runs(inner: &str, start: usize, length: usize) -> Option<Vec<(usize, usize)>> {
    let mut runs = vec![(0, start)];
    let (mut read, mut written) = (0, 0);
    while let Some(plain) = inner[read..].find('\\') {
        read += plain;
        written += plain;
        let (taken, given) = escape(&inner[read..])?;
        runs.push((written, start + read));
        read += taken;
        written += given;
        runs.push((written, start + read));
    }
    runs.dedup_by(|later, earlier| {
        let same = later.0 == earlier.0;
        if same {
            *earlier = *later;
        }
        same
    });
    (written + inner[read..].len() == length).then_some(runs)
}

/// Bytes an escape takes in the file, and bytes of the character it stands for.
fn escape(text: &str) -> Option<(usize, usize)> {
    let kind = text[1..].chars().next()?;
    match kind {
        'u' => {
            let end = text.find('}')?;
            let digits = text.get(3..end)?;
            let character = char::from_u32(u32::from_str_radix(digits, 16).ok()?)?;
            Some((end + 1, character.len_utf8()))
        }
        'x' => {
            let first = u8::from_str_radix(text.get(2..4)?, 16).ok()?;
            // Beyond ASCII, several `\x` make up one character in UTF-8.
            let bytes = match first {
                0x00..=0x7f => 1,
                0xc0..=0xdf => 2,
                0xe0..=0xef => 3,
                _ => 4,
            };
            Some((4 * bytes, bytes))
        }
        '\n' | '\r' => {
            let rest = text[1..].trim_start_matches([' ', '\t', '\n', '\r']);
            Some((text.len() - rest.len(), 0))
        }
        _ => Some((2, 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place_of(source: &str, part: &str) -> String {
        let text = Text::read(source, &(0..source.len())).unwrap();
        let at = text.value.find(part).unwrap();
        source[text.part(at..at + part.len())].to_owned()
    }

    #[test]
    fn parts_are_found_behind_escapes() {
        assert_eq!(place_of(r#""a + b""#, "b"), "b");
        assert_eq!(place_of(r#""\u{61} + b""#, "b"), "b");
        assert_eq!(place_of(r#""\u{61} + b""#, "a"), r"\u{61}");
        assert_eq!(place_of(r#""\xc3\xa4 + b""#, "b"), "b");
        assert_eq!(place_of("\"a \\\n   + b\"", "b"), "b");
        assert_eq!(place_of(r###"r#"a + "b"#"###, "b"), "b");
        assert_eq!(place_of(r#""é\tb""#, "b"), "b");
    }
}
