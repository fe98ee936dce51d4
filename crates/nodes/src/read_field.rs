//! A field from a file of numbers.

use std::sync::Arc;

use tessgraph_geometry::{Field, Quantity};
use tessgraph_graph::value::FilePath;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

use crate::evaluate_field::FieldElements;

/// Reads one number per vertex or face from a CSV file.
///
/// Each line is one element, in the order of the mesh. A file of several columns
/// needs a heading and `column`; lines starting with `#` are comments, and a first line
/// that is no number is taken as the heading. Numbers are written with a
/// decimal point.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "out": ReadField(path: "meshes/weights.csv", on: Vertices),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ReadField {
    /// The CSV file.
    path: FilePath,
    /// The elements the numbers are for.
    #[input(default = Vertices)]
    on: FieldElements,
    /// Name of the column to read, from the heading.
    column: Option<String>,
}

impl Node for ReadField {
    type Output = Arc<Field>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let bytes = cx.read(&self.path)?;
        let values = numbers(&bytes, self.column.as_deref()).map_err(|fault| {
            NodeError::new(format!("{}{fault}", self.path.as_str())).at_input("path")
        })?;
        Ok(Arc::new(Field::new(
            self.on.domain(),
            Quantity::Number,
            values,
        )?))
    }
}

/// The numbers of one column; errors begin with ":line: ".
fn numbers(bytes: &[u8], column: Option<&str>) -> Result<Vec<f64>, String> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let mut place = column.is_none().then_some(0);
    let (mut values, mut width) = (Vec::new(), None);
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|error| format!(": {error}"))?;
        let line = record.position().map_or(0, csv::Position::line);
        let Some(place) = place else {
            place = Some(heading(&record, column.unwrap_or_default(), line)?);
            width = Some(record.len());
            continue;
        };
        let cell = record.get(place).unwrap_or_default();
        if record.len() != *width.get_or_insert(record.len())
            || (record.len() > 1 && column.is_none())
        {
            let cells = record.len();
            return Err(format!(
                ":{line}: there are {cells} cells; write a decimal point, and name the column to read"
            ));
        }
        match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => values.push(number),
            // Without a column name the first line may be a heading.
            Err(_) if row == 0 && column.is_none() => {}
            _ => return Err(format!(":{line}: `{cell}` is not a finite number")),
        }
    }
    Ok(values)
}

fn heading(record: &csv::StringRecord, column: &str, line: u64) -> Result<usize, String> {
    record
        .iter()
        .position(|name| name == column)
        .ok_or_else(|| {
            let names: Vec<_> = record.iter().map(|name| format!("`{name}`")).collect();
            format!(
                ":{line}: there is no column `{column}`; the file has {}",
                names.join(", ")
            )
        })
}

#[cfg(test)]
mod tests {
    use super::numbers;

    #[test]
    fn reads_plain_lines_headings_and_columns() {
        assert_eq!(numbers(b"# weights\n0.5\n1\n", None), Ok(vec![0.5, 1.0]));
        assert_eq!(numbers(b"\xef\xbb\xbfw\r\n0.5\r\n", None), Ok(vec![0.5]));
        assert_eq!(numbers(b"a,b\n1,2\n3,4", Some("b")), Ok(vec![2.0, 4.0]));
    }

    #[test]
    fn names_the_line_at_fault() {
        assert_eq!(
            numbers(b"1\nx\n", None),
            Err(":2: `x` is not a finite number".into())
        );
        assert_eq!(
            numbers(b"1\nNaN\n", None),
            Err(":2: `NaN` is not a finite number".into())
        );
        let comma = ":1: there are 2 cells; write a decimal point, and name the column to read";
        assert_eq!(numbers(b"0,5\n1,25\n", None), Err(comma.into()));
        assert!(numbers(b"a,b\n1,2\n3\n", Some("a")).is_err());
        let missing = numbers(b"a,b\n1,2\n", Some("c"));
        assert_eq!(
            missing,
            Err(":1: there is no column `c`; the file has `a`, `b`".into())
        );
    }
}
