//! What every page is told: the latest message of each type, and the picture of what
//! it looks at.
//!
//! A page that is slow misses messages that a later one of the same type has
//! replaced, and nothing piles up for it.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, MutexGuard, PoisonError};

use axum::extract::ws::Utf8Bytes;
use tokio::sync::watch;

use crate::protocol::{Notice, ToPage};

/// The types that are kept for all, in the order in which a new page is told them.
const SLOTS: usize = 7;

/// Notices that a page which is a little behind still gets.
const MOST_NOTICES: usize = 32;

/// A page that is open, by number; none has the number of another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PageId(u64);

/// The latest messages, and a bell that rings when there are new ones.
pub struct Hub {
    state: Mutex<State>,
    bell: watch::Sender<u64>,
}

#[derive(Default)]
struct State {
    latest: [Option<Kept>; SLOTS],
    /// What pages see that have chosen nothing.
    first: Sight,
    /// The pages that are open, and what those see that have chosen something.
    pages: BTreeMap<PageId, Option<Sight>>,
    notices: VecDeque<(Option<PageId>, Kept)>,
    /// What pages are told when they come.
    greeting: Option<Utf8Bytes>,
    /// How many messages there were.
    count: u64,
    /// How many pages there were.
    opened: u64,
}

#[derive(Clone)]
struct Kept {
    /// How many messages there were with it.
    order: u64,
    text: Utf8Bytes,
}

/// A picture.
#[derive(Default)]
struct Sight {
    version: u64,
    shown: Option<Kept>,
    /// What the next one will need: a page that comes later has no use for it.
    coming: Option<Kept>,
}

