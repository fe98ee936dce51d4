//! Study files: which graph, which values, what to keep.

use std::ops::Range;
use std::sync::Arc;

use super::fields::Fields;
use super::problems::Problems;
use super::raw::{Item, Shape, Struct, plain};
use super::text::Text;
use super::{encoding, sections, syntax};
use crate::diagnostic::{Diagnostic, Source};
use crate::names::{is_snake_case, shown};

const FIELDS: [&str; 6] = ["version", "graph", "axes", "set", "keep", "measures"];

const FORM: &str =
    "a study is written `Study(version: 1, graph: \"facade.ron\", axes: {...}, measures: {...})`";

/// A study file, read but not held against its graph.
#[derive(Debug)]
pub(crate) struct StudyDocument {
    pub(crate) source: Arc<Source>,
    /// The path of the graph, from the study's folder.
    pub(crate) graph: Text,
    /// Names and axes in file order.
    pub(crate) axes: Vec<(Text, Item)>,
    /// Names and values of parameters that all variants share.
    pub(crate) set: Vec<(Text, Item)>,
    /// Outputs of the graph to be written for each variant.
    pub(crate) keep: Vec<Text>,
    /// Names and expressions.
    pub(crate) measures: Vec<(Text, Text)>,
    pub(crate) head: Range<usize>,
}

/// Reads a study file from its bytes.
///
/// # Errors
/// Everything that is wrong with it by itself.
pub(crate) fn read_study(name: &str, bytes: &[u8]) -> Result<StudyDocument, Vec<Diagnostic>> {
    let source = encoding::decode(name, bytes).map_err(|problem| vec![*problem])?;
    let root = syntax::parse(&source).map_err(|problem| vec![*problem])?;
    let text = source.text();
    let mut problems = Problems::new(&source);
    let study = study_fields(text, &root, &problems).map_err(|problem| vec![*problem])?;
    let head = study
        .name
        .clone()
        .unwrap_or_else(|| source.character(root.span.start));
    sections::check_version(text, study, &head, "study", &problems)
        .map_err(|problem| vec![*problem])?;
    let fields = Fields::new(text, &study.fields, &FIELDS, "a study", &mut problems);
    let mut reader = Reader { text, problems };
    let graph = reader.graph(fields.get("graph"), &head);
    let axes = reader.map(fields.get("axes"), "axes");
    let set = reader.map(fields.get("set"), "set");
    let keep = reader.list(fields.get("keep"));
    let measures = reader.measures(fields.get("measures"));
    reader.check_purpose(&axes, &fields, &head);
    match (graph, reader.problems.count()) {
        (Some(graph), 0) => Ok(StudyDocument {
            source: Arc::clone(&source),
            graph,
            axes,
            set,
            keep,
            measures,
            head,
        }),
        _ => Err(reader.problems.into_sorted()),
    }
}

/// The fields of `Study(...)`, or what the file is instead.
fn study_fields<'a>(
    text: &str,
    root: &'a Item,
    problems: &Problems,
) -> Result<&'a Struct, Box<Diagnostic>> {
    let start = problems.source().character(root.span.start);
    let (name, fields) = match &root.shape {
        Shape::Struct(fields) => (fields.name.as_ref(), Some(fields)),
        Shape::Tuple(tuple) => (tuple.name.as_ref(), None),
        _ => (None, None),
    };
    let (message, help) = match (name.map(|span| plain(text, span)), fields) {
        (Some("Study"), Some(fields)) => return Ok(fields),
        (Some("Graph"), _) => (
            "this is a graph, not a study".to_owned(),
            "run it with `tessgraph run`",
        ),
        (Some("Study"), None) => ("the study is empty".to_owned(), FORM),
        (Some(name), _) => (
            format!("expected `Study(...)`, found `{}(...)`", shown(name)),
            FORM,
        ),
        (None, _) => (
            format!("expected `Study(...)`, found {}", root.label(text)),
            FORM,
        ),
    };
    let span = name.cloned().unwrap_or(start);
    let error = problems.error("not_a_study", &span, message, "here");
    Err(Box::new(error.with_help(help)))
}

struct Reader<'a> {
    text: &'a str,
    problems: Problems,
}

