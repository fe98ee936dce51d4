//! Writes results to the cache's folder behind the evaluation's back: syncing
//! a large file takes longer than many an edit.

use std::sync::mpsc::{self, Receiver, SyncSender};
use std::sync::{Arc, Mutex, PoisonError};

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
}

impl Writer {
    /// Has the results written soon; waits only if many are waiting already.
    pub(super) fn store(&self, disk: &Arc<Disk>, work: ToStore) {
        let jobs = {
            let mut jobs = self.jobs.lock().unwrap_or_else(PoisonError::into_inner);
            if jobs.is_none() {
                *jobs = start(disk);
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
fn start(disk: &Arc<Disk>) -> Option<SyncSender<Job>> {
    let (sender, receiver) = mpsc::sync_channel(MOST_WAITING);
    let disk = Arc::clone(disk);
    let thread = std::thread::Builder::new().name("tessgraph cache".to_owned());
    thread.spawn(move || work_through(&disk, &receiver)).ok()?;
    Some(sender)
}

fn work_through(disk: &Arc<Disk>, jobs: &Receiver<Job>) {
    step_back();
    for job in jobs {
        match job {
            Job::Store(work) => {
                store(disk, &work);
                // Long watching and large studies would fill the disk.
                if let Some(budget) = disk.due_budget() {
                    CacheFolder::of(disk).gc(budget);
                }
            }
            Job::Flush(done) => {
                // Nobody may be waiting any more.
                let _ = done.send(());
            }
        }
    }
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
    if has_topology && disk.has(FileKind::Value, known.digest) {
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
    disk.write(FileKind::Value, known.digest, cost, &bytes);
    true
}

pub(super) fn topology_of(value: &Value) -> Option<&Arc<Topology>> {
    match value {
        Value::Mesh(mesh) => Some(mesh.topology()),
        Value::Directions(directions) => Some(directions.topology()),
        _ => None,
    }
}
