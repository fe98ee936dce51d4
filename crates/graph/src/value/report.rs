//! Named scalars: what measurements and checks give.

use std::fmt::Write as _;
use std::sync::Arc;

use tessgraph_geometry::Mesh;
use tessgraph_geometry::Quantity;
use tessgraph_geometry::digest::{Digest, Hasher};
use tessgraph_geometry::measure::measure_mesh;

use super::payload::six_digits;
use super::{Payload, Value};
use crate::node::OutputSpec;

/// A scalar in a report, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub enum Scalar {
    /// True or false.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A real number.
    Number(f64),
    /// A text.
    Text(Arc<str>),
}

/// One line of a report.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportEntry {
    /// Its name, a `snake_case` identifier.
    pub name: String,
    /// What it measures.
    pub quantity: Quantity,
    /// Its value in SI units.
    pub value: Scalar,
}

/// Named scalars in a fixed order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    entries: Vec<ReportEntry>,
}

impl Report {
    /// A report of these entries.
    pub fn new(entries: Vec<ReportEntry>) -> Self {
        Self { entries }
    }

    /// The scalar results among a node's results, as one report.
    pub fn of_results(specs: &[OutputSpec], values: &[Value]) -> Self {
        let entries = specs.iter().zip(values).filter_map(|(spec, value)| {
            let value = match value {
                Value::Bool(value) => Scalar::Bool(*value),
                Value::Integer(value) => Scalar::Integer(*value),
                Value::Number(value) => Scalar::Number(*value),
                Value::Text(value) => Scalar::Text(Arc::clone(value)),
                _ => return None,
            };
            Some(ReportEntry {
                name: spec.name.to_owned(),
                quantity: spec.quantity,
                value,
            })
        });
        Self {
            entries: entries.collect(),
        }
    }

    /// The entries in order.
    pub fn entries(&self) -> &[ReportEntry] {
        &self.entries
    }

    pub(super) fn digest(&self) -> Digest {
        let mut hasher = Hasher::new();
        hasher.text("report").number(self.entries.len() as u64);
        for entry in &self.entries {
            hasher.text(&entry.name).number(entry.quantity as u64);
            hasher.digest(match &entry.value {
                Scalar::Bool(value) => value.digest(),
                Scalar::Integer(value) => value.digest(),
                Scalar::Number(value) => value.digest(),
                Scalar::Text(value) => value.digest(),
            });
        }
        hasher.finish()
    }

    pub(super) fn summary(&self) -> String {
        let mut text = String::new();
        for entry in &self.entries {
            let value = match &entry.value {
                Scalar::Bool(value) => value.to_string(),
                Scalar::Integer(value) => value.to_string(),
                Scalar::Number(value) => six_digits(*value),
                Scalar::Text(value) => value.to_string(),
            };
            let _ = writeln!(text, "{}: {value}", entry.name);
        }
        text
    }
}

/// A mesh as lines that a person can judge: counts, borders, size, area, volume.
pub(super) fn mesh_summary(mesh: &Mesh) -> String {
    let found = measure_mesh(mesh);
    let mut text = format!("mesh: {} vertices, {} faces\n", found.vertices, found.faces);
    let _ = writeln!(
        text,
        "euler: {}, components: {}",
        found.euler, found.components
    );
    let _ = writeln!(text, "boundary loops: {}", found.boundary_loops);
    for (what, count) in [
        ("edges with more than two faces", found.nonmanifold_edges),
        (
            "edges between faces of opposite sense",
            found.inconsistent_edges,
        ),
        ("vertices without faces", found.isolated_vertices),
        ("degenerate faces", found.degenerate_faces),
    ] {
        if count > 0 {
            let _ = writeln!(text, "{what}: {count}");
        }
    }
    if let Some((low, high)) = found.bounds {
        let _ = writeln!(text, "bounds: {} .. {}", low.summary(), high.summary());
    }
    let _ = writeln!(text, "area: {}", six_digits(found.area));
    if let Some(volume) = found.volume {
        let _ = writeln!(text, "volume: {}", six_digits(volume));
    }
    for attribute in mesh.attributes() {
        let (name, domain) = (attribute.name(), attribute.domain());
        let _ = writeln!(
            text,
            "attribute: {name} ({} per {domain})",
            attribute.values().type_name()
        );
    }
    text
}
