//! The files that are watched: where they stand, what is in them, and how a
//! change of them becomes known.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tessgraph_geometry::digest::Digest;
use tessgraph_graph::world::DiskWorld;

use super::Watched;
use super::content;
use super::dependencies::Dependencies;
use super::mailbox::Post;
use super::notices::Notices;
use super::stamps::{Stamps, look};
use crate::places::trail;

/// How often every file is looked at where the system tells nothing.
const OFTEN: Duration = Duration::from_millis(500);

/// How often where it does: on some drives it takes the order and tells nothing,
/// and of a folder that was moved with its parents it knows nothing.
const SELDOM: Duration = Duration::from_secs(2);

/// The dependencies on the disk.
pub(super) struct Places<'a> {
    allowed: &'a [PathBuf],
    /// The graph, absolute.
    graph: PathBuf,
    pub(super) dependencies: Dependencies,
    /// `None` where the system tells nothing.
    notices: Option<Notices>,
    /// Why it does not, until that has been shown.
    pub(super) deaf: Option<String>,
    stamps: Stamps,
    /// When every file is looked at again.
    pub(super) next_look: Instant,
}

impl<'a> Places<'a> {
    /// Watches the graph, whether it is there or not.
    pub(super) fn new(watched: &Watched<'a>, post: Post) -> Self {
        let (notices, deaf) = match (watched.poll, Notices::new(post)) {
            (true, _) => (None, None),
            (false, Ok(notices)) => (Some(notices), None),
            (false, Err(reason)) => (None, Some(reason)),
        };
        let mut places = Self {
            allowed: watched.allowed,
            graph: std::path::absolute(watched.graph).unwrap_or_else(|_| watched.graph.to_owned()),
            dependencies: Dependencies::default(),
            notices,
            deaf,
            stamps: Stamps::default(),
            next_look: Instant::now(),
        };
        let graph = places.graph.clone();
        places.read(&graph, None);
        places
    }

    /// The run at work read this; says whether that is new, and was not watched
    /// when it was read.
    pub(super) fn read(&mut self, path: &Path, content: Option<&[u8]>) -> bool {
        let content = content.map(content::of_bytes);
        let is_new = self.dependencies.read(path, content, self.trail(path));
        if is_new {
            self.follow();
        }
        is_new
    }

    /// The run came to its end: what it did not read is not watched any more.
    pub(super) fn end(&mut self) {
        self.dependencies.end();
        self.follow();
    }

    /// Watches the folders that the files are in now.
    pub(super) fn follow(&mut self) {
        // Once more if something moved before it was watched; whoever moves things
        // without end is met by the next look at every file.
        for _ in 0..4 {
            let places = self.dependencies.places();
            if let Some(notices) = &mut self.notices
                && let Err(reason) = notices.watch(self.dependencies.folders())
            {
                self.deafen(reason);
            }
            let inside = self.inside();
            self.dependencies.relocate(&|path| trail(path, &inside));
            if self.dependencies.places() == places {
                break;
            }
        }
        self.stamps.keep(self.dependencies.places(), &look);
    }

    /// The system tells nothing any more.
    pub(super) fn deafen(&mut self, reason: String) {
        self.notices = None;
        self.deaf = Some(reason);
        self.next_look = Instant::now();
    }

    /// The files that were touched when something happened at these places.
    pub(super) fn files_at(&self, places: &[PathBuf]) -> BTreeSet<PathBuf> {
        let files = places.iter().map(|place| self.dependencies.at(place));
        files.flatten().collect()
    }

    /// Looks at every place from time to time: the files that were touched; `None`
    /// while it is not time.
    pub(super) fn look_if_due(&mut self, now: Instant) -> Option<BTreeSet<PathBuf>> {
        if now < self.next_look {
            return None;
        }
        let changed = self.stamps.changed(&look);
        let interval = if self.notices.is_some() {
            SELDOM
        } else {
            OFTEN
        };
        self.next_look = Instant::now() + interval;
        Some(self.files_at(&changed))
    }

    /// The first of `files` that is not as a run read it last.
    pub(super) fn changed(&self, files: &BTreeSet<PathBuf>) -> Option<PathBuf> {
        let changed = self.dependencies.changed(files, &|path| self.content(path));
        changed.map(Path::to_owned)
    }

    /// The first of `files` that the run at work has read, and that is another
    /// now.
    pub(super) fn changed_since_read(&self, files: &BTreeSet<PathBuf>) -> Option<PathBuf> {
        self.changed(&self.dependencies.read_by_now(files))
    }

    /// Whether the file is not as a run read it last.
    pub(super) fn is_changed(&self, file: &Path) -> bool {
        self.changed(&[file.to_owned()].into()).is_some()
    }

    fn trail(&self, path: &Path) -> Vec<PathBuf> {
        trail(path, &self.inside())
    }

    /// The graph's folder, links followed.
    fn inside(&self) -> PathBuf {
        let folder = self.graph.parent().unwrap_or(&self.graph);
        folder.canonicalize().unwrap_or_else(|_| folder.to_owned())
    }

    /// What a run would read now.
    fn content(&self, path: &Path) -> Option<Digest> {
        if path == self.graph {
            return content::of_file(path);
        }
        let disk = DiskWorld::new(self.graph.parent()?, self.allowed).ok()?;
        let found = disk.resolve(path.to_str()?).ok()?;
        content::of_file(&found)
    }
}
