//! Whole commands, called as the program calls them.

mod commands;
mod paths;
mod run;
mod stand_ins;
mod watch;

use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::console::Console;
use crate::dispatch;

/// A folder to work in, and a way to run commands on its files.
struct Desk {
    folder: TempDir,
}

/// What a command gave.
struct Given {
    status: u8,
    out: String,
    err: String,
}

impl Desk {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: &str) -> PathBuf {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path
    }

    fn content(&self, name: &str) -> Vec<u8> {
        content(&self.path(name))
    }

    fn text(&self, name: &str) -> String {
        String::from_utf8(self.content(name)).unwrap()
    }

    fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&self.content(name)).unwrap()
    }

    /// Runs a command on the graph `g.ron` with the stand-in nodes.
    fn command(&self, command: &str, args: &[&str]) -> Given {
        let graph = self.path("g.ron").to_string_lossy().into_owned();
        let args = [&["tessgraph", command, &graph], args].concat();
        given(|out, err| dispatch(args, &mut Console::plain(out, err), stand_ins::NODES, None))
    }

    /// Runs any command with the real nodes.
    fn program(&self, args: &[&str]) -> Given {
        let args = [&["tessgraph"], args].concat();
        given(|out, err| crate::run(args, out, err))
    }

    /// Names of everything in a folder, in order.
    fn names(&self, folder: &str) -> Vec<String> {
        let Ok(entries) = std::fs::read_dir(self.path(folder)) else {
            return Vec::new();
        };
        let names = entries.map(|entry| entry.unwrap().file_name());
        let mut names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }
}

fn given(run: impl FnOnce(&mut dyn std::io::Write, &mut dyn std::io::Write) -> u8) -> Given {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let status = run(&mut out, &mut err);
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Given {
        status,
        out: text(out),
        err: text(err),
    }
}

fn content(path: &Path) -> Vec<u8> {
    tessgraph_graph::world::read_plain(path, u64::MAX).unwrap()
}
