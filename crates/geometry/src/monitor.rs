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
}
