//! What the watcher is told, from other threads.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::Instant;

use super::debounce::Step;

/// Something the watcher has to deal with.
pub(crate) enum Message {
    /// Something happened at these places.
    Touched(Vec<PathBuf>, Step),
    /// So much happened that nobody can say where.
    TouchedAnywhere,
    /// The system tells of changes no more, for this reason.
    Deaf(String),
    /// The run at work read a file, or found that there is none.
    Read(PathBuf, Option<Arc<[u8]>>),
    /// The run at work has ended.
    Ended,
    /// Somebody asks for something.
    Asked,
    /// No more is wanted.
    Stop,
}

/// Where messages are put.
pub(crate) type Post = Sender<Message>;

/// Where messages wait.
pub(crate) struct Mailbox {
    post: Post,
    messages: Receiver<Message>,
}

impl Mailbox {
    /// An empty one.
    pub(crate) fn new() -> Self {
        let (post, messages) = mpsc::channel();
        Self { post, messages }
    }

    /// A way to put messages here.
    pub(crate) fn post(&self) -> Post {
        self.post.clone()
    }

    /// Everything that has come, waiting for it until `deadline`.
    pub(super) fn wait(&self, deadline: Instant) -> Vec<Message> {
        let patience = deadline.saturating_duration_since(Instant::now());
        let mut come = match self.messages.recv_timeout(patience) {
            Ok(first) => vec![first],
            // The box has a sender itself, so it never hangs up.
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => Vec::new(),
        };
        come.extend(self.messages.try_iter());
        come
    }
}
