//! The engine of tessgraph: graph files, their checking, evaluation and caching.
//!
//! This crate names no node. A registry, a plain slice of [`NodeSpec`]s, says
//! which nodes there are; from it follow parsing, checking and reference pages.

pub mod check;
pub mod diagnostic;
pub mod document;
pub mod eval;
pub mod expr;
pub mod forms;
mod lines;
pub mod names;
pub mod node;
pub mod plan;
pub mod reference;
pub mod units;
pub mod value;
pub mod world;

pub use check::{LoadOptions, Loaded, load, load_with, study};
pub use diagnostic::{Diagnostic, Label, Place, Severity, Source};
pub use eval::{Engine, Evaluation, NodeRun, Observer, Outcome, Silent};
pub use lines::{Lines, Position};
pub use node::{Args, EvalCx, Inputs, Node, NodeError, NodeSpec, Outputs};
pub use plan::Plan;
pub use tessgraph_geometry::Quantity;
pub use units::Units;
pub use value::{Kind, Value, plain_number, six_digits};
