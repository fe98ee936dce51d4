//! How well a thickness is kept.

use super::local::Found;
use super::solver::{NOT_MOVED, Solution, Status};
use crate::{Domain, Field, GeometryError, Quantity};

/// Deviations |d' - t| / t from the wanted thickness.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// The largest.
    pub max: f64,
    /// The mean.
    pub mean: f64,
    /// The root of the mean square.
    pub rms: f64,
}

impl Errors {
    /// Adds up in the order given; zero for no values.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let (mut count, mut max, mut sum, mut squares) = (0u32, 0.0f64, 0.0, 0.0);
        for value in values {
            count += 1;
            max = max.max(value);
            sum += value;
            squares += value * value;
        }
        let n = f64::from(count.max(1));
        Self {
            max,
            mean: sum / n,
            rms: f64::sqrt(squares / n),
        }
    }
}

/// A vertex that cannot keep its thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unsolved {
    /// Its index.
    pub vertex: u32,
    /// The thickness wanted, in metres.
    pub wanted: f64,
    /// The distance reached, in metres.
    pub reached: f64,
}

/// What compensation reached on one side of the base.
///
/// Vertices of faces are counted, in exactly one of `solved`, `extended`,
/// `border_clipped` and `unsolved`; those of thickness 0 are solved.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SideReport {
    /// Vertices at their thickness from the mesh itself.
    pub solved: usize,
    /// Vertices at their thickness from the extended border.
    pub extended: usize,
    /// Vertices at their thickness from the mesh, but not from the extended
    /// border, ascending.
    pub border_clipped: Vec<u32>,
    /// Vertices that are not at their thickness, ascending.
    pub unsolved: Vec<Unsolved>,
    /// Each vertex with its status, ascending.
    pub statuses: Vec<(u32, Status)>,
    /// Vertices whose direction is so near the tangent that its length was
    /// limited, ascending; `Local` only.
    pub clamped: Vec<u32>,
    /// Vertices whose closest place P'' lies outside the faces round them,
    /// ascending; `Local` only. Only there can its answer be wrong, apart from
    /// normals that differ between those faces (figure 8A).
    pub left_faces: Vec<u32>,
    /// Errors of all vertices, each by the rule it was judged with.
    pub errors: Errors,
    /// Errors of the solved and extended vertices.
    pub solved_errors: Errors,
    /// Distances evaluated in all.
    pub evaluations: u64,
    /// Distances evaluated for one vertex at most.
    pub most_evaluations: u32,
}

impl SideReport {
    /// Counts up solutions of vertices, each with the thickness wanted.
    pub(crate) fn of_solutions(found: impl Iterator<Item = (u32, f64, Solution)>) -> Self {
        Self::gather(found.map(|(vertex, wanted, solution)| {
            let found = Found {
                solution,
                ..Found::default()
            };
            (vertex, wanted, found)
        }))
    }

    /// Statuses of `count` vertices by [`Status::number`], [`NOT_MOVED`] for those
    /// that neither side has; no vertex may be on both.
    ///
    /// # Errors
    /// None for vertices below `count`.
    pub fn status_field(sides: &[&Self], count: usize) -> Result<Field, GeometryError> {
        let mut values = vec![NOT_MOVED; count];
        for &(vertex, status) in sides.iter().flat_map(|side| &side.statuses) {
            values[vertex as usize] = status.number();
        }
        Field::new(Domain::Vertex, Quantity::Number, values)
    }

    /// How many vertices there are on this side.
    pub fn vertices(&self) -> usize {
        self.solved + self.extended + self.border_clipped.len() + self.unsolved.len()
    }

    /// Counts up vertices, each with the thickness wanted and what was found.
    pub(super) fn gather(found: impl Iterator<Item = (u32, f64, Found)>) -> Self {
        let mut report = Self::default();
        let (mut all, mut kept) = (Vec::new(), Vec::new());
        for (vertex, wanted, found) in found {
            let solution = found.solution;
            let error = if wanted > 0.0 {
                (solution.reached - wanted).abs() / wanted
            } else {
                0.0
            };
            all.push(error);
            report.statuses.push((vertex, solution.status));
            match solution.status {
                Status::Solved => report.solved += 1,
                Status::Extended => report.extended += 1,
                Status::BorderClipped => report.border_clipped.push(vertex),
                Status::Unsolved => report.unsolved.push(Unsolved {
                    vertex,
                    wanted,
                    reached: solution.reached,
                }),
            }
            if matches!(solution.status, Status::Solved | Status::Extended) {
                kept.push(error);
            }
            if found.clamped {
                report.clamped.push(vertex);
            }
            if found.left_faces {
                report.left_faces.push(vertex);
            }
            report.evaluations += u64::from(solution.evaluations);
            report.most_evaluations = report.most_evaluations.max(solution.evaluations);
        }
        report.errors = Errors::of(all.into_iter());
        report.solved_errors = Errors::of(kept.into_iter());
        report
    }
}
