//! Reading numbers and words out of text, without a copy and without lines.

use memchr::memchr2;

use crate::Place;

/// `bytes` without a UTF-8 byte order mark, which Notepad writes.
pub(crate) fn without_bom(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The place of byte `at` as line and column. Cost: O(at), for errors only.
pub(crate) fn place(bytes: &[u8], at: usize) -> Place {
    let mark = bytes.len() - without_bom(bytes).len();
    let before = &bytes[..at.min(bytes.len())];
    let (mut line, mut start) = (1, mark.min(before.len()));
    for (i, &byte) in before.iter().enumerate() {
        // A lone CR ends a line too; of CR LF only the LF counts.
        if byte == b'\n' || (byte == b'\r' && bytes.get(i + 1) != Some(&b'\n')) {
            line += 1;
            start = i + 1;
        }
    }
    let starts_character = |byte: &&u8| **byte & 0xc0 != 0x80;
    let column = before[start..].iter().filter(starts_character).count() + 1;
    Place::Line { line, column }
}

/// Text as UTF-8, or else as Latin-1, of which every byte is a character.
pub(crate) fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// Why a word is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BadNumber {
    /// It is other text.
    Text,
    /// NaN, infinite or beyond the reach of 64 bits.
    NotFinite,
}

/// A cursor over text.
///
/// Lines end with LF, CR LF or CR. A backslash before a line's end joins the
/// next line, as OBJ allows; `#` starts a comment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scanner<'a> {
    /// The whole text.
    pub(crate) bytes: &'a [u8],
    /// The next byte.
    pub(crate) at: usize,
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

