//! What the pages see, and what becomes of what they ask for.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use tessgraph_geometry::digest::Digest;
use tessgraph_graph::document::edit::Declarations;
use tessgraph_graph::world::read_plain;
use tessgraph_graph::{Evaluation, Plan};
use tessgraph_view::document::{Values, nodes, outputs, parameters, single};
use tessgraph_view::outcomes::checks;
use tessgraph_view::protocol::{Document, Hello, Level, Notice, State, Status, ToPage, Value};
use tessgraph_view::shown::Gallery;
use tessgraph_view::{Buffers, Hub, PageId, token};

use super::ViewArgs;
use super::edits::Edits;
use super::problems::problems;
use super::requests::Requests;
use super::sights::Sight;
use super::studio::{Done, Order, Studio, Viewed};
use super::study::{self, Studies};
use crate::commands::run::Control;
use crate::diagnostics::{error_count, without_place};
use crate::graph_file::{GraphFile, LARGEST_GRAPH, folder_of};
use crate::memory::TOO_LARGE;
use crate::watch::{Cause, Job, Wish, Work, resume};

/// Paths of pictures that pages may ask for by number.
pub(super) type Pictures = Arc<Mutex<Vec<PathBuf>>>;

/// What the pages see: the graph file, the last run, and what was asked for.
pub(super) struct Viewer<'a> {
    pub(super) args: &'a ViewArgs,
    pub(super) studio: &'a Studio<'a>,
    pub(super) requests: Arc<Requests>,
    /// The pictures of the study, by number.
    pictures: Pictures,
    pub(super) hub: Arc<Hub>,
    pub(super) buffers: Arc<Buffers>,
    pub(super) gallery: Arc<Gallery>,
    /// The digest of the graph file when it was read last.
    pub(super) content: Option<Digest>,
    pub(super) declared: Option<Declarations>,
    document: Document,
    values: Values,
    studies: Studies,
    /// Values that somebody is trying out, as `--set` takes them.
    pub(super) live: BTreeMap<String, String>,
    pub(super) edits: Edits,
    /// What pages see that have chosen something, and with `None` all others.
    pub(super) sights: BTreeMap<Option<PageId>, Sight>,
    /// Whether the run at work is out of date: the file or a value is another.
    pub(super) outdated: bool,
    /// Whether somebody has stopped the run at work.
    pub(super) cancelled: bool,
    pub(super) last: Option<(Arc<Plan>, Arc<Evaluation>)>,
}

impl<'a> Viewer<'a> {
    /// Tells pages what is known before anything has run.
    pub(super) fn new(
        args: &'a ViewArgs,
        studio: &'a Studio<'a>,
        requests: Arc<Requests>,
        pictures: Pictures,
        hub: Arc<Hub>,
        buffers: Arc<Buffers>,
    ) -> Self {
        let locked = args.set.iter().map(|(name, _)| name.clone()).collect();
        let mut viewer = Self {
            args,
            studio,
            requests,
            pictures,
            hub,
            gallery: Arc::new(Gallery::new(Arc::clone(&buffers))),
            buffers,
            content: None,
            declared: None,
            document: Document::default(),
            values: Values {
                locked,
                ..Values::default()
            },
            studies: Studies::default(),
            live: BTreeMap::new(),
            edits: Edits::default(),
            sights: [(None, Sight::default())].into(),
            outdated: false,
            cancelled: false,
            last: None,
        };
        let graph = &args.graph;
        let folder = folder_of(graph);
        let folder = folder.canonicalize().unwrap_or(folder);
        viewer.hub.publish(&ToPage::Hello(Hello {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            file: graph
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into(),
            folder: folder.to_string_lossy().into_owned(),
            session: token().unwrap_or_default(),
            // Pages of paired devices are told apart by the server.
            read_only: !args.host.is_loopback(),
        }));
        if let Ok(bytes) = read_plain(graph, LARGEST_GRAPH) {
            viewer.know(&bytes);
        }
        viewer.publish_document();
        viewer.publish_study();
        if let Some(began) = args.resume {
            viewer.resume(began);
        }
        viewer
    }

