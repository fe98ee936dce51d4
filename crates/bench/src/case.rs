//! What is timed, and how.

use std::hint::black_box;
use std::process::Command;
use std::time::{Duration, Instant};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::clock::{children_time, most_held, processor_time};
use crate::held;
use crate::outside::{Arrays, Outside};
use crate::report::{self, Row};

/// A run of one benchmark program: what its command line asks for.
#[derive(Debug)]
pub struct Bench {
    quick: bool,
    names: Vec<String>,
    pools: [ThreadPool; 2],
}

impl Bench {
    /// Reads the command line and prints the head of the table.
    ///
    /// # Panics
    /// If threads cannot be started.
    pub fn new(title: &str) -> Self {
        // cargo itself adds `--bench`.
        let (options, names): (Vec<_>, Vec<_>) = std::env::args()
            .skip(1)
            .partition(|argument| argument.starts_with('-'));
        let pool = |threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads can be started")
        };
        report::head(title);
        Self {
            quick: options.iter().any(|option| option == "--quick"),
            names,
            pools: [pool(1), pool(2)],
        }
    }

    /// The sizes to run, of three that ascend: all, or with `--quick` the first.
    pub fn sizes<T: Copy>(&self, sizes: [T; 3]) -> Vec<T> {
        let count = if self.quick { 1 } else { sizes.len() };
        sizes[..count].to_vec()
    }

    /// Whether the command line asks for cases of this name, so that input which
    /// nobody wants need not be made.
    pub fn wants(&self, kernel: &str) -> bool {
        self.names.is_empty() || self.names.iter().any(|name| kernel.contains(name.as_str()))
    }

    /// A case of `count` elements called `unit`. The name is that of the kernel,
    /// the same for all its sizes.
    pub fn case(&self, kernel: &str, count: usize, unit: &'static str) -> Case<'_> {
        Case {
            bench: self,
            kernel: kernel.to_owned(),
            count,
            unit,
            bytes_are_rate: false,
            contestants: Vec::new(),
        }
    }
}

/// A kernel at one size, beside those that do the same work.
pub struct Case<'a> {
    bench: &'a Bench,
    kernel: String,
    count: usize,
    unit: &'static str,
    bytes_are_rate: bool,
    contestants: Vec<Contestant<'a>>,
}

/// What a contestant is to our kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    Ours,
    Peer,
    /// What our kernel needs at least in fresh memory.
    Limit,
    /// What it needs at least in memory used before.
    ReusedLimit,
}

struct Contestant<'a> {
    name: &'a str,
    role: Role,
    /// Whether its memory is that of this process, so that it may be kept.
    takes_our_memory: bool,
    run: Box<dyn FnMut(&ThreadPool) -> Sample + 'a>,
}

/// One run.
#[derive(Debug, Clone, Copy)]
struct Sample {
    processor: Duration,
    wall: Duration,
    /// The most bytes held above what was held before.
    bytes: usize,
}

/// The best of our kernel's runs.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Runs {
    /// On one thread, in pages the process has not touched before.
    pub(crate) fresh: Option<Best>,
    /// On one thread, in memory that earlier runs used.
    pub(crate) reused: Option<Best>,
    /// On two threads, in memory used before where that is possible.
    pub(crate) both: Option<Best>,
}

/// The least of several runs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Best {
    pub(crate) processor: Duration,
    pub(crate) wall: Duration,
    pub(crate) bytes: usize,
}

impl<'a> Case<'a> {
    /// Our kernel: `run` is timed on what `prepare` makes, which is not.
    pub fn ours<S: Send, T: Send>(
        mut self,
        mut prepare: impl FnMut() -> S + 'a,
        run: impl Fn(S) -> T + Sync + 'a,
    ) -> Self {
        self.contestants.push(Contestant {
            name: "tessgraph",
            role: Role::Ours,
            takes_our_memory: true,
            run: Box::new(move |pool| {
                let input = prepare();
                timed(|| pool.install(|| run(input)))
            }),
        });
        self
    }

    /// A program of ours: `command` makes a run of it on a number of threads. Its
    /// bytes are all that the process holds.
    pub fn program(mut self, command: impl Fn(usize) -> Command + 'a) -> Self {
        self.contestants.push(Contestant {
            name: "tessgraph",
            role: Role::Ours,
            takes_our_memory: false,
            run: Box::new(move |pool| process(&mut command(pool.current_num_threads()))),
        });
        self
    }

    /// Another library doing the same work, on one thread.
    pub fn peer<T>(self, name: &'a str, run: impl FnMut() -> T + 'a) -> Self {
        self.add(name, Role::Peer, run)
    }

    /// A library of another language doing the same work, if it is installed:
    /// `library` and `work` as `benches/peers/peers.py` knows them.
    pub fn outside(self, library: &'a str, work: &str, arrays: &Arrays) -> Self {
        if !self.bench.wants(&self.kernel) {
            return self;
        }
        match Outside::start(library, work, arrays) {
            Some(mut outside) => self.told(library, Role::Peer, move || outside.run()),
            None => self,
        }
    }

