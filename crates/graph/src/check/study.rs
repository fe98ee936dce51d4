//! Studies: one graph with many values of its parameters.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use tessgraph_geometry::digest::{Digest, Hasher};
use tessgraph_geometry::random::uniform;

use super::arguments::Wanted;
use super::axis::spread;
use super::inputs::Checker;
use super::scope::{Givings, Scope};
use super::{Loaded, Measured, load_prepared};
use crate::diagnostic::{Diagnostic, Source};
use crate::document::{
    self, Document, Fields, Item, Number, ParamKind, Problems, Shape, StudyDocument, Text,
};
use crate::names::{did_you_mean, quoted, shown};
use crate::node::NodeSpec;
use crate::value::Value;
use crate::world::World;

/// More variants than these would not end.
const MAX_VARIANTS: usize = 100_000;

/// A study as read from its file.
#[derive(Debug)]
pub struct Study {
    document: StudyDocument,
}

/// The graph of a study: what its reader knows it by, and its text.
#[derive(Debug, Clone, Copy)]
pub struct StudyGraph<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its bytes.
    pub bytes: &'a [u8],
    /// The nodes there are.
    pub registry: &'static [NodeSpec],
}

/// A combination of values.
#[derive(Debug, Clone)]
pub struct Variant {
    /// Hash of all values that the study gives: the same in every study that
    /// gives the same.
    pub id: String,
    /// Parameters with their values as a graph file writes them: those of the
    /// axes in their order.
    pub values: Vec<(String, Value)>,
}

/// All variants of a study.
#[derive(Debug)]
pub struct Variants {
    /// The parameters that vary, in the order of the axes.
    pub names: Vec<String>,
    /// What all variants share, in file order.
    pub fixed: Vec<(String, Value)>,
    /// The variants, the last axis varying fastest; each once.
    pub list: Vec<Variant>,
    /// How many were left out because they equal another one.
    pub repeated: usize,
}

/// The values of some parameters: their places in the document.
type Point = Vec<(usize, Value)>;