    /// Tells pages why the program began anew.
    fn resume(&mut self, began: u64) {
        if !resume::waits(&self.args.graph, began) {
            let text = "the run took more memory than it may; what the file says is shown";
            self.hub.greet(Some(Notice {
                level: Level::Warning,
                text: text.to_owned(),
            }));
            return;
        }
        let (args, registry) = (self.args, self.studio.registry);
        let opened = GraphFile::open(&args.graph, registry, &args.set, &args.engine.allow);
        if let Ok(file) = opened {
            self.document.nodes = nodes(&file.plan);
            self.document.outputs = outputs(&file.plan);
            self.publish_document();
        }
        let name = args.graph.to_string_lossy();
        let message = "the run took more memory than it may".to_owned();
        let mut diagnostic = without_place("out_of_memory", &name, message);
        diagnostic.help = Some(TOO_LARGE.to_owned());
        let items = problems(&[diagnostic]);
        self.hub.publish(&ToPage::Status(Status {
            state: State::Stale,
            errors: Some(1),
            ..Status::default()
        }));
        self.hub.publish(&ToPage::Diagnostics { items });
    }

    /// Tells pages of the table of a study, if there is a new one.
    pub(super) fn publish_study(&mut self) {
        if let Some(mut found) = self.studies.look(&self.args.graph) {
            let paths = study::add_pictures(&self.args.graph, &mut found);
            *self.pictures.lock().unwrap_or_else(PoisonError::into_inner) = paths;
            self.hub.publish(&ToPage::Study(found));
        }
    }

    /// This is the graph file's content now.
    pub(super) fn know(&mut self, bytes: &[u8]) {
        let digest = Digest::of(bytes);
        if self.content == Some(digest) {
            return;
        }
        self.content = Some(digest);
        let name = self.args.graph.to_string_lossy();
        match Declarations::read(&name, bytes) {
            Ok(declared) => {
                self.values.begin(&declared);
                self.document.source = declared.source().text().to_owned();
                self.document.units = declared.units().sign().to_owned();
                self.declared = Some(declared);
            }
            // Parameters and nodes stay those of the last text that could be read.
            Err(_) => self.document.source = String::from_utf8_lossy(bytes).into_owned(),
        }
    }

    /// Tells pages of the graph file.
    pub(super) fn publish_document(&mut self) {
        if let Some(declared) = &self.declared {
            self.document.parameters = parameters(declared, &self.values);
        }
        let content = self.content;
        self.document.can_undo = content.is_some_and(|content| self.edits.can_undo(content));
        self.document.can_redo = content.is_some_and(|content| self.edits.can_redo(content));
        self.hub.publish(&ToPage::Document(self.document.clone()));
    }

    /// What the file said of a parameter when the session began.
    pub(super) fn initial(&self, name: &str) -> Option<&Value> {
        self.values.initial.get(name)
    }

    /// Tells all pages something.
    pub(super) fn notice(&self, level: Level, text: impl Into<String>) {
        let text = text.into();
        self.hub.notice(None, Notice { level, text });
    }

    /// A cause as the page is told it: files from the graph's folder.
    fn cause(&self, cause: &Cause) -> String {
        match cause {
            Cause::File(path) => self.name_in_folder(path),
            Cause::Asked(words) => words.clone(),
        }
    }

    fn name_in_folder(&self, path: &Path) -> String {
        let folder = std::path::absolute(folder_of(&self.args.graph)).unwrap_or_default();
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let below = path.strip_prefix(&folder).unwrap_or(&path);
        below.to_string_lossy().into_owned()
    }

    /// Values that the graph runs with.
    pub(super) fn settings(&self) -> Vec<(String, String)> {
        let live = self.live.iter();
        let live = live.map(|(name, value)| (name.clone(), value.clone()));
        // Of several for one parameter the last counts: that of the command line.
        live.chain(self.args.set.iter().cloned()).collect()
    }

    /// What is true after a run that could evaluate the graph.
    fn settle(&mut self, done: Done, missing: Option<&PathBuf>, status: Status) {
        let plan = &done.plan;
        let now = plan.parameters.iter();
        let now = now.filter_map(|param| Some((param.name.clone(), single(&param.value)?)));
        self.values.now = now.collect();
        self.document.nodes = nodes(plan);
        self.document.outputs = outputs(plan);
        self.publish_document();
        let found = problems(&done.evaluation.diagnostics);
        let errors = error_count(&done.evaluation.diagnostics);
        let first = found.iter().find(|problem| problem.severity == "error");
        let line = first.map(|problem| problem.line);
        let message = first.map(|problem| problem.message.clone());
        self.publish_status(errors, line, missing, status);
        self.show_pictures(&done, message.as_deref());
        // Why nodes were computed is looked up on the disk: the picture does not wait.
        let nodes = self.studio.outcomes(plan, &done.evaluation);
        self.hub.publish(&ToPage::Outcomes { nodes });
        self.hub.publish(&ToPage::Diagnostics { items: found });
        let items = checks(plan, &done.evaluation);
        self.hub.publish(&ToPage::Checks { items });
        self.correct_pictures(&done);
        self.last = Some((done.plan, done.evaluation));
    }

