//! What was found out about contents, by their digests.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use tessgraph_geometry::digest::Digest;

/// Contents that are remembered: with more, all are forgotten.
const MOST: usize = 4096;

/// Remembers a small fact of each content that was looked at.
#[derive(Debug)]
pub(super) struct Memo<T> {
    known: Mutex<BTreeMap<Digest, T>>,
}

impl<T> Default for Memo<T> {
    fn default() -> Self {
        let known = Mutex::default();
        Self { known }
    }
}

impl<T: Copy> Memo<T> {
    /// The fact about `content`; `find` says it if it is not known. Not under the
    /// lock: finding out may use the thread pool.
    pub(super) fn get(&self, content: Digest, find: impl FnOnce() -> Option<T>) -> Option<T> {
        let known = self.look(content);
        if known.is_some() {
            return known;
        }
        let found = find()?;
        self.put(content, found);
        Some(found)
    }

    /// The fact about `content`, if it is known.
    pub(super) fn look(&self, content: Digest) -> Option<T> {
        self.known().get(&content).copied()
    }

    /// Remembers another fact about `content`.
    pub(super) fn put(&self, content: Digest, fact: T) {
        let mut known = self.known();
        if known.len() >= MOST {
            known.clear();
        }
        known.insert(content, fact);
    }

    fn known(&self) -> MutexGuard<'_, BTreeMap<Digest, T>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_is_not_found_out_again() {
        let memo = Memo::default();
        let content = Digest::of(b"x");
        assert_eq!(memo.get(content, || None), None);
        assert_eq!(memo.get(content, || Some(1)), Some(1));
        assert_eq!(memo.get(content, || panic!("it is known")), Some(1));
        for number in 0..=MOST as u64 {
            memo.get(Digest::of(&number.to_le_bytes()), || Some(2));
        }
        assert_eq!(memo.get(content, || Some(3)), Some(3), "forgotten at last");
    }
}
