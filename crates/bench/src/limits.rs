//! What the machine needs for memory traffic alone.

use std::hint::black_box;

/// Eight bytes at a time, as f64 arrays are written.
type Word = u64;

/// Writes `bytes` bytes one after the other into memory that was used before.
pub fn streaming_write(bytes: usize) -> impl FnMut() {
    let mut memory: Vec<Word> = vec![1; bytes.div_ceil(size_of::<Word>())];
    let mut value = 0;
    move || {
        value += 1;
        memory.fill(value);
        black_box(&mut memory);
    }
}

/// Writes `bytes` bytes into pages the process has not touched before.
pub fn first_touch(bytes: usize) -> impl FnMut() -> Vec<Word> {
    move || {
        let mut memory: Vec<Word> = vec![0; bytes.div_ceil(size_of::<Word>())];
        memory.fill(1);
        memory
    }
}

/// Reads `bytes` bytes and writes as many, into memory that was used before.
pub fn copy(bytes: usize) -> impl FnMut() {
    let from: Vec<Word> = vec![1; bytes.div_ceil(size_of::<Word>())];
    let mut to = from.clone();
    move || {
        to.copy_from_slice(black_box(&from));
        black_box(&mut to);
    }
}
