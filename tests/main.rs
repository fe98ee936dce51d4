//! Tests of the whole program, in one binary.

mod bad_geometry;
mod bad_input;
mod cache;
mod cli;
mod closed_forms;
mod determinism;
mod errors;
mod faults;
mod figures;
mod graphs;
mod includes;
mod nodes;
mod peer;
mod per_vertex;
mod picture;
mod recomputation;
mod require;
mod roofs;
mod several_components;
mod smoothing;
mod statuses;
mod study;
mod support;
mod tidy;
mod timings;
mod watch;
