//! The expression language of graph files: numbers, names and functions.
//!
//! From loosest to tightest: `or`, `and`, `not`, comparisons (one at a time),
//! `+ -`, `* / %`, sign, `^` (from the right: `2^3^2` is `2^9`, and `-2^2` is
//! `-4`). `a % b` is never negative and smaller than `|b|`, so that
//! `index % 2` means the same on both sides of 0. Comparisons give true or
//! false, which is a type of its own: `if(levels > 2, 0.1, 0.2)`.
//!
//! Functions: `min max clamp abs floor ceil round sqrt sin cos tan asin acos
//! atan atan2 exp ln pow rad deg if`; constants: `pi tau true false`.
//! Arithmetic is `f64`, trigonometry is in radians and the same on every
//! machine; `round` takes halves away from zero.
//!
//! Everything here sees numbers in the file's units; [`Expression`] and
//! [`Formula`] convert at their border.

mod error;
mod expression;
mod formula;
mod function;
mod parse;
mod program;
mod target;
#[cfg(test)]
mod tests;
mod token;
mod types;

pub use error::ExprError;
pub use expression::{Expression, ResultUse};
pub use formula::{Formula, FormulaTemplate};
pub use parse::{Names, names};
pub use target::Target;
pub use types::{Leaf, Type, is_reserved};

pub(crate) use expression::{ResolvedName, Scalar};
pub(crate) use formula::FormulaSlots;
