//! Lengths of directions that keep a thickness (§3.2).

use std::sync::Arc;

use tessgraph_geometry::compensate::{self, Compensate, CompensateOptions, SideReport};
use tessgraph_geometry::diffuse;
use tessgraph_geometry::surface::Border;
use tessgraph_geometry::{Amount, Directions, Field, Mesh, list_ids};
use tessgraph_graph::node::Preview;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs, Outputs};

/// Lengthens directions so that components keep their thickness (paper §3.2).
///
/// Moved along anything but the normal, a component gets thinner; where the
/// surface curves, the closest part of it is not where the direction came from.
/// Local compensation lengthens by the angle to the normal. Global compensation
/// finds the length at which the point lies `thickness` away from the whole
/// surface, outward and inward apart. A component drawn `thickness` high then ends
/// exactly there.
///
/// A vertex may have no solution: two walls closer than twice the thickness leave
/// no room. It is brought as far as possible and named in a warning.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": ParametricSurface(x: "4 * u", y: "4 * v", z: "0.5 * sin(u * tau)", cells: [16, 8]),
///     "smooth": SmoothNormals(mesh: "base", iterations: 30),
///     "out": CompensateThickness(mesh: "base", directions: "smooth", thickness: 0.2),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct CompensateThickness {
    /// Base surface.
    mesh: Arc<Mesh>,
    /// Directions of its vertices, not compensated yet.
    directions: Arc<Directions>,
    /// Wanted thickness on the outer side, a number or one per vertex.
    #[input(min = 0, unit = length)]
    thickness: Amount,
    /// Wanted thickness on the inner side; left out, the same.
    #[input(min = 0, unit = length)]
    inward: Option<Amount>,
    /// How lengths are found.
    #[input(default = Global)]
    mode: Mode,
    /// Largest error that counts as none, as a share of the thickness.
    #[input(default = 1e-4, above = 0, max = 0.1, only_with(mode = Global))]
    tolerance: f64,
    /// How distances beyond open borders are measured.
    #[input(default = Extend)]
    border: BorderChoice,
    /// Longest way, in thicknesses; directions nearer to the tangent are limited.
    #[input(default = 20.0, min = 1, max = 1000)]
    limit: f64,
}

/// How lengths are found.
#[derive(Clone, Copy, Choice)]
#[choice(into = Compensate)]
pub(crate) enum Mode {
    /// By the angle to the normal alone: exact while the closest place lies in a
    /// face with that normal (figure 8A).
    Local,
    /// By the distance to the whole surface (figure 8B).
    Global,
}

/// How distances beyond open borders are measured.
#[derive(Clone, Copy, Choice)]
#[choice(into = Border)]
pub(crate) enum BorderChoice {
    /// To the mesh as it is.
    Clip,
    /// To the border faces continued outward, where the closest place is on a border.
    Extend,
}

/// Compensated directions and how well they keep the thickness.
#[derive(Outputs)]
pub(crate) struct Compensated {
    /// The compensated directions.
    directions: Arc<Directions>,
    /// Largest error of both sides, as a share of the thickness.
    max_error: f64,
    /// Mean error of both sides, the worse one.
    mean_error: f64,
    /// Root mean square error of both sides, the worse one.
    rms_error: f64,
    /// Vertices at their thickness, on both sides together.
    solved: usize,
    /// Vertices at their thickness from the continued border.
    extended: usize,
    /// Vertices at their thickness from the mesh, but not from its continued border.
    border_clipped: usize,
    /// Vertices that could not reach their thickness.
    unsolved: usize,
    /// Vertices at their thickness on the outer side.
    outward_solved: usize,
    /// Those at it from the continued border.
    outward_extended: usize,
    /// Those at it from the mesh, but not from its continued border.
    outward_border_clipped: usize,
    /// Those that could not reach it.
    outward_unsolved: usize,
    /// Vertices at their thickness on the inner side.
    inward_solved: usize,
    /// Those at it from the continued border.
    inward_extended: usize,
    /// Those at it from the mesh, but not from its continued border.
    inward_border_clipped: usize,
    /// Those that could not reach it.
    inward_unsolved: usize,
    /// What became of each vertex on the outer side: 0 solved, 1 from the continued
    /// border, 2 from the mesh but not from its continued border, 3 unsolved, -1 for a
    /// vertex of no face.
    outward_status: Arc<Field>,
    /// The same on the inner side.
    inward_status: Arc<Field>,
    /// Distances evaluated.
    evaluations: i64,
    /// Widest angle between a direction and the normal.
    #[output(unit = angle)]
    largest_tilt: f64,
    /// Smallest cosine of a direction to the normal of a face at its vertex; at
    /// 0 and below the thickness is inverted there.
    least_cosine: f64,
    /// Faces that a direction turns against, or lies in: inverted thickness.
    inverted: usize,
}

