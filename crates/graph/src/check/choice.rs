//! Choices, and inputs that count only while a choice has some value.

use super::inputs::{Checker, left_out};
use super::scope::{Named, suggest};
use crate::document::{Item, ParamKind, Shape, Text};
use crate::names::{alternatives, did_you_mean, listing, shown};
use crate::node::{InputSpec, NodeSpec};
use crate::plan::{Origin, PlanInput};
use crate::value::Value;

impl Checker<'_, '_> {
    /// A bare identifier at a choice.
    pub(super) fn choice(&mut self, input: &'static InputSpec, item: &Item) -> Option<Origin> {
        let name = item.name(self.scope.text)?;
        if let Some(choice) = input.choices.iter().find(|choice| choice.name == name) {
            return Some(Origin::Constant(Value::Choice(choice.name)));
        }
        let message = format!("`{}` cannot be `{}`", input.name, shown(name));
        let names = input.choices.iter().map(|choice| choice.name);
        let help = suggest(name, names, "its choices");
        self.report(
            "unknown_choice",
            &item.span,
            message,
            "not one of its choices",
            help,
        );
        None
    }

    /// A text at a choice: the name of a Choice parameter.
    pub(super) fn choice_parameter(
        &mut self,
        input: &'static InputSpec,
        text: &Text,
    ) -> Option<Origin> {
        let name = &text.value;
        let param = match self.scope.find(name) {
            Some(Named::Param(index)) => &self.scope.params[index],
            Some(Named::Opaque) => return None,
            _ => {
                self.no_choice_parameter(input, text);
                return None;
            }
        };
        if param.kind != ParamKind::Choice {
            let label = param.kind.label();
            let message = format!(
                "`{}` takes a choice, but `{}` is {label}",
                input.name,
                shown(name)
            );
            let error = self
                .problems
                .error("wrong_kind", &text.span, message, label);
            let error = error.with_label(param.span.clone(), "defined here");
            let help = format!("declare it as {}", declaration(input));
            self.problems
                .add(error.with_help(help).with_node(self.node));
            return None;
        }
        let known = |name: &str| input.choices.iter().find(|choice| choice.name == name);
        // All of the parameter's names must fit, not only the present one.
        if let Some(unfit) = param.choices.iter().find(|name| known(name).is_none()) {
            let (shown, unfit) = (shown(name), shown(unfit));
            let message = format!("`{shown}` can be `{unfit}`, which `{}` cannot", input.name);
            let error = self
                .problems
                .error("wrong_kind", &text.span, message, "this parameter");
            let error = error.with_label(param.span.clone(), "defined here");
            let names = alternatives(input.choices.iter().map(|choice| choice.name));
            let help = format!("`{}` is one of {names}", input.name);
            self.problems
                .add(error.with_help(help).with_node(self.node));
            return None;
        }
        match param.value.as_ref()? {
            Value::Text(name) => {
                known(name).map(|choice| Origin::Constant(Value::Choice(choice.name)))
            }
            _ => None,
        }
    }

    fn no_choice_parameter(&mut self, input: &InputSpec, text: &Text) {
        let name = &text.value;
        let choices = input.choices.iter().map(|choice| choice.name);
        if choices.clone().any(|choice| choice == name) {
            let message = format!("`{}` takes a bare name, not a text", input.name);
            let help = format!("write `{name}` without quotes");
            self.report("wrong_kind", &text.span, message, "a text", help);
            return;
        }
        let params = self
            .scope
            .params
            .iter()
            .filter(|param| param.kind == ParamKind::Choice);
        let params = params.map(|param| param.name.value.as_str());
        let help = did_you_mean(name, params)
            .unwrap_or_else(|| format!("write {} without quotes", alternatives(choices)));
        let message = format!("there is no parameter `{}`", shown(name));
        self.report("unknown_name", &text.span, message, "not found", help);
    }

    /// Inputs that the choice of another input leaves without effect.
    ///
    /// Where the choice is written in place or left out, giving such an input
    /// is a mistake. Where it comes from a parameter, the input waits for other
    /// values of that parameter and is taken as left out, so that results do
    /// not depend on it.
    pub(super) fn refuse_unused(
        &mut self,
        spec: &NodeSpec,
        given: &[Option<&Item>],
        inputs: &mut [PlanInput],
    ) {
        for (place, input) in spec.inputs.iter().enumerate() {
            let Some((choice, values)) = input.only_with else {
                continue;
            };
            let Some(item) = given[place] else { continue };
            let Some(chooser) = spec.inputs.iter().position(|other| other.name == choice) else {
                continue;
            };
            let Origin::Constant(Value::Choice(chosen)) = inputs[chooser].origin else {
                continue;
            };
            if values.contains(&chosen) {
                continue;
            }
            if given[chooser].is_some_and(|item| matches!(item.shape, Shape::Text)) {
                inputs[place].origin = left_out(input);
                continue;
            }
            let default = if given[chooser].is_some() {
                ""
            } else {
                " by default"
            };
            let message = format!(
                "`{}` has no effect while `{choice}` is `{chosen}`{default}",
                input.name
            );
            let mut error =
                self.problems
                    .error("unused_input", &item.span, message, "has no effect");
            if let Some(chooser) = given[chooser] {
                error = error.with_label(chooser.span.clone(), "chosen here");
            }
            let wanted: Vec<String> = values
                .iter()
                .map(|value| format!("`{choice}: {value}`"))
                .collect();
            let help = format!("remove it, or write {}", listing(&wanted, "or"));
            self.problems
                .add(error.with_help(help).with_node(self.node));
        }
    }
}

/// How a Choice parameter for this input is declared.
fn declaration(input: &InputSpec) -> String {
    let names: Vec<&str> = input.choices.iter().map(|choice| choice.name).collect();
    let first = names.first().copied().unwrap_or_default();
    format!("`Choice(default: {first}, of: [{}])`", names.join(", "))
}
