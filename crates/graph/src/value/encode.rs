//! Values as bytes, for the cache on disk: little-endian, self-contained
//! except for topologies, which are named by digest and stored apart.

use std::sync::Arc;

use bytemuck::Pod;
use glam::{DVec2, DVec3};
use tessgraph_geometry::Topology;
use tessgraph_geometry::digest::Digest;

/// Lists nested deeper than this are not decoded; no node makes such lists.
const MAX_DEPTH: usize = 16;

/// Collects a value's bytes.
#[derive(Debug, Default)]
pub struct Encoder {
    bytes: Vec<u8>,
    topologies: Vec<Arc<Topology>>,
}

/// An element of an array, made of words of equal size.
pub trait Element: Pod {
    /// Bytes of one word.
    const WORD: usize;
}

impl Element for u32 {
    const WORD: usize = 4;
}

impl Element for i64 {
    const WORD: usize = 8;
}

impl Element for f64 {
    const WORD: usize = 8;
}

impl Element for DVec2 {
    const WORD: usize = 8;
}

impl Element for DVec3 {
    const WORD: usize = 8;
}

impl Encoder {
    /// An encoder that holds nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one byte.
    pub fn byte(&mut self, byte: u8) -> &mut Self {
        self.bytes.push(byte);
        self
    }

    /// Adds an integer.
    pub fn number(&mut self, number: u64) -> &mut Self {
        self.bytes.extend_from_slice(&number.to_le_bytes());
        self
    }

    /// Adds a float by its bits.
    pub fn float(&mut self, number: f64) -> &mut Self {
        self.number(number.to_bits())
    }

    /// Adds a text with its length.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.number(text.len() as u64);
        self.bytes.extend_from_slice(text.as_bytes());
        self
    }

    /// Adds a digest.
    pub fn digest(&mut self, digest: Digest) -> &mut Self {
        self.bytes.extend_from_slice(digest.as_bytes());
        self
    }

    /// Adds the elements of an array with their count.
    pub fn array<T: Element>(&mut self, values: &[T]) -> &mut Self {
        self.number(values.len() as u64);
        let start = self.bytes.len();
        self.bytes.extend_from_slice(bytemuck::cast_slice(values));
        little_endian(&mut self.bytes[start..], T::WORD);
        self
    }

    /// Names a topology, to be stored beside the value.
    pub fn topology(&mut self, topology: &Arc<Topology>) -> &mut Self {
        let digest = topology.digest();
        if self.topologies.iter().all(|other| other.digest() != digest) {
            self.topologies.push(Arc::clone(topology));
        }
        self.digest(digest)
    }

    /// The bytes, and the topologies they name.
    pub fn finish(self) -> (Vec<u8>, Vec<Arc<Topology>>) {
        (self.bytes, self.topologies)
    }
}

/// Takes a value apart again; every method is `None` on bytes that no
/// [`Encoder`] wrote, and none reserves more memory than there are bytes.
pub struct Decoder<'a> {
    rest: &'a [u8],
    find_topology: &'a dyn Fn(Digest) -> Option<Arc<Topology>>,
    depth: usize,
}

impl<'a> Decoder<'a> {
    /// A decoder of `bytes` that finds topologies by digest.
    pub fn new(
        bytes: &'a [u8],
        find_topology: &'a dyn Fn(Digest) -> Option<Arc<Topology>>,
    ) -> Self {
        Self {
            rest: bytes,
            find_topology,
            depth: 0,
        }
    }

    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(taken)
    }

    /// The next byte.
    pub fn byte(&mut self) -> Option<u8> {
        self.take(1).map(|bytes| bytes[0])
    }

    /// The next integer.
    pub fn number(&mut self) -> Option<u64> {
        let bytes = self.take(8)?.try_into().ok()?;
        Some(u64::from_le_bytes(bytes))
    }

    /// The next float.
    pub fn float(&mut self) -> Option<f64> {
        self.number().map(f64::from_bits)
    }

    /// The next integer as a count of things of at least one byte each.
    pub fn count(&mut self) -> Option<usize> {
        let count = usize::try_from(self.number()?).ok()?;
        (count <= self.rest.len()).then_some(count)
    }

    /// The next text.
    pub fn text(&mut self) -> Option<&'a str> {
        let count = self.count()?;
        std::str::from_utf8(self.take(count)?).ok()
    }

    /// The next digest.
    pub fn digest(&mut self) -> Option<Digest> {
        let bytes = self.take(16)?.try_into().ok()?;
        Some(Digest::from_bytes(bytes))
    }

    /// The next array.
    pub fn array<T: Element>(&mut self) -> Option<Vec<T>> {
        let count = usize::try_from(self.number()?).ok()?;
        let bytes = self.take(count.checked_mul(size_of::<T>())?)?;
        let mut values = vec![T::zeroed(); count];
        let target: &mut [u8] = bytemuck::cast_slice_mut(&mut values);
        target.copy_from_slice(bytes);
        little_endian(target, T::WORD);
        Some(values)
    }

    /// The next topology, found by its digest.
    pub fn topology(&mut self) -> Option<Arc<Topology>> {
        let digest = self.digest()?;
        (self.find_topology)(digest)
    }

    /// Runs `item` one level deeper; `None` beyond the deepest one.
    pub(super) fn nested<T>(&mut self, item: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        if self.depth >= MAX_DEPTH {
            return None;
        }
        self.depth += 1;
        let result = item(self);
        self.depth -= 1;
        result
    }

    /// `value` if nothing is left over.
    pub fn finish<T>(self, value: T) -> Option<T> {
        self.rest.is_empty().then_some(value)
    }
}

/// Turns words from this machine's byte order to little-endian, and back.
fn little_endian(bytes: &mut [u8], word: usize) {
    if cfg!(target_endian = "big") {
        bytes.chunks_exact_mut(word).for_each(<[u8]>::reverse);
    }
}

/// The bytes of a topology.
pub(crate) fn encode_topology(topology: &Topology) -> Vec<u8> {
    let mut out = Encoder::new();
    out.number(topology.vertex_count() as u64)
        .array(topology.offsets())
        .array(topology.corners());
    out.bytes
}

/// The topology that [`encode_topology`] wrote.
pub(crate) fn decode_topology(bytes: &[u8]) -> Option<Topology> {
    let mut from = Decoder::new(bytes, &|_| None);
    let vertices = usize::try_from(from.number()?).ok()?;
    let (offsets, corners) = (from.array()?, from.array()?);
    from.finish(Topology::new(vertices, offsets, corners).ok()?)
}
