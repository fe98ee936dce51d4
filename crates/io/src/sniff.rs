//! What a file seems to be by its first bytes, whatever its name says.

use crate::error::{FaultKind, IoError, Place, quote};
use crate::{Format, text};

/// Signatures at the start of a file, and what they mean in words.
const SIGNATURES: &[(&[u8], &str)] = &[
    (
        b"version https://git-lfs.github.com/spec",
        "a git-lfs pointer",
    ),
    (b"\x1f\x8b", "a gzip archive"),
    (b"PK\x03\x04", "a zip archive (or a 3MF file)"),
    (b"\xfd7zXZ\0", "an xz archive"),
    (b"\x28\xb5\x2f\xfd", "a zstd archive"),
    (b"BZh", "a bzip2 archive"),
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive"),
    (b"\x89PNG", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"%PDF", "a PDF document"),
    (b"glTF", "a binary glTF (GLB) file"),
    (b"Kaydara FBX Binary", "an FBX file"),
    (b"3D Geometry File Format", "a Rhino 3DM file"),
    (b"BLENDER", "a Blender file"),
    (b"ISO-10303-21", "a STEP or IFC file"),
    (b"AC10", "an AutoCAD DWG file"),
    (b"\xff\xfe\0\0", "UTF-32 text"),
    (b"\0\0\xfe\xff", "UTF-32 text"),
    (b"\xff\xfe", "UTF-16 text"),
    (b"\xfe\xff", "UTF-16 text"),
];

/// What to do about content that [`SIGNATURES`] names by these words.
fn remedy(seen: &str) -> &'static str {
    match seen {
        seen if seen.contains("git-lfs") => "fetch it with `git lfs pull`",
        seen if seen.contains("archive") => "unpack it first",
        seen if seen.contains("UTF-") => "save it as UTF-8",
        seen if seen.contains("page") => "download the file itself, not its web page",
        seen if seen.contains("glTF") && seen.contains("binary") => "name it .glb",
        seen if seen.contains("JSON") => "name it .gltf if it is glTF",
        seen if seen.contains("PLY") => "name it .ply",
        seen if seen.contains("STL") => "name it .stl",
        seen if seen.contains("merge") => "resolve the merge first",
        _ => "export the mesh as OBJ, GLB, STL or PLY",
    }
}

/// What `bytes` seem to be, in words: "a web page (HTML)", "a git-lfs pointer",
/// "a gzip archive", "UTF-16 text", "binary data".
///
/// `None` for text of no special kind, as OBJ is. For messages about a file
/// that is not what its name says; looks at the first bytes only.
///
/// ```
/// assert_eq!(tessgraph_io::recognise(b"\x1f\x8b\x08"), Some("a gzip archive"));
/// assert_eq!(tessgraph_io::recognise(b"v 0 0 0"), None);
/// ```
pub fn recognise(bytes: &[u8]) -> Option<&'static str> {
    let bytes = text::without_bom(bytes);
    if let Some((_, seen)) = SIGNATURES
        .iter()
        .find(|(start, _)| bytes.starts_with(start))
    {
        return Some(seen);
    }
    let text = bytes.trim_ascii_start();
    let head = text[..text.len().min(512)].to_ascii_lowercase();
    if head.starts_with(b"<!doctype html") || memchr::memmem::find(&head, b"<html").is_some() {
        return Some("a web page (HTML)");
    }
    if head.starts_with(b"<?xml") || head.starts_with(b"<svg") || head.starts_with(b"<collada") {
        return Some("an XML file");
    }
    if head.starts_with(b"<<<<<<<") {
        return Some("a file with unresolved git merge marks");
    }
    if head.starts_with(b"{") || head.starts_with(b"[") {
        return Some("a JSON file");
    }
    if head.starts_with(b"ply\n") || head.starts_with(b"ply\r") {
        return Some("a PLY file");
    }
    if head.starts_with(b"solid") && memchr::memmem::find(&head, b"facet").is_some() {
        return Some("an STL file");
    }
    if head.starts_with(b"off\n") || head.starts_with(b"off\r") {
        return Some("an OFF file");
    }
    binary(&bytes[..bytes.len().min(4096)])
}

/// UTF-16 without a mark, or other bytes that are no text.
fn binary(head: &[u8]) -> Option<&'static str> {
    let zeros = |start| {
        head.iter()
            .skip(start)
            .step_by(2)
            .filter(|&&b| b == 0)
            .count()
    };
    let (even, odd) = (zeros(0), zeros(1));
    let half = head.len() / 2;
    if half >= 8 && even.max(odd) * 10 > half * 8 && even.min(odd) * 10 < half {
        return Some("UTF-16 text");
    }
    let control = |&&b: &&u8| b < 0x20 && !b.is_ascii_whitespace() && b != 0x0b && b != 0x1b;
    let odd_bytes = head.iter().filter(control).count();
    (even + odd > 0 || odd_bytes * 20 > head.len()).then_some("binary data")
}

/// The error for content that is not `format`.
///
/// Callers pass bytes that their format's reader cannot take; what the bytes
/// seem to be decides what the message says.
pub(crate) fn wrong_content(format: Format, bytes: &[u8]) -> IoError {
    if bytes.is_empty() {
        let help = "export it again; the program that wrote it may have been stopped";
        return IoError::new(FaultKind::Empty, Place::Byte(0), "the file is empty", help);
    }
    if text::without_bom(bytes).trim_ascii().is_empty() {
        let help = "export it again";
        return IoError::new(FaultKind::Empty, Place::Byte(0), "the file is blank", help);
    }
    match recognise(bytes) {
        Some(seen) => {
            let cause = format!("this is {seen}, not {format}");
            IoError::new(FaultKind::WrongContent, Place::Byte(0), cause, remedy(seen))
        }
        None => {
            let start = bytes.trim_ascii_start();
            let line = start.split(|&b| b == b'\n' || b == b'\r').next();
            let cause = format!(
                "this is not {format}; it starts with {}",
                quote(line.unwrap_or_default())
            );
            let help = format!("give a {format} file, or the name that fits the content");
            IoError::new(FaultKind::WrongContent, Place::Byte(0), cause, help)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_what_it_sees() {
        for (bytes, word) in [
            (&b"<!DOCTYPE html><p>404"[..], "HTML"),
            (b"version https://git-lfs.github.com/spec/v1\n", "git-lfs"),
            (b"\x1f\x8b\x08\0", "gzip"),
            (b"glTF\x02\0\0\0", "GLB"),
            (b"\x89PNG\r\n", "PNG"),
            (b"\xff\xfev\0 \0", "UTF-16"),
            (
                b"v\0 \x001\0 \x002\0 \x003\0\n\0v\0 \x001\0 \x002\0 \x003\0\n\0",
                "UTF-16",
            ),
            (b"\0\x01\x02\x03\x04\x05\x06\x07", "binary"),
            (b"{\"asset\": 1}", "JSON"),
        ] {
            let error = wrong_content(Format::Obj, bytes).to_string();
            assert!(error.contains(word), "{error}");
        }
        assert_eq!(recognise(b"# comment\nv 0 0 0\n"), None);
        assert_eq!(recognise("# façade\nv 0 0 0\n".as_bytes()), None);
    }

    #[test]
    fn empty_and_blank_say_so() {
        assert!(
            wrong_content(Format::Ply, b"")
                .to_string()
                .contains("empty")
        );
        assert!(
            wrong_content(Format::Ply, b" \n\t")
                .to_string()
                .contains("blank")
        );
    }
}
