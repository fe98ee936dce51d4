//! Faces as frames round holes.

use std::sync::Arc;

use crate::support::memory::afford;
use tessgraph_geometry::domains::{self, Fill, FrameOptions, Inset, chosen_faces};
use tessgraph_geometry::{Amount, Mesh, list_ids};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Replaces each face by a ring of quads along its edges, round a hole.
///
/// A component's u runs along the face's edge and its v towards the hole. The
/// ring has the same `width` everywhere, or one by `factor`: relative to the size
/// of the faces, or the share of the way to the centre. The hole stays open, or
/// is filled by triangles or one polygon; a ring can be added outside open
/// borders. The face attribute `part` is 0 on rings, 1 outside borders, 2 in
/// holes and 3 on faces that were kept; `source_face` says where each comes from.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "hexagons": ReadMesh(path: "meshes/hexagons.obj"),
///     "out": FrameFaces(mesh: "hexagons", width: 0.15, border: true, fill: Fan),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct FrameFaces {
    /// Mesh whose faces are framed.
    mesh: Arc<Mesh>,
    /// Which faces are framed: those where this is 0.5 or more.
    #[input(default = 1.0)]
    faces: Amount,
    /// How far the hole lies inside the face.
    #[input(default = Constant)]
    inset: InsetChoice,
    /// Width of the ring, a number or one per vertex or face.
    #[input(default = 0.2, min = 0, unit = length, only_with(inset = Constant))]
    width: Amount,
    /// Width relative to the face: with `Centre` the share of the way to the
    /// centre. A number, or one per vertex or face.
    #[input(default = 0.3, min = 0, only_with(inset = Relative | Centre))]
    factor: Amount,
    /// What becomes of the hole.
    #[input(default = Open)]
    fill: FillChoice,
    /// Whether a ring is added outside open borders.
    #[input(default = false)]
    border: bool,
    /// Width of the ring outside borders; left out, as wide as inside.
    #[input(min = 0, unit = length)]
    border_width: Option<Amount>,
    /// Whether faces with four corners stay as they are.
    #[input(default = false)]
    preserve_quads: bool,
}

/// How far the hole lies inside.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
#[choice(into = Inset)]
pub(crate) enum InsetChoice {
    /// Edges move by `width`, mitred at the corners.
    Constant,
    /// Edges move by `factor` times the mean size of the faces at the corner.
    Relative,
    /// Corners move by the share `factor` of the way to the centre.
    Centre,
}

/// What becomes of the hole.
#[derive(Clone, Copy, Choice)]
#[choice(into = Fill)]
pub(crate) enum FillChoice {
    /// It stays open.
    Open,
    /// Triangles round its centre.
    Fan,
    /// One face.
    Polygon,
}

impl Node for FrameFaces {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let chosen = chosen_faces(&self.mesh, &self.faces)
            .map_err(|error| NodeError::from(error).at_input("faces"))?;
        // A quad for each corner, and two vertices.
        afford(6, [&*self.mesh], cx)?;
        let width = match self.inset {
            InsetChoice::Constant => self.width,
            _ => self.factor,
        };
        let options = FrameOptions {
            inset: self.inset.into(),
            width,
            fill: self.fill.into(),
            border: self.border,
            border_width: self.border_width,
            preserve_quads: self.preserve_quads,
        };
        let framed = domains::frame_faces(&self.mesh, &chosen, &options, cx.monitor())?;
        if !framed.overfull.is_empty() {
            cx.warn(format!(
                "the frame is wider than fits into faces {}; use a smaller width there, \
                 or `inset: Relative`",
                list_ids(&framed.overfull)
            ));
        }
        Ok(Arc::new(framed.mesh))
    }
}
