//! The statements of an OBJ file, or of a part of it.

use glam::{DVec2, DVec3};
use tessgraph_geometry::Monitor;
use tessgraph_geometry::glam;

use super::statements::{Counts, NONE, Statements};
use crate::error::IoError;
use crate::text::{BadNumber, Scanner};

/// Statements between two looks at the monitor.
const POLL: usize = 1 << 14;

/// Reads the statements of a part of a file.
pub(super) struct Parser<'a> {
    pub(super) scanner: Scanner<'a>,
    monitor: &'a dyn Monitor,
    /// A face that names a vertex from here on is an error.
    pub(super) vertex_limit: usize,
    /// What the parts before say; `None` if that is not known yet.
    pub(super) before: Option<Counts>,
    /// A face counted backwards from what is not known yet: its indices are
    /// wrong, and the part has to be read again.
    pub(super) counted_backwards: bool,
    pub(super) said: Statements<'a>,
}

impl<'a> Parser<'a> {
    /// A parser from byte `start` on to the end of `bytes`, which puts what it
    /// reads into `said`, whatever there was.
    pub(super) fn new(
        bytes: &'a [u8],
        start: usize,
        mut said: Statements<'a>,
        monitor: &'a dyn Monitor,
    ) -> Self {
        said.clear();
        Self {
            scanner: Scanner::new(bytes, start),
            monitor,
            vertex_limit: usize::MAX,
            before: None,
            counted_backwards: false,
            said,
        }
    }

    /// All there is so far, of what is known.
    pub(super) fn counts(&self) -> Counts {
        self.before.unwrap_or_default().with(&self.said)
    }

    /// Reads all statements.
    ///
    /// # Errors
    /// At the first statement that is wrong.
    pub(super) fn run(&mut self) -> Result<(), IoError> {
        let mut until_poll = 1;
        loop {
            until_poll -= 1;
            if until_poll == 0 {
                until_poll = POLL;
                self.monitor.check()?;
            }
            self.scanner.skip_blanks();
            let ahead = |k: usize| self.scanner.bytes.get(self.scanner.at + k).copied();
            let start = self.scanner.at;
            match (ahead(0), ahead(1), ahead(2)) {
                (None, ..) => return Ok(()),
                (Some(b'\n' | b'\r' | b'#'), ..) => {}
                (Some(b'v'), Some(b' ' | b'\t'), _) => {
                    self.scanner.at += 1;
                    self.vertex(start)?;
                }
                (Some(b'f'), Some(b' ' | b'\t'), _) => {
                    self.scanner.at += 1;
                    self.face(start)?;
                }
                (Some(b'v'), Some(b't'), Some(b' ' | b'\t')) => {
                    self.scanner.at += 2;
                    self.uv(start)?;
                }
                (Some(b'v'), Some(b'n'), Some(b' ' | b'\t')) => {
                    self.scanner.at += 2;
                    self.normal(start)?;
                }
                _ => self.other_statement(start)?,
            }
            self.scanner.next_line();
        }
    }

    #[inline]
    pub(super) fn vertex(&mut self, start: usize) -> Result<(), IoError> {
        self.said.known += 1;
        let mut place = [0.0; 3];
        for (k, value) in place.iter_mut().enumerate() {
            if !self.scanner.more() {
                return Err(self.too_few_numbers(start, "vertex", k, "three coordinates"));
            }
            *value = match self.scanner.number() {
                Ok(value) => value,
                Err(bad) => return Err(self.bad_number(bad, "coordinate")),
            };
        }
        self.said.positions.push(DVec3::from(place));
        if self.scanner.more() {
            self.color(start)?;
        } else if !self.said.colors.is_empty() {
            self.said.colors.push(DVec3::ONE);
        }
        Ok(())
    }

    /// Numbers after the coordinates: a weight (4th), a colour (4th to 6th),
    /// or a colour with opacity.
    #[cold]
    fn color(&mut self, start: usize) -> Result<(), IoError> {
        let mut extra = [0.0; 4];
        let mut count = 0;
        let mut finite = true;
        while self.scanner.more() && count < extra.len() {
            extra[count] = match self.scanner.number() {
                Ok(value) => value,
                Err(BadNumber::NotFinite) => {
                    self.scanner.word();
                    finite = false;
                    0.0
                }
                Err(bad) => return Err(self.bad_number(bad, "number after the coordinates")),
            };
            count += 1;
        }
        if count == 2 || self.scanner.more() {
            self.said.passed_over.extra_numbers.note(start);
        }
        if count >= 3 && self.said.colors.is_empty() {
            self.said
                .colors
                .resize(self.said.positions.len() - 1, DVec3::ONE);
        }
        if !finite {
            self.said.passed_over.bad_colors.note(start);
        }
        if count >= 3 && finite {
            self.said
                .colors
                .push(DVec3::new(extra[0], extra[1], extra[2]));
        } else if !self.said.colors.is_empty() || count >= 3 {
            self.said.colors.push(DVec3::ONE);
        }
        Ok(())
    }

