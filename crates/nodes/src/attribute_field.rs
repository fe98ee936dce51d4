//! A field from an attribute of a mesh.

use std::sync::Arc;

use tessgraph_geometry::{Domain, Field, GeometryError, Mesh, Quantity};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::evaluate_field::FieldElements;

/// Gives a numeric attribute of a mesh as a field.
///
/// Attributes come from files (PLY properties, OBJ weights, `SetAttribute`) or
/// from nodes that record where faces came from, such as `SubdivideQuad` and
/// `ArrayComponents`.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "marked": SetAttribute(mesh: "base", name: "weight", value: "x / 4"),
///     "out": AttributeField(mesh: "marked", name: "weight"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct AttributeField {
    /// Mesh that has the attribute.
    mesh: Arc<Mesh>,
    /// The attribute's name.
    name: String,
    /// The elements it is on.
    #[input(default = Vertices)]
    on: FieldElements,
}

impl Node for AttributeField {
    type Output = Arc<Field>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let domain = self.on.domain();
        let attribute = self.mesh.attribute(&self.name, domain);
        let Some(values) = attribute.and_then(|found| found.values().numbers()) else {
            return Err(NodeError::from(self.missing(domain)).at_input("name"));
        };
        Ok(Arc::new(Field::new(domain, Quantity::Number, values)?))
    }
}

impl AttributeField {
    fn missing(self, domain: Domain) -> GeometryError {
        let describe = |attribute: &tessgraph_geometry::Attribute| {
            let (kind, domain) = (attribute.values().type_name(), attribute.domain());
            format!("{} ({kind} per {domain})", attribute.name())
        };
        GeometryError::NoAttribute {
            name: self.name,
            wanted: match domain {
                Domain::Face => "numeric face",
                _ => "numeric vertex",
            },
            available: self.mesh.attributes().iter().map(describe).collect(),
        }
    }
}
