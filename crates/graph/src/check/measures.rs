//! Measures: numbers and conditions over a graph's results that stand outside it.

use super::inputs::Checker;
use super::scope::Scope;
use crate::document::{Problems, Text};
use crate::expr::Scalar;
use crate::plan::{Origin, PlanMeasure};

/// The measures in order, in the graph's units; those with problems are left
/// out.
pub(super) fn check(
    scope: &Scope<'_>,
    measures: &[(Text, Text)],
    problems: &mut Problems,
) -> Vec<PlanMeasure> {
    let mut checked = Vec::with_capacity(measures.len());
    for (name, text) in measures {
        let mut checker = Checker {
            scope,
            node: "",
            problems,
        };
        let origin = match checker.number_or_condition(&name.value, text) {
            Some(Scalar::Known(value)) => Origin::Constant(value),
            Some(Scalar::Later(expression)) => Origin::Expression(expression),
            None => continue,
        };
        checked.push(PlanMeasure {
            name: name.value.clone(),
            origin,
        });
    }
    checked
}
