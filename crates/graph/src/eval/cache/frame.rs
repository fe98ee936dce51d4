//! What stands round the content of every file of the disk cache.

use tessgraph_geometry::digest::Digest;

/// Raised whenever the content of cache files changes its form. Files of
/// another number are removed when they are met.
pub(super) const FORMAT: u32 = 1;

const MAGIC: &[u8; 8] = b"TESSGRPH";

/// Magic, format, kind, address, length, cost, checksum.
pub(super) const HEADER: usize = 8 + 4 + 4 + 16 + 8 + 8 + CHECKSUM;

const CHECKSUM: usize = 32;

/// What a cache file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::eval) enum FileKind {
    /// What is known about a node under a key.
    Entry,
    /// A value under its digest.
    Value,
    /// A topology under its digest.
    Topology,
    /// The keys of a graph's last run.
    LastRun,
    /// What an output file was last written from.
    Output,
}

impl FileKind {
    pub(super) const ALL: [Self; 5] = [
        Self::Entry,
        Self::Value,
        Self::Topology,
        Self::LastRun,
        Self::Output,
    ];

    /// The folder its files are in.
    pub(super) fn folder(self) -> &'static str {
        match self {
            Self::Entry => "entries",
            Self::Value => "values",
            Self::Topology => "topologies",
            Self::LastRun => "runs",
            Self::Output => "outputs",
        }
    }

    /// Whether a file must outlast a power cut. What is known of the last run is
    /// waited for in every run, and without it nothing but an explanation is lost.
    pub(super) fn is_lasting(self) -> bool {
        self != Self::LastRun
    }

    fn tag(self) -> u32 {
        match self {
            Self::Entry => 1,
            Self::Value => 2,
            Self::Topology => 3,
            Self::LastRun => 4,
            Self::Output => 5,
        }
    }
}

/// The header of a file with this content. `cost` is the milliseconds it took
/// to compute, for deciding what to remove first.
///
/// Stays on its thread: those of the pool may all be waiting for the thread
/// that writes.
pub(super) fn header(kind: FileKind, address: Digest, cost: f64, content: &[u8]) -> [u8; HEADER] {
    let mut header = [0; HEADER];
    let mut fill = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    fill(0, MAGIC);
    fill(8, &FORMAT.to_le_bytes());
    fill(12, &kind.tag().to_le_bytes());
    fill(16, address.as_bytes());
    fill(32, &(content.len() as u64).to_le_bytes());
    fill(40, &cost.to_bits().to_le_bytes());
    let mut hasher = blake3::Hasher::new();
    hasher.update(&header[..HEADER - CHECKSUM]).update(content);
    let sum = hasher.finalize();
    header[HEADER - CHECKSUM..].copy_from_slice(sum.as_bytes());
    header
}

/// The content of a file that must be of this kind and address; `None` if
/// anything about it is wrong.
pub(super) fn content(kind: FileKind, address: Digest, file: &[u8]) -> Option<&[u8]> {
    let (header, content) = file.split_at_checked(HEADER)?;
    let right = header[..8] == *MAGIC
        && header[8..12] == FORMAT.to_le_bytes()
        && header[12..16] == kind.tag().to_le_bytes()
        && header[16..32] == *address.as_bytes()
        && header[32..40] == (content.len() as u64).to_le_bytes();
    let (fields, sum) = header.split_at(HEADER - CHECKSUM);
    (right && checksum(fields, content).as_bytes() == sum).then_some(content)
}

/// The cost in a header; 0 if there is none.
pub(super) fn cost(header: &[u8]) -> f64 {
    let bytes = header.get(40..48).and_then(|bytes| bytes.try_into().ok());
    let cost = bytes.map_or(0.0, |bytes| f64::from_bits(u64::from_le_bytes(bytes)));
    if cost.is_finite() { cost.max(0.0) } else { 0.0 }
}

/// The checksum of a file that was read, on all threads if it is large.
fn checksum(fields: &[u8], content: &[u8]) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    hasher.update(fields);
    if content.len() >= 128 * 1024 {
        hasher.update_rayon(content);
    } else {
        hasher.update(content);
    }
    hasher.finalize()
}
