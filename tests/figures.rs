//! The graphs of the paper's figures run, and show what they say.

use crate::support::{self, Ran, workspace};

/// The meshes of each figure's table in docs/figures.md, with their labels.
///
/// Of a mesh `m` nodes `m_crossings`, `m_shape` (of components), `m_depth`, and
/// `m_tops_size` and `m_feet_size` (where the tops' spread matters) are read.
const FIGURES: &[(&str, &[(&str, &str)])] = &[
    ("01", &[("facade", "rings along normals")]),
    (
        "02",
        &[
            ("monoclastic_default", "monoclastic, along normals"),
            ("synclastic_default", "synclastic, along normals"),
            ("anticlastic_default", "anticlastic, along normals"),
        ],
    ),
    (
        "03",
        &[
            ("divergent", "on a hill: normals diverge"),
            ("parallel", "on a plane"),
            ("convergent", "in a bowl: normals converge"),
        ],
    ),
    (
        "05",
        &[
            ("monoclastic_plain", "monoclastic, before"),
            ("monoclastic_few", "monoclastic, 4 passes"),
            ("monoclastic_many", "monoclastic, 60 passes"),
            ("synclastic_plain", "synclastic, before"),
            ("synclastic_few", "synclastic, 4 passes"),
            ("synclastic_many", "synclastic, 60 passes"),
            ("anticlastic_plain", "anticlastic, before"),
            ("anticlastic_few", "anticlastic, 4 passes"),
            ("anticlastic_many", "anticlastic, 60 passes"),
        ],
    ),
    (
        "07",
        &[
            ("monoclastic_default", "monoclastic, before"),
            ("monoclastic_corrected", "monoclastic, towards a target"),
            ("synclastic_default", "synclastic, before"),
            ("synclastic_corrected", "synclastic, towards a target"),
            ("anticlastic_default", "anticlastic, before"),
            ("anticlastic_corrected", "anticlastic, towards a target"),
        ],
    ),
    (
        "09",
        &[
            ("coarse_simple", "coarse, before"),
            ("coarse_compensated", "coarse, compensated"),
            ("dense_simple", "dense, before"),
            ("dense_compensated", "dense, compensated"),
        ],
    ),
    (
        "10",
        &[
            ("default", "along normals (C)"),
            ("by_target", "towards a target (D)"),
            ("even", "and every vertex at its height (E)"),
        ],
    ),
    (
        "11",
        &[
            ("distorted", "each point its own direction (C)"),
            ("translated", "one direction for a post (D)"),
        ],
    ),
    (
        "13",
        &[
            ("default", "along normals (C)"),
            ("controlled", "towards a target (D)"),
        ],
    ),
];

/// The graph of a figure, as text.
fn text_of_figure(number: &str) -> String {
    support::text_of(&workspace().join(format!("graphs/figures/figure_{number}.ron")))
}

/// The graph of a figure, run.
fn figure(number: &str) -> Ran {
    let (name, text) = (format!("figure_{number}"), text_of_figure(number));
    let title = format!("// {name}.ron: ");
    assert!(text.starts_with(&title), "{name} begins with what it shows");
    let folder = workspace().join("graphs/figures");
    let ran = Ran::run(support::load(&name, &text), &support::world_of(&folder));
    let found = &ran.evaluation.diagnostics;
    assert!(ran.evaluation.is_ok(), "{name}: {}", support::shown(found));
    ran
}

#[test]
fn every_figure_runs() {
    for (number, _) in FIGURES {
        let ran = figure(number);
        let is_mesh = |path: &str| path.ends_with(".glb");
        let outputs = ran
            .plan
            .outputs
            .iter()
            .filter(|output| is_mesh(&output.path));
        let outputs: Vec<_> = outputs
            .map(|output| (output.path.clone(), output.result))
            .collect();
        insta::with_settings!({snapshot_suffix => *number, omit_expression => true}, {
            insta::assert_snapshot!("figure", ran.summary(&outputs));
        });
    }
}

/// A share as a percentage a person can read.
fn percent(share: f64) -> String {
    match share * 100.0 {
        none if none.abs() < 1e-9 => "0 %".to_owned(),
        little if little.abs() < 0.005 => "< 0.01 %".to_owned(),
        other => format!("{other:.2} %"),
    }
}

