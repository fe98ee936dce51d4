//! Axes: several values for one parameter of another graph.

use tessgraph_geometry::random::uniform;

use super::arguments::{Argument, Wanted};
use super::inputs::Checker;
use crate::document::{Field, Fields, Item, Number, ParamKind, Shape, plain};
use crate::names::{did_you_mean, shown};
use crate::value::Value;

/// A value of an axis, and the folder a path is named from.
pub(super) type AxisValue = (Value, Option<String>);

/// The kinds of axis and their fields.
const AXES: [(&str, &[&str]); 3] = [
    ("Linspace", &["from", "to", "count"]),
    ("Values", &["of"]),
    ("Random", &["from", "to", "count", "seed"]),
];

/// Whole numbers that a range of random ones may span.
const MAX_SPAN: f64 = 9_007_199_254_740_992.0;

impl Checker<'_, '_> {
    /// The values of an axis for a parameter of another graph, at most `most`.
    pub(super) fn axis(
        &mut self,
        wanted: Wanted<'_>,
        item: &Item,
        most: usize,
    ) -> Option<Vec<AxisValue>> {
        let (name, fields) = self.axis_fields(item)?;
        let text = self.scope.text;
        let known = AXES.iter().find(|(other, _)| *other == name);
        let Some((name, known)) = known else {
            self.unknown_axis(&name, item);
            return None;
        };
        let owner = format!("a {name} axis");
        let fields = Fields::new(text, fields, known, &owner, self.problems);
        let values = match *name {
            "Linspace" => self.linspace(wanted, item, &fields, most)?,
            "Random" => self.random(wanted, item, &fields, most)?,
            _ => return self.values(wanted, item, &fields, most),
        };
        let values: Vec<Option<Value>> = values
            .into_iter()
            .map(|number| self.crossing(wanted, Number::Real(number), &item.span))
            .collect();
        values
            .into_iter()
            .map(|value| Some((value?, None)))
            .collect()
    }

