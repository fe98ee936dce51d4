//! Text for people: harmless on a terminal, rounded, aligned.

use std::borrow::Cow;
use std::fmt::Write as _;

/// `text` with everything escaped that a terminal could take for a command or
/// that would show the text in another order. Line feeds stay.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    if !text.chars().any(is_harmful) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        match character {
            '\t' => safe.push(' '),
            harmful if is_harmful(harmful) => safe.extend(harmful.escape_unicode()),
            other => safe.push(other),
        }
    }
    Cow::Owned(safe)
}

/// Whether a character is a control character other than a line feed, or turns
/// the direction of writing.
pub(crate) fn is_harmful(character: char) -> bool {
    (character.is_control() && character != '\n')
        || matches!(character, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Bytes as "312 B", "14.2 kB", "1.25 GB"; powers of 1000.
pub(crate) fn bytes_text(bytes: u64) -> String {
    if bytes < 1000 {
        return format!("{bytes} B");
    }
    let mut amount = bytes as f64;
    let mut unit = "B";
    for next in ["kB", "MB", "GB", "TB"] {
        // 999.95 would be shown as 1000.0; go on to the next unit instead.
        if amount < 999.95 {
            break;
        }
        (amount, unit) = (amount / 1000.0, next);
    }
    format!("{} {unit}", three_digits(amount))
}

/// Milliseconds as "<0.1 ms", "12 ms", "0.8 s", "2 min 5 s".
pub(crate) fn time_text(ms: f64) -> String {
    if ms > 0.0 && ms < 0.05 {
        "<0.1 ms".to_owned()
    } else if ms < 99.95 {
        format!("{} ms", three_digits(ms))
    } else if ms < 59_950.0 {
        format!("{} s", three_digits(ms / 1000.0))
    } else {
        let seconds = (ms / 1000.0).round() as u64;
        format!("{} min {} s", seconds / 60, seconds % 60)
    }
}

/// Three significant digits at most, one decimal at most: 0.3, 14.2, 250.
fn three_digits(amount: f64) -> String {
    let digits = if amount < 99.95 { 1 } else { 0 };
    let text = format!("{amount:.digits$}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A word of a command that a shell takes as it is: in quotes if it must be.
pub(crate) fn argument(word: &str) -> Cow<'_, str> {
    let plain = |c: char| c.is_alphanumeric() || "-_./+=:,@%\\".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return Cow::Borrowed(word);
    }
    if cfg!(windows) {
        return Cow::Owned(format!("\"{word}\""));
    }
    Cow::Owned(format!("'{}'", word.replace('\'', r"'\''")))
}

/// "1 node", "3 nodes".
pub(crate) fn count(number: usize, noun: &str) -> String {
    if number == 1 {
        format!("1 {noun}")
    } else {
        format!("{number} {noun}s")
    }
}

/// On which side a column of a table is flush.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    /// Text.
    Left,
    /// Numbers.
    Right,
}

/// Rows with their columns aligned, two blanks between them, no blanks at the
/// ends of lines.
pub(crate) fn table(rows: &[Vec<String>], align: &[Align]) -> String {
    let width = |column: usize| {
        let widths = rows
            .iter()
            .filter_map(|row| row.get(column))
            .map(|cell| cell.chars().count());
        widths.max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..align.len()).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (cell, (align, width)) in row.iter().zip(align.iter().zip(&widths)) {
            let _ = match align {
                Align::Left => write!(line, "{cell:<width$}  "),
                Align::Right => write!(line, "{cell:>width$}  "),
            };
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escape_codes_never_stay() {
        let text = printable("a\x1b[31mb\u{9b}c\u{202e}d\te\nf");
        assert_eq!(text, "a\\u{1b}[31mb\\u{9b}c\\u{202e}d e\nf");
        assert!(matches!(printable("façade"), Cow::Borrowed(_)));
    }

    #[test]
    fn sizes_and_times_have_three_digits_at_most() {
        let sizes: Vec<_> = [0, 999, 1000, 14_210, 999_949, 999_999, 1_250_000_000]
            .map(bytes_text)
            .into();
        assert_eq!(
            sizes,
            [
                "0 B", "999 B", "1 kB", "14.2 kB", "1000 kB", "1 MB", "1.2 GB"
            ]
        );
        let times: Vec<_> = [0.04, 0.3, 12.34, 250.4, 999.9, 61_000.0]
            .map(time_text)
            .into();
        assert_eq!(
            times,
            ["<0.1 ms", "0.3 ms", "12.3 ms", "0.3 s", "1 s", "1 min 1 s"]
        );
    }

    #[test]
    fn tables_align() {
        let rows = [
            vec!["a".into(), "10".into()],
            vec!["bcd".into(), "2".into()],
        ];
        assert_eq!(
            table(&rows, &[Align::Left, Align::Right]),
            "a    10\nbcd   2\n"
        );
    }
}
