//! A field made visible.

use std::sync::Arc;

use tessgraph_geometry::{Amount, Attribute, AttributeValues, Domain, Mesh};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_io::{place_in_range, viridis};
use tessgraph_macros::{Inputs, Outputs};

/// Colours a mesh by a field, from dark blue (low) to yellow (high).
///
/// The colours are the attribute `color` of the vertices or faces, in linear light,
/// which GLB and PLY files hold. The colour map is viridis: even to the eye, and
/// legible in grey and to colour-blind readers. Lengths count in the file's
/// units.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [8, 8], size: [8, 8]),
///     "height": EvaluateField(mesh: "base", value: "sin(x) * cos(y)"),
///     "out": ColorByField(mesh: "base", field: "height", low: -1, high: 1),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ColorByField {
    /// Mesh to colour.
    mesh: Arc<Mesh>,
    /// One number per vertex or face of the mesh; a number colours all alike.
    field: Amount,
    /// The number shown dark blue; left out, the field's smallest.
    low: Option<f64>,
    /// The number shown yellow; left out, the field's largest.
    high: Option<f64>,
}

/// The coloured mesh and what its colours mean.
#[derive(Outputs)]
pub(crate) struct Colored {
    /// The mesh with the attribute `color`.
    mesh: Arc<Mesh>,
    /// The number shown dark blue.
    low: f64,
    /// The number shown yellow.
    high: f64,
}

impl Node for ColorByField {
    type Output = Colored;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let domain = self.field.domain_or(Domain::Vertex);
        let field = self.field.on(&self.mesh, domain)?;
        let (least, most) = field.range().unwrap_or_default();
        let (low, high) = (self.low.unwrap_or(least), self.high.unwrap_or(most));
        if low > high {
            return Err(
                NodeError::new(format!("`low` is {low}, above `high`, {high}"))
                    .with_help("exchange them, or leave one out")
                    .at_input("low"),
            );
        }
        let color = |&value: &f64| viridis(place_in_range(value, (low, high)));
        let colors = field.values().iter().map(color).collect();
        let values = AttributeValues::Vector3(colors);
        let attribute = Attribute::new("color", domain, values);
        let mesh = Arc::new(Mesh::clone(&self.mesh).with_attribute(attribute)?);
        Ok(Colored { mesh, low, high })
    }
}
