//! Writes results to the cache's folder behind the evaluation's back: syncing
//! a large file takes longer than many an edit.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tessgraph_geometry::Topology;
use tessgraph_geometry::digest::Digest;

use super::disk::Disk;
use super::entry::{Entry, Known};
use super::frame::FileKind;
use super::maintain::CacheFolder;
use crate::eval::Values;
use crate::value::Value;
use crate::value::encode::{Encoder, encode_topology};

/// Results that may wait to be written; they are held in memory meanwhile.
const MOST_WAITING: usize = 32;

/// Of those, how many wait for a pause.
const MOST_PAUSING: usize = 16;

/// A node's results, to be written.
#[derive(Debug)]
pub(in crate::eval) struct ToStore {
    pub(in crate::eval) key: Digest,
    pub(in crate::eval) entry: Arc<Entry>,
    pub(in crate::eval) values: Values,
}

/// What the writing thread is told.
enum Job {
    Store(ToStore),
    /// Say when everything before this has been written.
    Flush(SyncSender<()>),
}

/// A thread that writes, started with the first results. It ends when the
/// writer is dropped and everything has been written.
#[derive(Debug, Default)]
pub(super) struct Writer {
    jobs: Mutex<Option<SyncSender<Job>>>,
    /// Milliseconds that results wait.
    pause: AtomicU64,
}

impl Writer {
    /// Has results wait that long before they are written; counts for a thread that
    /// has not begun.
    pub(super) fn set_pause(&self, pause: Duration) {
        let ms = u64::try_from(pause.as_millis()).unwrap_or(u64::MAX);
        self.pause.store(ms, Ordering::Relaxed);
    }

    /// Has the results written soon; waits only if many are waiting already.
    pub(super) fn store(&self, disk: &Arc<Disk>, work: ToStore) {
        let jobs = {
            let mut jobs = self.jobs.lock().unwrap_or_else(PoisonError::into_inner);
            if jobs.is_none() {
                let pause = Duration::from_millis(self.pause.load(Ordering::Relaxed));
                *jobs = start(disk, pause);
            }
            jobs.clone()
        };
        match jobs {
            Some(jobs) => {
                // The thread ends only after its last sender.
                let _ = jobs.send(Job::Store(work));
            }
            None => store(disk, &work),
        }
    }

    /// Returns when everything handed over so far has been written.
    pub(super) fn flush(&self) {
        let jobs = {
            let jobs = self.jobs.lock().unwrap_or_else(PoisonError::into_inner);
            jobs.clone()
        };
        let (done, written) = mpsc::sync_channel(1);
        if jobs.is_some_and(|jobs| jobs.send(Job::Flush(done)).is_ok()) {
            let _ = written.recv();
        }
    }
}

/// The writing thread; `None` if the system gives no more threads.
fn start(disk: &Arc<Disk>, pause: Duration) -> Option<SyncSender<Job>> {
    let (sender, receiver) = mpsc::sync_channel(MOST_WAITING);
    let disk = Arc::clone(disk);
    let thread = std::thread::Builder::new().name("tessgraph cache".to_owned());
    thread
        .spawn(move || work_through(&disk, &receiver, pause))
        .ok()?;
    Some(sender)
}

fn work_through(disk: &Arc<Disk>, jobs: &Receiver<Job>, pause: Duration) {
    step_back();
    while let Ok(first) = jobs.recv() {
        let awaited = gather(first, jobs, pause, |work| {
            store(disk, &work);
            // Long watching and large studies would fill the disk.
            if let Some(budget) = disk.due_budget() {
                CacheFolder::of(disk).gc(budget);
            }
        });
        if let Some(done) = awaited {
            // Nobody may be waiting any more.
            let _ = done.send(());
        }
    }
}

/// Waits for a pause of others' work, unless somebody waits for this or too much
/// does, and passes on what has come until then; who waits for it, if anybody.
fn gather(
    first: Job,
    jobs: &Receiver<Job>,
    pause: Duration,
    store: impl FnMut(ToStore),
) -> Option<SyncSender<()>> {
    let (mut waiting, mut awaited) = (Vec::new(), None);
    let until = Instant::now() + pause;
    let mut next = Some(first);
    while let Some(job) = next {
        match job {
            Job::Store(work) => waiting.push(work),
            Job::Flush(done) => awaited = Some(done),
        }
        let left = until.saturating_duration_since(Instant::now());
        let is_ripe = awaited.is_some() || waiting.len() >= MOST_PAUSING || left.is_zero();
        next = (!is_ripe).then(|| jobs.recv_timeout(left).ok()).flatten();
    }
    waiting.into_iter().for_each(store);
    awaited
}

