//! Puts graphs in place: once, for each of several values, or repeatedly.

use std::rc::Rc;
use std::sync::Arc;

use super::bind::{constant, find_input};
use super::forms::{Form, FormShape, checker, ordered};
use super::{Call, Expander, MAX_GRAPHS, MAX_NODES, hidden};
use crate::check::arguments::{Wanted, declared};
use crate::check::axis::AxisValue;
use crate::check::expressions::slot_of;
use crate::check::outputs;
use crate::check::reference::{Found, Given};
use crate::check::scope::{FormResult, Givings, Meaning, Scope};
use crate::document::{DeclaredKind, Item, Problems, Text};
use crate::expr::{Expression, Leaf, ResultUse, Scalar, Type};
use crate::forms::FormSpec;
use crate::names::shown;
use crate::plan::{Origin, ResultRef};
use crate::value::Kind;

/// An axis of a `ForEach`: a parameter of the included graph and its values.
type Axis = (usize, Vec<AxisValue>);

impl Expander<'_> {
    /// Deals with all forms of a graph, each after those it takes results from.
    pub(super) fn place_forms(
        &mut self,
        call: &Call,
        scope: &mut Scope<'_>,
        forms: &[(usize, &'static FormSpec)],
        problems: &mut Problems,
    ) {
        let mut read = Vec::new();
        for &form in forms {
            read.extend(self.read_form(call, scope, form, problems));
        }
        for place in ordered(scope, &read, problems) {
            let form = &read[place];
            if let Some(results) = self.place_form(call, scope, form, problems) {
                scope.meanings[form.index] = Meaning::Form(results);
            }
        }
    }

    /// The results of a form; `None` after an error.
    fn place_form(
        &mut self,
        call: &Call,
        scope: &Scope<'_>,
        form: &Form<'_>,
        problems: &mut Problems,
    ) -> Option<Vec<FormResult>> {
        if form.target.document.results.is_empty() {
            let document = &form.target.document;
            let path = shown(document.source.name());
            let message = format!("`{path}` gives nothing to other graphs");
            let error = problems.error("no_results", form.span(), message, "included here");
            let error = error.with_places([declared(document, &document.head)]);
            let help = "add `results: {\"name\": \"node\"}` to it";
            problems.add(error.with_help(help).with_node(form.name()));
        }
        match &form.shape {
            FormShape::Subgraph => {
                let given = self.bind(call, scope, (form, &[]), problems);
                self.instance(call, (form, None), given, problems)
            }
            FormShape::ForEach { over, join } => {
                self.for_each(call, scope, (form, over, *join), problems)
            }
            FormShape::Repeat { times, carry } => {
                self.repeat(call, scope, (form, times, carry), problems)
            }
        }
    }

    /// Puts the included graph in place once; `copy` counts from 1.
    fn instance(
        &mut self,
        call: &Call,
        (form, copy): (&Form<'_>, Option<u32>),
        given: Givings,
        problems: &mut Problems,
    ) -> Option<Vec<FormResult>> {
        let document = &form.target.document;
        self.graphs += 1;
        let too_many = self.graphs > MAX_GRAPHS
            || self.nodes.len().saturating_add(document.nodes.len()) > MAX_NODES;
        if too_many && !self.stopped {
            self.stopped = true;
            let message = format!(
                "this includes more than {MAX_GRAPHS} graphs or {MAX_NODES} nodes, all levels counted"
            );
            let error = problems.error("too_many_graphs", form.span(), message, "one too many");
            let help = "repeat less often, over fewer values, or in fewer levels";
            problems.add(error.with_help(help).with_node(form.name()));
        }
        if self.stopped {
            return None;
        }
        let copy_name = copy.map_or_else(String::new, |copy| format!("{copy}/"));
        let mut key = call.key.clone();
        key.extend([form.index as u32, copy.unwrap_or(1)]);
        let call = Call {
            document: Rc::clone(document),
            given,
            prefix: format!("{}{}/{copy_name}", call.prefix, form.name()),
            key,
            folder: form.target.folder.clone(),
            chain: Rc::clone(&form.target.chain),
            included: Arc::clone(&form.target.included),
        };
        Some(self.expand(&call, |_, scope, problems| {
            outputs::check_results(scope, &scope.document.results, problems)
        }))
    }

    fn for_each(
        &mut self,
        call: &Call,
        scope: &Scope<'_>,
        (form, over, join): (&Form<'_>, &[(Text, &Item)], bool),
        problems: &mut Problems,
    ) -> Option<Vec<FormResult>> {
        let names: Vec<&str> = over.iter().map(|(name, _)| name.value.as_str()).collect();
        let given = self.bind(call, scope, (form, &names), problems);
        let axes = axes(scope, form, over, problems)?;
        let count = axes.iter().try_fold(1_usize, |count, (_, values)| {
            count.checked_mul(values.len())
        });
        let count = count.filter(|count| *count <= MAX_GRAPHS);
        let Some(count) = count else {
            let message = format!("these axes have more than {MAX_GRAPHS} combinations");
            let error = problems.error("too_many_graphs", form.span(), message, "too many");
            problems.add(error.with_help("give fewer values").with_node(form.name()));
            return None;
        };
        let mut copies = Vec::with_capacity(count);
        for index in 0..count {
            let mut given = given.clone();
            for (param, (value, folder)) in combination(&axes, index) {
                given.params[param].value = Some(value);
                given.params[param].folder = folder;
                given.computed[param] = None;
            }
            copies.push(self.instance(call, (form, Some(index as u32 + 1)), given, problems)?);
        }
        Some(self.gather(call, form, (&copies, join), problems))
    }

    /// The results of all copies: meshes joined if `join`, else as lists.
    fn gather(
        &mut self,
        call: &Call,
        form: &Form<'_>,
        (copies, join): (&[Vec<FormResult>], bool),
        problems: &mut Problems,
    ) -> Vec<FormResult> {
        let names = copies.first().into_iter().flatten();
        let names: Vec<String> = names.map(|result| result.name.clone()).collect();
        let mut gather = |(place, name): (usize, String)| {
            let found = copies
                .iter()
                .map(|results| results.get(place)?.found.as_ref());
            let found: Option<Vec<&Found>> = found.collect();
            let found = found.and_then(|found| {
                let gathered = self.gathered(call, (form, place, &name), &found, join);
                if gathered.is_none() {
                    report_list_of_lists(form, &name, problems);
                }
                gathered
            });
            FormResult { name, found }
        };
        names.into_iter().enumerate().map(&mut gather).collect()
    }

    fn gathered(
        &mut self,
        call: &Call,
        (form, place, name): (&Form<'_>, usize, &str),
        found: &[&Found],
        join: bool,
    ) -> Option<Found> {
        let first = found.first()?;
        let results: Option<Rc<[ResultRef]>> = found.iter().map(|found| found.result()).collect();
        let list = Found {
            kind: hidden::list_kind(first.kind)?,
            quantity: first.quantity,
            given: Given::Many(results?),
        };
        if !join || first.kind != Kind::Mesh {
            return Some(list);
        }
        let name = format!("{}/{name}", form.name());
        let key = [form.index as u32, u32::MAX, place as u32];
        let place = (list.origin(), form.span());
        Some(self.add_hidden(call, (name, &key), &hidden::JOIN, place))
    }

    fn repeat(
        &mut self,
        call: &Call,
        scope: &Scope<'_>,
        (form, times, carry): (&Form<'_>, &Item, &Text),
        problems: &mut Problems,
    ) -> Option<Vec<FormResult>> {
        let mut given = self.bind(call, scope, (form, &[]), problems);
        let input = find_input(form, carry, problems);
        let times =
            checker(scope, form.name(), problems).known_count("times", times, 0..=MAX_GRAPHS);
        let (input, times) = (input?, times?);
        let document = &form.target.document;
        let results = &document.results;
        let named = results
            .iter()
            .position(|result| result.name.value == carry.value);
        let carried = named.unwrap_or(0);
        let name = results
            .get(carried)
            .map_or(&carry.value, |result| &result.name.value);
        let mut last = vec![FormResult {
            name: name.clone(),
            found: self.initial(call, (form, input), &given, times, carry),
        }];
        for pass in 0..times {
            if pass > 0 {
                let found = last.get(carried)?.found.clone();
                self.feed(
                    call,
                    (form, input, pass as u32),
                    found,
                    (&mut given, carry),
                    problems,
                )?;
            }
            let copy = Some(pass as u32 + 1);
            last = self.instance(call, (form, copy), given.clone(), problems)?;
        }
        if times > 0 {
            // The bare name means what is carried.
            let first = last.remove(carried);
            last.insert(0, first);
        }
        Some(last)
    }

    /// What the carried input is given before the first pass, as a result; only
    /// needed where there is no pass.
    fn initial(
        &mut self,
        call: &Call,
        (form, input): (&Form<'_>, usize),
        given: &Givings,
        times: usize,
        carry: &Text,
    ) -> Option<Found> {
        if times > 0 {
            return None;
        }
        let document = &form.target.document;
        match document.inputs[input].kind {
            DeclaredKind::Value(..) => given.values[input].clone(),
            DeclaredKind::Param(param) if given.computed[param].is_some() => {
                given.computed[param].clone()
            }
            DeclaredKind::Param(param) => {
                let declared = &document.params[param];
                let kinds = (declared.value_kind(), declared.target.quantity());
                let origin = constant(document, param, given)?;
                let spec = hidden::input(kinds.0, kinds.1)?;
                let name = format!("{}/{}", form.name(), carry.value);
                let key = [form.index as u32, 0, input as u32];
                Some(self.add_hidden(call, (name, &key), spec, (origin, &carry.span)))
            }
            DeclaredKind::Unknown => None,
        }
    }

    /// Gives the carried input the result of the pass before.
    fn feed(
        &mut self,
        call: &Call,
        (form, input, pass): (&Form<'_>, usize, u32),
        found: Option<Found>,
        (given, carry): (&mut Givings, &Text),
        problems: &mut Problems,
    ) -> Option<()> {
        let document = &form.target.document;
        let (found, wanted) = (found?, document.inputs[input].kind);
        let kind = match wanted {
            DeclaredKind::Value(kind, _) => kind,
            DeclaredKind::Param(param) => document.params[param].value_kind(),
            DeclaredKind::Unknown => return None,
        };
        if !kind.accepts(found.kind) {
            let name = shown(&carry.value);
            let (wanted, label) = (kind.label(), found.kind.label());
            let message = format!("`{name}` takes {wanted}, but a pass gives {label}");
            let error = problems.error(
                "wrong_kind",
                &carry.span,
                message,
                "carried from pass to pass",
            );
            let error = error.with_places([declared(document, &document.inputs[input].span)]);
            let help = format!("give that graph a result `{name}` that is {wanted}");
            problems.add(error.with_help(help).with_node(form.name()));
            return None;
        }
        match wanted {
            DeclaredKind::Param(param) => {
                let key = [form.index as u32, pass, u32::MAX];
                let origin = self.in_range(document, param, &found)?;
                let spec = hidden::input(kind, document.params[param].target.quantity())?;
                let name = format!("{}/{}/{}", form.name(), pass + 1, carry.value);
                let place = (origin, &carry.span);
                let node = self.add_hidden(call, (name, &key), spec, place);
                given.params[param].value = None;
                given.computed[param] = Some(node);
            }
            _ => given.values[input] = Some(found),
        }
        Some(())
    }

    /// A scalar result as the value of a parameter, within its range.
    fn in_range(
        &self,
        document: &crate::document::Document,
        param: usize,
        found: &Found,
    ) -> Option<Origin> {
        let (result, param) = (found.result()?, &document.params[param]);
        let target = match param.value_kind() {
            Kind::Bool => return Some(Origin::Result(result)),
            _ => param.target.clone(),
        };
        let scale = document.units.to_si(found.quantity);
        let name = param.name.value.clone();
        let compiled = Expression::compile(&name, target, |_, _, uses| {
            let slot = slot_of(uses, ResultUse { result, scale });
            let ty = Type::Number;
            Ok(Some(Leaf::Variable { slot, ty, scale }))
        });
        match compiled {
            Ok(Scalar::Later(expression)) => Some(Origin::Expression(expression)),
            _ => None,
        }
    }
}

fn report_list_of_lists(form: &Form<'_>, name: &str, problems: &mut Problems) {
    let message = format!("`{}` of each copy is a list already", shown(name));
    let error = problems.error(
        "wrong_kind",
        form.span(),
        message,
        "would be a list of lists",
    );
    let document = &form.target.document;
    let result = document
        .results
        .iter()
        .find(|result| result.name.value == name);
    let places = result.map(|result| declared(document, &result.name.span));
    let help = "join it inside that graph: `ForEach(..., join: Mesh)`, or take it from the results";
    problems.add(
        error
            .with_places(places)
            .with_help(help)
            .with_node(form.name()),
    );
}

/// The axes of a `ForEach`; `None` after an error.
fn axes(
    scope: &Scope<'_>,
    form: &Form<'_>,
    over: &[(Text, &Item)],
    problems: &mut Problems,
) -> Option<Vec<Axis>> {
    let document = &*form.target.document;
    let mut axes = Vec::new();
    let mut sound = true;
    for (name, item) in over {
        let Some(input) = find_input(form, name, problems) else {
            sound = false;
            continue;
        };
        if let Some((given, _)) = form
            .with
            .iter()
            .find(|(other, _)| other.value == name.value)
        {
            let message = format!("`{}` is given by `over` and by `with`", shown(&name.value));
            let error = problems.error("duplicate_name", &given.span, message, "again here");
            let error = error.with_label(name.span.clone(), "an axis");
            problems.add(error.with_help("remove one of them").with_node(form.name()));
            sound = false;
        }
        let DeclaredKind::Param(param) = document.inputs[input].kind else {
            let message = format!("`{}` takes no plain values", shown(&name.value));
            let error = problems.error("wrong_kind", &name.span, message, "not an axis");
            let error = error.with_places([declared(document, &document.inputs[input].span)]);
            let help = "axes are for numbers, conditions, texts, paths and choices";
            problems.add(error.with_help(help).with_node(form.name()));
            sound = false;
            continue;
        };
        let wanted = Wanted {
            param: &document.params[param],
            document,
        };
        let values = checker(scope, form.name(), problems).axis(wanted, item, MAX_GRAPHS);
        sound &= values.is_some();
        axes.extend(values.map(|values| (param, values)));
    }
    if over.is_empty() {
        let error = problems.error("missing_input", form.span(), "`over` has no axis", "here");
        let help = "write `over: {\"input\": Values(of: [1, 2])}`";
        problems.add(error.with_help(help).with_node(form.name()));
    }
    (sound && !axes.is_empty()).then_some(axes)
}

/// The values of one combination, the last axis varying fastest.
fn combination(axes: &[Axis], index: usize) -> Vec<(usize, AxisValue)> {
    let mut rest = index;
    let mut values = Vec::with_capacity(axes.len());
    for (param, axis) in axes.iter().rev() {
        values.push((*param, axis[rest % axis.len()].clone()));
        rest /= axis.len();
    }
    values
}
