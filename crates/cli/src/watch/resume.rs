//! Going on after a run that took more memory than there may be.
//!
//! Where that is noticed nothing can be unwound: an allocation must not fail. So
//! the program begins anew in its own process, without what filled the memory,
//! and waits for the next edit.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::SystemTime;

/// Says that the program began anew, and when the run began that it could not end;
/// nobody types it.
const RESUME: &str = "--resume=";

static WATCHING: AtomicBool = AtomicBool::new(false);

/// From now on the program begins anew instead of ending.
pub(super) fn arm() {
    WATCHING.store(true, Ordering::Relaxed);
}

/// When the last run began, in milliseconds of 1970.
static BEGAN: AtomicU64 = AtomicU64::new(0);

/// A run begins.
#[allow(
    clippy::disallowed_methods,
    reason = "compared with the times of files, and no part of a result"
)]
pub(super) fn begins() {
    BEGAN.store(milliseconds(SystemTime::now()), Ordering::Relaxed);
}

/// Whether the file was written after the time of the argument.
pub(super) fn is_newer(path: &Path, began: u64) -> bool {
    let modified = path.metadata().and_then(|found| found.modified());
    modified.is_ok_and(|modified| milliseconds(modified) > began)
}

fn milliseconds(time: SystemTime) -> u64 {
    let since = time.duration_since(SystemTime::UNIX_EPOCH);
    since.map_or(0, |since| since.as_millis() as u64)
}

/// Begins the program anew if it watches a graph. Returns if it does not, or if
/// that is not possible here.
pub(crate) fn begin_anew() {
    #[cfg(unix)]
    if WATCHING.load(Ordering::Relaxed)
        && let Ok(program) = std::env::current_exe()
    {
        use std::ffi::OsString;
        use std::os::unix::process::CommandExt as _;

        let given: Vec<_> = std::env::args_os().skip(1).collect();
        let (command, rest) = given.split_at(given.len().min(1));
        let is_ours = |argument: &OsString| argument.to_string_lossy().starts_with(RESUME);
        let rest = rest.iter().filter(|argument| !is_ours(argument));
        let began = format!("{RESUME}{}", BEGAN.load(Ordering::Relaxed));
        let mut program = std::process::Command::new(program);
        program.args(command).arg(began).args(rest);
        // Comes back only if it fails; then the program ends after all.
        let _ = program.exec();
    }
}
