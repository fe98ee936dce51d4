//! Writes a file whole or not at all.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use tessgraph_geometry::digest::Digest;

use crate::interrupt::{self, Temporary};

/// Bytes written or compared between two looks at whether to stop.
const CHUNK: usize = 4 << 20;

/// How often writing starts again when another process swept the temporary
/// file away in the moment between its making and its locking.
const ATTEMPTS: usize = 4;

/// Puts `bytes` at `path`, unless they are there already; says whether it wrote.
///
/// The bytes go to a temporary file in the same folder, are flushed to the
/// disk, take the place of the old file in one step, and the folder is flushed.
/// Whatever happens in between, `path` is the old file or the new one. Missing
/// folders are made. A file with the same content keeps its time. Temporary
/// files that a killed process left for this path are removed.
///
/// # Errors
/// Whatever the file system says; the old file is then untouched, unless only
/// the last flush failed. `Interrupted` when the user asked to stop.
pub(crate) fn write_if_changed(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    let folder = path.parent().unwrap_or(Path::new(""));
    make_folders(folder)?;
    let prefix = temporary_prefix(path);
    sweep(folder, &prefix);
    if has_content(path, bytes)? {
        return Ok(false);
    }
    for attempt in 1.. {
        match replace(path, folder, &prefix, bytes) {
            Err(error) if error.kind() == io::ErrorKind::NotFound && attempt < ATTEMPTS => {}
            Err(error) => return Err(error),
            Ok(()) => break,
        }
    }
    flush_folder(folder)?;
    Ok(true)
}

/// Whether the file at `path` holds exactly `bytes`.
fn has_content(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    // A file that may be written but not read is simply replaced.
    let Ok(mut file) = File::open(path) else {
        return Ok(false);
    };
    if file.metadata()?.len() != bytes.len() as u64 {
        return Ok(false);
    }
    let mut buffer = vec![0; CHUNK.min(bytes.len())];
    for chunk in bytes.chunks(CHUNK) {
        let part = &mut buffer[..chunk.len()];
        if file.read_exact(part).is_err() || part != chunk {
            return Ok(false);
        }
        check_interrupt()?;
    }
    Ok(true)
}

fn replace(path: &Path, folder: &Path, prefix: &str, bytes: &[u8]) -> io::Result<()> {
    static SERIAL: AtomicU64 = AtomicU64::new(0);
    let serial = SERIAL.fetch_add(1, Ordering::Relaxed);
    let name = format!("{prefix}{}-{serial}.tmp", std::process::id());
    let temporary = Temporary::register(folder.join(name));
    let mut file = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(temporary.path())?;
    match file.try_lock() {
        // A sweeper has it, and is about to remove it.
        Err(TryLockError::WouldBlock) => return Err(io::ErrorKind::NotFound.into()),
        // No locks on this file system: then nobody sweeps there either.
        Err(TryLockError::Error(_)) | Ok(()) => {}
    }
    if let Ok(old) = fs::metadata(path) {
        file.set_permissions(old.permissions())?;
    }
    for chunk in bytes.chunks(CHUNK) {
        check_interrupt()?;
        file.write_all(chunk)?;
    }
    file.sync_all()?;
    fs::rename(temporary.path(), path)
}

fn check_interrupt() -> io::Result<()> {
    if interrupt::is_requested() {
        Err(io::ErrorKind::Interrupted.into())
    } else {
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
