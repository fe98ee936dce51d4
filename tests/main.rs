//! Tests of the whole program, in one binary.

mod cache;
mod cli;
mod closed_forms;
mod determinism;
mod errors;
mod figures;
mod graphs;
mod nodes;
mod peer;
mod per_vertex;
mod picture;
mod recomputation;
mod several_components;
mod support;
mod tidy;
mod timings;
mod watch;
