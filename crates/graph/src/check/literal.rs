//! What a value in the file means at an input of some kind.

use std::sync::Arc;

use glam::DVec3;

use super::inputs::Checker;
use crate::document::{Item, Number, Shape};
use crate::expr::{Formula, Target};
use crate::names::alternatives;
use crate::node::InputSpec;
use crate::plan::Origin;
use crate::value::{Kind, Value};

impl Checker<'_, '_> {
    /// Where the value of an input, or of a part of it, comes from. `kind` is
    /// the kind of the part. `None` after an error, which has been reported.
    pub(super) fn origin(
        &mut self,
        input: &'static InputSpec,
        kind: Kind,
        item: &Item,
    ) -> Option<Origin> {
        let text = item.text(self.scope.text);
        match (kind, &item.shape, text) {
            (Kind::Text | Kind::Path, _, Some(text)) => self.interpolate(&text, kind == Kind::Path),
            (Kind::Choice, _, Some(text)) => self.choice_parameter(input, &text),
            (Kind::Choice, Shape::Name, _) => self.choice(input, item),
            (Kind::Formula, _, Some(text)) => self.formula(input, &text),
            (Kind::Amount, _, Some(text)) => self.amount(input, &text),
            (kind, _, Some(text)) if kind.is_scalar() => self.scalar(input, kind, &text),
            (_, _, Some(text)) => self.reference(input, kind, &text),
            (Kind::Number | Kind::Integer | Kind::Amount | Kind::Formula, Shape::Number, _) => {
                self.number(input, kind, item)
            }
            (Kind::Bool, Shape::Name, _) => self.boolean(input, item),
            (Kind::Vector, Shape::Tuple(tuple), _) if tuple.name.is_none() => {
                self.vector(input, item, &tuple.items)
            }
            (Kind::List(part), Shape::List(items), _) => self.list(input, *part, items),
            // A list of fixed length reads as a tuple too: `cells: (8, 8)`.
            (Kind::List(part), Shape::Tuple(tuple), _)
                if input.length.is_some() && tuple.name.is_none() =>
            {
                self.list(input, *part, &tuple.items)
            }
            _ => {
                self.wrong_literal(input, kind, item);
                None
            }
        }
    }

    fn number(&mut self, input: &InputSpec, kind: Kind, item: &Item) -> Option<Origin> {
        let number = item.number(self.scope.text)?;
        let target = Target::of_part(input, kind, self.scope.units);
        let value = match (kind, number) {
            (Kind::Formula, _) => {
                let number = match number {
                    Number::Whole(number) => number as f64,
                    Number::Real(number) => number,
                };
                finite(input, number * target.scale())
                    .map(|number| Value::Formula(Arc::new(Formula::constant(number))))
            }
            (_, Number::Whole(number)) => target.of_integer(number),
            (_, Number::Real(number)) => target.of_number(number),
        };
        match value {
            Ok(value) => Some(Origin::Constant(value)),
            Err(message) => {
                let help = range_help(&target);
                self.report("out_of_range", &item.span, message, "this value", help);
                None
            }
        }
    }

    fn boolean(&mut self, input: &InputSpec, item: &Item) -> Option<Origin> {
        match item.name(self.scope.text) {
            Some("true") => Some(Origin::Constant(Value::Bool(true))),
            Some("false") => Some(Origin::Constant(Value::Bool(false))),
            _ => {
                self.wrong_literal(input, Kind::Bool, item);
                None
            }
        }
    }

    pub(super) fn vector(
        &mut self,
        input: &'static InputSpec,
        item: &Item,
        items: &[Item],
    ) -> Option<Origin> {
        if items.len() != 3 {
            let message = format!("`{}` takes three numbers, not {}", input.name, items.len());
            let help = "write `(x, y, z)`";
            self.report("wrong_length", &item.span, message, "here", help);
            return None;
        }
        let parts: Vec<Option<Origin>> = items
            .iter()
            .map(|part| self.origin(input, Kind::Number, part))
            .collect();
        let parts: Vec<Origin> = parts.into_iter().collect::<Option<_>>()?;
        let known: Vec<f64> = parts.iter().filter_map(known_number).collect();
        if let [x, y, z] = *known {
            return Some(Origin::Constant(Value::Vector(DVec3::new(x, y, z))));
        }
        Some(Origin::Vector(Box::new(parts.try_into().ok()?)))
    }

    fn list(&mut self, input: &'static InputSpec, part: Kind, items: &[Item]) -> Option<Origin> {
        let items: Vec<Option<Origin>> = items
            .iter()
            .map(|item| self.origin(input, part, item))
            .collect();
        let items: Vec<Origin> = items.into_iter().collect::<Option<_>>()?;
        let known = items.iter().map(|item| match item {
            Origin::Constant(value) => Some(value.clone()),
            _ => None,
        });
        match known.collect::<Option<Arc<[Value]>>>() {
            Some(values) => Some(Origin::Constant(Value::List(values))),
            None => Some(Origin::List(items)),
        }
    }
}

fn known_number(origin: &Origin) -> Option<f64> {
    match origin {
        Origin::Constant(Value::Number(number)) => Some(*number),
        _ => None,
    }
}

fn finite(input: &InputSpec, number: f64) -> Result<f64, String> {
    if number.is_finite() {
        Ok(number)
    } else {
        Err(format!(
            "`{}` takes a finite number, not {number}",
            input.name
        ))
    }
}

/// A way out for a number outside its range.
pub(super) fn range_help(target: &Target) -> String {
    let number = if target.kind() == Kind::Integer {
        "whole number"
    } else {
        "number"
    };
    match target.range().as_str() {
        "finite" => format!("give a finite {number}"),
        range if range.starts_with(|c: char| c.is_ascii_digit() || c == '-') => {
            format!("give a {number} from {range}")
        }
        range => format!("give a {number} {range}"),
    }
}

/// How values of a kind are written.
pub(super) fn form(input: &InputSpec, kind: Kind) -> String {
    match kind {
        Kind::Number | Kind::Integer => "write a number, or an expression in quotes".to_owned(),
        Kind::Bool => "write true or false, or a condition in quotes".to_owned(),
        Kind::Amount => "write a number, an expression, or the name of a field".to_owned(),
        Kind::Formula => "write a number, or a formula in quotes".to_owned(),
        Kind::Text | Kind::Path => "write it in quotes".to_owned(),
        Kind::Vector => "write `(x, y, z)`".to_owned(),
        Kind::Choice => {
            format!(
                "choose {}",
                alternatives(input.choices.iter().map(|choice| choice.name))
            )
        }
        Kind::List(_) if input.length.is_some() => "write `(a, b)` or `[a, b]`".to_owned(),
        Kind::List(_) => "write `[a, b]`".to_owned(),
        _ => "write the name of a node in quotes: `\"node\"` or `\"node.result\"`".to_owned(),
    }
}
