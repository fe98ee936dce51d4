//! Going on after a run that took more memory than there may be.
//!
//! Where that is noticed nothing can be unwound: an allocation must not fail. So
//! the program begins anew in its own process, without what filled the memory,
//! and waits for the next edit.

use std::sync::atomic::{AtomicBool, Ordering};

/// Says that the program began anew; nobody types it.
pub(crate) const RESUME: &str = "--resume";

static WATCHING: AtomicBool = AtomicBool::new(false);

/// From now on the program begins anew instead of ending.
pub(super) fn arm() {
    WATCHING.store(true, Ordering::Relaxed);
}

/// Begins the program anew if it watches a graph. Returns if it does not, or if
/// that is not possible here.
pub(crate) fn begin_anew() {
    #[cfg(unix)]
    if WATCHING.load(Ordering::Relaxed)
        && let Ok(program) = std::env::current_exe()
    {
        use std::os::unix::process::CommandExt as _;
        let given: Vec<_> = std::env::args_os().skip(1).collect();
        let (command, rest) = given.split_at(given.len().min(1));
        let rest = rest.iter().filter(|argument| *argument != RESUME);
        let mut program = std::process::Command::new(program);
        program.args(command).arg(RESUME).args(rest);
        // Comes back only if it fails; then the program ends after all.
        let _ = program.exec();
    }
}
