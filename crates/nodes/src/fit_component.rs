//! A component brought into the unit square.

use std::sync::Arc;

use tessgraph_geometry::{Anchor, Beyond, Fit, FitOptions, box_outliers, component_frame};
use tessgraph_geometry::{Mesh, list_ids};
use tessgraph_graph::node::Preview;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Brings a component into the unit square that `ArrayComponents` maps to quads.
///
/// x and y become u and v, z becomes the height above the surface. `height` sets
/// the component's depth, `anchor` which level of it lies in the surface. What
/// reaches beyond the square stays, is cut off, or comes in again at the other
/// side, per axis; the edges of cuts have 1 in the edge attribute `seam`, by which
/// `DissolveEdges` heals them in the array. Use the result with
/// `ArrayComponents(fit: Unit)`.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "brick": Cuboid(size: [3, 2, 1]),
///     "out": FitComponent(component: "brick", height: 0.12, anchor: Above),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct FitComponent {
    /// The component.
    component: Arc<Mesh>,
    /// What becomes the unit square.
    #[input(default = Bounds)]
    fit: FitChoice,
    /// Name of the group, object or material that is the reference cell.
    #[input(only_with(fit = Cell))]
    cell: Option<String>,
    /// Depth of the result; left out, heights stay as they are.
    #[input(above = 0, unit = length)]
    height: Option<f64>,
    /// Which level of the component lies in the surface.
    #[input(default = Origin)]
    anchor: AnchorChoice,
    /// What happens beyond the square along x.
    #[input(default = Extend)]
    x: BeyondChoice,
    /// What happens beyond the square along y.
    #[input(default = Extend)]
    y: BeyondChoice,
}

/// What becomes the unit square.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum FitChoice {
    /// The component's XY box.
    Bounds,
    /// x and y are u and v already.
    Unit,
    /// The XY box of a named part, which itself is not output.
    Cell,
}

impl FitChoice {
    /// The fit with the name of its cell.
    pub(crate) fn with_cell(self, cell: Option<String>) -> Result<Fit, NodeError> {
        Ok(match self {
            Self::Bounds => Fit::Bounds,
            Self::Unit => Fit::Unit,
            Self::Cell => Fit::Cell {
                name: cell.ok_or_else(|| {
                    NodeError::new("`fit: Cell` needs `cell`: the name of the reference part")
                        .at_input("fit")
                })?,
            },
        })
    }
}

/// Which level lies in the surface.
#[derive(Clone, Copy, Choice)]
#[choice(into = Anchor)]
pub(crate) enum AnchorChoice {
    /// The component's z = 0.
    Origin,
    /// Its top: all of it lies below the surface.
    Below,
    /// Half way.
    Centre,
    /// Its bottom: all of it lies above the surface.
    Above,
}

/// What happens beyond the square.
#[derive(Clone, Copy, Choice)]
#[choice(into = Beyond)]
pub(crate) enum BeyondChoice {
    /// It stays, and reaches beyond the face.
    Extend,
    /// It is cut off.
    Clip,
    /// It is cut off and comes in again at the other side.
    Cyclic,
}

impl Node for FitComponent {
    type Output = Arc<Mesh>;
    const VERSION: u32 = 2;
    const PREVIEW: Preview = Preview {
        heights: &["height"],
        ..Preview::NONE
    };

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let at =
            |error: tessgraph_geometry::GeometryError| NodeError::from(error).at_input("component");
        let fit = self.fit.with_cell(self.cell)?;
        warn_of_shape(&self.component, &fit, cx)?;
        let depth = self
            .component
            .bounds()
            .map_or(0.0, |(low, high)| high.z - low.z);
        if self.height.is_some() && depth == 0.0 {
            let message = "the component is flat: no scale gives it a height";
            return Err(NodeError::new(message).at_input("height"));
        }
        let options = FitOptions {
            fit,
            height: self.height,
            anchor: self.anchor.into(),
            x: self.x.into(),
            y: self.y.into(),
        };
        Ok(Arc::new(
            tessgraph_geometry::fit_component(&self.component, &options).map_err(at)?,
        ))
    }
}

/// Warns when the component's box has no extent along an axis, or few small
/// faces set a side of it.
pub(crate) fn warn_of_shape(component: &Mesh, fit: &Fit, cx: &EvalCx<'_>) -> Result<(), NodeError> {
    let size = component_frame(component, fit)?.size;
    for (axis, extent) in [("x", size.x), ("y", size.y)] {
        if extent == 0.0 {
            cx.warn(format!(
                "the component has no extent along {axis}: it lies on one line of each face"
            ));
        }
    }
    if *fit != Fit::Bounds {
        return Ok(());
    }
    for outlier in box_outliers(component)? {
        cx.warn(format!(
            "faces {} alone make {:.0} % of the component's box at {}; \
             fit a named part of it instead with `fit: Cell`",
            list_ids(&outlier.faces),
            outlier.share * 100.0,
            outlier.side,
        ));
    }
    Ok(())
}

/// Warns of vertices beyond the unit square where x and y are u and v already.
pub(crate) fn warn_of_outside(
    component: &Mesh,
    fit: &Fit,
    cx: &EvalCx<'_>,
) -> Result<(), NodeError> {
    if *fit != Fit::Unit {
        return Ok(());
    }
    let frame = component_frame(component, fit)?;
    // A hair of room, so that rounding at the border is not reported.
    let beyond = |x: f64| !(-1e-9..=1.0 + 1e-9).contains(&x);
    let outside = |vertex: &u32| {
        let uv = frame.uv(component.positions()[*vertex as usize].truncate());
        beyond(uv.x) || beyond(uv.y)
    };
    let vertices: Vec<u32> = (0..component.vertex_count() as u32)
        .filter(outside)
        .collect();
    if !vertices.is_empty() {
        cx.warn(format!(
            "vertices {} of the component lie outside the unit square and reach beyond \
             their face; cut or repeat them with FitComponent, or fit its box with \
             `fit: Bounds`",
            list_ids(&vertices)
        ));
    }
    Ok(())
}
