//! The bytes behind buffers: the binary chunk, data URIs, further files.

use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::document::Document;
use super::{EXPORT, fault};
use crate::error::{FaultKind, IoError, quote};
use crate::{Resolve, ResolveError, uri};

/// The bytes of one buffer, cheap to clone.
#[derive(Clone)]
pub(super) enum Data<'a> {
    /// The binary chunk of a GLB file.
    Chunk(&'a [u8]),
    /// Decoded or handed over.
    Owned(Arc<[u8]>),
}

impl Data<'_> {
    pub(super) fn bytes(&self) -> &[u8] {
        match self {
            Self::Chunk(bytes) => bytes,
            Self::Owned(bytes) => bytes,
        }
    }
}

/// Buffers, each loaded when it is first needed.
pub(super) struct Buffers<'a, 'r> {
    document: &'a Document<'a>,
    name: &'a str,
    binary: Option<&'a [u8]>,
    resolve: &'a mut Resolve<'r>,
    loaded: Vec<Option<Data<'a>>>,
}

impl<'a, 'r> Buffers<'a, 'r> {
    pub(super) fn new(
        document: &'a Document<'a>,
        name: &'a str,
        binary: Option<&'a [u8]>,
        resolve: &'a mut Resolve<'r>,
    ) -> Self {
        let loaded = vec![None; document.buffers.len()];
        Self {
            document,
            name,
            binary,
            resolve,
            loaded,
        }
    }

    /// At least `byteLength` bytes of buffer `index`, which `from` refers to.
    pub(super) fn get(&mut self, index: usize, from: &str) -> Result<Data<'a>, IoError> {
        let buffer = self.document.buffers.get(index, from)?;
        if let Some(data) = &self.loaded[index] {
            return Ok(data.clone());
        }
        let pointer = self.document.buffers.pointer(index);
        let data = match (&buffer.uri, self.binary) {
            (Some(uri), _) => Data::Owned(self.load(uri, &format!("{pointer}/uri"))?),
            (None, Some(chunk)) if index == 0 => Data::Chunk(chunk),
            (None, _) => {
                let cause = "the buffer has no data: neither a uri nor a binary chunk";
                return Err(fault(FaultKind::Unresolved, &pointer, cause, EXPORT));
            }
        };
        let (says, has) = (buffer.byte_length.0, data.bytes().len());
        if says > has as u64 {
            let cause = format!("the buffer says {says} bytes, but there are {has}");
            let pointer = format!("{pointer}/byteLength");
            return Err(fault(FaultKind::Truncated, &pointer, cause, EXPORT));
        }
        self.loaded[index] = Some(data.clone());
        Ok(data)
    }

    fn load(&mut self, uri: &str, pointer: &str) -> Result<Arc<[u8]>, IoError> {
        if let Some(data) = uri.strip_prefix("data:") {
            return decode(data, pointer);
        }
        let quoted = quote(uri.as_bytes());
        let path = uri::relative(uri).map_err(|why| {
            let cause = format!("the buffer's uri {quoted} {why}, so it is not followed");
            let help = "put the buffer beside the file, or export as one .glb";
            fault(FaultKind::UnsafeReference, pointer, cause, help)
        })?;
        let own = self.name.rsplit(['/', '\\']).next();
        if own == Some(path.trim_start_matches("./")) {
            let cause = format!("the buffer's uri {quoted} is this file itself");
            return Err(fault(FaultKind::UnsafeReference, pointer, cause, EXPORT));
        }
        let mut found = (self.resolve)(&path);
        if found == Err(ResolveError::NotFound) && path != uri && uri::check_path(uri).is_ok() {
            // Some exporters escape the uri but not the file's name.
            found = (self.resolve)(uri);
        }
        found.map_err(|error| {
            let cause = format!("the buffer {quoted} was not read: {error}");
            let help = "put it beside the file, or export as one .glb";
            fault(FaultKind::Unresolved, pointer, cause, help)
        })
    }
}

/// The bytes of a data URI, without its `data:`.
fn decode(data: &str, pointer: &str) -> Result<Arc<[u8]>, IoError> {
    let Some((kind, text)) = data.split_once(',') else {
        let cause = "the data URI has no comma before its data";
        return Err(fault(FaultKind::Syntax, pointer, cause, EXPORT));
    };
    if !kind.ends_with(";base64") {
        let cause = "the data URI is not in base64";
        return Err(fault(FaultKind::Unsupported, pointer, cause, EXPORT));
    }
    let bytes = STANDARD.decode(text).map_err(|error| {
        let cause = format!("the base64 data is broken: {error}");
        fault(FaultKind::Syntax, pointer, cause, EXPORT)
    })?;
    Ok(bytes.into())
}
