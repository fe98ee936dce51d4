//! Looking instead of being told, where nobody tells: on network drives.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What a look at a place shows without reading it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Stamp {
    bytes: u64,
    modified: Option<SystemTime>,
    /// Which file it is and when anything about it changed, where that is known:
    /// another file moved to the place may be older than the one before.
    identity: Option<(u64, u64, i64, i64)>,
    link: Option<PathBuf>,
}

/// The last look at each place.
#[derive(Debug, Default)]
pub(super) struct Stamps {
    seen: BTreeMap<PathBuf, Option<Stamp>>,
}

impl Stamps {
    /// From now on looks at these places; new ones are as they are now.
    pub(super) fn keep(
        &mut self,
        places: BTreeSet<PathBuf>,
        look: &dyn Fn(&Path) -> Option<Stamp>,
    ) {
        self.seen.retain(|place, _| places.contains(place));
        for place in places {
            self.seen
                .entry(place)
                .or_insert_with_key(|place| look(place));
        }
    }

    /// The places that are not as they were at the last look.
    pub(super) fn changed(&mut self, look: &dyn Fn(&Path) -> Option<Stamp>) -> Vec<PathBuf> {
        let mut changed = Vec::new();
        for (place, seen) in &mut self.seen {
            let now = look(place);
            if now != *seen {
                *seen = now;
                changed.push(place.clone());
            }
        }
        changed
    }
}

/// Looks at a place itself, not at where a link leads.
pub(super) fn look(place: &Path) -> Option<Stamp> {
    let found = place.symlink_metadata().ok()?;
    // A folder changes with everything in it; only whether it is there matters.
    let is_folder = found.is_dir();
    Some(Stamp {
        bytes: if is_folder { 0 } else { found.len() },
        modified: found.modified().ok().filter(|_| !is_folder),
        identity: identity(&found, is_folder),
        link: std::fs::read_link(place).ok(),
    })
}

#[cfg(unix)]
fn identity(found: &Metadata, is_folder: bool) -> Option<(u64, u64, i64, i64)> {
    use std::os::unix::fs::MetadataExt as _;
    let changed = if is_folder {
        (0, 0)
    } else {
        (found.ctime(), found.ctime_nsec())
    };
    Some((found.dev(), found.ino(), changed.0, changed.1))
}

#[cfg(not(unix))]
fn identity(_: &Metadata, _: bool) -> Option<(u64, u64, i64, i64)> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_that_can_happen_to_a_file_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("f")).unwrap();
        std::fs::write(at("a"), b"one").unwrap();
        std::fs::write(at("older"), b"two").unwrap();
        let old = SystemTime::UNIX_EPOCH;
        let older = std::fs::File::options().append(true).open(at("older"));
        older.unwrap().set_modified(old).unwrap();
        let mut stamps = Stamps::default();
        let nothing: Vec<PathBuf> = Vec::new();
        stamps.keep([at("a"), at("f"), at("gone")].into(), &look);
        assert_eq!(stamps.changed(&look), nothing);
        let mut after = |act: &dyn Fn()| {
            act();
            let changed = stamps.changed(&look);
            assert_eq!(stamps.changed(&look), nothing);
            changed
        };
        assert_eq!(after(&|| std::fs::write(at("f/x"), b"").unwrap()), nothing);
        assert_eq!(after(&|| std::fs::write(at("a"), b"1").unwrap()), [at("a")]);
        assert_eq!(
            after(&|| std::fs::write(at("gone"), b"").unwrap()),
            [at("gone")]
        );
        // Older than what it replaces, as an unpacked archive or an undo is.
        assert_eq!(
            after(&|| std::fs::rename(at("older"), at("a")).unwrap()),
            [at("a")]
        );
        assert_eq!(after(&|| std::fs::remove_file(at("a")).unwrap()), [at("a")]);
        #[cfg(unix)]
        {
            use std::os::unix::fs::symlink;
            assert_eq!(after(&|| symlink("f", at("a")).unwrap()), [at("a")]);
            let swap = || {
                symlink("gone", at("new")).unwrap();
                std::fs::rename(at("new"), at("a")).unwrap();
            };
            assert_eq!(after(&swap), [at("a")]);
        }
        stamps.keep([at("f")].into(), &look);
        std::fs::remove_file(at("a")).unwrap();
        assert_eq!(stamps.changed(&look), nothing);
    }
}
