//! What is told of a study.

use std::time::Instant;

use serde_json::{Map, Value as Json, json};
use tessgraph_graph::Diagnostic;
use tessgraph_graph::study::Variant;

use super::TABLE;
use super::desk::Desk;
use super::make::as_json;
use super::record::Record;
use crate::commands::run::ReportFormat;
use crate::commands::{Context, FAILED, OK};
use crate::console::Console;
use crate::diagnostics::print;
use crate::json::{line, number};
use crate::text::{count, printable, time_text};

/// A variant that is finished.
pub(super) struct Done {
    pub(super) record: Record,
    /// Whether an earlier run made it.
    pub(super) reused: bool,
    pub(super) diagnostics: Vec<Diagnostic>,
}

/// Collects what is told at the end.
pub(super) struct Told<'a> {
    desk: &'a Desk,
    report: ReportFormat,
    done: Vec<(&'a Variant, Record, bool)>,
    /// Each once: most are the same in all variants.
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Told<'a> {
    pub(super) fn new(desk: &'a Desk, report: ReportFormat) -> Self {
        Self {
            desk,
            report,
            done: Vec::new(),
            diagnostics: Vec::new(),
        }
    }

    /// How many variants are finished.
    pub(super) fn count(&self) -> usize {
        self.done.len()
    }

    /// A line about a variant, as soon as it is finished.
    pub(super) fn line(&self, variant: &Variant, done: &Done, console: &mut Console<'_>) {
        if self.report == ReportFormat::Json {
            return;
        }
        let values = variant.values.iter().map(|(name, value)| {
            let value = as_json(value);
            let text = value
                .as_str()
                .map_or_else(|| value.to_string(), str::to_owned);
            format!("{name}={text}")
        });
        let values: Vec<String> = values.collect();
        let what = match (&done.record.error, done.reused) {
            (Some(error), _) => format!("failed: {error}"),
            (None, true) => "there already".to_owned(),
            (None, false) => {
                let nodes = count(done.record.computed, "node");
                format!("{nodes} computed in {}", time_text(done.record.ms))
            }
        };
        let place = format!("{}/{}", self.done.len() + 1, self.desk.variants.list.len());
        let text = format!("{place} {} {}: {what}\n", variant.id, values.join(" "));
        console.note(&printable(&text));
    }

    pub(super) fn add(&mut self, variant: &'a Variant, done: Done) {
        for diagnostic in done.diagnostics {
            let known = self.diagnostics.iter().any(|other| {
                other.message == diagnostic.message
                    && other.code == diagnostic.code
                    && other.labels == diagnostic.labels
            });
            if !known {
                self.diagnostics.push(diagnostic);
            }
        }
        self.done.push((variant, done.record, done.reused));
    }

    /// Tells what the study came to; `table` says whether all went well, or why
    /// there is no table.
    pub(super) fn end(
        &self,
        start: Instant,
        table: Result<bool, String>,
        cx: &mut Context<'_, '_>,
    ) -> u8 {
        print(cx.console, &self.diagnostics);
        let ms = start.elapsed().as_secs_f64() * 1000.0;
        let failed = self
            .done
            .iter()
            .filter(|(_, record, _)| record.error.is_some())
            .count();
        let written = table.is_ok() && self.done.len() == self.desk.variants.list.len();
        let status = match &table {
            Err(message) => {
                let help = "run the study again; it makes only what is not there".to_owned();
                cx.fail(FAILED, "incomplete", message.as_str(), Some(help))
            }
            Ok(_) if failed > 0 => FAILED,
            Ok(_) => OK,
        };
        match self.report {
            ReportFormat::Json => cx.console.data(&self.json(ms, status == OK, written)),
            ReportFormat::Human => cx.console.note(&self.summary(ms, failed, written)),
        }
        status
    }

    /// "27 variants: 16 made, 11 there already; 32 nodes computed in 2.1 s".
    fn summary(&self, ms: f64, failed: usize, written: bool) -> String {
        let reused = self.done.iter().filter(|(_, _, reused)| *reused).count();
        let made = self.done.len() - reused - failed;
        let parts = [
            (made, "made"),
            (reused, "there already"),
            (failed, "failed"),
        ];
        let parts = parts.iter().filter(|(count, _)| *count > 0);
        let parts: Vec<String> = parts
            .map(|(count, what)| format!("{count} {what}"))
            .collect();
        let (variants, nodes) = (
            count(self.done.len(), "variant"),
            count(self.computed(), "node"),
        );
        let time = time_text(ms);
        let mut text = format!(
            "\n{variants}: {}; {nodes} computed in {time}\n",
            parts.join(", ")
        );
        if self.desk.variants.repeated > 0 {
            let repeated = count(self.desk.variants.repeated, "variant");
            text.push_str(&format!("{repeated} equal to others left out\n"));
        }
        if written {
            text.push_str(&format!("{}\n", self.desk.out.join(TABLE).display()));
        } else {
            text.push_str("`tessgraph study collect` makes the table when all shards are done\n");
        }
        printable(&text).into_owned()
    }

    fn computed(&self) -> usize {
        let made = self.done.iter().filter(|(_, _, reused)| !reused);
        made.map(|(_, record, _)| record.computed).sum()
    }

    fn json(&self, ms: f64, ok: bool, written: bool) -> String {
        let variants: Vec<Json> = self
            .done
            .iter()
            .map(|done| self.variant_json(done))
            .collect();
        let table = self.desk.out.join(TABLE);
        let report = json!({
            "ok": ok,
            "ms": number((ms * 1000.0).round() / 1000.0),
            "computed": self.computed(),
            "variants": variants,
            "table": written.then(|| table.to_string_lossy()),
        });
        format!("{}\n", line(&report))
    }

    fn variant_json(&self, (variant, record, reused): &(&Variant, Record, bool)) -> Json {
        let values = variant.values.iter();
        let values: Map<_, _> = values
            .map(|(name, value)| (name.clone(), as_json(value)))
            .collect();
        let names = self.desk.study.measures().map(|(name, _)| name.to_owned());
        let measures: Map<_, _> = names.zip(record.measures.iter().cloned()).collect();
        json!({
            "id": variant.id,
            "parameters": values,
            "status": if record.error.is_some() { "failed" } else { "ok" },
            "reused": reused,
            "computed": if *reused { 0 } else { record.computed },
            "ms": number((record.ms * 1000.0).round() / 1000.0),
            "measures": measures,
            "error": record.error,
        })
    }
}
