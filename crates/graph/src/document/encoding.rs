//! From bytes to text: what a file is that cannot be a graph.

use std::sync::Arc;

use super::MAX_BYTES;
use crate::diagnostic::{Diagnostic, Source};

/// First bytes of files that are given as a graph by mistake.
const MAGIC: [(&[u8], &str); 9] = [
    (b"glTF", "a binary glTF mesh"),
    (b"ply\n", "a PLY mesh"),
    (b"\x89PNG", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"\x1f\x8b", "gzip-compressed"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"%PDF", "a PDF document"),
    (b"\x7fELF", "a program"),
    (b"(\xb5/\xfd", "zstd-compressed"),
];

/// The text of a graph file, without a byte order mark.
pub(super) fn decode(name: &str, bytes: &[u8]) -> Result<Arc<Source>, Box<Diagnostic>> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if bytes.len() > MAX_BYTES {
        let (size, limit) = (bytes.len() >> 20, MAX_BYTES >> 20);
        let message = format!("the graph file has {size} MiB, more than the {limit} MiB allowed");
        return Err(placeless("too_large", name, message)
            .help("keep large data in meshes and tables, and read them with nodes"));
    }
    if let Some((_, what)) = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        let message = format!("this is not a graph file: it is {what}");
        return Err(placeless("not_a_graph", name, message)
            .help("a graph is a text that starts with `Graph(version: 1, ...)`"));
    }
    if is_utf16(bytes) {
        return Err(
            placeless("encoding", name, "the graph file is UTF-16").help("save it as UTF-8")
        );
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => return Err(invalid_utf8(name, bytes, error.valid_up_to())),
    };
    if let Some(at) = text.find('\0') {
        let source = Arc::new(Source::new(name, text));
        let message = format!("there is a NUL byte at byte {at}");
        let error = Diagnostic::error("encoding", &source, at..at + 1, message, "here");
        return Err(Box::new(
            error.with_help("the file is damaged or not a text; restore it"),
        ));
    }
    if text.trim().is_empty() {
        return Err(placeless("empty", name, "the graph file is empty")
            .help("start with `Graph(version: 1, nodes: {}, outputs: {})`"));
    }
    Ok(Arc::new(Source::new(name, text)))
}

/// A byte order mark, or NULs in every second place.
fn is_utf16(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(64)];
    let nuls = |first: usize| {
        let places = start.iter().skip(first).step_by(2);
        start.len() >= 4 && places.clone().count() > 0 && places.clone().all(|byte| *byte == 0)
    };
    let (even, odd) = (nuls(0), nuls(1));
    bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") || (even != odd)
}

fn invalid_utf8(name: &str, bytes: &[u8], at: usize) -> Box<Diagnostic> {
    // The text before the fault is kept as it is, so the place stays right.
    let text = String::from_utf8_lossy(bytes).into_owned();
    let source = Arc::new(Source::new(name, text));
    let what = if bytes.contains(&0) {
        "a text, but binary"
    } else {
        "UTF-8"
    };
    let message = format!(
        "the graph file is not {what}: byte {at} is 0x{:02x}",
        bytes[at]
    );
    let span = at..at + char::REPLACEMENT_CHARACTER.len_utf8();
    let error = Diagnostic::error("encoding", &source, span, message, "not UTF-8 from here");
    Box::new(error.with_help("save it as UTF-8"))
}

/// A diagnostic on a text that is not worth showing.
struct Placeless(Box<Diagnostic>);

fn placeless(code: &'static str, name: &str, message: impl Into<String>) -> Placeless {
    let source = Arc::new(Source::new(name, ""));
    let mut error = Diagnostic::error(code, &source, 0..0, message, "");
    error.labels.clear();
    Placeless(Box::new(error))
}

impl Placeless {
    fn help(self, help: &str) -> Box<Diagnostic> {
        Box::new(self.0.with_help(help))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(bytes: &[u8]) -> (&'static str, String) {
        let error = decode("g.ron", bytes).unwrap_err();
        assert!(error.help.is_some(), "{} has no help", error.message);
        (error.code, error.message)
    }

    #[test]
    fn what_is_no_text_is_named() {
        for bytes in [&b""[..], b" \n\t", b"\xef\xbb\xbf", b"\xef\xbb\xbf \n"] {
            assert_eq!(refusal(bytes).0, "empty");
        }
        assert!(refusal(b"\xff\xfeG\0r\0a\0p\0h\0").1.contains("UTF-16"));
        assert!(refusal(b"G\0r\0a\0p\0h\0(\0)\0").1.contains("UTF-16"));
        assert!(refusal(b"glTF\x02\0\0\0").1.contains("glTF"));
        assert!(refusal(&vec![b' '; MAX_BYTES + 1]).0 == "too_large");
    }

    #[test]
    fn damaged_bytes_are_pointed_at() {
        let error = decode("g.ron", b"(nodes: \"\xff\xfe\")").unwrap_err();
        assert!(
            error.message.contains("byte 9 is 0xff"),
            "{}",
            error.message
        );
        assert_eq!(error.labels[0].span, 9..12);
        let error = decode("g.ron", b"(no\0des: [])").unwrap_err();
        assert_eq!(error.labels[0].span, 3..4);
    }

    #[test]
    fn a_byte_order_mark_is_dropped() {
        assert_eq!(decode("g.ron", b"\xef\xbb\xbf()").unwrap().text(), "()");
    }
}
