//! What edges of a cut component carry.

use super::cut::CUT;
use crate::mesh::SEAM;
use crate::{Attribute, AttributeValues, Domain, Mesh};

/// 1 on edges made by a cut, elsewhere the seams that the component had before.
pub(super) fn seams(mesh: &Mesh, edges: &[u32]) -> AttributeValues {
    let known = mesh.attribute(SEAM, Domain::Corner).map(Attribute::values);
    let seam = |&edge: &u32| match known {
        _ if edge == CUT => 1.0,
        Some(AttributeValues::Number(values)) => values[edge as usize],
        Some(AttributeValues::Integer(values)) => values[edge as usize] as f64,
        _ => 0.0,
    };
    AttributeValues::Number(edges.iter().map(seam).collect())
}
