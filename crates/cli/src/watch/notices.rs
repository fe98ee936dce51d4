//! Being told by the system that something happened in a folder.

use std::collections::BTreeSet;
use std::path::PathBuf;

use notify::event::{AccessKind, AccessMode, Flag, ModifyKind, RenameMode};
use notify::{ErrorKind, Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use super::debounce::Step;
use super::mailbox::{Message, Post};

/// Has the system tell of whatever happens in some folders.
///
/// Folders are watched, never files: a file that an editor replaces by renaming
/// takes its watch with it.
pub(super) struct Notices {
    watcher: Box<dyn Watcher>,
    folders: BTreeSet<PathBuf>,
}

impl Notices {
    /// Posts [`Message::Touched`] for what happens.
    ///
    /// # Errors
    /// Why the system does not tell, in words.
    pub(super) fn new(post: Post) -> Result<Self, String> {
        let watcher = RecommendedWatcher::new(
            move |event| {
                // Nobody may be listening any more.
                let _ = message(event).map(|message| post.send(message));
            },
            notify::Config::default(),
        );
        Ok(Self::by(Box::new(watcher.map_err(|error| words(&error))?)))
    }

    fn by(watcher: Box<dyn Watcher>) -> Self {
        let folders = BTreeSet::new();
        Self { watcher, folders }
    }

    /// Watches these folders and no others. Those that were watched before are
    /// asked for again, for a folder may have been removed and made again; one
    /// that cannot be watched is left to the occasional look at every file.
    ///
    /// # Errors
    /// When the system watches no more folders, in words.
    pub(super) fn watch(&mut self, folders: BTreeSet<PathBuf>) -> Result<(), String> {
        for folder in self.folders.difference(&folders) {
            // It may be gone, and its watch with it.
            let _ = self.watcher.unwatch(folder);
        }
        for folder in &folders {
            match self.watcher.watch(folder, RecursiveMode::NonRecursive) {
                Err(error) if matches!(error.kind, ErrorKind::MaxFilesWatch) => {
                    return Err(words(&error));
                }
                Ok(()) | Err(_) => {}
            }
        }
        self.folders = folders;
        Ok(())
    }
}

/// What an event says; `None` for one that says nothing, as that a file was
/// opened: reading files must not look like changing them. Closing one after
/// writing counts, for a file that is mapped into memory changes without more.
fn message(event: notify::Result<Event>) -> Option<Message> {
    match event {
        Ok(event) if event.attrs.flag() == Some(Flag::Rescan) => Some(Message::TouchedAnywhere),
        Ok(event) => {
            let step = match event.kind {
                EventKind::Access(AccessKind::Close(AccessMode::Write))
                | EventKind::Modify(ModifyKind::Name(RenameMode::To | RenameMode::Both)) => {
                    Step::Done
                }
                EventKind::Access(_) => return None,
                EventKind::Modify(ModifyKind::Metadata(_)) => Step::Other,
                _ => Step::Begun,
            };
            Some(Message::Touched(event.paths, step))
        }
        Err(error) if matches!(error.kind, ErrorKind::MaxFilesWatch) => {
            Some(Message::Deaf(words(&error)))
        }
        Err(_) => Some(Message::TouchedAnywhere),
    }
}

fn words(error: &notify::Error) -> String {
    match &error.kind {
        ErrorKind::MaxFilesWatch => "the system watches no more folders".to_owned(),
        _ => error.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::time::{Duration, Instant};

    use super::super::content;
    use super::super::mailbox::Mailbox;
    use super::*;

    /// Watches two folders at most.
    struct Limited(usize);

    impl Watcher for Limited {
        fn new<F: notify::EventHandler>(_: F, _: notify::Config) -> notify::Result<Self> {
            Ok(Self(0))
        }

        fn watch(&mut self, _: &Path, _: RecursiveMode) -> notify::Result<()> {
            self.0 += 1;
            if self.0 > 2 {
                return Err(notify::Error::new(ErrorKind::MaxFilesWatch));
            }
            Ok(())
        }

        fn unwatch(&mut self, _: &Path) -> notify::Result<()> {
            Ok(())
        }

        fn kind() -> notify::WatcherKind {
            notify::WatcherKind::NullWatcher
        }
    }

    #[test]
    fn the_systems_limit_is_told_apart() {
        let mut notices = Notices::by(Box::new(Limited(0)));
        let folders = |names: &[&str]| names.iter().map(PathBuf::from).collect();
        assert_eq!(notices.watch(folders(&["/a", "/b"])), Ok(()));
        let refused = notices.watch(folders(&["/a", "/b", "/c"]));
        assert!(refused.is_err_and(|reason| reason.contains("no more folders")));
    }

    #[test]
    fn what_happens_in_a_folder_is_told_and_reading_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let mailbox = Mailbox::new();
        let mut notices = Notices::new(mailbox.post()).unwrap();
        std::fs::write(root.join("there"), b"").unwrap();
        // A folder that is not there is no reason to give up.
        notices
            .watch([root.clone(), root.join("missing")].into())
            .unwrap();
        assert_eq!(
            content::of_file(&root.join("there")),
            Some(content::of_bytes(b""))
        );
        std::fs::write(root.join("new"), b"").unwrap();
        let deadline = Instant::now() + Duration::from_secs(20);
        loop {
            let come = mailbox.wait(deadline);
            assert!(!come.is_empty(), "nothing was told in time");
            for message in come {
                let Message::Touched(places, _) = message else {
                    continue;
                };
                assert!(!places.contains(&root.join("there")));
                if !places.is_empty() {
                    return assert!(places.contains(&root.join("new")));
                }
            }
        }
    }
}
