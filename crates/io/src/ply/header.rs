//! The header: which elements there are, how many, with which properties.

use super::EXPORT;
use crate::error::{FaultKind, IoError, quote};
use crate::text::{self, Scanner};

/// Names of the list that holds a face's vertices.
pub(super) const INDEX_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// How the values after the header are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn named(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }
}

/// A property: a number, or a list preceded by its length.
#[derive(Debug, Clone)]
pub(super) struct Property {
    pub(super) name: String,
    /// Type of a list's length; `None` for a single number.
    pub(super) count: Option<Type>,
    pub(super) value: Type,
}

/// An element: so many rows of these properties.
#[derive(Debug, Clone)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// A whole header.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// First byte after the header.
    pub(super) end: usize,
}

impl Header {
    /// Rows of the element of that name, 0 if there is none.
    pub(super) fn count(&self, name: &str) -> u64 {
        self.elements
            .iter()
            .find(|element| element.name == name)
            .map_or(0, |element| element.count)
    }

    /// Parses the header of a file that starts with `ply`.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, IoError> {
        let mut scanner = Scanner::new(bytes, 3);
        scanner.next_line();
        let mut lines = Lines::default();
        loop {
            scanner.skip_blanks();
            let at = scanner.at;
            let word = scanner.word();
            if word.is_empty() && scanner.peek().is_none() {
                let (place, cause) = (text::place(bytes, at), "the file ends within its header");
                return Err(IoError::new(FaultKind::Truncated, place, cause, EXPORT));
            }
            let over = word == b"end_header";
            lines.line(word, &mut scanner).map_err(|cause| {
                let end = memchr::memchr2(b'\n', b'\r', &bytes[at..]);
                let line = quote(&bytes[at..end.map_or(bytes.len(), |n| at + n)]);
                let cause = format!("{cause}: {line}");
                IoError::new(FaultKind::Syntax, text::place(bytes, at), cause, EXPORT)
            })?;
            scanner.next_line();
            if over {
                break;
            }
        }
        let (Some(encoding), elements) = (lines.encoding, lines.elements) else {
            let cause = "the header has no format line";
            return Err(IoError::new(
                FaultKind::Syntax,
                text::place(bytes, 0),
                cause,
                EXPORT,
            ));
        };
        Ok(Self {
            encoding,
            elements,
            end: scanner.at,
        })
    }
}

/// What the header's lines have said so far.
#[derive(Default)]
struct Lines {
    encoding: Option<Encoding>,
    elements: Vec<Element>,
}

impl Lines {
    /// Takes the line that starts with `word`.
    fn line(&mut self, word: &[u8], scanner: &mut Scanner<'_>) -> Result<(), &'static str> {
        match word {
            b"" | b"comment" | b"obj_info" | b"end_header" => {}
            b"format" => {
                self.encoding = Some(match next(scanner) {
                    b"ascii" => Encoding::Ascii,
                    b"binary_little_endian" => Encoding::LittleEndian,
                    b"binary_big_endian" => Encoding::BigEndian,
                    _ => return Err("this format is not known"),
                });
            }
            b"element" => {
                let element = element(scanner).ok_or("an element has a name and a count")?;
                if self.elements.iter().any(|other| other.name == element.name) {
                    return Err("there are two elements of this name");
                }
                self.elements.push(element);
            }
            b"property" => {
                let property = property(scanner).ok_or("this property is not understood")?;
                let last = self
                    .elements
                    .last_mut()
                    .ok_or("this property belongs to no element")?;
                last.properties.push(property);
            }
            _ => return Err("this is no header line"),
        }
        Ok(())
    }
}

fn next<'a>(scanner: &mut Scanner<'a>) -> &'a [u8] {
    scanner.skip_blanks();
    scanner.word()
}

fn element(scanner: &mut Scanner<'_>) -> Option<Element> {
    let name = text::decode(next(scanner));
    let count = std::str::from_utf8(next(scanner)).ok()?.parse().ok()?;
    Some(Element {
        name,
        count,
        properties: Vec::new(),
    })
}

fn property(scanner: &mut Scanner<'_>) -> Option<Property> {
    let mut kind = next(scanner);
    let mut count = None;
    if kind == b"list" {
        count = Some(Type::named(next(scanner)).filter(|kind| !kind.is_float())?);
        kind = next(scanner);
    }
    let value = Type::named(kind)?;
    let name = text::decode(next(scanner));
    (!name.is_empty()).then_some(Property { name, count, value })
}
