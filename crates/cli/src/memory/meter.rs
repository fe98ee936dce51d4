//! The most memory that was held while something ran.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicIsize, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::guard::LARGE;

thread_local! {
    /// Whether what this thread takes is counted.
    static COUNTED: Cell<bool> = const { Cell::new(false) };
}

/// Bytes of large pieces that counted threads took, less those they freed.
static HELD: AtomicIsize = AtomicIsize::new(0);

/// The most that was held since this was last looked at.
static PEAK: AtomicIsize = AtomicIsize::new(0);

/// Whether the allocator reports anything at all: in a program that does not
/// use [`super::MemoryGuard`] nothing can be said.
static IN_CHARGE: AtomicBool = AtomicBool::new(false);

/// The spans that are open.
static OPEN: Mutex<Vec<Open>> = Mutex::new(Vec::new());

struct Open {
    number: u64,
    /// What was held when it began.
    base: isize,
    peak: isize,
}

/// Counts what this thread takes from now on: to be called by the threads that
/// compute, so that whatever else goes on in the process is no node's.
pub(crate) fn count_this_thread() {
    COUNTED.set(true);
}

/// Told by the allocator that a piece of `new` bytes took the place of one of
/// `old`; 0 for pieces that are too small to count.
pub(super) fn exchange(old: usize, new: usize) {
    if old == new || !COUNTED.get() {
        return;
    }
    IN_CHARGE.store(true, Ordering::Relaxed);
    // No piece is larger than `isize::MAX`.
    let more = new as isize - old as isize;
    let held = HELD.fetch_add(more, Ordering::Relaxed) + more;
    if more > 0 {
        PEAK.fetch_max(held, Ordering::Relaxed);
    }
}

/// A stretch of time over which memory is measured.
///
/// Measured is the most that all counted threads held at once beyond what they
/// held when it began. Of spans that overlap, each includes what was taken for
/// the others.
pub(crate) struct Span(u64);

impl Span {
    /// Begins one.
    pub(crate) fn begin() -> Self {
        static SERIAL: AtomicU64 = AtomicU64::new(0);
        let number = SERIAL.fetch_add(1, Ordering::Relaxed);
        let mut open = folded();
        let base = HELD.load(Ordering::Relaxed);
        open.push(Open {
            number,
            base,
            peak: base,
        });
        Self(number)
    }

    /// Ends it: the bytes, in pieces of 64 KiB or more. `None` where the program
    /// does not use [`super::MemoryGuard`].
    pub(crate) fn end(self) -> Option<u64> {
        let mut open = folded();
        let place = open.iter().position(|span| span.number == self.0)?;
        let span = open.swap_remove(place);
        drop(open);
        is_in_charge().then(|| (span.peak - span.base).unsigned_abs() as u64)
    }
}

/// The open spans, each with the peak up to now.
fn folded() -> MutexGuard<'static, Vec<Open>> {
    let mut open = OPEN.lock().unwrap_or_else(PoisonError::into_inner);
    let peak = PEAK.swap(HELD.load(Ordering::Relaxed), Ordering::Relaxed);
    // Something may have been taken between the two.
    PEAK.fetch_max(HELD.load(Ordering::Relaxed), Ordering::Relaxed);
    for span in open.iter_mut() {
        span.peak = span.peak.max(peak);
    }
    open
}

/// Whether the allocator reports to this module, tried with a large piece.
fn is_in_charge() -> bool {
    if !IN_CHARGE.load(Ordering::Relaxed) {
        let before = COUNTED.replace(true);
        drop(std::hint::black_box(Vec::<u8>::with_capacity(LARGE)));
        COUNTED.set(before);
    }
    IN_CHARGE.load(Ordering::Relaxed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tests' allocator does not report, so they do it in its place; one
    /// test, since what is held is known to the whole process.
    #[test]
    fn spans_see_the_most_that_was_held_beyond_their_beginning() {
        assert_eq!(Span::begin().end(), None, "nothing reports here");
        exchange(0, 500);
        assert_eq!(
            HELD.load(Ordering::Relaxed),
            0,
            "this thread is not counted"
        );
        count_this_thread();
        exchange(0, 1000);
        let outer = Span::begin();
        exchange(0, 300);
        exchange(300, 0);
        let inner = Span::begin();
        exchange(0, 200);
        exchange(200, 250);
        exchange(250, 0);
        exchange(1000, 0);
        assert_eq!(inner.end(), Some(250));
        exchange(0, 1200);
        assert_eq!(outer.end(), Some(300));
        exchange(1200, 0);
        let quiet = Span::begin();
        assert_eq!(quiet.end(), Some(0));
        COUNTED.set(false);
    }
}
