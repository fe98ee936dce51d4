//! Writes a file whole or not at all.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use tessgraph_geometry::digest::{Digest, Hasher};

use crate::interrupt::{self, Temporary};

/// Bytes written, compared or hashed between two looks at whether to stop.
pub(crate) const CHUNK: usize = 4 << 20;

/// How often writing starts again when another process swept the temporary
/// file away in the moment between its making and its locking.
const ATTEMPTS: usize = 4;

/// What stands at a place now.
#[derive(Debug)]
pub(crate) struct Put<T> {
    /// Whether the file was replaced; if not, it held these bytes already.
    pub(crate) changed: bool,
    /// Its size.
    pub(crate) bytes: u64,
    /// The digest of its content, in chunks of [`CHUNK`].
    pub(crate) digest: Digest,
    /// What making it gave besides.
    pub(crate) made: T,
}

/// [`put_if_changed`] with bytes that are there; says whether it wrote.
pub(crate) fn write_if_changed(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    put_if_changed(path, |sink| sink.write_all(bytes)).map(|put| put.changed)
}

/// Puts what `make` writes at `path`, unless it is there already.
///
/// As long as the bytes are those of the old file, nothing is written. From the
/// first that differs on they go to a temporary file in the same folder, which
/// is flushed to the disk and takes the place of the old file in one step; then
/// the folder is flushed. Whatever happens in between, `path` is the old file
/// or the new one. Missing folders are made. A file with the same content keeps
/// its time. Temporary files that a killed process left for this path are
/// removed. No more than [`CHUNK`] bytes are held.
///
/// # Errors
/// What `make` says, and the file system; the old file is then untouched, unless
/// only the last flush failed. Also when the user asked to stop.
pub(crate) fn put_if_changed<T, E: From<io::Error>>(
    path: &Path,
    make: impl FnOnce(&mut dyn Write) -> Result<T, E>,
) -> Result<Put<T>, E> {
    let mut replacement = Replacement::new(path)?;
    let made = make(&mut replacement)?;
    let (changed, bytes, digest) = replacement.finish()?;
    Ok(Put {
        changed,
        bytes,
        digest,
        made,
    })
}

/// Takes the bytes of a file that will stand at a path.
struct Replacement<'p> {
    path: &'p Path,
    folder: &'p Path,
    prefix: String,
    /// Bytes that were taken and not yet compared or written.
    chunk: Vec<u8>,
    taken: u64,
    hasher: Hasher,
    stage: Stage,
}

/// What becomes of the bytes.
enum Stage {
    /// So many were those of the old file, which stands behind them.
    Same(File),
    /// None was written yet, and there is nothing to compare with.
    Nothing,
    Written(File, Temporary),
}

impl<'p> Replacement<'p> {
    fn new(path: &'p Path) -> io::Result<Self> {
        let folder = path.parent().unwrap_or(Path::new(""));
        make_folders(folder)?;
        let prefix = temporary_prefix(path);
        sweep(folder, &prefix);
        // A file that may be written but not read is simply replaced.
        let old = File::open(path).ok();
        Ok(Self {
            path,
            folder,
            prefix,
            chunk: Vec::new(),
            taken: 0,
            hasher: Hasher::new(),
            stage: old.map_or(Stage::Nothing, Stage::Same),
        })
    }

    /// Compares or writes what was taken.
    fn settle(&mut self) -> io::Result<()> {
        if interrupt::is_requested() {
            return Err(io::Error::other("stopped"));
        }
        if self.chunk.is_empty() {
            return Ok(());
        }
        self.hasher.bytes(&self.chunk);
        let is_same = match &mut self.stage {
            Stage::Same(old) => {
                let mut there = Vec::with_capacity(self.chunk.len());
                let read = old.take(self.chunk.len() as u64).read_to_end(&mut there);
                read.is_ok() && there == self.chunk
            }
            _ => false,
        };
        if !is_same {
            self.begin()?;
            if let Stage::Written(file, _) = &mut self.stage {
                file.write_all(&self.chunk)?;
            }
        }
        self.taken += self.chunk.len() as u64;
        self.chunk.clear();
        Ok(())
    }

