//! A folder to run the program in, and what came of a run.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::support::program::program;

/// No fault may take longer, on the slowest machine.
const DEADLINE: Duration = Duration::from_secs(120);

/// Kibibytes of address space that `info` may take on any file: 512 MiB.
pub(super) const SMALL: u64 = 512 << 10;

/// A folder with a cache beside it, both gone at the end.
pub(super) struct Desk {
    folder: TempDir,
    cache: TempDir,
}

impl Desk {
    pub(super) fn new() -> Self {
        let folder = || tempfile::tempdir().expect("a folder");
        Self {
            folder: folder(),
            cache: folder(),
        }
    }

    /// A folder with the graph `g.ron`.
    pub(super) fn with(graph: impl AsRef<[u8]>) -> Self {
        let desk = Self::new();
        desk.write("g.ron", graph);
        desk
    }

    /// A folder with a graph of these nodes that writes node "out".
    pub(super) fn nodes(nodes: &str) -> Self {
        Self::with(graph(nodes))
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(super) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("below")).expect("a folder");
        std::fs::write(&path, content).expect("a file");
        path
    }

    /// The program in this folder, not yet started.
    pub(super) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(program());
        command.args(arguments);
        self.settle(&mut command);
        command
    }

    /// The same within so many kibibytes of address space.
    #[cfg(unix)]
    pub(super) fn limited(&self, kibibytes: u64, arguments: &[&str]) -> Done {
        let mut command = Command::new("sh");
        let script = format!("ulimit -v {kibibytes}; exec \"$@\"");
        command.arg("-c").arg(script).arg("sh");
        command.arg(program()).args(arguments);
        self.settle(&mut command);
        self.wait(command)
    }

    fn settle(&self, command: &mut Command) {
        command
            .current_dir(self.folder.path())
            .env("TESSGRAPH_CACHE", self.cache.path());
    }

    /// Runs the program and waits for its end.
    pub(super) fn run(&self, arguments: &[&str]) -> Done {
        self.wait(self.command(arguments))
    }

    /// Runs the graph `g.ron`.
    pub(super) fn go(&self) -> Done {
        self.run(&["run", "g.ron"])
    }

    pub(super) fn wait(&self, mut command: Command) -> Done {
        let [out, err] = [0, 1].map(|_| tempfile::tempfile().expect("a file"));
        let start = Instant::now();
        let clone = |file: &std::fs::File| Stdio::from(file.try_clone().expect("a handle"));
        let mut child = command
            .stdin(Stdio::null())
            .stdout(clone(&out))
            .stderr(clone(&err))
            .spawn()
            .expect("the program starts");
        let status = loop {
            if let Some(status) = child.try_wait().expect("a status") {
                break status;
            }
            if start.elapsed() > DEADLINE {
                child.kill().expect("a process");
                panic!("{command:?} did not end: {}", content(err));
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        Done {
            status: status.code(),
            out: content(out),
            err: content(err),
            took: start.elapsed(),
        }
    }

    /// Everything in the folder, by relative path, apart from what a test wrote.
    pub(super) fn names(&self) -> Vec<String> {
        names(self.folder.path())
    }

    pub(super) fn content(&self, name: &str) -> Vec<u8> {
        #[allow(clippy::disallowed_methods, reason = "tests read what was written")]
        std::fs::read(self.path(name)).expect("a file")
    }
}

/// A graph of these nodes that writes node "out".
pub(super) fn graph(nodes: &str) -> String {
    format!("Graph(version: 1, nodes: {{{nodes}}}, outputs: {{\"out/o.obj\": \"out\"}})")
}

/// Names of everything below a folder, in order.
pub(super) fn names(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(folder).expect("below");
            found.push(name.to_string_lossy().into_owned());
            if path.is_dir() && !path.is_symlink() {
                folders.push(path);
            }
        }
    }
    found.sort();
    found
}

fn content(mut file: std::fs::File) -> String {
    use std::io::{Read as _, Seek as _};
    let mut bytes = Vec::new();
    file.rewind().expect("a file");
    file.read_to_end(&mut bytes).expect("a file");
    String::from_utf8_lossy(&bytes).into_owned()
}

/// What a run came to.
pub(super) struct Done {
    /// `None` when a signal ended it.
    pub(super) status: Option<i32>,
    pub(super) out: String,
    pub(super) err: String,
    pub(super) took: Duration,
}

impl Done {
    /// A refusal as it should be: a status of its own, a cause, a way out, all
    /// of `says`, and nothing that belongs to a crash or steers a terminal.
    #[track_caller]
    pub(super) fn refused(&self, says: &[&str]) -> &Self {
        self.sound();
        assert!(matches!(self.status, Some(1 | 2)), "{}", self.told());
        for words in [&["error", "help"], says].concat() {
            assert!(self.err.contains(words), "no `{words}` in {}", self.told());
        }
        self
    }

    /// A success.
    #[track_caller]
    pub(super) fn made(&self) -> &Self {
        self.sound();
        assert_eq!(self.status, Some(0), "{}", self.told());
        self
    }

    /// A success with a warning that says all of this.
    #[track_caller]
    pub(super) fn warned(&self, says: &[&str]) -> &Self {
        self.made();
        for words in [&["warning"], says].concat() {
            assert!(self.err.contains(words), "no `{words}` in {}", self.told());
        }
        self
    }

    /// Neither a panic, nor a signal, nor an endless or dangerous message.
    #[track_caller]
    pub(super) fn sound(&self) -> &Self {
        assert!(self.status.is_some(), "killed: {}", self.told());
        assert!(!self.err.contains("panicked"), "{}", self.told());
        assert!(!self.err.contains('\u{1b}'), "{}", self.told());
        assert!(self.err.len() < 64 << 10, "{} bytes", self.err.len());
        self
    }

    #[track_caller]
    pub(super) fn within(&self, limit: Duration) -> &Self {
        assert!(self.took < limit, "took {:?}: {}", self.took, self.told());
        self
    }

    fn told(&self) -> String {
        let mut text = format!("status {:?}, ", self.status);
        let clip = |text: &str| text.chars().take(2000).collect::<String>();
        let _ = write!(text, "out: {}\nerr: {}", clip(&self.out), clip(&self.err));
        text
    }
}
