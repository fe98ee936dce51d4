//! The list of panels a fabricator works from.

use std::sync::Arc;

use tessgraph_geometry::measure::{self, Panel, PanelBase};
use tessgraph_geometry::surface::Surface;
use tessgraph_geometry::{Mesh, Quantity};
use tessgraph_graph::value::{Column, ColumnValues, Table};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::compensate_thickness::BorderChoice;

/// Lists the panels of an array with their measures, one row each.
///
/// A panel is a component of `ArrayComponents`, or a connected piece of a mesh
/// from elsewhere. Sizes are extents along x, y and z; the blank is the smallest
/// sheet a panel can be cut from, however it leans: in the plane that fits its
/// surface best the rectangle of least area, and the depth across it. That is what
/// is ordered, nested and crated. The volume is empty where
/// a panel's own faces do not close it (joined neighbours share theirs), the
/// thickness where no base is given. Planarity is the largest distance of a
/// corner to the best-fitting plane of its face. Written as CSV.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": ParametricSurface(x: "4 * u", y: "4 * v", z: "sin(2 * u)", cells: [4, 4]),
///     "normals": VertexNormals(mesh: "base"),
///     "box": Cuboid(size: [1, 1, 0.2]),
///     "panels": ArrayComponents(base: "base", component: "box", directions: "normals"),
///     "out": PanelSchedule(mesh: "panels", base: "base", ignore_below: 0.01),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct PanelSchedule {
    /// The arrayed components.
    mesh: Arc<Mesh>,
    /// Base surface that thickness is measured to.
    base: Option<Arc<Mesh>>,
    /// How distances beyond open borders of the base are measured.
    #[input(default = Extend)]
    border: BorderChoice,
    /// Vertices this close to the base or closer do not count for the thickness.
    #[input(min = 0, unit = length)]
    ignore_below: Option<f64>,
}

impl Node for PanelSchedule {
    type Output = Arc<Table>;
    const VERSION: u32 = 2;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let surface = match &self.base {
            Some(base) => Some(
                Surface::new(base, cx.monitor())
                    .map_err(|error| NodeError::from(error).at_input("base"))?,
            ),
            None => None,
        };
        let base = surface.as_ref().map(|surface| PanelBase {
            surface,
            border: self.border.into(),
            ignore_below: self.ignore_below.unwrap_or(-1.0),
        });
        let panels = measure::panels(&self.mesh, base.as_ref(), cx.monitor())?;
        Table::new(columns(&panels))
            .map(Arc::new)
            .ok_or_else(|| NodeError::new("the columns of the schedule differ in length"))
    }
}

fn columns(panels: &[Panel]) -> Vec<Column> {
    let column = |name: &str, quantity, values| Column {
        name: name.to_owned(),
        quantity,
        values,
    };
    let whole = |name: &str, of: &dyn Fn(&Panel) -> i64| {
        let cells = panels.iter().map(of).collect();
        column(name, Quantity::Number, ColumnValues::Integer(cells))
    };
    let number = |name: &str, quantity, of: &dyn Fn(&Panel) -> Option<f64>| {
        let cell = |panel: &Panel| of(panel).unwrap_or(f64::NAN);
        let cells = panels.iter().map(cell).collect();
        column(name, quantity, ColumnValues::Number(cells))
    };
    let mut columns = vec![whole("panel", &|panel| panel.id)];
    if panels.iter().all(|panel| panel.base_face.is_some()) {
        columns.push(whole("base_face", &|panel| panel.base_face.unwrap_or(-1)));
        columns.push(whole("component", &|panel| panel.component.unwrap_or(0)));
    }
    let (length, area, volume) = (Quantity::Length, Quantity::Area, Quantity::Volume);
    columns.extend([
        whole("faces", &|panel| panel.faces as i64),
        number("size_x", length, &|panel| Some(panel.size.x)),
        number("size_y", length, &|panel| Some(panel.size.y)),
        number("size_z", length, &|panel| Some(panel.size.z)),
        number("blank_length", length, &|panel| Some(panel.blank[0])),
        number("blank_width", length, &|panel| Some(panel.blank[1])),
        number("blank_depth", length, &|panel| Some(panel.blank[2])),
        number("area", area, &|panel| Some(panel.area)),
        number("volume", volume, &|panel| panel.volume),
        number("planarity", length, &|panel| Some(panel.planarity)),
    ]);
    for (k, name) in ["thickness_min", "thickness_mean", "thickness_max"]
        .iter()
        .enumerate()
    {
        columns.push(number(name, length, &|panel| {
            panel.thickness.map(|all| all[k])
        }));
    }
    columns
}
