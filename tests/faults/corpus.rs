//! Real and broken files from elsewhere, each read in a process of its own.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::desk::{Desk, Done, SMALL};
use crate::support::{text_of, workspace};

/// The folders with a MANIFEST.tsv: the one beside the project, and the one the
/// environment names.
fn folders() -> Vec<PathBuf> {
    let beside = workspace().join("../shared/corpus");
    let named = std::env::var_os("TESSGRAPH_CORPUS").map(PathBuf::from);
    let found = |folder: &PathBuf| folder.join("MANIFEST.tsv").is_file();
    [Some(beside), named]
        .into_iter()
        .flatten()
        .filter(found)
        .collect()
}

/// A line of the manifest.
struct Row<'a> {
    path: &'a str,
    expected: &'a str,
    counts: [Option<u64>; 2],
}

impl<'a> Row<'a> {
    fn of(line: &'a str) -> Self {
        let cells: Vec<_> = line.split('\t').collect();
        Self {
            path: cells[0],
            expected: cells[3],
            counts: [cells[4].parse().ok(), cells[5].parse().ok()],
        }
    }
}

fn run(path: &Path) -> Done {
    let desk = Desk::new();
    let name = path.to_string_lossy();
    if name.ends_with(".ron") {
        return desk.limited(SMALL, &["check", &name]);
    }
    desk.limited(SMALL, &["info", &name, "--json"])
}

/// What is wrong with the answer, if anything.
fn verdict(row: &Row<'_>, done: &Done, name: &str) -> Result<(), String> {
    let Some(status) = done.status else {
        return Err("was killed".to_owned());
    };
    if done.err.contains("panicked") {
        return Err("panicked".to_owned());
    }
    match (row.expected, status) {
        ("loads" | "either", 0) => {
            let found: Value = serde_json::from_str(&done.out).map_err(|e| e.to_string())?;
            let read = ["vertices", "faces"].map(|what| found[what].as_u64());
            let differs = |(wanted, read): (Option<u64>, Option<u64>)| {
                wanted.is_some_and(|wanted| Some(wanted) != read)
            };
            let pairs = row.counts.into_iter().zip(read);
            match pairs.clone().any(differs) {
                true if row.expected == "loads" => {
                    Err(format!("counts {:?}", pairs.collect::<Vec<_>>()))
                }
                _ => Ok(()),
            }
        }
        ("loads", _) => Err(format!("refused: {}", done.err)),
        ("refuse", 0) => Err("accepted".to_owned()),
        _ => {
            let says = ["error[", "help", name];
            match says.iter().find(|words| !done.err.contains(**words)) {
                Some(words) => Err(format!("no `{words}` in {}", done.err)),
                None => Ok(()),
            }
        }
    }
}

/// Files that the corpus itself does not hold whole, with the reason.
const INCOMPLETE: [(&str, &str); 1] = [(
    "gltf/gt_Unicode/Unicode ❤♻ Test.gltf",
    "its buffer `Unicode ❤♻ Binary.bin` is not in the corpus",
)];

#[cfg(unix)]
#[test]
fn every_file_of_the_corpus_loads_or_is_refused_as_it_should() {
    let folders = folders();
    if folders.is_empty() {
        println!("skipped: there is no ../shared/corpus, and TESSGRAPH_CORPUS names none");
    }
    for folder in folders {
        let manifest = text_of(&folder.join("MANIFEST.tsv"));
        let rows: Vec<_> = manifest.lines().skip(1).map(Row::of).collect();
        let mut wrong = Vec::new();
        for expected in ["loads", "refuse", "either"] {
            let rows = rows.iter().filter(|row| row.expected == expected);
            let mut right = 0;
            let total = rows.clone().count();
            for row in rows {
                let path = folder.join(row.path);
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                let plain: String = name.chars().take_while(char::is_ascii).collect();
                match verdict(row, &run(&path), &plain) {
                    Ok(()) => right += 1,
                    Err(what) => match INCOMPLETE.iter().find(|(path, _)| *path == row.path) {
                        Some((path, why)) if !why.is_empty() => println!("{path}: {why}"),
                        _ => wrong.push(format!("{}: {what}", row.path)),
                    },
                }
            }
            println!("{}: {expected}: {right} of {total}", folder.display());
        }
        assert!(
            wrong.is_empty(),
            "{} wrong:\n{}",
            wrong.len(),
            wrong.join("\n")
        );
    }
}