impl Study {
    /// Reads a study file; `name` is what its reader knows it by.
    ///
    /// # Errors
    /// Everything that is wrong with it by itself.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, Vec<Diagnostic>> {
        let document = document::read_study(name, bytes)?;
        Ok(Self { document })
    }

    /// The path of its graph, from the study's folder.
    pub fn graph(&self) -> &str {
        &self.document.graph.value
    }

    /// An error at the name of its graph.
    pub fn graph_error(&self, message: impl Into<String>) -> Diagnostic {
        let (source, span) = (&self.document.source, self.document.graph.span.clone());
        Diagnostic::error("unreadable", source, span, message, "this path")
            .with_help("the path is named from the study's folder")
    }

    /// The outputs of the graph that are kept.
    pub fn keep(&self) -> impl Iterator<Item = &str> {
        self.document.keep.iter().map(|text| text.value.as_str())
    }

    /// The measures: names and expressions.
    pub fn measures(&self) -> impl Iterator<Item = (&str, &str)> {
        let measures = self.document.measures.iter();
        measures.map(|(name, text)| (name.value.as_str(), text.value.as_str()))
    }

    /// All variants, in the order of the axes.
    ///
    /// # Errors
    /// Everything in the study that does not fit the graph's parameters.
    pub fn variants(&self, graph: StudyGraph<'_>) -> Result<Variants, Vec<Diagnostic>> {
        let (document, problems) = document::read(graph.name, graph.bytes)?;
        if problems.count() > 0 {
            return Err(problems.into_sorted());
        }
        let mut problems = Problems::new(&self.document.source);
        let result = self.combine(&document, &mut problems);
        match result {
            Some(variants) if problems.count() == 0 => Ok(variants),
            _ => Err(problems.into_sorted()),
        }
    }

    /// The plan of the graph with the values of a variant, or with those that
    /// all variants share, and with the study's measures.
    pub fn load(
        &self,
        graph: StudyGraph<'_>,
        values: &[(String, Value)],
        world: &dyn World,
    ) -> Loaded {
        let mut prepare = |document: &mut Document, _: &mut Problems| {
            for (name, value) in values {
                let mut params = document.params.iter_mut();
                if let Some(param) = params.find(|param| param.name.value == *name) {
                    param.value = Some(value.clone());
                }
            }
        };
        let measured = Measured {
            source: &self.document.source,
            measures: &self.document.measures,
        };
        let mut loaded = load_prepared(graph, &mut prepare, Some(&measured), world);
        if let Ok(plan) = &loaded.plan {
            let paths: Vec<&str> = plan
                .outputs
                .iter()
                .map(|output| output.path.as_str())
                .collect();
            let problems = self.unknown_outputs(&paths);
            if !problems.is_empty() {
                loaded.plan = Err(problems);
            }
        }
        loaded
    }

    fn unknown_outputs(&self, paths: &[&str]) -> Vec<Diagnostic> {
        let unknown = self
            .document
            .keep
            .iter()
            .filter(|text| !paths.contains(&text.value.as_str()));
        let problem = |text: &Text| {
            let message = format!("the graph has no output `{}`", shown(&text.value));
            let source = &self.document.source;
            let error = Diagnostic::error(
                "unknown_output",
                source,
                text.span.clone(),
                message,
                "not known",
            );
            let help = did_you_mean(&text.value, paths.iter().copied());
            error.with_help(help.unwrap_or_else(|| {
                format!("its outputs are {}", quoted(paths.iter().copied(), 10))
            }))
        };
        unknown.map(problem).collect()
    }

    fn combine(&self, document: &Document, problems: &mut Problems) -> Option<Variants> {
        let empty = Document::empty(&self.document.source, document.units);
        let given = Givings::default();
        let scope = Scope::new(&empty, &given, "", problems);
        let mut reader = Reader {
            document,
            checker: Checker {
                scope: &scope,
                node: "study",
                problems,
            },
            taken: Vec::new(),
        };
        let fixed = reader.fixed(&self.document.set);
        let axes = reader.axes(&self.document.axes);
        let (fixed, axes) = (fixed?, axes?);
        let count = axes
            .iter()
            .try_fold(1_usize, |count, axis| count.checked_mul(axis.len()));
        let Some(count) = count.filter(|count| *count <= MAX_VARIANTS) else {
            let message = format!("the study has more than {MAX_VARIANTS} variants");
            let span = self.document.head.clone();
            let error = problems.error("too_large", &span, message, "this study");
            problems.add(error.with_help("give fewer values, or sample with `LatinHypercube`"));
            return None;
        };
        Some(variants(document, &fixed, &axes, count))
    }
}

/// All combinations, without those that equal an earlier one.
fn variants(document: &Document, fixed: &Point, axes: &[Vec<Point>], count: usize) -> Variants {
    let name = |param: usize| document.params[param].name.value.clone();
    let named = |point: &[(usize, Value)]| -> Vec<(String, Value)> {
        point
            .iter()
            .map(|(param, value)| (name(*param), value.clone()))
            .collect()
    };
    let (mut list, mut known) = (Vec::with_capacity(count), BTreeSet::new());
    for index in 0..count {
        let mut points = Vec::with_capacity(axes.len());
        let mut rest = index;
        for axis in axes.iter().rev() {
            points.push(axis[rest % axis.len()].as_slice());
            rest /= axis.len();
        }
        points.reverse();
        let values = named(&points.concat());
        let id = identity(values.iter().chain(&named(fixed)));
        if known.insert(id.clone()) {
            list.push(Variant { id, values });
        }
    }
    let first = axes.iter().filter_map(|axis| axis.first());
    Variants {
        names: first.flatten().map(|(param, _)| name(*param)).collect(),
        fixed: named(fixed),
        repeated: count - list.len(),
        list,
    }
}