/// Where a message for all is kept; `None` for answers and pictures.
fn slot(message: &ToPage) -> Option<usize> {
    Some(match message {
        ToPage::Hello(_) => 0,
        ToPage::Document(_) => 1,
        ToPage::Status(_) => 2,
        ToPage::Outcomes { .. } => 3,
        ToPage::Diagnostics { .. } => 4,
        ToPage::Checks { .. } => 5,
        ToPage::Study(_) => 6,
        ToPage::Shown(_)
        | ToPage::Coming(_)
        | ToPage::Picked(_)
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
    /// not told again. Answers, notices and pictures do not belong here.
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

    /// Shows a page that has chosen something its picture, or what that will need; with
    /// `None` all others, and those that come later. Nothing but
    /// [`ToPage::Shown`] and [`ToPage::Coming`] belongs here.
    pub fn show(&self, page: Option<PageId>, message: &ToPage) {
        let text = text(message);
        let mut state = self.state();
        let order = state.next();
        let kept = Some(Kept { order, text });
        let sight = match page {
            None => &mut state.first,
            Some(page) => match state.pages.get_mut(&page) {
                Some(sight) => sight.get_or_insert_default(),
                // It is gone.
                None => return,
            },
        };
        match message {
            ToPage::Shown(shown) => (sight.version, sight.shown) = (shown.version, kept),
            ToPage::Coming(_) => sight.coming = kept,
            _ => return,
        }
        drop(state);
        self.bell.send_replace(order);
    }

    /// Tells a page, or all pages that are there now.
    pub fn notice(&self, page: Option<PageId>, notice: Notice) {
        let text = text(&ToPage::Notice(notice));
        let mut state = self.state();
        let order = state.next();
        state.notices.push_back((page, Kept { order, text }));
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

    /// Whether that page is still open.
    pub fn is_open(&self, page: PageId) -> bool {
        self.state().pages.contains_key(&page)
    }

    /// A page is opened.
    pub(crate) fn open(&self) -> PageId {
        let mut state = self.state();
        state.opened += 1;
        let page = PageId(state.opened);
        state.pages.insert(page, None);
        page
    }

    /// A page is closed.
    pub(crate) fn close(&self, page: PageId) {
        self.state().pages.remove(&page);
    }

    /// Rings whenever there is something new.
    pub(crate) fn bell(&self) -> watch::Receiver<u64> {
        self.bell.subscribe()
    }

    /// Everything a new page has to be told, and how many messages there were.
    pub(crate) fn first(&self) -> (Vec<Utf8Bytes>, u64) {
        let state = self.state();
        let kept = state.latest.iter().flatten().chain(&state.first.shown);
        let texts = kept.map(|kept| &kept.text).chain(&state.greeting);
        (texts.cloned().collect(), state.count)
    }

    /// What a page has to be told that was told the first `told` messages, in
    /// order, and how many messages there were.
    pub(crate) fn since(&self, page: PageId, told: u64) -> (Vec<Utf8Bytes>, u64) {
        let state = self.state();
        let own = state.pages.get(&page).and_then(Option::as_ref);
        let Sight { shown, coming, .. } = own.unwrap_or(&state.first);
        let notices = state.notices.iter();
        let notices = notices.filter(|(to, _)| to.is_none_or(|to| to == page));
        let kept = state.latest.iter().chain([shown, coming]).flatten();
        let kept = kept.chain(notices.map(|(_, kept)| kept));
        let mut new: Vec<&Kept> = kept.filter(|kept| kept.order > told).collect();
        new.sort_by_key(|kept| kept.order);
        let texts = new.into_iter().map(|kept| kept.text.clone()).collect();
        (texts, state.count)
    }

    /// All that a page was told last which sees the picture of that version; `None` if
    /// none sees it any more.
    pub(crate) fn seen_with(&self, version: u64) -> Option<Vec<Utf8Bytes>> {
        let state = self.state();
        let mut sights = state.pages.values().flatten().chain([&state.first]);
        let shown = &sights.find(|sight| sight.version == version)?.shown;
        let kept = state.latest.iter().chain([shown]).flatten();
        Some(kept.map(|kept| kept.text.clone()).collect())
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
    use crate::protocol::{Level, Shown, Status};

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
        let page = hub.open();
        assert!(hub.since(page, told).0.is_empty());
        hub.publish(&status(2.0));
        let items = Vec::new();
        hub.publish(&ToPage::Checks { items });
        for text in ["a", "b"] {
            let (level, text) = (Level::Info, text.to_owned());
            hub.notice(None, Notice { level, text });
        }
        hub.publish(&status(3.0));
        let (new, told) = hub.since(page, told);
        let types: Vec<_> = new.iter().map(|text| &text[..20]).collect();
        assert_eq!(new.len(), 4, "{types:?}");
        assert!(new[0].contains("checks") && new[1].contains("\"a\""));
        assert!(new[3].contains("3.0"));
        hub.publish(&status(3.0));
        assert!(
            hub.since(page, told).0.is_empty(),
            "the same is not told again"
        );
    }

    fn picture(version: u64) -> ToPage {
        ToPage::Shown(Box::new(Shown {
            version,
            ..Shown::default()
        }))
    }

    #[test]
    fn each_page_sees_what_it_has_chosen() {
        let hub = Hub::default();
        let [one, other] = [hub.open(), hub.open()];
        hub.show(None, &picture(1));
        let (_, told) = hub.first();
        hub.show(Some(one), &picture(2));
        let seen = |page| -> Vec<Utf8Bytes> { hub.since(page, told).0 };
        assert!(seen(one)[0].contains("\"version\":2") && seen(other).is_empty());
        hub.show(None, &picture(3));
        assert!(seen(one)[0].contains("\"version\":2"));
        assert!(seen(other)[0].contains("\"version\":3"));
        assert!(hub.first().0[0].contains("\"version\":3"));
        let (level, text) = (Level::Info, "only you".to_owned());
        hub.notice(Some(other), Notice { level, text });
        assert_eq!((seen(one).len(), seen(other).len()), (1, 2));
        assert_eq!(hub.seen_with(2).map(|texts| texts.len()), Some(1));
        assert!(hub.seen_with(1).is_none(), "it was replaced");
        hub.close(one);
        assert!(hub.seen_with(2).is_none() && !hub.is_open(one));
        hub.show(Some(one), &picture(4));
        assert!(hub.seen_with(4).is_none(), "nobody sees it");
    }
}
