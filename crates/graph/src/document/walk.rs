//! Finds where everything stands in a text that `ron` has accepted.

use std::ops::Range;

use super::raw::{Field, Item, Shape, Struct, Tuple};

/// More values than any graph has; a limit on the memory a small but dense
/// file can take.
const MAX_ITEMS: usize = 1 << 21;

/// `ron` refuses nesting at 128 levels, so this one is never met after it.
const MAX_DEPTH: usize = 200;

/// Why the walk stopped.
#[derive(Debug, PartialEq)]
pub(super) enum Stop {
    /// Something unexpected at this place.
    Unexpected(usize),
    /// More values than [`MAX_ITEMS`].
    TooMany,
}

/// The places of everything in `text`.
pub(super) fn walk(text: &str) -> Result<Item, Stop> {
    let mut walker = Walker {
        text,
        at: 0,
        items: 0,
        depth: 0,
    };
    walker.skip_attributes()?;
    let root = walker.item()?;
    walker.skip_blank()?;
    if walker.rest().is_empty() {
        Ok(root)
    } else {
        walker.stop()
    }
}

struct Walker<'a> {
    text: &'a str,
    at: usize,
    items: usize,
    depth: usize,
}

impl<'a> Walker<'a> {
    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn stop<T>(&self) -> Result<T, Stop> {
        Err(Stop::Unexpected(self.at.min(self.text.len())))
    }

    fn take(&mut self, sign: &str) -> bool {
        let found = self.rest().starts_with(sign);
        if found {
            self.at += sign.len();
        }
        found
    }

    fn expect(&mut self, sign: &str) -> Result<(), Stop> {
        if self.take(sign) { Ok(()) } else { self.stop() }
    }

    /// Skips blanks and comments; comments in `/* */` nest.
    fn skip_blank(&mut self) -> Result<(), Stop> {
        loop {
            let rest = self.rest();
            self.at = self.text.len() - rest.trim_start_matches(is_blank).len();
            if self.take("//") {
                self.at += self.rest().find('\n').unwrap_or(self.rest().len());
            } else if self.take("/*") {
                self.skip_block_comment()?;
            } else {
                return Ok(());
            }
        }
    }

    fn skip_block_comment(&mut self) -> Result<(), Stop> {
        let mut level = 1;
        while level > 0 {
            let Some(mark) = self.rest().find(['/', '*']) else {
                return self.stop();
            };
            self.at += mark;
            if self.take("/*") {
                level += 1;
            } else if self.take("*/") {
                level -= 1;
            } else {
                self.at += 1;
            }
        }
        Ok(())
    }

    /// Skips `#![enable(...)]`: no extension changes the meaning of a graph.
    fn skip_attributes(&mut self) -> Result<(), Stop> {
        self.skip_blank()?;
        while self.take("#") {
            while !self.take("]") {
                self.skip_blank()?;
                match self.rest().chars().next() {
                    Some('"' | 'r') if self.string_end().is_some() => drop(self.scalar()?),
                    Some(']') => {}
                    Some(character) => self.at += character.len_utf8(),
                    None => return self.stop(),
                }
            }
            self.skip_blank()?;
        }
        Ok(())
    }

    fn item(&mut self) -> Result<Item, Stop> {
        self.skip_blank()?;
        self.items += 1;
        self.depth += 1;
        if self.items > MAX_ITEMS {
            return Err(Stop::TooMany);
        }
        if self.depth > MAX_DEPTH {
            return self.stop();
        }
        let start = self.at;
        let shape = match self.rest().chars().next() {
            Some('[') => Shape::List(self.sequence("[", "]", Self::item)?),
            Some('{') => Shape::Map(self.sequence("{", "}", Self::entry)?),
            Some('(') => self.group(None)?,
            Some(_) => self.scalar_or_group()?,
            None => return self.stop(),
        };
        self.depth -= 1;
        Ok(Item {
            span: start..self.at,
            shape,
        })
    }

    fn entry(&mut self) -> Result<(Item, Item), Stop> {
        let key = self.item()?;
        self.skip_blank()?;
        self.expect(":")?;
        Ok((key, self.item()?))
    }

    fn field(&mut self) -> Result<Field, Stop> {
        let Some(length) = self.identifier() else {
            return self.stop();
        };
        let name = self.at..self.at + length;
        self.at += length;
        self.skip_blank()?;
        self.expect(":")?;
        Ok(Field {
            name,
            value: self.item()?,
        })
    }

