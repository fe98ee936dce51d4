//! Each broken graph in tests/suite/errors names its one mistake well.

use std::path::Path;

#[test]
fn broken_graphs() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("suite/errors");
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .expect("suite/errors")
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .filter(|name| name.ends_with(".ron"))
        .collect();
    names.sort();
    assert!(names.len() >= 15, "{} broken graphs", names.len());
    for name in names {
        // Tests run in the folder of their crate, so messages show this path.
        let path = format!("suite/errors/{name}");
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let status = tessgraph::run(["tessgraph", "run", &path], &mut out, &mut err);
        let text = String::from_utf8(err).expect("messages are UTF-8");
        assert_eq!(status, 1, "{name}: {text}");
        assert!(out.is_empty(), "{name} printed {out:?}");
        assert!(!text.contains("panicked"), "{name}: {text}");
        assert!(!folder.join("out").exists(), "{name} wrote something");
        // The table of nodes that follows a run has times in it.
        let text = text.split("\nnode ").next().unwrap_or_default().trim_end();
        let suffix = name.trim_end_matches(".ron").to_owned();
        insta::with_settings!({snapshot_suffix => suffix, omit_expression => true}, {
            insta::assert_snapshot!("error", text);
        });
    }
}