    /// Begins to write, with the bytes that were the same so far.
    fn begin(&mut self) -> io::Result<()> {
        let old = match std::mem::replace(&mut self.stage, Stage::Nothing) {
            written @ Stage::Written(..) => {
                self.stage = written;
                return Ok(());
            }
            Stage::Nothing => None,
            Stage::Same(old) => Some(old),
        };
        let (mut file, temporary) = self.temporary()?;
        if let Ok(old) = fs::metadata(self.path) {
            file.set_permissions(old.permissions())?;
        }
        if let Some(mut old) = old {
            old.rewind()?;
            if io::copy(&mut old.take(self.taken), &mut file)? != self.taken {
                let message = "the file was changed while it was compared; run again";
                return Err(io::Error::other(message));
            }
        }
        self.stage = Stage::Written(file, temporary);
        Ok(())
    }

    /// A new locked file beside the path.
    fn temporary(&self) -> io::Result<(File, Temporary)> {
        static SERIAL: AtomicU64 = AtomicU64::new(0);
        for attempt in 1.. {
            let serial = SERIAL.fetch_add(1, Ordering::Relaxed);
            let name = format!("{}{}-{serial}.tmp", self.prefix, std::process::id());
            let temporary = Temporary::register(self.folder.join(name));
            let file = OpenOptions::new()
                .write(true)
                .create_new(true)
                .open(temporary.path())?;
            // No locks on this file system: then nobody sweeps there either. A
            // sweeper that has it is about to remove it, or already has.
            let is_swept = matches!(file.try_lock(), Err(TryLockError::WouldBlock))
                || !temporary.path().exists();
            if !is_swept {
                return Ok((file, temporary));
            }
            if attempt == ATTEMPTS {
                break;
            }
        }
        Err(io::ErrorKind::NotFound.into())
    }

    /// Puts the file in its place, if it is another than stands there: whether it
    /// is, its size, and the digest of its content.
    fn finish(mut self) -> io::Result<(bool, u64, Digest)> {
        self.settle()?;
        let is_there = match &self.stage {
            Stage::Same(old) => old.metadata()?.len() == self.taken,
            _ => false,
        };
        if !is_there {
            self.begin()?;
            if let Stage::Written(file, temporary) = &self.stage {
                file.sync_all()?;
                fs::rename(temporary.path(), self.path)?;
            }
            flush_folder(self.folder)?;
        }
        Ok((!is_there, self.taken, self.hasher.finish()))
    }
}

impl Write for Replacement<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(CHUNK - self.chunk.len());
        self.chunk.extend_from_slice(&bytes[..taken]);
        if self.chunk.len() == CHUNK {
            self.settle()?;
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// How names of temporary files for `path` begin. It is short whatever the
/// name is, so that any name the file system takes can be written.
fn temporary_prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    let digest = Digest::of(name.as_encoded_bytes()).to_string();
    format!(".tessgraph-{}-", &digest[..16.min(digest.len())])
}

/// Removes what killed processes left: a living one holds its file's lock.
fn sweep(folder: &Path, prefix: &str) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        if !entry
            .file_name()
            .as_encoded_bytes()
            .starts_with(prefix.as_bytes())
        {
            continue;
        }
        let path = entry.path();
        if File::open(&path).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(&path);
        }
    }
}

/// Makes `folder` and what is missing above it, and flushes their entries.
fn make_folders(folder: &Path) -> io::Result<()> {
    let missing: Vec<PathBuf> = folder
        .ancestors()
        .take_while(|path| !path.exists())
        .map(Path::to_path_buf)
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    fs::create_dir_all(folder)?;
    missing
        .iter()
        .filter_map(|path| path.parent())
        .try_for_each(flush_folder)
}

