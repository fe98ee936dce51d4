//! One pass over the bytes of an OBJ file.

use glam::{DVec2, DVec3};
use tessgraph_geometry::Monitor;
use tessgraph_geometry::glam;

use super::tags::Tags;
use crate::error::IoError;
use crate::labels::Runs;
use crate::text::{BadNumber, Scanner, without_bom};
use crate::warnings::Counted;

/// Marks a corner without a texture coordinate or normal.
pub(super) const NONE: u32 = u32::MAX;

/// Statements between two looks at the monitor.
const POLL: usize = 1 << 14;

/// What was passed over, for one warning each.
#[derive(Debug, Default)]
pub(super) struct PassedOver {
    pub(super) lines_and_points: Counted,
    pub(super) free_form: Counted,
    pub(super) commands: Counted,
    pub(super) unknown: Counted,
    pub(super) extra_numbers: Counted,
    pub(super) bad_colors: Counted,
    pub(super) bad_normals: Counted,
    pub(super) bad_tags: Counted,
    pub(super) other_tags: Counted,
}

/// The state of reading: everything the file has said so far.
pub(super) struct Parser<'a> {
    pub(super) scanner: Scanner<'a>,
    monitor: &'a dyn Monitor,
    /// A face that names a vertex from here on is an error.
    pub(super) vertex_limit: usize,
    /// One more than the highest vertex a face names.
    highest: usize,
    pub(super) positions: Vec<DVec3>,
    /// One per vertex, or none at all.
    pub(super) colors: Vec<DVec3>,
    pub(super) uvs: Vec<DVec2>,
    pub(super) normals: Vec<DVec3>,
    pub(super) offsets: Vec<u32>,
    pub(super) corners: Vec<u32>,
    /// Texture coordinate of each corner; shorter where the last have none.
    pub(super) corner_uvs: Vec<u32>,
    /// Normal of each corner; shorter where the last have none.
    pub(super) corner_normals: Vec<u32>,
    pub(super) groups: Runs<&'a [u8]>,
    pub(super) objects: Runs<&'a [u8]>,
    pub(super) materials: Runs<&'a [u8]>,
    /// Names of material libraries, each with its place.
    pub(super) libraries: Vec<(&'a [u8], usize)>,
    pub(super) tags: Tags,
    pub(super) passed_over: PassedOver,
    /// Statements that OBJ knows.
    pub(super) known_statements: usize,
}

impl<'a> Parser<'a> {
    pub(super) fn new(bytes: &'a [u8], vertex_limit: usize, monitor: &'a dyn Monitor) -> Self {
        let start = bytes.len() - without_bom(bytes).len();
        Self {
            scanner: Scanner::new(bytes, start),
            monitor,
            vertex_limit,
            highest: 0,
            positions: Vec::new(),
            colors: Vec::new(),
            uvs: Vec::new(),
            normals: Vec::new(),
            offsets: vec![0],
            corners: Vec::new(),
            corner_uvs: Vec::new(),
            corner_normals: Vec::new(),
            groups: Runs::default(),
            objects: Runs::default(),
            materials: Runs::default(),
            libraries: Vec::new(),
            tags: Tags::default(),
            passed_over: PassedOver::default(),
            known_statements: 0,
        }
    }

    /// One more than the highest vertex index that a face names.
    pub(super) fn highest_vertex(&self) -> usize {
        self.highest
    }

