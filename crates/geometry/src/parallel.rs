//! Parallel loops that give the same bytes for any number of threads.
//!
//! Work is cut into chunks of a fixed size, never by thread count, and every
//! element is computed from its index alone. Reductions add up per chunk and
//! then over the chunks in order.

use std::sync::atomic::{AtomicU64, Ordering};

use bytemuck::Zeroable;
use rayon::prelude::*;

use crate::{GeometryError, Monitor};

/// Elements per chunk: some 100 µs of typical work, small enough to cancel fast.
pub const CHUNK: usize = 4096;

/// `f(i)` for `i` in `0..count`, in parallel and in order.
///
/// # Errors
/// [`GeometryError::Cancelled`] when `monitor` asks to stop.
pub fn map<T, F>(count: usize, monitor: &dyn Monitor, f: F) -> Result<Vec<T>, GeometryError>
where
    T: Send + Zeroable,
    F: Fn(usize) -> T + Sync,
{
    let mut out = zeroed(count);
    fill(&mut out, monitor, |i, slot| *slot = f(i))?;
    Ok(out)
}

/// Calls `f(i, &mut out[i])` for every element, in parallel.
///
/// # Errors
/// [`GeometryError::Cancelled`] when `monitor` asks to stop; `out` is then
/// partly written.
pub fn fill<T, F>(out: &mut [T], monitor: &dyn Monitor, f: F) -> Result<(), GeometryError>
where
    T: Send,
    F: Fn(usize, &mut T) + Sync,
{
    fill_chunks(out, monitor, |first, slots| {
        for (k, slot) in slots.iter_mut().enumerate() {
            f(first + k, slot);
        }
    })
}

/// Calls `f(first, slots)` for every chunk of `out`, in parallel: `slots` begin
/// with element `first`. For kernels that work on several elements at a time.
///
/// # Errors
/// [`GeometryError::Cancelled`] when `monitor` asks to stop; `out` is then
/// partly written.
pub fn fill_chunks<T, F>(out: &mut [T], monitor: &dyn Monitor, f: F) -> Result<(), GeometryError>
where
    T: Send,
    F: Fn(usize, &mut [T]) + Sync,
{
    let total = out.len() as u64;
    let done = AtomicU64::new(0);
    out.par_chunks_mut(CHUNK)
        .enumerate()
        .try_for_each(|(chunk, slots)| {
            monitor.check()?;
            f(chunk * CHUNK, slots);
            let before = done.fetch_add(slots.len() as u64, Ordering::Relaxed);
            monitor.progress(before + slots.len() as u64, total);
            Ok(())
        })
}

/// Whether `f(first, chunk)` holds for every chunk of `items`, in parallel:
/// `chunk` begins with element `first`.
pub(crate) fn all<T: Sync>(items: &[T], f: impl Fn(usize, &[T]) -> bool + Sync) -> bool {
    // Few items are not worth waking other threads for.
    if items.len() <= CHUNK {
        return f(0, items);
    }
    let chunks = items.par_chunks(CHUNK).enumerate();
    chunks.all(|(chunk, items)| f(chunk * CHUNK, items))
}

/// Calls `f(i)` for `i` in `0..count` one after the other: for work whose steps
/// need each other, that must stop all the same.
///
/// # Errors
/// [`GeometryError::Cancelled`] when `monitor` asks to stop.
pub(crate) fn in_order(
    count: usize,
    monitor: &dyn Monitor,
    mut f: impl FnMut(usize),
) -> Result<(), GeometryError> {
    for start in (0..count).step_by(CHUNK) {
        monitor.check()?;
        (start..(start + CHUNK).min(count)).for_each(&mut f);
    }
    Ok(())
}

/// Sorts by `key`, in parallel: chunks, then pairs of runs until one is left.
/// Equal keys keep their order. Cost: O(count · log count).
///
/// # Errors
/// [`GeometryError::Cancelled`] when `monitor` asks to stop; `items` is then
/// in any order.
pub(crate) fn sort_by_key<T, K>(
    items: &mut Vec<T>,
    monitor: &dyn Monitor,
    key: impl Fn(&T) -> K + Sync,
) -> Result<(), GeometryError>
where
    T: Copy + Send + Sync,
    K: Ord,
{
    items.par_chunks_mut(CHUNK).try_for_each(|run| {
        monitor.check()?;
        run.sort_by_key(&key);
        Ok(())
    })?;
    let mut merged = items.clone();
    let mut length = CHUNK;
    while length < items.len() {
        let pairs = items.par_chunks(2 * length);
        let slots = merged.par_chunks_mut(2 * length);
        pairs.zip(slots).try_for_each(|(pair, slots)| {
            let (left, right) = pair.split_at(length.min(pair.len()));
            merge(left, right, slots, monitor, &key)
        })?;
        std::mem::swap(items, &mut merged);
        length *= 2;
    }
    Ok(())
}

/// Two sorted runs as one; of equal items those of the left one first.
fn merge<'a, T: Copy, K: Ord>(
    mut left: &'a [T],
    mut right: &'a [T],
    out: &mut [T],
    monitor: &dyn Monitor,
    key: impl Fn(&T) -> K,
) -> Result<(), GeometryError> {
    for slots in out.chunks_mut(CHUNK) {
        monitor.check()?;
        for slot in slots {
            let from = match (left.first(), right.first()) {
                (Some(a), Some(b)) if key(b) < key(a) => &mut right,
                (Some(_), _) => &mut left,
                (None, _) => &mut right,
            };
            if let Some((first, rest)) = from.split_first() {
                (*slot, *from) = (*first, rest);
            }
        }
    }
    Ok(())
}

