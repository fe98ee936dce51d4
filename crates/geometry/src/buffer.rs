//! Shared, immutable arrays whose digest is computed once.

use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use bytemuck::NoUninit;

use crate::digest::Digest;

/// An immutable array shared by reference, with a digest computed on first use.
///
/// Cloning copies a pointer. Meshes that differ in one buffer share the others,
/// in memory and in the cache.
pub struct Buffer<T> {
    inner: Arc<Inner<T>>,
}

struct Inner<T> {
    data: Vec<T>,
    digest: OnceLock<Digest>,
}

impl<T> Buffer<T> {
    /// The elements as a slice.
    pub fn as_slice(&self) -> &[T] {
        &self.inner.data
    }

    /// Bytes the elements take in memory.
    pub fn byte_size(&self) -> usize {
        size_of_val(self.as_slice())
    }

    /// Identifies the allocation, so that shared buffers are counted once.
    pub fn address(&self) -> usize {
        Arc::as_ptr(&self.inner).addr()
    }

    /// Whether both are the same allocation; equal content may still differ here.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.inner, &other.inner)
    }
}

impl<T: NoUninit> Buffer<T> {
    /// Digest of the element count and bytes. Cost: O(n) once, then O(1).
    pub fn digest(&self) -> Digest {
        if let Some(digest) = self.inner.digest.get() {
            return *digest;
        }
        // Hashed before the cell is entered: hashing runs on the thread pool, and a
        // thread that waits there may take up a task that asks for this digest.
        let digest = Digest::of(bytemuck::cast_slice(self.as_slice()));
        *self.inner.digest.get_or_init(|| digest)
    }
}

impl<T: NoUninit> PartialEq for Buffer<T> {
    fn eq(&self, other: &Self) -> bool {
        self.is_same(other) || (self.len() == other.len() && self.digest() == other.digest())
    }
}

impl<T> From<Vec<T>> for Buffer<T> {
    fn from(data: Vec<T>) -> Self {
        Self {
            inner: Arc::new(Inner {
                data,
                digest: OnceLock::new(),
            }),
        }
    }
}

impl<T> FromIterator<T> for Buffer<T> {
    fn from_iter<I: IntoIterator<Item = T>>(iter: I) -> Self {
        Vec::from_iter(iter).into()
    }
}

impl<T> Default for Buffer<T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<T> Clone for Buffer<T> {
    fn clone(&self) -> Self {
        Self {
            inner: Arc::clone(&self.inner),
        }
    }
}

impl<T> Deref for Buffer<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        self.as_slice()
    }
}

impl<T: fmt::Debug> fmt::Debug for Buffer<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}
