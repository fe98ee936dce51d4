//! The graphs of the paper's figures run, and show what they say.

use crate::support::{self, Ran, workspace};

/// The graph of a figure, run.
fn figure(number: &str) -> Ran {
    let folder = workspace().join("graphs/figures");
    let name = format!("figure_{number}");
    let text = support::text_of(&folder.join(format!("{name}.ron")));
    let title = format!("// {name}.ron: ");
    assert!(text.starts_with(&title), "{name} begins with what it shows");
    let ran = Ran::run(support::load(&name, &text), &support::world_of(&folder));
    let found = &ran.evaluation.diagnostics;
    assert!(ran.evaluation.is_ok(), "{name}: {}", support::shown(found));
    ran
}

#[test]
fn every_figure_runs() {
    for number in ["01", "02", "03", "05", "07", "09", "10", "11", "13"] {
        let ran = figure(number);
        let outputs: Vec<_> = ran
            .plan
            .outputs
            .iter()
            .map(|output| (output.path.clone(), output.result))
            .collect();
        insta::with_settings!({snapshot_suffix => number, omit_expression => true}, {
            insta::assert_snapshot!("figure", ran.summary(&outputs));
        });
    }
}

#[test]
fn targets_solve_what_normals_do_not() {
    let surfaces = figure("07");
    for kind in ["monoclastic", "synclastic", "anticlastic"] {
        let result = |name: &str| surfaces.number(&format!("{kind}_corrected.{name}"));
        assert_eq!(result("unsolved") as usize, 0, "{kind}");
        assert!(result("outward_max_error") <= 1e-4, "{kind}");
    }
    let fold = figure("10");
    let error = |name: &str| fold.number(&format!("{name}_depth.rms_error"));
    assert!(error("even") < 1e-4 * error("by_target"));
    assert!(error("even") < 1e-4 * error("default"));
    assert_eq!(figure("13").number("controlled.unsolved") as usize, 0);
}
