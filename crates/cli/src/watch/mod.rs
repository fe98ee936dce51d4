//! Running again whenever something changes that the last run depended on.
//!
//! Runs take place on a thread of their own, while this one listens: to the
//! system, which tells of files that were touched, and to the run, which tells
//! of files it reads. What decides is always the content. Of the parts,
//! [`debounce`] and [`dependencies`] know neither clock nor disk, [`rerun`] is
//! what `run --watch` does; the live page does something else.

mod cause;
mod content;
mod debounce;
mod dependencies;
mod mailbox;
mod notices;
mod places;
mod rerun;
mod rest;
pub(crate) mod resume;
mod stamps;
mod status;

use std::collections::BTreeSet;
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::{Scope, ScopedJoinHandle};
use std::time::Instant;

use crate::commands::run::Control;
use crate::interrupt::{self, INTERRUPTED};
use debounce::{Debounce, Step};
use places::Places;
use rest::Rest;

pub(crate) use cause::Cause;
pub(crate) use mailbox::{Mailbox, Message, Post};
pub(crate) use rerun::watch;
pub(crate) use resume::begin_anew;

/// What is watched, and how.
pub(crate) struct Watched<'a> {
    /// The graph file.
    pub(crate) graph: &'a Path,
    /// Folders outside the graph's that may be read from.
    pub(crate) allowed: &'a [PathBuf],
    /// Whether files are looked at, because the system tells of no change.
    pub(crate) poll: bool,
}

/// A run that is about to begin.
pub(crate) type Job<'a, R> = Box<dyn FnOnce(&Control) -> R + Send + 'a>;

/// What is done whenever something has changed.
pub(crate) trait Work<'a> {
    /// What a run comes to.
    type Ran: Send + 'a;

    /// The next run.
    fn begin(&mut self, cause: &Cause) -> Job<'a, Self::Ran>;

    /// Whether a run was stopped before it came to its end.
    fn is_stopped(ran: &Self::Ran) -> bool;

    /// Deals with a run that was stopped because of `cause`; says whether another
    /// one is due.
    fn stopped(&mut self, cause: &Cause, ran: Self::Ran) -> bool;

    /// Deals with a run that depends on so many files; an exit status if it was
    /// the last one.
    fn ended(&mut self, cause: &Cause, ran: Self::Ran, files: usize) -> Option<u8>;

    /// Deals with [`Message::Asked`].
    fn asked(&mut self) -> Wish {
        Wish::default()
    }

    /// Called from time to time, every two seconds or so, to look at what nobody
    /// tells of.
    fn look(&mut self) {}

    /// Nobody has edited for a while: lets go of what is only kept for the next edit.
    fn rest(&mut self) {}

    /// The system tells of no changes.
    fn deaf(&mut self, reason: &str);
}

/// What somebody wants of the run at work and the next one.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Wish {
    /// The run at work stops, and without a reason for another none takes place.
    pub(crate) stop: bool,
    /// Another one takes place, for this reason.
    pub(crate) again: Option<Cause>,
}

/// Does the work at once unless `waits`, which is asked when the graph is already
/// watched, and again after every change, until the
/// mailbox says to stop.
pub(crate) fn follow<'a, W: Work<'a>>(
    watched: &Watched<'a>,
    waits: impl FnOnce() -> bool,
    mailbox: &Mailbox,
    work: W,
) -> u8 {
    std::thread::scope(|scope| {
        let watcher = Watcher {
            work,
            post: mailbox.post(),
            places: Places::new(watched, mailbox.post()),
            debounce: Debounce::default(),
            rest: Rest::default(),
            touched: BTreeSet::new(),
            unlooked: BTreeSet::new(),
            running: None,
            // After the places: what happens from now on is told.
            again: !waits(),
            cause: Cause::File(watched.graph.to_owned()),
        };
        watcher.go(scope, mailbox)
    })
}

/// What is going on.
struct Watcher<'s, 'a, W: Work<'a>> {
    work: W,
    post: Post,
    places: Places<'a>,
    debounce: Debounce,
    rest: Rest,
    /// Files that may have changed since the last run began.
    touched: BTreeSet<PathBuf>,
    /// Those of them that were touched just now.
    unlooked: BTreeSet<PathBuf>,
    running: Option<Running<'s, W::Ran>>,
    /// Whether the next run takes place whatever has changed.
    again: bool,
    /// What the run at work, or the next one, is for.
    cause: Cause,
}

/// The run at work.
struct Running<'s, R> {
    control: Arc<Control>,
    thread: ScopedJoinHandle<'s, R>,
}

/// Tells that a run has come to its end, whichever way that is.
struct Bell(Post);

impl Drop for Bell {
    fn drop(&mut self) {
        // Nobody may be listening any more.
        let _ = self.0.send(Message::Ended);
    }
}

