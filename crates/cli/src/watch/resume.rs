//! Going on after a run that took more memory than there may be.
//!
//! Where that is noticed nothing can be unwound: an allocation must not fail. So
//! the program begins anew in its own process, without what filled the memory,
//! and waits for the next edit.

use std::ffi::OsString;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

/// Says that the program began anew, and when the run began that it could not end;
/// nobody types it, nor anything else that begins like that.
const RESUME: &str = "--resume";

/// What the program is given besides when it begins anew.
struct Again {
    arguments: Vec<OsString>,
    variables: Vec<(&'static str, OsString)>,
}

static AGAIN: OnceLock<Again> = OnceLock::new();

/// From now on the program begins anew instead of ending, with further
/// `arguments`, which begin with `--resume-`, and variables of the environment.
pub(crate) fn arm(arguments: Vec<OsString>, variables: Vec<(&'static str, &str)>) {
    let variables = variables.into_iter();
    let variables = variables.map(|(name, value)| (name, value.into()));
    // Once is enough: a process watches one graph.
    let _ = AGAIN.set(Again {
        arguments,
        variables: variables.collect(),
    });
}

/// When the last run began, in milliseconds of 1970; 0 if it is of values that are
/// in no file.
static BEGAN: AtomicU64 = AtomicU64::new(0);

/// A run begins.
#[allow(
    clippy::disallowed_methods,
    reason = "compared with the times of files, and no part of a result"
)]
pub(super) fn begins() {
    BEGAN.store(milliseconds(SystemTime::now()), Ordering::Relaxed);
}

/// The run that begins is of values that somebody tries out: what stands in the
/// file may be all right.
pub(crate) fn begins_trial() {
    BEGAN.store(0, Ordering::Relaxed);
}

/// Whether there is nothing to do until the file is another: it was written before
/// the run that began at the time of the argument.
pub(crate) fn waits(path: &Path, began: u64) -> bool {
    let modified = path.metadata().and_then(|found| found.modified());
    modified.map_or(true, |modified| milliseconds(modified) <= began)
}

fn milliseconds(time: SystemTime) -> u64 {
    let since = time.duration_since(SystemTime::UNIX_EPOCH);
    since.map_or(0, |since| since.as_millis() as u64)
}

/// Begins the program anew if it watches a graph. Returns if it does not, or if
/// that is not possible here.
pub(crate) fn begin_anew() {
    #[cfg(unix)]
    if let Some(again) = AGAIN.get()
        && let Ok(program) = std::env::current_exe()
    {
        use std::os::unix::process::CommandExt as _;

        let given: Vec<_> = std::env::args_os().skip(1).collect();
        let (command, rest) = given.split_at(given.len().min(1));
        let is_ours = |argument: &OsString| argument.to_string_lossy().starts_with(RESUME);
        let rest = rest.iter().filter(|argument| !is_ours(argument));
        let began = format!("{RESUME}={}", BEGAN.load(Ordering::Relaxed));
        let mut program = std::process::Command::new(program);
        program.args(command).arg(began).args(&again.arguments);
        for (name, value) in &again.variables {
            program.env(name, value);
        }
        // Comes back only if it fails; then the program ends after all.
        let _ = program.args(rest).exec();
    }
}
