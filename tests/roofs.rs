//! Built roofs whose normals cross when offset far, freed by smoothing (§3.1).

use tessgraph_geometry::Mesh;

use crate::support::{self, Ran, workspace};

/// One run of tests/judged/roof.ron.
struct Roof {
    ran: Ran,
    /// The mean edge of the faces, in which offsets are given.
    edge: f64,
    offset: f64,
}

#[allow(
    clippy::print_stdout,
    reason = "what was skipped, and the price, are for people"
)]
impl Roof {
    /// The roof `name` offset by `edges` mean edges; `None`, said aloud, without
    /// the corpus.
    fn offset(name: &str, edges: f64, settings: &[(&str, &str)]) -> Option<Self> {
        let folder = workspace().join("../shared/corpus/quad");
        let file = folder.join(format!("{name}.obj"));
        if !file.is_file() {
            println!("skipped: {} is not here", file.display());
            return None;
        }
        let edge = mean_edge(&support::read_obj(&file).expect("a mesh"));
        let offset = edges * edge;
        let (file, length) = (format!("{name}.obj"), format!("{offset:?}"));
        let own = [("file", file.as_str()), ("offset", length.as_str())];
        let text = support::text_of(&workspace().join("tests/judged/roof.ron"));
        let plan = support::load_with("roof.ron", &text, &[settings, &own].concat());
        let ran = Ran::run(plan, &support::world_of(&folder));
        let found = &ran.evaluation.diagnostics;
        assert!(ran.evaluation.is_ok(), "{}", support::shown(found));
        Some(Self { ran, edge, offset })
    }

    fn plain(&self) -> i64 {
        self.ran.count("plain.pairs") + self.ran.count("plain.contacts")
    }

    /// Says what freedom costs, and holds it.
    fn assert_free(&self, what: &str) {
        let ran = &self.ran;
        let [rim, vertices] =
            ["at_rim", "vertices"].map(|name| ran.count(&format!("depth.{name}")));
        let tilt = ran.number("even.largest_tilt").to_degrees();
        let least = ran.number("even.least_cosine");
        let errors = ["max_error", "mean_error"].map(|name| ran.number(&format!("even.{name}")));
        println!(
            "{what}: offset {:.6} ({} edges of {:.6}), along normals {} crossings, freed: mean \
             error {:.1e}, maximum {:.1e}; price: {rim} of {vertices} vertices measured to the \
             rim, largest tilt {tilt:.2} degrees, smallest direction . face normal {least:.4}",
            self.offset,
            self.offset / self.edge,
            self.edge,
            self.plain(),
            errors[1],
            errors[0]
        );
        for result in [
            "check.pairs",
            "check.contacts",
            "even.unsolved",
            "even.inverted",
        ] {
            assert_eq!(ran.count(result), 0, "{what}: {result}");
        }
        assert!(errors[0] <= 1e-3 && errors[1] <= 1e-4, "{what}: {errors:?}");
        assert!(
            ran.number("depth.max_error") <= 1e-3 * self.offset.abs(),
            "{what}"
        );
        assert!(least > 0.0 && ran.warnings().is_empty(), "{what}: {least}");
    }
}

/// The mean length of all edges of all faces, inner edges twice.
fn mean_edge(mesh: &Mesh) -> f64 {
    let at = |vertex: u32| mesh.positions()[vertex as usize];
    let (mut sum, mut count) = (0.0, 0.0);
    for face in mesh.topology().faces() {
        for (k, &vertex) in face.iter().enumerate() {
            sum += at(vertex).distance(at(face[(k + 1) % face.len()]));
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn yas_island_one_edge_down_needs_no_smoothing() {
    let none = [("passes", "0")];
    let Some(roof) = Roof::offset("hedra_YasIsland", -1.0, &none) else {
        return;
    };
    assert_eq!(roof.plain(), 0);
    roof.assert_free("Yas Island at -1");
    let by_area = [("passes", "0"), ("weights", "Area")];
    let by_area = Roof::offset("hedra_YasIsland", -1.0, &by_area).expect("as above");
    assert_eq!(by_area.plain(), 4);
}

#[test]
fn yas_island_two_edges_down_is_freed_by_smoothing() {
    for (passes, diffusion) in [
        ("120", "1"),
        ("200", "1"),
        ("300", "1"),
        ("240", "0.5"),
        ("400", "0.5"),
    ] {
        let settings = [("passes", passes), ("diffusion", diffusion)];
        let Some(roof) = Roof::offset("hedra_YasIsland", -2.0, &settings) else {
            return;
        };
        assert_eq!(roof.plain(), 239);
        roof.assert_free(&format!("Yas Island at -2, {passes} passes of {diffusion}"));
    }
    let by_area = [("weights", "Area")];
    let by_area = Roof::offset("hedra_YasIsland", -2.0, &by_area).expect("as above");
    assert_eq!(by_area.plain(), 258);
}

#[test]
fn a_roof_of_six_arms_two_edges_up_is_freed_by_smoothing() {
    for passes in ["60", "100"] {
        let Some(roof) = Roof::offset("hedra_six", 2.0, &[("passes", passes)]) else {
            return;
        };
        assert!(roof.plain() > 0);
        roof.assert_free(&format!("six arms at +2, {passes} passes"));
    }
}
