//! Results kept for later: key to digests, digest to value, in memory and on
//! disk.

mod disk;
mod entry;
mod frame;
mod maintain;
mod memory;
#[cfg(test)]
mod tests;
mod writer;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Duration;

use tessgraph_geometry::Topology;
use tessgraph_geometry::digest::Digest;

use self::disk::Disk;
use self::memory::Memory;
use self::writer::{Writer, topology_of};
use crate::value::Value;
use crate::value::encode::{Decoder, decode_topology};

pub(super) use entry::{Entry, Known, key_with_files};
pub(super) use frame::FileKind;
pub use maintain::{CacheFolder, FolderStats, GcReport, VerifyReport};
pub(super) use writer::ToStore;

/// Bytes of entries kept in memory, as [`Entry::weight`] has them; beyond it the older
/// half is let go: those of some thousand edits are there.
const MOST_ENTRY_BYTES: usize = 16 << 20;

/// A two-level cache: small entries are kept, values live within a byte budget.
#[derive(Debug)]
pub(super) struct Cache {
    entries: Mutex<Entries>,
    values: Mutex<Memory>,
    /// Topologies in use by digest, so that equal ones are one and their
    /// adjacency is built once.
    topologies: Mutex<BTreeMap<Digest, Weak<Topology>>>,
    disk: Option<Arc<Disk>>,
    writer: Writer,
    /// Why there is no disk, if one was asked for.
    no_disk: Option<String>,
    entry_reads: AtomicU64,
    value_reads: AtomicU64,
}

/// Entries by key, each with the time it was put there.
#[derive(Debug, Default)]
struct Entries {
    by_key: BTreeMap<Digest, (u64, Arc<Entry>)>,
    clock: u64,
    /// Of all that are there.
    bytes: usize,
}

impl Entries {
    fn insert(&mut self, key: Digest, entry: &Arc<Entry>) {
        self.clock += 1;
        self.bytes += entry.weight();
        let before = self.by_key.insert(key, (self.clock, Arc::clone(entry)));
        self.bytes -= before.map_or(0, |(_, entry)| entry.weight());
        if self.bytes > MOST_ENTRY_BYTES {
            self.forget_older();
        }
    }

    /// Keeps the latest of them that fit into half of what there may be.
    fn forget_older(&mut self) {
        let times = self.by_key.values();
        let mut times: Vec<(u64, usize)> =
            times.map(|(time, entry)| (*time, entry.weight())).collect();
        times.sort_unstable_by(|one, other| other.cmp(one));
        let mut kept = 0;
        let lost = times.iter().find(|(_, bytes)| {
            kept += bytes;
            kept > MOST_ENTRY_BYTES / 2
        });
        let lost = lost.map_or(0, |(time, _)| *time);
        self.by_key.retain(|_, (time, _)| *time > lost);
        self.bytes = self.by_key.values().map(|(_, entry)| entry.weight()).sum();
    }
}

/// How much a cache holds and what was read from its folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CacheStats {
    /// Nodes' results known by key, in memory.
    pub entries: usize,
    /// Values held in memory.
    pub values: usize,
    /// Bytes of these values, shared buffers counted once.
    pub bytes: u64,
    /// Entries read from the folder so far.
    pub entry_reads: u64,
    /// Values read from the folder so far.
    pub value_reads: u64,
    /// Why the folder is not used, or not written to, if that is so.
    pub warning: Option<String>,
}

impl Cache {
    /// A cache that holds up to `bytes` of values in memory, and more in
    /// `folder` if there is one. A folder that cannot be used is a warning.
    pub(super) fn new(bytes: u64, folder: Option<&Path>) -> Self {
        let (disk, no_disk) = match folder.map(Disk::open) {
            Some(Ok(disk)) => (Some(Arc::new(disk)), None),
            Some(Err(reason)) => (None, Some(reason)),
            None => (None, None),
        };
        Self {
            entries: Mutex::default(),
            values: Mutex::new(Memory::new(bytes)),
            topologies: Mutex::default(),
            disk,
            writer: Writer::default(),
            no_disk,
            entry_reads: AtomicU64::new(0),
            value_reads: AtomicU64::new(0),
        }
    }

    /// Sets the bytes that the folder is kept to.
    pub(super) fn set_disk_budget(&self, bytes: u64) {
        if let Some(disk) = &self.disk {
            disk.set_budget(bytes);
        }
    }

    /// Sets how long results wait before they are written to the folder.
    pub(super) fn set_pause(&self, pause: Duration) {
        self.writer.set_pause(pause);
    }

    pub(super) fn stats(&self) -> CacheStats {
        let (values, bytes) = {
            let memory = lock(&self.values);
            (memory.len(), memory.bytes())
        };
        CacheStats {
            entries: lock(&self.entries).by_key.len(),
            values,
            bytes,
            entry_reads: self.entry_reads.load(Ordering::Relaxed),
            value_reads: self.value_reads.load(Ordering::Relaxed),
            warning: self.warning(),
        }
    }

