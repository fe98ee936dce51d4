//! The table of a study of the graph that is shown, if there is one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use tessgraph_graph::study::Study;
use tessgraph_graph::world::read_plain;
use tessgraph_view::protocol::{self, Value};

use crate::commands::study::table_of;
use crate::graph_file::{LARGEST_GRAPH, folder_of};
use crate::places::is_same_file;

/// Bytes of a table that the page can show.
const LARGEST_TABLE: u64 = 16 << 20;

/// Files that are looked at: folders with more are no folders of studies.
const MOST_FILES: usize = 1000;

/// The folders studies are looked for in, from the graph's.
const FOLDERS: [&str; 2] = ["", "studies"];

/// The studies of the graph, and which of their tables was told last.
#[derive(Default)]
pub(super) struct Studies {
    /// The table of each file that is a study of the graph, and nothing for the
    /// others, as they were at that time.
    known: BTreeMap<PathBuf, (SystemTime, Option<PathBuf>)>,
    told: Option<(SystemTime, PathBuf)>,
}

impl Studies {
    /// The newest table of a study of the graph, of studies beside it or in the
    /// folder `studies` there, if it is another than the last time.
    ///
    /// Only files that are new are read: this is asked again and again.
    pub(super) fn look(&mut self, graph: &Path) -> Option<protocol::Study> {
        let folder = folder_of(graph);
        let mut known = BTreeMap::new();
        for file in FOLDERS.iter().flat_map(|name| files_in(&folder.join(name))) {
            let Some(changed) = modified(&file) else {
                continue;
            };
            let before = self.known.remove(&file);
            let before = before.filter(|(then, _)| *then == changed);
            let found = before.unwrap_or_else(|| (changed, table_for(&file, graph)));
            known.insert(file, found);
        }
        self.known = known;
        let tables = self.known.values().filter_map(|(_, table)| table.as_ref());
        let newest = tables.filter_map(|table| Some((modified(table)?, table.clone())));
        let newest = newest.max()?;
        if self.told.as_ref() == Some(&newest) {
            return None;
        }
        let bytes = read_plain(&newest.1, LARGEST_TABLE).ok()?;
        let (columns, rows) = parse(&bytes)?;
        let below = newest.1.strip_prefix(&folder).unwrap_or(&newest.1);
        let path = below.to_string_lossy().into_owned();
        self.told = Some(newest);
        Some(protocol::Study {
            path,
            columns,
            rows,
            pictures: Vec::new(),
        })
    }
}

fn modified(file: &Path) -> Option<SystemTime> {
    file.metadata().ok()?.modified().ok()
}

/// The table of the study in `file`, if it is one of the graph.
fn table_for(file: &Path, graph: &Path) -> Option<PathBuf> {
    let bytes = read_plain(file, LARGEST_GRAPH).ok()?;
    let study = Study::read(&file.to_string_lossy(), &bytes).ok()?;
    let of = folder_of(file).join(study.graph());
    is_same_file(&of, graph).then(|| table_of(file))
}

/// Gives every row its picture, where its variant has left one; the paths by
/// number.
pub(super) fn add_pictures(graph: &Path, study: &mut protocol::Study) -> Vec<PathBuf> {
    let table = folder_of(graph).join(&study.path);
    let variants = folder_of(&table).join("variants");
    let mut paths = Vec::new();
    let pictures = study.rows.iter().map(|row| {
        // Ids that look like numbers are read as such; those name no folder here.
        let Some(Some(Value::Text(id))) = row.first() else {
            return None;
        };
        let is_name = id
            .bytes()
            .all(|byte| byte.is_ascii_alphanumeric() || byte == b'-');
        let path = first_picture(&variants.join(is_name.then_some(id)?))?;
        paths.push(path);
        Some(paths.len() - 1)
    });
    study.pictures = pictures.collect();
    if paths.is_empty() {
        study.pictures.clear();
    }
    paths
}

/// The first PNG of a folder by name.
fn first_picture(folder: &Path) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    let pictures = entries.map(|entry| entry.path()).filter(|path| {
        path.extension().is_some_and(|extension| extension == "png") && path.is_file()
    });
    pictures.take(MOST_FILES).min()
}

/// A picture as the page shows it.
pub(super) fn picture(path: &Path) -> Option<Vec<u8>> {
    read_plain(path, LARGEST_TABLE).ok()
}

/// The graphs and studies of a folder.
fn files_in(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.map(|entry| entry.path()).filter(|path| {
        path.extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("ron"))
    });
    files.take(MOST_FILES).collect()
}

