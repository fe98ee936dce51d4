//! Warnings that are counted instead of repeated.

use crate::text;

/// How often something happened, and where first.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counted {
    count: usize,
    first: usize,
}

impl Counted {
    /// Notes one more, at byte `at` of the file.
    pub(crate) fn note(&mut self, at: usize) {
        if self.count == 0 {
            self.first = at;
        }
        self.count += 1;
    }

    /// Adds what was counted further behind in the file.
    pub(crate) fn append(&mut self, behind: Self) {
        if self.count == 0 {
            self.first = behind.first;
        }
        self.count += behind.count;
    }

    /// The first byte noted, if any was.
    pub(crate) fn first(&self) -> Option<usize> {
        (self.count > 0).then_some(self.first)
    }

    /// Adds "3 {what}, first on line 12" to `warnings`, if there is any.
    pub(crate) fn report(&self, bytes: &[u8], what: [&str; 2], warnings: &mut Vec<String>) {
        if self.count > 0 {
            let counted = count(self.count, what);
            warnings.push(format!(
                "{counted}, first on line {}",
                line(bytes, self.first)
            ));
        }
    }
}

/// "1 {one}" or "3 {many}".
pub(crate) fn count(n: usize, [one, many]: [&str; 2]) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// The line that byte `at` is on.
pub(crate) fn line(bytes: &[u8], at: usize) -> usize {
    match text::place(bytes, at) {
        crate::Place::Line { line, .. } => line,
        _ => 0,
    }
}
