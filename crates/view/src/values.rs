//! Values as the page is told them: in the file's units, with their signs.

use tessgraph_geometry::Quantity;
use tessgraph_graph::value::{Report, Scalar};
use tessgraph_graph::{Units, plain_number};

use crate::protocol::{Entry, Value};

/// A value that stands alone; `None` for meshes, lists and all that is larger.
pub fn single(value: &tessgraph_graph::Value) -> Option<Value> {
    use tessgraph_graph::Value as From;
    Some(match value {
        From::Bool(value) => Value::Bool(*value),
        From::Integer(number) => Value::Integer(*number),
        From::Number(number) => Value::Number(*number),
        From::Text(text) => Value::Text(text.to_string()),
        From::Choice(name) => Value::Text((*name).to_owned()),
        _ => return None,
    })
}

/// A number in SI units with its sign in the file's: "0.25 m", "90°", "7".
pub(crate) fn amount(number: f64, quantity: Quantity, units: Units) -> String {
    let text = plain_number(units.from_si(number, quantity));
    match (units.quantity_sign(quantity), quantity) {
        (sign, _) if sign.is_empty() => text,
        (sign, Quantity::Angle) => text + &sign,
        (sign, _) => format!("{text} {sign}"),
    }
}

/// The lines of a report.
pub(crate) fn entries(report: &Report, units: Units) -> Vec<Entry> {
    let entry = |entry: &tessgraph_graph::value::ReportEntry| Entry {
        name: entry.name.clone(),
        value: Some(match &entry.value {
            Scalar::Bool(value) => Value::Bool(*value),
            Scalar::Integer(number) => Value::Integer(*number),
            Scalar::Number(number) => Value::Number(units.from_si(*number, entry.quantity)),
            Scalar::Text(text) => Value::Text(text.to_string()),
        }),
        unit: match entry.value {
            Scalar::Number(_) => units.quantity_sign(entry.quantity),
            _ => String::new(),
        },
    };
    report.entries().iter().map(entry).collect()
}

/// An entry as a person says it: "max 0.25 m".
pub(crate) fn said(entry: &Entry) -> String {
    let name = entry.name.replace('_', " ");
    let value = match &entry.value {
        None => "nothing".to_owned(),
        Some(Value::Bool(value)) => if *value { "yes" } else { "no" }.to_owned(),
        Some(Value::Integer(number)) => number.to_string(),
        Some(Value::Number(number)) => tessgraph_graph::six_digits(*number),
        Some(Value::Text(text)) => text.clone(),
    };
    match entry.unit.as_str() {
        "" => format!("{name} {value}"),
        "°" => format!("{name} {value}°"),
        unit => format!("{name} {value} {unit}"),
    }
}
