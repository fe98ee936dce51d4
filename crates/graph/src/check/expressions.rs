//! Texts that are expressions or formulas.

use std::ops::Range;
use std::sync::Arc;

use super::inputs::Checker;
use super::literal::range_help;
use super::reference::{Found, NotFound};
use super::scope::{Named, Scope};
use crate::diagnostic::{Label, Place};
use crate::document::Text;
use crate::expr::{
    ExprError, Expression, FormulaSlots, FormulaTemplate, Leaf, ResolvedName, ResultUse, Scalar,
    Target, Type,
};
use crate::names::shown;
use crate::node::InputSpec;
use crate::plan::Origin;
use crate::value::{Kind, Value};

impl Checker<'_, '_> {
    /// An expression that gives a number or a condition.
    pub(super) fn scalar(&mut self, input: &InputSpec, kind: Kind, text: &Text) -> Option<Origin> {
        let target = Target::of_part(input, kind, self.scope.units);
        let range = range_help(&target);
        let scope = self.scope;
        let compiled = Expression::compile(&text.value, target, |name, span, uses| {
            scope.leaf(name, span, |use_| slot_of(uses, use_))
        });
        match compiled {
            Ok(Scalar::Known(value)) => Some(Origin::Constant(value)),
            Ok(Scalar::Later(expression)) => Some(Origin::Expression(expression)),
            Err(errors) => {
                self.expression_errors((input.name, input.kind), text, errors, &range);
                None
            }
        }
    }

    /// A number, or a reference to a field.
    pub(super) fn amount(&mut self, input: &InputSpec, text: &Text) -> Option<Origin> {
        match self.scope.result(&text.value) {
            Ok(found) if !found.kind.is_scalar() => self.reference(input, Kind::Amount, text),
            _ => self.scalar(input, Kind::Amount, text),
        }
    }

    /// A formula over the input's free names, attributes, parameters, results.
    pub(super) fn formula(&mut self, input: &'static InputSpec, text: &Text) -> Option<Origin> {
        let scope = self.scope;
        let scale = scope.units.to_si(input.quantity);
        let compiled = FormulaTemplate::compile(&text.value, scale, |name, span, slots| {
            scope.formula_leaf(input, name, span, slots)
        });
        let template = match compiled {
            Ok(template) => template,
            Err(errors) => {
                self.expression_errors((input.name, input.kind), text, errors, "");
                return None;
            }
        };
        if !template.results().is_empty() {
            return Some(Origin::Formula(template));
        }
        // Without results there is nothing to ask for and nothing to fail.
        let formula = template.bind(&|_| Value::Number(0.0)).ok()?;
        Some(Origin::Constant(Value::Formula(Arc::new(formula))))
    }

    /// Reports what is wrong with an expression where `name` takes a `kind`.
    pub(super) fn expression_errors(
        &mut self,
        (name, kind): (&str, Kind),
        text: &Text,
        errors: Vec<ExprError>,
        range: &str,
    ) {
        for error in errors {
            let span = text.part(error.span);
            let mut problem = self
                .problems
                .error(error.code, &span, error.message, error.remark);
            if let Some((place, remark)) = error.elsewhere.map(|place| *place) {
                // An expression over a graph may stand in another file.
                let source = &self.scope.document.source;
                let label = Label {
                    span: place,
                    message: remark,
                };
                if Arc::ptr_eq(source, &problem.source) {
                    problem.labels.push(label);
                } else {
                    let source = Arc::clone(source);
                    problem.elsewhere.push(Place { source, label });
                }
            }
            let help = match (error.help, error.code) {
                (Some(help), _) => help,
                (None, "out_of_range") => range.to_owned(),
                (None, _) => format!("`{}` takes {}", shown(name), kind.label()),
            };
            self.problems
                .add(problem.with_help(help).with_node(self.node));
        }
    }
}

/// The slot of a result; equal results share one.
pub(super) fn slot_of(uses: &mut Vec<ResultUse>, wanted: ResultUse) -> u32 {
    let place = uses
        .iter()
        .position(|use_| *use_ == wanted)
        .unwrap_or_else(|| {
            uses.push(wanted);
            uses.len() - 1
        });
    // A text within the size limit of a file cannot hold 2^32 names.
    place as u32
}

