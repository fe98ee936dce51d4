//! The messages between the server and its page: JSON texts, each an object
//! whose `type` says what it is.
//!
//! The server keeps all state. A message replaces an earlier one of its type as
//! a whole, so a page that has one of each knows everything.

mod from_page;
mod graph;
mod picture;
mod sharing;
mod to_page;

use serde::{Deserialize, Serialize, Serializer};
use tessgraph_geometry::digest::Digest;

pub use from_page::{CutPlace, FromPage, MeasureEnd, PlaneAsked};
pub use graph::{
    Check, Described, Document, GraphNode, NodeInput, NodeOutcome, NodeResult, Output, Parameter,
    Problem, ProblemLabel, ResultSummary, State, Status,
};
pub use picture::{
    Instances, Measured, Picked, Previewed, Sectioned, Shown, ShownColumn, ShownDirections,
    ShownField, ShownMesh, ShownTable,
};
pub use sharing::{Lan, Pairing, Shares, Sharing};
pub use to_page::{Coming, Hello, Level, Notice, Study, ToPage};

/// The name of a buffer: 32 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct BufferName(pub Digest);

impl Serialize for BufferName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&self.0)
    }
}

/// A single value: of a parameter, a cell, a line of a report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// True or false.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A real number; null in JSON where it is not finite.
    Number(f64),
    /// A text, a path, the name of a choice.
    Text(String),
}

/// A named value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// The value, in the file's units.
    pub value: Option<Value>,
    /// The sign of its unit.
    pub unit: String,
}

/// A number with its unit, as text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Amount {
    /// With the digits people can use.
    pub text: String,
    /// With all that are known.
    pub exact: String,
}

impl From<String> for Amount {
    /// What is no number, or has no more digits.
    fn from(text: String) -> Self {
        let exact = text.clone();
        Self { text, exact }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_read_as_they_are_agreed() {
        let read = |text: &str| serde_json::from_str::<FromPage>(text);
        let name = || "t".to_owned();
        for (text, expected) in [
            (
                r#"{"type":"set","name":"t","value":0.5}"#,
                FromPage::Set {
                    name: name(),
                    value: Value::Number(0.5),
                },
            ),
            (
                r#"{"type":"write","name":"t","value":3}"#,
                FromPage::Write {
                    name: name(),
                    value: Value::Integer(3),
                },
            ),
            (r#"{"type":"undo"}"#, FromPage::Undo),
            (
                r#"{"type":"show","node":"t"}"#,
                FromPage::Show {
                    node: name(),
                    result: None,
                },
            ),
            (
                r#"{"type":"pick","request":7,"face":2}"#,
                FromPage::Pick {
                    request: 7,
                    face: Some(2),
                    vertex: None,
                },
            ),
        ] {
            assert_eq!(read(text).unwrap(), expected);
        }
        for wrong in [
            "",
            "{}",
            r#"{"type":"format"}"#,
            r#"{"type":"set","name":"t"}"#,
            r#"{"type":"pick","request":-1}"#,
        ] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn messages_are_flat_objects_with_a_type() {
        let status = ToPage::Status(Status {
            state: State::UpToDate,
            ms: Some(1.5),
            ..Status::default()
        });
        assert_eq!(
            serde_json::to_string(&status).unwrap(),
            r#"{"type":"status","state":"up_to_date","ms":1.5}"#
        );
        let entry = Entry {
            name: "a".to_owned(),
            value: Some(Value::Number(f64::NAN)),
            unit: String::new(),
        };
        assert_eq!(
            serde_json::to_string(&entry).unwrap(),
            r#"{"name":"a","value":null,"unit":""}"#
        );
    }
}
