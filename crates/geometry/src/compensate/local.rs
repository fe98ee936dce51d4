//! Local compensation: length by the angle to the normal (§3.2, figure 8A).

use super::solver::{Side, Solution, Solver, Start, Status};

/// The local answer at one vertex.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Found {
    pub(super) solution: Solution,
    /// The direction is so near the tangent that the length was limited.
    pub(super) clamped: bool,
    /// The closest place P'' lies outside the faces round the vertex.
    pub(super) left_faces: bool,
}

pub(super) struct Local<'a> {
    pub(super) solver: &'a Solver<'a>,
}

impl Local<'_> {
    /// d = t / cos at `vertex`, at most the solver's limit, judged by the
    /// solver's border rule. Searches from `leaf`, and leaves there where it ended.
    pub(super) fn solve(
        &self,
        start: &Start,
        vertex: usize,
        wanted: f64,
        side: Side,
        leaf: &mut u32,
    ) -> Found {
        if wanted <= 0.0 {
            return Found::default();
        }
        let solver = self.solver;
        let cosine = start.direction.dot(start.normal);
        let clamped = cosine < 1.0 / solver.limit;
        let length = wanted / cosine.max(1.0 / solver.limit);
        let away = match side {
            Side::Outward => start.direction,
            Side::Inward => -start.direction,
        };
        let point = start.origin + away * length;
        let measured = solver.surface.measure(point, solver.border, *leaf);
        let solved = (measured.distance - wanted).abs() <= solver.slack(wanted);
        let closest = measured.closest;
        *leaf = closest.leaf;
        let topology = solver.surface.topology();
        let own_faces = topology.adjacency().vertex_corners(vertex).iter();
        let own_faces =
            own_faces.map(|&corner| topology.adjacency().corner_faces()[corner as usize]);
        // Where an own face is as close as any other, P'' has not left them.
        let own = own_faces
            .flat_map(|face| solver.surface.face_triangles(face))
            .map(|k| (solver.surface.triangle(k).closest(point).point - point).length())
            .fold(f64::INFINITY, f64::min);
        Found {
            solution: Solution {
                length,
                reached: measured.distance,
                status: if solved {
                    Status::Solved
                } else {
                    Status::Unsolved
                },
                evaluations: 1,
            },
            clamped,
            left_faces: closest.distance < own * (1.0 - 1e-9),
        }
    }
}
