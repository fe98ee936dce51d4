//! Fields and attributes as buffers.

use tessgraph_geometry::buffer::Buffer;
use tessgraph_geometry::digest::Digest;
use tessgraph_geometry::{Attribute, AttributeValues, Domain, Field, Mesh, parallel};
use tessgraph_graph::Units;

use super::memo::Memo;
use super::mesh::all;
use crate::buffers::{Buffers, bytes, source};
use crate::protocol::{BufferName, ShownField};

/// Smallest and largest of numbers, by their digest.
pub(super) type Ranges = Memo<(f64, f64)>;

/// Puts fields into buffers.
pub(super) struct Hanger<'a> {
    pub(super) buffers: &'a Buffers,
    pub(super) ranges: &'a Ranges,
}

/// Numbers as they are asked for.
#[derive(Clone)]
enum Numbers {
    Real(Buffer<f64>),
    Whole(Buffer<i64>),
}

impl Numbers {
    fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Whole(values) => values.len(),
        }
    }

    fn digest(&self) -> Digest {
        match self {
            Self::Real(values) => values.digest(),
            Self::Whole(values) => values.digest(),
        }
    }

    fn at(&self, index: usize) -> f64 {
        match self {
            Self::Real(values) => values[index],
            Self::Whole(values) => values[index] as f64,
        }
    }
}

impl Hanger<'_> {
    /// A field that a node gives.
    pub(super) fn of_node(
        &self,
        node: &str,
        result: &str,
        field: &Field,
        units: Units,
    ) -> ShownField {
        let values = Numbers::Real(field.values().clone());
        let scale = units.to_si(field.quantity());
        let (low, high) = self.range(&values);
        ShownField {
            name: format!("{node}.{result}"),
            label: label(node, result),
            on: domain_name(field.domain()),
            unit: units.quantity_sign(field.quantity()),
            min: low / scale,
            max: high / scale,
            values: self.floats(values, scale),
            categorical: false,
            node: node.to_owned(),
        }
    }

    /// The attributes of vertices and faces that are numbers.
    pub(super) fn attributes(&self, mesh: &Mesh, node: &str) -> Vec<ShownField> {
        let attributes = mesh.attributes().iter();
        attributes
            .filter(|attribute| attribute.domain() != Domain::Corner)
            .filter_map(|attribute| self.attribute(attribute, node))
            .collect()
    }

    fn attribute(&self, attribute: &Attribute, node: &str) -> Option<ShownField> {
        let (values, categorical) = match attribute.values() {
            AttributeValues::Integer(values) => (Numbers::Whole(values.clone()), true),
            AttributeValues::Number(values) => (Numbers::Real(values.clone()), false),
            AttributeValues::Vector2(_) | AttributeValues::Vector3(_) => return None,
        };
        let (low, high) = self.range(&values);
        Some(ShownField {
            name: attribute.name().to_owned(),
            label: attribute.name().replace('_', " "),
            on: domain_name(attribute.domain()),
            unit: String::new(),
            min: low,
            max: high,
            values: self.floats(values, 1.0),
            categorical,
            node: node.to_owned(),
        })
    }

    fn range(&self, values: &Numbers) -> (f64, f64) {
        let find = || {
            let range = parallel::range(values.len(), |index| values.at(index));
            Some(range.unwrap_or((0.0, 0.0)))
        };
        let kind = matches!(values, Numbers::Whole(_)).into();
        let content = source("range", &[values.digest()]).number(kind).finish();
        self.ranges.get(content, find).unwrap_or_default()
    }

    /// Numbers over `scale` as `f32`.
    fn floats(&self, values: Numbers, scale: f64) -> BufferName {
        let kind = matches!(values, Numbers::Whole(_)).into();
        let source = source("floats", &[values.digest()])
            .number(kind)
            .float(scale)
            .finish();
        let count = values.len();
        self.buffers.awaited(source, 4 * count, move || {
            let number = |index: usize| ((values.at(index) / scale) as f32).to_bits().to_le();
            bytes(all(count, number))
        })
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

fn domain_name(domain: Domain) -> &'static str {
    match domain {
        Domain::Vertex => "vertex",
        Domain::Face => "face",
        Domain::Corner => "corner",
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tessgraph_geometry::Quantity;

    use super::*;

    #[test]
    fn fields_are_told_in_the_units_of_the_file() {
        let (buffers, ranges) = (&Buffers::new(0), &Ranges::default());
        let hanger = Hanger { buffers, ranges };
        let field = Field::new(Domain::Face, Quantity::Length, vec![0.12, -0.5]).unwrap();
        let told = hanger.of_node("n", "distances", &field, Units::Cm);
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
        let (buffers, ranges) = (&Buffers::new(0), &Ranges::default());
        let told = Hanger { buffers, ranges }.attributes(&mesh, "n");
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
