//! Faces that share no vertices.

use std::sync::Arc;

use tessgraph_geometry::Mesh;
use tessgraph_geometry::domains;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Gives every face vertices of its own.
///
/// Directions made of the result are one per face: with `FaceNormals` each cell of
/// an array is flat and upright, with gaps or overlaps between them, as tiles and
/// panels on a folded roof. `WeldVertices` joins faces again.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "dome": ParametricSurface(x: "4 * u", y: "4 * v", z: "2 * u * (1 - u)", cells: [5, 4]),
///     "cells": SeparateFaces(mesh: "dome"),
///     "upright": FaceNormals(mesh: "cells"),
///     "tile": Cuboid(size: [1, 1, 0.2]),
///     "out": ArrayComponents(base: "cells", component: "tile", directions: "upright"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct SeparateFaces {
    /// Mesh whose faces are separated.
    mesh: Arc<Mesh>,
}

impl Node for SeparateFaces {
    type Output = Arc<Mesh>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        Ok(Arc::new(domains::separate_faces(&self.mesh)?))
    }
}
