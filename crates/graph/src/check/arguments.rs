//! Values for the parameters of another graph: of an included one, or of the
//! graph that a study varies.

use std::ops::Range;

use super::expressions::slot_of;
use super::inputs::Checker;
use super::scope::Named;
use crate::diagnostic::{Diagnostic, Label, Place};
use crate::document::{Document, Item, Number, ParamKind, Parameter, Shape, Text};
use crate::expr::{Expression, Scalar, Target};
use crate::names::shown;
use crate::units::Units;
use crate::value::{Kind, Value};
use tessgraph_geometry::Quantity;

/// A parameter of another graph that is to be given a value.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub(super) param: &'a Parameter,
    pub(super) document: &'a Document,
}

/// What a parameter is given.
pub(super) enum Argument {
    /// A value in the units of the graph that takes it, and the folder a path
    /// is named from.
    Known(Value, Option<String>),
    /// A number or condition that depends on results of nodes.
    Later(Expression),
}

impl Wanted<'_> {
    /// Where the parameter is declared.
    pub(super) fn declared(&self) -> Place {
        declared(self.document, &self.param.span)
    }
}

/// A declaration in another graph, as a place to point at.
pub(super) fn declared(document: &Document, span: &Range<usize>) -> Place {
    Place {
        source: std::sync::Arc::clone(&document.source),
        label: Label {
            span: span.clone(),
            message: "declared here".to_owned(),
        },
    }
}

impl Checker<'_, '_> {
    /// What `item` gives to a parameter of another graph; `None` after an
    /// error, which has been reported.
    pub(super) fn argument(&mut self, wanted: Wanted<'_>, item: &Item) -> Option<Argument> {
        let known = |value| Some(Argument::Known(value, None));
        let text = item.text(self.scope.text);
        match (wanted.param.kind, &item.shape, text) {
            (ParamKind::Number | ParamKind::Integer, Shape::Number, _) => {
                let number = item.number(self.scope.text)?;
                known(self.crossing(wanted, number, &item.span)?)
            }
            (ParamKind::Number | ParamKind::Integer | ParamKind::Bool, _, Some(text)) => {
                self.scalar_argument(wanted, &text)
            }
            (ParamKind::Bool, Shape::Name, _) => match item.name(self.scope.text) {
                Some("true") => known(Value::Bool(true)),
                Some("false") => known(Value::Bool(false)),
                _ => self.wrong_argument(wanted, item),
            },
            (ParamKind::Text, _, Some(text)) => {
                known(Value::Text(self.interpolated(&text)?.into()))
            }
            (ParamKind::Path, _, Some(text)) => {
                let folder = self.folder_of(&text);
                let path = self.interpolated(&text)?;
                Some(Argument::Known(Value::Text(path.into()), Some(folder)))
            }
            (ParamKind::Choice, Shape::Name, _) => {
                let name = item.name(self.scope.text)?;
                known(self.chosen(wanted, name, &item.span)?)
            }
            (ParamKind::Choice, _, Some(text)) => self.choice_argument(wanted, item, &text),
            _ => self.wrong_argument(wanted, item),
        }
    }

    /// Reports an error at `span` about a parameter of another graph.
    fn refuse(&mut self, wanted: Wanted<'_>, error: Diagnostic, help: String) {
        let error = error.with_places([wanted.declared()]).with_help(help);
        self.problems.add(error.with_node(self.node));
    }

    fn wrong_argument(&mut self, wanted: Wanted<'_>, item: &Item) -> Option<Argument> {
        let (name, label) = (shown(&wanted.param.name.value), item.label(self.scope.text));
        let kind = wanted.param.kind;
        let message = format!("`{name}` takes {}, not {label}", kind.label());
        let error = self
            .problems
            .error("wrong_kind", &item.span, message, label);
        let help = match kind {
            ParamKind::Number | ParamKind::Integer => "write a number, or an expression in quotes",
            ParamKind::Bool => "write true or false, or a condition in quotes",
            ParamKind::Text | ParamKind::Path => "write it in quotes",
            ParamKind::Choice => "write one of its names without quotes",
        };
        self.refuse(wanted, error, help.to_owned());
        None
    }

    fn choice_argument(
        &mut self,
        wanted: Wanted<'_>,
        item: &Item,
        text: &Text,
    ) -> Option<Argument> {
        let Some(Named::Param(index)) = self.scope.find(&text.value) else {
            return self.wrong_argument(wanted, item);
        };
        let own = &self.scope.params[index];
        match (own.kind, own.value.as_ref()?) {
            (ParamKind::Choice, Value::Text(name)) => {
                let name = name.as_ref().to_owned();
                let value = self.chosen(wanted, &name, &item.span)?;
                Some(Argument::Known(value, None))
            }
            _ => self.wrong_argument(wanted, item),
        }
    }

    fn chosen(&mut self, wanted: Wanted<'_>, name: &str, span: &Range<usize>) -> Option<Value> {
        match wanted.param.choice(name) {
            Ok(value) => Some(value),
            Err((message, help)) => {
                let error =
                    self.problems
                        .error("unknown_choice", span, message, "not one of its choices");
                self.refuse(wanted, error, help.unwrap_or_default());
                None
            }
        }
    }

