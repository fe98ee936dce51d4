//! The system's allocator with large pages for large pieces of memory.
//!
//! The first touch of a page is a trip to the kernel. With pages of 4 KiB that
//! takes some ten times as long as the writing itself, and a mesh's buffers are
//! mostly written once; with pages of 2 MiB there are five hundred times fewer
//! trips. Linux gives them to whoever asks ("madvise" is its default), other
//! systems are left to their own ways.
#![allow(unsafe_code, reason = "an allocator cannot be written without it")]

use std::alloc::{GlobalAlloc, Layout, System};

/// A large page, in bytes.
const PAGE: usize = 2 << 20;

/// Pieces from this size on are worth asking for: at least one whole large page
/// lies in them, wherever they start.
const LARGE: usize = 2 * PAGE;

/// The system's allocator, which asks for large pages inside pieces of 4 MiB
/// and more.
///
/// Memory that is handed out is the same as the system's, only touched faster.
/// No more of it is taken: a large page never reaches beyond its piece.
#[derive(Debug, Clone, Copy, Default)]
pub struct LargePages;

// SAFETY: every call goes to `System` with the arguments unchanged, and its
// pointers are given back as they are; advice changes no content.
unsafe impl GlobalAlloc for LargePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller of this function promises.
        advised(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller of this function promises.
        advised(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as the caller of this function promises.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller of this function promises.
        advised(unsafe { System.realloc(pointer, layout, size) }, size)
    }
}

/// Asks for large pages where whole ones lie in the piece, and passes it on.
fn advised(pointer: *mut u8, size: usize) -> *mut u8 {
    if size >= LARGE && !pointer.is_null() {
        advise(pointer, size);
    }
    pointer
}

#[cfg(target_os = "linux")]
fn advise(pointer: *mut u8, size: usize) {
    let skipped = pointer.addr().next_multiple_of(PAGE) - pointer.addr();
    let whole = (size - skipped) / PAGE * PAGE;
    // SAFETY: the range lies inside the piece just allocated, whose bytes the
    // call neither reads nor writes. A refusal leaves everything as it was.
    unsafe { libc::madvise(pointer.add(skipped).cast(), whole, libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn advise(_: *mut u8, _: usize) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[global_allocator]
    static PAGES: LargePages = LargePages;

    #[test]
    fn pieces_hold_what_was_written() {
        for size in [1, LARGE - 1, LARGE, LARGE + 4097, 5 * PAGE + 3] {
            let mut bytes = vec![0u8; size];
            assert!(bytes.iter().all(|&byte| byte == 0), "{size}");
            bytes
                .iter_mut()
                .zip(0..)
                .for_each(|(byte, k)| *byte = k as u8);
            bytes.resize(size + LARGE, 7);
            let (old, new) = bytes.split_at(size);
            assert!(
                old.iter()
                    .zip(0..)
                    .all(|(&byte, k): (_, usize)| byte == k as u8)
            );
            assert!(new.iter().all(|&byte| byte == 7), "{size}");
        }
    }
}
