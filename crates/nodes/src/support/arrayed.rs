//! The results of `ArrayComponents`.

use std::sync::Arc;

use tessgraph_geometry::compensate::SideReport;
use tessgraph_geometry::{
    Arrayed, Domain, Field, GeometryError, Mesh, PerVertexReport, Quantity, list_ids,
};
use tessgraph_graph::EvalCx;
use tessgraph_macros::Outputs;

/// The array and what became of its joints.
#[derive(Outputs)]
pub(crate) struct ArrayedComponents {
    /// The components on their faces.
    mesh: Arc<Mesh>,
    /// How many components were placed.
    placed: usize,
    /// How many vertices on the sides of components found no partner.
    unmatched: usize,
    /// Coarse faces that took no component because they have not four sides.
    skipped_parents: usize,
    /// Vertices without a solution on both sides together; this and all below are
    /// 0 without `compensate: PerVertex`, and leave out vertices at height 0.
    unsolved: usize,
    /// What became of each vertex: 0 at its height, 1 from the continued border, 2 from
    /// the base but not from its continued border, 3 unsolved, -1 at height 0. Empty
    /// without `compensate: PerVertex`.
    status: Arc<Field>,
    /// Vertices above the base at their height from it.
    outward_solved: usize,
    /// Vertices above the base at their height from the continued border.
    outward_extended: usize,
    /// Vertices above the base at their height from it, not from its continued border.
    outward_border_clipped: usize,
    /// Vertices above the base that could not reach their height.
    outward_unsolved: usize,
    /// Largest error of solved and extended vertices above the base, as a share
    /// of their heights.
    outward_max_error: f64,
    /// Root mean square error of solved and extended vertices above the base.
    outward_rms_error: f64,
    /// Vertices below the base at their height from it.
    inward_solved: usize,
    /// Vertices below the base at their height from the continued border.
    inward_extended: usize,
    /// Vertices below the base at their height from it, not from its continued border.
    inward_border_clipped: usize,
    /// Vertices below the base that could not reach their height.
    inward_unsolved: usize,
    /// Largest error of solved and extended vertices below the base, as a share
    /// of their heights.
    inward_max_error: f64,
    /// Root mean square error of solved and extended vertices below the base.
    inward_rms_error: f64,
    /// Distances evaluated in all.
    evaluations: i64,
    /// Distances evaluated for one vertex at most.
    most_evaluations: u32,
}

impl ArrayedComponents {
    /// The results of an array; `report` where heights were compensated.
    pub(crate) fn new(
        array: Arrayed,
        report: Option<&PerVertexReport>,
    ) -> Result<Self, GeometryError> {
        let status = match report {
            Some(report) => {
                let sides = [&report.outward, &report.inward];
                SideReport::status_field(&sides, array.mesh.vertex_count())?
            }
            None => Field::new(Domain::Vertex, Quantity::Number, Vec::new())?,
        };
        let nothing = PerVertexReport::default();
        let PerVertexReport {
            outward, inward, ..
        } = report.unwrap_or(&nothing);
        Ok(Self {
            placed: array.placed,
            unmatched: array.join.as_ref().map_or(0, |join| join.open),
            mesh: Arc::new(array.mesh),
            skipped_parents: array.skipped_parents,
            unsolved: outward.unsolved.len() + inward.unsolved.len(),
            status: Arc::new(status),
            outward_solved: outward.solved,
            outward_extended: outward.extended,
            outward_border_clipped: outward.border_clipped.len(),
            outward_unsolved: outward.unsolved.len(),
            outward_max_error: outward.solved_errors.max,
            outward_rms_error: outward.solved_errors.rms,
            inward_solved: inward.solved,
            inward_extended: inward.extended,
            inward_border_clipped: inward.border_clipped.len(),
            inward_unsolved: inward.unsolved.len(),
            inward_max_error: inward.solved_errors.max,
            inward_rms_error: inward.solved_errors.rms,
            evaluations: (outward.evaluations + inward.evaluations).cast_signed(),
            most_evaluations: outward.most_evaluations.max(inward.most_evaluations),
        })
    }
}

/// Names the vertices that are not at their heights.
pub(crate) fn warn_of_heights(report: &PerVertexReport, cx: &EvalCx<'_>) {
    warn(cx, "above", &report.outward, &report.outward_faces);
    warn(cx, "below", &report.inward, &report.inward_faces);
}

/// Names those of one side.
fn warn(cx: &EvalCx<'_>, side: &str, report: &SideReport, faces: &[u32]) {
    if let Some(first) = report.unsolved.first() {
        let ids: Vec<u32> = report.unsolved.iter().map(|one| one.vertex).collect();
        cx.warn(format!(
            "{side} the base, no solution at {} of {} vertices: {} (3 in `status`); they are on \
             base faces {}; vertex {} reaches {} of {}",
            ids.len(),
            report.vertices(),
            list_ids(&ids),
            list_ids(faces),
            first.vertex,
            cx.length(first.reached),
            cx.length(first.wanted),
        ));
    }
    if !report.border_clipped.is_empty() {
        cx.warn(format!(
            "{side} the base, its border could not be continued at vertices {}",
            list_ids(&report.border_clipped)
        ));
    }
}
