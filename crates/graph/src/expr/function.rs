//! The functions of the expression language.

use tessgraph_geometry::math::{self, PI};

/// A function of numbers, in the order of [`TABLE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Function {
    Min,
    Max,
    Clamp,
    Abs,
    Floor,
    Ceil,
    Round,
    Sqrt,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Exp,
    Ln,
    Pow,
    Rad,
    Deg,
    If,
}

/// Name, function, and what it takes; `min` and `max` take more as well.
const TABLE: [(&str, Function, &[&str]); 21] = [
    ("min", Function::Min, &["a", "b"]),
    ("max", Function::Max, &["a", "b"]),
    ("clamp", Function::Clamp, &["x", "low", "high"]),
    ("abs", Function::Abs, &["x"]),
    ("floor", Function::Floor, &["x"]),
    ("ceil", Function::Ceil, &["x"]),
    ("round", Function::Round, &["x"]),
    ("sqrt", Function::Sqrt, &["x"]),
    ("sin", Function::Sin, &["angle"]),
    ("cos", Function::Cos, &["angle"]),
    ("tan", Function::Tan, &["angle"]),
    ("asin", Function::Asin, &["x"]),
    ("acos", Function::Acos, &["x"]),
    ("atan", Function::Atan, &["x"]),
    ("atan2", Function::Atan2, &["y", "x"]),
    ("exp", Function::Exp, &["x"]),
    ("ln", Function::Ln, &["x"]),
    ("pow", Function::Pow, &["base", "exponent"]),
    ("rad", Function::Rad, &["degrees"]),
    ("deg", Function::Deg, &["radians"]),
    ("if", Function::If, &["condition", "a", "b"]),
];

impl Function {
    /// The function of that name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        TABLE
            .iter()
            .find(|(other, ..)| *other == name)
            .map(|(_, function, _)| *function)
    }

    /// The names of all functions.
    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        TABLE.iter().map(|(name, ..)| *name)
    }

    pub(super) fn name(self) -> &'static str {
        TABLE[self as usize].0
    }

    /// How it is written: `clamp(x, low, high)`.
    pub(super) fn usage(self) -> String {
        let more = if self.takes_more() { ", ..." } else { "" };
        format!(
            "{}({}{more})",
            self.name(),
            TABLE[self as usize].2.join(", ")
        )
    }

    /// How many arguments the function has, at least if it takes more.
    pub(super) fn arity(self) -> usize {
        TABLE[self as usize].2.len()
    }

    /// Whether further arguments may follow; the function is then applied to
    /// the result so far and the next argument.
    pub(super) fn takes_more(self) -> bool {
        matches!(self, Self::Min | Self::Max)
    }

    /// Applies the function to as many arguments as [`Function::arity`] says.
    pub(super) fn apply(self, args: &[f64]) -> f64 {
        match *args {
            [x] => self.of_one(x),
            [a, b] => self.of_two(a, b),
            [condition, a, b] if self == Self::If => {
                if condition != 0.0 {
                    a
                } else {
                    b
                }
            }
            [x, low, high] => least(greatest(x, low), high),
            _ => f64::NAN,
        }
    }

    fn of_one(self, x: f64) -> f64 {
        match self {
            Self::Abs => x.abs(),
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
            Self::Round => x.round(),
            Self::Sqrt => x.sqrt(),
            Self::Sin => math::sin(x),
            Self::Cos => math::cos(x),
            Self::Tan => math::tan(x),
            Self::Asin => math::asin(x),
            Self::Acos => math::acos(x),
            Self::Atan => math::atan(x),
            Self::Exp => math::exp(x),
            Self::Ln => math::ln(x),
            Self::Rad => x * (PI / 180.0),
            Self::Deg => x * (180.0 / PI),
            _ => f64::NAN,
        }
    }

    fn of_two(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Min => least(a, b),
            Self::Max => greatest(a, b),
            Self::Atan2 => math::atan2(a, b),
            Self::Pow => math::pow(a, b),
            _ => f64::NAN,
        }
    }
}

/// The smaller number. Unlike `f64::min` it keeps a NaN, so that a mistake is
/// not hidden, and of equals the first, so that zeros do not change sign by
/// platform.
fn least(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

fn greatest(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_enum() {
        for (place, (name, function, args)) in TABLE.iter().enumerate() {
            assert_eq!(*function as usize, place, "{name}");
            let numbers = vec![0.5; args.len()];
            assert!(
                function.apply(&numbers).is_finite(),
                "{name} is not implemented"
            );
        }
    }

    #[test]
    fn extremes_do_not_hide_mistakes() {
        assert!(least(f64::NAN, 1.0).is_nan() && least(1.0, f64::NAN).is_nan());
        assert!(greatest(f64::NAN, 1.0).is_nan() && greatest(1.0, f64::NAN).is_nan());
    }
}
