//! Raw buffers by name: what the 3D view draws, each made once.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use bytemuck::NoUninit;
use tessgraph_geometry::digest::{Digest, Hasher};

use crate::protocol::BufferName;

/// Makes a buffer, once.
type Make = Box<dyn FnOnce() -> Bytes + Send>;

/// The buffers of the last messages.
///
/// Those that the latest message names are kept, and of older ones as many as
/// fit into the budget, for a page that is still fetching them or a value that
/// comes back.
pub struct Buffers {
    budget: usize,
    store: Mutex<Store>,
}

#[derive(Default)]
struct Store {
    blobs: BTreeMap<Digest, Blob>,
    /// Buffers named by what they were made from, where content names them.
    made: BTreeMap<Digest, Digest>,
    /// How many messages there were.
    clock: u64,
}

struct Blob {
    content: Arc<Content>,
    bytes: usize,
    /// The message that named it last.
    used: u64,
}

/// A buffer's bytes, or the way to them.
struct Content {
    state: Mutex<State>,
    /// Rings when the state is another.
    bell: Condvar,
}

enum State {
    Made(Bytes),
    Awaited(Make),
    /// A thread is making it.
    AtWork,
    /// Making it panicked.
    Lost,
}

impl Content {
    fn new(state: State) -> Arc<Self> {
        Arc::new(Self {
            state: Mutex::new(state),
            bell: Condvar::new(),
        })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The bytes, made now unless they were before; waits for a thread that is
    /// making them. Not for threads of a pool: what is waited for may need them.
    fn wait(&self) -> Option<Bytes> {
        self.make();
        let at_work = |state: &mut State| matches!(state, State::AtWork);
        let state = self.bell.wait_while(self.state(), at_work);
        match &*state.unwrap_or_else(PoisonError::into_inner) {
            State::Made(bytes) => Some(bytes.clone()),
            _ => None,
        }
    }

    /// Makes the bytes, unless that was done or a thread is at it.
    fn make(&self) {
        let mut state = self.state();
        let State::Awaited(_) = &*state else {
            return;
        };
        let State::Awaited(make) = std::mem::replace(&mut *state, State::AtWork) else {
            return;
        };
        // Not under the lock: making it may take a while, or the thread pool.
        drop(state);
        let mut outcome = Outcome {
            content: self,
            state: State::Lost,
        };
        outcome.state = State::Made(make());
    }
}

/// What making a buffer came to; told when this is dropped, by a panic too.
struct Outcome<'a> {
    content: &'a Content,
    state: State,
}

impl Drop for Outcome<'_> {
    fn drop(&mut self) {
        *self.content.state() = std::mem::replace(&mut self.state, State::Lost);
        self.content.bell.notify_all();
    }
}

/// Owns an array of numbers as bytes, without copying it.
struct Owned<T>(Vec<T>);

impl<T: NoUninit> AsRef<[u8]> for Owned<T> {
    fn as_ref(&self) -> &[u8] {
        bytemuck::cast_slice(&self.0)
    }
}

/// Numbers as bytes; they must be little-endian already.
pub(crate) fn bytes<T: NoUninit + Send + Sync>(numbers: Vec<T>) -> Bytes {
    Bytes::from_owner(Owned(numbers))
}

impl Buffers {
    /// A store that keeps up to `budget` bytes of buffers nobody names any more.
    pub fn new(budget: usize) -> Self {
        let store = Mutex::default();
        Self { budget, store }
    }

    /// The buffer of that name, made now if it was not before. Not for threads of
    /// a pool: it may wait for one of them.
    pub(crate) fn get(&self, name: Digest) -> Option<Bytes> {
        self.content(name)?.wait()
    }

    /// Has the thread pool make the buffer of that name, before anybody asks.
    pub(crate) fn prepare(&self, name: BufferName) {
        if let Some(content) = self.content(name.0) {
            rayon::spawn(move || content.make());
        }
    }

