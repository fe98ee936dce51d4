//! Expressions against a table, and against a tree that is computed directly.

use proptest::prelude::*;

use super::types::compile;
use super::*;
use crate::node::InputSpec;
use crate::units::Units;
use crate::value::{Kind, Value};
use tessgraph_geometry::{Quantity, math};

const VARIABLES: [(&str, f64); 3] = [("a", 1.5), ("b.c", -2.0), ("n", 7.0)];

/// The value of an expression over [`VARIABLES`]; true is 1.
fn value(text: &str) -> Result<f64, Vec<ExprError>> {
    let compiled = compile(text, &mut |name, span| match VARIABLES
        .iter()
        .position(|(other, _)| *other == name)
    {
        Some(slot) => Ok(Some(Leaf::Variable {
            slot: slot as u32,
            ty: Type::Number,
            scale: 1.0,
        })),
        None => Err(ExprError::new(span, "unknown").code("unknown_name")),
    })?;
    Ok(compiled.program.run(&VARIABLES.map(|(_, value)| value)))
}

const TABLE: &[(&str, f64)] = &[
    ("1 + 2 * 3", 7.0),
    ("(1 + 2) * 3", 9.0),
    ("10 - 4 - 3", 3.0),
    ("24 / 4 / 2", 3.0),
    ("2 * 3 % 4", 2.0),
    ("-2^2", -4.0),
    ("(-2)^2", 4.0),
    ("2^3^2", 512.0),
    ("2^-1", 0.5),
    ("2^-2^2", 0.0625),
    ("-2^-2", -0.25),
    ("--3", 3.0),
    ("+3", 3.0),
    ("2 - -3", 5.0),
    ("2 * -3", -6.0),
    ("- 3 * 2", -6.0),
    ("7 % 3", 1.0),
    ("-7 % 3", 2.0),
    ("7 % -3", 1.0),
    ("-0.5 % 1", 0.5),
    ("1 < 2", 1.0),
    ("1 + 1 < 3 - 2", 0.0),
    ("2 <= 2 and 3 >= 4", 0.0),
    ("1 == 1 or 1 == 2 and 1 == 3", 1.0),
    ("(1 == 1 or 1 == 2) and 1 == 3", 0.0),
    ("not 1 == 2", 1.0),
    ("not 1 == 2 and 1 == 2", 0.0),
    ("not not true", 1.0),
    ("true == not false", 1.0),
    ("1 != 2", 1.0),
    ("if(1 < 2, 10, 20) + 1", 11.0),
    ("if(false, 10, 20)", 20.0),
    ("if(true, false, true)", 0.0),
    ("min(3, 1, 2)", 1.0),
    ("max(3, 1, 2) + min(1, 2)", 4.0),
    ("clamp(5, 0, 3)", 3.0),
    ("clamp(-5, 0, 3)", 0.0),
    ("abs(-3)", 3.0),
    ("floor(-1.5)", -2.0),
    ("ceil(-1.5)", -1.0),
    ("round(-1.5)", -2.0),
    ("round(2.5)", 3.0),
    ("sqrt(16)", 4.0),
    ("pow(2, 10)", 1024.0),
    ("rad(180) - pi", 0.0),
    ("deg(tau)", 360.0),
    ("atan2(1, 0) * 2 - pi", 0.0),
    (
        "sin(0) + cos(0) + tan(0) + asin(0) + acos(1) + atan(0)",
        1.0,
    ),
    ("exp(0) + ln(1)", 1.0),
    (".5 + 5. + 1e2 + 1.5E-1", 105.65),
    ("a * 2 + b.c", 1.0),
    ("n", 7.0),
    ("  n\n% 2\t", 1.0),
    ("if(n % 2 == 1, a, b.c)", 1.5),
];

#[test]
fn operators_bind_as_in_mathematics() {
    for &(text, wanted) in TABLE {
        assert_eq!(
            value(text).map(f64::to_bits),
            Ok((wanted + 0.0_f64).to_bits()),
            "{text}"
        );
    }
}

#[test]
fn mistakes_are_found_where_they_are() {
    let table = [
        ("", "", "bad_expression"),
        ("1 +", "", "bad_expression"),
        ("1 + * 2", "*", "bad_expression"),
        ("(1", "(", "bad_expression"),
        ("1)", ")", "bad_expression"),
        ("()", ")", "bad_expression"),
        ("min()", "min", "bad_expression"),
        ("min(1,)", "min", "bad_expression"),
        ("abs(1, 2)", "abs", "bad_expression"),
        ("min(1; 2)", ";", "bad_expression"),
        ("foo(1)", "foo", "unknown_name"),
        ("foo + 1", "foo", "unknown_name"),
        ("2x", "x", "bad_expression"),
        ("12cm", "cm", "bad_expression"),
        ("1e999", "1e999", "bad_expression"),
        ("1 = 2", "=", "bad_expression"),
        ("a && b", "&&", "bad_expression"),
        ("!a", "!", "bad_expression"),
        ("1 < 2 == 3", "==", "bad_expression"),
        ("true + 1", "true", "bad_expression"),
        ("-true", "true", "bad_expression"),
        ("1 and true", "1", "bad_expression"),
        ("true == 1", "true == 1", "bad_expression"),
        ("if(1, 2, 3)", "1", "bad_expression"),
        ("if", "if", "bad_expression"),
        ("é + 1", "é", "bad_expression"),
        ("a.", ".", "bad_expression"),
        ("1.2.3", ".3", "bad_expression"),
    ];
    for (text, part, code) in table {
        let errors = value(text).expect_err(text);
        assert_eq!(
            (&text[errors[0].span.clone()], errors[0].code),
            (part, code),
            "{text}"
        );
    }
    assert_eq!(value("foo + bar * (true + baz)").unwrap_err().len(), 4);
}

