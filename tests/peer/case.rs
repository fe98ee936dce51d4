//! One case: its files, the graph that asks for the same, and the verdict.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tessgraph_geometry::{Mesh, Unmonitored, weld_vertices};
use tessgraph_graph::world::{DiskWorld, FileError, World};

use super::settings::{self, Holds, LATER_PASS, Request};
use super::{compare, even, patch};
use crate::support::{self, Ran};

pub(super) struct Case {
    pub(super) name: String,
    folder: PathBuf,
}

/// What became of a case.
pub(super) enum Verdict {
    /// Equal to the add-on's result.
    Reproduced,
    /// Equal once the vertices that the add-on's cut leaves twice are welded.
    ReproducedWelded,
    /// The add-on failed or gave no finite result; ours is valid. Says why.
    Beaten(String),
    /// Asks for something that has no counterpart; names the keys.
    Refused(Vec<String>),
    /// Should agree and does not.
    Differs(String),
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reproduced => f.write_str("reproduced"),
            Self::ReproducedWelded => f.write_str(
                "reproduced, after welding both at 1e-6: the add-on's cut leaves vertices twice \
                 and a face without area",
            ),
            Self::Beaten(why) => write!(f, "beaten: {why}"),
            Self::Refused(keys) => {
                let told = keys.iter().map(|key| match settings::reason(key) {
                    Some(reason) => format!("{key} ({reason})"),
                    None => key.clone(),
                });
                write!(f, "refused: {}", told.collect::<Vec<_>>().join(", "))
            }
            Self::Differs(how) => write!(f, "DIFFERS: {how}"),
        }
    }
}

impl Case {
    /// The cases in a folder, by name.
    pub(super) fn all_in(folder: &Path) -> Vec<Self> {
        let Ok(entries) = std::fs::read_dir(folder) else {
            return Vec::new();
        };
        let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let mut cases: Vec<_> = paths
            .filter(|path| path.join("settings.json").is_file())
            .map(|folder| {
                let name = folder.file_name().expect("folders have names");
                Self {
                    name: name.to_string_lossy().into_owned(),
                    folder,
                }
            })
            .collect();
        cases.sort_by(|a, b| a.name.cmp(&b.name));
        cases
    }

    pub(super) fn verdict(&self) -> Verdict {
        let settings = support::text_of(&self.folder.join("settings.json"));
        match settings::graph(&settings, &self.holds()) {
            Request::Refused(keys) => Verdict::Refused(keys),
            Request::Graph {
                text,
                later,
                clipped,
            } => self.compare(&text, later.as_deref(), clipped),
        }
    }

    /// What the folder holds beside meshes and settings.
    fn holds(&self) -> Holds {
        let has = |name: &str| self.folder.join(name).is_file();
        Holds {
            weights: has("weights.csv"),
            target: has("target.obj") && self.counts("target.obj") == self.counts("base.obj"),
            selection: has("selection.csv"),
            base_materials: self.materials("base.obj"),
            component_materials: self.materials("component.obj"),
        }
    }

    /// Vertices and faces of a mesh.
    fn counts(&self, name: &str) -> [usize; 2] {
        let text = support::text_of(&self.folder.join(name));
        ["v ", "f "].map(|mark| text.lines().filter(|line| line.starts_with(mark)).count())
    }

    /// The materials of a mesh in the order of their first faces.
    fn materials(&self, name: &str) -> Vec<String> {
        let text = support::text_of(&self.folder.join(name));
        let used = text.lines().filter_map(|line| line.strip_prefix("usemtl "));
        let mut names: Vec<String> = Vec::new();
        for name in used.map(str::trim) {
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        names
    }

    fn compare(&self, graph: &str, later: Option<&str>, clipped: bool) -> Verdict {
        let world = Folder {
            disk: support::world_of(&self.folder),
            later: later.unwrap_or_default().as_bytes().into(),
        };
        let plan = match support::try_load_in(&self.name, graph, &world) {
            Ok(plan) => plan,
            Err(found) => return Verdict::Differs(format!("{}\n{graph}", support::shown(&found))),
        };
        let ran = Ran::run(plan, &world);
        if !ran.evaluation.is_ok() {
            let found = support::shown(&ran.evaluation.diagnostics);
            if found.contains("SplitIntoQuads") {
                return Verdict::Refused(vec!["fill_mode (QUAD on n-gons)".to_owned()]);
            }
            return Verdict::Differs(found);
        }
        let ours = ran.mesh("result");
        match self.reference() {
            Ok(theirs) if later.is_none() && graph.contains("PerVertex") => {
                even::judge(&ran, &theirs)
            }
            Ok(theirs) if later.is_none() && self.folder.join("base_eval.obj").is_file() => {
                let blender = self.read("base_eval.obj").expect("a subdivided base");
                patch::judge(&ran, &blender, &theirs)
            }
            Ok(theirs) => match difference(&ours, &theirs, clipped) {
                None if clipped => Verdict::ReproducedWelded,
                None => Verdict::Reproduced,
                Some(difference) => Verdict::Differs(difference),
            },
            Err(_) if ours.face_count() == 0 => Verdict::Differs("no faces".to_owned()),
            Err(why) => {
                let finite = ours.positions().iter().all(|place| place.is_finite());
                assert!(finite, "{}: meshes are finite by construction", self.name);
                Verdict::Beaten(why)
            }
        }
    }

    /// What the add-on made; an error if it crashed or wrote no finite mesh.
    fn reference(&self) -> Result<Mesh, String> {
        let error = self.folder.join("ERROR.txt");
        if error.is_file() {
            let text = support::text_of(&error);
            return Err(format!(
                "the add-on failed: {}",
                text.lines().next_back().unwrap_or("")
            ));
        }
        if support::text_of(&self.folder.join("tissue.obj")).contains("nan") {
            return Err("the add-on wrote NaN".to_owned());
        }
        self.read("tissue.obj")
    }

    /// A mesh of the case's folder.
    fn read(&self, name: &str) -> Result<Mesh, String> {
        support::read_obj(&self.folder.join(name))
    }
}

/// The files of a case, and the graph of its later passes.
struct Folder {
    disk: DiskWorld,
    later: Arc<[u8]>,
}

impl World for Folder {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, FileError> {
        match path {
            LATER_PASS => Ok(Arc::clone(&self.later)),
            _ => self.disk.read(path),
        }
    }
}

/// How the two differ. Where the component was cut the add-on leaves coincident
/// vertices and faces without area beside the cut; both sides are welded first.
fn difference(ours: &Mesh, theirs: &Mesh, clipped: bool) -> Option<String> {
    if !clipped {
        return compare::difference(ours, theirs, 1e-5);
    }
    let welded = |mesh: &Mesh| {
        weld_vertices(mesh, 1e-6, &Unmonitored)
            .expect("the distance is fine")
            .mesh
    };
    compare::difference(&welded(ours), &welded(theirs), 1e-5)
}