    /// Whether the buffer of that name is there and was made.
    pub(crate) fn is_made(&self, name: BufferName) -> bool {
        let content = self.content(name.0);
        content.is_some_and(|content| matches!(&*content.state(), State::Made(_)))
    }

    fn content(&self, name: Digest) -> Option<Arc<Content>> {
        Some(Arc::clone(&self.store().blobs.get(&name)?.content))
    }

    /// A finished picture, named by its content.
    pub fn picture(&self, bytes: Vec<u8>) -> BufferName {
        let source = source("picture", &[Digest::of(&bytes)]).finish();
        self.made(source, || bytes.into()).0
    }

    /// A buffer that is made from what `source` is the digest of, named by its
    /// own content: equal ones have one name, whatever they were made from.
    pub(crate) fn made(&self, source: Digest, make: impl FnOnce() -> Bytes) -> (BufferName, usize) {
        if let Some(found) = self.touch_made(source) {
            return found;
        }
        let (name, length) = self.given(make());
        self.store().made.insert(source, name.0);
        (name, length)
    }

    /// A buffer that is there, named by its content.
    pub(crate) fn given(&self, content: Bytes) -> (BufferName, usize) {
        let (name, length) = (Digest::of(&content), content.len());
        self.store().keep(name, length, || State::Made(content));
        (BufferName(name), length)
    }

    /// A buffer of `length` bytes that is made when somebody asks for it, named
    /// by what it is made from.
    pub(crate) fn awaited(
        &self,
        source: Digest,
        length: usize,
        make: impl FnOnce() -> Bytes + Send + 'static,
    ) -> BufferName {
        self.store()
            .keep(source, length, || State::Awaited(Box::new(make)));
        BufferName(source)
    }

    /// A message was sent that names `named`; lets older buffers go.
    pub(crate) fn sent(&self, named: &BTreeSet<BufferName>) {
        let mut store = self.store();
        store.clock += 1;
        let clock = store.clock;
        for name in named {
            if let Some(blob) = store.blobs.get_mut(&name.0) {
                blob.used = clock;
            }
        }
        store.keep_older(self.budget);
    }

    /// Lets go of all buffers that the latest message does not name.
    pub fn let_go(&self) {
        self.store().keep_older(0);
    }

    /// Bytes of all buffers that are there or may be asked for.
    pub fn total(&self) -> usize {
        self.store().blobs.values().map(|blob| blob.bytes).sum()
    }

    fn touch_made(&self, source: Digest) -> Option<(BufferName, usize)> {
        let store = self.store();
        let name = *store.made.get(&source)?;
        Some((BufferName(name), store.blobs.get(&name)?.bytes))
    }

