//! The one name space of parameters and nodes.

use std::cell::Cell;
use std::collections::HashMap;
use std::ops::Range;

use super::reference::Found;
use crate::document::{DeclaredKind, Document, NodeEntry, Parameter, Problems, Spanned};
use crate::expr::is_reserved;
use crate::forms::FORMS;
use crate::names::{did_you_mean, is_snake_case, quoted, shown, to_snake_case};
use crate::node::NodeSpec;
use crate::units::Units;

/// What a name stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Named {
    /// A parameter, by its place in the document.
    Param(usize),
    /// A node or a form, by its place in the document.
    Node(usize),
    /// An input that another graph gives, by its place in the document.
    Input(usize),
    /// Nothing more can be said: the name is reported to mean two things.
    Opaque,
}

/// What an entry of `nodes` is.
#[derive(Debug, Clone)]
pub(super) enum Meaning {
    /// A node of the registry, and its place in the plan.
    Node(&'static NodeSpec, usize),
    /// A form of the language, with its results.
    Form(Vec<FormResult>),
    /// Nothing is known: its kind is unknown, or the form is wrong or not yet
    /// dealt with.
    Unknown,
}

/// A result of a form, under its name.
#[derive(Debug, Clone)]
pub(super) struct FormResult {
    pub(super) name: String,
    /// `None` if it is wrong, as reported.
    pub(super) found: Option<Found>,
}

/// What a graph is given by whoever runs or includes it.
#[derive(Debug, Clone, Default)]
pub(super) struct Givings {
    /// The parameters with their values.
    pub(super) params: Vec<Parameter>,
    /// For each parameter the result that gives it, if one does.
    pub(super) computed: Vec<Option<Found>>,
    /// For each input what it is given, if it is no parameter.
    pub(super) values: Vec<Option<Found>>,
}

impl Givings {
    /// Parameters with their defaults, and nothing else.
    pub(super) fn defaults(document: &Document) -> Self {
        Self {
            params: document.params.clone(),
            computed: vec![None; document.params.len()],
            values: vec![None; document.inputs.len()],
        }
    }
}

/// Everything that names in a graph can refer to.
pub(super) struct Scope<'a> {
    pub(super) document: &'a Document,
    pub(super) text: &'a str,
    pub(super) units: Units,
    /// The file's folder from the main graph's, with a slash at its end.
    pub(super) folder: &'a str,
    pub(super) given: &'a Givings,
    pub(super) params: &'a [Parameter],
    pub(super) nodes: &'a [NodeEntry],
    /// What each node is.
    pub(super) meanings: Vec<Meaning>,
    names: HashMap<&'a str, Named>,
    /// How many names may still be compared for suggestions.
    budget: Cell<usize>,
}

/// Comparing every wrong name with every right one takes minutes in a file
/// with 100 000 mistakes; nobody reads that many suggestions.
const COMPARISONS: usize = 2_000_000;

impl<'a> Scope<'a> {
    /// The names of a document. What its nodes are is still to be said.
    pub(super) fn new(
        document: &'a Document,
        given: &'a Givings,
        folder: &'a str,
        problems: &mut Problems,
    ) -> Self {
        Self {
            document,
            text: document.source.text(),
            units: document.units,
            folder,
            given,
            params: &given.params,
            nodes: &document.nodes,
            meanings: vec![Meaning::Unknown; document.nodes.len()],
            names: collect_names(document, problems),
            budget: Cell::new(COMPARISONS),
        }
    }

    /// Whether a search through all names is still worth its time.
    pub(super) fn may_search(&self) -> bool {
        let left = self.budget.get().checked_sub(self.names.len() + 1);
        left.is_some_and(|left| {
            self.budget.set(left);
            true
        })
    }

    /// What to say about a name that is not among `candidates`.
    pub(super) fn suggest<'n>(
        &self,
        name: &str,
        candidates: impl Iterator<Item = &'n str> + Clone,
        what: &str,
    ) -> String {
        if self.may_search() {
            suggest(name, candidates, what)
        } else {
            "check its spelling".to_owned()
        }
    }

    /// What a name stands for, if anything.
    pub(super) fn find(&self, name: &str) -> Option<Named> {
        self.names.get(name).copied()
    }

    /// The names of all parameters, in file order.
    pub(super) fn param_names(&self) -> impl Iterator<Item = &'a str> + Clone + use<'a> {
        self.params.iter().map(|param| param.name.value.as_str())
    }

    /// The names of all nodes, in file order.
    pub(super) fn node_names(&self) -> impl Iterator<Item = &'a str> + Clone + use<'a> {
        self.nodes.iter().map(|node| node.name.value.as_str())
    }
}

