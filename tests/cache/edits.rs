//! After any sequence of edits, failures and stops a warm run gives what a cold
//! one gives.

use std::sync::atomic::{AtomicU64, Ordering};

use proptest::prelude::*;
use tessgraph_geometry::digest::Digest;
use tessgraph_graph::world::MemoryWorld;
use tessgraph_graph::{Engine, Observer, Silent};

use super::CAGE;
use crate::support;

/// What a designer has on the desk at one moment.
#[derive(Debug, Clone)]
struct Sheet {
    levels: u32,
    thickness: u32,
    depth: u32,
    /// Appended to the names of all nodes.
    suffix: u32,
    /// Which node is written first.
    turn: usize,
    comment: bool,
    cage: Cage,
}

/// What is in the file that the graph reads.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Cage {
    /// A quad that is raised so far at one corner.
    Raised(u32),
    /// The first of these, with another comment.
    Redrawn,
    /// No mesh.
    Broken,
    Missing,
}

/// What happens between two runs.
#[derive(Debug, Clone)]
enum Edit {
    Levels(u32),
    Thickness(u32),
    Depth(u32),
    Rename(u32),
    Reorder(usize),
    Comment,
    File(Cage),
    /// A run that is stopped when it has asked so often whether to go on.
    Stop(u64),
}

fn edit() -> impl Strategy<Value = Edit> {
    let cage = prop_oneof![
        3 => (0..3u32).prop_map(Cage::Raised),
        1 => Just(Cage::Redrawn),
        1 => Just(Cage::Broken),
        1 => Just(Cage::Missing),
    ];
    prop_oneof![
        (0..3u32).prop_map(Edit::Levels),
        // Nothing is 0 thick: that fails in one node, while others go on.
        (0..4u32).prop_map(Edit::Thickness),
        (1..4u32).prop_map(Edit::Depth),
        (0..3u32).prop_map(Edit::Rename),
        (0..6usize).prop_map(Edit::Reorder),
        Just(Edit::Comment),
        cage.prop_map(Edit::File),
        (0..24u64).prop_map(Edit::Stop),
    ]
}

impl Sheet {
    fn apply(&mut self, edit: &Edit) {
        match *edit {
            Edit::Levels(levels) => self.levels = levels,
            Edit::Thickness(thickness) => self.thickness = thickness,
            Edit::Depth(depth) => self.depth = depth,
            Edit::Rename(suffix) => self.suffix = suffix,
            Edit::Reorder(turn) => self.turn = turn,
            Edit::Comment => self.comment = !self.comment,
            Edit::File(cage) => self.cage = cage,
            Edit::Stop(_) => {}
        }
    }

    fn text(&self) -> String {
        let Self {
            levels,
            thickness,
            depth,
            suffix,
            ..
        } = self;
        let name = |name: &str| format!("\"{name}_{suffix}\"");
        let [cage, surface, normals] = ["cage", "surface", "normals"].map(name);
        let [shell, size, deep] = ["shell", "size", "deep"].map(name);
        let mut nodes = [
            format!("{cage}: ReadMesh(path: \"cage.obj\"),"),
            format!("{surface}: SubdivideQuad(mesh: {cage}, levels: \"levels\"),"),
            format!("{normals}: VertexNormals(mesh: {surface}),"),
            // The area of the surface, so that a thickness of 0 is met in the run.
            format!(
                "{shell}: OffsetMesh(mesh: {surface}, directions: {normals}, \
                 outward: \"t * base_{suffix}.area\"),"
            ),
            format!("\"base_{suffix}\": MeasureMesh(mesh: {surface}),"),
            format!("{size}: MeasureMesh(mesh: {shell}),"),
            format!(
                "{deep}: OffsetMesh(mesh: {surface}, directions: {normals}, \
                 outward: \"base_{suffix}.area * 0.{depth}\"),"
            ),
        ];
        nodes.rotate_left(self.turn);
        let comment = if self.comment { "// again\n" } else { "" };
        format!(
            "Graph(version: 1, params: {{\"levels\": {levels}, \"t\": 0.{thickness}}}, \
             {comment} nodes: {{{}}}, outputs: {{\"deep.obj\": {deep}, \"size.json\": {size}}})",
            nodes.join("\n")
        )
    }

    fn world(&self) -> MemoryWorld {
        let mut world = MemoryWorld::default();
        let text = match self.cage {
            Cage::Raised(height) => CAGE.replace("0.2", &format!("0.{height}")),
            Cage::Redrawn => format!("# again\n{}", CAGE.replace("0.2", "0.0")),
            Cage::Broken => CAGE.replace("f 1 2 3 4", "f 1 2 3 9"),
            Cage::Missing => return world,
        };
        world.insert("cage.obj", text.as_bytes());
        world
    }

    /// Digests of the outputs' values, and what is said of nodes.
    fn run(&self, engine: &Engine, observer: &dyn Observer) -> Given {
        let plan = support::load("edit.ron", &self.text());
        let wanted: Vec<_> = plan.outputs.iter().map(|output| output.result).collect();
        let evaluation = engine.evaluate(&plan, &wanted, &self.world(), observer);
        let digest = |&result| {
            let value = evaluation.value(result)?;
            assert_eq!(Some(value.digest()), evaluation.digest(result));
            Some(value.digest())
        };
        Given {
            outputs: wanted.iter().map(digest).collect(),
            said: support::shown(&evaluation.diagnostics),
        }
    }
}

/// What a run came to.
#[derive(Debug, PartialEq)]
struct Given {
    outputs: Vec<Option<Digest>>,
    said: String,
}

/// Stops a run when it has asked `0` times whether it should stop.
struct StopAfter(AtomicU64);

impl Observer for StopAfter {
    fn cancelled(&self) -> bool {
        let before = self
            .0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| {
                left.checked_sub(1)
            });
        before.is_err()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn warm_is_cold(edits in prop::collection::vec(edit(), 1..12), budget in 0..20_000u64) {
        let folder = tempfile::tempdir().expect("a folder");
        let mut sheet = Sheet {
            levels: 1, thickness: 1, depth: 1, suffix: 0, turn: 0, comment: false, cage: Cage::Raised(2),
        };
        // One process that stays, with hardly any memory, and one that is new each time.
        let stays = Engine::with_disk(budget, folder.path());
        let alone = Engine::new(budget);
        for edit in edits {
            sheet.apply(&edit);
            if let Edit::Stop(after) = edit {
                let new = Engine::with_disk(1 << 20, folder.path());
                for engine in [&stays, &alone, &new] {
                    sheet.run(engine, &StopAfter(AtomicU64::new(after)));
                }
            }
            let cold = sheet.run(&Engine::without_cache(), &Silent);
            let complete = cold.outputs.iter().all(Option::is_some);
            let sound = !matches!(sheet.cage, Cage::Broken | Cage::Missing) && sheet.thickness > 0;
            prop_assert_eq!(complete, sound, "{}", &cold.said);
            prop_assert_eq!(&sheet.run(&stays, &Silent), &cold);
            prop_assert_eq!(&sheet.run(&alone, &Silent), &cold);
            let new = Engine::with_disk(1 << 20, folder.path());
            prop_assert_eq!(&sheet.run(&new, &Silent), &cold);
        }
    }
}
