//! Puts included graphs in place of the forms that include them.
//!
//! Everything here depends on parameters only, so that all nodes are known
//! before any is evaluated. Each use of an included graph is a [`Call`] with
//! values and results of its own; each file is read once.

mod bind;
mod files;
mod forms;
mod hidden;
mod place;

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

use super::inputs;
use super::reference::{Found, Given};
use super::scope::{Givings, Kinds, Meaning, Scope};
use crate::diagnostic::{Diagnostic, Place, Source};
use crate::document::{Document, Problems};
use crate::forms::form;
use crate::node::NodeSpec;
use crate::plan::{Origin, PlanInput, ResultRef};
use crate::units::Units;
use crate::world::World;

/// How many graphs one graph may include, each use counted.
pub(super) const MAX_GRAPHS: usize = 10_000;

/// How many nodes these graphs may have in all.
const MAX_NODES: usize = 500_000;

/// A graph in one of its places.
pub(super) struct Call {
    pub(super) document: Rc<Document>,
    pub(super) given: Givings,
    /// What its nodes' names begin with: `panels/`.
    prefix: String,
    /// Its place in the order of the files.
    key: Vec<u32>,
    /// Its file's folder from the main graph's, with a slash at its end.
    folder: String,
    /// The files it was reached through, itself last: identity and name.
    chain: Rc<[(String, String)]>,
    /// Where these were included, from inside out.
    included: Arc<[Place]>,
}

/// A node of the plan to be.
pub(super) struct ExpandedNode {
    pub(super) name: String,
    key: Vec<u32>,
    pub(super) spec: &'static NodeSpec,
    pub(super) inputs: Vec<PlanInput>,
    pub(super) span: Range<usize>,
    pub(super) source: Arc<Source>,
    pub(super) units: Units,
    pub(super) included: Arc<[Place]>,
    /// The document and the entry it stands for, unless a form made it.
    pub(super) entry: Option<(Rc<Document>, usize)>,
}

/// Collects the nodes of a graph and of all graphs it includes.
pub(super) struct Expander<'w> {
    kinds: Kinds,
    world: &'w dyn World,
    /// The folder of the main graph as its reader knows it.
    shown_folder: String,
    /// Included files by identity; `None` where they cannot be read.
    files: HashMap<String, Option<Rc<Document>>>,
    /// All texts in the order they were met.
    sources: Vec<Arc<Source>>,
    /// All included files as paths from the main graph's folder.
    pub(super) included: Vec<String>,
    pub(super) nodes: Vec<ExpandedNode>,
    graphs: usize,
    /// Whether a limit was met: then nothing more is put in place.
    stopped: bool,
    problems: Vec<Diagnostic>,
    /// Problems by text, code, place and message: one mistake in a graph that is
    /// used a thousand times is one problem.
    seen: HashSet<(usize, &'static str, Option<Range<usize>>, String)>,
}

impl<'w> Expander<'w> {
    /// For the graph called `name`.
    pub(super) fn new(name: &str, registry: &'static [NodeSpec], world: &'w dyn World) -> Self {
        let folder = name.rfind(['/', '\\']).map_or("", |end| &name[..=end]);
        Self {
            kinds: Kinds::new(registry),
            world,
            shown_folder: folder.to_owned(),
            files: HashMap::new(),
            sources: Vec::new(),
            included: Vec::new(),
            nodes: Vec::new(),
            graphs: 0,
            stopped: false,
            problems: Vec::new(),
            seen: HashSet::new(),
        }
    }

    /// The main graph as a call.
    pub(super) fn main(&mut self, name: &str, document: Rc<Document>, given: Givings) -> Call {
        self.sources.push(Arc::clone(&document.source));
        let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
        Call {
            document,
            given,
            prefix: String::new(),
            key: Vec::new(),
            folder: String::new(),
            chain: [(self.world.identity(file), name.to_owned())].into(),
            included: [].into(),
        }
    }

