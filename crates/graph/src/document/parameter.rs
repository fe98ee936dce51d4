//! A parameter: what its values may be, and the one it has.

use std::ops::Range;

use super::Spanned;
use super::raw::Number;
use crate::expr::Target;
use crate::names::{alternatives, did_you_mean, shown};
use crate::value::{Kind, Value};

/// The kind of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ParamKind {
    Number,
    Integer,
    Bool,
    Text,
    Path,
    Choice,
}

/// How kinds are written.
pub(super) const KINDS: [(&str, ParamKind); 6] = [
    ("Number", ParamKind::Number),
    ("Integer", ParamKind::Integer),
    ("Bool", ParamKind::Bool),
    ("Text", ParamKind::Text),
    ("Path", ParamKind::Path),
    ("Choice", ParamKind::Choice),
];

impl ParamKind {
    /// What its values are called, with the article.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Integer => "a whole number",
            Self::Bool => "true or false",
            Self::Text => "a text",
            Self::Path => "a path",
            Self::Choice => "a choice",
        }
    }

    /// How it is written.
    pub(crate) fn name(self) -> &'static str {
        KINDS
            .iter()
            .find(|(_, kind)| *kind == self)
            .map_or("", |(name, _)| name)
    }

    /// Which fields its declaration may have.
    pub(super) fn fields(self) -> &'static [&'static str] {
        match self {
            Self::Number => &["default", "min", "max", "unit", "about"],
            Self::Integer => &["default", "min", "max", "about"],
            Self::Bool | Self::Text | Self::Path => &["default", "about"],
            Self::Choice => &["default", "of", "about"],
        }
    }
}

/// A parameter with its value.
#[derive(Debug, Clone)]
pub(crate) struct Parameter {
    pub(crate) name: Spanned<String>,
    pub(crate) kind: ParamKind,
    /// The value in the file's units; choices are texts. `None` if the
    /// declaration has no usable default, which was reported.
    pub(crate) value: Option<Value>,
    /// The folder that a path is named from: of the file it is written in.
    pub(crate) folder: Option<String>,
    /// The names to choose from.
    pub(crate) choices: Vec<String>,
    /// The range, in the file's units.
    pub(crate) target: Target,
    /// The declaration.
    pub(crate) span: Range<usize>,
    /// The value in it; `None` if it has none.
    pub(crate) value_span: Option<Range<usize>>,
    /// The smallest and the largest value as declared, in the file's units.
    pub(crate) limits: (Option<f64>, Option<f64>),
    /// What it means, in the author's words.
    pub(crate) about: String,
}

impl Parameter {
    /// The kind of a number or condition that a node computes for it.
    pub(crate) fn value_kind(&self) -> Kind {
        match self.kind {
            ParamKind::Bool => Kind::Bool,
            ParamKind::Integer => Kind::Integer,
            _ => Kind::Number,
        }
    }

    /// Checks a number in the file's units, and gives it as the value.
    pub(crate) fn number(&self, number: Number) -> Result<Value, String> {
        match (self.kind, number) {
            (ParamKind::Integer, Number::Whole(number)) => self.target.of_integer(number),
            (ParamKind::Integer, Number::Real(number)) => self.target.of_number(number),
            (_, number) => {
                let number = match number {
                    Number::Whole(number) => number as f64,
                    Number::Real(number) => number,
                };
                self.target
                    .of_number(number)
                    .map(|_| Value::Number(number + 0.0))
            }
        }
    }

    /// Checks the name of a choice, and gives it as the value.
    pub(crate) fn choice(&self, name: &str) -> Result<Value, (String, Option<String>)> {
        if self.choices.iter().any(|choice| choice == name) {
            return Ok(Value::Text(name.into()));
        }
        let names = self.choices.iter().map(String::as_str);
        let message = format!("`{}` cannot be `{}`", shown(&self.name.value), shown(name));
        let help = did_you_mean(name, names.clone())
            .unwrap_or_else(|| format!("it is {}", alternatives(names)));
        Err((message, Some(help)))
    }
}
