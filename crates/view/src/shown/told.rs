//! Which pictures pages were shown last.

use std::collections::BTreeMap;
use std::sync::{MutexGuard, PoisonError};

use super::Gallery;
use crate::hub::PageId;
use crate::protocol::{BufferName, Coming, Shown, ShownField};

/// What pages were shown last.
#[derive(Default)]
pub(super) struct Told {
    /// Of the last picture; no two have the same.
    version: u64,
    /// By page, and for all that have chosen nothing.
    pictures: BTreeMap<Option<PageId>, Shown>,
}

impl Gallery {
    /// Whether a page was shown another picture last than the one that needs this.
    pub fn lacks(&self, page: Option<PageId>, coming: &Coming) -> bool {
        let told = self.told_now();
        let last = told.pictures.get(&page);
        let mesh = last.and_then(|shown| shown.mesh.as_ref());
        mesh.is_none_or(|mesh| mesh.positions != coming.positions)
    }

    /// Has the fields made by which somebody coloured a last picture: they will
    /// be asked for next.
    pub(super) fn prepare(&self, fields: &[ShownField]) {
        let told = self.told_now();
        for field in fields {
            let before = told.pictures.values().flat_map(|shown| &shown.fields);
            let mut before = before.filter(|before| before.name == field.name);
            if before.any(|before| self.buffers.is_made(before.values)) {
                self.buffers.prepare(field.values);
            }
        }
    }

    /// The version of the picture that a page was shown last.
    pub fn version(&self, page: PageId) -> u64 {
        let told = self.told_now();
        let own = told.pictures.get(&Some(page));
        let shown = own.or_else(|| told.pictures.get(&None));
        shown.map_or(0, |shown| shown.version)
    }

    /// Gives a picture the version it is shown to a page under. Says whether it has to
    /// be told: it is new to that page, or somebody insists.
    pub fn told(&self, page: Option<PageId>, shown: &mut Shown, insists: bool) -> bool {
        let mut told = self.told_now();
        let last = told.pictures.get(&page);
        shown.version = last.map_or(0, |last| last.version);
        let is_new = last != Some(&*shown) || insists;
        if is_new {
            told.version += 1;
            shown.version = told.version;
            told.pictures.insert(page, shown.clone());
        }
        is_new
    }

    /// All pages were shown what is new to them: lets go of buffers that only older
    /// pictures name.
    pub fn tidy(&self) {
        let named = self.told_now().pictures.values().flat_map(names).collect();
        self.buffers.sent(&named);
    }

    /// Forgets pages that are closed.
    pub fn retain(&self, is_open: impl Fn(PageId) -> bool) {
        let mut told = self.told_now();
        told.pictures.retain(|page, _| page.is_none_or(&is_open));
    }

    fn told_now(&self) -> MutexGuard<'_, Told> {
        self.told.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// All buffers that a message names.
fn names(shown: &Shown) -> impl Iterator<Item = BufferName> {
    let mesh = shown.mesh.iter().flat_map(|mesh| mesh.buffers.keys());
    let directions = shown
        .directions
        .iter()
        .map(|directions| &directions.outward);
    let fields = shown.fields.iter().map(|field| &field.values);
    mesh.chain(directions).chain(fields).copied()
}