    /// A number of this file as the other file would write it. Between files of
    /// the same units it stays the same to the last bit.
    pub(super) fn crossing(
        &mut self,
        wanted: Wanted<'_>,
        number: Number,
        span: &Range<usize>,
    ) -> Option<Value> {
        let quantity = wanted.param.target.quantity();
        let (from, to) = (self.scope.units, wanted.document.units);
        let number = match number {
            number if from == to || quantity == Quantity::Number => number,
            Number::Whole(number) => Number::Real(converted(number as f64, from, to, quantity)),
            Number::Real(number) => Number::Real(converted(number, from, to, quantity)),
        };
        match wanted.param.number(number) {
            Ok(value) => Some(value),
            Err(message) => {
                let error = self
                    .problems
                    .error("out_of_range", span, message, "this value");
                let help = super::literal::range_help(&wanted.param.target.in_units(from));
                self.refuse(wanted, error, help);
                None
            }
        }
    }

    /// An expression as argument: a value now, or one to be computed.
    fn scalar_argument(&mut self, wanted: Wanted<'_>, text: &Text) -> Option<Argument> {
        let kind = wanted.param.value_kind();
        let plain = match kind {
            Kind::Bool => Kind::Bool,
            _ => Kind::Number,
        };
        match self.compiled(&wanted.param.name.value, plain, text)? {
            Scalar::Known(Value::Number(number)) => {
                let value = self.crossing(wanted, Number::Real(number), &text.span)?;
                Some(Argument::Known(value, None))
            }
            Scalar::Known(value) => Some(Argument::Known(value, None)),
            // The same again, with the unit and range it will have to keep.
            Scalar::Later(expression) if kind == Kind::Bool => Some(Argument::Later(expression)),
            Scalar::Later(_) => {
                let target = wanted.param.target.in_units(self.scope.units);
                match self.compiled_for(target, text)? {
                    Scalar::Later(expression) => Some(Argument::Later(expression)),
                    Scalar::Known(_) => None,
                }
            }
        }
    }

    /// An expression of either type, in the file's units.
    pub(super) fn number_or_condition(&mut self, name: &str, text: &Text) -> Option<Scalar> {
        let (scope, units) = (self.scope, self.scope.units);
        let compiled = [Kind::Number, Kind::Bool].map(|kind| {
            let target = Target::of_parameter(name, kind, Quantity::Number, units, (None, None));
            Expression::compile(&text.value, target, |name, span, uses| {
                scope.leaf(name, span, |use_| slot_of(uses, use_))
            })
        });
        let [number, condition] = compiled;
        match (number, condition) {
            (Ok(scalar), _) | (Err(_), Ok(scalar)) => Some(scalar),
            (Err(errors), Err(_)) => {
                self.expression_errors((name, Kind::Number), text, errors, "");
                None
            }
        }
    }

    fn compiled(&mut self, name: &str, kind: Kind, text: &Text) -> Option<Scalar> {
        let units = self.scope.units;
        let target = Target::of_parameter(name, kind, Quantity::Number, units, (None, None));
        self.compiled_for(target, text)
    }

    fn compiled_for(&mut self, target: Target, text: &Text) -> Option<Scalar> {
        let scope = self.scope;
        let (name, kind) = (target.name().to_owned(), target.kind());
        let range = super::literal::range_help(&target);
        let compiled = Expression::compile(&text.value, target, |name, span, uses| {
            scope.leaf(name, span, |use_| slot_of(uses, use_))
        });
        compiled
            .map_err(|errors| self.expression_errors((&name, kind), text, errors, &range))
            .ok()
    }

    /// A number that must be known before anything runs: a literal, or an
    /// expression over parameters.
    pub(super) fn known_number(&mut self, name: &str, item: &Item) -> Option<f64> {
        if let Some(text) = item.text(self.scope.text) {
            return match self.compiled(name, Kind::Number, &text)? {
                Scalar::Known(Value::Number(number)) => Some(number),
                Scalar::Known(_) => None,
                Scalar::Later(_) => {
                    let message = format!("`{name}` must be known before anything runs");
                    let help = "let it depend on parameters only, not on nodes";
                    self.report(
                        "not_known_yet",
                        &text.span,
                        message,
                        "depends on a node",
                        help,
                    );
                    None
                }
            };
        }
        match item.number(self.scope.text) {
            Some(Number::Whole(number)) => Some(number as f64),
            Some(Number::Real(number)) if number.is_finite() => Some(number),
            _ => {
                let label = item.label(self.scope.text);
                let message = format!("`{name}` takes a finite number, not {label}");
                let help = "write a number, or an expression in quotes";
                self.report("wrong_kind", &item.span, message, label, help);
                None
            }
        }
    }

    /// A whole number in a range that must be known before anything runs.
    pub(super) fn known_count(
        &mut self,
        name: &str,
        item: &Item,
        range: std::ops::RangeInclusive<usize>,
    ) -> Option<usize> {
        let number = self.known_number(name, item)?;
        let (least, most) = (*range.start() as f64, *range.end() as f64);
        if number.fract() == 0.0 && (least..=most).contains(&number) {
            return Some(number as usize);
        }
        let message = format!("`{name}` takes a whole number from {least} to {most}, not {number}");
        let help = format!("give a whole number from {least} to {most}");
        self.report("out_of_range", &item.span, message, "this value", help);
        None
    }
}

/// A number of a file in units `from` as a file in units `to` would write it.
fn converted(number: f64, from: Units, to: Units, quantity: Quantity) -> f64 {
    to.from_si(number * from.to_si(quantity), quantity)
}
