//! The system's allocator, but large pieces of memory come in large pages and
//! are kept for the next.
//!
//! The first touch of a page is a trip to the kernel, which clears it. With
//! pages of 4 KiB that takes some ten times as long as the writing itself, and
//! a mesh's buffers are mostly written once; with pages of 2 MiB there are five
//! hundred times fewer trips, and with pages that were used before none. Linux
//! gives large pages to whoever asks ("madvise" is its default), other systems
//! are left to their own ways.
#![allow(unsafe_code, reason = "an allocator cannot be written without it")]

#[cfg(any(target_os = "linux", test))]
mod kept;
#[cfg(target_os = "linux")]
mod pieces;

use std::alloc::{GlobalAlloc, Layout, System};

/// A large page, in bytes.
#[cfg(target_os = "linux")]
const PAGE: usize = 2 << 20;

/// The system's allocator, except for pieces of 4 MiB and more on Linux: those
/// are whole large pages, and when they are freed up to [`keep_at_most`] bytes
/// of them are kept for pieces to come.
///
/// The pages held never exceed the most that was in use at once: before a piece
/// is taken from the system that what is kept has no room for, as much of that
/// is given back. A large page never reaches beyond its piece.
#[derive(Debug, Clone, Copy, Default)]
pub struct LargePages;

/// Sets how many bytes of freed memory [`LargePages`] keeps for the pieces to
/// come, 0 at first; what is kept beyond is given back to the system.
///
/// ```
/// tessgraph_pages::keep_at_most(1 << 30);
/// ```
pub fn keep_at_most(bytes: usize) {
    #[cfg(target_os = "linux")]
    pieces::keep_at_most(bytes);
    #[cfg(not(target_os = "linux"))]
    let _ = bytes;
}

/// Gives the freed memory that [`LargePages`] has kept back to the system: to be
/// called when nothing will be made for a while. It goes on keeping what is freed
/// from now on.
pub fn give_back() {
    #[cfg(target_os = "linux")]
    pieces::give_back_kept();
}

#[cfg(target_os = "linux")]
mod large {
    use super::{GlobalAlloc, LargePages, Layout, PAGE, System, pieces};

    /// Pieces from this size on are ours; two whole pages lie in them.
    pub(super) const LARGE: usize = 2 * PAGE;

    fn is_large(layout: Layout) -> bool {
        layout.size() >= LARGE && layout.align() <= PAGE
    }

    // SAFETY: a small piece is the system's in every call, by its layout alone;
    // a large one is a range of pages that `pieces` gives to one owner at a time,
    // at least as long as its layout and aligned to a page of 2 MiB.
    unsafe impl GlobalAlloc for LargePages {
        unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
            if is_large(layout) {
                return pieces::take(layout.size()).start;
            }
            // SAFETY: as the caller of this function promises.
            unsafe { System.alloc(layout) }
        }

        unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
            if !is_large(layout) {
                // SAFETY: as the caller of this function promises.
                return unsafe { System.alloc_zeroed(layout) };
            }
            let piece = pieces::take(layout.size());
            if !piece.is_zero {
                // SAFETY: the piece has that many bytes, and an owner: us.
                unsafe { piece.start.write_bytes(0, layout.size()) };
            }
            piece.start
        }

        unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
            if is_large(layout) {
                // SAFETY: `alloc` took as much for this layout, and the caller
                // gives it up.
                return unsafe { pieces::free(pointer, pieces::reserved(layout.size())) };
            }
            // SAFETY: as the caller of this function promises.
            unsafe { System.dealloc(pointer, layout) }
        }

        unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
            // SAFETY: the caller promises that the size is one a layout can have.
            let new = unsafe { Layout::from_size_align_unchecked(size, layout.align()) };
            match (is_large(layout), is_large(new)) {
                // SAFETY: as the caller of this function promises.
                (false, false) => unsafe { System.realloc(pointer, layout, size) },
                (true, true) if pieces::reserved(size) <= pieces::reserved(layout.size()) => {
                    let (had, needed) = (pieces::reserved(layout.size()), pieces::reserved(size));
                    // SAFETY: the end of the piece, which the caller gives up.
                    unsafe { pieces::free(pointer.add(needed), had - needed) };
                    pointer
                }
                _ => {
                    // SAFETY: the new piece is another one, and as many bytes are
                    // copied as both have; the old one is given up by the caller.
                    unsafe {
                        let moved = self.alloc(new);
                        if !moved.is_null() {
                            moved.copy_from_nonoverlapping(pointer, size.min(layout.size()));
                            self.dealloc(pointer, layout);
                        }
                        moved
                    }
                }
            }
        }
    }
}

// SAFETY: every call goes to `System` with the arguments unchanged.
#[cfg(not(target_os = "linux"))]
unsafe impl GlobalAlloc for LargePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller of this function promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller of this function promises.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as the caller of this function promises.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller of this function promises.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::large::LARGE;
    use super::*;

    #[global_allocator]
    static PAGES: LargePages = LargePages;

    /// One thread's work: pieces of many sizes, grown, shrunk, dropped in another
    /// order than they were made, each filled with a number of its own.
    fn work(seed: u8) {
        let sizes = [1, LARGE - 1, LARGE, LARGE + 4097, 5 * PAGE + 3, 9 * PAGE];
        let mut held: Vec<(u8, Vec<u8>)> = Vec::new();
        for round in 0..60u8 {
            let mark = seed.wrapping_add(round);
            let size = sizes[usize::from(round) % sizes.len()];
            let mut bytes = vec![0u8; size];
            assert!(bytes.iter().all(|&byte| byte == 0), "{size}");
            bytes.fill(mark);
            match round % 4 {
                0 => bytes.resize(size + LARGE, mark),
                1 => {
                    bytes.truncate(size / 2);
                    bytes.shrink_to_fit();
                }
                _ => {}
            }
            held.push((mark, bytes));
            if held.len() > 5 {
                let (mark, bytes) = held.swap_remove(usize::from(round) % held.len());
                assert!(bytes.iter().all(|&byte| byte == mark));
            }
        }
        for (mark, bytes) in held {
            assert!(bytes.iter().all(|&byte| byte == mark));
        }
    }

    #[test]
    fn pieces_hold_what_was_written() {
        for most in [0, 3 * LARGE, usize::MAX] {
            keep_at_most(most);
            std::thread::scope(|scope| {
                for seed in [0, 85, 170] {
                    scope.spawn(move || work(seed));
                }
            });
        }
        keep_at_most(0);
        keep_at_most(usize::MAX);
        let first = vec![1u8; 20 * PAGE];
        let place = first.as_ptr();
        drop(first);
        let second = vec![2u8; 20 * PAGE];
        assert_eq!(second.as_ptr(), place, "the same pages again");
        drop(second);
        assert_eq!(pieces::kept(), 20 * PAGE);
        give_back();
        assert_eq!(pieces::kept(), 0);
        drop(vec![2u8; 20 * PAGE]);
        assert_eq!(pieces::kept(), 20 * PAGE, "it goes on keeping");
        // What has no room in what is kept takes the place of as much of it: never
        // more is held than was in use at once.
        let third = vec![3u8; 15 * PAGE];
        let fourth = vec![4u8; 12 * PAGE];
        assert_eq!(pieces::kept(), 0, "12 pages replace the 5 that were left");
        drop((third, fourth));
        keep_at_most(0);
        assert!(vec![0u8; 20 * PAGE].iter().all(|&byte| byte == 0));
    }
}
