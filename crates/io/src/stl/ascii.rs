//! ASCII STL: `solid`, `facet`, `vertex`.

use tessgraph_geometry::Monitor;

use super::{DVec3, Soup, text};
use crate::error::{FaultKind, IoError, quote};
use crate::labels::Runs;
use crate::text::{BadNumber, Scanner};

/// Whether a file that is not binary is ASCII STL: `solid`, and soon `facet`
/// or `endsolid`.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let text = text::without_bom(bytes).trim_ascii_start();
    let head = text[..text.len().min(2048)].to_ascii_lowercase();
    let has = |word: &[u8]| memchr::memmem::find(&head, word).is_some();
    head.starts_with(b"solid") && (has(b"facet") || has(b"endsolid"))
}

/// Reads the triangles of all solids.
pub(super) fn read(bytes: &[u8], monitor: &dyn Monitor) -> Result<Soup, IoError> {
    let start = bytes.len() - text::without_bom(bytes).len();
    let mut reader = Reader {
        scanner: Scanner::new(bytes, start),
        corners: Vec::new(),
        objects: Runs::default(),
        open: None,
        vertices: 0,
    };
    let mut lines = 0_usize;
    while reader.scanner.peek().is_some() {
        if lines.is_multiple_of(1 << 14) {
            monitor.check()?;
            monitor.progress(reader.scanner.at as u64, bytes.len() as u64);
        }
        lines += 1;
        reader.line()?;
        reader.scanner.next_line();
    }
    if let Some(at) = reader.open {
        let cause = "the file ends within this facet".to_owned();
        return Err(reader.fail(FaultKind::Truncated, at, cause));
    }
    let faces = reader.corners.len() / 3;
    let name = |name: &&[u8]| (!name.is_empty()).then(|| text::decode(name));
    let objects = reader.objects.finish(faces, name)?;
    Ok(Soup {
        corners: reader.corners,
        objects,
        warnings: Vec::new(),
    })
}

struct Reader<'a> {
    scanner: Scanner<'a>,
    corners: Vec<DVec3>,
    objects: Runs<&'a [u8]>,
    /// Start of the facet that is being read.
    open: Option<usize>,
    /// Vertices it has so far.
    vertices: usize,
}

impl Reader<'_> {
    fn line(&mut self) -> Result<(), IoError> {
        self.scanner.skip_blanks();
        let at = self.scanner.at;
        let word = self.scanner.word();
        let is = |keyword: &[u8]| word.eq_ignore_ascii_case(keyword);
        if is(b"vertex") {
            return self.vertex(at);
        }
        if is(b"facet") {
            return self.facet(at);
        }
        if is(b"endfacet") {
            if self.open.take().is_none() || self.vertices != 3 {
                let cause = "the facet does not have three vertices".to_owned();
                return Err(self.fail(FaultKind::Syntax, at, cause));
            }
            return Ok(());
        }
        if is(b"solid") {
            let name = self.scanner.rest();
            self.objects.start(self.corners.len() / 3, name);
            return Ok(());
        }
        let known = [
            &b""[..],
            b"outer",
            b"endloop",
            b"endsolid",
            b"end",
            b"color",
        ];
        if known.iter().any(|keyword| is(keyword)) {
            return Ok(());
        }
        let cause = format!("{} is not an STL statement", quote(word));
        Err(self.fail(FaultKind::Syntax, at, cause))
    }

    fn facet(&mut self, at: usize) -> Result<(), IoError> {
        if self.open.replace(at).is_some() {
            let cause = "a facet begins before the last one has ended".to_owned();
            return Err(self.fail(FaultKind::Syntax, at, cause));
        }
        self.vertices = 0;
        Ok(())
    }

    fn vertex(&mut self, at: usize) -> Result<(), IoError> {
        let mut place = [0.0; 3];
        for value in &mut place {
            self.scanner.skip_blanks();
            let at = self.scanner.at;
            *value = self.scanner.number().map_err(|bad| {
                let word = quote(Scanner::new(self.scanner.bytes, at).word());
                match bad {
                    BadNumber::NotFinite => self.fail(
                        FaultKind::NotFinite,
                        at,
                        format!("the coordinate {word} is not finite"),
                    ),
                    BadNumber::Text => self.fail(
                        FaultKind::Syntax,
                        at,
                        format!("the coordinate {word} is not a number"),
                    ),
                }
            })?;
        }
        if self.open.is_none() || self.vertices == 3 {
            let cause = "the vertex is a fourth of its facet, or in none".to_owned();
            return Err(self.fail(FaultKind::Syntax, at, cause));
        }
        self.vertices += 1;
        self.corners.push(DVec3::from(place));
        Ok(())
    }

    fn fail(&self, kind: FaultKind, at: usize, cause: String) -> IoError {
        let place = text::place(self.scanner.bytes, at);
        IoError::new(kind, place, cause, "export it again")
    }
}
