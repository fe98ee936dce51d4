//! Components whose every vertex keeps its own height (§5), on the folds of the
//! add-on's cases.

use tessgraph_geometry::Unmonitored;
use tessgraph_geometry::surface::Surface;

use crate::support::{self, Ran, workspace};

/// The array of a case's component over its base, compensated.
fn compensated(case: &str, directions: &str) -> Ran {
    let text = format!(
        "Graph(version: 1, nodes: {{
            \"base\": ReadMesh(path: \"base.obj\"),
            {directions},
            \"part\": ReadMesh(path: \"component.obj\"),
            \"array\": ArrayComponents(base: \"base\", component: \"part\", fit: Unit,
                directions: \"directions\", compensate: PerVertex),
            \"check\": CheckIntersections(mesh: \"array\"),
            \"shape\": MeasureDistortion(mesh: \"array\", component: \"part\"),
        }}, outputs: {{\"out.obj\": \"array\"}})"
    );
    let folder = workspace().join("tests/peer/cases").join(case);
    let ran = Ran::run(support::load(case, &text), &support::world_of(&folder));
    let found = &ran.evaluation.diagnostics;
    assert!(ran.evaluation.is_ok(), "{}", support::shown(found));
    ran
}

const TOWARDS: &str = "\"target\": ReadMesh(path: \"target.obj\"),
            \"directions\": TargetDirections(mesh: \"base\", target: \"target\", length: Unit)";

/// Results of the array by name.
fn of(ran: &Ran, result: &str) -> f64 {
    ran.number(&format!("array.{result}"))
}

#[test]
fn folds_with_targets_keep_every_height() {
    for case in ["08_fold_target_even10", "32_valley_fold_target_constant"] {
        let ran = compensated(case, TOWARDS);
        let value = |result| of(&ran, result);
        assert_eq!(
            value("unsolved") as usize,
            0,
            "{case}: {:?}",
            ran.warnings()
        );
        for result in ["check.pairs", "check.component_pairs", "shape.inverted"] {
            assert_eq!(ran.count(result), 0, "{case}: {result}");
        }
        assert!(ran.warnings().is_empty(), "{case}: {:?}", ran.warnings());
        // By a second search from scratch, by the same border rule.
        let base = Surface::new(&ran.mesh("base"), &Unmonitored).expect("faces");
        for sign in [1.0, -1.0] {
            let errors = support::height_errors(&ran.mesh("array"), &base, &ran.mesh("part"), sign);
            println!("{case}: side {sign}: measured {errors:?}");
            assert!(errors.max <= 2e-4, "{case}: {errors:?}");
        }
        for side in ["outward", "inward"] {
            let side = |result: &str| of(&ran, &format!("{side}_{result}"));
            let [solved, extended, clipped] = ["solved", "extended", "border_clipped"].map(&side);
            let (max, rms) = (side("max_error"), side("rms_error"));
            println!(
                "{case}: solved {solved}, extended {extended}, clipped {clipped}, \
                 max {max:.2e}, rms {rms:.2e}"
            );
            assert!(solved > 0.0, "{case}");
            assert!(max <= 2e-4, "{case}: {max}");
        }
        let most = value("most_evaluations");
        let vertices = ran.mesh("array").vertex_count() as f64;
        let mean = value("evaluations") / vertices;
        println!("{case}: at most {most} evaluations, {mean:.2} in the mean");
        assert!(most <= 12.0, "{case}: {most}");
    }
}

#[test]
fn plain_normals_of_a_narrow_fold_have_no_solution() {
    let normals = "\"directions\": VertexNormals(mesh: \"base\")";
    let ran = compensated("03_fold_default", normals);
    println!("{:?}", ran.warnings());
    assert_eq!(of(&ran, "outward_unsolved") as usize, 320);
    let warning = ran.warnings().concat();
    assert!(warning.contains("no solution at 320 of"), "{warning}");
    assert!(warning.contains("base faces"), "{warning}");
}