/// The table of a figure; tops are compared with feet where the graph measures
/// them.
fn table(number: &str, meshes: &[(&str, &str)]) -> String {
    let (ran, text) = (figure(number), text_of_figure(number));
    let default = text
        .split_once("\"thickness\": Number(default: ")
        .and_then(|(_, rest)| rest.split_once(','));
    let thickness: f64 = default
        .and_then(|(number, _)| number.parse().ok())
        .expect("a thickness");
    let mut heads = vec!["", "pairs of components that cross", "of faces"];
    heads.extend([
        "inverted components",
        "thickness: rms error",
        "largest error",
    ]);
    let spreads = text.contains("_feet_size\"");
    heads.extend(spreads.then_some("area of tops against feet"));
    let mut rows = vec![heads.join(" | "), vec!["---"; heads.len()].join(" | ")];
    for (mesh, label) in meshes {
        let count = |result: &str| ran.count(&format!("{mesh}_{result}")).to_string();
        let has_shape = ran.plan.node_index(&format!("{mesh}_shape")).is_some();
        let of_components = |result: &str| match has_shape {
            true => count(result),
            false => "-".to_owned(),
        };
        let error = |which: &str| percent(ran.number(&format!("{mesh}_depth.{which}")) / thickness);
        let area = |part: &str| ran.number(&format!("{mesh}_{part}_size.area"));
        let mut row = vec![
            (*label).to_owned(),
            of_components("crossings.component_pairs"),
            count("crossings.pairs"),
            of_components("shape.inverted"),
            error("rms_error"),
            error("max_error"),
        ];
        row.extend(spreads.then(|| percent(area("tops") / area("feet") - 1.0)));
        rows.push(row.join(" | "));
    }
    rows.iter().map(|row| format!("| {row} |\n")).collect()
}

/// docs/figures.md with the tables between its marks as they are now.
fn with_tables(page: &str) -> String {
    let mut page = page.to_owned();
    for (number, meshes) in FIGURES {
        let mark = format!("<!-- numbers {number} -->\n");
        let start = page.find(&mark).unwrap_or_else(|| panic!("no {mark}")) + mark.len();
        let end = start + page[start..].find("<!-- end -->").expect("an end");
        page.replace_range(start..end, &table(number, meshes));
        assert!(page.contains(&format!("figures/figure_{number}.png")));
    }
    page
}

#[test]
fn the_page_of_figures_is_current() {
    let path = workspace().join("docs/figures.md");
    let page = support::text_of(&path);
    let current = with_tables(&page);
    if std::env::var_os("TESSGRAPH_FIGURES").is_some_and(|value| value == "update") {
        #[allow(clippy::disallowed_methods, reason = "the page is what is updated")]
        std::fs::write(&path, &current).expect("docs/figures.md is writable");
        return;
    }
    let differs = page
        .lines()
        .zip(current.lines())
        .find(|(old, new)| old != new);
    assert!(
        page == current,
        "docs/figures.md is out of date: run TESSGRAPH_FIGURES=update cargo test -p \
         tessgraph-tests figures; first difference: {differs:?}"
    );
}

#[test]
fn pictures_are_there_and_small() {
    for (number, _) in FIGURES {
        let path = workspace().join(format!("docs/figures/figure_{number}.png"));
        let size = std::fs::metadata(&path).map(|data| data.len());
        let size = size.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert!((5_000..150_000).contains(&size), "{number}: {size} bytes");
    }
}

#[test]
fn targets_solve_what_normals_do_not() {
    let surfaces = figure("07");
    for kind in ["monoclastic", "synclastic", "anticlastic"] {
        let result = |name: &str| surfaces.number(&format!("{kind}_corrected.{name}"));
        assert_eq!(result("unsolved") as usize, 0, "{kind}");
        assert!(result("outward_max_error") <= 1e-4, "{kind}");
        assert!(surfaces.count(&format!("{kind}_default_crossings.pairs")) > 100);
        assert_eq!(
            surfaces.count(&format!("{kind}_corrected_crossings.pairs")),
            0
        );
    }
    let fold = figure("10");
    let error = |name: &str| fold.number(&format!("{name}_depth.rms_error"));
    assert!(error("even") < 1e-4 * error("by_target"));
    assert!(error("even") < 1e-4 * error("default"));
    let roof = figure("13");
    assert_eq!(roof.count("controlled.unsolved"), 0);
    assert_eq!(roof.count("controlled_crossings.pairs"), 0);
    assert!(roof.count("default_crossings.component_pairs") > 0);
}

#[test]
fn smoothing_frees_first_and_loses_the_shape_later() {
    let ran = figure("05");
    for kind in ["monoclastic", "synclastic", "anticlastic"] {
        let pairs = |passes: &str| ran.count(&format!("{kind}_{passes}_crossings.pairs"));
        assert!(pairs("plain") > pairs("few"), "{kind}");
        assert_eq!(pairs("many"), 0, "{kind}");
        // The price: along directions that no longer follow the surface the
        // thickness is lost again.
        let error = |passes: &str| ran.number(&format!("{kind}_{passes}_depth.rms_error"));
        assert!(error("many") > error("few"), "{kind}");
    }
}

#[test]
fn one_direction_keeps_a_post_from_spreading() {
    let ran = figure("11");
    let area = |name: &str| ran.number(&format!("{name}_size.area"));
    let spread = |mesh: &str| area(&format!("{mesh}_tops")) / area(&format!("{mesh}_feet")) - 1.0;
    assert!(spread("distorted") > 0.1, "{}", spread("distorted"));
    assert!(
        spread("translated").abs() < 1e-9,
        "{}",
        spread("translated")
    );
}