type Rows = Vec<Vec<Option<Value>>>;

/// The headings and rows of a table as `study` writes it.
fn parse(bytes: &[u8]) -> Option<(Vec<String>, Rows)> {
    let mut reader = csv::Reader::from_reader(bytes);
    let columns = reader.headers().ok()?.iter().map(str::to_owned).collect();
    let rows = reader.records().map(|record| {
        let record = record.ok()?;
        Some(record.iter().map(cell).collect())
    });
    Some((columns, rows.collect::<Option<Rows>>()?))
}

/// A cell; `None` for an empty one.
fn cell(text: &str) -> Option<Value> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    match number {
        _ if text.is_empty() => None,
        Some(number) => Some(Value::Number(number)),
        None => Some(Value::Text(text.to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_with_their_kinds() {
        let text = "id,n,note,error\na1,3,\"x, \"\"y\"\"\",\nb2,0.5,true,no\n";
        let (columns, rows) = parse(text.as_bytes()).unwrap();
        assert_eq!(columns, ["id", "n", "note", "error"]);
        let word = |text: &str| Some(Value::Text(text.to_owned()));
        let number = |number| Some(Value::Number(number));
        assert_eq!(rows[0], [word("a1"), number(3.0), word("x, \"y\""), None]);
        assert_eq!(rows[1], [word("b2"), number(0.5), word("true"), word("no")]);
        assert!(parse(b"a,b\n1\n").is_none());
    }

    #[test]
    fn rows_have_the_pictures_that_their_variants_left() {
        let folder = tempfile::tempdir().unwrap();
        let variants = folder.path().join("out/s/variants");
        for (variant, file) in [("a1", "b.png"), ("a1", "a.png"), ("c3", "mesh.obj")] {
            std::fs::create_dir_all(variants.join(variant)).unwrap();
            std::fs::write(variants.join(variant).join(file), file).unwrap();
        }
        std::fs::write(folder.path().join("out/s/secret.png"), "").unwrap();
        let rows = ["b2", "a1", "c3", "..", "../.."];
        let mut study = protocol::Study {
            path: "out/s/results.csv".to_owned(),
            columns: vec!["id".to_owned()],
            rows: rows
                .map(|id| vec![Some(Value::Text(id.to_owned()))])
                .to_vec(),
            pictures: Vec::new(),
        };
        let paths = add_pictures(&folder.path().join("g.ron"), &mut study);
        assert_eq!(study.pictures, [None, Some(0), None, None, None]);
        assert_eq!(paths, [variants.join("a1/a.png")]);
        assert_eq!(picture(&paths[0]).as_deref(), Some(b"a.png".as_slice()));
    }

    #[test]
    fn the_study_of_this_graph_is_found_and_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in ["out/other", "studies/out/mine"] {
            std::fs::create_dir_all(at(name)).unwrap();
            std::fs::write(at(name).join("results.csv"), format!("id\n{name}\n")).unwrap();
        }
        let study = |graph: &str| {
            format!(
                "Study(version: 1, graph: \"{graph}\", axes: {{\"n\": Values(of: [1])}}, keep: [])"
            )
        };
        std::fs::write(at("g.ron"), "").unwrap();
        std::fs::write(at("h.ron"), "").unwrap();
        std::fs::write(at("other.ron"), study("h.ron")).unwrap();
        std::fs::write(at("studies/mine.ron"), study("../g.ron")).unwrap();
        let mut studies = Studies::default();
        let found = studies.look(&at("g.ron")).unwrap();
        assert_eq!(
            Path::new(&found.path),
            Path::new("studies/out/mine/results.csv")
        );
        assert_eq!(
            found.rows,
            [[Some(Value::Text("studies/out/mine".to_owned()))]]
        );
        assert_eq!(studies.look(&at("g.ron")), None, "nothing is new");
        assert!(Studies::default().look(&at("studies/mine.ron")).is_none());
    }

    #[test]
    fn a_table_that_is_made_later_is_found_then() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("g.ron"), "").unwrap();
        let study = "Study(version: 1, graph: \"g.ron\", axes: {\"n\": Values(of: [1])}, keep: [])";
        std::fs::write(at("s.ron"), study).unwrap();
        let mut studies = Studies::default();
        assert_eq!(studies.look(&at("g.ron")), None);
        let table = table_of(&at("s.ron"));
        std::fs::create_dir_all(table.parent().unwrap()).unwrap();
        std::fs::write(&table, "id\na\n").unwrap();
        assert_eq!(studies.look(&at("g.ron")).unwrap().columns, ["id"]);
    }
}
