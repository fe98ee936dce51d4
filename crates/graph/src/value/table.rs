//! Rows and typed columns: schedules of panels.

use std::fmt::Write as _;
use std::sync::Arc;

use tessgraph_geometry::Quantity;
use tessgraph_geometry::digest::{Digest, Hasher};

use super::payload::six_digits;

/// The cells of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnValues {
    /// Whole numbers.
    Integer(Vec<i64>),
    /// Real numbers in SI units; NaN stands for an empty cell.
    Number(Vec<f64>),
    /// Texts.
    Text(Vec<Arc<str>>),
}

/// A named column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its heading, a `snake_case` identifier.
    pub name: String,
    /// What its numbers measure.
    pub quantity: Quantity,
    /// One cell per row.
    pub values: ColumnValues,
}

/// Columns of equal length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    columns: Vec<Column>,
    rows: usize,
}

impl Table {
    /// A table of these columns; `None` when their lengths differ.
    pub fn new(columns: Vec<Column>) -> Option<Self> {
        let rows = columns.first().map_or(0, |column| column.values.len());
        let even = columns.iter().all(|column| column.values.len() == rows);
        even.then_some(Self { columns, rows })
    }

    /// The columns in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// How many rows there are.
    pub fn row_count(&self) -> usize {
        self.rows
    }

    pub(super) fn digest(&self) -> Digest {
        let mut hasher = Hasher::new();
        hasher
            .text("table")
            .number(self.columns.len() as u64)
            .number(self.rows as u64);
        for column in &self.columns {
            hasher.text(&column.name).number(column.quantity as u64);
            match &column.values {
                ColumnValues::Integer(cells) => {
                    hasher.text("integer").bytes(bytemuck::cast_slice(cells));
                }
                ColumnValues::Number(cells) => {
                    hasher.text("number");
                    cells.iter().for_each(|cell| {
                        hasher.float(*cell);
                    });
                }
                ColumnValues::Text(cells) => {
                    hasher.text("text");
                    cells.iter().for_each(|cell| {
                        hasher.text(cell);
                    });
                }
            }
        }
        hasher.finish()
    }

    pub(super) fn summary(&self) -> String {
        let names: Vec<_> = self
            .columns
            .iter()
            .map(|column| column.name.as_str())
            .collect();
        let mut text = format!("table: {} rows of {}\n", self.rows, names.join(", "));
        for column in &self.columns {
            if let ColumnValues::Number(cells) = &column.values {
                let finite = cells.iter().filter(|cell| cell.is_finite());
                let (low, high) = finite
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &cell| {
                        (low.min(cell), high.max(cell))
                    });
                let (low, high) = (six_digits(low), six_digits(high));
                let _ = writeln!(text, "{}: {low} .. {high}", column.name);
            }
        }
        text
    }
}

impl ColumnValues {
    /// How many cells there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Integer(cells) => cells.len(),
            Self::Number(cells) => cells.len(),
            Self::Text(cells) => cells.len(),
        }
    }

    /// Whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