impl Reader<'_> {
    fn report(&mut self, code: &'static str, span: &Range<usize>, message: String, help: &str) {
        let error = self.problems.error(code, span, message, "here");
        self.problems.add(error.with_help(help));
    }

    fn graph(&mut self, item: Option<&Item>, head: &Range<usize>) -> Option<Text> {
        let Some(item) = item else {
            let help = "add `graph: \"facade.ron\"`, a path from the study's folder";
            self.report(
                "missing_input",
                head,
                "the study names no graph".to_owned(),
                help,
            );
            return None;
        };
        let text = item.text(self.text);
        if text.is_none() {
            let message = format!("`graph` takes a path, not {}", item.label(self.text));
            self.report("wrong_kind", &item.span, message, "write it in quotes");
        }
        text
    }

    /// A map with texts as keys, each once.
    fn map(&mut self, section: Option<&Item>, name: &str) -> Vec<(Text, Item)> {
        let mut entries: Vec<(Text, Item)> = Vec::new();
        let Some(section) = section else {
            return entries;
        };
        let Shape::Map(pairs) = &section.shape else {
            let message = format!("`{name}` takes a map, not {}", section.label(self.text));
            let help = format!("write `{name}: {{\"name\": ...}}`");
            self.report("wrong_kind", &section.span, message, &help);
            return entries;
        };
        for (key, item) in pairs {
            let Some(key_text) = key.text(self.text) else {
                let message = format!("a name is a text, not {}", key.label(self.text));
                self.report("wrong_kind", &key.span, message, "write it in quotes");
                continue;
            };
            if let Some((first, _)) = entries.iter().find(|(key, _)| key.value == key_text.value) {
                let message = format!("`{}` is given twice", shown(&key_text.value));
                let error = self
                    .problems
                    .error("duplicate_name", &key_text.span, message, "again here")
                    .with_label(first.span.clone(), "first given here");
                self.problems.add(error.with_help("remove one of them"));
                continue;
            }
            entries.push((key_text, item.clone()));
        }
        entries
    }

    fn list(&mut self, section: Option<&Item>) -> Vec<Text> {
        let Some(section) = section else {
            return Vec::new();
        };
        let items = match &section.shape {
            Shape::List(items) => items.as_slice(),
            _ => std::slice::from_ref(section),
        };
        let mut texts = Vec::new();
        for item in items {
            match item.text(self.text) {
                Some(text) => texts.push(text),
                None => {
                    let label = item.label(self.text);
                    let message = format!("`keep` takes outputs of the graph, not {label}");
                    let help = "write `keep: [\"out/facade.glb\"]`";
                    self.report("wrong_kind", &item.span, message, help);
                }
            }
        }
        texts
    }

    fn measures(&mut self, section: Option<&Item>) -> Vec<(Text, Text)> {
        let mut measures = Vec::new();
        for (name, item) in self.map(section, "measures") {
            if !is_snake_case(&name.value)
                || ["id", "status", "error"].contains(&name.value.as_str())
            {
                let message = format!("`{}` is no name for a measure", shown(&name.value));
                let help =
                    "write lower-case letters, digits and `_`; not `id`, `status` or `error`";
                self.report("bad_name", &name.span, message, help);
            }
            match item.text(self.text) {
                Some(text) => measures.push((name, text)),
                None => {
                    let label = item.label(self.text);
                    let message = format!("a measure is an expression, not {label}");
                    let help = "write it in quotes: `\"check.pairs\"`";
                    self.report("wrong_kind", &item.span, message, help);
                }
            }
        }
        measures
    }

    /// A study varies something and wants to know something.
    fn check_purpose(
        &mut self,
        axes: &[(Text, Item)],
        fields: &Fields<'_, '_>,
        head: &Range<usize>,
    ) {
        if axes.is_empty()
            && fields
                .get("axes")
                .is_none_or(|axes| matches!(axes.shape, Shape::Map(_)))
        {
            let help = "add `axes: {\"parameter\": Values(of: [...])}`";
            self.report(
                "missing_input",
                head,
                "the study varies nothing".to_owned(),
                help,
            );
        }
        if fields.get("keep").is_none() && fields.get("measures").is_none() {
            let help =
                "add `measures: {\"name\": \"node.result\"}` or `keep: [\"out/facade.glb\"]`";
            self.report(
                "missing_input",
                head,
                "the study keeps nothing".to_owned(),
                help,
            );
        }
    }
}
