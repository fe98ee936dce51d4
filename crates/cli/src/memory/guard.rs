//! An allocator that keeps the process within its memory limit.
#![allow(unsafe_code, reason = "an allocator cannot be written without it")]

use std::alloc::{GlobalAlloc, Layout};
use std::cell::Cell;
use std::io::Write as _;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use tessgraph_pages::LargePages;

use super::{TOO_LARGE, meter};
use crate::commands::FAILED;
use crate::interrupt;
use crate::watch::begin_anew;

/// Only pieces of this size or more are counted: a mesh's buffers, not names.
pub(super) const LARGE: usize = 64 << 10;

/// Bytes that large pieces may take together.
static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);

/// Bytes that large pieces take now.
static LIVE: AtomicUsize = AtomicUsize::new(0);

/// The system's allocator with large pages and a limit.
///
/// What would pass the limit, or what the system refuses, ends the process in
/// order: a message with the number of bytes and the nodes at work, temporary
/// files removed, exit status 1; a program that watches a graph begins anew
/// instead. Without it the process would be aborted, or
/// killed after it had slowed the machine down.
#[derive(Debug)]
pub struct MemoryGuard;

thread_local! {
    /// Whether this thread is ending the process: then nothing stops it any more.
    static LEAVING: Cell<bool> = const { Cell::new(false) };
}

/// Freed memory that is kept for the next pieces: the buffers of a model of some
/// ten million vertices, which an edit makes anew while the old ones are shown.
const KEPT: usize = 1 << 30;

/// Sets the limit in bytes.
pub(crate) fn set_limit(bytes: u64) {
    let limit = usize::try_from(bytes).unwrap_or(usize::MAX);
    LIMIT.store(limit, Ordering::Relaxed);
    tessgraph_pages::keep_at_most(KEPT.min(limit / 4));
}

/// The limit in bytes.
pub(crate) fn limit() -> u64 {
    LIMIT.load(Ordering::Relaxed) as u64
}

/// Bytes that large pieces may still take; `None` before a limit is set.
pub(crate) fn left() -> Option<u64> {
    match LIMIT.load(Ordering::Relaxed) {
        usize::MAX => None,
        limit => Some(limit.saturating_sub(LIVE.load(Ordering::Relaxed)) as u64),
    }
}

/// The part of a piece's size that counts.
fn counted(size: usize) -> usize {
    if size < LARGE { 0 } else { size }
}

/// Counts a piece of `new` bytes that takes the place of one of `old`.
fn exchange(old: usize, new: usize) {
    let (old, new) = (counted(old), counted(new));
    meter::exchange(old, new);
    if new <= old {
        if old > 0 {
            LIVE.fetch_sub(old - new, Ordering::Relaxed);
        }
        return;
    }
    let more = new - old;
    let before = LIVE.fetch_add(more, Ordering::Relaxed);
    let limit = LIMIT.load(Ordering::Relaxed);
    if before.saturating_add(more) > limit && !LEAVING.get() {
        refuse(more, before, Some(limit));
    }
}

/// Passes a pointer on, unless the system had no memory.
fn checked(pointer: *mut u8, size: usize) -> *mut u8 {
    if pointer.is_null() && !LEAVING.get() {
        refuse(size, LIVE.load(Ordering::Relaxed), None);
    }
    pointer
}

// SAFETY: every call goes to `LargePages` with the arguments unchanged; what is
// added counts bytes and may end the process, but never unwinds and never
// touches the memory.
unsafe impl GlobalAlloc for MemoryGuard {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        exchange(0, layout.size());
        // SAFETY: as the caller of this function promises.
        checked(unsafe { LargePages.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        exchange(0, layout.size());
        // SAFETY: as the caller of this function promises.
        checked(unsafe { LargePages.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        exchange(layout.size(), 0);
        // SAFETY: as the caller of this function promises.
        unsafe { LargePages.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        exchange(layout.size(), size);
        // SAFETY: as the caller of this function promises.
        checked(unsafe { LargePages.realloc(pointer, layout, size) }, size)
    }
}

/// Ends the process because `more` bytes cannot be had. Needs no memory itself.
fn refuse(more: usize, live: usize, limit: Option<usize>) -> ! {
    static ONCE: AtomicBool = AtomicBool::new(false);
    LEAVING.set(true);
    while ONCE.swap(true, Ordering::Relaxed) {
        // Another thread is about to end the process.
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    let mega = |bytes: usize| bytes.div_ceil(1_000_000);
    let mut err = std::io::stderr().lock();
    // Without stderr there is nowhere left to complain to.
    let _ = write!(
        err,
        "error[out_of_memory]: {} MB more are needed",
        mega(more)
    );
    crate::progress::with_running(|names| {
        for (index, name) in names.iter().enumerate() {
            let before = if index == 0 { " by" } else { "," };
            let _ = write!(err, "{before} `{name}`");
        }
    });
    let _ = write!(err, ", {} MB are in use, and ", mega(live));
    let _ = match limit {
        Some(limit) => writeln!(err, "the limit is {} MB", mega(limit)),
        None => writeln!(err, "the system has no more"),
    };
    let _ = writeln!(err, " = help: {TOO_LARGE}");
    drop(err);
    interrupt::remove_temporaries();
    begin_anew();
    interrupt::leave(FAILED)
}
