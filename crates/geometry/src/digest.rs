//! Content digests: equal content has an equal digest, on every machine.

use std::fmt;

/// 128 bits of BLAKE3 over a value's content.
///
/// Digests identify buffers, meshes and every other value that travels between
/// nodes. 128 bits keep the chance of a collision among 10¹⁵ values below 10⁻⁸.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Digest([u8; 16]);

impl Digest {
    /// Digest of `bytes`. Cost: O(n); large inputs use all threads of the pool.
    pub fn of(bytes: &[u8]) -> Self {
        let mut hasher = Hasher::new();
        hasher.bytes(bytes);
        hasher.finish()
    }

    /// The 16 bytes of the digest.
    pub fn as_bytes(&self) -> &[u8; 16] {
        &self.0
    }

    /// Rebuilds a digest from bytes stored earlier.
    pub fn from_bytes(bytes: [u8; 16]) -> Self {
        Self(bytes)
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Digest({self})")
    }
}

/// Collects parts of a value into one [`Digest`].
///
/// Every part is preceded by its length or has a fixed one, so that two
/// different lists of parts never feed the same bytes.
#[derive(Default)]
pub struct Hasher(blake3::Hasher);

/// From this size on hashing in parallel is faster than on one thread.
const PARALLEL_BYTES: usize = 128 * 1024;

impl Hasher {
    /// A hasher that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Feeds bytes, preceded by their count.
    pub fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        self.number(bytes.len() as u64);
        if bytes.len() >= PARALLEL_BYTES {
            self.0.update_rayon(bytes);
        } else {
            self.0.update(bytes);
        }
        self
    }

    /// Feeds a text, preceded by its length.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.bytes(text.as_bytes())
    }

    /// Feeds an integer of fixed width.
    pub fn number(&mut self, number: u64) -> &mut Self {
        self.0.update(&number.to_le_bytes());
        self
    }

    /// Feeds a float by its bits; -0 counts as 0.
    pub fn float(&mut self, number: f64) -> &mut Self {
        // Adding zero turns -0 into 0 and changes nothing else.
        self.number((number + 0.0).to_bits())
    }

    /// Feeds another value's digest.
    pub fn digest(&mut self, digest: Digest) -> &mut Self {
        self.0.update(&digest.0);
        self
    }

    /// The digest of all that was fed.
    pub fn finish(&self) -> Digest {
        let mut bytes = [0; 16];
        bytes.copy_from_slice(&self.0.finalize().as_bytes()[..16]);
        Digest(bytes)
    }
}