/// Hash of values, whatever their order.
fn identity<'v>(values: impl Iterator<Item = &'v (String, Value)>) -> String {
    let mut values: Vec<(&str, Digest)> = values
        .map(|(name, value)| (name.as_str(), value.digest()))
        .collect();
    values.sort_unstable_by_key(|(name, _)| *name);
    let mut hasher = Hasher::new();
    for (name, digest) in values {
        hasher.text(name).digest(digest);
    }
    hasher.finish().to_string()[..16].to_owned()
}

/// Reads the values of a study for the parameters of its graph.
struct Reader<'a, 'p> {
    document: &'a Document,
    checker: Checker<'a, 'p>,
    /// Parameters that have values already, with the places of their names.
    taken: Vec<(usize, Range<usize>)>,
}

impl Reader<'_, '_> {
    /// The parameter of that name, which nothing else gives a value.
    fn param(&mut self, name: &Text) -> Option<usize> {
        let params = &self.document.params;
        let names = params.iter().map(|param| param.name.value.as_str());
        let found = params
            .iter()
            .position(|param| param.name.value == name.value);
        let Some(found) = found else {
            let message = format!("the graph has no parameter `{}`", shown(&name.value));
            let help = did_you_mean(&name.value, names.clone())
                .unwrap_or_else(|| format!("its parameters are {}", quoted(names, 10)));
            self.checker
                .report("unknown_name", &name.span, message, "not known", help);
            return None;
        };
        if let Some((_, first)) = self.taken.iter().find(|(param, _)| *param == found) {
            let message = format!("`{}` is given twice", shown(&name.value));
            let problems = &mut *self.checker.problems;
            let error = problems.error("duplicate_name", &name.span, message, "again here");
            let error = error.with_label(first.clone(), "first given here");
            problems.add(error.with_help("remove one of them"));
            return None;
        }
        self.taken.push((found, name.span.clone()));
        Some(found)
    }

