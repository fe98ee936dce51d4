//! What an included graph is given: `with`, by the names of its inputs.

use super::forms::{Form, checker};
use super::{Call, Expander, hidden};
use crate::check::arguments::{Argument, Wanted, declared};
use crate::check::reference::Found;
use crate::check::scope::{Givings, Scope};
use crate::document::{DeclaredInput, DeclaredKind, Document, Item, Problems, Shape, Text};
use crate::names::{did_you_mean, quoted, shown};
use crate::plan::Origin;
use crate::value::{Kind, Value};
use tessgraph_geometry::Quantity;

impl Expander<'_> {
    /// Everything that `with` gives. What is wrong or missing is reported and
    /// stays unknown; inputs in `otherwise` may be missing.
    pub(super) fn bind(
        &mut self,
        call: &Call,
        scope: &Scope<'_>,
        (form, otherwise): (&Form<'_>, &[&str]),
        problems: &mut Problems,
    ) -> Givings {
        let document = &*form.target.document;
        let mut given = Givings::defaults(document);
        // A default path is named from the file that declares it.
        for (name, item) in &form.with {
            let Some(place) = find_input(form, name, problems) else {
                continue;
            };
            let input = &document.inputs[place];
            match input.kind {
                DeclaredKind::Param(param) => {
                    self.bind_param(
                        call,
                        scope,
                        (form, place, param),
                        item,
                        &mut given,
                        problems,
                    );
                }
                DeclaredKind::Value(kind, quantity) => {
                    let kinds = (kind, quantity);
                    given.values[place] =
                        self.bind_value(call, scope, (form, place), kinds, item, problems);
                }
                DeclaredKind::Unknown => {}
            }
        }
        report_missing(form, otherwise, problems);
        given
    }

    fn bind_param(
        &mut self,
        call: &Call,
        scope: &Scope<'_>,
        (form, place, param): (&Form<'_>, usize, usize),
        item: &Item,
        given: &mut Givings,
        problems: &mut Problems,
    ) {
        let document = &*form.target.document;
        let wanted = Wanted {
            param: &document.params[param],
            document,
        };
        let argument = checker(scope, form.name(), problems).argument(wanted, item);
        match argument {
            Some(Argument::Known(value, folder)) => {
                given.params[param].value = Some(value);
                given.params[param].folder = folder;
            }
            Some(Argument::Later(expression)) => {
                let origin = Origin::Expression(expression);
                let kind = wanted.param.value_kind();
                let quantity = wanted.param.target.quantity();
                given.params[param].value = None;
                given.computed[param] =
                    self.input_node(call, (form, place), (kind, quantity), origin, item);
            }
            None => given.params[param].value = None,
        }
    }

    /// The node through which an input is given a value.
    pub(super) fn input_node(
        &mut self,
        call: &Call,
        (form, place): (&Form<'_>, usize),
        (kind, quantity): (Kind, Quantity),
        origin: Origin,
        item: &Item,
    ) -> Option<Found> {
        let spec = hidden::input(kind, quantity)?;
        let input = &form.target.document.inputs[place].name.value;
        let name = format!("{}/{input}", form.name());
        let key = [form.index as u32, 0, place as u32];
        Some(self.add_hidden(call, (name, &key), spec, (origin, &item.span)))
    }

    /// A mesh, a field, ...: a result of another node, or a vector in place.
    fn bind_value(
        &mut self,
        call: &Call,
        scope: &Scope<'_>,
        (form, place): (&Form<'_>, usize),
        (kind, quantity): (Kind, Quantity),
        item: &Item,
        problems: &mut Problems,
    ) -> Option<Found> {
        let document = &*form.target.document;
        let input = &document.inputs[place];
        let name = shown(&input.name.value);
        let mut checker = checker(scope, form.name(), problems);
        if let Some(text) = item.text(scope.text) {
            let found = checker.found(&format!("`{name}`"), kind, &text)?;
            // A plain field is read in the units of the file that gives it.
            let plain_field = kind == Kind::Field && quantity != Quantity::Number;
            if plain_field && document.units != scope.units {
                let origin = found.origin();
                return self.input_node(call, (form, place), (kind, quantity), origin, item);
            }
            return Some(found);
        }
        if let (Kind::Vector, Shape::Tuple(tuple)) = (kind, &item.shape) {
            let spec = hidden::input(kind, quantity)?;
            let origin = checker.vector(&spec.inputs[0], item, &tuple.items)?;
            return self.input_node(call, (form, place), (kind, quantity), origin, item);
        }
        let (wanted, label) = (kind.label(), item.label(scope.text));
        let message = format!("`{name}` takes {wanted}, not {label}");
        let error = problems.error("wrong_kind", &item.span, message, label);
        let error = error.with_places([declared(document, &input.span)]);
        let help = "write the name of a node in quotes: `\"node\"` or `\"node.result\"`";
        problems.add(error.with_help(help).with_node(form.name()));
        None
    }
}

/// The input of the included graph that has the name.
pub(super) fn find_input(form: &Form<'_>, name: &Text, problems: &mut Problems) -> Option<usize> {
    let document = &*form.target.document;
    let inputs = &document.inputs;
    let found = inputs
        .iter()
        .position(|input| input.name.value == name.value);
    if found.is_some() {
        return found;
    }
    let (wanted, path) = (shown(&name.value), shown(document.source.name()));
    let message = format!("`{path}` has no input `{wanted}`");
    let error = problems.error("unknown_input", &name.span, message, "not known");
    let names = inputs.iter().map(|input| input.name.value.as_str());
    let is_param = document
        .params
        .iter()
        .find(|param| param.name.value == name.value);
    let error = match is_param {
        Some(param) => error
            .with_places([declared(document, &param.span)])
            .with_help("it is a parameter there: declare it under `inputs` instead"),
        None => {
            error.with_help(did_you_mean(&name.value, names.clone()).unwrap_or_else(
                || match quoted(names, 20) {
                    all if all.is_empty() => "that graph has no `inputs`".to_owned(),
                    all => format!("its inputs are {all}"),
                },
            ))
        }
    };
    problems.add(error.with_node(form.name()));
    None
}

fn report_missing(form: &Form<'_>, otherwise: &[&str], problems: &mut Problems) {
    let document = &*form.target.document;
    let is_given = |input: &&DeclaredInput| {
        let name = input.name.value.as_str();
        otherwise.contains(&name) || form.with.iter().any(|(given, _)| given.value == name)
    };
    let missing: Vec<&DeclaredInput> = document
        .inputs
        .iter()
        .filter(|input| input.required && !is_given(input))
        .collect();
    if missing.is_empty() {
        return;
    }
    let names = quoted(missing.iter().map(|input| input.name.value.as_str()), 20);
    let path = shown(document.source.name());
    let message = format!("`{path}` must be given {names}");
    let error = problems.error("missing_input", form.span(), message, "not given");
    let places = missing
        .iter()
        .take(4)
        .map(|input| declared(document, &input.span));
    let first = &missing[0].name.value;
    let help = format!("add it: `with: {{\"{}\": ...}}`", shown(first));
    problems.add(
        error
            .with_places(places)
            .with_help(help)
            .with_node(form.name()),
    );
}

/// A value that is known, as the origin of a node's input.
pub(super) fn constant(document: &Document, param: usize, given: &Givings) -> Option<Origin> {
    let target = &document.params[param].target;
    Some(Origin::Constant(
        match given.params[param].value.as_ref()? {
            Value::Number(number) => Value::Number(number * target.scale()),
            value => value.clone(),
        },
    ))
}
