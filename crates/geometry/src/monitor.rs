//! How a long operation reports progress and learns that it should stop.

use crate::GeometryError;

/// The caller's side of a long operation.
///
/// Loops poll it once per chunk of work, so cancellation takes effect within
/// milliseconds and costs nothing measurable.
pub trait Monitor: Sync {
    /// Whether the operation should stop at the next chance.
    fn cancelled(&self) -> bool {
        false
    }

    /// Told from time to time that `done` of `total` units of work are finished.
    fn progress(&self, _done: u64, _total: u64) {}

    /// Bytes that may still be taken; `None` without a limit.
    fn memory_left(&self) -> Option<u64> {
        None
    }

    /// Asked before an operation allocates a result of about `bytes`, so that
    /// one that cannot fit costs a message and not the process.
    ///
    /// # Errors
    /// [`GeometryError::OutOfMemory`] when [`Monitor::memory_left`] is less.
    fn afford(&self, bytes: u128) -> Result<(), GeometryError> {
        match self.memory_left() {
            Some(left) if bytes > u128::from(left) => Err(GeometryError::OutOfMemory {
                needed: bytes,
                left,
            }),
            _ => Ok(()),
        }
    }

    /// `Err(GeometryError::Cancelled)` if the operation should stop.
    ///
    /// # Errors
    /// When [`Monitor::cancelled`] says so.
    fn check(&self) -> Result<(), GeometryError> {
        if self.cancelled() {
            Err(GeometryError::Cancelled)
        } else {
            Ok(())
        }
    }
}

/// A monitor that never cancels and ignores progress.
pub struct Unmonitored;

impl Monitor for Unmonitored {}

/// Passes cancellation on but no progress: for the inner loops of an operation
/// that reports its own.
pub(crate) struct Quiet<'a>(pub(crate) &'a dyn Monitor);

impl Monitor for Quiet<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }

    fn memory_left(&self) -> Option<u64> {
        self.0.memory_left()
    }
}

#[cfg(test)]
mod tests;
