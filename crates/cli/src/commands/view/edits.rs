//! Edits of the graph file that are made on the page.

use std::io;
use std::path::Path;

use tessgraph_geometry::digest::Digest;
use tessgraph_graph::document::edit::{Declarations, Edit};
use tessgraph_graph::world::read_plain;

use crate::atomic::write_if_changed;
use crate::graph_file::LARGEST_GRAPH;

/// Edits that can be taken back.
const MOST: usize = 1000;

/// The edits made here, and those taken back.
#[derive(Debug, Default)]
pub(super) struct Edits {
    done: Vec<Made>,
    undone: Vec<Made>,
}

/// An edit with what the file was before and after it.
#[derive(Debug, Clone)]
struct Made {
    edit: Edit,
    before: Digest,
    after: Digest,
}

/// Why the file was not changed.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Refused {
    /// It is not what it was when it was read last.
    ChangedOutside,
    /// There is nothing to do.
    Nothing,
    /// Something else, in words.
    Other(String),
}

impl From<io::Error> for Refused {
    fn from(error: io::Error) -> Self {
        Self::Other(format!("it cannot be written: {error}"))
    }
}

impl Edits {
    /// Whether there is an edit to take back from a file of this content.
    pub(super) fn can_undo(&self, content: Digest) -> bool {
        self.done.last().is_some_and(|made| made.after == content)
    }

    /// Whether there is one to make again.
    pub(super) fn can_redo(&self, content: Digest) -> bool {
        self.undone
            .last()
            .is_some_and(|made| made.before == content)
    }

    /// Gives a parameter another value in the file, which must still be `known`;
    /// gives the new content.
    ///
    /// # Errors
    /// [`Refused`]; the file is then untouched.
    pub(super) fn write(
        &mut self,
        path: &Path,
        known: Digest,
        name: &str,
        value: &str,
    ) -> Result<Vec<u8>, Refused> {
        let bytes = read(path)?;
        if Digest::of(&bytes) != known {
            return Err(Refused::ChangedOutside);
        }
        let declared = Declarations::read(&path.to_string_lossy(), &bytes)
            .map_err(|_| Refused::Other("the file has an error of syntax".to_owned()))?;
        let edit = declared.edit(name, value).map_err(Refused::Other)?;
        let edit = edit.ok_or(Refused::Nothing)?;
        let made = make(path, &bytes, edit)?;
        self.undone.clear();
        self.done.push(made.0);
        if self.done.len() > MOST {
            self.done.remove(0);
        }
        Ok(made.1)
    }

    /// Takes the last edit back; gives the new content.
    ///
    /// # Errors
    /// [`Refused`]; the file is then untouched.
    pub(super) fn undo(&mut self, path: &Path) -> Result<Vec<u8>, Refused> {
        let last = self.done.last().ok_or(Refused::Nothing)?;
        let content = again(path, last.edit.inverse(), last.after)?;
        self.undone.extend(self.done.pop());
        Ok(content)
    }

    /// Makes the last edit again that was taken back; gives the new content.
    ///
    /// # Errors
    /// [`Refused`]; the file is then untouched.
    pub(super) fn redo(&mut self, path: &Path) -> Result<Vec<u8>, Refused> {
        let last = self.undone.last().ok_or(Refused::Nothing)?;
        let content = again(path, last.edit.clone(), last.before)?;
        self.done.extend(self.undone.pop());
        Ok(content)
    }
}

fn read(path: &Path) -> Result<Vec<u8>, Refused> {
    read_plain(path, LARGEST_GRAPH)
        .map_err(|reason| Refused::Other(format!("it cannot be read: {reason}")))
}

/// Changes a file whose content must be `known`.
fn again(path: &Path, edit: Edit, known: Digest) -> Result<Vec<u8>, Refused> {
    let bytes = read(path)?;
    if Digest::of(&bytes) != known {
        return Err(Refused::ChangedOutside);
    }
    make(path, &bytes, edit).map(|(_, content)| content)
}

fn make(path: &Path, bytes: &[u8], edit: Edit) -> Result<(Made, Vec<u8>), Refused> {
    let content = edit.apply(bytes).ok_or(Refused::ChangedOutside)?;
    // The file itself, not a link to it.
    write_if_changed(&path.canonicalize()?, &content)?;
    let made = Made {
        edit,
        before: Digest::of(bytes),
        after: Digest::of(&content),
    };
    Ok((made, content))
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAPH: &[u8] = b"Graph(version: 1, params: {\"n\": 3 /* three */}, nodes: {})\n";

    fn content(path: &Path) -> Vec<u8> {
        read(path).unwrap()
    }

    #[test]
    fn undo_brings_the_bytes_back_and_redo_the_edit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("g.ron");
        std::fs::write(&path, GRAPH).unwrap();
        let mut edits = Edits::default();
        assert_eq!(edits.undo(&path), Err(Refused::Nothing));
        let mut known = Digest::of(GRAPH);
        let mut contents = vec![GRAPH.to_vec()];
        for value in ["4", "5"] {
            let written = edits.write(&path, known, "n", value).unwrap();
            assert_eq!(content(&path), written);
            known = Digest::of(&written);
            contents.push(written);
        }
        assert!(edits.can_undo(known) && !edits.can_redo(known));
        assert_eq!(edits.undo(&path), Ok(contents[1].clone()));
        assert_eq!(edits.undo(&path), Ok(contents[0].clone()));
        assert_eq!(content(&path), GRAPH);
        assert_eq!(edits.redo(&path), Ok(contents[1].clone()));
        let known = Digest::of(&contents[1]);
        assert!(edits.can_undo(known) && edits.can_redo(known));
        // Another edit is another future.
        edits.write(&path, known, "n", "9").unwrap();
        assert_eq!(edits.redo(&path), Err(Refused::Nothing));
    }

    #[test]
    fn what_was_changed_outside_is_not_touched() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("g.ron");
        std::fs::write(&path, GRAPH).unwrap();
        let mut edits = Edits::default();
        let written = edits.write(&path, Digest::of(GRAPH), "n", "4").unwrap();
        let outside = [GRAPH, b"// more\n"].concat();
        std::fs::write(&path, &outside).unwrap();
        let known = Digest::of(&written);
        let refused = Err(Refused::ChangedOutside);
        assert_eq!(edits.write(&path, known, "n", "5"), refused);
        assert_eq!(edits.undo(&path), refused);
        assert_eq!(content(&path), outside);
        // And when it is as it was, the edit can be taken back after all.
        std::fs::write(&path, &written).unwrap();
        assert_eq!(edits.undo(&path), Ok(GRAPH.to_vec()));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("g.ron"), folder.path().join("l.ron"));
        std::fs::write(&path, GRAPH).unwrap();
        let permissions = std::fs::Permissions::from_mode(0o640);
        std::fs::set_permissions(&path, permissions).unwrap();
        symlink("g.ron", &link).unwrap();
        let mut edits = Edits::default();
        edits.write(&link, Digest::of(GRAPH), "n", "4").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        let mode = path.metadata().unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
    }
}
