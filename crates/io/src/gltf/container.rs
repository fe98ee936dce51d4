//! The binary container (GLB): a header and chunks.

use crate::error::{FaultKind, IoError, Place, quote};

const HELP: &str = "export or download the file again";

/// The chunks of a GLB file.
pub(super) struct Chunks<'a> {
    pub(super) json: &'a [u8],
    /// Byte at which the JSON starts.
    pub(super) json_start: usize,
    pub(super) binary: Option<&'a [u8]>,
}

fn fail(kind: FaultKind, at: usize, cause: String, help: &str) -> IoError {
    IoError::new(kind, Place::Byte(at as u64), cause, help)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}

/// Splits a file that starts with `glTF` into its chunks.
///
/// # Errors
/// When a length disagrees with the bytes there are, or chunks are missing,
/// doubled or out of order.
pub(super) fn split<'a>(
    bytes: &'a [u8],
    warnings: &mut Vec<String>,
) -> Result<Chunks<'a>, IoError> {
    let length = header(bytes, warnings)?;
    let mut chunks = Chunks {
        json: &[],
        json_start: 0,
        binary: None,
    };
    let (mut at, mut index, mut unaligned) = (12, 0, false);
    while at < length {
        let (kind, start, end) = chunk(bytes, at, length)?;
        let data = &bytes[start..end];
        unaligned |= !data.len().is_multiple_of(4);
        match (&kind, index) {
            (b"JSON", 0) => (chunks.json, chunks.json_start) = (data, start),
            (b"BIN\0", 1) => chunks.binary = Some(data),
            (b"JSON" | b"BIN\0", _) => {
                let cause = format!(
                    "chunk {index} is {}, which has no place there",
                    quote(&kind)
                );
                return Err(fail(FaultKind::Syntax, at, cause, HELP));
            }
            (_, 0) => {
                let cause = format!("the first chunk is {}, not JSON", quote(&kind));
                return Err(fail(FaultKind::Syntax, at, cause, HELP));
            }
            _ => {}
        }
        (at, index) = (end, index + 1);
    }
    if chunks.json.is_empty() {
        let cause = "there is no JSON in the file".to_owned();
        return Err(fail(FaultKind::Empty, 12.min(bytes.len()), cause, HELP));
    }
    if unaligned {
        warnings.push("a chunk's length is not a multiple of 4, as it should be".to_owned());
    }
    Ok(chunks)
}

/// Checks the header; the length it says the file has.
fn header(bytes: &[u8], warnings: &mut Vec<String>) -> Result<usize, IoError> {
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        let cause = format!(
            "the file ends after {} bytes, within its header of 12",
            bytes.len()
        );
        return Err(fail(FaultKind::Truncated, bytes.len(), cause, HELP));
    };
    if version != 2 {
        let cause = format!("this is GLB version {version}; only version 2 is read");
        return Err(fail(
            FaultKind::Unsupported,
            4,
            cause,
            "convert it to glTF 2.0",
        ));
    }
    let length = length as usize;
    if length > bytes.len() {
        let cause = format!(
            "the header says {length} bytes, but the file has {}",
            bytes.len()
        );
        return Err(fail(FaultKind::Truncated, 8, cause, HELP));
    }
    if length < bytes.len() {
        let extra = bytes.len() - length;
        warnings.push(format!(
            "{extra} bytes after the end of the file were ignored"
        ));
    }
    Ok(length)
}

/// Kind, start and end of the chunk whose header is at `at`.
fn chunk(bytes: &[u8], at: usize, length: usize) -> Result<([u8; 4], usize, usize), IoError> {
    let cut = |cause| fail(FaultKind::Truncated, at, cause, HELP);
    let header = (word(bytes, at), bytes.get(at + 4..at + 8));
    let (Some(size), Some(kind)) = header else {
        return Err(cut("the file ends within the header of a chunk".to_owned()));
    };
    let kind = [kind[0], kind[1], kind[2], kind[3]];
    let (start, size) = (at + 8, size as usize);
    if start > length || size > length - start {
        let left = length.saturating_sub(start);
        return Err(cut(format!(
            "the chunk says {size} bytes, but {left} are left"
        )));
    }
    Ok((kind, start, start + size))
}
