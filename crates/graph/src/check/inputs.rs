//! The inputs of one node: each known, each once, none missing.

use std::ops::Range;

use super::scope::{Meaning, Scope};
use crate::document::{Item, Problems, Shape};
use crate::names::{did_you_mean, listing, nearest, quoted, shown};
use crate::node::{InputSpec, NodeSpec};
use crate::plan::{Origin, PlanInput};
use crate::value::{Kind, Value};

/// Checks values for the inputs of one node.
pub(super) struct Checker<'a, 'p> {
    pub(super) scope: &'a Scope<'a>,
    /// The node's name, for diagnostics.
    pub(super) node: &'a str,
    pub(super) problems: &'p mut Problems,
}

/// An input's value as written.
type Given<'a> = Option<&'a Item>;

/// The inputs of the node at `index`, one per input of its spec. Where the
/// value is wrong, the input counts as left out, and the problem is reported.
pub(super) fn check(scope: &Scope<'_>, index: usize, problems: &mut Problems) -> Vec<PlanInput> {
    let Meaning::Node(spec, _) = scope.meanings[index] else {
        return Vec::new();
    };
    let node = &scope.nodes[index];
    let mut checker = Checker {
        scope,
        node: &node.name.value,
        problems,
    };
    let (given, meant) = checker.assign(spec, index);
    checker.report_missing(spec, &given, &meant, &node.kind.span);
    let mut inputs: Vec<PlanInput> = spec
        .inputs
        .iter()
        .zip(&given)
        .map(|(input, item)| checker.input(input, *item))
        .collect();
    checker.refuse_unused(spec, &given, &mut inputs);
    inputs
}

impl<'a> Checker<'a, '_> {
    /// Reports an error of this node.
    pub(super) fn report(
        &mut self,
        code: &'static str,
        span: &Range<usize>,
        message: impl Into<String>,
        remark: impl Into<String>,
        help: impl Into<String>,
    ) {
        let error = self.problems.error(code, span, message, remark);
        self.problems
            .add(error.with_help(help).with_node(self.node));
    }

    /// Which value was written for which input of the spec, and which inputs
    /// were probably meant by unknown names.
    fn assign(&mut self, spec: &NodeSpec, index: usize) -> (Vec<Given<'a>>, Vec<&'static str>) {
        let mut meant = Vec::new();
        let mut given: Vec<Given<'a>> = vec![None; spec.inputs.len()];
        let mut names: Vec<Range<usize>> = vec![0..0; spec.inputs.len()];
        for field in &self.scope.nodes[index].fields {
            let name = crate::document::plain(self.scope.text, &field.name);
            match spec.inputs.iter().position(|input| input.name == name) {
                None => meant.extend(self.unknown_input(spec, name, &field.name)),
                Some(place) if given[place].is_some() => {
                    let message = format!("`{name}` is given twice");
                    let error =
                        self.problems
                            .error("duplicate_name", &field.name, message, "again here");
                    let error = error.with_label(names[place].clone(), "first given here");
                    self.problems
                        .add(error.with_help("remove one of them").with_node(self.node));
                }
                Some(place) => {
                    given[place] = Some(&field.value);
                    names[place] = field.name.clone();
                }
            }
        }
        (given, meant)
    }

    /// Reports an unknown input; the input that was probably meant.
    fn unknown_input(
        &mut self,
        spec: &NodeSpec,
        name: &str,
        span: &Range<usize>,
    ) -> Option<&'static str> {
        let known = spec.inputs.iter().map(|input| input.name);
        let message = format!("`{}` has no input `{}`", spec.name, shown(name));
        let help = did_you_mean(name, known.clone()).unwrap_or_else(|| match spec.inputs.len() {
            0 => format!("`{}` has no inputs", spec.name),
            _ => format!("its inputs are {}", quoted(known.clone(), 100)),
        });
        self.report("unknown_input", span, message, "not known", help);
        nearest(name, known).first().copied()
    }

    /// One diagnostic for all inputs of the node that are missing.
    fn report_missing(
        &mut self,
        spec: &NodeSpec,
        given: &[Given<'_>],
        meant: &[&str],
        span: &Range<usize>,
    ) {
        let missing: Vec<&InputSpec> = spec
            .inputs
            .iter()
            .zip(given)
            .filter(|(input, item)| item.is_none() && is_required(input))
            .filter(|(input, _)| !meant.contains(&input.name))
            .map(|(input, _)| input)
            .collect();
        if missing.is_empty() {
            return;
        }
        let names = quoted(missing.iter().map(|input| input.name), 100);
        let help: Vec<String> = missing
            .iter()
            .map(|input| format!("`{}: ...` ({})", input.name, input.kind.label()))
            .collect();
        let message = format!("`{}` needs {names}", spec.name);
        let help = format!("add {}", listing(&help, "and"));
        self.report("missing_input", span, message, "not given", help);
    }

    fn input(&mut self, input: &'static InputSpec, item: Given<'_>) -> PlanInput {
        let Some(item) = item else {
            return PlanInput {
                origin: left_out(input),
                span: None,
            };
        };
        let origin = self.origin(input, input.kind, item);
        let origin = origin.and_then(|origin| self.check_length(input, origin, &item.span));
        PlanInput {
            origin: origin.unwrap_or(Origin::Absent),
            span: Some(item.span.clone()),
        }
    }

    /// Lists of fixed length have it, as far as that is known by now.
    fn check_length(
        &mut self,
        input: &InputSpec,
        origin: Origin,
        span: &Range<usize>,
    ) -> Option<Origin> {
        let length = match &origin {
            Origin::List(items) => items.len(),
            Origin::Constant(Value::List(items)) => items.len(),
            _ => return Some(origin),
        };
        match input.length {
            Some(wanted) if wanted != length => {
                let plural = if wanted == 1 { "" } else { "s" };
                let message = format!("`{}` takes {wanted} item{plural}, not {length}", input.name);
                let help = format!("give exactly {wanted}");
                self.report(
                    "wrong_length",
                    span,
                    message,
                    format!("{length} given"),
                    help,
                );
                None
            }
            _ => Some(origin),
        }
    }

    /// Takes `Some(...)` and other forms that no input is written in.
    pub(super) fn wrong_literal(&mut self, input: &InputSpec, kind: Kind, item: &Item) {
        let label = item.label(self.scope.text);
        let message = format!(
            "{} takes {}, not {label}",
            subject(input, kind),
            kind.label()
        );
        let help = match (&item.shape, label) {
            (_, "`Some`" | "`None`") => "write the value itself, or leave the input out".to_owned(),
            (Shape::Struct(_), _) => {
                "a node inside a node is not possible: name it and refer to it".to_owned()
            }
            _ => super::literal::form(input, kind),
        };
        self.report("wrong_kind", &item.span, message, label, help);
    }
}

/// The input, or the part of it that is of `kind`.
pub(super) fn subject(input: &InputSpec, kind: Kind) -> String {
    match input.kind {
        Kind::List(part) if *part == kind => format!("each item of `{}`", input.name),
        Kind::Vector if kind == Kind::Number => format!("each component of `{}`", input.name),
        _ => format!("`{}`", input.name),
    }
}

/// Whether the input must be written.
fn is_required(input: &InputSpec) -> bool {
    !input.optional && input.default.is_none()
}

/// What an input is that was not written.
pub(super) fn left_out(input: &InputSpec) -> Origin {
    input
        .default
        .map_or(Origin::Absent, |default| Origin::Constant(default()))
}
