//! The cache on disk: plain files named by content, shared without locks.
//!
//! A file is written under a temporary name, synced, and renamed, so that
//! readers see all of it or nothing. Its name says what must be in it, and a
//! checksum over everything says whether it is. One that is damaged, cut,
//! swapped or of another format is removed and counts as missing. One small
//! file per key, rather than an index: 50 of them are read in under a
//! millisecond, and processes that share the folder need not agree on anything.

use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher as _, RandomState};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use tessgraph_geometry::digest::Digest;

use super::frame::{self, FORMAT, FileKind};

/// Tells backup programs that the folder can be rebuilt, and us what is in it.
const TAG_FILE: &str = "CACHEDIR.TAG";
const TAG_BEGIN: &str = "Signature: 8a477f597d28d172789f06886806bc55\n# tessgraph cache, format ";

/// Temporary files begin with this.
pub(super) const TEMPORARY: &str = ".new-";

/// A file used again after this time is marked as used, so that `gc` keeps it.
const REFRESH: Duration = Duration::from_secs(6 * 3600);

/// Bytes of files the folder is kept to unless another budget is asked for.
const BUDGET: u64 = 20_000_000_000;

/// How long a folder goes without a look at its size.
const SWEEP: Duration = Duration::from_secs(3600);

/// A folder of cache files.
#[derive(Debug)]
pub(super) struct Disk {
    root: PathBuf,
    budget: AtomicU64,
    written: AtomicU64,
    writable: AtomicBool,
    warning: Mutex<Option<String>>,
}