    /// Values between brackets, separated by commas.
    fn sequence<T>(
        &mut self,
        open: &str,
        close: &str,
        read: impl Fn(&mut Self) -> Result<T, Stop>,
    ) -> Result<Vec<T>, Stop> {
        self.expect(open)?;
        let mut items = Vec::new();
        loop {
            self.skip_blank()?;
            if self.take(close) {
                return Ok(items);
            }
            items.push(read(self)?);
            self.skip_blank()?;
            if !self.take(",") && !self.rest().starts_with(close) {
                return self.stop();
            }
        }
    }

    /// What stands in round brackets: named fields, or values.
    fn group(&mut self, name: Option<Range<usize>>) -> Result<Shape, Stop> {
        if self.has_named_fields()? {
            let fields = self.sequence("(", ")", Self::field)?;
            return Ok(Shape::Struct(Box::new(Struct { name, fields })));
        }
        let items = self.sequence("(", ")", Self::item)?;
        Ok(Shape::Tuple(Box::new(Tuple { name, items })))
    }

    /// Whether `(` is followed by a name and a colon.
    fn has_named_fields(&mut self) -> Result<bool, Stop> {
        let start = self.at;
        self.expect("(")?;
        self.skip_blank()?;
        let named = match self.identifier() {
            Some(length) => {
                self.at += length;
                self.skip_blank()?;
                self.rest().starts_with(':')
            }
            None => false,
        };
        self.at = start;
        Ok(named)
    }

    fn scalar_or_group(&mut self) -> Result<Shape, Stop> {
        let Some(length) = self.identifier() else {
            return self.scalar();
        };
        let name = self.at..self.at + length;
        self.at = name.end;
        if matches!(
            &self.text[name.clone()],
            "inf" | "inff32" | "inff64" | "NaN" | "NaNf32" | "NaNf64"
        ) {
            self.at = name.start;
            return self.number();
        }
        self.skip_blank()?;
        if self.rest().starts_with('(') {
            return self.group(Some(name));
        }
        self.at = name.end;
        Ok(Shape::Name)
    }

    fn scalar(&mut self) -> Result<Shape, Stop> {
        let rest = self.rest();
        if rest.starts_with("b\"") || rest.starts_with("br") {
            self.at += 1;
            self.scalar()?;
            return Ok(Shape::Other("a byte string"));
        }
        if rest.starts_with(['"', 'r']) {
            let Some(length) = self.string_end() else {
                return self.stop();
            };
            self.at += length;
            return Ok(Shape::Text);
        }
        if rest.starts_with('\'') || rest.starts_with("b'") {
            return self.character();
        }
        self.number()
    }

    /// Length of the string that starts here.
    fn string_end(&self) -> Option<usize> {
        let rest = self.rest();
        if let Some(raw) = rest.strip_prefix('r') {
            let hashes = raw.len() - raw.trim_start_matches('#').len();
            let inner = raw[hashes..].strip_prefix('"')?;
            let ending = format!("\"{}", &raw[..hashes]);
            return Some(1 + hashes + 1 + inner.find(&ending)? + ending.len());
        }
        let inner = rest.strip_prefix('"')?;
        let mut at = 0;
        loop {
            at += inner[at..].find(['"', '\\'])?;
            if inner[at..].starts_with('"') {
                return Some(at + 2);
            }
            at += 1 + inner[at + 1..].chars().next()?.len_utf8();
        }
    }

    fn character(&mut self) -> Result<Shape, Stop> {
        self.take("b");
        self.expect("'")?;
        self.take("\\");
        // The character itself may be a quote.
        self.at += self.rest().chars().next().map_or(0, char::len_utf8);
        match self.rest().find('\'') {
            Some(length) => self.at += length + 1,
            None => return self.stop(),
        }
        Ok(Shape::Other("a character"))
    }

    fn number(&mut self) -> Result<Shape, Stop> {
        let rest = self.rest();
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '+' | '-' | '=');
        let length = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
        if length == 0 {
            return self.stop();
        }
        self.at += length;
        let is_range = rest[..length].contains("..");
        Ok(if is_range {
            Shape::Other("a range")
        } else {
            Shape::Number
        })
    }

    /// Length of the identifier that starts here.
    fn identifier(&self) -> Option<usize> {
        let rest = self.rest();
        let is_string = ["b\"", "b'", "br#", "br\"", "r\"", "r#\"", "r##"];
        if is_string.iter().any(|start| rest.starts_with(start)) {
            return None;
        }
        if let Some(raw) = rest.strip_prefix("r#") {
            let is_part = |c: char| is_identifier_part(c) || matches!(c, '.' | '+' | '-');
            let length = raw.find(|c| !is_part(c)).unwrap_or(raw.len());
            return (length > 0).then_some(2 + length);
        }
        let starts = rest.starts_with(|c: char| is_identifier_part(c) && !c.is_numeric());
        starts.then(|| rest.find(|c| !is_identifier_part(c)).unwrap_or(rest.len()))
    }
}

