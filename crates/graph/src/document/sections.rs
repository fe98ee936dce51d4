//! The sections of a graph file: version, units, params, nodes, outputs.

use std::ops::Range;
use std::sync::Arc;

use super::fields::Fields;
use super::params;
use super::problems::Problems;
use super::raw::{Item, Number, Shape, Struct, plain};
use super::{DeclaredInput, DeclaredKind, Document, Link, NodeEntry, Parameter, Spanned, VERSION};
use crate::diagnostic::{Diagnostic, Source};
use crate::names::{did_you_mean, shown};
use crate::units::Units;

const SECTIONS: [&str; 7] = [
    "version", "units", "params", "inputs", "nodes", "outputs", "results",
];

/// Reads a whole graph from its places.
pub(super) fn read(
    source: &Arc<Source>,
    root: &Item,
) -> Result<(Document, Problems), Vec<Diagnostic>> {
    let text = source.text();
    let mut problems = Problems::new(source);
    let graph = match graph_fields(text, root, &problems) {
        Ok(graph) => graph,
        Err(problem) => return Err(vec![*problem]),
    };
    let head = graph
        .name
        .clone()
        .unwrap_or_else(|| problems.source().character(root.span.start));
    if let Err(problem) = check_version(text, graph, &head, "graph", &problems) {
        return Err(vec![*problem]);
    }
    let fields = Fields::new(text, &graph.fields, &SECTIONS, "a graph", &mut problems);
    let units = fields
        .get("units")
        .map_or(Units::default(), |item| units(text, item, &mut problems));
    let mut reader = Reader { text, problems };
    let mut params = Vec::new();
    for (name, item) in reader.entries(fields.get("params"), "params", "a parameter") {
        params.extend(params::read(text, &name, item, units, &mut reader.problems));
    }
    let inputs = reader.inputs(fields.get("inputs"), units, &mut params);
    let nodes = reader.entries(fields.get("nodes"), "nodes", "a node");
    let nodes = nodes
        .into_iter()
        .filter_map(|(name, item)| reader.node(name, item))
        .collect();
    let before = reader.problems.count();
    let outputs = reader.links(fields.get("outputs"), "outputs");
    let outputs_damaged = reader.problems.count() > before;
    let results = reader.links(fields.get("results"), "results");
    let document = Document {
        source: Arc::clone(source),
        units,
        params,
        inputs,
        nodes,
        outputs,
        outputs_damaged,
        results,
        head,
    };
    Ok((document, reader.problems))
}

/// The fields of `Graph(...)`, or what the file is instead.
fn graph_fields<'a>(
    text: &str,
    root: &'a Item,
    problems: &Problems,
) -> Result<&'a Struct, Box<Diagnostic>> {
    let start = problems.source().character(root.span.start);
    let found = |span: &Range<usize>, message: String, help: &str| {
        Err(Box::new(
            problems
                .error("not_a_graph", span, message, "here")
                .with_help(help),
        ))
    };
    const FORM: &str = "a graph is written `Graph(version: 1, nodes: {...}, outputs: {...})`";
    let name = match &root.shape {
        Shape::Struct(fields) => fields.name.as_ref(),
        Shape::Tuple(tuple) => tuple.name.as_ref(),
        _ => None,
    };
    match (name.map(|span| (span, plain(text, span))), &root.shape) {
        (None | Some((_, "Graph")), Shape::Struct(fields)) => Ok(fields),
        (Some((span, "Study")), _) => {
            let message = "this is a study, not a graph".to_owned();
            found(span, message, "run it with `tessgraph study`")
        }
        (None | Some((_, "Graph")), Shape::Tuple(tuple)) if tuple.items.is_empty() => found(
            &start,
            "the graph has no version and no nodes".to_owned(),
            FORM,
        ),
        (Some((span, name)), Shape::Struct(_)) => found(
            span,
            format!("expected `Graph(...)`, found `{}(...)`", shown(name)),
            FORM,
        ),
        _ => match super::foreign::recognise(text) {
            Some(foreign) => found(&foreign.span, foreign.message.to_owned(), foreign.help),
            None => {
                let label = root.label(text);
                found(
                    &start,
                    format!("expected `Graph(...)`, found {label}"),
                    FORM,
                )
            }
        },
    }
}

/// The version comes first: a newer file may mean anything by the rest.
pub(super) fn check_version(
    text: &str,
    graph: &Struct,
    head: &Range<usize>,
    what: &str,
    problems: &Problems,
) -> Result<(), Box<Diagnostic>> {
    let field = graph
        .fields
        .iter()
        .find(|field| plain(text, &field.name) == "version");
    let Some(item) = field.map(|field| &field.value) else {
        let error = problems.error(
            "bad_version",
            head,
            format!("the {what} states no version"),
            "here",
        );
        return Err(Box::new(
            error.with_help(format!("add `version: {VERSION},` as first field")),
        ));
    };
    let error = |message: String, help: String| {
        let error = problems.error("bad_version", &item.span, message, "here");
        Err(Box::new(error.with_help(help)))
    };
    match item.number(text) {
        Some(Number::Whole(VERSION)) => Ok(()),
        Some(Number::Whole(version)) if version > VERSION => error(
            format!(
                "this {what} is of version {version}, but this program reads versions up to {VERSION}"
            ),
            format!("install a release of tessgraph that reads version {version}"),
        ),
        Some(Number::Whole(version)) => error(
            format!("there is no version {version}"),
            format!("write `version: {VERSION}`"),
        ),
        _ => error(
            format!("`version` takes a whole number, not {}", item.label(text)),
            format!("write `version: {VERSION}`"),
        ),
    }
}