    /// Our kernel, which tells its time itself: where the clock counts, as for
    /// what somebody waits for.
    pub fn clocked(self, run: impl FnMut() -> Duration + 'a) -> Self {
        self.told("tessgraph", Role::Ours, run)
    }

    /// A limit that tells its time itself.
    pub fn clocked_limit(self, name: &'a str, run: impl FnMut() -> Duration + 'a) -> Self {
        self.told(name, Role::Limit, run)
    }

    fn told(mut self, name: &'a str, role: Role, mut run: impl FnMut() -> Duration + 'a) -> Self {
        let sample = move |_: &ThreadPool| {
            let time = run();
            Sample {
                processor: time,
                wall: time,
                bytes: 0,
            }
        };
        let run = Box::new(sample);
        self.contestants.push(Contestant {
            name,
            role,
            takes_our_memory: false,
            run,
        });
        self
    }

    /// The least any program would need in fresh memory, from [`crate::limits`].
    pub fn limit<T>(self, name: &'a str, run: impl FnMut() -> T + 'a) -> Self {
        self.add(name, Role::Limit, run)
    }

    /// The least any program would need in memory used before, from
    /// [`crate::limits`].
    pub fn reused_limit<T>(self, name: &'a str, run: impl FnMut() -> T + 'a) -> Self {
        self.add(name, Role::ReusedLimit, run)
    }

    /// Elements are bytes: the rate reads as MB/s.
    pub fn in_bytes(mut self) -> Self {
        self.bytes_are_rate = true;
        self
    }

    fn add<T>(mut self, name: &'a str, role: Role, mut run: impl FnMut() -> T + 'a) -> Self {
        self.contestants.push(Contestant {
            name,
            role,
            takes_our_memory: false,
            run: Box::new(move |_| timed(&mut run)),
        });
        self
    }

    /// Runs all in turn and prints the line.
    pub fn run(mut self) {
        if !self.bench.wants(&self.kernel) {
            return;
        }
        let start = Instant::now();
        let [one, two] = &self.bench.pools;
        let mut best = vec![Runs::default(); self.contestants.len()];
        // The first run of all warms up memory and caches and does not count.
        if let Some(first) = self.contestants.first_mut() {
            (first.run)(one);
        }
        for round in 0..self.rounds() {
            if round >= 3 && start.elapsed() > PATIENCE {
                break;
            }
            for (contestant, best) in self.contestants.iter_mut().zip(&mut best) {
                tessgraph_pages::keep_at_most(0);
                better(&mut best.fresh, (contestant.run)(one));
                if contestant.takes_our_memory {
                    tessgraph_pages::keep_at_most(usize::MAX);
                    if best.reused.is_none() {
                        (contestant.run)(one);
                    }
                    better(&mut best.reused, (contestant.run)(one));
                }
                if contestant.role == Role::Ours {
                    better(&mut best.both, (contestant.run)(two));
                }
            }
        }
        tessgraph_pages::keep_at_most(0);
        let mut row = Row::new(&self.kernel, self.count, self.unit, self.bytes_are_rate);
        for (contestant, runs) in self.contestants.iter().zip(best) {
            row.add(contestant.name, contestant.role, runs);
        }
        row.print();
    }

    fn rounds(&self) -> usize {
        if self.bench.quick { 3 } else { 7 }
    }
}

/// How long a case may go on once every contestant has run three times.
const PATIENCE: Duration = Duration::from_secs(15);

/// The time of `run` alone; what it gives is dropped outside of it.
fn timed<T>(run: impl FnOnce() -> T) -> Sample {
    let before = held::begin();
    let (wall, processor) = (Instant::now(), processor_time());
    let result = black_box(run());
    let (processor, wall) = (processor_time() - processor, wall.elapsed());
    let bytes = held::peak().saturating_sub(before);
    drop(result);
    Sample {
        processor,
        wall,
        bytes,
    }
}

/// What a child process takes from its start to its end.
fn process(command: &mut Command) -> Sample {
    let before = children_time();
    let start = Instant::now();
    let mut child = command.spawn().expect("the program starts");
    let mut bytes = 0;
    let status = loop {
        bytes = most_held(child.id()).unwrap_or(bytes);
        if let Some(status) = child.try_wait().expect("a child can be waited for") {
            break status;
        }
        std::thread::sleep(LOOK);
    };
    let wall = start.elapsed();
    assert!(status.success(), "the program failed: {command:?}");
    let processor = children_time().zip(before);
    Sample {
        processor: processor.map_or(wall, |(after, before)| after - before),
        wall,
        bytes,
    }
}

/// Time between two looks at a child's memory.
const LOOK: Duration = Duration::from_millis(1);

fn better(best: &mut Option<Best>, sample: Sample) {
    let old = best.unwrap_or(Best {
        processor: Duration::MAX,
        wall: Duration::MAX,
        bytes: usize::MAX,
    });
    *best = Some(Best {
        processor: old.processor.min(sample.processor),
        wall: old.wall.min(sample.wall),
        bytes: old.bytes.min(sample.bytes),
    });
}
