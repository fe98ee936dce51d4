//! The values after the header, checked while they are read.

use tessgraph_geometry::Monitor;

use super::EXPORT;
use super::header::{Element, Encoding, Header, INDEX_NAMES, Property, Type};
use crate::error::{FaultKind, IoError, Place, quote};
use crate::text::{self, BadNumber, Scanner};

/// The values of one property in all rows of an element.
#[derive(Debug)]
pub(super) enum Column {
    /// One number per row.
    Scalar { kind: Type, values: Vec<f64> },
    /// A list per row: where each ends, and the numbers of all.
    List {
        kind: Type,
        ends: Vec<usize>,
        values: Vec<f64>,
    },
}

/// All rows of an element, by property.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) count: usize,
    pub(super) columns: Vec<(String, Column)>,
}

impl Rows {
    /// Takes the property of that name out.
    pub(super) fn take(&mut self, name: &str) -> Option<Column> {
        let place = self.columns.iter().position(|column| column.0 == name)?;
        Some(self.columns.remove(place).1)
    }
}

/// What a property's values must be.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Rule {
    /// Any number.
    Any,
    /// A coordinate: finite.
    Finite,
    /// A face's vertices: at least three, each below this.
    Indices(u64),
}

/// The bytes after the header.
pub(super) struct Source<'a> {
    scanner: Scanner<'a>,
    encoding: Encoding,
}

