//! What pages ask for, until somebody sees to it.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

use tessgraph_view::Asking;

use crate::watch::{Message, Post};

/// Requests that wait; more come only from a page that has gone wrong.
const MOST: usize = 1024;

/// The requests that nobody has seen to.
pub(super) struct Requests {
    waiting: Mutex<VecDeque<Asking>>,
    post: Mutex<Post>,
}

impl Requests {
    /// Requests are announced by [`Message::Asked`].
    pub(super) fn new(post: Post) -> Self {
        Self {
            waiting: Mutex::default(),
            post: Mutex::new(post),
        }
    }

    /// Takes a request up; `false` if too many are waiting.
    pub(super) fn put(&self, asking: Asking) -> bool {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        if waiting.len() >= MOST {
            return false;
        }
        waiting.push_back(asking);
        drop(waiting);
        let post = self.post.lock().unwrap_or_else(PoisonError::into_inner);
        // Nobody may be listening any more.
        let _ = post.send(Message::Asked);
        true
    }

    /// The oldest request.
    pub(super) fn take(&self) -> Option<Asking> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.pop_front()
    }
}
