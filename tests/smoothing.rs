//! Smoothed normals (§3.1): what they free, from how many passes on, and where
//! they stay on their side.

use crate::support::{self, Ran, workspace};

/// A graph over a recorded case's base and component, with parameters set.
fn ran(case: &str, nodes: &str, set: &[(&str, &str)]) -> Ran {
    let text = format!(
        "Graph(version: 1, params: {{\"passes\": 0, \"diffusion\": 1.0, \"depth\": 0.4, \"noise\": 0.0}},
        nodes: {{
            \"read\": ReadMesh(path: \"base.obj\"),
            \"part\": ReadMesh(path: \"component.obj\"),
            {nodes},
            \"check\": CheckIntersections(mesh: \"array\", between: Components),
            \"shape\": MeasureDistortion(mesh: \"array\", component: \"part\"),
        }}, outputs: {{\"out.obj\": \"array\"}})"
    );
    let folder = workspace().join("tests/peer/cases").join(case);
    let plan = support::load_with(case, &text, set);
    let ran = Ran::run(plan, &support::world_of(&folder));
    let found = &ran.evaluation.diagnostics;
    assert!(ran.evaluation.is_ok(), "{}", support::shown(found));
    ran
}

/// Smoothed and compensated globally; the component reaches 0.1 below the base.
const FOLD: &str = "\"directions\": SmoothNormals(mesh: \"read\", diffusion: \"diffusion\", iterations: \"passes\"),
    \"even\": CompensateThickness(mesh: \"read\", directions: \"directions\", thickness: \"depth\", inward: 0.1),
    \"array\": ArrayComponents(base: \"read\", component: \"part\", directions: \"even\", fit: Unit)";

const NARROW: (&str, &str) = ("03_fold_default", "0.4");
const VALLEY: (&str, &str) = ("30_valley_fold_default", "1.3");

#[test]
fn enough_passes_free_the_folds() {
    for ((case, depth), passes, diffusion) in [
        (NARROW, "400", "1"),
        (NARROW, "800", "0.5"),
        (VALLEY, "20", "1"),
        (VALLEY, "40", "0.5"),
    ] {
        let set = [
            ("passes", passes),
            ("diffusion", diffusion),
            ("depth", depth),
        ];
        let ran = ran(case, FOLD, &set);
        for result in [
            "check.pairs",
            "shape.inverted",
            "even.unsolved",
            "even.inverted",
        ] {
            assert_eq!(ran.count(result), 0, "{case} {passes}: {result}");
        }
        assert!(ran.number("even.max_error") <= 1e-4, "{case} {passes}");
        assert!(ran.number("even.least_cosine") > 0.0, "{case} {passes}");
    }
}

#[test]
fn with_fewer_passes_crossings_remain_and_are_reported() {
    for ((case, depth), passes) in [(NARROW, "100"), (NARROW, "300"), (VALLEY, "5")] {
        let ran = ran(case, FOLD, &[("passes", passes), ("depth", depth)]);
        let (pairs, inverted) = (
            ran.count("check.component_pairs"),
            ran.count("shape.inverted"),
        );
        println!("{case}, {passes} passes: {pairs} component pairs, {inverted} inverted");
        assert!(
            pairs >= 100 && inverted >= 16,
            "{case} {passes}: {pairs}, {inverted}"
        );
    }
}

#[test]
fn compensation_alone_does_not_free_plain_normals() {
    let plain = FOLD.replace("directions: \"even\"", "directions: \"directions\"");
    for ((case, depth), pairs) in [(NARROW, 176), (VALLEY, 152)] {
        let uncompensated = ran(case, &plain, &[("depth", depth)]);
        assert_eq!(
            uncompensated.count("check.component_pairs"),
            pairs,
            "{case}"
        );
        assert_eq!(uncompensated.count("shape.inverted"), 16, "{case}");
        let compensated = ran(case, FOLD, &[("depth", depth)]);
        assert!(compensated.count("check.component_pairs") > 0, "{case}");
    }
    // Five of twelve columns on each side have no room: the report says so.
    let narrow = ran(NARROW.0, FOLD, &[]);
    assert!(narrow.count("even.unsolved") * 10 > narrow.mesh("read").vertex_count() as i64);
    let said = narrow.warnings().concat();
    assert!(said.contains("no room for this thickness"), "{said}");
}

const POLES: &str = "\"normals\": VertexNormals(mesh: \"read\"),
    \"size\": MeasureMesh(mesh: \"read\"),
    \"rough\": RandomField(mesh: \"read\", low: -1, high: 1),
    \"named\": SetAttribute(mesh: \"read\", name: \"bump\", field: \"rough\"),
    \"bumps\": EvaluateField(mesh: \"named\", value: \"bump * noise * size.size_z / 2\"),
    \"base\": DisplaceVertices(mesh: \"read\", directions: \"normals\", distance: \"bumps\"),
    \"directions\": SmoothNormals(mesh: \"base\", iterations: \"passes\"),
    \"array\": ArrayComponents(base: \"base\", component: \"part\", directions: \"directions\", fit: Unit)";
const SPHERE: &str = "46_sphere_pole_CONSTANT_smooth5";

#[test]
fn poles_of_valence_32_invert_no_component() {
    for noise in ["0", "0.01"] {
        let ran = ran(SPHERE, POLES, &[("passes", "400"), ("noise", noise)]);
        assert_eq!(ran.count("array.placed"), 384);
        assert_eq!(ran.count("shape.inverted"), 0, "noise {noise}");
        assert!(ran.warnings().is_empty(), "{:?}", ran.warnings());
    }
    // The paper's add-on's step turns 128 over at once.
    let step = POLES.replace(
        "iterations: \"passes\"",
        "iterations: \"passes\", scheme: EdgeSum",
    );
    let diverged = ran(SPHERE, &step, &[("passes", "6")]);
    assert_eq!(diverged.count("shape.inverted"), 128);
}

#[test]
fn directions_that_lost_the_shape_are_counted() {
    let rough = [("passes", "10000"), ("noise", "0.01")];
    let ran = ran(SPHERE, POLES, &rough);
    assert!(ran.count("shape.inverted") > 100);
    let said = ran.warnings().concat();
    assert!(said.contains("directions turn against 193 faces"), "{said}");
}
