//! Numbers, reports, tables and fields as JSON and CSV, in the file's units.

use std::fmt::Write as _;

use serde_json::{Map, Value as Json, json};
use tessgraph_geometry::{Field, Quantity};
use tessgraph_graph::value::{Column, ColumnValues, Report, Scalar, Table};
use tessgraph_graph::{Units, Value};

use crate::json::{line, number, pretty};

/// A value as JSON text; `None` for kinds that JSON does not hold.
///
/// Scalars are themselves, vectors `[x, y, z]`, a report is one object, a table
/// a list of objects with one row a line, a field an object with `domain`,
/// `quantity`, `unit` and `values`. Empty cells are null.
pub(super) fn json_text(value: &Value, quantity: Quantity, units: Units) -> Option<String> {
    Some(match value {
        Value::Table(table) => lines(&rows(table, units)),
        Value::Field(field) => format!("{}\n", line(&field_json(field, units))),
        Value::List(items) => {
            let items: Option<Vec<Json>> = items
                .iter()
                .map(|item| plain_json(item, quantity, units))
                .collect();
            lines(&items?)
        }
        value => pretty(&plain_json(value, quantity, units)?),
    })
}

/// A value as CSV text; `None` for kinds that are no rows.
///
/// The first line names the columns. A report has the columns name, value and
/// unit; a field the element's index and the value. Fields with commas, quotes
/// or line feeds are quoted (RFC 4180); lines end with a line feed.
pub(super) fn csv_text(value: &Value, units: Units) -> Option<String> {
    let mut text = String::new();
    match value {
        Value::Table(table) => table_csv(table, units, &mut text),
        Value::Field(field) => {
            let _ = writeln!(text, "{},value", field.domain());
            for (index, &value) in field.values().iter().enumerate() {
                let value = units.from_si(value, field.quantity());
                let _ = writeln!(text, "{index},{}", csv_number(value));
            }
        }
        Value::Report(report) => {
            text.push_str("name,value,unit\n");
            for entry in report.entries() {
                let value = match &entry.value {
                    Scalar::Bool(value) => value.to_string(),
                    Scalar::Integer(value) => value.to_string(),
                    Scalar::Number(value) => csv_number(units.from_si(*value, entry.quantity)),
                    Scalar::Text(value) => csv_field(value),
                };
                let unit = units.quantity_sign(entry.quantity);
                let _ = writeln!(text, "{},{value},{unit}", csv_field(&entry.name));
            }
        }
        _ => return None,
    }
    Some(text)
}

fn plain_json(value: &Value, quantity: Quantity, units: Units) -> Option<Json> {
    let scalar = |si: f64| number(units.from_si(si, quantity));
    Some(match value {
        Value::Bool(value) => json!(value),
        Value::Integer(value) => json!(value),
        Value::Number(value) => scalar(*value),
        Value::Text(value) => json!(value.as_ref()),
        Value::Choice(name) => json!(name),
        Value::Vector(v) => json!([scalar(v.x), scalar(v.y), scalar(v.z)]),
        Value::Report(report) => report_json(report, units),
        Value::Table(table) => Json::Array(rows(table, units)),
        Value::Field(field) => field_json(field, units),
        Value::List(items) => {
            let items = items.iter().map(|item| plain_json(item, quantity, units));
            Json::Array(items.collect::<Option<_>>()?)
        }
        Value::Mesh(_) | Value::Directions(_) | Value::Formula(_) => return None,
    })
}

fn report_json(report: &Report, units: Units) -> Json {
    let entries = report.entries().iter().map(|entry| {
        let value = match &entry.value {
            Scalar::Bool(value) => json!(value),
            Scalar::Integer(value) => json!(value),
            Scalar::Number(value) => number(units.from_si(*value, entry.quantity)),
            Scalar::Text(value) => json!(value.as_ref()),
        };
        (entry.name.clone(), value)
    });
    Json::Object(entries.collect())
}

fn field_json(field: &Field, units: Units) -> Json {
    let values = field.values().iter();
    let values: Vec<Json> = values
        .map(|&value| number(units.from_si(value, field.quantity())))
        .collect();
    json!({
        "domain": field.domain().to_string(),
        "quantity": field.quantity().to_string(),
        "unit": units.quantity_sign(field.quantity()),
        "values": values,
    })
}

/// One object per row of the table.
fn rows(table: &Table, units: Units) -> Vec<Json> {
    let cell = |column: &Column, row: usize| match &column.values {
        ColumnValues::Integer(cells) => json!(cells[row]),
        ColumnValues::Number(cells) => number(units.from_si(cells[row], column.quantity)),
        ColumnValues::Text(cells) => json!(cells[row].as_ref()),
    };
    let row = |row| {
        let cells = table
            .columns()
            .iter()
            .map(|column| (column.name.clone(), cell(column, row)));
        Json::Object(cells.collect::<Map<_, _>>())
    };
    (0..table.row_count()).map(row).collect()
}

/// A list with one item a line.
fn lines(items: &[Json]) -> String {
    if items.is_empty() {
        return "[]\n".to_owned();
    }
    let items: Vec<String> = items
        .iter()
        .map(|item| format!("  {}", line(item)))
        .collect();
    format!("[\n{}\n]\n", items.join(",\n"))
}

