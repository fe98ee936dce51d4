//! An attribute from a formula or a field.

use std::sync::Arc;

use tessgraph_geometry::{Amount, Attribute, AttributeValues, Mesh};
use tessgraph_graph::expr::Formula;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::support::elements::{self, Elements};

/// Adds a named attribute to a mesh, or replaces it.
///
/// The values come from a formula over the chosen elements or from a field.
/// Some names mean something to other nodes: `crease` on edges is the sharpness
/// of edges in `SubdivideQuad` and `corner_sharpness` on vertices that of
/// vertices (0 smooth, 10 and more sharp at every level). `smooth` above 0 on faces
/// has GLB files shaded smoothly instead of flat.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "creased": SetAttribute(mesh: "base", name: "crease", on: Edges, value: "if(abs(x) < 0.01, 10, 0)"),
///     "out": SubdivideQuad(mesh: "creased", levels: 2),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct SetAttribute {
    /// Mesh that gets the attribute.
    mesh: Arc<Mesh>,
    /// The attribute's name.
    name: String,
    /// The elements that get a value; a field brings its own.
    #[input(default = Vertices)]
    on: Elements,
    /// The formula for the values; either this or `field`.
    #[input(free(x: length, y: length, z: length, u, v, index), attributes)]
    value: Option<Arc<Formula>>,
    /// The field with the values, or one number for all elements; either this or
    /// `value`.
    field: Option<Amount>,
}

impl Node for SetAttribute {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let (domain, values) = match (&self.value, &self.field) {
            (Some(formula), None) => {
                let values = elements::evaluate(formula, &self.mesh, self.on, "value", cx)?;
                (self.on.domain(), values.into())
            }
            (None, Some(Amount::Constant(number))) => {
                let domain = self.on.domain();
                let values = vec![*number; self.mesh.element_count(domain)];
                (domain, values.into())
            }
            (None, Some(Amount::Field(field))) => {
                field.check(&self.mesh, field.domain())?;
                (field.domain(), field.values().clone())
            }
            _ => {
                return Err(NodeError::new("give either `value` or `field`")
                    .with_help("`value` is a formula, `field` a node that gives a field"));
            }
        };
        if self.name.trim().is_empty() {
            return Err(NodeError::new("the attribute needs a name").at_input("name"));
        }
        let attribute = Attribute::new(self.name, domain, AttributeValues::Number(values));
        Ok(Arc::new(Mesh::clone(&self.mesh).with_attribute(attribute)?))
    }
}
