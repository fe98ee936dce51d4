//! Values of a graph file as written, each with its place.

use std::ops::Range;

use super::text::Text;

/// A value of the file, with its place.
#[derive(Debug, Clone)]
pub(crate) struct Item {
    pub(crate) span: Range<usize>,
    pub(crate) shape: Shape,
}

/// How a value is written.
#[derive(Debug, Clone)]
pub(crate) enum Shape {
    /// `"text"`, `r"text"`.
    Text,
    /// `1`, `-0.5`, `1e3`, `inf`.
    Number,
    /// `Global`, `true`.
    Name,
    /// `Kind(name: value)` or `(name: value)`.
    Struct(Box<Struct>),
    /// `Kind(value)` or `(value, value)`; also empty brackets.
    Tuple(Box<Tuple>),
    /// `[value, value]`.
    List(Vec<Item>),
    /// `{key: value}`.
    Map(Vec<(Item, Item)>),
    /// Something RON has and graphs do not, in words.
    Other(&'static str),
}

/// Named fields, with the name before the bracket if there is one.
#[derive(Debug, Clone)]
pub(crate) struct Struct {
    pub(crate) name: Option<Range<usize>>,
    pub(crate) fields: Vec<Field>,
}

/// One `name: value`.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pub(crate) name: Range<usize>,
    pub(crate) value: Item,
}

/// Unnamed values, with the name before the bracket if there is one.
#[derive(Debug, Clone)]
pub(crate) struct Tuple {
    pub(crate) name: Option<Range<usize>>,
    pub(crate) items: Vec<Item>,
}

/// A number as written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Number {
    /// Without a point, and within 64 bits.
    Whole(i64),
    /// With a point or exponent, or too large to be whole; may be infinite.
    Real(f64),
}

impl Item {
    /// The text, if it is one.
    pub(crate) fn text(&self, source: &str) -> Option<Text> {
        matches!(self.shape, Shape::Text).then(|| Text::read(source, &self.span))?
    }

    /// The number, if it is one.
    pub(crate) fn number(&self, source: &str) -> Option<Number> {
        if !matches!(self.shape, Shape::Number) {
            return None;
        }
        let ron::Value::Number(number) = ron::from_str(source.get(self.span.clone())?).ok()? else {
            return None;
        };
        Some(match number {
            ron::Number::I8(number) => Number::Whole(number.into()),
            ron::Number::I16(number) => Number::Whole(number.into()),
            ron::Number::I32(number) => Number::Whole(number.into()),
            ron::Number::I64(number) => Number::Whole(number),
            ron::Number::U8(number) => Number::Whole(number.into()),
            ron::Number::U16(number) => Number::Whole(number.into()),
            ron::Number::U32(number) => Number::Whole(number.into()),
            ron::Number::U64(number) => match i64::try_from(number) {
                Ok(number) => Number::Whole(number),
                Err(_) => Number::Real(number as f64),
            },
            number => Number::Real(number.into_f64()),
        })
    }

    /// The bare name, if it is one.
    pub(crate) fn name<'s>(&self, source: &'s str) -> Option<&'s str> {
        matches!(self.shape, Shape::Name).then(|| plain(source, &self.span))
    }

    /// What kind of thing is written here, with its article.
    pub(crate) fn label(&self, source: &str) -> &'static str {
        match &self.shape {
            Shape::Text => "a text",
            Shape::Number => "a number",
            Shape::Name => match plain(source, &self.span) {
                "true" | "false" => "true or false",
                "None" => "`None`",
                _ => "a bare name",
            },
            Shape::Struct(fields) if fields.name.is_none() => "a group of named fields",
            Shape::Struct(_) => "a name with fields",
            Shape::Tuple(tuple) => match tuple.name.clone().map(|name| plain(source, &name)) {
                Some("Some") => "`Some`",
                Some(_) => "a name with brackets",
                None => "a tuple",
            },
            Shape::List(_) => "a list",
            Shape::Map(_) => "a map",
            Shape::Other(what) => what,
        }
    }
}

/// An identifier without the mark of a raw one.
pub(crate) fn plain<'s>(source: &'s str, span: &Range<usize>) -> &'s str {
    let name = source.get(span.clone()).unwrap_or_default();
    name.strip_prefix("r#").unwrap_or(name)
}