/// The kinds of node there are.
pub(super) struct Kinds {
    by_name: HashMap<&'static str, &'static NodeSpec>,
    registry: &'static [NodeSpec],
}

impl Kinds {
    pub(super) fn new(registry: &'static [NodeSpec]) -> Self {
        Self {
            by_name: registry.iter().map(|spec| (spec.name, spec)).collect(),
            registry,
        }
    }

    pub(super) fn find(
        &self,
        node: &NodeEntry,
        problems: &mut Problems,
    ) -> Option<&'static NodeSpec> {
        let kind = &node.kind.value;
        if let Some(spec) = self.by_name.get(kind.as_str()) {
            return Some(spec);
        }
        let message = format!("there is no node `{}`", shown(kind));
        let error = problems.error("unknown_kind", &node.kind.span, message, "not known");
        let forms = FORMS.iter().map(|form| form.name);
        let help = did_you_mean(
            kind,
            self.registry.iter().map(|spec| spec.name).chain(forms),
        )
        .unwrap_or_else(|| "`tessgraph nodes` lists all nodes".to_owned());
        problems.add(error.with_help(help).with_node(&node.name.value));
        None
    }
}

/// All names, each with the first thing that has it; repeats are reported.
fn collect_names<'a>(document: &'a Document, problems: &mut Problems) -> HashMap<&'a str, Named> {
    let params = document.params.iter().enumerate();
    let params = params.map(|(index, param)| (&param.name, Named::Param(index)));
    let given = document.inputs.iter().enumerate();
    let given = given
        .filter(|(_, input)| !matches!(input.kind, DeclaredKind::Param(_)))
        .map(|(index, input)| (&input.name, Named::Input(index)));
    let nodes = document.nodes.iter().enumerate();
    let nodes = nodes.map(|(index, node)| (&node.name, Named::Node(index)));
    let mut first: HashMap<&str, (Named, Range<usize>)> = HashMap::new();
    let mut names = HashMap::new();
    for (name, named) in params.chain(given).chain(nodes) {
        check_name(name, named, problems);
        if let Some((earlier, span)) = first.get(name.value.as_str()) {
            report_repeat(name, named, *earlier, span, problems);
            if earlier.word() != named.word() {
                names.insert(name.value.as_str(), Named::Opaque);
            }
        } else {
            first.insert(&name.value, (named, name.span.clone()));
            names.insert(name.value.as_str(), named);
        }
    }
    names
}

impl Named {
    fn word(self) -> &'static str {
        match self {
            Self::Param(_) => "a parameter",
            Self::Node(_) => "a node",
            Self::Input(_) | Self::Opaque => "an input",
        }
    }
}

fn report_repeat(
    name: &Spanned<String>,
    named: Named,
    earlier: Named,
    first: &Range<usize>,
    problems: &mut Problems,
) {
    let (shown, word) = (shown(&name.value), earlier.word());
    let message = if named.word() == word {
        format!(
            "`{shown}` is the name of two {}s",
            word.trim_start_matches("a ").trim_start_matches("an ")
        )
    } else {
        format!("`{shown}` is the name of {word} and of {}", named.word())
    };
    let error = problems.error("duplicate_name", &name.span, message, "again here");
    problems.add(
        error
            .with_label(first.clone(), "first named here")
            .with_help("parameters, inputs and nodes share their names: rename one of them"),
    );
}

fn check_name(name: &Spanned<String>, named: Named, problems: &mut Problems) {
    let (text, word) = (&name.value, named.word());
    if is_reserved(text) {
        let message = format!("`{text}` means something else in expressions");
        let error = problems.error("reserved_name", &name.span, message, "reserved");
        problems.add(error.with_help(format!("give {} another name", word.replace("a ", "the "))));
    } else if !is_snake_case(text) {
        let message = format!("`{}` is no name for {word}", shown(text));
        let error = problems.error("bad_name", &name.span, message, "not snake_case");
        let rule = "names are lower-case letters, digits and `_`, and start with a letter";
        problems.add(error.with_help(match to_snake_case(text) {
            Some(better) => format!("write `{better}`; {rule}"),
            None => rule.to_owned(),
        }));
    }
}

/// "did you mean", or else which names there are.
pub(super) fn suggest<'n>(
    name: &str,
    candidates: impl Iterator<Item = &'n str> + Clone,
    what: &str,
) -> String {
    if let Some(help) = did_you_mean(name, candidates.clone()) {
        return help;
    }
    let all = quoted(candidates, 8);
    if all.is_empty() {
        format!("there are no {what}")
    } else {
        format!("{what} are {all}")
    }
}
