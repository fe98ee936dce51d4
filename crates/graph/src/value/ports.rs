//! Which Rust types a node may take and give.

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::Amount;

use super::{Kind, Value};

/// A Rust type that a node input can have.
pub trait InputType: Sized {
    /// The kind of value it is made from.
    const KIND: Kind;
    /// Whether the input may be left out.
    const OPTIONAL: bool = false;
    /// The names to choose from, for choices.
    const CHOICES: &'static [ChoiceSpec] = &[];
    /// How many items a list must have, if its length is fixed.
    const LENGTH: Option<usize> = None;
    /// The smallest number the type can hold, if there is one.
    const MIN: Option<f64> = None;
    /// The largest number the type can hold, if there is one.
    const MAX: Option<f64> = None;

    /// The typed value; `None` if `value` is of another kind or out of range.
    fn from_value(value: Value) -> Option<Self>;

    /// What an input that was left out becomes; `None` if it may not be.
    fn absent() -> Option<Self> {
        None
    }
}

/// A Rust type that a node result can have.
pub trait OutputType {
    /// The kind of value it becomes.
    const KIND: Kind;

    /// The value that travels on.
    fn into_value(self) -> Value;
}

/// One name of a choice, with what it means.
#[derive(Debug, Clone, Copy)]
pub struct ChoiceSpec {
    /// The bare identifier in a graph file.
    pub name: &'static str,
    /// What choosing it means.
    pub doc: &'static str,
}

/// An input type that can have a default.
pub trait InputDefault: InputType {
    /// How the default is written in Rust.
    type Literal;

    /// The default as a value.
    fn default_value(literal: Self::Literal) -> Value;
}

/// Input types whose default is written as a plain Rust literal.
macro_rules! literals {
    ($($type:ty: $literal:ty => $value:expr;)*) => {
        $(impl InputDefault for $type {
            type Literal = $literal;

            fn default_value(literal: $literal) -> Value {
                #[allow(clippy::redundant_closure_call, reason = "the table's right-hand sides")]
                ($value)(literal)
            }
        })*
    };
}

literals! {
    bool: bool => Value::Bool;
    i64: i64 => Value::Integer;
    u32: u32 => |literal: u32| Value::Integer(literal.into());
    f64: f64 => Value::Number;
    Amount: f64 => Value::Number;
    DVec3: [f64; 3] => |literal: [f64; 3]| Value::Vector(literal.into());
    String: &'static str => |literal: &'static str| Value::Text(literal.into());
    FilePath: &'static str => |literal: &'static str| Value::Text(literal.into());
}

impl<T: InputDefault, const N: usize> InputDefault for [T; N] {
    type Literal = [T::Literal; N];

    fn default_value(literal: Self::Literal) -> Value {
        Value::List(literal.map(T::default_value).into())
    }
}

/// A file to read, as written in the graph: relative to the graph's folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FilePath(Arc<str>);

impl FilePath {
    /// The path as written, with `/` between its parts.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl From<&str> for FilePath {
    fn from(path: &str) -> Self {
        Self(path.into())
    }
}

impl InputType for FilePath {
    const KIND: Kind = Kind::Path;

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Text(path) => Some(Self(path)),
            _ => None,
        }
    }
}

impl InputType for String {
    const KIND: Kind = Kind::Text;

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Text(text) => Some(text.as_ref().to_owned()),
            _ => None,
        }
    }
}

impl InputType for u32 {
    const KIND: Kind = Kind::Integer;
    const MIN: Option<f64> = Some(0.0);
    const MAX: Option<f64> = Some(u32::MAX as f64);

    fn from_value(value: Value) -> Option<Self> {
        i64::from_value(value)?.try_into().ok()
    }
}

impl InputType for Amount {
    const KIND: Kind = Kind::Amount;

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(number) => Some(Self::Constant(number)),
            Value::Field(field) => Some(Self::Field(field)),
            _ => None,
        }
    }
}

impl<T: InputType> InputType for Option<T> {
    const KIND: Kind = T::KIND;
    const OPTIONAL: bool = true;
    const CHOICES: &'static [ChoiceSpec] = T::CHOICES;
    const LENGTH: Option<usize> = T::LENGTH;
    const MIN: Option<f64> = T::MIN;
    const MAX: Option<f64> = T::MAX;

    fn from_value(value: Value) -> Option<Self> {
        T::from_value(value).map(Some)
    }

    fn absent() -> Option<Self> {
        Some(None)
    }
}

impl<T: InputType> InputType for Vec<T> {
    const KIND: Kind = Kind::List(&T::KIND);
    const MIN: Option<f64> = T::MIN;
    const MAX: Option<f64> = T::MAX;

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::List(items) => items.iter().cloned().map(T::from_value).collect(),
            _ => None,
        }
    }
}

impl<T: InputType, const N: usize> InputType for [T; N] {
    const KIND: Kind = Kind::List(&T::KIND);
    const LENGTH: Option<usize> = Some(N);
    const MIN: Option<f64> = T::MIN;
    const MAX: Option<f64> = T::MAX;

    fn from_value(value: Value) -> Option<Self> {
        Vec::from_value(value)?.try_into().ok()
    }
}

impl OutputType for u32 {
    const KIND: Kind = Kind::Integer;

    fn into_value(self) -> Value {
        Value::Integer(self.into())
    }
}

impl OutputType for usize {
    const KIND: Kind = Kind::Integer;

    fn into_value(self) -> Value {
        // No count in a mesh exceeds 2^63.
        Value::Integer(i64::try_from(self).unwrap_or(i64::MAX))
    }
}

impl<T: OutputType> OutputType for Vec<T> {
    const KIND: Kind = Kind::List(&T::KIND);

    fn into_value(self) -> Value {
        Value::List(self.into_iter().map(T::into_value).collect())
    }
}
