//! The picture of a graph: parameters, nodes and outputs as boxes, and the
//! edges between them.

mod dot;
mod layout;
mod mermaid;
mod model;
mod order;
mod svg;
#[cfg(test)]
mod tests;

pub(crate) use dot::dot;
pub(crate) use mermaid::mermaid;
pub(crate) use model::Picture;
pub(crate) use svg::svg;