fn units(text: &str, item: &Item, problems: &mut Problems) -> Units {
    let names = Units::ALL.iter().map(|(name, _)| *name);
    if let Some(units) = item.name(text).and_then(Units::from_name) {
        return units;
    }
    let message = match item.name(text) {
        Some(name) => format!("there is no unit `{}`", shown(name)),
        None => format!("`units` takes a bare name, not {}", item.label(text)),
    };
    let near = item
        .name(text)
        .and_then(|name| did_you_mean(name, names.clone()));
    let all = names.collect::<Vec<_>>().join(", ");
    let help = near.unwrap_or_else(|| format!("units are {all}"));
    problems.add(
        problems
            .error("unknown_name", &item.span, message, "here")
            .with_help(help),
    );
    Units::default()
}

struct Reader<'a> {
    text: &'a str,
    problems: Problems,
}

impl<'a> Reader<'a> {
    /// The entries of a map with texts as keys.
    fn entries(
        &mut self,
        section: Option<&'a Item>,
        name: &str,
        what: &str,
    ) -> Vec<(Spanned<String>, &'a Item)> {
        let map = self.map(section, name);
        let mut entries = Vec::with_capacity(map.len());
        for (key, item) in map {
            match key.text(self.text) {
                Some(text) => entries.push((
                    Spanned {
                        value: text.value,
                        span: text.span,
                    },
                    item,
                )),
                None => self.bad_key(key, what),
            }
        }
        entries
    }

    /// Inputs of the graph; those that can be parameters are added to `params`.
    fn inputs(
        &mut self,
        section: Option<&'a Item>,
        units: Units,
        params: &mut Vec<Parameter>,
    ) -> Vec<DeclaredInput> {
        let mut inputs = Vec::new();
        for (name, item) in self.entries(section, "inputs", "an input") {
            let read = params::read_input(self.text, &name, item, units, &mut self.problems);
            let required = !read.has_default();
            let kind = match read {
                params::ReadInput::Param(param, _) => {
                    params.push(*param);
                    DeclaredKind::Param(params.len() - 1)
                }
                params::ReadInput::Value(kind, quantity) => DeclaredKind::Value(kind, quantity),
                params::ReadInput::Unknown => DeclaredKind::Unknown,
            };
            inputs.push(DeclaredInput {
                name,
                kind,
                span: item.span.clone(),
                required,
            });
        }
        inputs
    }

    fn map(&mut self, section: Option<&'a Item>, name: &str) -> &'a [(Item, Item)] {
        match section {
            None => &[],
            Some(Item {
                shape: Shape::Map(entries),
                ..
            }) => entries,
            Some(item) => {
                let message = format!("`{name}` takes a map, not {}", item.label(self.text));
                let error = self
                    .problems
                    .error("wrong_kind", &item.span, message, "here");
                let help = format!("write `{name}: {{\"name\": ...}}`");
                self.problems.add(error.with_help(help));
                &[]
            }
        }
    }

    fn bad_key(&mut self, key: &Item, what: &str) {
        let message = format!("the name of {what} is a text, not {}", key.label(self.text));
        let error = self
            .problems
            .error("wrong_kind", &key.span, message, "here");
        self.problems
            .add(error.with_help("write it in quotes: `\"name\"`"));
    }

    /// Pairs of texts: output paths or result names, and references.
    fn links(&mut self, section: Option<&'a Item>, name: &str) -> Vec<Link> {
        let what = if name == "outputs" {
            "an output"
        } else {
            "a result"
        };
        let mut links = Vec::new();
        for (key, item) in self.map(section, name) {
            let Some(key) = key.text(self.text) else {
                self.bad_key(key, what);
                continue;
            };
            match item.text(self.text) {
                Some(target) => links.push(Link { name: key, target }),
                None => {
                    let label = item.label(self.text);
                    let message = format!("{what} is the name of a node, not {label}");
                    let error = self
                        .problems
                        .error("wrong_kind", &item.span, message, "here");
                    let help = "write `\"node\"` or `\"node.result\"`";
                    self.problems.add(error.with_help(help));
                }
            }
        }
        links
    }

    /// A node: its kind and its named inputs.
    fn node(&mut self, name: Spanned<String>, item: &Item) -> Option<NodeEntry> {
        let (kind, fields) = match &item.shape {
            Shape::Struct(node) => (node.name.clone(), node.fields.clone()),
            Shape::Tuple(tuple) if tuple.items.is_empty() => (tuple.name.clone(), Vec::new()),
            _ => (None, Vec::new()),
        };
        let Some(kind) = kind else {
            self.not_a_node(&name, item);
            return None;
        };
        let kind = Spanned {
            value: plain(self.text, &kind).to_owned(),
            span: kind,
        };
        Some(NodeEntry {
            name,
            kind,
            fields,
            span: item.span.clone(),
        })
    }

    fn not_a_node(&mut self, name: &Spanned<String>, item: &Item) {
        let (found, help) = match &item.shape {
            Shape::Name => {
                let kind = shown(plain(self.text, &item.span));
                ("a bare name".to_owned(), format!("write `{kind}()`"))
            }
            Shape::Tuple(tuple) if tuple.name.is_some() => (
                "a kind with values that have no names".to_owned(),
                "inputs are named: `Kind(input: value)`".to_owned(),
            ),
            Shape::Struct(_) | Shape::Tuple(_) => (
                "a group without a kind".to_owned(),
                "write the kind before the bracket: `ReadMesh(path: \"roof.obj\")`".to_owned(),
            ),
            _ => {
                let help = "a node is written `Kind(input: value)`".to_owned();
                (item.label(self.text).to_owned(), help)
            }
        };
        let message = format!("`{}` is a node, but {found} is given", shown(&name.value));
        let error = self
            .problems
            .error("not_a_node", &item.span, message, "not a node");
        self.problems
            .add(error.with_help(help).with_node(&name.value));
    }
}
