//! Directions that are stored in a mesh.

use std::sync::Arc;

use tessgraph_geometry::{Directions, Mesh, directions};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Takes directions from vectors stored in the mesh, such as a file's normals.
///
/// The attribute is on vertices or on corners; of corners the mean round each
/// vertex counts. OBJ, glTF and PLY files bring their normals as `normal`.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "strip": ReadMesh(path: "meshes/leaning.obj"),
///     "out": DirectionsFromAttribute(mesh: "strip"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct DirectionsFromAttribute {
    /// Mesh that has the attribute.
    mesh: Arc<Mesh>,
    /// The attribute's name.
    #[input(default = "normal")]
    name: String,
    /// Whether the vectors are brought to length 1; else they keep their lengths.
    #[input(default = true)]
    unit: bool,
}

impl Node for DirectionsFromAttribute {
    type Output = Arc<Directions>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let (mesh, name) = (&self.mesh, &self.name);
        let found = directions::directions_from_attribute(mesh, name, self.unit, cx.monitor())
            .map_err(|error| NodeError::from(error).at_input("name"))?;
        Ok(Arc::new(found))
    }
}
