//! Where a path leads, also when nothing is there yet.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// How many symbolic links a path may lead through; the limit of Linux.
const MOST_LINKS: usize = 40;

/// The place that `path` names from `base`: absolute, with symbolic links
/// followed as far as anything exists, also a last link to nothing.
///
/// # Errors
/// In words, when `base` cannot be found, a file stands where a folder is
/// needed, or links lead in a circle.
pub(crate) fn locate(base: &Path, path: &Path) -> Result<PathBuf, String> {
    follow(existing_part(base)?, path, &mut |_, _| {})
}

/// All places whose change can change what `path` means: the place it names,
/// each symbolic link on the way, each folder on the way below `inside`, and,
/// where the way ends early, the first thing that is missing.
pub(crate) fn trail(path: &Path, inside: &Path) -> Vec<PathBuf> {
    let Ok(path) = std::path::absolute(path) else {
        return Vec::new();
    };
    let (mut trail, mut last, mut lost) = (Vec::new(), None, false);
    let mut met = |place: &Path, found: Met| {
        if lost {
            return;
        }
        last = Some(place.to_owned());
        lost = found == Met::Nothing;
        let matters = match found {
            Met::Link | Met::Nothing => true,
            Met::Other => place != inside && place.starts_with(inside),
        };
        trail.extend(matters.then(|| place.to_owned()));
    };
    // A way that leads nowhere has been followed as far as it goes.
    let _ = follow(PathBuf::new(), &path, &mut met);
    trail.extend(last);
    trail.dedup();
    trail
}

/// What is at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Met {
    Link,
    Nothing,
    Other,
}

/// Goes from `place` along `path`, and tells of everything met on the way.
fn follow(
    mut place: PathBuf,
    path: &Path,
    met: &mut dyn FnMut(&Path, Met),
) -> Result<PathBuf, String> {
    let mut rest: VecDeque<Step> = steps(path).into();
    let mut links = 0;
    while let Some(step) = rest.pop_front() {
        match step {
            Step::Root(root) => place = root,
            Step::Up => {
                place.pop();
            }
            Step::Into(name) => {
                let next = place.join(&name);
                let found = fs::symlink_metadata(&next);
                met(
                    &next,
                    match &found {
                        Ok(found) if found.is_symlink() => Met::Link,
                        Ok(_) => Met::Other,
                        Err(_) => Met::Nothing,
                    },
                );
                match found {
                    Ok(found) if found.is_symlink() => {
                        links += 1;
                        if links > MOST_LINKS {
                            return Err("its symbolic links lead in a circle".to_owned());
                        }
                        let target = fs::read_link(&next).map_err(|error| error.to_string())?;
                        for step in steps(&target).into_iter().rev() {
                            rest.push_front(step);
                        }
                    }
                    Ok(found) if !found.is_dir() && !rest.is_empty() => {
                        return Err(format!("`{}` is a file, not a folder", next.display()));
                    }
                    // Nothing there, or not to be looked at: writing will tell.
                    _ => place = next,
                }
            }
        }
    }
    Ok(place)
}

/// The current folder's canonical path joined with `base`.
fn existing_part(base: &Path) -> Result<PathBuf, String> {
    let base = if base.as_os_str().is_empty() {
        Path::new(".")
    } else {
        base
    };
    if let Ok(found) = base.canonicalize() {
        return Ok(found);
    }
    // A folder that is still to be made: its existing ancestors are followed.
    let here = Path::new(".")
        .canonicalize()
        .map_err(|error| error.to_string())?;
    if base == Path::new(".") {
        Ok(here)
    } else {
        locate(&here, base)
    }
}

/// One step of a path.
enum Step {
    Root(PathBuf),
    Up,
    Into(OsString),
}

fn steps(path: &Path) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut root = PathBuf::new();
    for component in path.components() {
        match component {
            Component::Prefix(_) => root.push(component),
            Component::RootDir => {
                root.push(component);
                steps.push(Step::Root(root.clone()));
            }
            Component::CurDir => {}
            Component::ParentDir => steps.push(Step::Up),
            Component::Normal(name) => steps.push(Step::Into(name.to_owned())),
        }
    }
    steps
}

/// Whether two paths name one existing file, also as two hard links.
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    if one == other {
        return true;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let id = |path| {
            fs::metadata(path)
                .map(|found| (found.dev(), found.ino()))
                .ok()
        };
        id(one).is_some_and(|found| id(other) == Some(found))
    }
    #[cfg(not(unix))]
    {
        let id = |path: &Path| path.canonicalize().ok();
        id(one).is_some_and(|found| id(other) == Some(found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_what_exists_and_keeps_the_rest() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        fs::create_dir(root.join("a")).unwrap();
        let located = |path: &str| locate(&root, Path::new(path));
        assert_eq!(located("a/./b/c.glb"), Ok(root.join("a/b/c.glb")));
        assert_eq!(located("a/../b"), Ok(root.join("b")));
        assert_eq!(located("/x/y"), Ok(PathBuf::from("/x/y")));
        assert_eq!(
            locate(&root.join("new"), Path::new("x")),
            Ok(root.join("new/x"))
        );
    }

    #[test]
    fn a_file_is_no_folder() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("f"), b"").unwrap();
        assert!(
            locate(folder.path(), Path::new("f/x"))
                .unwrap_err()
                .contains("is a file")
        );
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_circles_noticed() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        symlink("../outside", root.join("up")).unwrap();
        symlink("there", root.join("here")).unwrap();
        symlink("b", root.join("a")).unwrap();
        symlink("a", root.join("b")).unwrap();
        let parent = root.parent().unwrap();
        assert_eq!(
            locate(&root, Path::new("up/x")),
            Ok(parent.join("outside/x"))
        );
        assert_eq!(locate(&root, Path::new("here")), Ok(root.join("there")));
        assert!(
            locate(&root, Path::new("a"))
                .unwrap_err()
                .contains("circle")
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_trail_holds_links_folders_inside_and_the_first_thing_missing() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        fs::create_dir_all(root.join("p/v1/meshes")).unwrap();
        fs::write(root.join("p/v1/meshes/a.obj"), b"").unwrap();
        symlink("v1", root.join("p/current")).unwrap();
        symlink("p", root.join("link")).unwrap();
        let trail = |path: &str| {
            let places = trail(&root.join(path), &root.join("p"));
            let below = places
                .iter()
                .map(|place| place.strip_prefix(&root).unwrap());
            let below: Vec<_> = below
                .map(|place| place.to_str().unwrap().to_owned())
                .collect();
            below.join(" ")
        };
        assert_eq!(
            trail("p/v1/meshes/a.obj"),
            "p/v1 p/v1/meshes p/v1/meshes/a.obj"
        );
        assert_eq!(
            trail("link/current/meshes/a.obj"),
            "link p/current p/v1 p/v1/meshes p/v1/meshes/a.obj"
        );
        assert_eq!(trail("p/no/b.obj"), "p/no");
        assert_eq!(
            trail("p/v1/meshes/a.obj/c"),
            "p/v1 p/v1/meshes p/v1/meshes/a.obj"
        );
        fs::create_dir(root.join("elsewhere")).unwrap();
        assert_eq!(trail("elsewhere/c.obj"), "elsewhere/c.obj");
    }

    #[test]
    fn hard_links_are_one_file() {
        let folder = tempfile::tempdir().unwrap();
        let (one, other) = (folder.path().join("1"), folder.path().join("2"));
        fs::write(&one, b"x").unwrap();
        assert!(!is_same_file(&one, &other));
        fs::hard_link(&one, &other).unwrap();
        assert!(is_same_file(&one, &other));
    }
}
