//! Asking for memory before a mesh is made of others.

use tessgraph_geometry::{GeometryError, Mesh};
use tessgraph_graph::EvalCx;

/// Asks for what a result takes that is up to `times` as large as `meshes`, the
/// memory it is made with included, so that one that cannot be held costs a
/// message and not the process.
///
/// # Errors
/// [`GeometryError::OutOfMemory`] with the bytes it would need.
pub(crate) fn afford<'a>(
    times: u32,
    meshes: impl IntoIterator<Item = &'a Mesh>,
    cx: &EvalCx<'_>,
) -> Result<(), GeometryError> {
    let mut bytes = 0;
    for mesh in meshes {
        mesh.visit_buffers(&mut |_, size| bytes += size as u128);
    }
    cx.monitor().afford(u128::from(times) * bytes)
}
