//! Changing a graph file from a program: one value, byte by byte, and nothing
//! else. Comments, order and layout are the author's.

use std::ops::Range;
use std::sync::Arc;

use tessgraph_geometry::Quantity;

use super::parameter::{ParamKind, Parameter};
use super::raw::Number;
use crate::check::value_of;
use crate::diagnostic::{Diagnostic, Source};
use crate::names::shown;
use crate::units::Units;
use crate::value::{Value, plain_number};

/// What a graph file declares that a program may change.
#[derive(Debug)]
pub struct Declarations {
    source: Arc<Source>,
    units: Units,
    parameters: Vec<Declaration>,
    /// Bytes of the file before its text: a byte order mark.
    before: usize,
}

/// A parameter as its file declares it.
#[derive(Debug)]
pub struct Declaration {
    parameter: Parameter,
    value: Value,
    span: Range<usize>,
}

/// A change of one piece of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// Where the piece begins, in bytes of the file.
    pub start: usize,
    /// What stands there.
    pub old: String,
    /// What is to stand there.
    pub new: String,
}

impl Declarations {
    /// Reads what a graph file declares, whatever its nodes are.
    ///
    /// # Errors
    /// When it is no graph file, or has an error of syntax; parameters that are
    /// at fault are left out.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, Vec<Diagnostic>> {
        let (document, _) = super::read(name, bytes)?;
        let declared = document.params.into_iter().filter_map(|parameter| {
            Some(Declaration {
                value: parameter.value.clone()?,
                span: parameter.value_span.clone()?,
                parameter,
            })
        });
        Ok(Self {
            before: bytes.len() - document.source.text().len(),
            units: document.units,
            parameters: declared.collect(),
            source: document.source,
        })
    }

    /// The text of the file, without a byte order mark.
    pub fn source(&self) -> &Arc<Source> {
        &self.source
    }

    /// The unit of every length in the file.
    pub fn units(&self) -> Units {
        self.units
    }

    /// The parameters that have a value, in the order of the file.
    pub fn parameters(&self) -> &[Declaration] {
        &self.parameters
    }

    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<&Declaration> {
        self.parameters.iter().find(|other| other.name() == name)
    }

    /// The change that gives a parameter another value, written as `--set` takes
    /// it; `None` if it has that value already.
    ///
    /// # Errors
    /// In words, when there is no such parameter, or it takes no such value.
    pub fn edit(&self, name: &str, value: &str) -> Result<Option<Edit>, String> {
        let Some(declaration) = self.parameter(name) else {
            return Err(format!("the file has no parameter `{}`", shown(name)));
        };
        let value = declaration.read(value)?;
        if is_same(&value, &declaration.value) {
            return Ok(None);
        }
        let old = &self.source.text()[declaration.span.clone()];
        let new = declaration.literal(&value);
        // Another number, but not one that a person would tell from it.
        Ok((new != old).then(|| Edit {
            start: self.before + declaration.span.start,
            old: old.to_owned(),
            new,
        }))
    }
}

impl Declaration {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.parameter.name.value
    }

    /// The kind as it is written: `Number`, `Integer`, `Bool`, `Text`, `Path`,
    /// `Choice`.
    pub fn kind(&self) -> &'static str {
        self.parameter.kind.name()
    }

    /// The value that the file gives it, in the file's units; choices are texts.
    pub fn value(&self) -> &Value {
        &self.value
    }

    /// Where that value stands, in bytes of the text.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The smallest and the largest value allowed, in the file's units.
    pub fn limits(&self) -> (Option<f64>, Option<f64>) {
        self.parameter.limits
    }

    /// What its numbers measure.
    pub fn quantity(&self) -> Quantity {
        self.parameter.target.quantity()
    }

    /// The names a choice is made from; nothing for other kinds.
    pub fn choices(&self) -> &[String] {
        &self.parameter.choices
    }

    /// What it means, in the author's words.
    pub fn about(&self) -> &str {
        &self.parameter.about
    }

    /// The value that a text stands for, as `--set` takes it.
    ///
    /// # Errors
    /// In words, when it is of another kind or out of range.
    pub fn read(&self, text: &str) -> Result<Value, String> {
        value_of(&self.parameter, text)
    }

    /// A value as a person would write it here: 0.12 rather than the dust of
    /// arithmetic; a Number keeps its point, or it would become an Integer.
    fn literal(&self, value: &Value) -> String {
        match value {
            Value::Number(number) => {
                let plain = with_point(plain_number(*number));
                let rounded = plain.parse().map_or(*number, |rounded: f64| rounded);
                // The nearest short number may be just outside the range.
                match self.parameter.number(Number::Real(rounded)) {
                    Ok(_) => plain,
                    Err(_) => with_point(format!("{number:?}")),
                }
            }
            Value::Integer(number) => number.to_string(),
            Value::Bool(value) => value.to_string(),
            Value::Text(name) if self.parameter.kind == ParamKind::Choice => identifier(name),
            Value::Text(text) => quoted(text),
            other => other.summary(),
        }
    }
}

impl Edit {
    /// The file with the change; `None` if something else stands at the place.
    pub fn apply(&self, bytes: &[u8]) -> Option<Vec<u8>> {
        let end = self.start.checked_add(self.old.len())?;
        if bytes.get(self.start..end)? != self.old.as_bytes() {
            return None;
        }
        Some([&bytes[..self.start], self.new.as_bytes(), &bytes[end..]].concat())
    }

