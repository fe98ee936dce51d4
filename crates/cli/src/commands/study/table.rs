//! The table of a study: one row per variant, in the order of the axes.

use serde_json::Value as Json;

use super::desk::Desk;
use super::make::as_json;
use super::record::Record;
use crate::outputs::{csv_field, csv_number};

/// The table as CSV: the variant's id, the parameters that vary, the measures,
/// `ok` or `failed`, and the error. It says nothing about time, so that it has
/// the same bytes however the variants were made.
pub(super) fn csv(desk: &Desk, records: &[Record]) -> String {
    let mut header = vec!["id".to_owned()];
    header.extend(desk.variants.names.iter().map(|name| csv_field(name)));
    header.extend(desk.study.measures().map(|(name, _)| csv_field(name)));
    header.extend(["status".to_owned(), "error".to_owned()]);
    let mut text = header.join(",");
    text.push('\n');
    for (variant, record) in desk.variants.list.iter().zip(records) {
        let mut row = vec![variant.id.clone()];
        row.extend(
            variant
                .values
                .iter()
                .map(|(_, value)| cell(&as_json(value))),
        );
        row.extend(record.measures.iter().map(cell));
        let failed = record.error.is_some();
        row.push(if failed { "failed" } else { "ok" }.to_owned());
        row.push(csv_field(record.error.as_deref().unwrap_or_default()));
        text.push_str(&row.join(","));
        text.push('\n');
    }
    text
}

fn cell(value: &Json) -> String {
    match value {
        Json::Null => String::new(),
        Json::String(text) => csv_field(text),
        Json::Number(number) => number.as_f64().map_or_else(String::new, csv_number),
        other => other.to_string(),
    }
}