impl Disk {
    /// The cache in `root`, made if it is missing.
    ///
    /// # Errors
    /// Why it cannot be used, as a sentence.
    pub(super) fn open(root: &Path) -> Result<Self, String> {
        let unusable = |reason: String| {
            format!(
                "the cache folder {} cannot be used: {reason}",
                root.display()
            )
        };
        fs::create_dir_all(root).map_err(|error| unusable(error.to_string()))?;
        let disk = Self {
            root: root.to_owned(),
            budget: AtomicU64::new(BUDGET),
            written: AtomicU64::new(0),
            writable: AtomicBool::new(true),
            warning: Mutex::default(),
        };
        let tag = format!("{TAG_BEGIN}{FORMAT}\n");
        match read_file(&root.join(TAG_FILE)) {
            Ok(found) if found == tag.as_bytes() => {}
            // A tag that was cut short is written again.
            Ok(found) if !tag.as_bytes().starts_with(&found) => {
                return Err(unusable("another version of tessgraph made it".to_owned()));
            }
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(unusable(error.to_string()));
            }
            _ => disk.keep(disk.replace(&root.join(TAG_FILE), &[tag.as_bytes()], true)),
        }
        Ok(disk)
    }

    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    /// Sets the bytes that the folder is kept to.
    pub(super) fn set_budget(&self, bytes: u64) {
        self.budget.store(bytes, Ordering::Relaxed);
    }

    /// The budget, if it is time to look whether the folder keeps to it: when
    /// nobody did for an hour, or this process has written an eighth of it.
    /// Asking counts as looking.
    pub(super) fn due_budget(&self) -> Option<u64> {
        if !self.writable.load(Ordering::Relaxed) {
            return None;
        }
        let budget = self.budget.load(Ordering::Relaxed);
        let tag = self.root.join(TAG_FILE);
        let much = self.written.load(Ordering::Relaxed) > budget / 8;
        // The tag's time says when somebody looked.
        let recent = || fs::metadata(&tag).is_ok_and(|found| age(&found) < SWEEP);
        if !much && recent() {
            return None;
        }
        self.written.store(0, Ordering::Relaxed);
        refresh(&tag, Duration::ZERO);
        Some(budget)
    }

    /// Why nothing is written any more, if that is so.
    pub(super) fn warning(&self) -> Option<String> {
        lock(&self.warning).clone()
    }

    /// Where the file of this kind and address is.
    pub(super) fn path(&self, kind: FileKind, address: Digest) -> PathBuf {
        let name = address.to_string();
        let (folder, rest) = name.split_at(2);
        self.root.join(kind.folder()).join(folder).join(rest)
    }

    /// What `decode` makes of the content of that file. A file that is damaged
    /// or not understood is removed.
    pub(super) fn read<T>(
        &self,
        kind: FileKind,
        address: Digest,
        decode: impl FnOnce(&[u8]) -> Option<T>,
    ) -> Option<T> {
        let path = self.path(kind, address);
        let file = match read_file(&path) {
            Ok(file) => file,
            Err(_) => return None,
        };
        let value = frame::content(kind, address, &file).and_then(decode);
        match value {
            Some(_) => refresh(&path, REFRESH),
            None => self.remove(kind, address),
        }
        value
    }

    /// Writes a file; a failure is remembered and stops further writing.
    pub(super) fn write(&self, kind: FileKind, address: Digest, cost: f64, content: &[u8]) {
        if self.writable.load(Ordering::Relaxed) {
            let header = frame::header(kind, address, cost, content);
            let bytes = (header.len() + content.len()) as u64;
            self.written.fetch_add(bytes, Ordering::Relaxed);
            let path = self.path(kind, address);
            self.keep(self.replace(&path, &[&header, content], kind.is_lasting()));
        }
    }

    /// Whether there is a file of that kind and address, whatever is in it.
    pub(super) fn has(&self, kind: FileKind, address: Digest) -> bool {
        self.path(kind, address).is_file()
    }

    pub(super) fn remove(&self, kind: FileKind, address: Digest) {
        // If it cannot be removed it is met and refused again, no more.
        let _ = fs::remove_file(self.path(kind, address));
    }

    fn keep(&self, result: io::Result<()>) {
        if let Err(error) = result {
            self.writable.store(false, Ordering::Relaxed);
            let folder = self.root.display();
            lock(&self.warning).get_or_insert_with(|| {
                format!("results are not kept for later: cannot write to {folder}: {error}")
            });
        }
    }

    /// Writes `parts` to `path` so that it holds all of them or what it held; after
    /// a power cut too if it is `lasting`.
    fn replace(&self, path: &Path, parts: &[&[u8]], lasting: bool) -> io::Result<()> {
        let folder = path.parent().unwrap_or(&self.root);
        let temporary = folder.join(temporary_name());
        let attempt = || {
            let mut file = File::options()
                .write(true)
                .create_new(true)
                .open(&temporary)?;
            parts.iter().try_for_each(|part| file.write_all(part))?;
            if lasting {
                file.sync_all()?;
            }
            fs::rename(&temporary, path)
        };
        let result = match attempt() {
            // The folder is missing at first, or was removed in the middle.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                fs::create_dir_all(folder).and_then(|()| attempt())
            }
            result => result,
        };
        if result.is_err() {
            let _ = fs::remove_file(&temporary);
        }
        result
    }
}

/// A name that no other process or thread chooses.
fn temporary_name() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let random = RandomState::new().build_hasher().finish();
    format!("{TEMPORARY}{}-{count}-{random:016x}", std::process::id())
}

/// The whole content of a file.
pub(super) fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let mut bytes = Vec::with_capacity(file.metadata()?.len() as usize);
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// How long ago the file was written or used.
pub(super) fn age(metadata: &fs::Metadata) -> Duration {
    #[allow(
        clippy::disallowed_methods,
        reason = "decides what is kept, never a result"
    )]
    let now = SystemTime::now();
    metadata
        .modified()
        .ok()
        .and_then(|then| now.duration_since(then).ok())
        .unwrap_or_default()
}

/// Marks a file as used just now if that has not been done for so long.
fn refresh(path: &Path, after: Duration) {
    let old = fs::metadata(path).is_ok_and(|metadata| age(&metadata) > after);
    if old && let Ok(file) = File::options().write(true).open(path) {
        #[allow(
            clippy::disallowed_methods,
            reason = "decides what is kept, never a result"
        )]
        let now = SystemTime::now();
        // A folder that cannot be written to is not cleaned up either.
        let _ = file.set_modified(now);
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
