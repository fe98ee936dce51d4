//! Tables: their first rows.

use tessgraph_graph::Units;
use tessgraph_graph::value::{Column, ColumnValues, Table};

use crate::protocol::{ShownColumn, ShownTable, Value};

/// Rows that a page is told.
const MOST_ROWS: usize = 5000;

/// A table in the file's units.
pub(super) fn table(table: &Table, units: Units) -> ShownTable {
    let columns = table.columns().iter().map(|column| ShownColumn {
        name: column.name.clone(),
        unit: match column.values {
            ColumnValues::Number(_) => units.quantity_sign(column.quantity),
            _ => String::new(),
        },
    });
    let row = |row: usize| {
        let cells = table
            .columns()
            .iter()
            .map(|column| cell(column, row, units));
        cells.collect()
    };
    ShownTable {
        columns: columns.collect(),
        rows: (0..table.row_count().min(MOST_ROWS)).map(row).collect(),
        total: table.row_count(),
    }
}

/// A cell; `None` for an empty one.
fn cell(column: &Column, row: usize, units: Units) -> Option<Value> {
    Some(match &column.values {
        ColumnValues::Integer(cells) => Value::Integer(cells[row]),
        ColumnValues::Number(cells) if cells[row].is_nan() => return None,
        ColumnValues::Number(cells) => Value::Number(units.from_si(cells[row], column.quantity)),
        ColumnValues::Text(cells) => Value::Text(cells[row].to_string()),
    })
}

#[cfg(test)]
mod tests {
    use tessgraph_geometry::Quantity;

    use super::*;

    #[test]
    fn cells_are_in_the_units_of_the_file_and_may_be_empty() {
        let column = |name: &str, quantity, values| Column {
            name: name.to_owned(),
            quantity,
            values,
        };
        let widths = ColumnValues::Number(vec![0.5, f64::NAN]);
        let names = ColumnValues::Text(vec!["a".into(), "b".into()]);
        let columns = vec![
            column("width", Quantity::Length, widths),
            column("name", Quantity::Number, names),
        ];
        let told = table(&Table::new(columns).unwrap(), Units::Mm);
        assert_eq!((told.columns[0].unit.as_str(), told.total), ("mm", 2));
        assert_eq!(told.rows[0][0], Some(Value::Number(500.0)));
        assert_eq!(told.rows[1], [None, Some(Value::Text("b".to_owned()))]);
    }
}