    /// What is known under `key`; no value is loaded.
    pub(super) fn entry(&self, key: Digest) -> Option<Arc<Entry>> {
        if let Some((_, entry)) = lock(&self.entries).by_key.get(&key) {
            return Some(Arc::clone(entry));
        }
        let disk = self.disk.as_ref()?;
        let entry = disk.read(FileKind::Entry, key, Entry::decode)?;
        self.entry_reads.fetch_add(1, Ordering::Relaxed);
        let entry = Arc::new(entry);
        self.remember(key, &entry);
        Some(entry)
    }

    fn remember(&self, key: Digest, entry: &Arc<Entry>) {
        lock(&self.entries).insert(key, entry);
    }

    /// The value with that digest, from memory or disk; `None` if it was let go
    /// or is damaged. `cost` is what it took to compute, in milliseconds.
    pub(super) fn value(&self, digest: Digest, cost: f64) -> Option<Value> {
        if let Some(value) = lock(&self.values).get(digest) {
            return Some(value);
        }
        let disk = self.disk.as_ref()?;
        let find = |digest| self.topology(disk, digest);
        // No lock is held here: checksums of large files use the thread pool.
        let value = disk.read(FileKind::Value, digest, |bytes| {
            let mut from = Decoder::new(bytes, &find);
            let value = Value::decode(&mut from)?;
            from.finish(value)
        })?;
        self.value_reads.fetch_add(1, Ordering::Relaxed);
        lock(&self.values).insert(digest, &value, cost);
        Some(value)
    }

    fn topology(&self, disk: &Disk, digest: Digest) -> Option<Arc<Topology>> {
        let known = lock(&self.topologies).get(&digest).and_then(Weak::upgrade);
        if known.is_some() {
            return known;
        }
        let topology = disk.read(FileKind::Topology, digest, decode_topology)?;
        Some(self.share(digest, Arc::new(topology)))
    }

    /// The topology of that digest that is in use already, or this one.
    fn share(&self, digest: Digest, topology: Arc<Topology>) -> Arc<Topology> {
        let mut known = lock(&self.topologies);
        if let Some(other) = known.get(&digest).and_then(Weak::upgrade) {
            return other;
        }
        if known.len() >= 256 && known.len().is_power_of_two() {
            known.retain(|_, topology| topology.strong_count() > 0);
        }
        known.insert(digest, Arc::downgrade(&topology));
        topology
    }

    /// The same value: a mesh with the faces of one that is in use already gets
    /// those, and with them the neighbours that are known.
    pub(super) fn shared(&self, value: Value) -> Value {
        let Value::Mesh(mesh) = &value else {
            return value;
        };
        // Before the lock is taken: hashing uses the thread pool.
        let digest = mesh.topology().digest();
        let topology = self.share(digest, Arc::clone(mesh.topology()));
        match mesh.sharing(&topology) {
            Ok(sharing) if !Arc::ptr_eq(&topology, mesh.topology()) => {
                Value::Mesh(Arc::new(sharing))
            }
            _ => value,
        }
    }

    /// Keeps results in memory.
    pub(super) fn insert(&self, key: Digest, entry: &Arc<Entry>, values: &[Value]) {
        for (known, value) in entry.results.iter().zip(values) {
            if let Some(topology) = topology_of(value) {
                self.share(topology.digest(), Arc::clone(topology));
            }
            if known.small.is_none() {
                lock(&self.values).insert(known.identity, value, entry.ms);
            }
        }
        for key in entry.keys(key) {
            self.remember(key, entry);
        }
    }

    /// Has results kept on disk, soon.
    pub(super) fn store(&self, work: ToStore) {
        if let Some(disk) = &self.disk {
            self.writer.store(disk, work);
        }
    }

    /// Returns when everything that is to be kept on disk is there.
    pub(super) fn flush(&self) {
        self.writer.flush();
    }

    /// Why the folder is not used, or not written to, if that is so.
    pub(super) fn warning(&self) -> Option<String> {
        let disk = self.disk.as_deref();
        self.no_disk
            .clone()
            .or_else(|| disk.and_then(Disk::warning))
    }

    /// What is kept about something else than a node: a graph, an output.
    pub(super) fn record<T>(
        &self,
        kind: FileKind,
        about: Digest,
        decode: impl FnOnce(&[u8]) -> Option<T>,
    ) -> Option<T> {
        self.disk.as_ref()?.read(kind, about, decode)
    }

    /// Replaces what [`Cache::record`] gives.
    pub(super) fn set_record(&self, kind: FileKind, about: Digest, content: &[u8]) {
        if let Some(disk) = &self.disk {
            disk.write(kind, about, 0.0, content);
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