    /// Faces read so far.
    pub(super) fn face_count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Reads all statements.
    ///
    /// # Errors
    /// At the first statement that is wrong.
    pub(super) fn run(&mut self) -> Result<(), IoError> {
        let total = self.scanner.bytes.len() as u64;
        let mut until_poll = 1;
        loop {
            until_poll -= 1;
            if until_poll == 0 {
                until_poll = POLL;
                self.monitor.check()?;
                self.monitor.progress(self.scanner.at as u64, total);
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
        self.known_statements += 1;
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
        self.positions.push(DVec3::from(place));
        if self.scanner.more() {
            self.color(start)?;
        } else if !self.colors.is_empty() {
            self.colors.push(DVec3::ONE);
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
            self.passed_over.extra_numbers.note(start);
        }
        if count >= 3 && self.colors.is_empty() {
            self.colors.resize(self.positions.len() - 1, DVec3::ONE);
        }
        if !finite {
            self.passed_over.bad_colors.note(start);
        }
        if count >= 3 && finite {
            self.colors.push(DVec3::new(extra[0], extra[1], extra[2]));
        } else if !self.colors.is_empty() || count >= 3 {
            self.colors.push(DVec3::ONE);
        }
        Ok(())
    }

    /// `vt u [v [w]]`; v is 0 where it is missing, w is not read.
    pub(super) fn uv(&mut self, start: usize) -> Result<(), IoError> {
        self.known_statements += 1;
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
        self.uvs.push(DVec2::from(place));
        Ok(())
    }

    pub(super) fn normal(&mut self, start: usize) -> Result<(), IoError> {
        self.known_statements += 1;
        let mut normal = [0.0; 3];
        for (k, value) in normal.iter_mut().enumerate() {
            if !self.scanner.more() {
                return Err(self.too_few_numbers(start, "normal", k, "three numbers"));
            }
            *value = match self.scanner.number() {
                Ok(value) => value,
                // Exporters write NaN as the normal of a degenerate face.
                Err(BadNumber::NotFinite) => {
                    self.passed_over.bad_normals.note(start);
                    self.normals.push(DVec3::ZERO);
                    return Ok(());
                }
                Err(bad) => return Err(self.bad_number(bad, "component of a normal")),
            };
        }
        self.normals.push(DVec3::from(normal));
        Ok(())
    }

    #[inline]
    pub(super) fn face(&mut self, start: usize) -> Result<(), IoError> {
        self.known_statements += 1;
        let first = self.corners.len();
        while self.scanner.more() {
            self.corner()?;
        }
        let count = self.corners.len() - first;
        if count < 3 {
            return Err(self.too_few_corners(start, count));
        }
        if self.corners.len() >= NONE as usize {
            return Err(self.too_many_corners(start));
        }
        self.offsets.push(self.corners.len() as u32);
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
            _ => match resolve_backwards(index, self.positions.len()) {
                Some(vertex) => vertex,
                None => return Err(self.no_such_vertex(start, index)),
            },
        };
        if vertex >= self.vertex_limit {
            return Err(self.no_such_vertex(start, index));
        }
        self.highest = self.highest.max(vertex + 1);
        if self.scanner.peek() == Some(b'/') {
            let (uv, normal) = self.more_indices(start)?;
            if uv != NONE {
                self.corner_uvs.resize(self.corners.len(), NONE);
                self.corner_uvs.push(uv);
            }
            if normal != NONE {
                self.corner_normals.resize(self.corners.len(), NONE);
                self.corner_normals.push(normal);
            }
        }
        if !self.scanner.word_is_over() {
            return Err(self.bad_index(start));
        }
        self.corners.push(vertex.min(NONE as usize - 1) as u32);
        Ok(())
    }

    /// The parts behind the slashes as indices from 0; one too high is kept as
    /// it is and dealt with when all counts are known.
    #[inline]
    fn more_indices(&mut self, start: usize) -> Result<(u32, u32), IoError> {
        let mut parts = [NONE; 2];
        let counts = [self.uvs.len(), self.normals.len()];
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
                    _ => resolve_backwards(index, count)
                        .map_or(NONE - 1, |index| index.min(NONE as usize - 1) as u32),
                };
            }
        }
        Ok((parts[0], parts[1]))
    }
}

/// The element that a negative index means when `count` are known.
#[inline]
pub(super) fn resolve_backwards(index: i64, count: usize) -> Option<usize> {
    if index >= 0 {
        return None;
    }
    count.checked_sub(usize::try_from(index.unsigned_abs()).ok()?)
}
