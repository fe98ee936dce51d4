//! What is known about a node's results under one key.

use tessgraph_geometry::digest::{Digest, Hasher};

use crate::node::FileUse;
use crate::value::Value;
use crate::value::encode::{Decoder, Encoder};

/// Values up to this many bytes stand in the entry itself: numbers, reports.
pub(in crate::eval) const SMALL: usize = 2048;

/// What is known about a node's results under one key.
#[derive(Debug, Clone)]
pub(in crate::eval) struct Entry {
    /// Each result, in the order of the node's spec.
    pub(in crate::eval) results: Vec<Known>,
    /// Files found only while evaluating; a hit needs all of them unchanged.
    pub(in crate::eval) files: Vec<FileUse>,
    /// What the node warned of.
    pub(in crate::eval) warnings: Vec<String>,
    /// Milliseconds it took to compute.
    pub(in crate::eval) ms: f64,
    /// Bytes of all results in memory.
    pub(in crate::eval) bytes: u64,
}

/// What an entry knows about one result.
#[derive(Debug, Clone)]
pub(in crate::eval) struct Known {
    /// Tells it from all other results: by its content, or in a run without a
    /// cache by how it was made.
    pub(in crate::eval) identity: Digest,
    /// The value itself if it is small: an expression over a number needs no
    /// further file.
    pub(in crate::eval) small: Option<Value>,
}

impl Known {
    /// A result that is known by its content, so that equal ones are found equal.
    pub(in crate::eval) fn new(value: &Value) -> Self {
        Self {
            identity: value.digest(),
            small: is_small(value).then(|| value.clone()),
        }
    }

    /// A result that is not looked up anywhere: its provenance tells it apart as
    /// well, and nobody reads all of a large mesh for it.
    pub(in crate::eval) fn unread(value: &Value, provenance: Digest) -> Self {
        Self {
            identity: provenance,
            small: is_small(value).then(|| value.clone()),
        }
    }
}

/// The key of a node together with the contents of further files.
pub(in crate::eval) fn key_with_files(key: Digest, files: &[FileUse]) -> Digest {
    let mut hasher = Hasher::new();
    hasher.text("with files").digest(key);
    for file in files {
        hasher.number(file.input as u64).text(&file.relative);
        match file.content {
            Some(content) => hasher.number(1).digest(content),
            None => hasher.number(0),
        };
    }
    hasher.finish()
}

/// Whether the value is stored within its entry.
fn is_small(value: &Value) -> bool {
    match value {
        Value::Mesh(_) | Value::Directions(_) | Value::Field(_) | Value::Formula(_) => false,
        Value::Bool(_) | Value::Integer(_) | Value::Number(_) | Value::Vector(_) => true,
        Value::List(items) => items.len() <= 64 && items.iter().all(is_small),
        _ => {
            // Texts, reports and tables: writing them is cheap even if they turn
            // out to be too long.
            let mut out = Encoder::new();
            let (stored, (bytes, topologies)) = (value.encode(&mut out), out.finish());
            stored && topologies.is_empty() && bytes.len() <= SMALL
        }
    }
}

impl Entry {
    /// The keys that the entry is kept under. One that depends on further files
    /// has two: under the node's key stands the latest, which says what files
    /// these are, and under another each that there ever was, by their contents.
    pub(super) fn keys(&self, key: Digest) -> Vec<Digest> {
        if self.files.is_empty() {
            return vec![key];
        }
        vec![key, key_with_files(key, &self.files)]
    }

    /// Bytes that it takes in memory, about: what stands in it is small, and its texts
    /// and numbers take some times as much there as in a file.
    pub(super) fn weight(&self) -> usize {
        /// Of the entry itself and its place under its keys.
        const OVERHEAD: usize = 512;
        /// Measured for reports of ten lines.
        const TIMES: usize = 4;
        OVERHEAD + TIMES * self.encode().len()
    }

    /// The entry as bytes.
    pub(super) fn encode(&self) -> Vec<u8> {
        let mut out = Encoder::new();
        out.float(self.ms).number(self.bytes);
        out.number(self.results.len() as u64);
        for known in &self.results {
            out.digest(known.identity);
            out.byte(u8::from(known.small.is_some()));
            if let Some(value) = &known.small {
                value.encode(&mut out);
            }
        }
        out.number(self.files.len() as u64);
        for file in &self.files {
            out.number(file.input as u64).text(&file.relative);
            out.byte(u8::from(file.content.is_some()));
            if let Some(content) = file.content {
                out.digest(content);
            }
        }
        out.number(self.warnings.len() as u64);
        for warning in &self.warnings {
            out.text(warning);
        }
        out.finish().0
    }

    /// The entry that [`Entry::encode`] wrote.
    pub(super) fn decode(bytes: &[u8]) -> Option<Self> {
        let mut from = Decoder::new(bytes, &|_| None);
        let (ms, size) = (from.float()?, from.number()?);
        let count = from.count()?;
        let results: Option<_> = (0..count).map(|_| decode_known(&mut from)).collect();
        let count = from.count()?;
        let files: Option<_> = (0..count).map(|_| decode_file(&mut from)).collect();
        let count = from.count()?;
        let warnings: Option<_> = (0..count).map(|_| from.text().map(str::to_owned)).collect();
        let entry = Self {
            results: results?,
            files: files?,
            warnings: warnings?,
            ms,
            bytes: size,
        };
        from.finish(entry)
    }
}

fn decode_known(from: &mut Decoder<'_>) -> Option<Known> {
    let identity = from.digest()?;
    let small = match from.byte()? {
        0 => None,
        1 => Some(Value::decode(from)?),
        _ => return None,
    };
    Some(Known { identity, small })
}

fn decode_file(from: &mut Decoder<'_>) -> Option<FileUse> {
    let input = usize::try_from(from.number()?).ok()?;
    let relative = from.text()?.to_owned();
    let content = match from.byte()? {
        0 => None,
        1 => Some(from.digest()?),
        _ => return None,
    };
    Some(FileUse {
        input,
        relative,
        content,
    })
}