    /// Tells pages whether what they see is true.
    fn publish_status(
        &self,
        errors: usize,
        line: Option<usize>,
        missing: Option<&PathBuf>,
        status: Status,
    ) {
        let waiting_for = missing.filter(|_| errors > 0);
        self.hub.publish(&ToPage::Status(Status {
            state: match (errors, waiting_for) {
                (0, _) => State::UpToDate,
                (_, Some(_)) => State::Waiting,
                (_, None) => State::Stale,
            },
            errors: (errors > 0).then_some(errors),
            line,
            waiting_for: waiting_for.map(|path| self.name_in_folder(path)),
            ..status
        }));
    }
}

impl<'a> Work<'a> for Viewer<'a> {
    type Ran = Viewed;

    fn begin(&mut self, cause: &Cause) -> Job<'a, Viewed> {
        (self.outdated, self.cancelled) = (false, false);
        if self.last.is_some() {
            // Whoever comes from now on sees what came after it.
            self.hub.greet(None);
        }
        if !self.live.is_empty() {
            resume::begins_trial();
        }
        let hub = Arc::clone(&self.hub);
        self.gallery.retain(|page| hub.is_open(page));
        self.sights
            .retain(|page, _| page.is_none_or(|page| hub.is_open(page)));
        let asked = self.sights.iter();
        let asked = asked.map(|(page, sight)| (*page, sight.asked.clone()));
        let order = Order {
            set: self.settings(),
            asked: asked.collect(),
            cause: self.cause(cause),
            hub: Arc::clone(&self.hub),
            gallery: Arc::clone(&self.gallery),
        };
        self.hub.publish(&ToPage::Status(Status {
            state: State::Computing,
            cause: Some(order.cause.clone()),
            ..Status::default()
        }));
        let studio = self.studio;
        Box::new(move |control: &Control| studio.run(&order, control))
    }

    fn is_stopped(ran: &Viewed) -> bool {
        ran.stopped
    }

    fn stopped(&mut self, cause: &Cause, ran: Viewed) -> bool {
        let cancelled = std::mem::take(&mut self.cancelled);
        if cancelled {
            self.hub.publish(&ToPage::Status(Status {
                state: State::Cancelled,
                ms: Some(ran.ms),
                cause: Some(self.cause(cause)),
                ..Status::default()
            }));
        }
        !cancelled
    }

    fn ended(&mut self, cause: &Cause, ran: Viewed, _: usize) -> Option<u8> {
        self.cancelled = false;
        if self.outdated {
            // It came to its end before it could be stopped; the next one is due.
            return None;
        }
        if let Some(content) = &ran.content {
            self.know(content);
        }
        let status = Status {
            ms: Some(ran.ms),
            cause: Some(self.cause(cause)),
            ..Status::default()
        };
        match ran.result {
            Ok(done) => self.settle(done, ran.missing.as_ref(), status),
            Err(diagnostics) => {
                self.values.now.clear();
                self.publish_document();
                let items = problems(&diagnostics);
                let line = items.first().map(|problem| problem.line);
                let errors = error_count(&diagnostics);
                self.publish_status(errors, line, ran.missing.as_ref(), status);
                self.hub.publish(&ToPage::Diagnostics { items });
            }
        }
        None
    }

    fn asked(&mut self) -> Wish {
        self.see_to_requests()
    }

    fn deaf(&mut self, reason: &str) {
        let text = format!("changes are looked for, not told: {reason}");
        self.notice(Level::Info, text);
    }

    fn look(&mut self) {
        self.publish_study();
    }

    fn rest(&mut self) {
        self.buffers.let_go();
    }
}

/// A value as `--set` takes it.
pub(super) fn setting(value: &Value) -> String {
    match value {
        Value::Bool(value) => value.to_string(),
        Value::Integer(number) => number.to_string(),
        Value::Number(number) => number.to_string(),
        Value::Text(text) => text.clone(),
    }
}
