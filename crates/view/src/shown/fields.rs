//! Fields and attributes as buffers.

use tessgraph_geometry::buffer::Buffer;
use tessgraph_geometry::digest::Digest;
use tessgraph_geometry::{Attribute, AttributeValues, Domain, Field, Mesh, parallel};
use tessgraph_graph::Units;

use super::mesh::all;
use crate::buffers::{Buffers, bytes, source};
use crate::protocol::{BufferName, ShownField};

/// A field that a node gives.
pub(super) fn of_node(
    buffers: &Buffers,
    node: &str,
    result: &str,
    field: &Field,
    units: Units,
) -> ShownField {
    let values = field.values();
    let scale = units.to_si(field.quantity());
    let (low, high) = range(values.len(), |index| values[index]);
    let taken = values.clone();
    let awaited = floats(
        buffers,
        values.digest(),
        scale,
        values.len(),
        move |index| taken[index],
    );
    ShownField {
        name: format!("{node}.{result}"),
        label: label(node, result),
        on: domain_name(field.domain()),
        unit: units.quantity_sign(field.quantity()),
        min: low / scale,
        max: high / scale,
        values: awaited,
        categorical: false,
        node: node.to_owned(),
    }
}

/// What people call a result: "depth: distances", "curvature".
fn label(node: &str, result: &str) -> String {
    match result {
        // What results are called that have no name of their own.
        "result" | "field" => node.replace('_', " "),
        _ => format!("{}: {}", node.replace('_', " "), result.replace('_', " ")),
    }
}

/// The attributes of vertices and faces that are numbers.
pub(super) fn attributes(buffers: &Buffers, mesh: &Mesh, node: &str) -> Vec<ShownField> {
    let attributes = mesh.attributes().iter();
    attributes
        .filter(|attribute| attribute.domain() != Domain::Corner)
        .filter_map(|attribute| self::attribute(buffers, attribute, node))
        .collect()
}

fn attribute(buffers: &Buffers, attribute: &Attribute, node: &str) -> Option<ShownField> {
    let ((low, high), values, categorical) = match attribute.values() {
        AttributeValues::Integer(values) => {
            let number = |values: &Buffer<i64>, index: usize| values[index] as f64;
            let found = range(values.len(), |index| number(values, index));
            let taken = values.clone();
            let take = move |index| number(&taken, index);
            let awaited = floats(buffers, values.digest(), 1.0, values.len(), take);
            (found, awaited, true)
        }
        AttributeValues::Number(values) => {
            let found = range(values.len(), |index| values[index]);
            let taken = values.clone();
            let take = move |index| taken[index];
            let awaited = floats(buffers, values.digest(), 1.0, values.len(), take);
            (found, awaited, false)
        }
        AttributeValues::Vector2(_) | AttributeValues::Vector3(_) => return None,
    };
    Some(ShownField {
        name: attribute.name().to_owned(),
        label: attribute.name().replace('_', " "),
        on: domain_name(attribute.domain()),
        unit: String::new(),
        min: low,
        max: high,
        values,
        categorical,
        node: node.to_owned(),
    })
}

fn domain_name(domain: Domain) -> &'static str {
    match domain {
        Domain::Vertex => "vertex",
        Domain::Face => "face",
        Domain::Corner => "corner",
    }
}

/// Numbers over `scale` as `f32`.
fn floats(
    buffers: &Buffers,
    digest: Digest,
    scale: f64,
    count: usize,
    take: impl Fn(usize) -> f64 + Send + Sync + 'static,
) -> BufferName {
    let source = source("floats", &[digest]).float(scale).finish();
    buffers.awaited(source, 4 * count, move || {
        let number = |index: usize| ((take(index) / scale) as f32).to_bits().to_le();
        bytes(all(count, number))
    })
}

/// The smallest and the largest of some numbers; zeros if there are none.
fn range(count: usize, take: impl Fn(usize) -> f64 + Sync) -> (f64, f64) {
    let wider =
        |(low, high): (f64, f64), (other, another): (f64, f64)| (low.min(other), high.max(another));
    let nothing = || (f64::INFINITY, f64::NEG_INFINITY);
    let one = |found, index| {
        let number = take(index);
        wider(found, (number, number))
    };
    let found = parallel::reduce(count, nothing, one, wider);
    if count == 0 { (0.0, 0.0) } else { found }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tessgraph_geometry::Quantity;

    use super::*;

    #[test]
    fn fields_are_told_in_the_units_of_the_file() {
        let buffers = Buffers::new(0);
        let field = Field::new(Domain::Face, Quantity::Length, vec![0.12, -0.5]).unwrap();
        let told = of_node(&buffers, "n", "distances", &field, Units::Cm);
        assert_eq!((told.min, told.max), (-50.0, 12.0));
        assert_eq!((told.unit.as_str(), told.on), ("cm", "face"));
        let content = buffers.get(told.values.0).unwrap();
        assert_eq!(content[..4], 12f32.to_le_bytes());
        assert_eq!(content[4..], (-50f32).to_le_bytes());
    }

    #[test]
    fn whole_numbers_are_labels_and_vectors_no_fields() {
        let mesh = Mesh::from_faces(vec![[0.0; 3]; 3], &[[0, 1, 2]]).unwrap();
        let with = |mesh: Mesh, name, domain, values| {
            mesh.with_attribute(Attribute::new(name, domain, values))
                .unwrap()
        };
        let panel = AttributeValues::Integer(vec![7].into());
        let mesh = with(mesh, "panel", Domain::Face, panel);
        let height = AttributeValues::Number(vec![1.5, -2.0, 0.0].into());
        let mesh = with(mesh, "height", Domain::Vertex, height);
        let uv = AttributeValues::Vector2(vec![glam::DVec2::ZERO; 3].into());
        let mesh = Arc::new(with(mesh, "uv", Domain::Vertex, uv));
        let told = attributes(&Buffers::new(0), &mesh, "n");
        let facts: Vec<_> = told
            .iter()
            .map(|field| (field.name.as_str(), field.min, field.max, field.categorical))
            .collect();
        assert_eq!(
            facts,
            [("panel", 7.0, 7.0, true), ("height", -2.0, 1.5, false)]
        );
    }
}
