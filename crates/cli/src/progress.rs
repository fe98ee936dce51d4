//! What happens during a run: a bar for people, and the wish to stop.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tessgraph_graph::{NodeRun, Observer};

use crate::interrupt;

/// Work that is shorter than this shows no bar: it would only flicker.
const PATIENCE: Duration = Duration::from_millis(300);

/// How often the bar moves.
const TICK: Duration = Duration::from_millis(100);

/// The names of the nodes at work, for whoever has to say why all stops.
static RUNNING: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Shows the names of the nodes at work, unless they change just now.
pub(crate) fn with_running(show: impl FnOnce(&[String])) {
    if let Ok(names) = RUNNING.try_lock() {
        show(&names);
    }
}

/// An observer that draws a bar on stderr once the work has lasted a while.
pub(crate) struct Progress {
    bar: ProgressBar,
    names: Vec<String>,
    running: Mutex<Vec<(usize, Option<u64>)>>,
}

impl Progress {
    /// For nodes of these names, all of them or only some needed.
    pub(crate) fn new(names: Vec<String>) -> Self {
        let bar =
            ProgressBar::with_draw_target(Some(names.len() as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{spinner} {pos}/{len} {wide_msg}") {
            bar.set_style(style);
        }
        Self {
            bar,
            names,
            running: Mutex::default(),
        }
    }

    /// Carries `work` out; with `live` a bar is shown meanwhile if it takes long.
    pub(crate) fn during<T>(&self, live: bool, work: impl FnOnce() -> T) -> T {
        if !live {
            return work();
        }
        let done = (Mutex::new(false), Condvar::new());
        let result = std::thread::scope(|scope| {
            scope.spawn(|| {
                let guard = done.0.lock().unwrap_or_else(PoisonError::into_inner);
                let waited = done.1.wait_timeout_while(guard, PATIENCE, |done| !*done);
                let over = waited.map_or(true, |(done, _)| *done);
                if !over {
                    self.bar.set_draw_target(ProgressDrawTarget::stderr());
                    self.bar.enable_steady_tick(TICK);
                }
            });
            let result = work();
            *done.0.lock().unwrap_or_else(PoisonError::into_inner) = true;
            done.1.notify_all();
            result
        });
        self.bar.finish_and_clear();
        result
    }

    fn update(&self, change: impl FnOnce(&mut Vec<(usize, Option<u64>)>)) {
        let mut running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut running);
        if self.bar.is_hidden() {
            return;
        }
        let shown = running.iter().map(|(node, percent)| match percent {
            Some(percent) => format!("{} {percent} %", self.names[*node]),
            None => self.names[*node].clone(),
        });
        self.bar.set_message(shown.collect::<Vec<_>>().join(", "));
    }
}

fn running_names() -> MutexGuard<'static, Vec<String>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Observer for Progress {
    fn started(&self, node: usize) {
        running_names().push(self.names[node].clone());
        self.update(|running| running.push((node, None)));
    }

    fn progress(&self, node: usize, done: u64, total: u64) {
        let percent = (done.saturating_mul(100)).checked_div(total);
        self.update(|running| {
            if let Some(entry) = running.iter_mut().find(|(other, _)| *other == node) {
                entry.1 = percent;
            }
        });
    }

    fn finished(&self, node: usize, _run: &NodeRun) {
        let mut names = running_names();
        if let Some(place) = names.iter().position(|name| *name == self.names[node]) {
            names.swap_remove(place);
        }
        drop(names);
        self.bar.inc(1);
        self.update(|running| running.retain(|(other, _)| *other != node));
    }

    fn cancelled(&self) -> bool {
        interrupt::is_requested()
    }
}
