//! Derives that describe the inputs and outputs of nodes as data.
//!
//! They emit constants and conversions only; what a node does is written by
//! hand. Doc comments become the reference page, so a missing one is an error.

mod attributes;
mod choice;
mod inputs;
mod outputs;

use proc_macro::TokenStream;
use syn::{DeriveInput, parse_macro_input};

/// Derives `Inputs` from a struct with one field per input.
///
/// The struct's doc comment is the node's reference page, each field's the
/// description of that input. `#[input(...)]` on a field takes:
/// `default = EXPR` (a bare identifier names a variant of a choice),
/// `min`, `above`, `max` (numbers in SI units), `unit = length | area | volume
/// | angle`, `free(x: length, u, ...)` and `attributes` for formulas, and
/// `only_with(choice = A | B)`.
#[proc_macro_derive(Inputs, attributes(input))]
pub fn derive_inputs(tokens: TokenStream) -> TokenStream {
    let item = parse_macro_input!(tokens as DeriveInput);
    inputs::expand(&item)
        .unwrap_or_else(syn::Error::into_compile_error)
        .into()
}

/// Derives `Outputs` from a struct with one field per result, the main one first.
///
/// `#[output(unit = ...)]` on a field states what it measures. With
/// `#[outputs(report)]` on the struct, a report of all scalar results is put
/// before them and becomes the main one.
#[proc_macro_derive(Outputs, attributes(outputs, output))]
pub fn derive_outputs(tokens: TokenStream) -> TokenStream {
    let item = parse_macro_input!(tokens as DeriveInput);
    outputs::expand(&item)
        .unwrap_or_else(syn::Error::into_compile_error)
        .into()
}

/// Derives an input type from an enum whose variants are the names to choose from.
///
/// `#[choice(into = path::Type)]` also derives `From` into an enum with
/// variants of the same names.
#[proc_macro_derive(Choice, attributes(choice))]
pub fn derive_choice(tokens: TokenStream) -> TokenStream {
    let item = parse_macro_input!(tokens as DeriveInput);
    choice::expand(&item)
        .unwrap_or_else(syn::Error::into_compile_error)
        .into()
}