/// Lets threads that somebody waits for go first, where all processors are taken.
fn step_back() {
    /// Half as nice as one can be: a tenth of the share of the others.
    #[cfg(target_os = "linux")]
    const NICE: i32 = 10;
    // Of this thread alone: elsewhere the whole process has one priority. What the
    // system does not allow is done as fast as the rest.
    #[cfg(target_os = "linux")]
    let _ = rustix::process::setpriority_process(None, NICE);
}

/// Writes results: values before the entry that names them.
fn store(disk: &Disk, work: &ToStore) {
    let entry = &work.entry;
    for (known, value) in entry.results.iter().zip(work.values.iter()) {
        let stored = known.small.is_some() || store_value(disk, known, value, entry.ms);
        if !stored {
            return;
        }
    }
    for key in entry.keys(work.key) {
        disk.write(FileKind::Entry, key, entry.ms, &entry.encode());
    }
}

/// Writes a value and its topologies; `false` if it is of a type that is never
/// stored.
fn store_value(disk: &Disk, known: &Known, value: &Value, cost: f64) -> bool {
    // A topology may have been removed apart from the value. Lists name several
    // and are written again to be sure.
    let has_topology = match topology_of(value) {
        Some(topology) => disk.has(FileKind::Topology, topology.digest()),
        None => !matches!(value, Value::List(_)),
    };
    if has_topology && disk.has(FileKind::Value, known.identity) {
        return true;
    }
    let mut out = Encoder::new();
    if !value.encode(&mut out) {
        return false;
    }
    let (bytes, topologies) = out.finish();
    for topology in topologies {
        let digest = topology.digest();
        if !disk.has(FileKind::Topology, digest) {
            let bytes = encode_topology(&topology);
            disk.write(FileKind::Topology, digest, cost, &bytes);
        }
    }
    disk.write(FileKind::Value, known.identity, cost, &bytes);
    true
}

pub(super) fn topology_of(value: &Value) -> Option<&Arc<Topology>> {
    match value {
        Value::Mesh(mesh) => Some(mesh.topology()),
        Value::Directions(directions) => Some(directions.topology()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(number: u8) -> Job {
        let entry = Entry {
            results: Vec::new(),
            files: Vec::new(),
            warnings: Vec::new(),
            ms: 0.0,
            bytes: 0,
        };
        Job::Store(ToStore {
            key: Digest::of(&[number]),
            entry: Arc::new(entry),
            values: Arc::new([]),
        })
    }

    /// How many results are stored, whether somebody waits for it, and after which time.
    fn gathered(jobs: Vec<Job>, pause: Duration) -> (usize, bool, Duration) {
        let (sender, receiver) = mpsc::sync_channel(MOST_WAITING);
        let mut jobs = jobs.into_iter();
        let first = jobs.next().unwrap();
        jobs.for_each(|job| sender.send(job).unwrap());
        let (start, mut count) = (Instant::now(), 0);
        let awaited = gather(first, &receiver, pause, |_| count += 1);
        (count, awaited.is_some(), start.elapsed())
    }

    #[test]
    fn results_wait_for_a_pause_but_nobody_for_results() {
        let (long, short) = (Duration::from_secs(600), Duration::from_millis(30));
        let flush = || Job::Flush(mpsc::sync_channel(1).0);
        let (count, awaited, time) = gathered(vec![work(0), work(1)], short);
        assert_eq!((count, awaited), (2, false));
        assert!(time >= short);
        let (count, awaited, time) = gathered(vec![work(0), work(1), flush(), work(2)], long);
        assert_eq!((count, awaited), (2, true));
        assert!(time < long);
        let many = (0..20).map(work).collect();
        assert_eq!(gathered(many, long).0, MOST_PAUSING);
        assert_eq!(gathered(vec![work(0), work(1)], Duration::ZERO).0, 1);
    }
}