    /// The change that takes this one back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self {
            start: self.start,
            old: self.new.clone(),
            new: self.old.clone(),
        }
    }
}

fn is_same(one: &Value, other: &Value) -> bool {
    match (one, other) {
        (Value::Number(one), Value::Number(other)) => one.total_cmp(other).is_eq(),
        _ => one.digest() == other.digest(),
    }
}

/// A real number with a point or an exponent.
fn with_point(mut text: String) -> String {
    if !text.contains(['.', 'e']) {
        text.push_str(".0");
    }
    text
}

/// A bare name, marked as raw where RON needs that.
fn identifier(name: &str) -> String {
    let is_plain = name
        .chars()
        .all(|character| character.is_ascii_alphanumeric() || character == '_');
    if is_plain {
        name.to_owned()
    } else {
        format!("r#{name}")
    }
}

/// A text in quotes, with escapes where they are needed.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\r' => quoted.push_str("\\r"),
            '\t' => quoted.push_str("\\t"),
            control if control.is_control() => quoted.extend(control.escape_unicode()),
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAPH: &str = r#"// é, a comment
Graph(
    version: 1,
    units: Cm,
    params: {
        "thickness": Number(min: 2, /* keep */ default: 12.0, max: 40, unit: Length, about: "depth"),
        "bare": 20, // passes
        "real": 2.5e0,
        "on": true,
        "name": "a \"b\"",
        "mode": Choice(default: Local, of: [Local, Global]),
    },
    nodes: {},
    outputs: {},
)
"#;

    fn edited(name: &str, value: &str) -> Result<String, String> {
        let file = Declarations::read("g.ron", GRAPH.as_bytes()).unwrap();
        let Some(edit) = file.edit(name, value)? else {
            return Ok(GRAPH.to_owned());
        };
        let bytes = edit.apply(GRAPH.as_bytes()).unwrap();
        assert_eq!(edit.inverse().apply(&bytes).unwrap(), GRAPH.as_bytes());
        assert_eq!(edit.apply(b"something else"), None);
        let read = Declarations::read("g.ron", &bytes).unwrap();
        let expected = file.parameter(name).unwrap().read(value).unwrap();
        match (read.parameter(name).unwrap().value(), &expected) {
            (Value::Number(one), Value::Number(other)) => assert!((one - other).abs() < 1e-9),
            (one, other) => assert_eq!(one.digest(), other.digest()),
        }
        Ok(String::from_utf8(bytes).unwrap())
    }

    #[test]
    fn only_the_bytes_of_the_value_change() {
        for (name, value, old, new) in [
            ("thickness", "13", "default: 12.0", "default: 13.0"),
            ("thickness", "12.000000000000002", "12.0,", "12.0,"),
            ("thickness", "0.30000000000000004e2", "12.0,", "30.0,"),
            ("bare", "21", "20,", "21,"),
            ("real", "3", "2.5e0", "3.0"),
            ("real", "0.0000001", "2.5e0", "1e-7"),
            ("on", "false", "true", "false"),
            (
                "name",
                "c:\\d\n\u{1}é",
                r#""a \"b\"""#,
                r#""c:\\d\n\u{1}é""#,
            ),
            ("mode", "Global", "default: Local", "default: Global"),
        ] {
            assert_eq!(edited(name, value), Ok(GRAPH.replace(old, new)), "{name}");
        }
    }

    #[test]
    fn values_the_file_would_refuse_are_refused() {
        for (name, value, told) in [
            ("thickness", "41", "must be 2 cm to 40 cm"),
            ("thickness", "x", "takes a number"),
            ("bare", "2.5", "whole number"),
            ("mode", "Globl", "did you mean"),
            ("missing", "1", "no parameter `missing`"),
        ] {
            let refusal = edited(name, value).unwrap_err();
            assert!(refusal.contains(told), "{refusal}");
        }
        assert_eq!(edited("mode", "Local"), Ok(GRAPH.to_owned()));
    }

    #[test]
    fn a_byte_order_mark_and_broken_nodes_are_no_obstacle() {
        let text = "\u{feff}Graph(version: 1, params: {\"n\": 3}, nodes: {\"a\": Nothing(1)})";
        let file = Declarations::read("g.ron", text.as_bytes()).unwrap();
        let edit = file.edit("n", "4").unwrap().unwrap();
        let bytes = edit.apply(text.as_bytes()).unwrap();
        assert_eq!(bytes, text.replace('3', "4").as_bytes());
        assert!(Declarations::read("g.ron", b"Graph(version: 1, params: {\"n\": ").is_err());
    }

    #[test]
    fn what_is_declared_is_told() {
        let file = Declarations::read("g.ron", GRAPH.as_bytes()).unwrap();
        assert_eq!(file.parameters().len(), 6);
        let thickness = file.parameter("thickness").unwrap();
        assert_eq!((thickness.kind(), thickness.about()), ("Number", "depth"));
        assert_eq!(thickness.limits(), (Some(2.0), Some(40.0)));
        assert_eq!(thickness.quantity(), Quantity::Length);
        assert_eq!(&file.source().text()[thickness.span()], "12.0");
        assert_eq!(
            file.parameter("mode").unwrap().choices(),
            ["Local", "Global"]
        );
    }
}