impl Scope<'_> {
    /// What a name in an expression means; `slot` hands out a result's slot.
    pub(super) fn leaf(
        &self,
        name: &str,
        span: Range<usize>,
        slot: impl FnOnce(ResultUse) -> u32,
    ) -> ResolvedName {
        let head = name.split('.').next().unwrap_or(name);
        match self.find(head) {
            Some(Named::Param(index)) if self.given.computed[index].is_none() => {
                self.param_leaf(index, name, span)
            }
            Some(Named::Opaque) => Ok(None),
            Some(_) => match self.result(name) {
                Ok(found) => self.result_leaf(found, name, span, slot),
                Err(NotFound::Known) => Ok(None),
                Err(NotFound::Error(missing)) => Err(ExprError::new(span, missing.message)
                    .code(missing.code)
                    .remark("not found")
                    .help(missing.help)),
            },
            None => {
                let names = self.param_names().chain(self.node_names());
                let message = format!("there is no parameter or node `{}`", shown(head));
                Err(ExprError::new(span, message)
                    .code("unknown_name")
                    .remark("not found")
                    .help(self.suggest(head, names, "names")))
            }
        }
    }

    fn param_leaf(&self, index: usize, name: &str, span: Range<usize>) -> ResolvedName {
        let param = &self.params[index];
        if name.contains('.') {
            let message = format!(
                "`{}` is a parameter and has no results",
                shown(&param.name.value)
            );
            let help = format!("write `{}`", shown(&param.name.value));
            return Err(ExprError::new(span, message)
                .code("unknown_result")
                .help(help));
        }
        match &param.value {
            None => Ok(None),
            Some(Value::Number(number)) => Ok(Some(Leaf::Number(*number))),
            Some(Value::Integer(number)) => Ok(Some(Leaf::Number(*number as f64))),
            Some(Value::Bool(truth)) => Ok(Some(Leaf::Bool(*truth))),
            Some(_) => {
                let label = param.kind.label();
                let message = format!("`{}` is {label}; expressions take numbers", shown(name));
                Err(ExprError::new(span, message)
                    .code("wrong_kind")
                    .remark(label)
                    .help("use a parameter of kind Number, Integer or Bool")
                    .elsewhere(param.span.clone(), "defined here"))
            }
        }
    }

    fn result_leaf(
        &self,
        found: Found,
        name: &str,
        span: Range<usize>,
        slot: impl FnOnce(ResultUse) -> u32,
    ) -> ResolvedName {
        let ty = match found.kind {
            Kind::Bool => Type::Bool,
            Kind::Number | Kind::Integer => Type::Number,
            other => {
                let label = other.label();
                let message = format!("`{}` gives {label}; expressions take numbers", shown(name));
                let error = ExprError::new(span, message)
                    .code("wrong_kind")
                    .remark(other.noun())
                    .help(self.scalar_results(name));
                return Err(match self.definition(name) {
                    Some((_, place)) => error.elsewhere(place, "defined here"),
                    None => error,
                });
            }
        };
        let Some(result) = found.result() else {
            return Ok(None);
        };
        let scale = self.units.to_si(found.quantity);
        let slot = slot(ResultUse { result, scale });
        Ok(Some(Leaf::Variable { slot, ty, scale }))
    }

    /// Which results of the same node an expression could use.
    fn scalar_results(&self, reference: &str) -> String {
        let node = shown(reference.split('.').next().unwrap_or(reference));
        let index = self.definition(reference).and_then(|(index, _)| index);
        let results = index.map_or_else(Vec::new, |index| self.results_of(index));
        let names: Vec<String> = results
            .iter()
            .filter(|(_, kind)| kind.is_scalar())
            .map(|(name, _)| format!("{node}.{name}"))
            .collect();
        if names.is_empty() {
            return format!("`{node}` has no result that is a number");
        }
        format!(
            "its numbers are {}",
            crate::names::quoted(names.iter().map(String::as_str), 20)
        )
    }

    fn formula_leaf(
        &self,
        input: &'static InputSpec,
        name: &str,
        span: Range<usize>,
        slots: &mut FormulaSlots,
    ) -> ResolvedName {
        let head = name.split('.').next().unwrap_or(name);
        let named = self.find(head);
        if let Some(free) = input.free.iter().find(|free| free.name == name) {
            if let Some(named) = named {
                return Err(self.clash(name, named, span));
            }
            let scale = self.units.to_si(free.quantity);
            let slot = slots.name(name, false, scale);
            return Ok(Some(Leaf::Variable {
                slot,
                ty: Type::Number,
                scale,
            }));
        }
        if named.is_some() {
            return self.leaf(name, span, |use_| slots.result(use_));
        }
        if input.attributes && !name.contains('.') {
            let slot = slots.name(name, true, 1.0);
            return Ok(Some(Leaf::Variable {
                slot,
                ty: Type::Number,
                scale: 1.0,
            }));
        }
        let free = input.free.iter().map(|free| free.name);
        let names = free.chain(self.param_names()).chain(self.node_names());
        let message = format!("there is no variable, parameter or node `{}`", shown(head));
        Err(ExprError::new(span, message)
            .code("unknown_name")
            .remark("not found")
            .help(self.suggest(head, names, "names")))
    }

    /// A name that could mean two things.
    fn clash(&self, name: &str, named: Named, span: Range<usize>) -> ExprError {
        let (word, place) = match named {
            Named::Param(index) => ("parameter", Some(self.params[index].name.span.clone())),
            Named::Node(index) => ("node", Some(self.nodes[index].name.span.clone())),
            Named::Input(index) => ("input", Some(self.document.inputs[index].name.span.clone())),
            Named::Opaque => ("input", None),
        };
        let message =
            format!("`{name}` is both a variable of this formula and the name of a {word}");
        let error = ExprError::new(span, message)
            .code("ambiguous_name")
            .remark("which of them?")
            .help(format!("rename the {word}"));
        match place {
            Some(place) => error.elsewhere(place, "named here"),
            None => error,
        }
    }
}
