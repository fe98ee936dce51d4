//! References to results of nodes: `"node"` or `"node.result"`.

use super::inputs::{Checker, subject};
use super::scope::{Named, Scope};
use crate::diagnostic::Diagnostic;
use crate::document::{Problems, Text};
use crate::names::{did_you_mean, quoted, shown};
use crate::node::{InputSpec, OutputSpec};
use crate::plan::{Origin, ResultRef};
use crate::value::Kind;

/// A result that a reference names.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub(super) result: ResultRef,
    pub(super) spec: &'static OutputSpec,
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

    fn result_of(&self, index: usize, node: &str, result: Option<&str>) -> Result<Found, NotFound> {
        let Some(spec) = self.specs[index] else {
            return Err(NotFound::Known);
        };
        let place = match result {
            None => 0,
            Some(name) => {
                let place = spec.outputs.iter().position(|output| output.name == name);
                let Some(place) = place else {
                    return Err(NotFound::Error(no_result(node, name, spec.outputs)));
                };
                place
            }
        };
        match spec.outputs.get(place) {
            Some(spec) => Ok(Found {
                result: ResultRef {
                    node: index,
                    result: place,
                },
                spec,
            }),
            None => Err(NotFound::Known),
        }
    }
}

fn no_result(node: &str, name: &str, outputs: &[OutputSpec]) -> Missing {
    let names = outputs.iter().map(|output| output.name);
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
        match resolve(self.scope, text, self.problems) {
            Ok(found) if kind.accepts(found.spec.kind) => Some(Origin::Result(found.result)),
            Ok(found) => {
                self.wrong_result(input, kind, text, found);
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

    fn wrong_result(&mut self, input: &InputSpec, kind: Kind, text: &Text, found: Found) {
        let (wanted, given) = (kind.label(), found.spec.kind);
        let name = shown(&text.value);
        let subject = subject(input, kind);
        let message = format!(
            "{subject} takes {wanted}, but `{name}` gives {}",
            given.label()
        );
        let node = &self.scope.nodes[found.result.node];
        let error = self
            .problems
            .error("wrong_kind", &text.span, message, given.noun());
        let help = self.other_result(kind, found);
        let error = error
            .with_label(node.span.clone(), "defined here")
            .with_help(help);
        self.problems.add(error.with_node(self.node));
    }

    /// What could be connected instead.
    fn other_result(&self, kind: Kind, found: Found) -> String {
        if let Kind::List(part) = kind
            && part.accepts(found.spec.kind)
        {
            let name = shown(&self.scope.nodes[found.result.node].name.value);
            return format!("a list is written in square brackets: `[\"{name}\"]`");
        }
        let name = &self.scope.nodes[found.result.node].name.value;
        let outputs = self.scope.specs[found.result.node].map_or(&[][..], |spec| spec.outputs);
        if let Some(output) = outputs.iter().find(|output| kind.accepts(output.kind)) {
            return format!("`{}.{}` gives {}", shown(name), output.name, kind.label());
        }
        if !self.scope.may_search() {
            return format!("connect a node that gives {}", kind.label());
        }
        let nodes = self.scope.nodes.iter().zip(&self.scope.specs);
        let fitting = nodes.filter(|(node, spec)| {
            node.name.value != self.node
                && spec
                    .and_then(|spec| spec.outputs.first())
                    .is_some_and(|o| kind.accepts(o.kind))
        });
        let names = quoted(fitting.map(|(node, _)| node.name.value.as_str()), 8);
        if names.is_empty() {
            format!("add a node that gives {}", kind.label())
        } else {
            format!("nodes that give {} are {names}", kind.label())
        }
    }
}
