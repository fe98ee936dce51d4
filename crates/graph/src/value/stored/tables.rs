//! Reports and tables in the cache.

use std::sync::Arc;

use super::{Stored, quantity_of, quantity_tag};
use crate::value::encode::{Decoder, Encoder};
use crate::value::{Column, ColumnValues, Report, ReportEntry, Scalar, Table};

impl Stored for Arc<Report> {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.number(self.entries().len() as u64);
        for entry in self.entries() {
            out.text(&entry.name).byte(quantity_tag(entry.quantity));
            match &entry.value {
                Scalar::Bool(value) => value.encode(out.byte(0)),
                Scalar::Integer(value) => value.encode(out.byte(1)),
                Scalar::Number(value) => value.encode(out.byte(2)),
                Scalar::Text(value) => value.encode(out.byte(3)),
            };
        }
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        let count = from.count()?;
        let entry = |from: &mut Decoder<'_>| {
            let name = from.text()?.to_owned();
            let quantity = quantity_of(from.byte()?)?;
            let value = match from.byte()? {
                0 => Scalar::Bool(bool::decode(from)?),
                1 => Scalar::Integer(i64::decode(from)?),
                2 => Scalar::Number(f64::decode(from)?),
                3 => Scalar::Text(Arc::decode(from)?),
                _ => return None,
            };
            Some(ReportEntry {
                name,
                quantity,
                value,
            })
        };
        let entries: Option<Vec<_>> = (0..count).map(|_| entry(from)).collect();
        Some(Self::new(Report::new(entries?)))
    }
}

impl Stored for Arc<Table> {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.number(self.columns().len() as u64);
        for column in self.columns() {
            out.text(&column.name).byte(quantity_tag(column.quantity));
            match &column.values {
                ColumnValues::Integer(cells) => {
                    out.byte(0).array(cells);
                }
                ColumnValues::Number(cells) => {
                    out.byte(1).array(cells);
                }
                ColumnValues::Text(cells) => {
                    out.byte(2).number(cells.len() as u64);
                    cells.iter().for_each(|cell| {
                        out.text(cell);
                    });
                }
            }
        }
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        let count = from.count()?;
        let column = |from: &mut Decoder<'_>| {
            let name = from.text()?.to_owned();
            let quantity = quantity_of(from.byte()?)?;
            let values = match from.byte()? {
                0 => ColumnValues::Integer(from.array()?),
                1 => ColumnValues::Number(from.array()?),
                2 => {
                    let cells = from.count()?;
                    let cells: Option<_> = (0..cells).map(|_| Arc::decode(from)).collect();
                    ColumnValues::Text(cells?)
                }
                _ => return None,
            };
            Some(Column {
                name,
                quantity,
                values,
            })
        };
        let columns: Option<Vec<_>> = (0..count).map(|_| column(from)).collect();
        Table::new(columns?).map(Self::new)
    }
}