    /// The name and the fields of `Name(field: value)`.
    pub(super) fn axis_fields<'i>(&mut self, item: &'i Item) -> Option<(String, &'i [Field])> {
        let text = self.scope.text;
        let (name, fields): (_, &[Field]) = match &item.shape {
            Shape::Struct(fields) => (fields.name.as_ref(), &fields.fields),
            Shape::Tuple(tuple) if tuple.items.is_empty() => (tuple.name.as_ref(), &[]),
            _ => (None, &[]),
        };
        if let Some(name) = name {
            return Some((plain(text, name).to_owned(), fields));
        }
        let message = format!("an axis cannot be {}", item.label(text));
        let help = "write `Linspace(from: 0, to: 1, count: 5)` or `Values(of: [0, 1])`";
        self.report("wrong_kind", &item.span, message, "here", help);
        None
    }

    fn unknown_axis(&mut self, name: &str, item: &Item) {
        let names = AXES.iter().map(|(name, _)| *name);
        let message = format!("there is no axis `{}` here", shown(name));
        let help = did_you_mean(name, names)
            .unwrap_or_else(|| "axes are `Linspace`, `Values` and `Random`".to_owned());
        self.report("unknown_kind", &item.span, message, "not known", help);
    }

    /// A field that must be there.
    pub(super) fn needed<'i>(
        &mut self,
        fields: &Fields<'i, '_>,
        name: &str,
        item: &Item,
    ) -> Option<&'i Item> {
        let found = fields.get(name);
        if found.is_none() {
            let message = format!("`{name}` is missing");
            let help = format!("add `{name}: ...`");
            self.report("missing_input", &item.span, message, "not given", help);
        }
        found
    }

    /// Evenly spaced numbers, both ends among them.
    fn linspace(
        &mut self,
        wanted: Wanted<'_>,
        item: &Item,
        fields: &Fields<'_, '_>,
        most: usize,
    ) -> Option<Vec<f64>> {
        let (from, to) = self.ends(wanted, item, fields)?;
        let count = self.needed(fields, "count", item)?;
        let count = self.known_count("count", count, 1..=most)?;
        let last = (count - 1).max(1) as f64;
        // Both ends weighted: 0.1 to 0.3 in three steps has 0.2 in its middle.
        let at = |index: usize| (from * (last - index as f64) + to * index as f64) / last;
        Some((0..count).map(at).collect())
    }

    /// Numbers drawn evenly between two ends.
    fn random(
        &mut self,
        wanted: Wanted<'_>,
        item: &Item,
        fields: &Fields<'_, '_>,
        most: usize,
    ) -> Option<Vec<f64>> {
        let (from, to) = self.ends(wanted, item, fields)?;
        let count = self.needed(fields, "count", item)?;
        let count = self.known_count("count", count, 1..=most)?;
        let seed = self.seed(fields.get("seed"))?;
        let whole = wanted.param.kind == ParamKind::Integer;
        let draw = |index: usize| spread(from, to, whole, uniform(seed, index as i64));
        Some((0..count).map(draw).collect())
    }

    /// The seed of random numbers; 0 where none is given.
    pub(super) fn seed(&mut self, item: Option<&Item>) -> Option<u64> {
        match item {
            Some(item) => Some(self.known_count("seed", item, 0..=u32::MAX as usize)? as u64),
            None => Some(0),
        }
    }

    /// `from` and `to` of an axis of numbers.
    pub(super) fn ends(
        &mut self,
        wanted: Wanted<'_>,
        item: &Item,
        fields: &Fields<'_, '_>,
    ) -> Option<(f64, f64)> {
        let param = wanted.param;
        if !matches!(param.kind, ParamKind::Number | ParamKind::Integer) {
            let (name, kind) = (shown(&param.name.value), param.kind.label());
            let message = format!("`{name}` takes {kind}, which is not between two numbers");
            let error = self
                .problems
                .error("wrong_kind", &item.span, message, "numbers");
            let error = error.with_places([wanted.declared()]);
            let error = error.with_help("list its values: `Values(of: [...])`");
            self.problems.add(error.with_node(self.node));
            return None;
        }
        let from = self.needed(fields, "from", item);
        let to = self.needed(fields, "to", item);
        let from = from.and_then(|from| self.known_number("from", from));
        let to = to.and_then(|to| self.known_number("to", to));
        let (from, to) = (from?, to?);
        if (to - from).abs() < MAX_SPAN {
            return Some((from, to));
        }
        let message = format!("the span from {from} to {to} is too large");
        self.report(
            "out_of_range",
            &item.span,
            message,
            "here",
            "choose nearer ends",
        );
        None
    }

    /// Values one by one.
    fn values(
        &mut self,
        wanted: Wanted<'_>,
        item: &Item,
        fields: &Fields<'_, '_>,
        most: usize,
    ) -> Option<Vec<AxisValue>> {
        let of = self.needed(fields, "of", item)?;
        let Shape::List(items) = &of.shape else {
            let message = format!("`of` takes a list, not {}", of.label(self.scope.text));
            self.report(
                "wrong_kind",
                &of.span,
                message,
                "here",
                "write `of: [a, b]`",
            );
            return None;
        };
        if items.is_empty() || items.len() > most {
            let message = format!("`of` takes 1 to {most} values, not {}", items.len());
            let help = "give at least one value";
            self.report("wrong_length", &of.span, message, "here", help);
            return None;
        }
        let values: Vec<Option<AxisValue>> = items
            .iter()
            .map(|item| self.known_argument(wanted, item))
            .collect();
        values.into_iter().collect()
    }

    /// What `item` gives to a parameter, which must be known before anything
    /// runs.
    pub(super) fn known_argument(&mut self, wanted: Wanted<'_>, item: &Item) -> Option<AxisValue> {
        match self.argument(wanted, item)? {
            Argument::Known(value, folder) => Some((value, folder)),
            Argument::Later(_) => {
                let message = "this must be known before anything runs";
                let help = "let it depend on parameters only, not on nodes";
                self.report(
                    "not_known_yet",
                    &item.span,
                    message,
                    "depends on a node",
                    help,
                );
                None
            }
        }
    }
}

/// The number a `share` of the way between two ends, a whole one if wanted: then
/// each has the same chance, both ends included.
pub(super) fn spread(from: f64, to: f64, whole: bool, share: f64) -> f64 {
    if !whole {
        return from * (1.0 - share) + to * share;
    }
    let (low, high) = (from.min(to).ceil(), from.max(to).floor());
    (low + (share * (high - low + 1.0)).floor()).min(high)
}