impl Node for CompensateThickness {
    type Output = Compensated;
    const VERSION: u32 = 3;
    // Lengths are per unit of height: a greater thickness finds much the same ones.
    const PREVIEW: Preview = Preview {
        slight: &["thickness"],
        ..Preview::NONE
    };

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let options = CompensateOptions {
            mode: self.mode.into(),
            tolerance: self.tolerance,
            limit: self.limit,
            border: self.border.into(),
        };
        let inward = self.inward.as_ref().unwrap_or(&self.thickness);
        let found = compensate::compensate(
            &self.mesh,
            &self.directions,
            &self.thickness,
            inward,
            &options,
            cx.monitor(),
        )?;
        let inverted = diffuse::inverted(&self.mesh, &self.directions, cx.monitor())?;
        warn(cx, "outward", &found.outward);
        warn(cx, "inward", &found.inward);
        let sides = [&found.outward, &found.inward];
        let worse = |of: fn(&SideReport) -> f64| of(sides[0]).max(of(sides[1]));
        let both = |of: fn(&SideReport) -> usize| of(sides[0]) + of(sides[1]);
        Ok(Compensated {
            max_error: worse(|side| side.errors.max),
            mean_error: worse(|side| side.errors.mean),
            rms_error: worse(|side| side.errors.rms),
            solved: both(|side| side.solved),
            extended: both(|side| side.extended),
            border_clipped: both(|side| side.border_clipped.len()),
            unsolved: both(|side| side.unsolved.len()),
            outward_solved: found.outward.solved,
            outward_extended: found.outward.extended,
            outward_border_clipped: found.outward.border_clipped.len(),
            outward_unsolved: found.outward.unsolved.len(),
            inward_solved: found.inward.solved,
            inward_extended: found.inward.extended,
            inward_border_clipped: found.inward.border_clipped.len(),
            inward_unsolved: found.inward.unsolved.len(),
            outward_status: status(&found.outward, &self.mesh)?,
            inward_status: status(&found.inward, &self.mesh)?,
            evaluations: sides
                .iter()
                .map(|side| side.evaluations.cast_signed())
                .sum(),
            largest_tilt: found.largest_tilt,
            least_cosine: inverted.least_cosine,
            inverted: inverted.faces.len(),
            directions: Arc::new(found.directions),
        })
    }
}

fn status(side: &SideReport, mesh: &Mesh) -> Result<Arc<Field>, NodeError> {
    let field = SideReport::status_field(&[side], mesh.vertex_count())?;
    Ok(Arc::new(field))
}

/// Names the vertices of one side that need a look.
fn warn(cx: &EvalCx<'_>, side: &str, report: &SideReport) {
    if let Some(first) = report.unsolved.first() {
        let ids: Vec<u32> = report
            .unsolved
            .iter()
            .map(|unsolved| unsolved.vertex)
            .collect();
        cx.warn(format!(
            "{side}, no solution at {} of {} vertices: {} (3 in `{side}_status`); \
             vertex {} reaches {} of {}{}",
            ids.len(),
            total(report),
            list_ids(&ids),
            first.vertex,
            cx.length(first.reached),
            cx.length(first.wanted),
            if 10 * ids.len() > total(report) {
                NO_ROOM
            } else {
                ""
            },
        ));
    }
    if !report.border_clipped.is_empty() {
        let ids = list_ids(&report.border_clipped);
        cx.warn(format!(
            "{side}, the border could not be continued at vertices {ids}"
        ));
    }
    if !report.clamped.is_empty() {
        let ids = list_ids(&report.clamped);
        cx.warn(format!(
            "{side}, directions at vertices {ids} are nearly tangential: limited"
        ));
    }
    if !report.left_faces.is_empty() {
        cx.warn(format!(
            "{side}, {} of {} vertices are closest to faces not round them ({}): \
             local compensation may be wrong there; use `mode: Global`",
            report.left_faces.len(),
            total(report),
            list_ids(&report.left_faces),
        ));
    }
}

/// Said where over a tenth of the vertices has no solution.
const NO_ROOM: &str = "; along these directions the surface has no room for this thickness: \
                       lead them elsewhere with TargetDirections, or make it thinner";

fn total(report: &SideReport) -> usize {
    report.solved + report.extended + report.border_clipped.len() + report.unsolved.len()
}
