//! Cuts the text of an expression into tokens.

use std::ops::Range;

use super::ExprError;

/// The smallest piece of an expression that means something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Token<'a> {
    /// A number, finite.
    Number(f64),
    /// A name, possibly of a node's result: `check.pairs`.
    Name(&'a str),
    /// An operator, a bracket or a comma.
    Sign(&'static str),
    /// Nothing is left.
    End,
}

const SIGNS: [&str; 16] = [
    "<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "%", "^", "(", ")", ",", ";",
];

/// What people type who know another language, and what to write here.
const FOREIGN: [(&str, &str); 12] = [
    ("**", "a power is written `^`"),
    ("&&", "write `and`"),
    ("||", "write `or`"),
    ("&", "write `and`"),
    ("|", "write `or`; an absolute value is `abs(x)`"),
    ("!", "write `not`"),
    ("=", "a comparison is written `==`"),
    ("?", "a choice is written `if(condition, a, b)`"),
    ("×", "a product is written `*`"),
    ("−", "a minus is written `-`"),
    (
        "°",
        "an angle input is in degrees already; `rad(x)` turns degrees into radians",
    ),
    ("π", "write `pi`"),
];

/// Reads tokens one after the other.
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// The next token and its place; [`Token::End`] for ever at the end.
    pub(super) fn next(&mut self) -> Result<(Token<'a>, Range<usize>), ExprError> {
        let rest = self.text[self.at..].trim_start();
        let start = self.text.len() - rest.len();
        let (token, length) = self.token(rest, start)?;
        self.at = start + length;
        Ok((token, start..self.at))
    }

    fn token(&self, rest: &'a str, start: usize) -> Result<(Token<'a>, usize), ExprError> {
        let Some(first) = rest.chars().next() else {
            return Ok((Token::End, 0));
        };
        if first.is_ascii_digit() || (first == '.' && rest[1..].starts_with(is_digit)) {
            return number(rest, start);
        }
        if first.is_ascii_alphabetic() || first == '_' {
            let length = name_length(rest);
            return Ok((Token::Name(&rest[..length]), length));
        }
        if let Some((sign, help)) = FOREIGN.iter().find(|(sign, _)| rest.starts_with(sign))
            && !rest.starts_with("!=")
            && !rest.starts_with("==")
        {
            let error = ExprError::new(
                start..start + sign.len(),
                format!("`{sign}` is not known here"),
            );
            return Err(error.help(*help));
        }
        if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
            return Ok((Token::Sign(sign), sign.len()));
        }
        let shown = first.escape_debug();
        let message = format!("the character `{shown}` means nothing in an expression");
        Err(ExprError::new(start..start + first.len_utf8(), message)
            .help("expressions hold numbers, names, functions, operators and brackets"))
    }
}

fn is_digit(character: char) -> bool {
    character.is_ascii_digit()
}

/// Length of a name with its dotted parts.
fn name_length(text: &str) -> usize {
    let part = |text: &str| {
        text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .unwrap_or(text.len())
    };
    let mut length = part(text);
    while text[length..].starts_with('.')
        && text[length + 1..].starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
    {
        length += 1 + part(&text[length + 1..]);
    }
    length
}

fn number<'a>(rest: &'a str, start: usize) -> Result<(Token<'a>, usize), ExprError> {
    let length = number_length(rest);
    let error = |length, message: String| Err(ExprError::new(start..start + length, message));
    let after = &rest[length..];
    if after.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        let name = &after[..name_length(after)];
        let message = format!("`{name}` follows a number without an operator");
        return Err(
            ExprError::new(start + length..start + length + name.len(), message).help(format!(
                "write `{} * {name}`; numbers carry no unit, they are in the file's",
                &rest[..length]
            )),
        );
    }
    match rest[..length].parse::<f64>() {
        Ok(number) if number.is_finite() => Ok((Token::Number(number), length)),
        Ok(_) => error(length, "this number is too large".to_owned()),
        Err(_) => error(length, "this is not a number".to_owned()),
    }
}

/// Length of digits, a point, digits, and an exponent if one follows.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        text[from..]
            .find(|c: char| !c.is_ascii_digit())
            .map_or(text.len(), |count| from + count)
    };
    let mut end = digits(0);
    if text[end..].starts_with('.') {
        end = digits(end + 1);
    }
    let exponent = &text[end..];
    if exponent.starts_with(['e', 'E']) {
        let signed = end + 1 + usize::from(exponent[1..].starts_with(['+', '-']));
        if text[signed..].starts_with(is_digit) {
            end = digits(signed);
        }
    }
    end
}
