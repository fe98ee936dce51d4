//! `run --watch`: runs again whenever something changes that the last run
//! depended on.
//!
//! Runs take place on a thread of their own, while this one listens: to the
//! system, which tells of files that were touched, and to the run, which tells
//! of files it reads. What decides is always the content. Of the parts,
//! [`debounce`] and [`dependencies`] know neither clock nor disk.

mod content;
mod debounce;
mod dependencies;
mod mailbox;
mod notices;
mod places;
mod resume;
mod stamps;
mod status;

use std::collections::BTreeSet;
use std::mem;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::Scope;
use std::time::Instant;

use crate::commands::run::{
    Control, Ran, ReportFormat, RunArgs, Session, Stopped, closing, details,
};
use crate::commands::{Context, OK, USAGE};
use crate::interrupt::{self, INTERRUPTED};
use crate::text::{count, printable};
use debounce::Debounce;
use places::Places;

pub(crate) use mailbox::{Mailbox, Message, Post};
pub(crate) use resume::begin_anew;

/// Runs the graph now and after every change, until the mailbox says to stop.
pub(crate) fn watch(
    args: &RunArgs,
    session: &Session<'_>,
    mailbox: &Mailbox,
    cx: &mut Context<'_, '_>,
) -> u8 {
    let watcher = Watcher {
        args,
        session,
        post: mailbox.post(),
        live: cx.console.is_live() && args.report == ReportFormat::Human,
        places: Places::new(args, mailbox.post()),
        debounce: Debounce::default(),
        touched: BTreeSet::new(),
        unlooked: BTreeSet::new(),
        running: None,
        again: !args.resume,
        cause: args.graph.clone(),
        is_first: !args.resume,
        warned: false,
    };
    resume::arm();
    if args.resume {
        watcher.tell("waiting for a change of the graph\n", cx);
        if args.report == ReportFormat::Json {
            // The report of the run that could not end by itself.
            closing(args, &Ran::never(Stopped::Graph(Vec::new())), cx);
        }
    }
    std::thread::scope(|scope| watcher.go(scope, mailbox, cx))
}

/// What is going on.
struct Watcher<'a> {
    args: &'a RunArgs,
    session: &'a Session<'a>,
    post: Post,
    /// Whether a bar shows progress.
    live: bool,
    places: Places<'a>,
    debounce: Debounce,
    /// Files that may have changed since the last run began.
    touched: BTreeSet<PathBuf>,
    /// Those of them that were touched just now.
    unlooked: BTreeSet<PathBuf>,
    /// The run at work.
    running: Option<Arc<Control>>,
    /// Whether the next run takes place whatever has changed.
    again: bool,
    /// What the run at work, or the next one, is for.
    cause: PathBuf,
    is_first: bool,
    /// Whether the warning about the cache was shown.
    warned: bool,
}

