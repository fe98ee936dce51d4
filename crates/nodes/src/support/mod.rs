//! What several nodes share: no node by itself.

pub(crate) mod arrayed;
pub(crate) mod choice_of_components;
pub(crate) mod elements;
pub(crate) mod memory;
