//! Libraries of other languages, as programs that do the work when asked to.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use tempfile::TempDir;

use crate::report;

/// The input of such programs: arrays, each a file of little-endian numbers.
#[derive(Debug)]
pub struct Arrays {
    folder: TempDir,
}

impl Default for Arrays {
    fn default() -> Self {
        Self::new()
    }
}

impl Arrays {
    /// No arrays yet.
    ///
    /// # Panics
    /// If there is no place for temporary files.
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder for temporary files");
        Self { folder }
    }

    /// Adds `NAME.f64`.
    ///
    /// # Panics
    /// If it cannot be written.
    pub fn floats<const N: usize>(&self, name: &str, rows: &[[f64; N]]) -> &Self {
        let values = rows.as_flattened().iter();
        let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
        self.file(&format!("{name}.f64"), &bytes)
    }

    /// Adds `NAME.u32`.
    ///
    /// # Panics
    /// If it cannot be written.
    pub fn indices<const N: usize>(&self, name: &str, rows: &[[u32; N]]) -> &Self {
        let values = rows.as_flattened().iter();
        let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
        self.file(&format!("{name}.u32"), &bytes)
    }

    /// Adds a file as it is.
    ///
    /// # Panics
    /// If it cannot be written.
    pub fn file(&self, name: &str, bytes: &[u8]) -> &Self {
        let path = self.folder.path().join(name);
        fs::write(path, bytes).expect("room for a benchmark's input");
        self
    }
}

/// A program of `benches/peers` that waits for work.
pub(crate) struct Outside {
    child: Child,
    ask: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Outside {
    /// Starts `benches/peers/peers.py`; says on stderr why if it, or the library,
    /// is not there. `TESSGRAPH_PEERS_PYTHON` names the Python that has them.
    pub(crate) fn start(library: &str, work: &str, arrays: &Arrays) -> Option<Self> {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/peers/peers.py");
        let python = std::env::var_os("TESSGRAPH_PEERS_PYTHON").unwrap_or("python3".into());
        let absent = |reason: &str| report::absent(library, reason.trim());
        let started = Command::new(python)
            .arg(script)
            .args([library, work])
            .arg(arrays.folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut child = match started {
            Ok(child) => child,
            Err(error) => {
                absent(&error.to_string());
                return None;
            }
        };
        let (ask, answers) = child.stdin.take().zip(child.stdout.take())?;
        let mut outside = Self {
            child,
            ask,
            answers: BufReader::new(answers),
        };
        match outside.answer() {
            Some(line) if line.trim() == "ready" => Some(outside),
            line => {
                absent(line.as_deref().unwrap_or("it ended at once"));
                None
            }
        }
    }

    fn answer(&mut self) -> Option<String> {
        let mut line = String::new();
        let read = self.answers.read_line(&mut line).ok()?;
        (read > 0).then_some(line)
    }

    /// Does the work once: its processor time.
    ///
    /// # Panics
    /// If the program ends instead.
    pub(crate) fn run(&mut self) -> Duration {
        let asked = self.ask.write_all(b"run\n").and_then(|()| self.ask.flush());
        let nanoseconds = asked
            .ok()
            .and_then(|()| self.answer())
            .and_then(|line| line.trim().parse().ok());
        Duration::from_nanos(nanoseconds.expect("a peer that was ready does its work"))
    }
}

impl Drop for Outside {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
