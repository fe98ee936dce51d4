//! Outputs whose files are still what an earlier run wrote: they are not made
//! again, and their values not even loaded.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::sync::PoisonError;

use tessgraph_geometry::digest::{Digest, Hasher};
use tessgraph_graph::eval::{OutputRecord, WrittenFile};
use tessgraph_graph::plan::ResultRef;
use tessgraph_graph::{NodeRun, Observer};

use super::encode::made_from;
use super::{Outputs, Target, WrittenOutput};
use crate::atomic::{CHUNK, Put};
use crate::interrupt;

impl Outputs<'_> {
    /// The record of the target's files if it is of `made_from` and they are
    /// still what it says. Each is looked at once in a run.
    pub(super) fn current_record(
        &self,
        target: &Target,
        made_from: Digest,
    ) -> Option<OutputRecord> {
        let known = || self.current.lock().unwrap_or_else(PoisonError::into_inner);
        let found = known().get(&target.path).cloned();
        if found
            .as_ref()
            .is_some_and(|record| record.made_from == made_from)
        {
            return found;
        }
        let record = self.engine.output_record(&target.path)?;
        // Not under the lock: hashing uses the thread pool.
        if record.made_from != made_from || !record.files.iter().all(is_as_written) {
            return None;
        }
        known().insert(target.path.clone(), record.clone());
        Some(record)
    }

    /// Whether a result has to be written to any file.
    fn needs(&self, result: ResultRef, digest: Digest, provenance: Digest) -> bool {
        let mut takers = self.targets.iter().filter(|target| target.result == result);
        takers.any(|target| {
            let made_from = made_from(self.plan, target, digest, provenance);
            self.current_record(target, made_from).is_none()
        })
    }
}

/// The files of an output that is as it was written.
pub(super) fn found(target: &Target, record: &OutputRecord) -> Vec<WrittenOutput> {
    let files = record.files.iter();
    let mut found: Vec<_> = files
        .map(|file| WrittenOutput {
            bytes: file.bytes,
            ..target.file(Path::new(&file.path))
        })
        .collect();
    if let Some(last) = found.last_mut() {
        last.lost.clone_from(&record.lost);
    }
    found
}

/// The record of files that were just put where they are; none for paths that
/// are no UTF-8.
pub(super) fn record(
    made_from: Digest,
    files: &[(&Path, Put<Vec<String>>)],
    lost: Vec<String>,
) -> Option<OutputRecord> {
    let written = |(path, put): &(&Path, Put<Vec<String>>)| {
        Some(WrittenFile {
            path: path.to_str()?.to_owned(),
            bytes: put.bytes,
            digest: put.digest,
        })
    };
    let files = files.iter().map(written).collect::<Option<_>>()?;
    Some(OutputRecord {
        made_from,
        files,
        lost,
    })
}

/// Whether the file holds what was written to it.
fn is_as_written(written: &WrittenFile) -> bool {
    let Ok(mut file) = File::open(&written.path) else {
        return false;
    };
    let plain = file
        .metadata()
        .is_ok_and(|found| found.is_file() && found.len() == written.bytes);
    if !plain {
        return false;
    }
    let (mut hasher, mut rest) = (Hasher::new(), written.bytes);
    let mut buffer = vec![0; CHUNK.min(usize::try_from(rest).unwrap_or(CHUNK))];
    while rest > 0 {
        let part = &mut buffer[..CHUNK.min(usize::try_from(rest).unwrap_or(CHUNK))];
        if interrupt::is_requested() || file.read_exact(part).is_err() {
            return false;
        }
        hasher.bytes(part);
        rest -= part.len() as u64;
    }
    hasher.finish() == written.digest
}

/// An observer that knows which results no output needs.
pub(crate) struct OutputObserver<'a> {
    /// Is told everything else.
    pub(crate) inner: &'a dyn Observer,
    /// The outputs.
    pub(crate) outputs: &'a Outputs<'a>,
}

impl Observer for OutputObserver<'_> {
    fn needs(&self, result: ResultRef, digest: Digest, provenance: Digest) -> bool {
        self.outputs.needs(result, digest, provenance)
    }

    fn started(&self, node: usize) {
        self.inner.started(node);
    }

    fn progress(&self, node: usize, done: u64, total: u64) {
        self.inner.progress(node, done, total);
    }

    fn finished(&self, node: usize, run: &NodeRun) {
        self.inner.finished(node, run);
    }

    fn memory_left(&self) -> Option<u64> {
        self.inner.memory_left()
    }

    fn cancelled(&self) -> bool {
        self.inner.cancelled()
    }
}
