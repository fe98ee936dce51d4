//! Reads the named fields of a section: each once, none unknown.

use std::ops::Range;

use super::problems::Problems;
use super::raw::{Field, Item, plain};
use crate::names::{did_you_mean, quoted, shown};

/// The fields of one group, taken out by name.
pub(crate) struct Fields<'a, 'k> {
    source: &'a str,
    fields: &'a [Field],
    known: &'k [&'k str],
}

impl<'a, 'k> Fields<'a, 'k> {
    /// Reports fields that are repeated or not among `known`; `owner` says
    /// whose fields they are: "a graph", "a Number parameter".
    pub(crate) fn new(
        source: &'a str,
        fields: &'a [Field],
        known: &'k [&'k str],
        owner: &str,
        problems: &mut Problems,
    ) -> Self {
        let mut seen: Vec<(&str, Range<usize>)> = Vec::new();
        for field in fields {
            let name = plain(source, &field.name);
            if !known.contains(&name) {
                problems.add(unknown(name, &field.name, known, owner, problems));
            } else if let Some((_, first)) = seen.iter().find(|(other, _)| *other == name) {
                let message = format!("`{name}` is given twice");
                let error = problems.error("duplicate_name", &field.name, message, "again here");
                problems.add(
                    error
                        .with_label(first.clone(), "first given here")
                        .with_help("remove one of them"),
                );
            } else {
                seen.push((name, field.name.clone()));
            }
        }
        Self {
            source,
            fields,
            known,
        }
    }

    /// The value of the field of that name, the first if it is repeated.
    pub(crate) fn get(&self, name: &str) -> Option<&'a Item> {
        debug_assert!(
            self.known.contains(&name),
            "{name} is not among the known fields"
        );
        let field = self
            .fields
            .iter()
            .find(|field| plain(self.source, &field.name) == name);
        field.map(|field| &field.value)
    }
}

fn unknown(
    name: &str,
    span: &Range<usize>,
    known: &[&str],
    owner: &str,
    problems: &Problems,
) -> crate::Diagnostic {
    let message = format!("{owner} has no field `{}`", shown(name));
    let help = did_you_mean(name, known.iter().copied())
        .unwrap_or_else(|| format!("its fields are {}", quoted(known.iter().copied(), 12)));
    problems
        .error("unknown_field", span, message, "not known")
        .with_help(help)
}