fn ends_line(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

impl<'a> Scanner<'a> {
    pub(crate) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    #[inline]
    pub(crate) fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Bytes of a backslash at `at` and the line end it takes back, or 0.
    #[inline]
    fn continuation(&self, at: usize) -> usize {
        match (
            self.bytes.get(at),
            self.bytes.get(at + 1),
            self.bytes.get(at + 2),
        ) {
            (Some(b'\\'), Some(b'\r'), Some(b'\n')) => 3,
            (Some(b'\\'), Some(b'\n' | b'\r'), _) => 2,
            _ => 0,
        }
    }

    #[inline]
    pub(crate) fn skip_blanks(&mut self) {
        while let Some(byte) = self.peek() {
            if is_blank(byte) {
                self.at += 1;
            } else if byte == b'\\' && self.continuation(self.at) > 0 {
                self.at += self.continuation(self.at);
            } else {
                return;
            }
        }
    }

    /// Skips blanks; whether another word follows on this line.
    #[inline]
    pub(crate) fn more(&mut self) -> bool {
        self.skip_blanks();
        !matches!(self.peek(), None | Some(b'\n' | b'\r' | b'#'))
    }

    /// Whether the word ends here.
    #[inline]
    fn at_delimiter(&self) -> bool {
        match self.peek() {
            None | Some(b' ' | b'\n' | b'\r' | b'\t' | 0x0b | 0x0c) => true,
            Some(b'\\') => self.continuation(self.at) > 0,
            _ => false,
        }
    }

    /// The word that starts here, up to a blank or the line's end; moves past it.
    pub(crate) fn word(&mut self) -> &'a [u8] {
        let start = self.at;
        while let Some(byte) = self.peek() {
            let joined = byte == b'\\' && self.continuation(self.at) > 0;
            if is_blank(byte) || ends_line(byte) || joined {
                break;
            }
            self.at += 1;
        }
        &self.bytes[start..self.at]
    }

    /// The rest of the line without blanks at its ends and without a comment
    /// (a `#` at the start of a word); may hold joined line ends.
    pub(crate) fn rest(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let start = self.at;
        let mut end = start;
        while self.more() {
            self.word();
            end = self.at;
        }
        &self.bytes[start..end]
    }

    /// Moves to the start of the next line, whatever is left on this one.
    #[inline]
    pub(crate) fn next_line(&mut self) {
        let rest = &self.bytes[self.at.min(self.bytes.len())..];
        let Some(length) = (match rest.first() {
            Some(b'\n' | b'\r') => Some(0),
            _ => memchr2(b'\n', b'\r', rest),
        }) else {
            self.at = self.bytes.len();
            return;
        };
        self.at += length + 1;
        if rest[length] == b'\r' && rest.get(length + 1) == Some(&b'\n') {
            self.at += 1;
        }
    }

    /// A finite number, correctly rounded; the cursor moves past it, or stays
    /// where it is on failure.
    ///
    /// Numbers of at most 2⁵³ in their digits and a power of ten up to 10²²
    /// are one exact operation away from their digits (Clinger 1990); all
    /// others go to `fast-float2`.
    #[inline]
    pub(crate) fn number(&mut self) -> Result<f64, BadNumber> {
        match self.plain_number() {
            Some(value) => Ok(value),
            None => self.any_number(),
        }
    }

    /// A number as most programs write them: a sign or none, one to seven digits,
    /// a point, one to eight digits and a blank or the line's end. `None`, without
    /// moving, for all others.
    #[inline(always)]
    fn plain_number(&mut self) -> Option<f64> {
        let ahead = self.bytes.get(self.at..)?.first_chunk::<24>()?;
        let negative = ahead[0] == b'-';
        let start = usize::from(negative);
        let whole = eight(ahead, start);
        let point = digit_run(whole);
        if !matches!(point, 1..=7) || ahead[start + point] != b'.' {
            return None;
        }
        let behind = start + point + 1;
        let decimals = eight(ahead, behind);
        let count = digit_run(decimals);
        if count == 0 || !matches!(ahead[behind + count], b' ' | b'\n' | b'\r') {
            return None;
        }
        let digits = run_value(whole, point) * POWERS[count] + run_value(decimals, count);
        // Below 10^15 and so exact: the division rounds once.
        let value = digits as f64 / TENS[count];
        self.at += behind + count;
        Some(if negative { -value } else { value })
    }

    /// [`Scanner::number`] in any spelling.
    fn any_number(&mut self) -> Result<f64, BadNumber> {
        let start = self.at;
        let negative = match self.peek() {
            Some(b'-') => {
                self.at += 1;
                true
            }
            Some(b'+') => {
                self.at += 1;
                false
            }
            _ => false,
        };
        let mut digits: u64 = 0;
        let first = self.at;
        self.digits(&mut digits);
        let mut count = self.at - first;
        let mut power = 0;
        if self.peek() == Some(b'.') {
            self.at += 1;
            let point = self.at;
            self.digits(&mut digits);
            power = point as i64 - self.at as i64;
            count += self.at - point;
        }
        if matches!(self.peek(), Some(b'e' | b'E')) {
            power += self.exponent().unwrap_or(i64::MAX / 2);
        }
        if count == 0 || count > 19 || !self.at_delimiter() {
            self.at = start;
            return self.long_number();
        }
        match exact(digits, power) {
            Some(value) => Ok(if negative { -value } else { value }),
            None => {
                self.at = start;
                self.long_number()
            }
        }
    }

    /// Skips digits and appends them to `value`, which wraps beyond 19 of them.
    #[inline]
    fn digits(&mut self, value: &mut u64) {
        // Eight bytes at once: most numbers are one or two steps long.
        while let Some(&chunk) = self.bytes.get(self.at..).and_then(<[u8]>::first_chunk::<8>) {
            let chunk = u64::from_le_bytes(chunk);
            let count = digit_run(chunk);
            if count == 0 {
                return;
            }
            let part = run_value(chunk, count);
            *value = value.wrapping_mul(POWERS[count]).wrapping_add(part);
            self.at += count;
            if count < 8 {
                return;
            }
        }
        while let Some(byte @ b'0'..=b'9') = self.peek() {
            *value = value.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
            self.at += 1;
        }
    }

    /// Skips `e`, a sign and digits; their value if it has one to four digits.
    fn exponent(&mut self) -> Option<i64> {
        self.at += 1;
        let negative = self.peek() == Some(b'-');
        if matches!(self.peek(), Some(b'-' | b'+')) {
            self.at += 1;
        }
        let (start, mut value) = (self.at, 0);
        self.digits(&mut value);
        let value = value as i64;
        matches!(self.at - start, 1..=4).then_some(if negative { -value } else { value })
    }

    #[cold]
    fn long_number(&mut self) -> Result<f64, BadNumber> {
        let mut ahead = *self;
        let mut word = ahead.word();
        if let Some(comment) = memchr::memchr(b'#', word) {
            // Old C libraries print NaN and infinity as 1.#IND, 1.#QNAN, 1.#INF.
            let after = word[comment + 1..].to_ascii_uppercase();
            if [&b"IND"[..], b"QNAN", b"SNAN", b"INF"]
                .iter()
                .any(|nan| after.starts_with(nan))
            {
                return Err(BadNumber::NotFinite);
            }
            word = &word[..comment];
        }
        let unsigned = word.strip_prefix(b"+").unwrap_or(word);
        if unsigned.starts_with(b"+") || (unsigned.len() < word.len() && unsigned.starts_with(b"-"))
        {
            return Err(BadNumber::Text);
        }
        match fast_float2::parse::<f64, _>(unsigned) {
            Ok(value) if value.is_finite() => {
                self.at += word.len();
                Ok(value)
            }
            Ok(_) => Err(BadNumber::NotFinite),
            Err(_) if is_nan(unsigned) => Err(BadNumber::NotFinite),
            Err(_) => Err(BadNumber::Text),
        }
    }

    /// A whole number; the cursor moves past its digits, which something else
    /// may follow. `None`, without moving, if there is none or it needs more
    /// than 18 digits.
    #[inline]
    pub(crate) fn integer(&mut self) -> Option<i64> {
        match self.few_digits(self.at) {
            Some((value, end)) => {
                self.at = end;
                Some(i64::from(value))
            }
            None => self.any_integer(),
        }
    }

    /// A blank, a whole number of one to seven digits, and a blank or the line's
    /// end, which the cursor moves to: most corners of faces. `None`, without
    /// moving, for all else.
    #[inline(always)]
    pub(crate) fn blank_and_digits(&mut self) -> Option<u32> {
        if self.peek() != Some(b' ') {
            return None;
        }
        let (value, end) = self.few_digits(self.at + 1)?;
        if !matches!(self.bytes.get(end), Some(b' ' | b'\n' | b'\r')) {
            return None;
        }
        self.at = end;
        Some(value)
    }

    /// The whole number of one to seven digits at `at`, and where it ends.
    #[inline(always)]
    fn few_digits(&self, at: usize) -> Option<(u32, usize)> {
        let chunk = u64::from_le_bytes(*self.bytes.get(at..)?.first_chunk()?);
        let count = digit_run(chunk);
        matches!(count, 1..=7).then(|| (run_value(chunk, count) as u32, at + count))
    }

    /// [`Scanner::integer`] with a sign or with any count of digits.
    fn any_integer(&mut self) -> Option<i64> {
        let start = self.at;
        let negative = self.peek() == Some(b'-');
        if matches!(self.peek(), Some(b'-' | b'+')) {
            self.at += 1;
        }
        let (first, mut value) = (self.at, 0);
        self.digits(&mut value);
        if !matches!(self.at - first, 1..=18) {
            self.at = start;
            return None;
        }
        let value = value as i64;
        Some(if negative { -value } else { value })
    }

    /// Whether an integer that was just read is the whole word.
    #[inline]
    pub(crate) fn word_is_over(&self) -> bool {
        self.at_delimiter()
    }
}

