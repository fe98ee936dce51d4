//! What must not break it: each fault of a list, by its number.
//!
//! A test is named after the faults it holds, `f045_...`. Faults that are held
//! by tests elsewhere, and those that cannot be tested on one machine, stand in
//! the tables here, and a test compares all three with the list.

mod corpus;
mod desk;
mod file_system;
mod graph_file;
mod killing;
mod mesh_content;
mod mesh_file;
mod size;

use std::collections::{BTreeMap, BTreeSet};

use crate::support::{text_of, workspace};

/// The faults of the list that concern what there is.
const LAST: u32 = 106;

/// Held by tests that stand with what they test: fault, file, test.
const ELSEWHERE: &[(u32, &str, &str)] = &[
    (
        68,
        "tests/faults/corpus.rs",
        "every_file_of_the_corpus_loads_or_is_refused_as_it_should",
    ),
    (70, "crates/io/src/hostile.rs", "damaged_files"),
    (
        101,
        "tests/cache/damage.rs",
        "any_flipped_byte_is_found_out",
    ),
    (
        102,
        "tests/cache/folder.rs",
        "a_folder_of_another_version_is_left_alone",
    ),
    (
        103,
        "tests/cache/sharing.rs",
        "eight_processes_share_a_folder_and_one_is_killed",
    ),
    (
        104,
        "tests/cache/folder.rs",
        "failures_leave_nothing_behind",
    ),
    (105, "tests/cache/edits.rs", "warm_is_cold"),
];

/// Not testable here, with the reason.
const UNTESTED: &[(u32, &str)] = &[
    (27, "graphs do not include others yet"),
    (28, "graphs do not include others yet"),
    (29, "graphs do not include others yet"),
    (86, "nothing is watched yet"),
    (87, "nothing is watched yet"),
    (88, "nothing is watched yet"),
    (89, "nothing is watched yet"),
    (90, "nothing is watched yet"),
    (91, "nothing is watched yet"),
    (92, "nothing is watched yet"),
    (93, "nothing is watched yet"),
    (94, "nothing is watched yet"),
    (95, "nothing is watched yet"),
    (96, "nothing is watched yet"),
    (97, "nothing is watched yet"),
];

/// The numbers in the names of tests: "f059_f060_..." holds two.
fn numbers(source: &str) -> impl Iterator<Item = u32> {
    let names = source.lines().filter_map(|line| line.strip_prefix("fn f"));
    names.flat_map(|name| {
        let parts = name.split('_').map(|part| part.trim_start_matches('f'));
        parts
            .map_while(|part| part.parse().ok())
            .collect::<Vec<_>>()
    })
}

#[test]
fn every_fault_of_the_list_has_a_test() {
    let folder = workspace().join("tests/faults");
    let mut held: BTreeMap<u32, &str> = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "rs") {
            held.extend(numbers(&text_of(&path)).map(|number| (number, "here")));
        }
    }
    for (number, file, test) in ELSEWHERE {
        let source = text_of(&workspace().join(file));
        assert!(
            source.contains(&format!("fn {test}")),
            "{file} has no {test}"
        );
        held.insert(*number, file);
    }
    held.extend(UNTESTED.iter().copied());
    let missing: BTreeSet<_> = (1..=LAST)
        .filter(|number| !held.contains_key(number))
        .collect();
    println!(
        "{} of {LAST} faults have a test",
        LAST as usize - missing.len() - UNTESTED.len()
    );
    for (number, reason) in UNTESTED {
        println!("fault {number} has none: {reason}");
    }
    assert!(missing.is_empty(), "no test of {missing:?}");
}