/// Letters, digits, underscores, and the marks that combine with letters:
/// whatever cannot be a sign of RON's.
fn is_identifier_part(character: char) -> bool {
    character.is_alphanumeric()
        || character == '_'
        || (!character.is_ascii() && !is_blank(character))
}

/// What `ron` counts as blank.
fn is_blank(character: char) -> bool {
    matches!(
        character,
        ' ' | '\t'..='\r' | '\u{85}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}'
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Number;

    /// Forms of RON that are rare in graphs, or easily misread.
    const FORMS: &[&str] = &[
        "()",
        "( )",
        "(1,)",
        "[]",
        "{}",
        "Foo",
        "Foo()",
        "Foo ( 1 , )",
        "Some(Some(1))",
        "None",
        "(a: 1)",
        "(a:(b:[{1:2,},],),)",
        "r#type",
        "r#a-b.c(x: 1)",
        "(r#type: 1)",
        "(true, false)",
        "'a'",
        "'\\''",
        "'\"'",
        "'\\u{1F}'",
        "b'x'",
        "b'\\''",
        "b\"\\xff\"",
        "br#\"\"\"#",
        "\"\"",
        "\"\\\"\\\\\"",
        "r\"\\\"",
        "r##\"\"#\"##",
        "\"a\\\n  b\"",
        "\"é\"",
        "(é: ü)",
        "0x1F",
        "0b1_0",
        "-1_000.5e-3",
        "+.5",
        "1.",
        "1u8",
        "-3i32",
        "2.5f32",
        "inf",
        "-inf",
        "NaN",
        "NaNf64",
        "1..5",
        "1..=5",
        "..5",
        "..=5",
        "1..",
        "..",
        "1.5..2.5",
        "(1..2, 3)",
        "/* a /* b */ c */ 1 // d",
        "// only\n1",
        "1 /**/",
        "1 //",
        "\u{feff}1",
        "\u{2028}1\u{200e}",
        "#![enable(implicit_some)] 1",
        "#![type = \"a]b\"]\n#![schema = r\"x\"] 1",
        "{\"a\" /* : */ : /* , */ 1 /* } */, (1, 2): [3]}",
        "(a /*:*/: 1)",
        "(a /*:*/, b)",
        "infinite",
        "NaNny(1)",
        "r",
        "b",
        "br",
        "rb(1)",
        "truely",
        "Some",
        "_",
        "__a1(_b: _c)",
        "[",
        "(1",
        "{1}",
        "(a: )",
        "1 2",
        "'ab'",
        "@",
        "\"",
        "",
        "a:",
        "(:1)",
    ];

    #[test]
    fn the_walk_accepts_all_that_ron_accepts() {
        for form in FORMS {
            let accepted = ron::from_str::<serde::de::IgnoredAny>(form).is_ok();
            let walked = walk(form);
            assert!(!accepted || walked.is_ok(), "{form}: {walked:?}");
            if let Ok(item) = walked {
                assert!(form.get(item.span).is_some(), "{form}");
            }
        }
    }

    #[test]
    fn places_are_exact() {
        let text = "/* ( */ Foo(a: [1, \"é)\"], /* , */ b : Bar) // )";
        let root = walk(text).unwrap();
        assert_eq!(
            &text[root.span.clone()],
            "Foo(a: [1, \"é)\"], /* , */ b : Bar)"
        );
        let Shape::Struct(root) = root.shape else {
            panic!()
        };
        assert_eq!(&text[root.name.unwrap()], "Foo");
        let parts = root
            .fields
            .iter()
            .map(|field| (&text[field.name.clone()], &text[field.value.span.clone()]));
        assert_eq!(
            parts.collect::<Vec<_>>(),
            [("a", "[1, \"é)\"]"), ("b", "Bar")]
        );
    }

    #[test]
    fn numbers_are_read_as_ron_reads_them() {
        let number = |text: &str| walk(text).unwrap().number(text);
        assert_eq!(number("-1_000"), Some(Number::Whole(-1000)));
        assert_eq!(number("0xff"), Some(Number::Whole(255)));
        assert_eq!(number("9223372036854775807"), Some(Number::Whole(i64::MAX)));
        assert_eq!(
            number("9223372036854775808"),
            Some(Number::Real(9_223_372_036_854_775_808.0))
        );
        assert_eq!(number("2.0"), Some(Number::Real(2.0)));
        assert_eq!(number("1e400"), Some(Number::Real(f64::INFINITY)));
        assert_eq!(number("-inf"), Some(Number::Real(f64::NEG_INFINITY)));
        assert_eq!(number("1..5"), None);
    }
}