impl<'s, 'a: 's, W: Work<'a>> Watcher<'s, 'a, W> {
    fn go(mut self, scope: &'s Scope<'s, '_>, mailbox: &Mailbox) -> u8 {
        loop {
            self.start_if_due(scope);
            for message in mailbox.wait(self.deadline()) {
                if let Some(status) = self.take(message) {
                    self.stop();
                    return status;
                }
            }
            if let Some(reason) = self.places.deaf.take() {
                self.work.deaf(&reason);
            }
            if let Some(looked) = self.places.look_if_due(Instant::now()) {
                self.touch(looked, Step::Begun);
                self.work.look();
            }
            self.stop_if_stale();
            self.rest_if_due();
        }
    }

    /// Gives back memory when nothing has been at work for a while. Asked at every
    /// look for changes, every few seconds.
    fn rest_if_due(&mut self) {
        if self.running.is_none() && self.rest.take(Instant::now()) {
            self.work.rest();
            tessgraph_pages::give_back();
        }
    }

    /// Until when nothing has to be done unless a message comes.
    fn deadline(&self) -> Instant {
        let due = self.debounce.due().filter(|_| self.running.is_none());
        due.map_or(self.places.next_look, |due| due.min(self.places.next_look))
    }

    /// Deals with a message; an exit status if it was the last one.
    fn take(&mut self, message: Message) -> Option<u8> {
        match message {
            Message::Touched(places, step) => {
                let files = self.places.files_at(&places);
                self.touch(files, step);
            }
            Message::TouchedAnywhere => {
                let files = self.places.dependencies.all();
                self.touch(files, Step::Begun);
            }
            Message::Deaf(reason) => self.places.deafen(reason),
            Message::Read(path, content) => {
                let is_new = self.places.read(&path, content.as_deref());
                if self.touched.contains(&path) {
                    self.unlooked.insert(path);
                } else if is_new && self.places.is_changed(&path) {
                    // Between being read and being watched.
                    self.touch([path].into(), Step::Begun);
                }
            }
            Message::Ended => return self.ended(),
            Message::Asked => {
                self.rest.disturb(Instant::now());
                let wish = self.work.asked();
                if wish.stop {
                    self.stop();
                }
                match wish.again {
                    Some(cause) => (self.again, self.cause) = (true, cause),
                    None => self.again &= !wish.stop,
                }
            }
            Message::Stop => return Some(INTERRUPTED),
        }
        None
    }

    fn touch(&mut self, files: BTreeSet<PathBuf>, step: Step) {
        if files.is_empty() {
            return;
        }
        self.debounce.note(Instant::now(), &files, step);
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
        if let Some(Running { control, .. }) = &self.running
            && !control.stop.load(Ordering::Relaxed)
            && let Some(changed) = self.places.changed_since_read(&unlooked)
        {
            control.stop.store(true, Ordering::Relaxed);
            self.cause = Cause::File(changed);
        }
    }

    fn stop(&self) {
        if let Some(Running { control, .. }) = &self.running {
            control.stop.store(true, Ordering::Relaxed);
        }
    }

    /// Begins a run, if none is at work and there is a reason for one.
    fn start_if_due(&mut self, scope: &'s Scope<'s, '_>) {
        if self.running.is_some() {
            return;
        }
        let is_due = self.debounce.take(Instant::now());
        if is_due {
            let touched = mem::take(&mut self.touched);
            if let Some(changed) = self.places.changed(&touched) {
                (self.again, self.cause) = (true, Cause::File(changed));
            }
        }
        // What is still going on is waited for also after a run was stopped.
        if !self.again || self.debounce.due().is_some() {
            return;
        }
        self.again = false;
        resume::begins();
        self.places.dependencies.begin();
        let post = self.post.clone();
        let control = Arc::new(Control {
            stop: false.into(),
            // Nobody may be listening any more.
            listener: Some(Arc::new(move |path, content| {
                let _ = post.send(Message::Read(path, content));
            })),
        });
        let job = self.work.begin(&self.cause);
        let (given, bell) = (Arc::clone(&control), Bell(self.post.clone()));
        let thread = scope.spawn(move || {
            let _bell = bell;
            job(&given)
        });
        self.running = Some(Running { control, thread });
    }

    /// Deals with what a run came to; an exit status if it was the last one.
    fn ended(&mut self) -> Option<u8> {
        let running = self.running.take()?;
        self.rest.disturb(Instant::now());
        let ran = match running.thread.join() {
            Ok(ran) => ran,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        if interrupt::is_requested() {
            return Some(INTERRUPTED);
        }
        if W::is_stopped(&ran) {
            self.again |= self.work.stopped(&self.cause, ran);
            return None;
        }
        self.places.end();
        let files = self.places.dependencies.all().len();
        self.work.ended(&self.cause, ran, files)
    }
}
