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
mod page;
mod size;

use std::collections::{BTreeMap, BTreeSet};

use crate::support::{text_of, workspace};

/// The faults of the list that concern what there is.
const LAST: u32 = 113;

/// Held by tests that stand with what they test: fault, file, test.
const ELSEWHERE: &str = "
68 tests/faults/corpus.rs every_file_of_the_corpus_loads_or_is_refused_as_it_should
70 crates/io/src/hostile.rs damaged_files
86 tests/watch/editors.rs every_way_of_saving_is_followed
87 tests/watch/editors.rs a_half_written_file_is_an_error_until_the_rest_comes
88 tests/watch/editors.rs a_hundred_saves_in_a_second_end_in_the_last_content
89 tests/watch/stopping.rs an_edit_stops_a_node_of_a_million_vertices_at_once
90 tests/watch/disturbances.rs a_graph_that_is_removed_and_restored_recovers
91 tests/watch/disturbances.rs a_folder_that_is_removed_and_made_again_is_followed
92 tests/watch/disturbances.rs what_is_missing_at_the_start_is_awaited
93 tests/watch/dependencies.rs a_mesh_is_followed_while_it_is_used
94 tests/watch/disturbances.rs what_only_seems_to_change_starts_nothing
95 tests/watch/disturbances.rs outputs_start_nothing_wherever_they_are
96 crates/cli/src/watch/notices.rs the_systems_limit_is_told_apart
97 tests/watch/memory.rs a_watching_process_stays_as_large_as_it_is
101 tests/cache/damage.rs any_flipped_byte_is_found_out
102 tests/cache/folder.rs a_folder_of_another_version_is_left_alone
103 tests/cache/sharing.rs eight_processes_share_a_folder_and_one_is_killed
104 tests/cache/folder.rs failures_leave_nothing_behind
105 tests/cache/edits.rs warm_is_cold
";

/// Not testable here, with the reason.
const UNTESTED: &[(u32, &str)] = &[];

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
    for row in ELSEWHERE.trim().lines() {
        let mut words = row.split(' ');
        let mut word = || words.next().expect("fault, file and test");
        let (number, file, test) = (word(), word(), word());
        let source = text_of(&workspace().join(file));
        assert!(
            source.contains(&format!("fn {test}")),
            "{file} has no {test}"
        );
        held.insert(number.parse().expect("a number"), file);
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
