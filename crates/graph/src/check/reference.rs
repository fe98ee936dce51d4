//! References to results of nodes: `"node"` or `"node.result"`.

use std::ops::Range;
use std::rc::Rc;

use super::inputs::{Checker, subject};
use super::scope::{FormResult, Meaning, Named, Scope};
use crate::diagnostic::Diagnostic;
use crate::document::{Problems, Text};
use crate::names::{did_you_mean, quoted, shown};
use crate::node::{InputSpec, OutputSpec};
use crate::plan::{Origin, ResultRef};
use crate::value::Kind;
use tessgraph_geometry::Quantity;

/// What a reference gives.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub(super) kind: Kind,
    pub(super) quantity: Quantity,
    pub(super) given: Given,
}

/// Where a reference leads.
#[derive(Debug, Clone)]
pub(super) enum Given {
    /// To one result of one node.
    One(ResultRef),
    /// To results of several nodes, as a list.
    Many(Rc<[ResultRef]>),
}

impl Found {
    /// One result of the node at `node` in the plan.
    pub(super) fn one(node: usize, result: usize, spec: &OutputSpec) -> Self {
        Self {
            kind: spec.kind,
            quantity: spec.quantity,
            given: Given::One(ResultRef { node, result }),
        }
    }

    /// The result, if it is one.
    pub(super) fn result(&self) -> Option<ResultRef> {
        match self.given {
            Given::One(result) => Some(result),
            Given::Many(_) => None,
        }
    }

    /// The origin of an input that takes it.
    pub(super) fn origin(&self) -> Origin {
        match &self.given {
            Given::One(result) => Origin::Result(*result),
            Given::Many(results) => {
                Origin::List(results.iter().copied().map(Origin::Result).collect())
            }
        }
    }
}

/// Why a reference names no result.
pub(super) enum NotFound {
    /// It names a node whose kind is unknown, or an input that another graph
    /// gives: reported already.
    Known,
    /// It names nothing, or no result.
    Error(Missing),
}

/// What to report about a reference that names no result.
pub(super) struct Missing {
    pub(super) code: &'static str,
    pub(super) message: String,
    pub(super) help: String,
}

impl Scope<'_> {
    /// The result that `name` means.
    pub(super) fn result(&self, name: &str) -> Result<Found, NotFound> {
        let (node, result) = match name.split_once('.') {
            Some((node, result)) => (node, Some(result)),
            None => (name, None),
        };
        match self.find(node) {
            Some(Named::Node(index)) => self.result_of(index, node, result),
            Some(Named::Opaque) => Err(NotFound::Known),
            Some(Named::Input(index)) => {
                self.plain(self.given.values[index].as_ref(), node, result)
            }
            Some(Named::Param(index)) if self.given.computed[index].is_some() => {
                self.plain(self.given.computed[index].as_ref(), node, result)
            }
            Some(Named::Param(_)) => Err(NotFound::Error(Missing {
                code: "wrong_kind",
                message: format!("`{}` is a parameter, not a node", shown(node)),
                help: self.suggest(node, self.node_names(), "nodes"),
            })),
            None => Err(NotFound::Error(Missing {
                code: "unknown_node",
                message: format!("there is no node `{}`", shown(node)),
                help: self.suggest(node, self.node_names(), "nodes"),
            })),
        }
    }

    /// What an input is given, which has no results by name.
    fn plain(
        &self,
        found: Option<&Found>,
        name: &str,
        result: Option<&str>,
    ) -> Result<Found, NotFound> {
        if let Some(result) = result {
            return Err(NotFound::Error(Missing {
                code: "unknown_result",
                message: format!(
                    "`{}` is an input and has no result `{}`",
                    shown(name),
                    shown(result)
                ),
                help: format!("write `{}`", shown(name)),
            }));
        }
        found.cloned().ok_or(NotFound::Known)
    }

    fn result_of(&self, index: usize, node: &str, result: Option<&str>) -> Result<Found, NotFound> {
        let found = match (&self.meanings[index], result) {
            (Meaning::Unknown, _) => return Err(NotFound::Known),
            (Meaning::Node(spec, node), None) => spec
                .outputs
                .first()
                .map(|spec| Some(Found::one(*node, 0, spec))),
            (Meaning::Node(spec, node), Some(name)) => {
                let place = spec.outputs.iter().position(|output| output.name == name);
                place.map(|place| Some(Found::one(*node, place, &spec.outputs[place])))
            }
            (Meaning::Form(results), None) => results.first().map(|result| result.found.clone()),
            (Meaning::Form(results), Some(name)) => {
                let result = results.iter().find(|result| result.name == name);
                result.map(|result| result.found.clone())
            }
        };
        match (found, result) {
            (Some(Some(found)), _) => Ok(found),
            (Some(None), _) | (None, None) => Err(NotFound::Known),
            (None, Some(name)) => {
                let results = self.results_of(index);
                let names: Vec<&str> = results.iter().map(|(name, _)| name.as_str()).collect();
                Err(NotFound::Error(no_result(node, name, &names)))
            }
        }
    }

    /// The results of an entry of `nodes`, with their kinds.
    pub(super) fn results_of(&self, index: usize) -> Vec<(String, Kind)> {
        match &self.meanings[index] {
            Meaning::Unknown => Vec::new(),
            Meaning::Node(spec, _) => {
                let outputs = spec.outputs.iter();
                outputs
                    .map(|output| (output.name.to_owned(), output.kind))
                    .collect()
            }
            Meaning::Form(results) => {
                let known =
                    |result: &FormResult| Some((result.name.clone(), result.found.as_ref()?.kind));
                results.iter().filter_map(known).collect()
            }
        }
    }

    /// The node that a reference names, and where it is defined.
    pub(super) fn definition(&self, reference: &str) -> Option<(Option<usize>, Range<usize>)> {
        let head = reference.split('.').next().unwrap_or(reference);
        match self.find(head)? {
            Named::Node(index) => Some((Some(index), self.nodes[index].span.clone())),
            Named::Input(index) => Some((None, self.document.inputs[index].span.clone())),
            Named::Param(index) => Some((None, self.params[index].span.clone())),
            Named::Opaque => None,
        }
    }
}

