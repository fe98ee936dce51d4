//! Large pieces of memory straight from the kernel (Linux).
#![allow(unsafe_code, reason = "an allocator cannot be written without it")]

use std::ptr::null_mut;
use std::sync::{Mutex, PoisonError};

use crate::PAGE;
use crate::kept::{Kept, Range};

/// What is kept, and how much may be.
struct Pool {
    kept: Kept,
    most: usize,
}

static POOL: Mutex<Pool> = Mutex::new(Pool {
    kept: Kept::new(),
    most: 0,
});

/// A piece and whether its bytes are known to be zero.
pub(crate) struct Piece {
    pub(crate) start: *mut u8,
    pub(crate) is_zero: bool,
}

/// The address range that a piece of `size` bytes takes: whole large pages, of
/// which the last is touched as far as it is used.
pub(crate) fn reserved(size: usize) -> usize {
    size.next_multiple_of(PAGE)
}

/// Sets how many bytes may be kept, and gives back those that are too many.
pub(crate) fn keep_at_most(bytes: usize) {
    with(|pool| {
        pool.most = bytes;
        let surplus = pool.kept.total().saturating_sub(bytes);
        give_back_of(&mut pool.kept, surplus);
    });
}

/// Gives back all that is kept.
pub(crate) fn give_back_kept() {
    with(|pool| give_back_of(&mut pool.kept, usize::MAX));
}

/// A piece of at least `size` bytes, null if there is none to be had.
///
/// One that was kept, if it fits. Otherwise as many bytes of those kept are
/// given back as are asked for: pages held never exceed the most that was ever
/// in use at once.
pub(crate) fn take(size: usize) -> Piece {
    let len = reserved(size);
    let kept = with(|pool| {
        let kept = pool.kept.take(len);
        if kept.is_none() {
            give_back_of(&mut pool.kept, len);
        }
        kept
    });
    let start = kept.map_or_else(
        || map_or_make_room(len),
        std::ptr::with_exposed_provenance_mut,
    );
    if !start.is_null() {
        advise(start, size);
    }
    Piece {
        start,
        is_zero: kept.is_none(),
    }
}

/// Frees `len` bytes from `start` on, whole large pages.
///
/// # Safety
/// They are all or a part of a piece that [`take`] gave, and nobody uses them.
pub(crate) unsafe fn free(start: *mut u8, len: usize) {
    if len == 0 {
        return;
    }
    let range = Range {
        start: start.expose_provenance(),
        len,
    };
    let is_kept = with(|pool| pool.kept.total() + range.len <= pool.most && pool.kept.put(range));
    if !is_kept {
        give_back(range);
    }
}

/// Bytes that are kept now.
#[cfg(test)]
pub(crate) fn kept() -> usize {
    with(|pool| pool.kept.total())
}

/// Nothing in here allocates or panics, so that the lock is never poisoned.
fn with<T>(work: impl FnOnce(&mut Pool) -> T) -> T {
    work(&mut POOL.lock().unwrap_or_else(PoisonError::into_inner))
}

fn give_back_of(kept: &mut Kept, mut len: usize) {
    while len > 0
        && let Some(range) = kept.take_some(len)
    {
        give_back(range);
        len -= range.len;
    }
}

fn give_back(range: Range) {
    // SAFETY: the range was mapped by `map`, and is neither in use nor kept.
    unsafe {
        libc::munmap(
            std::ptr::with_exposed_provenance_mut(range.start),
            range.len,
        )
    };
}

/// Fresh pages, for which all that is kept is given back if there are no others.
fn map_or_make_room(len: usize) -> *mut u8 {
    let start = map(len);
    if !start.is_null() {
        return start;
    }
    give_back_kept();
    map(len)
}

/// Fresh pages, aligned to large ones, of zeros.
fn map(len: usize) -> *mut u8 {
    let Some(wider) = len.checked_add(PAGE) else {
        return null_mut();
    };
    let (protection, flags) = (
        libc::PROT_READ | libc::PROT_WRITE,
        libc::MAP_PRIVATE | libc::MAP_ANONYMOUS,
    );
    // SAFETY: a new mapping where the kernel likes touches no other memory.
    let pointer = unsafe { libc::mmap(null_mut(), wider, protection, flags, -1, 0) };
    if pointer == libc::MAP_FAILED {
        return null_mut();
    }
    let (start, end) = (
        pointer.expose_provenance(),
        pointer.expose_provenance() + wider,
    );
    let aligned = start.next_multiple_of(PAGE);
    for (start, end) in [(start, aligned), (aligned + len, end)] {
        if end > start {
            give_back(Range {
                start,
                len: end - start,
            });
        }
    }
    std::ptr::with_exposed_provenance_mut(aligned)
}

/// Asks for large pages where whole ones lie in the piece.
fn advise(start: *mut u8, size: usize) {
    let whole = size / PAGE * PAGE;
    // SAFETY: the range lies inside the piece, whose bytes the call neither
    // reads nor writes. A refusal leaves everything as it was.
    unsafe { libc::madvise(start.cast(), whole, libc::MADV_HUGEPAGE) };
}
