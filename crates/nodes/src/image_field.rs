//! The luminance of a picture as a field.

use std::sync::Arc;

use tessgraph_geometry::{Field, Mesh, Quantity};
use tessgraph_graph::value::FilePath;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::evaluate_field::FieldElements;
use crate::support::elements::uv;

/// Reads the luminance of a PNG at the texture coordinates of a mesh.
///
/// Black is 0 and white 1, as drawn (a grey of 50 % is 0.5); between pixels values
/// are bilinear, and beyond 0..1 the picture repeats. The mesh needs a UV layer,
/// as `Grid` and `ParametricSurface` have.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": ParametricSurface(x: "4 * u", y: "4 * v", z: "0", cells: [8, 8]),
///     "out": ImageField(mesh: "base", path: "images/ramps.png"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ImageField {
    /// Mesh whose texture coordinates are used.
    mesh: Arc<Mesh>,
    /// The PNG file.
    path: FilePath,
    /// The elements that get a number; of a face the mean of its corners counts.
    #[input(default = Vertices)]
    on: FieldElements,
}

impl Node for ImageField {
    type Output = Arc<Field>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let places = uv(&self.mesh, self.on.into()).map_err(|error| error.at_input("mesh"))?;
        let bytes = cx.read(&self.path)?;
        let picture = tessgraph_io::read_luminance(&bytes, self.path.as_str())
            .map_err(|error| NodeError::new(error.to_string()).at_input("path"))?;
        let values = places
            .iter()
            .map(|place| picture.at(place.x, place.y))
            .collect();
        let domain = self.on.domain();
        Ok(Arc::new(Field::new(domain, Quantity::Number, values)?))
    }
}