impl<'a> Source<'a> {
    pub(super) fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self {
            scanner: Scanner::new(bytes, header.end),
            encoding: header.encoding,
        }
    }

    /// Reads all rows of `element`; keeps those of vertices and faces.
    pub(super) fn rows(
        &mut self,
        element: &Element,
        vertex_count: u64,
        monitor: &dyn Monitor,
    ) -> Result<Rows, IoError> {
        self.check_count(element)?;
        let keep = matches!(element.name.as_str(), "vertex" | "face");
        let count = if element.properties.is_empty() {
            0
        } else {
            element.count as usize
        };
        let mut columns: Vec<_> = element
            .properties
            .iter()
            .map(|property| match property.count {
                None => Column::Scalar {
                    kind: property.value,
                    values: Vec::new(),
                },
                Some(_) => Column::List {
                    kind: property.value,
                    ends: Vec::new(),
                    values: Vec::new(),
                },
            })
            .collect();
        let rules: Vec<_> = element
            .properties
            .iter()
            .map(|property| match element.name.as_str() {
                "vertex" if matches!(property.name.as_str(), "x" | "y" | "z") => Rule::Finite,
                "face" if INDEX_NAMES.contains(&property.name.as_str()) => {
                    Rule::Indices(vertex_count)
                }
                _ => Rule::Any,
            })
            .collect();
        for row in 0..count {
            if row.is_multiple_of(1 << 14) {
                monitor.check()?;
                monitor.progress(self.scanner.at as u64, self.scanner.bytes.len() as u64);
            }
            for ((property, column), rule) in
                element.properties.iter().zip(&mut columns).zip(&rules)
            {
                self.value(property, column, *rule)?;
                if !keep {
                    column.clear();
                }
            }
        }
        let names = element
            .properties
            .iter()
            .map(|property| property.name.clone());
        Ok(Rows {
            count,
            columns: names.zip(columns).collect(),
        })
    }

    /// Refuses a count that the rest of the file cannot hold, before anything
    /// is allocated for it.
    fn check_count(&self, element: &Element) -> Result<(), IoError> {
        let least = |property: &Property| match self.encoding {
            // A character and a blank.
            Encoding::Ascii => 2,
            _ => property.count.unwrap_or(property.value).size(),
        };
        let row: usize = element.properties.iter().map(least).sum();
        // The last value of a text needs no blank.
        let left = self.scanner.bytes.len() - self.scanner.at.min(self.scanner.bytes.len()) + 1;
        if u128::from(element.count) * row as u128 <= left as u128 {
            return Ok(());
        }
        let cause = format!(
            "the header says {} elements `{}` of at least {row} bytes, but {} bytes are left",
            element.count,
            crate::error::shorten(&element.name),
            left - 1
        );
        Err(self.fail(FaultKind::Truncated, self.scanner.at, cause))
    }

    fn value(
        &mut self,
        property: &Property,
        column: &mut Column,
        rule: Rule,
    ) -> Result<(), IoError> {
        let at = self.scanner.at;
        match column {
            Column::Scalar { values, .. } => {
                let value = self.number(property.value)?;
                if rule == Rule::Finite && !value.is_finite() {
                    let cause = format!("the coordinate `{}` is not finite", property.name);
                    return Err(self.fail(FaultKind::NotFinite, at, cause));
                }
                values.push(value);
            }
            Column::List { ends, values, .. } => {
                let count = self.number(property.count.unwrap_or(Type::U8))?;
                let Some(count) = whole(count) else {
                    let cause = format!("{count} is not the length of a list");
                    return Err(self.fail(FaultKind::Syntax, at, cause));
                };
                self.check_list(property, count, at)?;
                if matches!(rule, Rule::Indices(_)) && count < 3 {
                    let cause = format!("the face has {count} corners; a face needs at least 3");
                    return Err(self.fail(FaultKind::Syntax, at, cause));
                }
                for _ in 0..count {
                    let at = self.scanner.at;
                    let value = self.number(property.value)?;
                    if let Rule::Indices(limit) = rule
                        && whole(value).is_none_or(|index| index >= limit)
                    {
                        let cause = format!(
                            "the face names vertex {value}, but there are {limit}, counted from 0"
                        );
                        return Err(self.fail(FaultKind::OutOfRange, at, cause));
                    }
                    values.push(value);
                }
                ends.push(values.len());
            }
        }
        Ok(())
    }

    /// Refuses a list that the rest of the file cannot hold.
    fn check_list(&self, property: &Property, count: u64, at: usize) -> Result<(), IoError> {
        let size = if self.encoding == Encoding::Ascii {
            2
        } else {
            property.value.size()
        };
        let left = self.scanner.bytes.len() - self.scanner.at + 1;
        if u128::from(count) * size as u128 <= left as u128 {
            return Ok(());
        }
        let cause = format!(
            "the list says {count} values, but {} bytes are left",
            left - 1
        );
        Err(self.fail(FaultKind::Truncated, at, cause))
    }

    fn number(&mut self, kind: Type) -> Result<f64, IoError> {
        match self.encoding {
            Encoding::Ascii => self.text_number(),
            Encoding::LittleEndian => self.binary_number(kind, false),
            Encoding::BigEndian => self.binary_number(kind, true),
        }
    }

    fn text_number(&mut self) -> Result<f64, IoError> {
        loop {
            self.scanner.skip_blanks();
            match self.scanner.peek() {
                Some(b'\n' | b'\r') => self.scanner.next_line(),
                Some(_) => break,
                None => {
                    let cause = "the file ends within its values".to_owned();
                    return Err(self.fail(FaultKind::Truncated, self.scanner.at, cause));
                }
            }
        }
        let at = self.scanner.at;
        match self.scanner.number() {
            Ok(value) => Ok(value),
            Err(BadNumber::NotFinite) => {
                self.scanner.word();
                Ok(f64::NAN)
            }
            Err(BadNumber::Text) => {
                let cause = format!("{} is not a number", quote(self.scanner.word()));
                Err(self.fail(FaultKind::Syntax, at, cause))
            }
        }
    }

    fn binary_number(&mut self, kind: Type, big: bool) -> Result<f64, IoError> {
        let size = kind.size();
        let Some(bytes) = self
            .scanner
            .bytes
            .get(self.scanner.at..self.scanner.at + size)
        else {
            let cause = "the file ends within its values".to_owned();
            return Err(self.fail(FaultKind::Truncated, self.scanner.at, cause));
        };
        // Little endian, filled up with zeros.
        let mut word = [0; 8];
        word[..size].copy_from_slice(bytes);
        if big {
            word[..size].reverse();
        }
        self.scanner.at += size;
        let bits = u64::from_le_bytes(word);
        Ok(match kind {
            Type::I8 => f64::from(bits as i8),
            Type::U8 => f64::from(bits as u8),
            Type::I16 => f64::from(bits as i16),
            Type::U16 => f64::from(bits as u16),
            Type::I32 => f64::from(bits as i32),
            Type::U32 => f64::from(bits as u32),
            Type::F32 => f64::from(f32::from_bits(bits as u32)),
            Type::F64 => f64::from_bits(bits),
        })
    }

    fn fail(&self, kind: FaultKind, at: usize, cause: String) -> IoError {
        let place = match self.encoding {
            Encoding::Ascii => text::place(self.scanner.bytes, at),
            _ => Place::Byte(at as u64),
        };
        IoError::new(kind, place, cause, EXPORT)
    }
}

impl Column {
    fn clear(&mut self) {
        match self {
            Self::Scalar { values, .. } => values.clear(),
            Self::List { ends, values, .. } => {
                ends.clear();
                values.clear();
            }
        }
    }
}

/// `value` as a whole number from 0 to 2³², if it is one.
fn whole(value: f64) -> Option<u64> {
    let index = value as u64;
    #[expect(clippy::float_cmp, reason = "whole numbers of this size are exact")]
    ((0.0..=4_294_967_296.0).contains(&value) && index as f64 == value).then_some(index)
}
