//! Reads the forms of one graph and finds the order they need each other in.

use std::ops::Range;

use super::files::Target;
use super::{Call, Expander};
use crate::check::inputs::Checker;
use crate::check::interpolate::in_folder;
use crate::check::order;
use crate::check::scope::{Named, Scope};
use crate::document::{DeclaredKind, Fields, Item, NodeEntry, ParamKind, Problems, Shape, Text};
use crate::forms::FormSpec;
use crate::names::{quoted, shown};

/// A form as written, and the graph it includes.
pub(super) struct Form<'a> {
    /// Its place among the nodes of its graph.
    pub(super) index: usize,
    pub(super) entry: &'a NodeEntry,
    pub(super) target: Target,
    pub(super) with: Vec<(Text, &'a Item)>,
    pub(super) shape: FormShape<'a>,
}

/// What tells the forms apart.
pub(super) enum FormShape<'a> {
    Subgraph,
    ForEach {
        over: Vec<(Text, &'a Item)>,
        /// Whether meshes are joined.
        join: bool,
    },
    Repeat {
        times: &'a Item,
        carry: Text,
    },
}

impl Form<'_> {
    pub(super) fn name(&self) -> &str {
        &self.entry.name.value
    }

    /// The place of the form's kind and of its path.
    pub(super) fn span(&self) -> &Range<usize> {
        &self.entry.kind.span
    }
}

/// Something to report errors of one form with.
pub(super) fn checker<'a, 'p>(
    scope: &'a Scope<'a>,
    form: &'a str,
    problems: &'p mut Problems,
) -> Checker<'a, 'p> {
    Checker {
        scope,
        node: form,
        problems,
    }
}

impl Expander<'_> {
    /// Reads a form; `None` after an error without which nothing can go on.
    pub(super) fn read_form<'a>(
        &mut self,
        call: &Call,
        scope: &Scope<'a>,
        (index, spec): (usize, &'static FormSpec),
        problems: &mut Problems,
    ) -> Option<Form<'a>> {
        let entry = &scope.nodes[index];
        let name = &entry.name.value;
        let known: Vec<&str> = spec.fields.iter().map(|field| field.name).collect();
        let owner = format!("`{}`", spec.name);
        let fields = Fields::new(scope.text, &entry.fields, &known, &owner, problems);
        report_missing(spec, entry, &fields, problems);
        let with = fields
            .get("with")
            .map_or_else(Vec::new, |item| map(scope, name, "with", item, problems));
        let shape = match spec.name {
            "ForEach" => FormShape::ForEach {
                over: map(scope, name, "over", fields.get("over")?, problems),
                join: join(scope, name, fields.get("join"), problems)?,
            },
            "Repeat" => FormShape::Repeat {
                times: fields.get("times")?,
                carry: text(scope, name, ("carry", fields.get("carry")?), problems)?,
            },
            _ => FormShape::Subgraph,
        };
        let written = text(scope, name, ("path", fields.get("path")?), problems)?;
        let mut checker = checker(scope, name, problems);
        let folder = checker.folder_of(&written);
        let path = in_folder(&folder, &checker.interpolated(&written)?);
        let target = self.open(call, &path, (&written, name), problems)?;
        Some(Form {
            index,
            entry,
            target,
            with,
            shape,
        })
    }
}

fn report_missing(
    spec: &FormSpec,
    entry: &NodeEntry,
    fields: &Fields<'_, '_>,
    problems: &mut Problems,
) {
    let missing = spec
        .fields
        .iter()
        .filter(|field| field.default.is_none() && fields.get(field.name).is_none());
    let missing: Vec<&str> = missing.map(|field| field.name).collect();
    if missing.is_empty() {
        return;
    }
    let names = quoted(missing.iter().copied(), 10);
    let message = format!("`{}` needs {names}", spec.name);
    let error = problems.error("missing_input", &entry.kind.span, message, "not given");
    let help = format!("`tessgraph nodes {}` shows how it is written", spec.name);
    problems.add(error.with_help(help).with_node(&entry.name.value));
}

