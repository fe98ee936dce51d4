//! What is in a file, as a digest.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use tessgraph_geometry::digest::{Digest, Hasher};

/// Bytes fed at a time: few enough to be hashed on this thread alone, so that
/// the pool that computes is left in peace.
const CHUNK: usize = 64 << 10;

/// The digest of bytes that were read.
pub(super) fn of_bytes(bytes: &[u8]) -> Digest {
    let mut hasher = Hasher::new();
    bytes.chunks(CHUNK).for_each(|chunk| {
        hasher.bytes(chunk);
    });
    hasher.finish()
}

/// The same of a file; `None` unless there is a plain file that can be read.
pub(super) fn of_file(path: &Path) -> Option<Digest> {
    // Asked before opening: opening a pipe waits for its writer.
    if !path.metadata().ok()?.is_file() {
        return None;
    }
    let mut file = File::open(path).ok()?;
    let (mut hasher, mut chunk) = (Hasher::new(), Vec::with_capacity(CHUNK));
    loop {
        chunk.clear();
        let most = CHUNK as u64;
        (&mut file).take(most).read_to_end(&mut chunk).ok()?;
        if chunk.is_empty() {
            return Some(hasher.finish());
        }
        hasher.bytes(&chunk);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_and_bytes_agree_at_any_length() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f");
        for length in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 3 * CHUNK] {
            let bytes: Vec<u8> = (0..length).map(|index| (index % 251) as u8).collect();
            std::fs::write(&path, &bytes).unwrap();
            assert_eq!(of_file(&path), Some(of_bytes(&bytes)), "{length}");
        }
        assert_ne!(of_bytes(b"a"), of_bytes(b"b"));
        assert_eq!(of_file(folder.path()), None);
        assert_eq!(of_file(&folder.path().join("g")), None);
    }
}
