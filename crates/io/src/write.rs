//! What writers give, and text made fast.

use std::io;

use zmij::Buffer;

use crate::error::IoError;

/// Bytes of a written file, and what it could not hold.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The file's content.
    pub bytes: Vec<u8>,
    /// What of the mesh the format has no place for, a sentence each without a
    /// full stop.
    pub warnings: Vec<String>,
}

impl Written {
    /// What a writer gives that streams to a sink, kept in memory.
    pub(crate) fn of(
        write: impl FnOnce(&mut dyn io::Write) -> Result<Vec<String>, IoError>,
    ) -> Result<Self, IoError> {
        let mut bytes = Vec::new();
        let warnings = write(&mut bytes)?;
        Ok(Self { bytes, warnings })
    }
}

/// The encoding of a file that has both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TextOrBinary {
    /// Small and fast.
    #[default]
    Binary,
    /// Readable; numbers in the fewest digits that read back exactly.
    Text,
}

/// Text that is being written.
pub(crate) struct Text<'a> {
    bytes: &'a mut Vec<u8>,
}

impl<'a> Text<'a> {
    /// Text that comes after `bytes`.
    pub(crate) fn at_end_of(bytes: &'a mut Vec<u8>) -> Self {
        Self { bytes }
    }

    #[inline]
    pub(crate) fn text(&mut self, text: &str) -> &mut Self {
        self.bytes.extend_from_slice(text.as_bytes());
        self
    }

    /// A finite number in the fewest digits that read back as the same number.
    #[inline]
    pub(crate) fn float(&mut self, value: f64) -> &mut Self {
        let mut buffer = Buffer::new();
        let digits = buffer.format_finite(value).as_bytes();
        self.bytes
            .extend_from_slice(digits.strip_suffix(b".0").unwrap_or(digits));
        self
    }

    #[inline]
    pub(crate) fn integer(&mut self, value: u64) -> &mut Self {
        if value < 100_000_000 {
            let digits = eight_digits(value as u32);
            // Leading zeros are the low bytes; of 0 itself one stays.
            let skip = (digits.trailing_zeros() / 8).min(7);
            let text = (digits | 0x3030_3030_3030_3030) >> (8 * skip);
            // Copying a fixed length is one store; what is too much is cut.
            self.bytes.extend_from_slice(&text.to_le_bytes());
            self.bytes.truncate(self.bytes.len() - skip as usize);
            return self;
        }
        self.bytes.extend_from_slice(value.to_string().as_bytes());
        self
    }
}

/// The eight decimal digits of `value` < 10⁸ as bytes 0..=9, the first digit
/// in the lowest byte.
#[inline]
fn eight_digits(value: u32) -> u64 {
    // Split in halves three times: four digits each, two each, one each.
    let (high, low) = (u64::from(value / 10_000), u64::from(value % 10_000));
    let fours = high | low << 32;
    let hundreds = ((fours * 10_486) >> 20) & 0x0000_007f_0000_007f;
    let twos = hundreds | (fours - hundreds * 100) << 16;
    let tens = ((twos * 103) >> 10) & 0x000f_000f_000f_000f;
    tens | (twos - tens * 10) << 8
}

/// `name` as one line of a text file can hold it: control characters become
/// `_`, blanks at the ends go, what would start a comment or join lines
/// becomes `_`. With `one_word`, blanks become `_` too.
pub(crate) fn plain_name(name: &str, one_word: bool) -> String {
    let mut out = String::with_capacity(name.len());
    let mut after_blank = true;
    for c in name.trim().chars() {
        let bad = c.is_control() || (c == '#' && after_blank) || (one_word && c.is_whitespace());
        out.push(if bad { '_' } else { c });
        after_blank = c == ' ';
    }
    if out.ends_with('\\') {
        out.pop();
        out.push('_');
    }
    if out.is_empty() { "_".to_owned() } else { out }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let mut bytes = Vec::new();
        let mut out = Text::at_end_of(&mut bytes);
        out.float(1.0)
            .text(" ")
            .float(-0.5)
            .text(" ")
            .float(1e22)
            .text(" ")
            .integer(0);
        out.text(" ").integer(u64::MAX).text(" ").float(-0.0);
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text, "1 -0.5 1e+22 0 18446744073709551615 -0");
    }

    #[test]
    fn integers_have_their_digits() {
        for value in (0..100_000_000)
            .step_by(9_973)
            .chain([9, 10, 99, 100, 9_999, 10_000, 99_999_999])
        {
            let mut bytes = Vec::new();
            Text::at_end_of(&mut bytes).integer(value);
            assert_eq!(bytes, value.to_string().into_bytes());
        }
    }

    #[test]
    fn names_fit_a_line() {
        assert_eq!(plain_name(" a b\n#c ", false), "a b_#c");
        assert_eq!(plain_name("a #b", false), "a _b");
        assert_eq!(plain_name("a b", true), "a_b");
        assert_eq!(plain_name("x\\", false), "x_");
        assert_eq!(plain_name("", false), "_");
    }
}
