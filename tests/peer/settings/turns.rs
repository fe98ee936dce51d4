//! Quarter turns of triangles, which the add-on takes as quads with a side of no
//! length: of their four senses only three are corners of the triangle, so each
//! takes the component turned in one of four ways.

use super::Settings;

/// Corners of a triangle as those of a quad, in the order (0,0) (0,1) (1,1) (1,0).
const AROUND: [&str; 4] = ["c0", "c2", "c2", "c1"];

/// Node `quarters`: for each triangle of `base` how many quarters the component
/// turns, the best by `score` plus `shift`. `value` is a formula over corners,
/// `score` the sign of each corner in the order of [`AROUND`], before it is turned.
pub(super) fn quarters(settings: &mut Settings, value: &str, score: [f64; 4], shift: f64) {
    let mut mesh = "base".to_owned();
    for corner in 0..3 {
        // A face's value of an attribute on corners is their mean.
        let of_corner = format!(
            "SetAttribute(mesh: \"{mesh}\", name: \"c{corner}\", on: Corners, \
             value: \"if(index % 3 == {corner}, 3 * ({value}), 0)\")"
        );
        mesh = format!("corner_{corner}");
        settings.node(&mesh, &of_corner);
    }
    let scores = [0, 1, 2, 3].map(|turn| {
        let term = |k: usize| format!("{:?} * {}", score[k], AROUND[(k + turn) % 4]);
        format!("({} + {} + {} + {})", term(0), term(1), term(2), term(3))
    });
    for (turn, score) in scores.iter().enumerate() {
        let field = format!(
            "SetAttribute(mesh: \"{mesh}\", name: \"s{turn}\", on: Faces, value: \"{score}\")"
        );
        mesh = format!("score_{turn}");
        settings.node(&mesh, &field);
    }
    // Of equal ones the fewest turns.
    let best = "if(s0 >= max(s1, s2, s3), 0, if(s1 >= max(s2, s3), 1, if(s2 >= s3, 2, 3)))";
    let quarters =
        format!("EvaluateField(mesh: \"{mesh}\", on: Faces, value: \"({best} + {shift:?}) % 4\")");
    settings.node("quarters", &quarters);
}