    /// `vt u [v [w]]`; v is 0 where it is missing, w is not read.
    pub(super) fn uv(&mut self, start: usize) -> Result<(), IoError> {
        self.said.known += 1;
        let mut place = [0.0; 2];
        for (k, value) in place.iter_mut().enumerate() {
            if self.scanner.more() {
                *value = match self.scanner.number() {
                    Ok(value) => value,
                    Err(bad) => return Err(self.bad_number(bad, "texture coordinate")),
                };
            } else if k == 0 {
                return Err(self.too_few_numbers(start, "texture coordinate", 0, "a number"));
            }
        }
        self.said.uvs.push(DVec2::from(place));
        Ok(())
    }

    pub(super) fn normal(&mut self, start: usize) -> Result<(), IoError> {
        self.said.known += 1;
        let mut normal = [0.0; 3];
        for (k, value) in normal.iter_mut().enumerate() {
            if !self.scanner.more() {
                return Err(self.too_few_numbers(start, "normal", k, "three numbers"));
            }
            *value = match self.scanner.number() {
                Ok(value) => value,
                // Exporters write NaN as the normal of a degenerate face.
                Err(BadNumber::NotFinite) => {
                    self.said.passed_over.bad_normals.note(start);
                    self.said.normals.push(DVec3::ZERO);
                    return Ok(());
                }
                Err(bad) => return Err(self.bad_number(bad, "component of a normal")),
            };
        }
        self.said.normals.push(DVec3::from(normal));
        Ok(())
    }

    #[inline]
    pub(super) fn face(&mut self, start: usize) -> Result<(), IoError> {
        self.said.known += 1;
        let first = self.said.corners.len();
        let mut highest = self.said.highest;
        loop {
            let before = self.scanner.at;
            let Some(index) = self.scanner.blank_and_digits() else {
                break;
            };
            if index == 0 || index as usize > self.vertex_limit {
                self.scanner.at = before;
                break;
            }
            highest = highest.max(index as usize);
            self.said.corners.push(index - 1);
        }
        self.said.highest = highest;
        // Corners of more than a vertex, with several blanks, or wrong.
        while self.scanner.more() {
            self.corner()?;
        }
        let count = self.said.corners.len() - first;
        if count < 3 {
            return Err(self.too_few_corners(start, count));
        }
        if self.counts().corners >= NONE as usize {
            return Err(self.too_many_corners(start));
        }
        self.said.ends.push(self.said.corners.len() as u32);
        Ok(())
    }

    /// One corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`; empty parts are allowed.
    #[inline]
    fn corner(&mut self) -> Result<(), IoError> {
        let start = self.scanner.at;
        let Some(index) = self.scanner.integer() else {
            return Err(self.bad_index(start));
        };
        if !self.scanner.word_is_over() && self.scanner.peek() != Some(b'/') {
            return Err(self.bad_index(start));
        }
        let vertex = match index {
            1.. => index as u64 as usize - 1,
            0 => return Err(self.no_such_vertex(start, index)),
            _ => match self.backwards(index, self.counts().vertices) {
                Some(vertex) => vertex,
                None => return Err(self.no_such_vertex(start, index)),
            },
        };
        if vertex >= self.vertex_limit {
            return Err(self.no_such_vertex(start, index));
        }
        self.said.highest = self.said.highest.max(vertex + 1);
        if self.scanner.peek() == Some(b'/') {
            let (uv, normal) = self.more_indices(start)?;
            if uv != NONE {
                self.said.corner_uvs.resize(self.said.corners.len(), NONE);
                self.said.corner_uvs.push(uv);
            }
            if normal != NONE {
                self.said
                    .corner_normals
                    .resize(self.said.corners.len(), NONE);
                self.said.corner_normals.push(normal);
            }
        }
        if !self.scanner.word_is_over() {
            return Err(self.bad_index(start));
        }
        self.said.corners.push(vertex.min(NONE as usize - 1) as u32);
        Ok(())
    }

    /// The parts behind the slashes as indices from 0; one too high is kept as
    /// it is and dealt with when all counts are known.
    #[inline]
    fn more_indices(&mut self, start: usize) -> Result<(u32, u32), IoError> {
        let mut parts = [NONE; 2];
        let counts = self.counts();
        let counts = [counts.uvs, counts.normals];
        for (part, count) in parts.iter_mut().zip(counts) {
            if self.scanner.peek() != Some(b'/') {
                break;
            }
            self.scanner.at += 1;
            if matches!(self.scanner.peek(), Some(b'0'..=b'9' | b'-' | b'+')) {
                let Some(index) = self.scanner.integer() else {
                    return Err(self.bad_index(start));
                };
                *part = match index {
                    1.. => (index - 1).min(i64::from(NONE - 1)) as u32,
                    // Missing data, as one too high: NONE - 1 is never there.
                    _ => self
                        .backwards(index, count)
                        .map_or(NONE - 1, |index| index.min(NONE as usize - 1) as u32),
                };
            }
        }
        Ok((parts[0], parts[1]))
    }

    /// The element that an index below zero means where `count` are known. Where
    /// not all are, any, and the part has to be read again.
    fn backwards(&mut self, index: i64, count: usize) -> Option<usize> {
        if index >= 0 {
            return None;
        }
        if self.before.is_none() {
            self.counted_backwards = true;
            return Some(0);
        }
        count.checked_sub(usize::try_from(index.unsigned_abs()).ok()?)
    }
}
