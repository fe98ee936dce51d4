//! Graph files as data: RON text in, every part with its exact place out.
//!
//! `ron` decides what is RON: it reads the whole text first and reports the
//! first mistake of syntax. What it accepted is then walked once more by
//! `walk`, which only finds out where things are; a RON value carries no
//! places by itself. Nothing here knows which kinds of node there are.

pub mod edit;
mod encoding;
mod fields;
mod foreign;
mod parameter;
mod params;
mod problems;
mod raw;
mod sections;
mod study;
mod syntax;
mod text;
mod walk;

use std::ops::Range;
use std::sync::Arc;

pub(crate) use fields::Fields;
pub(crate) use parameter::{ParamKind, Parameter};
pub(crate) use problems::Problems;
pub(crate) use raw::{Field, Item, Number, Shape, plain};
pub(crate) use study::{StudyDocument, read_study};
pub(crate) use text::Text;

use crate::diagnostic::{Diagnostic, Source};
use crate::units::Units;
use crate::value::Kind;
use tessgraph_geometry::Quantity;

/// The version of the graph file format that this program reads.
pub const VERSION: i64 = 1;

/// The largest graph file that is read, in bytes. A hundred thousand nodes
/// take about five million.
pub const MAX_BYTES: usize = 64 << 20;

/// A name or value with its place in the text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Spanned<T> {
    pub(crate) value: T,
    pub(crate) span: Range<usize>,
}

/// A graph file, read but not checked against any kinds of node.
#[derive(Debug)]
pub(crate) struct Document {
    pub(crate) source: Arc<Source>,
    pub(crate) units: Units,
    /// Parameters, then those inputs of the graph that can be parameters.
    pub(crate) params: Vec<Parameter>,
    /// What the graph takes from another graph.
    pub(crate) inputs: Vec<DeclaredInput>,
    pub(crate) nodes: Vec<NodeEntry>,
    pub(crate) outputs: Vec<Link>,
    /// Whether outputs are missing because they could not be read.
    pub(crate) outputs_damaged: bool,
    /// What the graph gives to another graph.
    pub(crate) results: Vec<Link>,
    /// The place to add a missing section at: the top-level name or bracket.
    pub(crate) head: Range<usize>,
}

/// An input of the graph as declared.
#[derive(Debug)]
pub(crate) struct DeclaredInput {
    pub(crate) name: Spanned<String>,
    pub(crate) kind: DeclaredKind,
    /// The declaration.
    pub(crate) span: Range<usize>,
    /// Whether another graph must give it.
    pub(crate) required: bool,
}

/// What an input of the graph takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum DeclaredKind {
    /// What a parameter takes: the one at that place in [`Document::params`].
    Param(usize),
    /// A value that only a node of another graph can give.
    Value(Kind, Quantity),
    /// Nothing sensible, as reported.
    Unknown,
}

/// A node as written.
#[derive(Debug)]
pub(crate) struct NodeEntry {
    pub(crate) name: Spanned<String>,
    pub(crate) kind: Spanned<String>,
    /// The inputs in order, repeats and unknown names included.
    pub(crate) fields: Vec<Field>,
    /// From the kind to the closing bracket.
    pub(crate) span: Range<usize>,
}

/// An output path or the name of a result, and the reference it stands for.
#[derive(Debug)]
pub(crate) struct Link {
    pub(crate) name: Text,
    pub(crate) target: Text,
}

/// Reads a graph file from its bytes.
///
/// # Errors
/// When there is nothing to go on with: not text, not RON, not a graph, or of
/// a newer version. Everything else that is wrong is in the [`Problems`].
pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<(Document, Problems), Vec<Diagnostic>> {
    let source = encoding::decode(name, bytes).map_err(|problem| vec![*problem])?;
    let root = syntax::parse(&source).map_err(|problem| vec![*problem])?;
    sections::read(&source, &root)
}
