//! What every type of value can tell about itself.

use std::fmt::Write as _;
use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::digest::{Digest, Hasher};
use tessgraph_geometry::{Directions, Field, Mesh};

use super::{Report, Table, Value};
use crate::expr::Formula;

/// What the engine needs of a type before its values can travel on edges.
pub trait Payload {
    /// Digest of the content, never of addresses; -0 counts as 0.
    fn digest(&self) -> Digest;

    /// Calls `visit` with the address and size of each heap buffer inside.
    fn visit_buffers(&self, _visit: &mut dyn FnMut(usize, usize)) {}

    /// Text that a person can judge, for snapshots and the command line.
    fn summary(&self) -> String;
}

impl Payload for bool {
    fn digest(&self) -> Digest {
        Hasher::new().text("bool").number(u64::from(*self)).finish()
    }

    fn summary(&self) -> String {
        self.to_string()
    }
}

impl Payload for i64 {
    fn digest(&self) -> Digest {
        Hasher::new()
            .text("integer")
            .number(self.cast_unsigned())
            .finish()
    }

    fn summary(&self) -> String {
        self.to_string()
    }
}

impl Payload for f64 {
    fn digest(&self) -> Digest {
        Hasher::new().text("number").float(*self).finish()
    }

    fn summary(&self) -> String {
        six_digits(*self)
    }
}

impl Payload for Arc<str> {
    fn digest(&self) -> Digest {
        Hasher::new().text("text").text(self).finish()
    }

    fn summary(&self) -> String {
        format!("{self:?}")
    }
}

impl Payload for &'static str {
    fn digest(&self) -> Digest {
        Hasher::new().text("choice").text(self).finish()
    }

    fn summary(&self) -> String {
        (*self).to_owned()
    }
}

impl Payload for DVec3 {
    fn digest(&self) -> Digest {
        Hasher::new()
            .text("vector")
            .float(self.x)
            .float(self.y)
            .float(self.z)
            .finish()
    }

    fn summary(&self) -> String {
        format!(
            "({}, {}, {})",
            six_digits(self.x),
            six_digits(self.y),
            six_digits(self.z)
        )
    }
}

impl Payload for Arc<Formula> {
    fn digest(&self) -> Digest {
        Formula::digest(self)
    }

    fn summary(&self) -> String {
        "formula".to_owned()
    }
}

impl Payload for Arc<Mesh> {
    fn digest(&self) -> Digest {
        Mesh::digest(self)
    }

    fn visit_buffers(&self, visit: &mut dyn FnMut(usize, usize)) {
        Mesh::visit_buffers(self, visit);
    }

    fn summary(&self) -> String {
        super::report::mesh_summary(self)
    }
}

impl Payload for Arc<Directions> {
    fn digest(&self) -> Digest {
        Directions::digest(self)
    }

    fn visit_buffers(&self, visit: &mut dyn FnMut(usize, usize)) {
        let topology = self.topology();
        visit(topology.offsets().address(), topology.offsets().byte_size());
        visit(topology.corners().address(), topology.corners().byte_size());
        for side in [self.outward(), self.inward()] {
            visit(side.address(), side.byte_size());
        }
    }

    fn summary(&self) -> String {
        let lengths = |side: &[DVec3]| range_summary(side.iter().map(|vector| vector.length()));
        let mut text = format!("directions: {} vertices\n", self.outward().len());
        if self.is_symmetric() {
            let _ = writeln!(text, "length: {}", lengths(self.outward()));
        } else {
            let _ = writeln!(text, "length outward: {}", lengths(self.outward()));
            let _ = writeln!(text, "length inward: {}", lengths(self.inward()));
        }
        let _ = writeln!(text, "compensated: {}", self.is_compensated());
        text
    }
}

impl Payload for Arc<Field> {
    fn digest(&self) -> Digest {
        Field::digest(self)
    }

    fn visit_buffers(&self, visit: &mut dyn FnMut(usize, usize)) {
        visit(self.values().address(), self.values().byte_size());
    }

    fn summary(&self) -> String {
        let count = self.values().len();
        let range = range_summary(self.values().iter().copied());
        format!(
            "field: {} per {}, {count} values\nvalue: {range}\n",
            self.quantity(),
            self.domain()
        )
    }
}

impl Payload for Arc<Report> {
    fn digest(&self) -> Digest {
        Report::digest(self)
    }

    fn summary(&self) -> String {
        Report::summary(self)
    }
}

impl Payload for Arc<Table> {
    fn digest(&self) -> Digest {
        Table::digest(self)
    }

    fn summary(&self) -> String {
        Table::summary(self)
    }
}

/// The digest of a list whose items have these digests.
pub(crate) fn list_digest(items: impl ExactSizeIterator<Item = Digest>) -> Digest {
    let mut hasher = Hasher::new();
    hasher.text("list").number(items.len() as u64);
    for item in items {
        hasher.digest(item);
    }
    hasher.finish()
}

pub(super) fn list_summary(items: &[Value]) -> String {
    let mut text = format!("list of {}\n", items.len());
    for (index, item) in items.iter().enumerate() {
        let _ = writeln!(text, "[{index}]\n{}", item.summary().trim_end());
    }
    text
}

/// "min .. max, mean", each to six digits; "none" without values.
fn range_summary(values: impl Iterator<Item = f64>) -> String {
    let (mut low, mut high, mut sum, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0usize);
    for value in values {
        (low, high, sum, count) = (low.min(value), high.max(value), sum + value, count + 1);
    }
    if count == 0 {
        return "none".to_owned();
    }
    let mean = sum / count as f64;
    format!(
        "{} .. {}, mean {}",
        six_digits(low),
        six_digits(high),
        six_digits(mean)
    )
}

/// The shortest decimal within 10⁻¹⁰ of the number, relative and absolute at
/// once: what a person would have written, without the dust of arithmetic.
///
/// ```
/// assert_eq!(tessgraph_graph::plain_number(0.1 + 0.02), "0.12");
/// assert_eq!(tessgraph_graph::plain_number(5_000_000.1234), "5000000.1234");
/// assert_eq!(tessgraph_graph::plain_number(1.0 / 3.0), "0.33333333333");
/// assert_eq!(tessgraph_graph::plain_number(-0.0), "0");
/// assert_eq!(tessgraph_graph::plain_number(1.5e-9), "1.5e-9");
/// ```
pub fn plain_number(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return (number + 0.0).to_string();
    }
    let near = 1e-10 * number.abs().min(1.0);
    let rounded = (0..17).find_map(|digits| {
        let rounded: f64 = format!("{number:.digits$e}").parse().ok()?;
        ((rounded - number).abs() <= near).then_some(rounded)
    });
    let rounded = rounded.unwrap_or(number);
    if (1e-5..1e15).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// A number to six significant digits, with -0 as 0: how results are shown.
///
/// ```
/// assert_eq!(tessgraph_graph::six_digits(-0.0), "0");
/// assert_eq!(tessgraph_graph::six_digits(1.0 / 3.0), "0.333333");
/// assert_eq!(tessgraph_graph::six_digits(1234567.0), "1234570");
/// assert_eq!(tessgraph_graph::six_digits(1.5e-9), "1.5e-9");
/// ```
pub fn six_digits(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return (number + 0.0).to_string();
    }
    let scientific = format!("{number:.5e}");
    // Rounding through text is exact: it keeps the six digits and nothing else.
    let rounded: f64 = scientific.parse().unwrap_or(number);
    let magnitude = rounded.abs();
    if (1e-5..1e15).contains(&magnitude) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}
