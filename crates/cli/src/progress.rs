//! What happens during a run: a bar for people, and the wish to stop.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tessgraph_graph::{NodeRun, Observer};

use crate::interrupt;
use crate::memory::{self, Span};

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

/// An observer that draws a bar on stderr once the work has lasted a while, and
/// measures the memory of each node.
pub(crate) struct Progress<'a> {
    bar: ProgressBar,
    names: Vec<String>,
    running: Mutex<Vec<Running>>,
    peaks: Mutex<Vec<Option<u64>>>,
    stop: &'a AtomicBool,
}

/// A node at work.
struct Running {
    node: usize,
    percent: Option<u64>,
    memory: Span,
}

impl<'a> Progress<'a> {
    /// For nodes of these names, all of them or only some needed. The evaluation
    /// stops when the user asks for it, or when `stop` is set.
    pub(crate) fn new(names: Vec<String>, stop: &'a AtomicBool) -> Self {
        let bar =
            ProgressBar::with_draw_target(Some(names.len() as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{spinner} {pos}/{len} {wide_msg}") {
            bar.set_style(style);
        }
        Self {
            bar,
            peaks: Mutex::new(vec![None; names.len()]),
            names,
            running: Mutex::default(),
            stop,
        }
    }

    /// The most bytes each node took while it was evaluated, as [`Span`] measures
    /// them; `None` for nodes that were not evaluated.
    pub(crate) fn peaks(&self) -> Vec<Option<u64>> {
        lock(&self.peaks).clone()
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

    fn update<T>(&self, change: impl FnOnce(&mut Vec<Running>) -> T) -> T {
        let mut running = lock(&self.running);
        let result = change(&mut running);
        if !self.bar.is_hidden() {
            let shown = running.iter().map(|at_work| {
                let name = &self.names[at_work.node];
                match at_work.percent {
                    Some(percent) => format!("{name} {percent} %"),
                    None => name.clone(),
                }
            });
            self.bar.set_message(shown.collect::<Vec<_>>().join(", "));
        }
        result
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Observer for Progress<'_> {
    fn started(&self, node: usize) {
        lock(&RUNNING).push(self.names[node].clone());
        let memory = Span::begin();
        self.update(|running| {
            running.push(Running {
                node,
                percent: None,
                memory,
            });
        });
    }

    fn progress(&self, node: usize, done: u64, total: u64) {
        let percent = (done.saturating_mul(100)).checked_div(total);
        self.update(|running| {
            if let Some(at_work) = running.iter_mut().find(|at_work| at_work.node == node) {
                at_work.percent = percent;
            }
        });
    }

    fn finished(&self, node: usize, _run: &NodeRun) {
        let ended = self.update(|running| {
            let place = running.iter().position(|at_work| at_work.node == node)?;
            Some(running.swap_remove(place))
        });
        if let Some(peak) = ended.and_then(|ended| ended.memory.end()) {
            let known = &mut lock(&self.peaks)[node];
            *known = (*known).max(Some(peak));
        }
        let mut names = lock(&RUNNING);
        if let Some(place) = names.iter().position(|name| *name == self.names[node]) {
            names.swap_remove(place);
        }
        drop(names);
        self.bar.inc(1);
    }

    fn memory_left(&self) -> Option<u64> {
        memory::left()
    }

    fn cancelled(&self) -> bool {
        interrupt::is_requested() || self.stop.load(Ordering::Relaxed)
    }
}
