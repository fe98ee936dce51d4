//! How far a study is, for people.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tessgraph_graph::study::Variant;

use super::record::Record;
use crate::text::time_text;

/// A bar over the variants with the time that is left.
pub(super) struct Progress {
    bar: ProgressBar,
    /// Variants whose times are known, those of earlier runs among them.
    known: usize,
    /// Milliseconds these took.
    ms: f64,
}

impl Progress {
    pub(super) fn new(variants: usize, live: bool) -> Self {
        let target = if live {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(variants as u64), target);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {pos}/{len} {wide_msg}") {
            bar.set_style(style);
        }
        Self {
            bar,
            known: 0,
            ms: 0.0,
        }
    }

    pub(super) fn finished(&mut self, variant: &Variant, record: &Record, reused: bool) {
        self.known += 1;
        self.ms += record.ms;
        self.bar.inc(1);
        let length = self.bar.length().unwrap_or(0);
        let left = length.saturating_sub(self.bar.position()) as f64;
        let mean = self.ms / self.known as f64;
        let what = if reused { "there already" } else { "made" };
        let left = time_text(left * mean);
        self.bar
            .set_message(format!("{} {what}, about {left} left", variant.id));
    }

    pub(super) fn end(&mut self) {
        self.bar.finish_and_clear();
    }
}
