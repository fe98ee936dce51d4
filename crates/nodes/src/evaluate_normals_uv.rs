//! Where each point of a component reads its direction.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use tessgraph_geometry::Fit;
use tessgraph_geometry::{Amount, Mesh, list_ids};
use tessgraph_geometry::{NormalUvAxes, NormalUvSource, Part, evaluate_normals_uv};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

use crate::fit_component::FitChoice;

/// Separates where a component's points sit from where their directions are read.
///
/// A point at (u, v) usually moves along the direction at (u, v). This node
/// gives it another place (u', v') for the direction (paper §3.3): a portion
/// whose points share one (u', v') is moved by parallel translation and keeps its
/// shape (figure 11). The result is the component with the vertex attribute
/// `normal_uv`, which `ArrayComponents` uses.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "post": Cuboid(size: [1, 1, 1], cells: [2, 2, 1]),
///     "out": EvaluateNormalsUV(component: "post", source: Collapse),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct EvaluateNormalsUV {
    /// The component.
    component: Arc<Mesh>,
    /// Where (u', v') comes from.
    #[input(default = UvLayer)]
    source: Source,
    /// Name of the UV layer; left out, the first.
    #[input(only_with(source = UvLayer))]
    layer: Option<String>,
    /// Another mesh with the same faces that has the UV layer.
    #[input(only_with(source = UvLayer))]
    layer_of: Option<Arc<Mesh>>,
    /// Group, object or material that is collapsed; left out, everything.
    #[input(only_with(source = Collapse))]
    group: Option<String>,
    /// Lowest corner of a box that is collapsed, in the component's coordinates.
    #[input(unit = length, only_with(source = Collapse))]
    box_low: Option<DVec3>,
    /// Highest corner of that box.
    #[input(unit = length, only_with(source = Collapse))]
    box_high: Option<DVec3>,
    /// The place (u, v) to collapse to or scale about; left out, the part's
    /// centroid, or the middle of the square for `Scale`.
    #[input(only_with(source = Collapse | Scale))]
    point: Option<[f64; 2]>,
    /// 0 gives one direction to all, 1 leaves (u, v) as they are.
    #[input(default = 0.0, only_with(source = Scale))]
    factor: Amount,
    /// Which of u' and v' are set.
    #[input(default = Both)]
    axes: Axes,
    /// How x and y of the component become (u, v), as in `ArrayComponents`.
    #[input(default = Unit)]
    fit: FitChoice,
    /// Name of the reference cell.
    #[input(only_with(fit = Cell))]
    cell: Option<String>,
}

/// Where (u', v') comes from.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum Source {
    /// A UV layer of the component or of another mesh with the same faces.
    UvLayer,
    /// One place for a part of the component.
    Collapse,
    /// (u, v) drawn towards a point by a factor.
    Scale,
}

/// Which of u' and v' may differ from u and v.
#[derive(Clone, Copy, Choice)]
#[choice(into = NormalUvAxes)]
pub(crate) enum Axes {
    /// Both.
    Both,
    /// u' only; v' stays v, as the paper's add-on does.
    U,
}

impl Node for EvaluateNormalsUV {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let part = self.part()?;
        let layer = self.layer.as_deref();
        let source = match (self.source, &self.layer_of) {
            (Source::UvLayer, Some(mesh)) => NormalUvSource::UvLayerOf { mesh, layer },
            (Source::UvLayer, None) => NormalUvSource::UvLayer { layer },
            (Source::Collapse, _) => NormalUvSource::Collapse {
                part,
                to: self.point.map(DVec2::from),
            },
            (Source::Scale, _) => {
                let about = DVec2::from(self.point.unwrap_or([0.5, 0.5]));
                NormalUvSource::Scale {
                    about,
                    factor: &self.factor,
                }
            }
        };
        let fit: Fit = self.fit.with_cell(self.cell.clone())?;
        let axes = self.axes.into();
        let result = evaluate_normals_uv(&self.component, &source, axes, &fit)?;
        if !result.seams.is_empty() {
            let ids = list_ids(&result.seams);
            cx.warn(format!("corners disagree about (u', v') at vertices {ids}: a UV seam; the last corner counts"));
        }
        if !result.outside.is_empty() {
            let ids = list_ids(&result.outside);
            cx.warn(format!("(u', v') lies outside the unit square at vertices {ids}: directions are extrapolated"));
        }
        Ok(Arc::new(result.mesh))
    }
}

impl EvaluateNormalsUV {
    /// The part of the component that is collapsed.
    fn part(&self) -> Result<Part<'_>, NodeError> {
        match (self.group.as_deref(), self.box_low, self.box_high) {
            (None, None, None) => Ok(Part::All),
            (Some(name), None, None) => Ok(Part::Named(name)),
            (None, Some(low), Some(high)) => Ok(Part::Box { low, high }),
            _ => Err(NodeError::new(
                "give either `group`, or both `box_low` and `box_high`",
            )),
        }
    }
}
