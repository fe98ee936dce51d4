//! Holes closed by new faces.

use std::sync::Arc;

use tessgraph_geometry::domains::{self, Cap, CapOptions};
use tessgraph_geometry::{Amount, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs, Outputs};

/// Closes the open borders of a mesh with new faces.
///
/// Caps continue the orientation of the surface and take the material of the face
/// at the hole's first edge. The outer border of an open surface counts as a hole
/// too; `most_edges` leaves larger ones open, and `only` chooses among them.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "box": Cuboid(size: [1, 1, 1]),
///     "top": EvaluateField(mesh: "box", on: Faces, value: "if(z > 0.99, 1, 0)"),
///     "open": DeleteFaces(mesh: "box", faces: "top"),
///     "out": CapHoles(mesh: "open", cap: Fan),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct CapHoles {
    /// Mesh whose holes are closed.
    mesh: Arc<Mesh>,
    /// What closes a hole.
    #[input(default = Polygon)]
    cap: CapChoice,
    /// Holes with more edges stay open; left out, all are closed.
    #[input(min = 3, max = 1000000)]
    most_edges: Option<u32>,
    /// Which holes are closed: those where this is 0.5 or more all along, a number
    /// or one per vertex or face.
    #[input(default = 1.0)]
    only: Amount,
    /// Name of the material of the caps; left out, that of the face at the hole's
    /// first edge.
    material: Option<String>,
    /// Sharpness of the edges round caps in `SubdivideQuad`: 0 smooth, 10 and more
    /// sharp at every level.
    #[input(default = 0.0, min = 0)]
    crease: f64,
}

/// What closes a hole.
#[derive(Clone, Copy, Choice)]
#[choice(into = Cap)]
pub(crate) enum CapChoice {
    /// One polygon.
    Polygon,
    /// Triangles round the centre.
    Fan,
}

/// The closed mesh.
#[derive(Outputs)]
pub(crate) struct CappedHoles {
    /// The mesh with its caps.
    mesh: Arc<Mesh>,
    /// Holes closed.
    caps: usize,
    /// Holes left open because they have more edges.
    larger: usize,
}

impl Node for CapHoles {
    type Output = CappedHoles;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let options = CapOptions {
            cap: self.cap.into(),
            most_edges: self.most_edges.map(|most| most as usize),
            only: self.only,
            crease: self.crease,
            material: self.material.as_deref(),
        };
        let capped = domains::cap_holes(&self.mesh, &options)?;
        if capped.broken > 0 {
            cx.warn(format!(
                "{} borders stay open: they do not return to where they start, because \
                 faces there disagree in orientation or more than two share an edge",
                capped.broken
            ));
        }
        Ok(CappedHoles {
            mesh: Arc::new(capped.mesh),
            caps: capped.caps,
            larger: capped.larger,
        })
    }
}
