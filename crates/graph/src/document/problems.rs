//! Collects what is wrong, so that all of it is reported at once.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Source};

/// The problems found so far in one text.
#[derive(Debug)]
pub(crate) struct Problems {
    source: Arc<Source>,
    found: Vec<Diagnostic>,
}

impl Problems {
    pub(crate) fn new(source: &Arc<Source>) -> Self {
        Self {
            source: Arc::clone(source),
            found: Vec::new(),
        }
    }

    /// The text they are in.
    pub(crate) fn source(&self) -> &Source {
        &self.source
    }

    /// An error at `span` with a remark there; [`Problems::add`] keeps it.
    pub(crate) fn error(
        &self,
        code: &'static str,
        span: &Range<usize>,
        message: impl Into<String>,
        remark: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::error(code, &self.source, span.clone(), message, remark)
    }

    /// An error that has no place in the text.
    pub(crate) fn placeless(&self, code: &'static str, message: impl Into<String>) -> Diagnostic {
        let mut error = self.error(code, &(0..0), message, "");
        error.labels.clear();
        error
    }

    pub(crate) fn add(&mut self, problem: Diagnostic) {
        self.found.push(problem);
    }

    pub(crate) fn extend(&mut self, problems: impl IntoIterator<Item = Diagnostic>) {
        self.found.extend(problems);
    }

    pub(crate) fn count(&self) -> usize {
        self.found.len()
    }

    /// All problems in the order of their places; those without a place first.
    pub(crate) fn into_sorted(mut self) -> Vec<Diagnostic> {
        self.found
            .sort_by_key(|problem| problem.labels.first().map(|label| label.span.start));
        self.found
    }
}
