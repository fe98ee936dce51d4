//! What every page is told: the latest message of each type.
//!
//! A page that is slow misses messages that a later one of the same type has
//! replaced, and nothing piles up for it.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use axum::extract::ws::Utf8Bytes;
use tokio::sync::watch;

use crate::protocol::{Notice, ToPage};

/// The types that are kept, in the order in which a new page is told them.
const SLOTS: usize = 9;

/// Where what is to come is kept: a page that comes later has no use for it.
const COMING: usize = 8;

/// Notices that a page which is a little behind still gets.
const MOST_NOTICES: usize = 32;

/// The latest messages, and a bell that rings when there are new ones.
pub struct Hub {
    state: Mutex<State>,
    bell: watch::Sender<u64>,
}

#[derive(Default)]
struct State {
    latest: [Option<Kept>; SLOTS],
    notices: VecDeque<Kept>,
    /// What pages are told when they come.
    greeting: Option<Utf8Bytes>,
    /// How many messages there were.
    count: u64,
}

#[derive(Clone)]
struct Kept {
    /// How many messages there were with it.
    order: u64,
    text: Utf8Bytes,
}

/// Where a message is kept; `None` for answers, which are for one page only.
fn slot(message: &ToPage) -> Option<usize> {
    Some(match message {
        ToPage::Hello(_) => 0,
        ToPage::Document(_) => 1,
        ToPage::Status(_) => 2,
        ToPage::Outcomes { .. } => 3,
        ToPage::Diagnostics { .. } => 4,
        ToPage::Checks { .. } => 5,
        ToPage::Shown(_) => 6,
        ToPage::Study(_) => 7,
        ToPage::Coming(_) => COMING,
        ToPage::Picked(_)
        | ToPage::Measured(_)
        | ToPage::Sectioned(_)
        | ToPage::Rendered { .. }
        | ToPage::Described(_)
        | ToPage::Previewed(_)
        | ToPage::Notice(_)
        | ToPage::Access { .. }
        | ToPage::Shares(_) => return None,
    })
}

/// A message as it is sent. The types of this crate always have a JSON form.
pub(crate) fn text(message: &ToPage) -> Utf8Bytes {
    serde_json::to_string(message).unwrap_or_default().into()
}

impl Default for Hub {
    fn default() -> Self {
        Self {
            state: Mutex::default(),
            bell: watch::Sender::new(0),
        }
    }
}

impl Hub {
    /// Tells all pages, and those that come later. What they were told last is
    /// not told again. Answers and notices do not belong here.
    pub fn publish(&self, message: &ToPage) {
        let Some(slot) = slot(message) else {
            return;
        };
        let text = text(message);
        let mut state = self.state();
        if state.latest[slot]
            .as_ref()
            .is_some_and(|kept| kept.text == text)
        {
            return;
        }
        let order = state.next();
        state.latest[slot] = Some(Kept { order, text });
        drop(state);
        self.bell.send_replace(order);
    }

    /// Tells all pages that are there now.
    pub fn notice(&self, notice: Notice) {
        let text = text(&ToPage::Notice(notice));
        let mut state = self.state();
        let order = state.next();
        state.notices.push_back(Kept { order, text });
        if state.notices.len() > MOST_NOTICES {
            state.notices.pop_front();
        }
        drop(state);
        self.bell.send_replace(order);
    }

    /// Tells this to every page that comes from now on; nothing any more with `None`.
    pub fn greet(&self, notice: Option<Notice>) {
        let greeting = notice.map(|notice| text(&ToPage::Notice(notice)));
        self.state().greeting = greeting;
    }

    /// Rings after [`Hub::publish`] and [`Hub::notice`].
    pub(crate) fn bell(&self) -> watch::Receiver<u64> {
        self.bell.subscribe()
    }

    /// Everything a new page has to be told, and how many messages there were.
    pub(crate) fn first(&self) -> (Vec<Utf8Bytes>, u64) {
        let state = self.state();
        let latest = state.latest[..COMING].iter().flatten();
        let latest = latest.map(|kept| &kept.text);
        let texts = latest.chain(&state.greeting).cloned();
        (texts.collect(), state.count)
    }

    /// What a page has to be told that was told the first `told` messages, in
    /// order, and how many messages there were.
    pub(crate) fn since(&self, told: u64) -> (Vec<Utf8Bytes>, u64) {
        let state = self.state();
        let kept = state.latest.iter().flatten().chain(&state.notices);
        let mut new: Vec<&Kept> = kept.filter(|kept| kept.order > told).collect();
        new.sort_by_key(|kept| kept.order);
        let texts = new.into_iter().map(|kept| kept.text.clone()).collect();
        (texts, state.count)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn next(&mut self) -> u64 {
        self.count += 1;
        self.count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::{Level, Status};

    fn status(ms: f64) -> ToPage {
        ToPage::Status(Status {
            ms: Some(ms),
            ..Status::default()
        })
    }

    #[test]
    fn a_page_that_is_behind_gets_the_latest_of_each_type_and_all_notices() {
        let hub = Hub::default();
        hub.publish(&status(1.0));
        let (first, told) = hub.first();
        assert_eq!((first.len(), told), (1, 1));
        assert!(hub.since(told).0.is_empty());
        hub.publish(&status(2.0));
        let items = Vec::new();
        hub.publish(&ToPage::Checks { items });
        for text in ["a", "b"] {
            let (level, text) = (Level::Info, text.to_owned());
            hub.notice(Notice { level, text });
        }
        hub.publish(&status(3.0));
        let (new, told) = hub.since(told);
        let types: Vec<_> = new.iter().map(|text| &text[..20]).collect();
        assert_eq!(new.len(), 4, "{types:?}");
        assert!(new[0].contains("checks") && new[1].contains("\"a\""));
        assert!(new[3].contains("3.0"));
        hub.publish(&status(3.0));
        assert!(hub.since(told).0.is_empty(), "the same is not told again");
    }
}
