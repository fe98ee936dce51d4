//! Triangles turned as the add-on turns them: as quads with a side of no length.

use tessgraph_geometry::Mesh;
use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::normals::{NormalWeights, vertex_normals};

use super::case::Verdict;
use super::folders::{folder, recorded, verdict};
use crate::support::{self, workspace};

const CASE: &str = "12_fan_hex";

/// The base in the domains that `node` makes.
fn domains(node: &str) -> std::sync::Arc<Mesh> {
    let body = format!(
        "\"read\": ReadMesh(path: \"base.obj\"), \n\"base\": {node}(mesh: \"read\", order: Appended)"
    );
    support::Ran::nodes(&body, &[("base.obj", &recorded(CASE, "base.obj"))]).mesh("base")
}

/// The add-on's mapping: corners (00, 10, 11, 01) rolled by the turns of each
/// triangle, positions and normals interpolated.
fn reference(base: &Mesh, turns: impl Fn([DVec3; 3]) -> usize) -> String {
    let component = workspace().join("tests/peer/cases").join(CASE);
    let component = support::read_obj(&component.join("component.obj")).expect("a component");
    let monitor = tessgraph_geometry::Unmonitored;
    let normals = vertex_normals(base, NormalWeights::Angle, true, &monitor).expect("normals");
    let places = component.positions();
    let low = places.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let high = places.iter().fold(-DVec3::INFINITY, |high, p| high.max(*p));
    let (size, count) = (high - low, places.len());
    let mut text = String::new();
    for face in base.topology().faces() {
        let [a, b, c] = [face[0], face[1], face[2]].map(|vertex| vertex as usize);
        let mut corners = [a, b, c, c];
        corners.rotate_right(turns([a, b, c].map(|vertex| base.positions()[vertex])));
        let at = |values: &[DVec3], u: f64, v: f64| {
            let [p, q, r, s] = corners.map(|corner| values[corner]);
            p.lerp(q, u).lerp(s.lerp(r, u), v)
        };
        for p in places.iter() {
            let (u, v) = ((p.x - low.x) / size.x, (p.y - low.y) / size.y);
            let x = at(base.positions(), u, v) + p.z * at(&normals, u, v);
            text += &format!("v {:?} {:?} {:?}\n", x.x, x.y, x.z);
        }
    }
    for piece in 0..base.face_count() {
        for face in component.topology().faces() {
            let corner = |&vertex: &u32| (piece * count + vertex as usize + 1).to_string();
            let corners: Vec<String> = face.iter().map(corner).collect();
            text += &format!("f {}\n", corners.join(" "));
        }
    }
    text
}

fn of(settings: &str, files: &[(&str, &str)]) -> Verdict {
    let settings = format!("{{\"settings\": {{\"scale_mode\": \"CONSTANT\", {settings}}}}}");
    let mut all = vec![("settings.json", settings.as_str())];
    all.extend_from_slice(files);
    verdict(folder(CASE, &all).path())
}

#[test]
fn triangles_turn_by_a_number() {
    for turns in 1..4 {
        let theirs = reference(&domains("FanFaces"), |_| turns);
        let settings = format!("\"fill_mode\": \"FAN\", \"rotation_shift\": {turns}");
        let verdict = of(&settings, &[("tissue.obj", &theirs)]);
        assert!(matches!(verdict, Verdict::Reproduced), "{turns}: {verdict}");
    }
}

/// Linear in the place, so that it has one value at a fan's centre, however that
/// is made; without ties.
fn weight(p: DVec3) -> f64 {
    0.4 + 0.03 * p.x + 0.0171 * p.y
}

/// The turns with the largest sum of score times value over the corners
/// (0,0) (0,1) (1,1) (1,0), the fewest of equals.
fn best(score: [f64; 4], value: impl Fn(DVec3) -> f64) -> impl Fn([DVec3; 3]) -> usize {
    move |[a, b, c]| {
        let around = [a, c, c, b].map(&value);
        let gain = |turn: usize| {
            (0..4)
                .map(|k| score[k] * around[(k + turn) % 4])
                .sum::<f64>()
        };
        (1..4).fold(0, |best, turn| {
            if gain(turn) > gain(best) + 1e-9 {
                turn
            } else {
                best
            }
        })
    }
}

#[test]
fn triangles_turn_uphill_on_a_group() {
    let vertices = support::read_obj(
        &workspace()
            .join("tests/peer/cases")
            .join(CASE)
            .join("base.obj"),
    )
    .expect("a base");
    let weights: String = vertices
        .positions()
        .iter()
        .map(|p| format!("{:?}\n", weight(*p)))
        .collect();
    let group = "\"rotation_mode\": \"WEIGHT\", \"vertex_group_rotation\": \"W\"";
    let (edges, diagonals) = ([-1.0, 1.0, 1.0, -1.0], [-1.0, 0.0, 1.0, 0.0]);
    for (fill, node) in [("FAN", "FanFaces"), ("TRI", "TriangulateFaces")] {
        let base = domains(node);
        let mut seen = [false; 4];
        for (more, score, sign, shift) in [
            ("", edges, 1.0, 0),
            (", \"invert_vertex_group_rotation\": true", edges, -1.0, 0),
            (", \"rotation_direction\": \"DIAG\"", diagonals, 1.0, 0),
            (", \"rotation_shift\": 3", edges, 1.0, 3),
        ] {
            let best = best(score, |p| sign * weight(p));
            let turns = |corners: [DVec3; 3]| (best(corners) + shift) % 4;
            for face in base.topology().faces() {
                let corners = [face[0], face[1], face[2]];
                seen[turns(corners.map(|v| base.positions()[v as usize]))] = true;
            }
            let theirs = reference(&base, turns);
            let settings = format!("\"fill_mode\": \"{fill}\", {group}{more}");
            let files = [("tissue.obj", theirs.as_str()), ("weights.csv", &weights)];
            let verdict = of(&settings, &files);
            assert!(
                matches!(verdict, Verdict::Reproduced),
                "{fill}{more}: {verdict}"
            );
        }
        assert_eq!(seen, [true; 4], "{fill}: every turn occurs");
    }
}

#[test]
fn triangles_turn_along_a_layer() {
    let base = recorded(CASE, "base.obj");
    let mut with_uv = String::new();
    for line in base.lines() {
        if let Some(place) = line.strip_prefix("v ") {
            let xy: Vec<&str> = place.split_whitespace().take(2).collect();
            with_uv += &format!("{line}\nvt {}\n", xy.join(" "));
        } else if let Some(face) = line.strip_prefix("f ") {
            let index = |corner: &str| corner.split('/').next().unwrap_or("").to_owned();
            let corner = |corner: &str| format!(" {0}/{0}", index(corner));
            let corners: String = face.split_whitespace().map(corner).collect();
            with_uv += &format!("f{corners}\n");
        }
    }
    let turns = best([-1.0, -1.0, 1.0, 1.0], |p| p.x);
    let theirs = reference(&domains("TriangulateFaces"), turns);
    let files = [("tissue.obj", theirs.as_str()), ("base.obj", &with_uv)];
    let settings = "\"fill_mode\": \"TRI\", \"rotation_mode\": \"UV\"";
    let verdict = of(settings, &files);
    assert!(matches!(verdict, Verdict::Reproduced), "{verdict}");
}