fn no_result(node: &str, name: &str, names: &[&str]) -> Missing {
    let names = names.iter().copied();
    let all = format!("its results are {}", quoted(names.clone(), 100));
    Missing {
        code: "unknown_result",
        message: format!("`{}` has no result `{}`", shown(node), shown(name)),
        help: match did_you_mean(name, names) {
            Some(help) => format!("{help} {all}"),
            None => all,
        },
    }
}

/// A reference at its place in the text, or an error that says why not.
pub(super) fn resolve(
    scope: &Scope<'_>,
    text: &Text,
    problems: &Problems,
) -> Result<Found, Option<Box<Diagnostic>>> {
    if !is_reference(&text.value) {
        let message = format!("`{}` is not the name of a node", shown(&text.value));
        let error = problems.error("unknown_node", &text.span, message, "not a name");
        return Err(Some(Box::new(
            error.with_help("write `\"node\"` or `\"node.result\"`"),
        )));
    }
    scope.result(&text.value).map_err(|error| match error {
        NotFound::Known => None,
        NotFound::Error(missing) => {
            let place = match (missing.code, text.value.find('.')) {
                ("unknown_result", Some(dot)) => text.part(dot + 1..text.value.len()),
                _ => text.span.clone(),
            };
            let error = problems.error(missing.code, &place, missing.message, "not found");
            Some(Box::new(error.with_help(missing.help)))
        }
    })
}

/// Whether the text has the form of a reference.
fn is_reference(text: &str) -> bool {
    let is_name = |part: &str| {
        !part.is_empty()
            && part
                .chars()
                .all(|c| c.is_alphanumeric() || c == '_' || c == '-')
    };
    match text.split_once('.') {
        Some((node, result)) => is_name(node) && is_name(result),
        None => is_name(text),
    }
}

impl Checker<'_, '_> {
    /// A reference at an input of `kind`.
    pub(super) fn reference(
        &mut self,
        input: &InputSpec,
        kind: Kind,
        text: &Text,
    ) -> Option<Origin> {
        let found = self.found(&subject(input, kind), kind, text)?;
        Some(found.origin())
    }

    /// What a reference leads to where `subject` takes a `kind`.
    pub(super) fn found(&mut self, subject: &str, kind: Kind, text: &Text) -> Option<Found> {
        match resolve(self.scope, text, self.problems) {
            Ok(found) if kind.accepts(found.kind) => Some(found),
            Ok(found) => {
                self.wrong_result(subject, kind, text, &found);
                None
            }
            Err(error) => {
                if let Some(error) = error {
                    self.problems.add(error.with_node(self.node));
                }
                None
            }
        }
    }

    fn wrong_result(&mut self, subject: &str, kind: Kind, text: &Text, found: &Found) {
        let (wanted, given) = (kind.label(), found.kind);
        let name = shown(&text.value);
        let message = format!(
            "{subject} takes {wanted}, but `{name}` gives {}",
            given.label()
        );
        let mut error = self
            .problems
            .error("wrong_kind", &text.span, message, given.noun());
        let help = self.other_result(kind, found, &text.value);
        if let Some((_, place)) = self.scope.definition(&text.value) {
            error = error.with_label(place, "defined here");
        }
        self.problems
            .add(error.with_help(help).with_node(self.node));
    }

    /// What could be connected instead.
    fn other_result(&self, kind: Kind, found: &Found, reference: &str) -> String {
        let name = shown(reference.split('.').next().unwrap_or(reference));
        if let Kind::List(part) = kind
            && part.accepts(found.kind)
        {
            return format!("a list is written in square brackets: `[\"{name}\"]`");
        }
        let index = self
            .scope
            .definition(reference)
            .and_then(|(index, _)| index);
        let results = index.map_or_else(Vec::new, |index| self.scope.results_of(index));
        if let Some((result, _)) = results.iter().find(|(_, other)| kind.accepts(*other)) {
            return format!("`{name}.{result}` gives {}", kind.label());
        }
        if !self.scope.may_search() {
            return format!("connect a node that gives {}", kind.label());
        }
        let fits = |index: usize| match &self.scope.meanings[index] {
            Meaning::Node(spec, _) => spec.outputs.first().map(|output| output.kind),
            Meaning::Form(results) => results.first()?.found.as_ref().map(|found| found.kind),
            Meaning::Unknown => None,
        };
        let nodes = self.scope.nodes.iter().enumerate();
        let fitting = nodes.filter(|(index, node)| {
            node.name.value != self.node && fits(*index).is_some_and(|other| kind.accepts(other))
        });
        let names = quoted(fitting.map(|(_, node)| node.name.value.as_str()), 8);
        if names.is_empty() {
            format!("add a node that gives {}", kind.label())
        } else {
            format!("nodes that give {} are {names}", kind.label())
        }
    }
}
