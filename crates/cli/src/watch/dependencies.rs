//! What a run depends on: files, and what was in them when it read them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use tessgraph_geometry::digest::Digest;

/// The files of the last run and of the one at work, by absolute path.
#[derive(Debug, Default)]
pub(super) struct Dependencies {
    files: BTreeMap<PathBuf, Dependency>,
    /// Which run is the last one that began.
    run: u64,
}

/// A file that a run asked for, whether it was there or not.
#[derive(Debug)]
struct Dependency {
    /// Digest of what the run read; `None` if there was nothing to be read.
    content: Option<Digest>,
    /// The places whose change can change what the path means: the file, the
    /// links that lead to it, or the first thing on the way that is missing.
    places: Vec<PathBuf>,
    /// The run that read it last.
    run: u64,
}

impl Dependencies {
    /// A run begins, and will say what it reads.
    pub(super) fn begin(&mut self) {
        self.run += 1;
    }

    /// The run read a file, which stands at `places`; says whether the file was
    /// unknown, or elsewhere, before.
    pub(super) fn read(
        &mut self,
        path: &Path,
        content: Option<Digest>,
        places: Vec<PathBuf>,
    ) -> bool {
        let run = self.run;
        let known = self.files.get(path).map(|file| &file.places) == Some(&places);
        let file = Dependency {
            content,
            places,
            run,
        };
        self.files.insert(path.to_owned(), file);
        !known
    }

    /// The run came to its end: what it did not read it does not depend on.
    pub(super) fn end(&mut self) {
        self.files.retain(|_, file| file.run == self.run);
    }

    /// Looks up again where the files stand: a link may lead elsewhere now.
    pub(super) fn relocate(&mut self, places_of: &dyn Fn(&Path) -> Vec<PathBuf>) {
        for (path, file) in &mut self.files {
            file.places = places_of(path);
        }
    }

    /// All places of all files.
    pub(super) fn places(&self) -> BTreeSet<PathBuf> {
        let places = self.files.values().flat_map(|file| &file.places);
        places.cloned().collect()
    }

    /// The folders in which these places are.
    pub(super) fn folders(&self) -> BTreeSet<PathBuf> {
        let places = self.files.values().flat_map(|file| &file.places);
        places
            .filter_map(|place| place.parent())
            .map(Path::to_owned)
            .collect()
    }

    /// The files that something happening at `place` may concern. Where names
    /// differ only by case they may mean one file.
    pub(super) fn at(&self, place: &Path) -> BTreeSet<PathBuf> {
        let concerns = |other: &PathBuf| {
            other.starts_with(place) || other.as_os_str().eq_ignore_ascii_case(place.as_os_str())
        };
        let files = self.files.iter();
        let files = files.filter(|(_, file)| file.places.iter().any(concerns));
        files.map(|(path, _)| path.clone()).collect()
    }

    /// All files.
    pub(super) fn all(&self) -> BTreeSet<PathBuf> {
        self.files.keys().cloned().collect()
    }

    /// Those of `files` in which `look` finds something else than was read last.
    pub(super) fn changed<'f>(
        &self,
        files: &'f BTreeSet<PathBuf>,
        look: &dyn Fn(&Path) -> Option<Digest>,
    ) -> Option<&'f Path> {
        let is_changed = |path: &&PathBuf| {
            let known = self.files.get(path.as_path());
            known.is_some_and(|file| look(path) != file.content)
        };
        files.iter().find(is_changed).map(PathBuf::as_path)
    }

    /// Those of `files` that the run at work has read by now; the others it will
    /// read as they are then.
    pub(super) fn read_by_now(&self, files: &BTreeSet<PathBuf>) -> BTreeSet<PathBuf> {
        let is_read = |path: &&PathBuf| {
            let known = self.files.get(path.as_path());
            known.is_some_and(|file| file.run == self.run)
        };
        files.iter().filter(is_read).cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digest(text: &str) -> Option<Digest> {
        Some(Digest::of(text.as_bytes()))
    }

    fn paths(names: &[&str]) -> Vec<PathBuf> {
        names.iter().map(PathBuf::from).collect()
    }

    /// A graph, a mesh behind a link in the folder `current`, and a file that
    /// is missing with its folder.
    fn some() -> Dependencies {
        let mut dependencies = Dependencies::default();
        dependencies.begin();
        let mut read = |path: &str, content, places: &[&str]| {
            assert!(dependencies.read(Path::new(path), content, paths(places)));
        };
        read("/p/g.ron", digest("graph"), &["/p/g.ron"]);
        read(
            "/p/current/roof.obj",
            digest("roof"),
            &["/p/current", "/p/v1/roof.obj"],
        );
        read("/p/a/b/c.obj", None, &["/p/a"]);
        dependencies
    }

    #[test]
    fn folders_are_watched_and_names_in_them_told_apart() {
        let some = some();
        let folders: Vec<PathBuf> = some.folders().into_iter().collect();
        assert_eq!(folders, paths(&["/p", "/p/v1"]));
        for (place, files) in [
            ("/p/g.ron", &["/p/g.ron"][..]),
            ("/p/out", &[]),
            ("/p/g.ron.tmp", &[]),
            ("/p/G.RON", &["/p/g.ron"]),
            ("/p/v1/roof.obj", &["/p/current/roof.obj"]),
            ("/p/current", &["/p/current/roof.obj"]),
            // A folder was removed, or came back.
            ("/p/v1", &["/p/current/roof.obj"]),
            ("/p/a", &["/p/a/b/c.obj"]),
        ] {
            let at: Vec<PathBuf> = some.at(Path::new(place)).into_iter().collect();
            assert_eq!(at, paths(files), "{place}");
        }
    }

    #[test]
    fn contents_decide_and_a_missing_file_is_awaited() {
        let some = some();
        let same = |path: &Path| match path.to_str() {
            Some("/p/g.ron") => digest("graph"),
            Some("/p/current/roof.obj") => digest("roof"),
            _ => None,
        };
        let all = some.all();
        assert_eq!(some.changed(&all, &same), None);
        let made = |path: &Path| same(path).or(digest("new"));
        assert_eq!(some.changed(&all, &made), Some(Path::new("/p/a/b/c.obj")));
        let removed = |_: &Path| None;
        let graph = some.at(Path::new("/p/g.ron"));
        assert_eq!(some.changed(&graph, &removed), Some(Path::new("/p/g.ron")));
    }

    #[test]
    fn a_run_drops_what_it_did_not_read_when_it_ends() {
        let mut some = some();
        some.begin();
        let graph = paths(&["/p/g.ron"]);
        assert!(!some.read(&graph[0], digest("other"), graph.clone()));
        assert_eq!(some.all().len(), 3);
        let read: Vec<PathBuf> = some.read_by_now(&some.all()).into_iter().collect();
        assert_eq!(read, graph);
        some.end();
        assert_eq!(some.all().into_iter().collect::<Vec<_>>(), graph);
        // Known, but behind a link now: that has to be watched too.
        assert!(some.read(&graph[0], digest("other"), paths(&["/p/g.ron", "/q/g.ron"])));
        some.relocate(&|path| vec![path.to_owned()]);
        assert_eq!(some.places(), graph.into_iter().collect());
    }
}
