//! What an output file was last written from, so that one that is still the
//! same need not be made again, and its value not even be loaded.

use std::path::Path;

use tessgraph_geometry::digest::{Digest, Hasher};

use super::cache::{Cache, FileKind};
use crate::value::encode::{Decoder, Encoder};

/// How an output was written. It need not be written again while `made_from`
/// and the files themselves still agree.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputRecord {
    /// Digest of everything that the bytes depend on: the value, the format and
    /// the version of its writer, units.
    pub made_from: Digest,
    /// The files that were written.
    pub files: Vec<WrittenFile>,
    /// What the format could not hold, to be said again.
    pub lost: Vec<String>,
}

/// A file of an output as it was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenFile {
    /// Its path.
    pub path: String,
    /// Its length.
    pub bytes: u64,
    /// Digest of its content.
    pub digest: Digest,
}

pub(super) fn find(cache: &Cache, path: &Path) -> Option<OutputRecord> {
    cache.record(FileKind::Output, address(path), OutputRecord::decode)
}

pub(super) fn keep(cache: &Cache, path: &Path, record: &OutputRecord) {
    cache.set_record(FileKind::Output, address(path), &record.encode());
}

fn address(path: &Path) -> Digest {
    let path = path.as_os_str().as_encoded_bytes();
    Hasher::new().text("output").bytes(path).finish()
}

impl OutputRecord {
    fn encode(&self) -> Vec<u8> {
        let mut out = Encoder::new();
        out.digest(self.made_from).number(self.files.len() as u64);
        for file in &self.files {
            out.text(&file.path).number(file.bytes).digest(file.digest);
        }
        out.number(self.lost.len() as u64);
        for lost in &self.lost {
            out.text(lost);
        }
        out.finish().0
    }

    fn decode(bytes: &[u8]) -> Option<Self> {
        let mut from = Decoder::new(bytes, &|_| None);
        let made_from = from.digest()?;
        let count = from.count()?;
        let file = |from: &mut Decoder<'_>| {
            Some(WrittenFile {
                path: from.text()?.to_owned(),
                bytes: from.number()?,
                digest: from.digest()?,
            })
        };
        let files: Option<_> = (0..count).map(|_| file(&mut from)).collect();
        let count = from.count()?;
        let lost: Option<_> = (0..count).map(|_| from.text().map(str::to_owned)).collect();
        let record = Self {
            made_from,
            files: files?,
            lost: lost?,
        };
        from.finish(record)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_read_back_and_nothing_else_is() {
        let file = |path: &str, bytes| WrittenFile {
            path: path.to_owned(),
            bytes,
            digest: Digest::of(path.as_bytes()),
        };
        let record = OutputRecord {
            made_from: Digest::of(b"all"),
            files: vec![file("/a/é.mtl", 0), file("/a/é.obj", u64::MAX)],
            lost: vec!["the attribute `x`".to_owned()],
        };
        let bytes = record.encode();
        assert_eq!(OutputRecord::decode(&bytes), Some(record));
        for length in 0..bytes.len() {
            assert_eq!(OutputRecord::decode(&bytes[..length]), None);
        }
    }
}