    /// Puts everything the graph includes in its place and checks its inputs;
    /// `finish` then looks at what else stands in it.
    pub(super) fn expand<T>(
        &mut self,
        call: &Call,
        finish: impl FnOnce(&mut Self, &Scope<'_>, &mut Problems) -> T,
    ) -> T {
        let document = &*call.document;
        let mut problems = Problems::new(&document.source);
        let mut scope = Scope::new(document, &call.given, &call.folder, &mut problems);
        let mut forms = Vec::new();
        for (index, entry) in document.nodes.iter().enumerate() {
            if let Some(form) = form(&entry.kind.value) {
                forms.push((index, form));
            } else if let Some(spec) = self.kinds.find(entry, &mut problems) {
                let node = self.add_entry(call, index, spec);
                scope.meanings[index] = Meaning::Node(spec, node);
            }
        }
        if !forms.is_empty() {
            self.place_forms(call, &mut scope, &forms, &mut problems);
        }
        for index in 0..document.nodes.len() {
            if let Meaning::Node(_, node) = scope.meanings[index] {
                self.nodes[node].inputs = inputs::check(&scope, index, &mut problems);
            }
        }
        let result = finish(self, &scope, &mut problems);
        self.take(problems, &call.included);
        result
    }

    fn add_entry(&mut self, call: &Call, index: usize, spec: &'static NodeSpec) -> usize {
        let entry = &call.document.nodes[index];
        let mut key = call.key.clone();
        key.push(index as u32);
        self.nodes.push(ExpandedNode {
            name: format!("{}{}", call.prefix, entry.name.value),
            key,
            spec,
            inputs: Vec::new(),
            span: entry.span.clone(),
            source: Arc::clone(&call.document.source),
            units: call.document.units,
            included: Arc::clone(&call.included),
            entry: Some((Rc::clone(&call.document), index)),
        });
        self.nodes.len() - 1
    }

    /// Adds a node that a form needs; it stands in the text of the form.
    fn add_hidden(
        &mut self,
        call: &Call,
        (name, key): (String, &[u32]),
        spec: &'static NodeSpec,
        (origin, span): (Origin, &Range<usize>),
    ) -> Found {
        let input = PlanInput {
            origin,
            span: Some(span.clone()),
        };
        self.nodes.push(ExpandedNode {
            name: format!("{}{name}", call.prefix),
            key: [&call.key, key].concat(),
            spec,
            inputs: vec![input],
            span: span.clone(),
            source: Arc::clone(&call.document.source),
            units: call.document.units,
            included: Arc::clone(&call.included),
            entry: None,
        });
        Found::one(self.nodes.len() - 1, 0, &spec.outputs[0])
    }

    /// One result for an output of the main graph: a list is collected by a
    /// node of its own.
    pub(super) fn single(
        &mut self,
        call: &Call,
        name: &str,
        found: &Found,
        span: &Range<usize>,
    ) -> Option<ResultRef> {
        let results = match &found.given {
            Given::One(result) => return Some(*result),
            Given::Many(results) => results,
        };
        let (crate::Kind::List(item), first) = (found.kind, results.first()?) else {
            return None;
        };
        let spec = hidden::list(*item, found.quantity)?;
        // Lists come last: nothing but outputs takes them.
        let key = [u32::MAX, first.node as u32, first.result as u32];
        let place = (found.origin(), span);
        self.add_hidden(call, (name.to_owned(), &key), spec, place)
            .result()
    }

    /// Keeps problems of one graph that are not known already.
    fn take(&mut self, problems: Problems, included: &Arc<[Place]>) {
        for problem in problems.into_sorted() {
            let problem = problem.with_places(included.iter().cloned());
            self.report(problem);
        }
    }

    pub(super) fn report(&mut self, problem: Diagnostic) {
        // Without included graphs nothing can be found twice.
        if self.graphs > 0 {
            let text = Arc::as_ptr(&problem.source) as usize;
            let place = problem.labels.first().map(|label| label.span.clone());
            if !self
                .seen
                .insert((text, problem.code, place, problem.message.clone()))
            {
                return;
            }
        }
        self.problems.push(problem);
    }

    /// Whether nothing is wrong so far.
    pub(super) fn is_sound(&self) -> bool {
        self.problems.is_empty()
    }

    /// All problems: the main graph's first, then those of each included file
    /// in the order they were met, each in the order of their places.
    pub(super) fn into_problems(self) -> Vec<Diagnostic> {
        let mut problems = self.problems;
        let sources = self.sources;
        problems.sort_by_key(|problem| {
            let text = sources
                .iter()
                .position(|source| Arc::ptr_eq(source, &problem.source));
            let place = problem.labels.first().map(|label| label.span.start);
            (text.unwrap_or(sources.len()), place)
        });
        problems
    }

    /// Puts nodes into the order of the files; the place that each now has.
    pub(super) fn sort_nodes(&mut self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.nodes.len()).collect();
        if self.nodes.is_sorted_by(|a, b| a.key <= b.key) {
            return order;
        }
        order.sort_by(|&a, &b| self.nodes[a].key.cmp(&self.nodes[b].key));
        let mut places = vec![0; order.len()];
        for (place, &node) in order.iter().enumerate() {
            places[node] = place;
        }
        let mut nodes: Vec<_> = std::mem::take(&mut self.nodes)
            .into_iter()
            .enumerate()
            .collect();
        nodes.sort_by_key(|(node, _)| places[*node]);
        self.nodes = nodes.into_iter().map(|(_, node)| node).collect();
        for node in &mut self.nodes {
            for input in &mut node.inputs {
                super::renumber(&mut input.origin, &places);
            }
        }
        places
    }
}
