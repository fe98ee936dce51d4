//! Whole files: never devices, never more than wanted, never a mixture.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;
use std::time::SystemTime;

use crate::six_digits;

/// How often a file that changes while it is read is read again.
const ATTEMPTS: usize = 4;

/// The content of a plain file of at most `largest` bytes.
///
/// A file that is written while it is read is read again, so that the content is
/// the old one or the new one and no mixture, as far as its length and time tell.
///
/// # Errors
/// In words. Pipes and devices are refused: reading them might never end.
pub fn read_plain(path: &Path, largest: u64) -> Result<Vec<u8>, String> {
    for _ in 0..ATTEMPTS {
        if let Some(bytes) = read_once(path, largest)? {
            return Ok(bytes);
        }
    }
    Err("it changes while it is read; try again once it is written".to_owned())
}

/// `None` when the file changed meanwhile.
fn read_once(path: &Path, largest: u64) -> Result<Option<Vec<u8>>, String> {
    // Asked before opening: opening a pipe waits for its writer.
    plain_file(path)?;
    let mut file = File::open(path).map_err(words)?;
    let before = file.metadata().map_err(words)?;
    if before.len() > largest {
        return Err(too_large(before.len(), largest));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(before.len()).unwrap_or(0));
    // One byte more, so that a file that grows while it is read is noticed.
    (&mut file)
        .take(largest.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(words)?;
    let after = file.metadata().map_err(words)?;
    let whole = stamp(&before) == stamp(&after) && bytes.len() as u64 == after.len();
    // Files of the system have no length: what was read is what there is.
    Ok((whole || before.len() == 0).then_some(bytes))
}

/// Refuses, in words, what is there but no plain file, and what is not there.
pub(super) fn plain_file(path: &Path) -> Result<(), String> {
    let found = path.metadata().map_err(words)?;
    if found.is_dir() {
        return Err("it is a folder".to_owned());
    }
    if !found.is_file() {
        return Err("it is not a plain file".to_owned());
    }
    Ok(())
}

/// What a write to the file changes.
fn stamp(metadata: &Metadata) -> (u64, Option<SystemTime>) {
    (metadata.len(), metadata.modified().ok())
}

fn words(error: io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => error.to_string(),
    }
}

fn too_large(bytes: u64, largest: u64) -> String {
    let mega = |bytes: u64| six_digits(bytes as f64 / 1e6);
    format!(
        "it has {} MB, and at most {} MB are read",
        mega(bytes),
        mega(largest)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_files_of_some_size_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("f");
        std::fs::write(&file, b"12345").unwrap();
        assert_eq!(read_plain(&file, 5), Ok(b"12345".to_vec()));
        let refused = |path: &Path, largest| read_plain(path, largest).unwrap_err();
        assert_eq!(
            refused(&file, 4),
            "it has 5e-6 MB, and at most 4e-6 MB are read"
        );
        assert!(refused(folder.path(), 9).contains("folder"));
        assert!(refused(&folder.path().join("g"), 9).contains("no such file"));
        #[cfg(unix)]
        assert!(refused(Path::new("/dev/zero"), 9).contains("not a plain file"));
    }

    #[test]
    fn a_file_that_is_rewritten_all_the_time_is_never_a_mixture() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("f");
        let write = |k: u8| std::fs::write(&file, vec![k; 100_000 + usize::from(k)]).unwrap();
        write(0);
        let stop = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                for k in (1..=50).cycle() {
                    if stop.load(std::sync::atomic::Ordering::Relaxed) {
                        break;
                    }
                    write(k);
                }
            });
            for _ in 0..200 {
                let Ok(bytes) = read_plain(&file, u64::MAX) else {
                    continue;
                };
                assert!(bytes.iter().all(|byte| *byte == bytes[0]), "a mixture");
            }
            stop.store(true, std::sync::atomic::Ordering::Relaxed);
        });
    }
}
