//! Cases run through the paper's own add-on for Blender, reproduced.
//!
//! Each folder holds a base, a component, the add-on's settings and what it
//! made of them (tests/peer/cases/README.md). From the settings a graph is
//! built that asks for the same, and the results are compared. Any folder of
//! the same layout will do: name it in TESSGRAPH_PEER_CASES.

mod case;
mod compare;
mod even;
mod folders;
mod mapped;
mod patch;
mod settings;
mod towards;
mod triangles;

use std::path::PathBuf;

use crate::support::workspace;
use case::{Case, Verdict};

/// Cases that must be reproduced by this version; the others may be refused.
const REPRODUCED: &[&str] = &[
    "01", "02", "03", "04", "06", "07", "08", "10", "11", "12", "13", "15", "16", "17", "19b",
    "30", "31", "32", "40", "45", "46",
];

#[test]
fn cases_of_the_add_on() {
    let folder = std::env::var_os("TESSGRAPH_PEER_CASES")
        .map_or_else(|| workspace().join("tests/peer/cases"), PathBuf::from);
    let cases = Case::all_in(&folder);
    let mut failures = Vec::new();
    let (mut reproduced, mut beaten, mut refused) = (0, 0, 0);
    for case in &cases {
        let verdict = case.verdict();
        println!("{}: {verdict}", case.name);
        let required = REPRODUCED
            .iter()
            .any(|prefix| case.name.split('_').next() == Some(prefix));
        match verdict {
            Verdict::Reproduced | Verdict::ReproducedWelded => reproduced += 1,
            Verdict::Beaten(_) => beaten += 1,
            Verdict::Refused(_) if !required => refused += 1,
            verdict => failures.push(format!("{}: {verdict}", case.name)),
        }
    }
    println!(
        "reproduced {reproduced}, beaten {beaten}, refused {refused} of {}",
        cases.len()
    );
    assert!(!cases.is_empty(), "no cases in {}", folder.display());
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
