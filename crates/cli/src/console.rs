//! Where text goes: the one way to stdout and stderr.

use std::io::{self, Write};

/// The two streams of a command, and what may be written to them.
///
/// Writing never fails for the caller: a closed stdout (`| head -1`) is no
/// fault, any other failure is kept and shown once at the end, and stderr is
/// only for people.
pub(crate) struct Console<'a> {
    out: &'a mut dyn Write,
    err: &'a mut dyn Write,
    styled: bool,
    live: bool,
    out_failure: Option<io::Error>,
}

impl<'a> Console<'a> {
    /// Plain text, nothing that moves: for tests and for pipes.
    pub(crate) fn plain(out: &'a mut dyn Write, err: &'a mut dyn Write) -> Self {
        Self {
            out,
            err,
            styled: false,
            live: false,
            out_failure: None,
        }
    }

    /// Streams that take styled text (and strip it where it is not wanted);
    /// `live` says that stderr is a terminal that progress can be drawn on.
    pub(crate) fn styled(out: &'a mut dyn Write, err: &'a mut dyn Write, live: bool) -> Self {
        Self {
            out,
            err,
            styled: true,
            live,
            out_failure: None,
        }
    }

    /// Whether text may carry colours.
    pub(crate) fn is_styled(&self) -> bool {
        self.styled
    }

    /// Whether progress may be drawn on stderr.
    pub(crate) fn is_live(&self) -> bool {
        self.live
    }

    /// Writes data that was asked for.
    pub(crate) fn data(&mut self, text: &str) {
        if self.out_failure.is_some() {
            return;
        }
        let written = self
            .out
            .write_all(text.as_bytes())
            .and_then(|()| self.out.flush());
        self.out_failure = written.err();
    }

    /// Writes something for people.
    pub(crate) fn note(&mut self, text: &str) {
        // Without stderr there is nowhere left to complain to.
        let _ = self
            .err
            .write_all(text.as_bytes())
            .and_then(|()| self.err.flush());
    }

    /// Whether data can no longer be written, for whatever reason.
    pub(crate) fn has_lost_out(&self) -> bool {
        self.out_failure.is_some()
    }

    /// Why data could not be written, unless its reader simply went away.
    pub(crate) fn out_failure(&self) -> Option<&io::Error> {
        self.out_failure
            .as_ref()
            .filter(|error| error.kind() != io::ErrorKind::BrokenPipe)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A writer that always fails in one way.
    struct Fails(io::ErrorKind);

    impl Write for Fails {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_reader_that_went_away_is_no_fault() {
        for (kind, fault) in [
            (io::ErrorKind::BrokenPipe, false),
            (io::ErrorKind::StorageFull, true),
        ] {
            let (mut out, mut err) = (Fails(kind), Fails(kind));
            let mut console = Console::plain(&mut out, &mut err);
            console.data("a");
            console.note("b");
            assert_eq!(console.out_failure().is_some(), fault);
        }
    }
}