/// `count` zero values, in pages the system hands out zeroed: the threads that
/// write them touch them first, which on large arrays is most of the cost.
pub fn zeroed<T: Zeroable>(count: usize) -> Vec<T> {
    bytemuck::zeroed_vec(count)
}

/// Calls `f(scratch, i, run)` for every run of `out`, in parallel: run `i` is
/// `out[starts[i]..starts[i + 1]]`. `scratch` makes working memory once per
/// chunk of runs; a run must not depend on what an earlier one left in it.
///
/// # Errors
/// [`GeometryError::Cancelled`] when `monitor` asks to stop; `out` is then
/// partly written.
///
/// # Panics
/// If `starts` does not ascend from 0 to the length of `out`.
pub fn fill_runs<T, S, F>(
    out: &mut [T],
    starts: &[u32],
    monitor: &dyn Monitor,
    scratch: impl Fn() -> S + Sync,
    f: F,
) -> Result<(), GeometryError>
where
    T: Send,
    F: Fn(&mut S, usize, &mut [T]) + Sync,
{
    let runs = starts.len().saturating_sub(1);
    let total = out.len() as u64;
    let done = AtomicU64::new(0);
    let mut chunks = Vec::new();
    let (mut rest, mut first) = (out, 0);
    while first < runs {
        // Whole runs up to the size of a chunk, and at least one.
        let limit = starts[first] as usize + CHUNK;
        let end = first + starts[first + 1..].partition_point(|&at| at as usize <= limit);
        let end = end.max(first + 1);
        let (chunk, tail) = rest.split_at_mut((starts[end] - starts[first]) as usize);
        chunks.push((first..end, chunk));
        (rest, first) = (tail, end);
    }
    chunks.into_par_iter().try_for_each(|(runs, mut slots)| {
        monitor.check()?;
        let mut scratch = scratch();
        let written = slots.len() as u64;
        for i in runs {
            let (run, tail) = slots.split_at_mut((starts[i + 1] - starts[i]) as usize);
            f(&mut scratch, i, run);
            slots = tail;
        }
        let before = done.fetch_add(written, Ordering::Relaxed);
        monitor.progress(before + written, total);
        Ok(())
    })
}

/// Calls `f(scratch, row, slots)` for every row of `len` slots of `out`, in
/// parallel. `scratch` makes working memory once per chunk of rows, so that a
/// row needs no allocation of its own; a row must not depend on what an earlier
/// one left in it.
///
/// # Errors
/// [`GeometryError::Cancelled`] when `monitor` asks to stop; `out` is then
/// partly written.
pub fn fill_rows<T, S, F>(
    out: &mut [T],
    len: usize,
    monitor: &dyn Monitor,
    scratch: impl Fn() -> S + Sync,
    f: F,
) -> Result<(), GeometryError>
where
    T: Send,
    F: Fn(&mut S, usize, &mut [T]) + Sync,
{
    if len == 0 {
        return Ok(());
    }
    let rows = (CHUNK / len).max(1);
    out.par_chunks_mut(rows * len)
        .enumerate()
        .try_for_each(|(chunk, slots)| {
            monitor.check()?;
            let mut scratch = scratch();
            for (k, row) in slots.chunks_exact_mut(len).enumerate() {
                f(&mut scratch, chunk * rows + k, row);
            }
            Ok(())
        })
}

/// Ordered reduction: `fold` runs over each chunk of indices, `merge` joins the
/// chunks' results from first to last.
///
/// The result is the same for any number of threads, because neither the cut
/// into chunks nor the order of merging depends on it.
pub fn reduce<A, F, M>(count: usize, start: impl Fn() -> A + Sync, fold: F, merge: M) -> A
where
    A: Send,
    F: Fn(A, usize) -> A + Sync,
    M: Fn(A, A) -> A,
{
    let chunks: Vec<A> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let end = (chunk * CHUNK + CHUNK).min(count);
            (chunk * CHUNK..end).fold(start(), &fold)
        })
        .collect();
    chunks.into_iter().fold(start(), merge)
}

/// The smallest and the largest of `take(i)` for `i` in `0..count`; `None` of
/// none.
pub fn range(count: usize, take: impl Fn(usize) -> f64 + Sync) -> Option<(f64, f64)> {
    let wider =
        |(low, high): (f64, f64), (least, most): (f64, f64)| (low.min(least), high.max(most));
    let nothing = || (f64::INFINITY, f64::NEG_INFINITY);
    let one = |found, index: usize| {
        let number = take(index);
        wider(found, (number, number))
    };
    (count > 0).then(|| reduce(count, nothing, one, wider))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;

    #[test]
    fn runs_of_any_length_are_filled_once() {
        let lengths = [0, 3, 5000, 1, 0, 4095, 4096, 4097, 2, 0];
        let mut starts = vec![0];
        for length in lengths {
            starts.push(starts[starts.len() - 1] + length);
        }
        let mut out: Vec<u32> = zeroed(starts[10] as usize);
        fill_runs(
            &mut out,
            &starts,
            &Unmonitored,
            || (),
            |(), run, slots| {
                slots.iter_mut().for_each(|slot| *slot += run as u32 + 1);
            },
        )
        .unwrap();
        let expected: Vec<u32> = (1u32..)
            .zip(lengths)
            .flat_map(|(run, length)| std::iter::repeat_n(run, length as usize))
            .collect();
        assert_eq!(out, expected);
    }
}