/// Makes the entries of a folder survive a power failure, where folders can be
/// flushed at all.
fn flush_folder(folder: &Path) -> io::Result<()> {
    if !cfg!(unix) {
        return Ok(());
    }
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
        // A folder that may be written to but not listed cannot be opened.
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => Ok(()),
        result => result,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name());
        let mut names: Vec<_> = entries.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn content(path: &Path) -> Vec<u8> {
        let mut bytes = Vec::new();
        File::open(path).unwrap().read_to_end(&mut bytes).unwrap();
        bytes
    }

    #[test]
    fn makes_folders_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b/c.txt");
        assert!(write_if_changed(&path, b"one").unwrap());
        assert!(write_if_changed(&path, b"two").unwrap());
        assert_eq!(content(&path), b"two");
        assert_eq!(names(&folder.path().join("a/b")), ["c.txt"]);
    }

    #[test]
    fn the_same_content_keeps_the_files_time() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let bytes = vec![7; CHUNK + 3];
        assert!(write_if_changed(&path, &bytes).unwrap());
        let time = fs::metadata(&path).unwrap().modified().unwrap();
        assert!(!write_if_changed(&path, &bytes).unwrap());
        assert_eq!(fs::metadata(&path).unwrap().modified().unwrap(), time);
        let mut other = bytes;
        other[CHUNK + 1] = 8;
        assert!(write_if_changed(&path, &other).unwrap());
    }

    #[test]
    fn what_is_the_same_at_first_is_kept_and_the_rest_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let of = |count: usize| (0..count).map(|k| (k % 251) as u8).collect::<Vec<u8>>();
        let mut edited = of(3 * CHUNK);
        edited[2 * CHUNK + 7] ^= 1;
        // Longer, shorter, changed late, ending with a chunk, empty, and again.
        let contents = [
            of(5),
            of(2 * CHUNK),
            of(2 * CHUNK + 1),
            of(3 * CHUNK),
            edited,
        ];
        for content in contents.iter().chain([&of(CHUNK), &Vec::new(), &of(9)]) {
            let put = put_if_changed::<_, io::Error>(&path, |sink| {
                content
                    .chunks(100_003)
                    .try_for_each(|part| sink.write_all(part))
            });
            let put = put.unwrap();
            assert!(put.changed);
            assert_eq!(put.bytes, content.len() as u64);
            assert_eq!(super::tests::content(&path), *content);
            let again = put_if_changed::<_, io::Error>(&path, |sink| sink.write_all(content));
            let again = again.unwrap();
            assert!(!again.changed);
            assert_eq!(again.digest, put.digest);
        }
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn what_cannot_be_made_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, b"old").unwrap();
        let failed = put_if_changed::<(), io::Error>(&path, |sink| {
            sink.write_all(&vec![1; CHUNK + 1])?;
            Err(io::Error::other("no more"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "no more");
        assert_eq!(content(&path), b"old");
        assert_eq!(names(folder.path()), ["a"]);
    }

    #[test]
    fn long_names_and_leftovers_are_no_obstacle() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x".repeat(255));
        let stale = format!("{}999999-0.tmp", temporary_prefix(&path));
        fs::write(folder.path().join(stale), b"half").unwrap();
        let living = folder
            .path()
            .join(format!("{}1-0.tmp", temporary_prefix(&path)));
        let held = File::create(&living).unwrap();
        held.lock().unwrap();
        assert!(write_if_changed(&path, b"whole").unwrap());
        let left = names(folder.path());
        assert_eq!(left.len(), 2, "{left:?}");
        assert!(living.exists());
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_no_temporary() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken");
        fs::create_dir_all(path.join("inner")).unwrap();
        assert!(write_if_changed(&path, b"x").is_err());
        assert_eq!(names(folder.path()), ["taken"]);
        let below_a_file = folder.path().join("file/x");
        fs::write(folder.path().join("file"), b"").unwrap();
        assert!(write_if_changed(&below_a_file, b"x").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn permissions_of_the_old_file_stay() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        write_if_changed(&path, b"1").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        write_if_changed(&path, b"2").unwrap();
        assert_eq!(
            fs::metadata(&path).unwrap().permissions().mode() & 0o777,
            0o640
        );
    }
}
