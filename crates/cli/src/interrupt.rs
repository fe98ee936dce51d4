//! Ctrl-C: the work stops, and no half-written file stays behind.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tessgraph_geometry::Monitor;

use crate::memory;

/// The exit status of an interrupted command: 128 + SIGINT.
pub(crate) const INTERRUPTED: u8 = 130;

/// How long an interrupted command may take to stop by itself.
const GRACE: Duration = Duration::from_millis(700);

static REQUESTS: AtomicUsize = AtomicUsize::new(0);

/// What is to be done at the first request, besides.
static WAKE: Mutex<Option<Box<dyn Fn() + Send>>> = Mutex::new(None);

/// Files being written under a temporary name.
static TEMPORARIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Makes SIGINT, SIGTERM and SIGHUP stop the process in order: the first asks
/// the work to stop and waits a moment for it, a second does not wait.
pub(crate) fn install() {
    // Fails only if a handler is there already, which then does the same.
    let _ = ctrlc::set_handler(|| {
        if REQUESTS.fetch_add(1, Ordering::Relaxed) > 0 {
            leave(INTERRUPTED);
        }
        std::thread::spawn(|| {
            std::thread::sleep(GRACE);
            leave(INTERRUPTED);
        });
        if let Some(wake) = &*WAKE.lock().unwrap_or_else(PoisonError::into_inner) {
            wake();
        }
    });
}

/// Has `wake` called when the work should stop: for work that waits.
pub(crate) fn on_request(wake: impl Fn() + Send + 'static) {
    *WAKE.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(wake));
}

/// Whether the work should stop.
pub(crate) fn is_requested() -> bool {
    REQUESTS.load(Ordering::Relaxed) > 0
}

/// A monitor for work outside of graphs: it stops when the user asks for it.
pub(crate) struct UntilInterrupt;

impl Monitor for UntilInterrupt {
    fn cancelled(&self) -> bool {
        is_requested()
    }

    fn memory_left(&self) -> Option<u64> {
        memory::left()
    }
}

/// Removes temporary files and ends the process.
pub(crate) fn leave(status: u8) -> ! {
    remove_temporaries();
    std::process::exit(status.into());
}

/// Removes temporary files, and lets nobody begin another one.
pub(crate) fn remove_temporaries() {
    // The lock is held for moments only, except by a thread that ran out of
    // memory inside it and now comes here: hence no endless wait. It is never
    // released again, so that nobody begins another temporary file.
    for _ in 0..100 {
        if let Ok(temporaries) = TEMPORARIES.try_lock() {
            for path in temporaries.iter() {
                let _ = std::fs::remove_file(path);
            }
            std::mem::forget(temporaries);
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// A path that is removed on interruption until this guard is gone.
pub(crate) struct Temporary(PathBuf);

impl Temporary {
    /// Registers `path` before anything is created there.
    pub(crate) fn register(path: PathBuf) -> Self {
        temporaries().push(path.clone());
        Self(path)
    }

    /// The path.
    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Temporary {
    /// Removes the file, if it is still there, and forgets it.
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
        temporaries().retain(|path| *path != self.0);
    }
}

fn temporaries() -> MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner)
}