fn table_csv(table: &Table, units: Units, text: &mut String) {
    let names: Vec<_> = table
        .columns()
        .iter()
        .map(|column| csv_field(&column.name))
        .collect();
    let _ = writeln!(text, "{}", names.join(","));
    for row in 0..table.row_count() {
        for (index, column) in table.columns().iter().enumerate() {
            if index > 0 {
                text.push(',');
            }
            match &column.values {
                ColumnValues::Integer(cells) => {
                    let _ = write!(text, "{}", cells[row]);
                }
                ColumnValues::Number(cells) => {
                    text.push_str(&csv_number(units.from_si(cells[row], column.quantity)));
                }
                ColumnValues::Text(cells) => text.push_str(&csv_field(&cells[row])),
            }
        }
        text.push('\n');
    }
}

/// The fewest digits that read back exactly; nothing for NaN and infinity.
/// A number as CSV; nothing for NaN and infinity.
pub(crate) fn csv_number(value: f64) -> String {
    match number(value) {
        Json::Number(number) => {
            let text = number.to_string();
            text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
        }
        _ => String::new(),
    }
}

/// A text as CSV, quoted where it must be.
pub(crate) fn csv_field(text: &str) -> String {
    let special = |character| matches!(character, ',' | '"' | '\n' | '\r');
    let blank = text.starts_with(' ') || text.ends_with(' ');
    if blank || text.contains(special) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tessgraph_geometry::Domain;
    use tessgraph_graph::value::ReportEntry;

    use super::*;

    fn report() -> Value {
        let entry = |name: &str, quantity, value| ReportEntry {
            name: name.to_owned(),
            quantity,
            value,
        };
        Value::Report(Arc::new(Report::new(vec![
            entry("pairs", Quantity::Number, Scalar::Integer(3)),
            entry("gap", Quantity::Length, Scalar::Number(0.12)),
            entry("area", Quantity::Area, Scalar::Number(0.5)),
            entry(
                "angle",
                Quantity::Angle,
                Scalar::Number(tessgraph_geometry::math::PI / 2.0),
            ),
            entry("empty", Quantity::Length, Scalar::Number(f64::NAN)),
            entry("closed", Quantity::Number, Scalar::Bool(true)),
            entry("note", Quantity::Number, Scalar::Text("a, \"b\"".into())),
        ])))
    }

    fn table() -> Value {
        let column = |name: &str, quantity, values| Column {
            name: name.to_owned(),
            quantity,
            values,
        };
        let columns = vec![
            column("panel", Quantity::Number, ColumnValues::Integer(vec![0, 1])),
            column(
                "width",
                Quantity::Length,
                ColumnValues::Number(vec![1.25, f64::NAN]),
            ),
            column(
                "mark",
                Quantity::Number,
                ColumnValues::Text(vec!["A".into(), "x\ny".into()]),
            ),
        ];
        Value::Table(Arc::new(Table::new(columns).unwrap()))
    }

    #[test]
    fn reports_are_in_the_files_units_and_degrees() {
        let text = json_text(&report(), Quantity::Number, Units::Cm).unwrap();
        let expected = json!({
            "pairs": 3, "gap": 12.0, "area": 5000.0, "angle": 90.0, "empty": null,
            "closed": true, "note": "a, \"b\"",
        });
        assert_eq!(serde_json::from_str::<Json>(&text).unwrap(), expected);
        let csv = csv_text(&report(), Units::Mm).unwrap();
        let expected = "name,value,unit\npairs,3,\ngap,120,mm\narea,500000,mm²\nangle,90,°\n\
                        empty,,mm\nclosed,true,\nnote,\"a, \"\"b\"\"\",\n";
        assert_eq!(csv, expected);
    }

    #[test]
    fn tables_have_a_row_a_line() {
        let text = json_text(&table(), Quantity::Number, Units::Cm).unwrap();
        let expected = "[\n  {\"panel\":0,\"width\":125.0,\"mark\":\"A\"},\n  \
                        {\"panel\":1,\"width\":null,\"mark\":\"x\\ny\"}\n]\n";
        assert_eq!(text, expected);
        let csv = csv_text(&table(), Units::Cm).unwrap();
        assert_eq!(csv, "panel,width,mark\n0,125,A\n1,,\"x\ny\"\n");
    }

    #[test]
    fn fields_scalars_and_lists() {
        let field = Field::new(Domain::Face, Quantity::Length, vec![0.001, -0.0]).unwrap();
        let field = Value::Field(Arc::new(field));
        assert_eq!(
            csv_text(&field, Units::Mm).unwrap(),
            "face,value\n0,1\n1,0\n"
        );
        let text = json_text(&field, Quantity::Number, Units::Mm).unwrap();
        let expected =
            "{\"domain\":\"face\",\"quantity\":\"length\",\"unit\":\"mm\",\"values\":[1.0,0.0]}\n";
        assert_eq!(text, expected);
        let length = json_text(&Value::Number(0.3048), Quantity::Length, Units::Ft);
        assert_eq!(length.unwrap(), "1.0\n");
        let list = Value::List([Value::Integer(1), Value::Integer(2)].into());
        assert_eq!(
            json_text(&list, Quantity::Number, Units::M).unwrap(),
            "[\n  1,\n  2\n]\n"
        );
        let empty = Value::List([].into());
        assert_eq!(
            json_text(&empty, Quantity::Number, Units::M).unwrap(),
            "[]\n"
        );
    }
}
