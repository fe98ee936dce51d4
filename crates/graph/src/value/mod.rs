//! The values that travel between nodes, in one table.

pub mod encode;
mod payload;
mod ports;
mod report;
mod stored;
mod table;

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::digest::Digest;
use tessgraph_geometry::{Directions, Field, Mesh};

pub(crate) use payload::list_digest;
pub use payload::{Payload, plain_number, six_digits};
pub use ports::{ChoiceSpec, FilePath, InputDefault, InputType, OutputType};
pub use report::{Report, ReportEntry, Scalar};
pub use stored::Stored;
pub use table::{Column, ColumnValues, Table};

use crate::expr::Formula;

/// Generates [`Value`], [`Kind`] and the conversions from one line per type.
macro_rules! values {
    ($($(#[doc = $doc:literal])* $variant:ident($payload:ty), $label:literal;)*) => {
        /// A value on an edge of the graph or at an input.
        #[derive(Debug, Clone)]
        pub enum Value {
            $($(#[doc = $doc])* $variant($payload),)*
            /// Several values of one kind.
            List(Arc<[Value]>),
        }

        /// The kind of a value or of an input.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Kind {
            $($(#[doc = $doc])* $variant,)*
            /// A file to read; its content, not its name, is what counts.
            Path,
            /// A number, or a field with one number per element.
            Amount,
            /// Several values of one kind.
            List(&'static Kind),
        }

        impl Kind {
            /// What a value of this kind is called in messages, with its article.
            pub fn label(self) -> String {
                match self {
                    $(Self::$variant => $label.to_owned(),)*
                    Self::Path => "a file path".to_owned(),
                    Self::Amount => "a number or a field".to_owned(),
                    Self::List(item) => format!("a list of {}", item.plural()),
                }
            }
        }

        impl Value {
            /// The kind of this value; the kind of a list is that of its first item.
            pub fn kind(&self) -> Kind {
                match self {
                    $(Self::$variant(_) => Kind::$variant,)*
                    Self::List(items) => match items.first().map(Value::kind) {
                        $(Some(Kind::$variant) => Kind::List(&Kind::$variant),)*
                        _ => Kind::List(&Kind::Number),
                    },
                }
            }

            /// Content digest; -0 counts as 0. Cached in the value's buffers.
            pub fn digest(&self) -> Digest {
                match self {
                    $(Self::$variant(payload) => payload.digest(),)*
                    Self::List(items) => list_digest(items.iter().map(Value::digest)),
                }
            }

            /// Writes the value, its type first; `false` if it is of a type that
            /// is never stored, and `out` is then of no use.
            pub fn encode(&self, out: &mut encode::Encoder) -> bool {
                match self {
                    $(Self::$variant(payload) => payload.encode(out.text(stringify!($variant))),)*
                    Self::List(items) => {
                        out.text("List").number(items.len() as u64);
                        items.iter().all(|item| item.encode(out))
                    }
                }
            }

            /// The value that [`Value::encode`] wrote; `None` for any other bytes.
            pub fn decode(from: &mut encode::Decoder<'_>) -> Option<Self> {
                match from.text()? {
                    $(stringify!($variant) => <$payload>::decode(from).map(Self::$variant),)*
                    "List" => from.nested(|from| {
                        let count = from.count()?;
                        let items: Option<Vec<_>> = (0..count).map(|_| Self::decode(from)).collect();
                        items.map(|items| Self::List(items.into()))
                    }),
                    _ => None,
                }
            }

            /// Calls `visit` with the address and bytes of each buffer inside,
            /// so that shared memory can be counted once.
            pub fn visit_buffers(&self, visit: &mut dyn FnMut(usize, usize)) {
                match self {
                    $(Self::$variant(payload) => payload.visit_buffers(visit),)*
                    Self::List(items) => items.iter().for_each(|item| item.visit_buffers(visit)),
                }
            }

            /// A few lines a person can judge: counts, ranges, measures in SI units.
            pub fn summary(&self) -> String {
                match self {
                    $(Self::$variant(payload) => payload.summary(),)*
                    Self::List(items) => payload::list_summary(items),
                }
            }
        }

        $(
            impl OutputType for $payload {
                const KIND: Kind = Kind::$variant;

                fn into_value(self) -> Value {
                    Value::$variant(self)
                }
            }

            impl InputType for $payload {
                const KIND: Kind = Kind::$variant;

                fn from_value(value: Value) -> Option<Self> {
                    match value {
                        Value::$variant(payload) => Some(payload),
                        _ => None,
                    }
                }
            }
        )*
    };
}

values! {
    /// True or false.
    Bool(bool), "true or false";
    /// A whole number.
    Integer(i64), "a whole number";
    /// A real number, in SI units and radians.
    Number(f64), "a number";
    /// A text.
    Text(Arc<str>), "a text";
    /// Three numbers, in SI units.
    Vector(DVec3), "a vector";
    /// One of several names.
    Choice(&'static str), "a choice";
    /// A polygon mesh.
    Mesh(Arc<Mesh>), "a mesh";
    /// Displacement directions of a mesh's vertices.
    Directions(Arc<Directions>), "directions";
    /// One number per vertex or face.
    Field(Arc<Field>), "a field";
    /// A formula over named variables.
    Formula(Arc<Formula>), "a formula";
    /// Named scalars.
    Report(Arc<Report>), "a report";
    /// Rows and typed columns.
    Table(Arc<Table>), "a table";
}

impl Kind {
    /// The label without its article: "mesh", "whole number".
    pub fn noun(self) -> String {
        let label = self.label();
        label
            .strip_prefix("a ")
            .map_or(label.clone(), str::to_owned)
    }

    /// Several of this kind: "meshes", "whole numbers".
    fn plural(self) -> String {
        match (self, self.noun()) {
            (Self::Bool, _) => "conditions".to_owned(),
            (Self::Directions, noun) => noun,
            (Self::Amount, _) => "numbers or fields".to_owned(),
            (_, noun) if noun.ends_with("sh") => noun + "es",
            (_, noun) => noun + "s",
        }
    }

    /// Whether a string at an input of this kind is an expression.
    pub fn is_scalar(self) -> bool {
        matches!(self, Self::Bool | Self::Integer | Self::Number)
    }

    /// Whether a result of kind `given` may be connected to an input of this kind.
    pub fn accepts(self, given: Kind) -> bool {
        match (self, given) {
            (Self::Amount, Self::Field | Self::Number | Self::Integer)
            | (Self::Number, Self::Integer) => true,
            (Self::List(wanted), Self::List(given)) => wanted.accepts(*given),
            _ => self == given,
        }
    }
}

impl Value {
    /// Bytes of all buffers inside, shared ones counted once.
    pub fn byte_size(&self) -> usize {
        let mut seen = std::collections::BTreeSet::new();
        let mut total = 0;
        self.visit_buffers(&mut |address, bytes| {
            if seen.insert(address) {
                total += bytes;
            }
        });
        total
    }
}
