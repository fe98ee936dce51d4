//! The real process: terminal, signals, panics.

use std::io::{IsTerminal as _, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use crate::commands::FAILED;
use crate::console::Console;
use crate::{dispatch, interrupt};

/// What the last panic said and where it was.
static LAST_PANIC: Mutex<String> = Mutex::new(String::new());

/// Carries out the command that the process was started with.
///
/// Colours and progress are only for terminals. Ctrl-C stops the work and
/// leaves no half-written file. A node's panic is caught where nodes are
/// evaluated and shown as that node's error, so panics print nothing by
/// themselves.
pub fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|panic| {
        *LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner) = panic.to_string();
    }));
    interrupt::install();
    let live = std::io::stderr().is_terminal();
    let mut out = anstream::stdout();
    let mut err = anstream::stderr();
    let body = || {
        let mut console = Console::styled(&mut out, &mut err, live);
        let (args, nodes) = (std::env::args_os(), tessgraph_nodes::NODES);
        dispatch(args, &mut console, nodes, cache_folder())
    };
    let status = catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|_| {
        let panic = LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner);
        let mut err = anstream::stderr();
        // Without stderr there is nowhere left to complain to.
        let _ = writeln!(
            err,
            "error: internal error: {panic}\nThis is a bug of tessgraph, not of the graph; \
             please report it."
        );
        FAILED
    });
    ExitCode::from(status)
}

/// Where results are kept: `TESSGRAPH_CACHE`, else in the user's cache folder;
/// none where there is neither.
fn cache_folder() -> Option<PathBuf> {
    use etcetera::BaseStrategy as _;
    match std::env::var_os("TESSGRAPH_CACHE") {
        Some(folder) if folder.is_empty() => None,
        Some(folder) => Some(folder.into()),
        None => {
            let user = etcetera::choose_base_strategy().ok()?;
            Some(user.cache_dir().join("tessgraph"))
        }
    }
}