impl<'a> Watcher<'a> {
    fn go<'s>(mut self, scope: &'s Scope<'s, '_>, mailbox: &Mailbox, cx: &mut Context<'_, '_>) -> u8
    where
        'a: 's,
    {
        loop {
            self.start_if_due(scope);
            for message in mailbox.wait(self.deadline()) {
                if let Some(status) = self.take(message, cx) {
                    self.stop();
                    return status;
                }
            }
            if let Some(reason) = self.places.deaf.take() {
                let note = format!("note: changes are looked for, not told: {reason}\n");
                cx.console.note(&printable(&note));
            }
            let looked = self.places.look_if_due(Instant::now());
            self.touch(looked);
            self.stop_if_stale();
        }
    }

    /// Until when nothing has to be done unless a message comes.
    fn deadline(&self) -> Instant {
        let due = self.debounce.due().filter(|_| self.running.is_none());
        due.map_or(self.places.next_look, |due| due.min(self.places.next_look))
    }

    /// Deals with a message; an exit status if it was the last one.
    fn take(&mut self, message: Message, cx: &mut Context<'_, '_>) -> Option<u8> {
        match message {
            Message::Touched(places) => {
                let files = self.places.files_at(&places);
                self.touch(files);
            }
            Message::TouchedAnywhere => {
                let files = self.places.dependencies.all();
                self.touch(files);
            }
            Message::Deaf(reason) => self.places.deafen(reason),
            Message::Read(path, content) => {
                let is_new = self.places.read(&path, content.as_deref());
                if self.touched.contains(&path) {
                    self.unlooked.insert(path);
                } else if is_new && self.places.is_changed(&path) {
                    // Between being read and being watched.
                    self.touch([path].into());
                }
            }
            Message::Ended(ran) => return self.ended(&ran, cx),
            Message::Stop => return Some(INTERRUPTED),
        }
        None
    }

    fn touch(&mut self, files: BTreeSet<PathBuf>) {
        if files.is_empty() {
            return;
        }
        self.debounce.note(Instant::now());
        // A folder may be another one now, or a link lead elsewhere.
        self.places.follow();
        self.touched.extend(files.iter().cloned());
        self.unlooked.extend(files);
    }

    /// Stops the run at work if something it has read is another now. Nothing
    /// is waited for: the sooner it stops the better, and when the next one
    /// begins is another question.
    fn stop_if_stale(&mut self) {
        let unlooked = mem::take(&mut self.unlooked);
        if let Some(control) = &self.running
            && !control.stop.load(Ordering::Relaxed)
            && let Some(changed) = self.places.changed_since_read(&unlooked)
        {
            control.stop.store(true, Ordering::Relaxed);
            self.cause = changed;
        }
    }

    fn stop(&self) {
        if let Some(control) = &self.running {
            control.stop.store(true, Ordering::Relaxed);
        }
    }

    /// Begins a run, if none is at work and there is a reason for one.
    fn start_if_due<'s>(&mut self, scope: &'s Scope<'s, '_>)
    where
        'a: 's,
    {
        if self.running.is_some() {
            return;
        }
        let is_due = self.debounce.take(Instant::now());
        if is_due {
            let touched = mem::take(&mut self.touched);
            if let Some(changed) = self.places.changed(&touched) {
                (self.again, self.cause) = (true, changed);
            }
        }
        // What is still going on is waited for also after a run was stopped.
        if !self.again || self.debounce.due().is_some() {
            return;
        }
        self.again = false;
        self.places.dependencies.begin();
        let post = self.post.clone();
        let control = Arc::new(Control {
            stop: false.into(),
            // Nobody may be listening any more.
            listener: Some(Arc::new(move |path, content| {
                let _ = post.send(Message::Read(path, content));
            })),
        });
        self.running = Some(Arc::clone(&control));
        let (session, live, post) = (self.session, self.live, self.post.clone());
        scope.spawn(move || {
            let ran = session.run(live, &control);
            let _ = post.send(Message::Ended(Box::new(ran)));
        });
    }

    /// Shows what a run came to; an exit status if it was the last one.
    fn ended(&mut self, ran: &Ran, cx: &mut Context<'_, '_>) -> Option<u8> {
        self.running = None;
        if interrupt::is_requested() {
            return Some(INTERRUPTED);
        }
        if matches!(&ran.result, Ok(finished) if finished.stopped) {
            self.again = true;
            self.tell(&status::stopped(&self.cause, ran), cx);
            return None;
        }
        self.places.end();
        let warning = self.session.cache_warning().filter(|_| !self.warned);
        self.warned |= warning.is_some();
        let status = details(self.args, ran, warning, cx);
        if status == USAGE && self.is_first {
            return Some(status);
        }
        self.tell(&status::status(&self.cause, ran), cx);
        if self.args.report == ReportFormat::Json {
            closing(self.args, ran, cx);
        }
        if self.is_first {
            let files = count(self.places.dependencies.all().len(), "file");
            self.tell(&format!("watching {files}; Ctrl-C ends\n"), cx);
            self.is_first = false;
        }
        // Nobody reads the reports any more.
        cx.console.has_lost_out().then_some(OK)
    }

    /// A line for people.
    fn tell(&self, line: &str, cx: &mut Context<'_, '_>) {
        if self.args.report == ReportFormat::Human {
            cx.console.note(line);
        }
    }
}
