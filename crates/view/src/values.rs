//! Values as the page is told them: in the file's units, with their signs.

use tessgraph_geometry::Quantity;
use tessgraph_graph::value::{Report, Scalar};
use tessgraph_graph::{Units, plain_number};

use crate::protocol::{Amount, Entry, Value};

/// Digits of a number that people can use: of a length of metres the tenths of
/// millimetres.
const DIGITS: i32 = 5;

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

/// A number in SI units as people are told it in the file's: "0.25 m", "90°", "7".
pub(crate) fn amount(number: f64, quantity: Quantity, units: Units) -> Amount {
    amount_beside(number, number, quantity, units)
}

/// The same with as many digits as a size has: a share of a distance with those
/// of the distance, a place with those of the model it is in, however far away
/// that is.
pub(crate) fn amount_beside(number: f64, size: f64, quantity: Quantity, units: Units) -> Amount {
    let [number, size] = [number, size].map(|number| units.from_si(number, quantity));
    let with_sign = |text: String| match (units.quantity_sign(quantity), quantity) {
        (sign, _) if sign.is_empty() => text,
        (sign, Quantity::Angle) => text + &sign,
        (sign, _) => format!("{text} {sign}"),
    };
    Amount {
        text: with_sign(plain_number(rounded(number, size))),
        exact: with_sign(plain_number(number)),
    }
}

/// A number rounded to the place of a size's last useful digit, whole numbers to
/// ones at most.
fn rounded(number: f64, size: f64) -> f64 {
    // Through text, which is exact and the same everywhere.
    let scientific = format!("{size:.*e}", DIGITS as usize - 1);
    let power = scientific
        .split_once('e')
        .and_then(|(_, power)| power.parse().ok());
    match power {
        Some(power) => {
            let decimals = (DIGITS - 1_i32).saturating_sub(power).max(0) as usize;
            format!("{number:.decimals$}").parse().unwrap_or(number)
        }
        None => number,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_people_can_use_and_the_rest_beside_them() {
        let told = |number, quantity| amount(number, quantity, Units::M);
        let length = told(std::f64::consts::SQRT_2, Quantity::Length);
        assert_eq!(
            (length.text.as_str(), length.exact.as_str()),
            ("1.4142 m", "1.4142135624 m")
        );
        for (number, quantity, text) in [
            (0.1 + 0.2, Quantity::Length, "0.3 m"),
            (0.000_123_456_78, Quantity::Area, "0.00012346 m²"),
            (1_234_567.891, Quantity::Volume, "1234568 m³"),
            (99_999.96, Quantity::Number, "100000"),
            (std::f64::consts::FRAC_PI_3, Quantity::Angle, "60°"),
            (-0.0, Quantity::Number, "0"),
            (1.5e-9, Quantity::Number, "1.5e-9"),
            (f64::INFINITY, Quantity::Number, "inf"),
        ] {
            assert_eq!(told(number, quantity).text, text);
        }
    }

    #[test]
    fn what_is_small_beside_its_size_is_nothing() {
        let told = |number, size| amount_beside(number, size, Quantity::Length, Units::Mm).text;
        assert_eq!(told(1e-17, 2.0), "0 mm");
        assert_eq!(told(0.012_345_678, 2.0), "12.3 mm");
        assert_eq!(told(5_000_000.123_456, 20.0), "5000000123 mm");
    }
}