    fn store(&self) -> MutexGuard<'_, Store> {
        self.store.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Store {
    /// Keeps the latest of the buffers that the last message did not name, as many as
    /// fit into so many bytes.
    fn keep_older(&mut self, budget: usize) {
        let Self { blobs, made, clock } = self;
        let older = blobs.iter().filter(|(_, blob)| blob.used < *clock);
        let older = older.map(|(name, blob)| (blob.used, *name, blob.bytes));
        let mut older: Vec<(u64, Digest, usize)> = older.collect();
        older.sort_by(|one, other| other.cmp(one));
        let mut kept = 0;
        for (_, name, bytes) in older {
            kept += bytes;
            if kept > budget {
                blobs.remove(&name);
            }
        }
        made.retain(|_, name| blobs.contains_key(name));
    }

    fn keep(&mut self, name: Digest, bytes: usize, state: impl FnOnce() -> State) {
        // One more than the last message: not to be let go before the next.
        let used = self.clock + 1;
        let blob = self.blobs.entry(name).or_insert_with(|| Blob {
            content: Content::new(state()),
            bytes,
            used,
        });
        blob.used = used;
    }
}

/// What a buffer is made from: its kind, and the digests of its sources.
pub(crate) fn source(kind: &str, from: &[Digest]) -> Hasher {
    let mut hasher = Hasher::new();
    hasher.text("view").text(kind);
    from.iter().for_each(|digest| {
        hasher.digest(*digest);
    });
    hasher
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(names: &[BufferName]) -> BTreeSet<BufferName> {
        names.iter().copied().collect()
    }

    #[test]
    fn old_buffers_go_when_the_budget_is_full_and_named_ones_stay() {
        let buffers = Buffers::new(8);
        let make = |number: u32| {
            let source = source("test", &[Digest::of(&number.to_le_bytes())]).finish();
            let (name, length) = buffers.made(source, || bytes(vec![number, number]));
            assert_eq!(length, 8);
            buffers.sent(&named(&[name]));
            name
        };
        let names: Vec<BufferName> = (0..4).map(make).collect();
        assert_eq!(buffers.total(), 16);
        assert!(buffers.get(names[0].0).is_none() && buffers.get(names[1].0).is_none());
        assert_eq!(&buffers.get(names[2].0).unwrap()[..4], &2u32.to_le_bytes());
        assert_eq!(buffers.get(names[3].0).unwrap().len(), 8);
        assert_eq!(buffers.total(), 16);
        // A buffer that comes back is kept again without being made again.
        let source = source("test", &[Digest::of(&2u32.to_le_bytes())]).finish();
        let (back, _) = buffers.made(source, || panic!("it is there"));
        assert_eq!(back, names[2]);
        buffers.sent(&named(&[back]));
        buffers.let_go();
        assert_eq!(buffers.total(), 8, "only what is named");
        assert!(buffers.get(back.0).is_some());
    }

    #[test]
    fn awaited_buffers_are_made_once() {
        use std::sync::atomic::{AtomicUsize, Ordering};
        let count = Arc::new(AtomicUsize::new(0));
        let buffers = Buffers::new(0);
        let counted = Arc::clone(&count);
        let name = buffers.awaited(Digest::of(b"x"), 4, move || {
            counted.fetch_add(1, Ordering::Relaxed);
            bytes(vec![7u32])
        });
        buffers.sent(&named(&[name]));
        assert_eq!(count.load(Ordering::Relaxed), 0);
        assert!(!buffers.is_made(name));
        assert_eq!(&buffers.get(name.0).unwrap()[..], &7u32.to_le_bytes());
        assert!(buffers.get(name.0).is_some() && buffers.is_made(name));
        assert_eq!(count.load(Ordering::Relaxed), 1);
        buffers.sent(&named(&[]));
        assert!(buffers.get(name.0).is_none());
    }

    #[test]
    fn who_asks_while_a_buffer_is_made_waits_for_it() {
        let buffers = Buffers::new(0);
        let (begun, begins) = std::sync::mpsc::channel();
        let (go, gone) = std::sync::mpsc::channel();
        let name = buffers.awaited(Digest::of(b"x"), 4, move || {
            begun.send(()).unwrap();
            gone.recv().unwrap();
            bytes(vec![7u32])
        });
        buffers.prepare(name);
        begins.recv().unwrap();
        std::thread::scope(|scope| {
            let asking: Vec<_> = (0..3)
                .map(|_| scope.spawn(|| buffers.get(name.0)))
                .collect();
            go.send(()).unwrap();
            for asked in asking {
                assert_eq!(&asked.join().unwrap().unwrap()[..], &7u32.to_le_bytes());
            }
        });
    }

    #[test]
    fn a_buffer_that_cannot_be_made_keeps_nobody_waiting() {
        let buffers = Buffers::new(0);
        let name = buffers.awaited(Digest::of(b"x"), 4, || panic!("as the test wants it"));
        let making = std::thread::scope(|scope| scope.spawn(|| buffers.get(name.0)).join());
        assert!(making.is_err());
        assert!(buffers.get(name.0).is_none());
    }
}
