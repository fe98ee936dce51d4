//! Faces pushed out of a surface.

use std::sync::Arc;

use crate::support::memory::afford;
use tessgraph_geometry::domains::{self, ExtrudeMode, ExtrudeOptions, chosen_faces};
use tessgraph_geometry::{Amount, Directions, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Pushes faces out of a surface, with walls along their edges.
///
/// Each face goes on its own, or neighbours together as a region whose planes
/// all move by the height. A height below 0 makes a recess; a closed surface
/// stays closed. A component's u runs along the foot of a wall and v in the
/// direction of pushing. The face attribute `part` is 0 on pushed faces, 1 on
/// walls and 2 on faces that stayed; `source_face` says where each comes from.
/// Walls take material and groups from their face.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "white": SelectFaces(mesh: "base", by: Checker),
///     "out": ExtrudeFaces(mesh: "base", faces: "white", height: 0.5),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ExtrudeFaces {
    /// Mesh whose faces are pushed.
    mesh: Arc<Mesh>,
    /// Which faces are pushed: those where this is 0.5 or more.
    #[input(default = 1.0)]
    faces: Amount,
    /// How far, a number or one per face or vertex; faces of height 0 stay.
    #[input(unit = length)]
    height: Amount,
    /// Whether neighbours go together.
    #[input(default = Individual)]
    mode: ExtrudeModeChoice,
    /// Where vertices go per unit of height; left out, along the normals of the
    /// faces.
    directions: Option<Arc<Directions>>,
    /// Whether the pushed faces are kept; without them only walls rise.
    #[input(default = true)]
    cap: bool,
}

/// Whether neighbours go together.
#[derive(Clone, Copy, Choice)]
#[choice(into = ExtrudeMode)]
pub(crate) enum ExtrudeModeChoice {
    /// Every face on its own, with walls all round.
    Individual,
    /// Faces that share an edge together, with walls round the region.
    Region,
}

impl Node for ExtrudeFaces {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let chosen = chosen_faces(&self.mesh, &self.faces)
            .map_err(|error| NodeError::from(error).at_input("faces"))?;
        // A wall for each corner, and a cap.
        afford(6, [&*self.mesh], cx)?;
        let options = ExtrudeOptions {
            mode: self.mode.into(),
            height: self.height,
            directions: self.directions.as_deref(),
            cap: self.cap,
        };
        let extruded = domains::extrude_faces(&self.mesh, &chosen, &options, cx.monitor())?;
        Ok(Arc::new(extruded))
    }
}
