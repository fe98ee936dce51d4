//! What may be shown of a node before it is evaluated: declared by the node, so that
//! whoever draws knows no node by name.

use tessgraph_geometry::ArrayParts;

use super::{Args, EvalCx, NodeError};

/// Takes apart the array that a node would make of these values; `None` where it
/// makes one that is more than its parts.
pub type TakeApart = fn(Args, &EvalCx<'_>) -> Result<Option<ArrayParts>, NodeError>;

/// How a node's main result, a mesh or directions, follows some of its inputs.
#[derive(Debug, Clone, Copy)]
pub struct Preview {
    /// Inputs, a number each: all heights of the result are proportional to it. For
    /// a component that is z, for an array how far its vertices are from its base.
    pub heights: &'static [&'static str],
    /// Inputs that the result follows so little that a picture may leave it as it
    /// is, until it has been evaluated.
    pub slight: &'static [&'static str],
    /// Inputs whose heights become the result's.
    pub components: &'static [&'static str],
    /// Says where the vertices of the result come from, if that is an array.
    pub parts: Option<TakeApart>,
}

impl Preview {
    /// Nothing is shown before it is evaluated.
    pub const NONE: Self = Self {
        heights: &[],
        slight: &[],
        components: &[],
        parts: None,
    };
}
