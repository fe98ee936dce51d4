//! Looking after a cache folder: how much there is, what to remove, what is
//! damaged.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use tessgraph_geometry::digest::Digest;

use super::disk::{self, Disk, TEMPORARY};
use super::frame::{self, FileKind, HEADER};

/// Temporary files older than this were left behind by a killed process.
const ABANDONED: Duration = Duration::from_secs(3600);

/// A cache folder, to be looked after; other processes may use it meanwhile.
#[derive(Debug)]
pub struct CacheFolder {
    disk: Arc<Disk>,
}

/// What a cache folder holds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FolderStats {
    /// Nodes' results known by key.
    pub entries: usize,
    /// Values and topologies.
    pub values: usize,
    /// Bytes of all files.
    pub bytes: u64,
}

/// What a clean-up removed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct GcReport {
    /// Files removed.
    pub removed: usize,
    /// Their bytes.
    pub removed_bytes: u64,
    /// Bytes that are left.
    pub kept_bytes: u64,
}

/// What a check of every file found.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VerifyReport {
    /// Files looked at.
    pub checked: usize,
    /// Files that were damaged; they have been removed.
    pub damaged: Vec<PathBuf>,
}

/// A file of the cache.
struct Found {
    path: PathBuf,
    kind: FileKind,
    address: Option<Digest>,
    bytes: u64,
    age: Duration,
}

impl CacheFolder {
    /// The cache in `folder`, made if it is missing.
    ///
    /// # Errors
    /// Why it cannot be used, as a sentence.
    pub fn open(folder: &Path) -> Result<Self, String> {
        Disk::open(folder).map(|disk| Self::of(&Arc::new(disk)))
    }

    /// The folder that an engine uses.
    pub(super) fn of(disk: &Arc<Disk>) -> Self {
        let disk = Arc::clone(disk);
        Self { disk }
    }

    /// What the folder holds. Cost: a look at every file's metadata.
    pub fn stats(&self) -> FolderStats {
        let mut stats = FolderStats::default();
        for file in self.files() {
            stats.bytes += file.bytes;
            match file.kind {
                FileKind::Entry => stats.entries += 1,
                FileKind::Value | FileKind::Topology => stats.values += 1,
                FileKind::LastRun | FileKind::Output => {}
            }
        }
        stats
    }

    /// Removes files until at most `max_bytes` are left: first what was used
    /// long ago, is large, and was quick to compute. Abandoned temporary files
    /// always go. Safe while other processes use the folder: what they miss
    /// they compute again.
    pub fn gc(&self, max_bytes: u64) -> GcReport {
        let mut report = GcReport::default();
        let (temporary, files): (Vec<_>, Vec<_>) =
            self.files().into_iter().partition(Found::is_temporary);
        for file in temporary.iter().filter(|file| file.age > ABANDONED) {
            report.remove(file);
        }
        let mut bytes: u64 = files.iter().map(|file| file.bytes).sum();
        let mut ranked: Vec<(f64, Found)> =
            files.into_iter().map(|file| (file.worth(), file)).collect();
        ranked.sort_by(|(a, left), (b, right)| {
            a.total_cmp(b).then_with(|| left.path.cmp(&right.path))
        });
        for (_, file) in ranked {
            if bytes <= max_bytes {
                break;
            }
            if report.remove(&file) {
                bytes -= file.bytes;
            }
        }
        report.kept_bytes = bytes;
        report
    }

    /// Reads every file and removes those that are damaged.
    pub fn verify(&self) -> VerifyReport {
        let mut report = VerifyReport::default();
        for file in self.files() {
            if file.is_temporary() {
                continue;
            }
            // A file that is gone by now was removed by another process.
            let Ok(bytes) = disk::read_file(&file.path) else {
                continue;
            };
            report.checked += 1;
            let right = file
                .address
                .is_some_and(|address| frame::content(file.kind, address, &bytes).is_some());
            if !right {
                let _ = fs::remove_file(&file.path);
                report.damaged.push(file.path);
            }
        }
        report
    }

    /// All files in the order of their names.
    fn files(&self) -> Vec<Found> {
        let mut files = Vec::new();
        for kind in FileKind::ALL {
            for folder in children(&self.disk.root().join(kind.folder())) {
                files.extend(children(&folder).into_iter().filter_map(|path| {
                    let metadata = path.metadata().ok()?;
                    metadata.is_file().then(|| Found {
                        address: address_of(&path),
                        kind,
                        bytes: metadata.len(),
                        age: disk::age(&metadata),
                        path,
                    })
                }));
            }
        }
        files
    }
}

impl GcReport {
    fn remove(&mut self, file: &Found) -> bool {
        let removed = fs::remove_file(&file.path).is_ok();
        if removed {
            self.removed += 1;
            self.removed_bytes += file.bytes;
        }
        removed
    }
}

impl Found {
    fn is_temporary(&self) -> bool {
        let name = self.path.file_name().and_then(|name| name.to_str());
        name.is_some_and(|name| name.starts_with(TEMPORARY))
    }

    /// Milliseconds saved per byte, less by the hour. Entries cost next to
    /// nothing to keep and say what need not be computed, so only values that
    /// took a second per kilobyte rank above them.
    fn worth(&self) -> f64 {
        let hours = self.age.as_secs_f64() / 3600.0;
        let mut header = [0; HEADER];
        let cost = fs::File::open(&self.path)
            .and_then(|mut file| file.read_exact(&mut header))
            .map_or(0.0, |()| frame::cost(&header));
        let least = if self.kind == FileKind::Entry {
            1000.0
        } else {
            0.01
        };
        (cost + least) / (self.bytes.max(1) as f64 * (1.0 + hours))
    }
}

/// What is in a folder, by name; nothing if it cannot be read.
fn children(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

/// The address that a file's folder and name spell.
fn address_of(path: &Path) -> Option<Digest> {
    let name = path.file_name()?.to_str()?;
    let folder = path.parent()?.file_name()?.to_str()?;
    let digits = format!("{folder}{name}");
    if digits.len() != 32 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return None;
    }
    let mut bytes = [0; 16];
    for (index, byte) in bytes.iter_mut().enumerate() {
        *byte = u8::from_str_radix(&digits[2 * index..2 * index + 2], 16).ok()?;
    }
    Some(Digest::from_bytes(bytes))
}