    fn wanted(&self, param: usize) -> Wanted<'_> {
        Wanted {
            param: &self.document.params[param],
            document: self.document,
        }
    }

    fn fixed(&mut self, set: &[(Text, Item)]) -> Option<Point> {
        let mut point = Vec::new();
        let mut sound = true;
        for (name, item) in set {
            let value = self.param(name).and_then(|param| {
                let document = self.document;
                let wanted = Wanted {
                    param: &document.params[param],
                    document,
                };
                Some((param, self.checker.known_argument(wanted, item)?.0))
            });
            sound &= value.is_some();
            point.extend(value);
        }
        sound.then_some(point)
    }

    fn axes(&mut self, axes: &[(Text, Item)]) -> Option<Vec<Vec<Point>>> {
        let mut all = Vec::new();
        let mut sound = true;
        for (name, item) in axes {
            let axis = match self.checker.axis_fields(item) {
                Some((kind, _)) if kind == "LatinHypercube" => self.hypercube(item),
                Some(_) => self.plain_axis(name, item),
                None => None,
            };
            sound &= axis.is_some();
            all.extend(axis);
        }
        sound.then_some(all)
    }

    fn plain_axis(&mut self, name: &Text, item: &Item) -> Option<Vec<Point>> {
        let param = self.param(name)?;
        let document = self.document;
        let wanted = Wanted {
            param: &document.params[param],
            document,
        };
        let values = self.checker.axis(wanted, item, MAX_VARIANTS)?;
        let points = values.into_iter().map(|(value, _)| vec![(param, value)]);
        Some(points.collect())
    }

    /// `LatinHypercube(count: 20, seed: 1, over: {"a": Range(from: 0, to: 1), ...})`:
    /// each parameter's range is cut into `count` slices, and each slice is met
    /// exactly once (McKay, Beckman and Conover 1979).
    fn hypercube(&mut self, item: &Item) -> Option<Vec<Point>> {
        let (_, written) = self.checker.axis_fields(item)?;
        let text = self.checker.scope.text;
        let known = ["count", "seed", "over"];
        let owner = "a LatinHypercube";
        let fields = Fields::new(text, written, &known, owner, self.checker.problems);
        let count = self.checker.needed(&fields, "count", item)?;
        let count = self.checker.known_count("count", count, 1..=MAX_VARIANTS)?;
        let seed = self.checker.seed(fields.get("seed"))?;
        let over = self.checker.needed(&fields, "over", item)?;
        let Shape::Map(entries) = &over.shape else {
            let message = format!("`over` takes a map, not {}", over.label(text));
            let help = "write `over: {\"parameter\": Range(from: 0, to: 1)}`";
            self.checker
                .report("wrong_kind", &over.span, message, "here", help);
            return None;
        };
        let mut points = vec![Point::new(); count];
        for (number, (key, range)) in entries.iter().enumerate() {
            let Some(name) = key.text(text) else {
                let message = format!("a parameter is named by a text, not {}", key.label(text));
                self.checker.report(
                    "wrong_kind",
                    &key.span,
                    message,
                    "here",
                    "write it in quotes",
                );
                return None;
            };
            let shares = shares(count, seed, number as u64);
            let param = self.param(&name)?;
            for (point, value) in points.iter_mut().zip(self.sampled(param, range, &shares)?) {
                point.push((param, value));
            }
        }
        Some(points)
    }

    /// The values at these shares of a range or list.
    fn sampled(&mut self, param: usize, item: &Item, shares: &[f64]) -> Option<Vec<Value>> {
        let document = self.document;
        let wanted = Wanted {
            param: &document.params[param],
            document,
        };
        let (kind, written) = self.checker.axis_fields(item)?;
        if kind != "Range" {
            let values = self.checker.axis(wanted, item, MAX_VARIANTS)?;
            let last = values.len() - 1;
            let at = |share: &f64| ((share * values.len() as f64) as usize).min(last);
            return Some(
                shares
                    .iter()
                    .map(|share| values[at(share)].0.clone())
                    .collect(),
            );
        }
        let text = self.checker.scope.text;
        let fields = Fields::new(
            text,
            written,
            &["from", "to"],
            "a Range",
            self.checker.problems,
        );
        let (from, to) = self.checker.ends(wanted, item, &fields)?;
        let whole = self.wanted(param).param.kind == ParamKind::Integer;
        let number = |share: &f64| Number::Real(spread(from, to, whole, *share));
        let values: Vec<Option<Value>> = shares
            .iter()
            .map(|share| self.checker.crossing(wanted, number(share), &item.span))
            .collect();
        values.into_iter().collect()
    }
}

/// One share of 0..1 from each of `count` equal slices, in random order.
fn shares(count: usize, seed: u64, dimension: u64) -> Vec<f64> {
    let seed = seed.wrapping_mul(0x1_0001).wrapping_add(dimension);
    let mut slices: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        // Fisher and Yates: each order has the same chance.
        let other = (uniform(seed, last as i64) * (last + 1) as f64) as usize;
        slices.swap(last, other.min(last));
    }
    let inside = |slice: usize| uniform(seed, -1 - slice as i64);
    let share = |slice: usize| (slice as f64 + inside(slice)) / count as f64;
    slices.into_iter().map(share).collect()
}

impl Document {
    /// A graph with nothing in it, for expressions that stand in no graph.
    fn empty(source: &Arc<Source>, units: crate::Units) -> Self {
        Self {
            source: Arc::clone(source),
            units,
            params: Vec::new(),
            inputs: Vec::new(),
            nodes: Vec::new(),
            outputs: Vec::new(),
            outputs_damaged: false,
            results: Vec::new(),
            head: 0..0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hypercube_meets_every_slice_once() {
        for (count, seed) in [(1, 0), (7, 3), (100, 42)] {
            let mut slices: Vec<usize> = shares(count, seed, 0)
                .iter()
                .map(|share| (share * count as f64) as usize)
                .collect();
            assert_ne!(shares(count, seed, 0), shares(count, seed, 1));
            slices.sort_unstable();
            assert_eq!(slices, (0..count).collect::<Vec<_>>());
        }
    }
}
