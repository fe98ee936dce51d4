//! A file read in parts on all threads, with the result of one reading.
//!
//! A part is parsed without knowing what stands before it. That is enough: only
//! faces that count backwards depend on it, and a part with such faces is parsed
//! again when the parts before are counted, which no face changes.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use memchr::memchr2_iter;
use rayon::prelude::*;
use tessgraph_geometry::Monitor;

use super::parse::Parser;
use super::statements::{Counts, NONE, Statements};
use crate::error::{FaultKind, IoError, Place};
use crate::text::without_bom;

/// Bytes of a part, up to its last line: what it says stays in the cache until
/// it is added to the rest.
const PART: usize = 1 << 17;

/// Parts for each thread that are parsed before they are added.
const BATCH: usize = 8;

/// Everything that the statements of a file say.
///
/// # Errors
/// At the first statement that is wrong; [`IoError::Cancelled`].
pub(super) fn statements<'a>(
    bytes: &'a [u8],
    monitor: &'a dyn Monitor,
) -> Result<Statements<'a>, IoError> {
    let said = in_parts(bytes, PART, usize::MAX, monitor)?;
    let count = said.positions.len();
    if said.highest <= count {
        return Ok(said);
    }
    // A face may come before its vertices, so the count was not known. A second
    // reading knows it and stops at the place.
    in_parts(bytes, PART, count, monitor)?;
    Err(IoError::new(
        FaultKind::OutOfRange,
        Place::File,
        "a face names a vertex that does not exist",
        "export it again",
    ))
}

/// Everything said, read in parts of about `part` bytes; a vertex from
/// `vertex_limit` on is an error.
pub(super) fn in_parts<'a>(
    bytes: &'a [u8],
    part: usize,
    vertex_limit: usize,
    monitor: &'a dyn Monitor,
) -> Result<Statements<'a>, IoError> {
    let reader = Reader {
        bytes,
        vertex_limit,
        monitor,
        done: AtomicU64::new(0),
    };
    let parts = cut(bytes, part);
    let mut said = Statements::default();
    let mut before = Counts::default();
    let (mut parsed, mut spare) = (Vec::new(), Vec::new());
    let mut batches = parts.chunks(BATCH * rayon::current_num_threads());
    loop {
        // One batch is parsed while the last is added to the rest.
        let batch = batches.next();
        let (next, ()) = rayon::join(
            || reader.parse(batch.unwrap_or_default(), spare, before),
            || parsed.iter().for_each(|part| said.append(part)),
        );
        spare = std::mem::take(&mut parsed);
        (parsed, before) = next?;
        if batch.is_none() {
            return Ok(said);
        }
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    vertex_limit: usize,
    monitor: &'a dyn Monitor,
    /// Bytes that were read.
    done: AtomicU64,
}

impl<'a> Reader<'a> {
    /// What each of `parts` says, in memory of `spare`, and how much there is then
    /// with what was `before`.
    fn parse(
        &self,
        parts: &[Range<usize>],
        mut spare: Vec<Statements<'a>>,
        before: Counts,
    ) -> Result<(Vec<Statements<'a>>, Counts), IoError> {
        spare.resize_with(parts.len(), Statements::default);
        let parse = |(part, said): (&Range<usize>, Statements<'a>)| self.part(part, said, None);
        let parsed = parts.par_iter().zip(spare).map(parse);
        let parsed: Vec<(Parser<'a>, Result<(), IoError>)> = parsed.collect();
        let mut before = before;
        let again = |parser: &Parser<'a>| {
            let start = before;
            before = before.with(&parser.said);
            let full = before.corners >= NONE as usize;
            (full || parser.counted_backwards).then_some(start)
        };
        let again: Vec<Option<Counts>> =
            parsed.iter().map(|(parser, _)| parser).map(again).collect();
        let parsed = parts.par_iter().zip(parsed).zip(again);
        let parsed = parsed.map(|((part, parsed), start)| match start {
            Some(start) => self.part(part, parsed.0.said, Some(start)),
            None => parsed,
        });
        let parsed: Vec<(Parser<'a>, Result<(), IoError>)> = parsed.collect();
        // The counts behind a mistake are wrong, but what is said of them comes
        // after it.
        let said = parsed
            .into_iter()
            .map(|(parser, end)| end.map(|()| parser.said));
        Ok((said.collect::<Result<_, _>>()?, before))
    }

    /// Parses one part.
    fn part(
        &self,
        part: &Range<usize>,
        said: Statements<'a>,
        before: Option<Counts>,
    ) -> (Parser<'a>, Result<(), IoError>) {
        let bytes = &self.bytes[..part.end];
        let mut parser = Parser::new(bytes, part.start, said, self.monitor);
        parser.vertex_limit = self.vertex_limit;
        parser.before = before;
        let end = parser.run();
        if before.is_none() {
            let length = part.len() as u64;
            let done = self.done.fetch_add(length, Ordering::Relaxed) + length;
            self.monitor.progress(done, self.bytes.len() as u64);
        }
        (parser, end)
    }
}

/// Parts of at least `least` bytes that end where a line does; a line's end
/// behind a backslash is none.
fn cut(bytes: &[u8], least: usize) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let mut start = bytes.len() - without_bom(bytes).len();
    while start < bytes.len() {
        let from = (start + least).min(bytes.len());
        let mut ends = memchr2_iter(b'\n', b'\r', &bytes[from..]).map(|at| from + at);
        let joined = |&at: &usize| {
            let line = bytes[start..at].strip_suffix(b"\r");
            line.unwrap_or(&bytes[start..at]).ends_with(b"\\")
        };
        let end = ends.find(|at| !joined(at)).map_or(bytes.len(), |at| at + 1);
        parts.push(start..end);
        start = end;
    }
    parts
}