/// A map from names to values.
fn map<'a>(
    scope: &Scope<'a>,
    form: &str,
    field: &str,
    item: &'a Item,
    problems: &mut Problems,
) -> Vec<(Text, &'a Item)> {
    let wrong = |item: &Item, message: String, problems: &mut Problems| {
        let error = problems.error("wrong_kind", &item.span, message, "here");
        let help = format!("write `{field}: {{\"input\": value}}`");
        problems.add(error.with_help(help).with_node(form));
    };
    let Shape::Map(entries) = &item.shape else {
        let message = format!("`{field}` takes a map, not {}", item.label(scope.text));
        wrong(item, message, problems);
        return Vec::new();
    };
    let mut pairs: Vec<(Text, &'a Item)> = Vec::new();
    for (key, value) in entries {
        let Some(name) = key.text(scope.text) else {
            let message = format!("an input is named by a text, not {}", key.label(scope.text));
            wrong(key, message, problems);
            continue;
        };
        if let Some((first, _)) = pairs.iter().find(|(other, _)| other.value == name.value) {
            let message = format!("`{}` is given twice", shown(&name.value));
            let error = problems.error("duplicate_name", &name.span, message, "again here");
            let error = error.with_label(first.span.clone(), "first given here");
            problems.add(error.with_help("remove one of them").with_node(form));
            continue;
        }
        pairs.push((name, value));
    }
    pairs
}

/// `Mesh` or `List`.
fn join(
    scope: &Scope<'_>,
    form: &str,
    item: Option<&Item>,
    problems: &mut Problems,
) -> Option<bool> {
    let Some(item) = item else { return Some(true) };
    match item.name(scope.text) {
        Some("Mesh") => Some(true),
        Some("List") => Some(false),
        _ => {
            let message = format!("`join` is `Mesh` or `List`, not {}", item.label(scope.text));
            let error = problems.error("unknown_choice", &item.span, message, "here");
            let help = "`Mesh` joins meshes into one, `List` gives a list";
            problems.add(error.with_help(help).with_node(form));
            None
        }
    }
}

fn text(
    scope: &Scope<'_>,
    form: &str,
    (field, item): (&str, &Item),
    problems: &mut Problems,
) -> Option<Text> {
    let text = item.text(scope.text);
    if text.is_none() {
        let message = format!("`{field}` takes a text, not {}", item.label(scope.text));
        let error = problems.error("wrong_kind", &item.span, message, "here");
        problems.add(error.with_help("write it in quotes").with_node(form));
    }
    text
}

/// The forms in an order in which each finds what it takes: indices into
/// `forms`. Circles are reported and left out.
pub(super) fn ordered(
    scope: &Scope<'_>,
    forms: &[Form<'_>],
    problems: &mut Problems,
) -> Vec<usize> {
    let needs: Vec<Vec<usize>> = forms
        .iter()
        .map(|form| needed(scope, form, forms))
        .collect();
    let order = order::sort(&needs);
    if order.len() < forms.len() {
        for circle in order::cycles(&needs, &order) {
            report_circle(forms, &circle, problems);
        }
    }
    order
}

/// The forms whose results a form takes, in ascending order.
fn needed(scope: &Scope<'_>, form: &Form<'_>, forms: &[Form<'_>]) -> Vec<usize> {
    let document = &form.target.document;
    let mut needed = Vec::new();
    for (name, item) in &form.with {
        let declared = document
            .inputs
            .iter()
            .find(|input| input.name.value == name.value);
        let is_text = declared.is_some_and(|input| match input.kind {
            DeclaredKind::Param(index) => matches!(
                document.params[index].kind,
                ParamKind::Text | ParamKind::Path | ParamKind::Choice
            ),
            _ => false,
        });
        if !is_text {
            mentioned(scope, item, forms, &mut needed);
        }
    }
    needed.sort_unstable();
    needed.dedup();
    needed
}

/// The forms that texts in `item` name.
fn mentioned(scope: &Scope<'_>, item: &Item, forms: &[Form<'_>], found: &mut Vec<usize>) {
    match &item.shape {
        Shape::Tuple(tuple) => {
            let items = tuple.items.iter();
            items.for_each(|item| mentioned(scope, item, forms, found));
        }
        Shape::List(items) => items
            .iter()
            .for_each(|item| mentioned(scope, item, forms, found)),
        _ => {
            let text = item
                .text(scope.text)
                .map(|text| text.value)
                .unwrap_or_default();
            let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
            found.extend(words.filter_map(|word| match scope.find(word)? {
                // Forms stand in the order of the file.
                Named::Node(index) => forms.binary_search_by_key(&index, |form| form.index).ok(),
                _ => None,
            }));
        }
    }
}

fn report_circle(forms: &[Form<'_>], circle: &[usize], problems: &mut Problems) {
    let name = |form: usize| format!("`{}`", shown(forms[form].name()));
    let names: Vec<String> = circle
        .iter()
        .chain(circle.first())
        .map(|&form| name(form))
        .collect();
    let message = format!(
        "included graphs need each other in a circle: {}",
        names.join(" -> ")
    );
    let mut error = problems.error("cycle", forms[circle[0]].span(), message, "needs the next");
    for &form in &circle[1..] {
        error = error.with_label(forms[form].span().clone(), "needs the next");
    }
    let help =
        "an included graph takes all of its inputs before it gives results; break the circle";
    problems.add(error.with_help(help).with_node(forms[circle[0]].name()));
}
