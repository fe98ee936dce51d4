//! Files on their way out, a block at a time.

use std::io;
use std::ops::Range;

use rayon::prelude::*;
use tessgraph_geometry::Monitor;

use crate::error::IoError;

/// Elements that are encoded by one thread in one go.
const BLOCK: usize = 1 << 13;

/// Blocks that are encoded side by side before they are handed over in order:
/// what is held of a file is at most so many.
const TOGETHER: usize = 16;

/// Where the bytes of a file go while it is made.
pub(crate) struct Stream<'a> {
    sink: &'a mut dyn io::Write,
    monitor: &'a dyn Monitor,
    /// Elements written so far, and of how many.
    done: u64,
    total: u64,
    /// Blocks, kept for the next ones.
    blocks: Vec<Vec<u8>>,
}

impl<'a> Stream<'a> {
    /// A file of `total` elements, for the monitor to count.
    pub(crate) fn new(sink: &'a mut dyn io::Write, total: usize, monitor: &'a dyn Monitor) -> Self {
        Self {
            sink,
            monitor,
            done: 0,
            total: total as u64,
            blocks: vec![Vec::new(); TOGETHER],
        }
    }

    pub(crate) fn bytes(&mut self, bytes: &[u8]) -> Result<(), IoError> {
        Ok(self.sink.write_all(bytes)?)
    }

    /// What `encode` makes of `count` elements, a block of them at a time.
    ///
    /// Which elements make a block does not depend on the number of threads.
    pub(crate) fn elements(
        &mut self,
        count: usize,
        encode: impl Fn(Range<usize>, &mut Vec<u8>) + Sync,
    ) -> Result<(), IoError> {
        for first in (0..count).step_by(BLOCK * TOGETHER) {
            self.monitor.check()?;
            let last = count.min(first + BLOCK * TOGETHER);
            let used = (last - first).div_ceil(BLOCK);
            let blocks = &mut self.blocks[..used];
            blocks.par_iter_mut().enumerate().for_each(|(k, block)| {
                let start = first + k * BLOCK;
                block.clear();
                encode(start..last.min(start + BLOCK), block);
            });
            blocks
                .iter()
                .try_for_each(|block| self.sink.write_all(block))?;
            self.done += (last - first) as u64;
            self.monitor.progress(self.done.min(self.total), self.total);
        }
        Ok(())
    }
}

impl From<io::Error> for IoError {
    fn from(error: io::Error) -> Self {
        Self::NotTaken {
            kind: error.kind(),
            message: error.to_string(),
        }
    }
}
