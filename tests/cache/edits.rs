//! After any sequence of edits a warm run gives what a cold one gives.

use proptest::prelude::*;
use tessgraph_geometry::digest::Digest;
use tessgraph_graph::Engine;

use super::Run;

/// What a designer has in the file at one moment.
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
}

/// One edit.
#[derive(Debug, Clone)]
enum Edit {
    Levels(u32),
    Thickness(u32),
    Depth(u32),
    Rename(u32),
    Reorder(usize),
    Comment,
}

fn edit() -> impl Strategy<Value = Edit> {
    prop_oneof![
        (0..3u32).prop_map(Edit::Levels),
        (1..4u32).prop_map(Edit::Thickness),
        (1..4u32).prop_map(Edit::Depth),
        (0..3u32).prop_map(Edit::Rename),
        (0..6usize).prop_map(Edit::Reorder),
        Just(Edit::Comment),
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
            format!("{shell}: OffsetMesh(mesh: {surface}, directions: {normals}, outward: \"t\"),"),
            format!("{size}: MeasureMesh(mesh: {shell}),"),
            format!(
                "{deep}: OffsetMesh(mesh: {surface}, directions: {normals}, \
                 outward: \"size_{suffix}.area * 0.{depth}\"),"
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
}

/// Digests without the suffixes of the names, in the order of the names.
fn digests(engine: &Engine, text: &str) -> Vec<(String, Digest)> {
    let mut found = Run::with(engine, text, false).digests();
    found.sort();
    found
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn warm_is_cold(edits in prop::collection::vec(edit(), 1..8), budget in 0..20_000u64) {
        let folder = tempfile::tempdir().expect("a folder");
        let mut sheet = Sheet { levels: 1, thickness: 1, depth: 1, suffix: 0, turn: 0, comment: false };
        // One process that stays, with hardly any memory, and one that is new each time.
        let stays = Engine::with_disk(budget, folder.path());
        let alone = Engine::new(budget);
        for edit in edits {
            sheet.apply(&edit);
            let text = sheet.text();
            let cold = digests(&Engine::without_cache(), &text);
            prop_assert_eq!(&digests(&stays, &text), &cold);
            prop_assert_eq!(&digests(&alone, &text), &cold);
            let new = Engine::with_disk(1 << 20, folder.path());
            prop_assert_eq!(&digests(&new, &text), &cold);
        }
    }
}