/// Ten to the power of a count of digits.
const POWERS: [u64; 9] = [
    1,
    10,
    100,
    1_000,
    10_000,
    100_000,
    1_000_000,
    10_000_000,
    100_000_000,
];

/// Eight of the characters, from `at` on, as [`digit_run`] takes them.
#[inline(always)]
fn eight(ahead: &[u8; 24], at: usize) -> u64 {
    let mut chunk = [0; 8];
    chunk.copy_from_slice(&ahead[at..at + 8]);
    u64::from_le_bytes(chunk)
}

/// How many of eight characters, from the lowest byte on, are digits before
/// the first that is none.
#[inline]
fn digit_run(chunk: u64) -> usize {
    let digits = chunk ^ 0x3030_3030_3030_3030;
    // A byte above 9 sets its high bit, itself or by the sum; what it carries
    // spoils only bytes behind it.
    let others = (digits.wrapping_add(0x7676_7676_7676_7676) | digits) & 0x8080_8080_8080_8080;
    others.trailing_zeros() as usize / 8
}

/// The value of the first `count` characters, 1 to 8 digits.
#[inline]
fn run_value(chunk: u64, count: usize) -> u64 {
    // As eight digits with zeros in front; then pairs, fours and all are joined.
    let ones = (chunk ^ 0x3030_3030_3030_3030) << (64 - 8 * count);
    let twos = (ones.wrapping_mul(10).wrapping_add(ones >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (twos.wrapping_mul(100).wrapping_add(twos >> 16)) & 0x0000_ffff_0000_ffff;
    (fours.wrapping_mul(10_000).wrapping_add(fours >> 32)) & 0xffff_ffff
}

/// "nan(ind)", "-nan(0x8000)": what newer C libraries print.
fn is_nan(word: &[u8]) -> bool {
    let word = word.strip_prefix(b"-").unwrap_or(word);
    word.get(..4)
        .is_some_and(|start| start.eq_ignore_ascii_case(b"nan("))
}

/// Powers of ten that a double holds exactly.
const TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// `digits · 10^power` where one rounding is enough.
#[inline]
fn exact(digits: u64, power: i64) -> Option<f64> {
    if digits > 1 << 53 {
        return None;
    }
    let value = digits as f64;
    if power < 0 {
        Some(value / TENS.get(power.unsigned_abs() as usize)?)
    } else {
        Some(value * TENS.get(power as usize)?)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn number(text: &str) -> Result<f64, BadNumber> {
        Scanner::new(text.as_bytes(), 0).number()
    }

    #[test]
    fn number_forms() {
        for (text, value) in [
            ("1", 1.0),
            ("+1.5", 1.5),
            ("-.5", -0.5),
            ("2.", 2.0),
            ("1e3", 1000.0),
            ("1E-3", 1e-3),
            ("1e+0", 1.0),
            ("0.1", 0.1),
            ("1e-320", 1e-320),
            ("1e-999", 0.0),
            ("1e308", 1e308),
            ("1.0000000000000000000000000000000000001", 1.0),
            ("9007199254740993", 9007199254740992.0),
            ("1#comment", 1.0),
            ("1e00005", 100000.0),
        ] {
            assert_eq!(
                number(text).map(f64::to_bits),
                Ok(f64::to_bits(value)),
                "{text}"
            );
        }
        assert_eq!(number("-0").map(f64::to_bits), Ok((-0.0f64).to_bits()));
    }

    #[test]
    fn what_is_no_number() {
        for text in [
            "", "x", "1x", ".", "-", "+-1", "++1", "1,5", "3.1+e2", "0x10", "1e", "1d5",
        ] {
            assert_eq!(number(text), Err(BadNumber::Text), "{text}");
        }
        for text in ["nan", "NaN", "inf", "-inf", "1e400", "-1.#IND", "1e99999"] {
            assert_eq!(number(text), Err(BadNumber::NotFinite), "{text}");
        }
    }

    #[test]
    fn places_count_lines_and_characters() {
        let text = "a\r\nb\rcé x".as_bytes();
        assert_eq!(place(text, 3), Place::Line { line: 2, column: 1 });
        assert_eq!(place(text, 5), Place::Line { line: 3, column: 1 });
        assert_eq!(
            place(text, text.len() - 1),
            Place::Line { line: 3, column: 4 }
        );
        assert_eq!(
            place(b"\xef\xbb\xbfv", 3),
            Place::Line { line: 1, column: 1 }
        );
    }

    #[test]
    fn rest_drops_comments_and_blanks() {
        let mut scanner = Scanner::new(b"  my name#1 \t# note\nnext", 0);
        assert_eq!(scanner.rest(), b"my name#1");
        scanner.next_line();
        assert_eq!(scanner.rest(), b"next");
    }

    proptest! {
        #[test]
        fn integers_are_their_digits(value in -999_999_999_999_999_999..=999_999_999_999_999_999_i64, tail in "[ /a]{0,9}") {
            let text = format!("{value}{tail}");
            let mut scanner = Scanner::new(text.as_bytes(), 0);
            prop_assert_eq!(scanner.integer(), Some(value));
            prop_assert_eq!(scanner.at, value.to_string().len());
        }

        #[test]
        fn numbers_round_as_the_standard_library_does(bits: u64, decimals in 0usize..20) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            for text in [format!("{value:e}"), format!("{:.decimals$}", value % 1e6)] {
                let expected: f64 = text.parse().unwrap();
                prop_assert_eq!(number(&text).map(f64::to_bits), Ok(expected.to_bits()));
                // Among others, as most stand, where they are read in fewer steps.
                let line = format!("{text} {text}\n{}", " ".repeat(24));
                let mut scanner = Scanner::new(line.as_bytes(), 0);
                for _ in 0..2 {
                    prop_assert_eq!(scanner.number().map(f64::to_bits), Ok(expected.to_bits()));
                    prop_assert!(scanner.word_is_over());
                    scanner.skip_blanks();
                }
                prop_assert_eq!(scanner.peek(), Some(b'\n'));
            }
        }
    }
}