#[test]
fn names_have_places() {
    let found = names("if(level > 2, check.pairs, pi) * level").unwrap();
    let wanted = [("level", 3..8), ("check.pairs", 14..25), ("level", 33..38)];
    assert_eq!(found, wanted);
}

#[test]
fn long_sums_are_fine_and_deep_brackets_refused() {
    let sum = format!("1{}", " + 1".repeat(5000));
    assert_eq!(value(&sum), Ok(5001.0));
    for deep in [
        "(".repeat(30_000),
        "-".repeat(30_000),
        "2^".repeat(10_000) + "2",
    ] {
        assert!(value(&deep).unwrap_err()[0].message.contains("nested"));
    }
    assert!(
        value(&"1+".repeat(100_000)).unwrap_err()[0]
            .message
            .contains("longer")
    );
    // Deep for the stack of numbers, though not for the parser's.
    let deep = format!("{}1{}", "1 + n * (".repeat(60), ")".repeat(60));
    assert!(value(&deep).unwrap_err()[0].message.contains("nested"));
    let fine = format!("{}1{}", "1 + n * (".repeat(25), ")".repeat(25));
    assert!(value(&fine).is_ok());
}

/// An expression as a tree, computed by the shortest code there is.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Variable(usize),
    Negate(Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
    Call(&'static str, Vec<Tree>),
    If(Box<Tree>, &'static str, Box<Tree>, Box<Tree>),
}

impl Tree {
    fn compute(&self) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::Variable(index) => VARIABLES[*index].1,
            Self::Negate(x) => -x.compute(),
            Self::Binary(sign, a, b) => {
                let (a, b) = (a.compute(), b.compute());
                match *sign {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    "%" => a.rem_euclid(b),
                    _ => math::pow(a, b),
                }
            }
            Self::Call(name, args) => {
                let args: Vec<f64> = args.iter().map(Tree::compute).collect();
                match *name {
                    "sin" => math::sin(args[0]),
                    "sqrt" => args[0].sqrt(),
                    "floor" => args[0].floor(),
                    "atan2" => math::atan2(args[0], args[1]),
                    _ => args
                        .into_iter()
                        .reduce(|a, b| if b > a || b.is_nan() { b } else { a })
                        .unwrap(),
                }
            }
            Self::If(a, sign, b, c) => {
                let (x, y) = (a.compute(), b.compute());
                let truth = if *sign == "<" { x < y } else { x >= y };
                if truth { x } else { c.compute() }
            }
        }
    }

    /// How tightly the outermost operator binds.
    fn level(&self) -> u8 {
        match self {
            Self::Binary("+" | "-", ..) => 1,
            Self::Binary("*" | "/" | "%", ..) => 2,
            Self::Negate(_) => 3,
            Self::Binary(..) => 4,
            _ => 5,
        }
    }

    /// As text with no bracket too many.
    fn text(&self) -> String {
        let part = |tree: &Tree, level: u8| {
            if tree.level() < level {
                format!("({})", tree.text())
            } else {
                tree.text()
            }
        };
        match self {
            Self::Number(number) => format!("{number:?}"),
            Self::Variable(index) => VARIABLES[*index].0.to_owned(),
            Self::Negate(x) => format!("-{}", part(x, 3)),
            // A power's base must be closed; its exponent may have a sign.
            Self::Binary("^", a, b) => format!("{}^{}", part(a, 5), part(b, 3)),
            Self::Binary(sign, a, b) => {
                format!(
                    "{} {sign} {}",
                    part(a, self.level()),
                    part(b, self.level() + 1)
                )
            }
            Self::Call(name, args) => {
                let args: Vec<String> = args.iter().map(Tree::text).collect();
                format!("{name}({})", args.join(", "))
            }
            Self::If(a, sign, b, c) => {
                format!("if({0} {sign} {1}, {0}, {2})", a.text(), b.text(), c.text())
            }
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (0..1000u32).prop_map(|number| Tree::Number(f64::from(number) / 8.0)),
        (0..VARIABLES.len()).prop_map(Tree::Variable),
    ];
    leaf.prop_recursive(5, 40, 3, |inner| {
        let signs = proptest::sample::select(vec!["+", "-", "*", "/", "%", "^"]);
        let ones = proptest::sample::select(vec!["sin", "sqrt", "floor"]);
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            3 => (signs, pair.clone())
                .prop_map(|(sign, (a, b))| Tree::Binary(sign, Box::new(a), Box::new(b))),
            1 => inner.clone().prop_map(|x| Tree::Negate(Box::new(x))),
            1 => (ones, inner.clone()).prop_map(|(name, x)| Tree::Call(name, vec![x])),
            1 => pair.prop_map(|(a, b)| Tree::Call("atan2", vec![a, b])),
            1 => proptest::collection::vec(inner.clone(), 2..4)
                .prop_map(|args| Tree::Call("max", args)),
            1 => (inner.clone(), inner.clone(), inner, any::<bool>()).prop_map(|(a, b, c, less)| {
                let sign = if less { "<" } else { ">=" };
                Tree::If(Box::new(a), sign, Box::new(b), Box::new(c))
            }),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn programs_compute_what_their_trees_do(tree in tree()) {
        let (wanted, text) = (tree.compute(), tree.text());
        let found = value(&text).unwrap_or_else(|errors| panic!("{text}: {errors:?}"));
        let same = found.is_nan() && wanted.is_nan() || (found + 0.0).to_bits() == (wanted + 0.0).to_bits();
        prop_assert!(same, "{text}: {found} instead of {wanted}");
    }

    #[test]
    fn any_text_is_read_or_refused_in_place(pieces in proptest::collection::vec(
        proptest::sample::select(vec![
            "1", "2.5", "a", "b.c", "if(", "min(", ")", "(", ",", "+", "-", "^", "and", "not",
            "<", "==", " ", "é", "×", ".", "e", "1e", "true", "!", "\u{0}", "pi",
        ]),
        0..30,
    )) {
        let text = pieces.concat();
        if let Err(errors) = value(&text) {
            prop_assert!(!errors.is_empty());
            for error in errors {
                prop_assert!(text.get(error.span.clone()).is_some(), "{text}: {error:?}");
            }
        }
    }
}

fn formula(text: &str, units: Units) -> Formula {
    let scale = units.to_si(Quantity::Length);
    let template = FormulaTemplate::compile(text, scale, |name, _, slots| {
        let scale = if name == "x" {
            units.to_si(Quantity::Length)
        } else {
            1.0
        };
        let slot = slots.name(name, name != "x", scale);
        Ok(Some(Leaf::Variable {
            slot,
            ty: Type::Number,
            scale,
        }))
    });
    template.unwrap().bind(&|_| Value::Number(0.0)).unwrap()
}

#[test]
fn digests_know_what_is_computed_and_not_how_it_is_written() {
    let digest = |text, units| formula(text, units).digest();
    assert_eq!(digest("x * 2", Units::M), digest(" x*(1 + 1) ", Units::M));
    assert_eq!(digest("0.12", Units::M), digest("12", Units::Cm));
    assert_eq!(digest("0.12", Units::M), Formula::constant(0.12).digest());
    assert_eq!(digest("-0", Units::M), digest("0", Units::M));
    for other in ["x * 3", "x / 2", "2 * x", "y * 2", "x * 2 + 0 * y"] {
        assert_ne!(
            digest("x * 2", Units::M),
            digest(other, Units::M),
            "{other}"
        );
    }
    // x + 1 m is another thing than x + 1 cm.
    assert_ne!(digest("x + 1", Units::M), digest("x + 1", Units::Cm));
}

#[test]
fn formulas_of_one_number_are_that_number_in_any_unit() {
    for units in [Units::M, Units::Cm, Units::Mm, Units::In] {
        let same = formula("x", units);
        assert_eq!(same.names(), ["x"]);
        assert!((same.evaluate(&[0.3]) - 0.3).abs() < 1e-16);
        assert_eq!(
            formula("2 + 3", units).as_constant(),
            Some(5.0 * units.metres())
        );
    }
}

#[test]
fn a_known_expression_is_a_value_at_once() {
    const SPEC: InputSpec = InputSpec {
        name: "levels",
        doc: "Levels.",
        kind: Kind::Integer,
        quantity: Quantity::Number,
        optional: false,
        default: None,
        min: Some(0.0),
        above: None,
        max: Some(8.0),
        choices: &[],
        length: None,
        free: &[],
        attributes: false,
        only_with: None,
    };
    let compile = |text: &str| {
        Expression::compile(text, Target::of_input(&SPEC, Units::M), |_, _, _| {
            Ok(Some(Leaf::Number(3.0)))
        })
    };
    assert!(matches!(
        compile("n + 1"),
        Ok(Scalar::Known(Value::Integer(4)))
    ));
    for (text, said) in [
        ("n / 2", "whole number, not 1.5"),
        ("n * 3", "0 to 8, but is 9"),
    ] {
        let Err(errors) = compile(text) else {
            panic!("{text} is accepted")
        };
        assert!(errors[0].message.contains(said), "{}", errors[0].message);
    }
}
