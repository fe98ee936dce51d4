//! Reads the files of included graphs, each once, and refuses circles.

use std::rc::Rc;
use std::sync::Arc;

use super::{Call, Expander};
use crate::check::interpolate::in_folder;
use crate::diagnostic::{Label, Place};
use crate::document::{self, Document, Problems, Text};
use crate::names::shown;

/// How deep graphs may include graphs.
const MAX_DEPTH: usize = 32;

/// A graph that a form includes, as far as its file says.
pub(super) struct Target {
    pub(super) document: Rc<Document>,
    pub(super) folder: String,
    pub(super) chain: Rc<[(String, String)]>,
    pub(super) included: Arc<[Place]>,
}

impl Expander<'_> {
    /// The graph at `path`, named from the main graph's folder, which is written
    /// as `text`; `None` after an error, which has been reported.
    pub(super) fn open(
        &mut self,
        call: &Call,
        path: &str,
        (text, form): (&Text, &str),
        problems: &mut Problems,
    ) -> Option<Target> {
        let identity = self.world.identity(path);
        let name = in_folder(&self.shown_folder, path);
        let chain: Vec<_> = call
            .chain
            .iter()
            .cloned()
            .chain([(identity.clone(), name.clone())])
            .collect();
        let start = call.chain.iter().position(|(other, _)| *other == identity);
        if let Some(start) = start {
            let names: Vec<String> = chain[start..]
                .iter()
                .map(|(_, name)| shown_path(name))
                .collect();
            let message = format!(
                "graphs include each other in a circle: {}",
                names.join(" -> ")
            );
            let error = problems.error("include_cycle", &text.span, message, "closes the circle");
            let help = "no graph can hold itself; take one of these away";
            problems.add(error.with_help(help).with_node(form));
            return None;
        }
        if chain.len() > MAX_DEPTH {
            let message = format!("graphs include each other more than {MAX_DEPTH} levels deep");
            let error = problems.error("too_deep", &text.span, message, "one more");
            problems.add(error.with_help("include fewer levels").with_node(form));
            return None;
        }
        let place = Place {
            source: Arc::clone(&call.document.source),
            label: Label {
                span: text.span.clone(),
                message: format!("included here by `{}`", shown(form)),
            },
        };
        let included: Arc<[Place]> = [place]
            .into_iter()
            .chain(call.included.iter().cloned())
            .collect();
        let document = match self.files.get(&identity) {
            Some(document) => document.clone(),
            None => {
                let document = self.read(path, &name, (text, form), &included, problems);
                self.files.insert(identity, document.clone());
                document
            }
        };
        Some(Target {
            document: document?,
            folder: path.rfind('/').map_or("", |end| &path[..=end]).to_owned(),
            chain: chain.into(),
            included,
        })
    }

    fn read(
        &mut self,
        path: &str,
        name: &str,
        (text, form): (&Text, &str),
        included: &Arc<[Place]>,
        problems: &mut Problems,
    ) -> Option<Rc<Document>> {
        self.included.push(path.to_owned());
        let bytes = match self.world.read(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = format!(
                    "cannot read the graph `{}`: {}",
                    shown_path(path),
                    error.reason
                );
                let error = problems.error("unreadable", &text.span, message, "included here");
                let help = "the path is named from the folder of the file it is written in";
                problems.add(error.with_help(help).with_node(form));
                return None;
            }
        };
        // From here on one mistake can be met twice.
        self.graphs += 1;
        match document::read(name, &bytes) {
            Ok((document, found)) => {
                self.sources.push(Arc::clone(&document.source));
                self.take(found, included);
                Some(Rc::new(document))
            }
            Err(found) => {
                self.sources
                    .extend(found.first().map(|problem| Arc::clone(&problem.source)));
                for problem in found {
                    self.report(problem.with_places(included.iter().cloned()));
                }
                None
            }
        }
    }
}

/// A path in a message: harmless, and its end rather than its start when long.
fn shown_path(path: &str) -> String {
    let count = path.chars().count();
    match count.checked_sub(60) {
        Some(more) if more > 0 => {
            let end: String = path.chars().skip(more).collect();
            format!("…{}", end.escape_debug())
        }
        _ => path.escape_debug().to_string(),
    }
}
