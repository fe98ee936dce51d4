//! Every shipped graph runs, and its outputs are what a person judged right.

use crate::support::{self, Ran, workspace};

#[test]
fn shipped_graphs() {
    let folder = workspace().join("graphs");
    let mut paths: Vec<_> = std::fs::read_dir(&folder)
        .expect("graphs/")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "ron"))
        .collect();
    paths.sort();
    assert!(paths.len() >= 6, "{} graphs", paths.len());
    let world = support::world_of(&folder);
    for path in paths {
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let text = support::text_of(&path);
        assert!(
            text.starts_with(&format!("// {name}.ron: ")),
            "{name} begins with what it shows"
        );
        let ran = Ran::run(support::load_in(&name, &text, &world), &world);
        let outputs: Vec<_> = ran
            .plan
            .outputs
            .iter()
            .map(|output| (output.path.clone(), output.result))
            .collect();
        insta::with_settings!({snapshot_suffix => name.as_str(), omit_expression => true}, {
            insta::assert_snapshot!("graph", ran.summary(&outputs));
        });
        assert!(
            ran.evaluation.is_ok(),
            "{name}: {}",
            support::shown(&ran.evaluation.diagnostics)
        );
    }
}
