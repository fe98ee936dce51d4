//! What the OBJ reader says about statements it cannot take, and the
//! statements besides vertices and faces.

use super::parse::Parser;
use crate::error::{FaultKind, IoError, quote};
use crate::text::{self, BadNumber};

const EXPORT: &str = "correct the line, or export the mesh again";

/// Statements that change the look of a mesh, not the mesh.
const LOOKS: &[&[u8]] = &[
    b"s",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"usemap",
    b"maplib",
    b"shadow_obj",
    b"trace_obj",
    b"mg",
];

/// Statements of free-form curves and surfaces.
const FREE_FORM: &[&[u8]] = &[
    b"vp", b"cstype", b"deg", b"bmat", b"step", b"curv", b"curv2", b"surf", b"parm", b"trim",
    b"hole", b"scrv", b"sp", b"end", b"con", b"ctech", b"stech", b"bsp", b"bzp", b"cdc", b"cdp",
    b"res",
];

impl Parser<'_> {
    /// Any statement that does not make up most of a file.
    #[cold]
    pub(super) fn other_statement(&mut self, start: usize) -> Result<(), IoError> {
        let word = self.scanner.word();
        self.said.known += 1;
        match word {
            // With a joined line end, or nothing, behind the name.
            b"v" => return self.vertex(start),
            b"vt" => return self.uv(start),
            b"vn" => return self.normal(start),
            // `fo` is the old spelling.
            b"f" | b"fo" => return self.face(start),
            b"g" => {
                let names = self.scanner.rest();
                self.said.groups.start(self.said.ends.len(), names);
            }
            b"o" => {
                let name = self.scanner.rest();
                self.said.objects.start(self.said.ends.len(), name);
            }
            b"usemtl" => {
                let name = self.scanner.rest();
                self.said.materials.start(self.said.ends.len(), name);
            }
            b"mtllib" => {
                let names = self.scanner.rest();
                self.said.libraries.push((names, start));
            }
            b"t" => self.tag(start),
            b"l" | b"p" => self.said.passed_over.lines_and_points.note(start),
            b"call" | b"csh" => self.said.passed_over.commands.note(start),
            _ if FREE_FORM.contains(&word) => self.said.passed_over.free_form.note(start),
            _ if LOOKS.contains(&word) => {}
            _ if is_merge_mark(word) => return Err(self.merge_mark(start)),
            _ => {
                self.said.known -= 1;
                self.said.passed_over.unknown.note(start);
            }
        }
        Ok(())
    }

    pub(super) fn fail(&self, kind: FaultKind, at: usize, cause: String, help: &str) -> IoError {
        IoError::new(kind, text::place(self.scanner.bytes, at), cause, help)
    }

    /// The word at the cursor, for a message.
    fn quoted_word(&self, at: usize) -> String {
        quote(text::Scanner::new(self.scanner.bytes, at).word())
    }

    #[cold]
    pub(super) fn bad_number(&self, bad: BadNumber, what: &str) -> IoError {
        let at = self.scanner.at;
        let word = self.quoted_word(at);
        match bad {
            BadNumber::NotFinite => {
                let cause = format!("the {what} {word} is not finite");
                self.fail(FaultKind::NotFinite, at, cause, EXPORT)
            }
            BadNumber::Text if word.contains(',') => {
                let cause = format!("the {what} {word} is not a number");
                self.fail(
                    FaultKind::Syntax,
                    at,
                    cause,
                    "write decimals with a point, not a comma",
                )
            }
            BadNumber::Text => {
                let cause = format!("the {what} {word} is not a number");
                self.fail(FaultKind::Syntax, at, cause, EXPORT)
            }
        }
    }

    #[cold]
    pub(super) fn too_few_numbers(&self, at: usize, what: &str, got: usize, need: &str) -> IoError {
        let cause = format!("the {what} has {got} of the {need} it needs");
        let cause = if got == 0 {
            format!("the {what} lacks {need}")
        } else {
            cause
        };
        self.fail(FaultKind::Syntax, at, cause, EXPORT)
    }

    #[cold]
    pub(super) fn too_few_corners(&self, at: usize, count: usize) -> IoError {
        let corners = crate::warnings::count(count, ["corner", "corners"]);
        let cause = format!("the face has {corners}; a face needs at least 3");
        self.fail(
            FaultKind::Syntax,
            at,
            cause,
            "remove the face, or write an edge as `l`",
        )
    }

    #[cold]
    pub(super) fn too_many_corners(&self, at: usize) -> IoError {
        let cause = "the faces have more than 4294967294 corners".to_owned();
        self.fail(FaultKind::TooLarge, at, cause, "split the file")
    }

    #[cold]
    pub(super) fn bad_index(&self, at: usize) -> IoError {
        let word = self.quoted_word(at);
        let cause = format!("{word} is not a corner of a face: v/vt/vn, each a whole number");
        self.fail(FaultKind::Syntax, at, cause, EXPORT)
    }

    #[cold]
    pub(super) fn no_such_vertex(&self, at: usize, index: i64) -> IoError {
        let count = self.counts().vertices;
        let cause = match index {
            0 => "the face names vertex 0, but vertices are counted from 1".to_owned(),
            1.. => {
                format!(
                    "the face names vertex {index}, but there are {}",
                    self.vertex_limit
                )
            }
            _ => format!("the face names vertex {index}, but there are only {count} before it"),
        };
        self.fail(FaultKind::OutOfRange, at, cause, EXPORT)
    }

    fn merge_mark(&self, at: usize) -> IoError {
        let cause = "a git merge was left unresolved here".to_owned();
        self.fail(FaultKind::Syntax, at, cause, "resolve the merge first")
    }
}

fn is_merge_mark(word: &[u8]) -> bool {
    matches!(word, b"<<<<<<<" | b"=======" | b">>>>>>>")
}
