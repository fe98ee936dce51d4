//! Reads declarations of parameters: what a graph can be asked to vary.

use std::ops::Range;

use tessgraph_geometry::Quantity;

use super::Spanned;
use super::fields::Fields;
use super::parameter::{KINDS, ParamKind, Parameter};
use super::problems::Problems;
use super::raw::{Item, Number, Shape, plain};
use crate::expr::Target;
use crate::names::{alternatives, did_you_mean, listing, shown};
use crate::units::Units;
use crate::value::{Kind, Value};

/// Kinds of graph inputs that only another graph can give.
const GIVEN: [(&str, Kind); 6] = [
    ("Mesh", Kind::Mesh),
    ("Directions", Kind::Directions),
    ("Field", Kind::Field),
    ("Vector", Kind::Vector),
    ("Report", Kind::Report),
    ("Table", Kind::Table),
];

const QUANTITIES: [(&str, Quantity); 5] = [
    ("Length", Quantity::Length),
    ("Area", Quantity::Area),
    ("Volume", Quantity::Volume),
    ("Angle", Quantity::Angle),
    ("Number", Quantity::Number),
];

/// Reads a parameter's declaration or bare value.
pub(super) fn read(
    text: &str,
    name: &Spanned<String>,
    item: &Item,
    units: Units,
    problems: &mut Problems,
) -> Option<Parameter> {
    let mut reader = Reader {
        text,
        units,
        problems,
    };
    match declared_kind(text, item) {
        Some((span, kind_name)) => match KINDS.iter().find(|(other, _)| *other == kind_name) {
            Some((_, kind)) => Some(reader.declared(name, *kind, item, true)),
            None => {
                reader.unknown_kind(&span, kind_name, &[]);
                None
            }
        },
        None => reader.bare(name, item),
    }
}

/// An input of the graph as read.
pub(super) enum ReadInput {
    /// One that can be a parameter, and whether it has a default.
    Param(Box<Parameter>, bool),
    /// A value that only another graph can give.
    Value(Kind, Quantity),
    /// Nothing sensible, as reported.
    Unknown,
}

impl ReadInput {
    pub(super) fn has_default(&self) -> bool {
        matches!(self, Self::Param(_, true))
    }
}

/// Reads an input of the graph.
pub(super) fn read_input(
    text: &str,
    name: &Spanned<String>,
    item: &Item,
    units: Units,
    problems: &mut Problems,
) -> ReadInput {
    let Some((span, kind_name)) = declared_kind(text, item) else {
        let bare = read(text, name, item, units, problems);
        return bare.map_or(ReadInput::Unknown, |param| {
            ReadInput::Param(Box::new(param), true)
        });
    };
    let mut reader = Reader {
        text,
        units,
        problems,
    };
    if let Some((_, kind)) = KINDS.iter().find(|(other, _)| *other == kind_name) {
        let param = reader.declared(name, *kind, item, false);
        return ReadInput::Param(Box::new(param), has_field(text, item, "default"));
    }
    if let Some((given, kind)) = GIVEN.iter().find(|(other, _)| *other == kind_name) {
        return ReadInput::Value(*kind, reader.given(given, *kind, item));
    }
    reader.unknown_kind(&span, kind_name, &GIVEN);
    ReadInput::Unknown
}

/// The kind that a declaration names: `Number` in `Number(default: 1)`.
fn declared_kind<'t>(text: &'t str, item: &Item) -> Option<(Range<usize>, &'t str)> {
    let span = match &item.shape {
        Shape::Struct(fields) => fields.name.clone()?,
        Shape::Tuple(tuple) => tuple.name.clone()?,
        _ => return None,
    };
    let name = plain(text, &span);
    Some((span, name))
}

fn has_field(text: &str, item: &Item, name: &str) -> bool {
    match &item.shape {
        Shape::Struct(fields) => fields
            .fields
            .iter()
            .any(|field| plain(text, &field.name) == name),
        _ => false,
    }
}

struct Reader<'a> {
    text: &'a str,
    units: Units,
    problems: &'a mut Problems,
}

impl Reader<'_> {
    fn report(&mut self, code: &'static str, span: &Range<usize>, message: String, help: &str) {
        let error = self.problems.error(code, span, message, "here");
        self.problems.add(error.with_help(help));
    }

    /// Reports a kind that is none of a parameter's, nor of `given`.
    fn unknown_kind(&mut self, span: &Range<usize>, name: &str, given: &[(&str, Kind)]) {
        let kinds = KINDS.iter().map(|(name, _)| *name);
        let kinds = kinds.chain(given.iter().map(|(name, _)| *name));
        let help = did_you_mean(name, kinds.clone())
            .unwrap_or_else(|| format!("it is {}", alternatives(kinds)));
        let message = format!("there is no kind of parameter `{}`", shown(name));
        self.report("unknown_kind", span, message, &help);
    }

    /// What the numbers of a `Mesh()`, `Field(unit: Length)`, ... measure.
    fn given(&mut self, name: &str, kind: Kind, item: &Item) -> Quantity {
        let fields = match &item.shape {
            Shape::Struct(fields) => fields.fields.as_slice(),
            _ => &[],
        };
        let known: &[&str] = match kind {
            Kind::Field | Kind::Vector => &["unit", "about"],
            _ => &["about"],
        };
        let owner = format!("a {name} input");
        let fields = Fields::new(self.text, fields, known, &owner, self.problems);
        self.about(fields.get("about"));
        match kind {
            Kind::Field | Kind::Vector => fields
                .get("unit")
                .map_or(Quantity::Number, |unit| self.quantity(unit)),
            _ => Quantity::Number,
        }
    }

    fn about(&mut self, about: Option<&Item>) -> Option<String> {
        let about = about?;
        let text = about.text(self.text).map(|text| text.value);
        if text.is_none() {
            let message = format!("`about` takes a text, not {}", about.label(self.text));
            self.report("wrong_kind", &about.span, message, "write it in quotes");
        }
        text
    }

    /// `"smooth": 20` is a parameter whose value says its kind.
    fn bare(&mut self, name: &Spanned<String>, item: &Item) -> Option<Parameter> {
        let kind = match (&item.shape, item.number(self.text)) {
            (_, Some(Number::Whole(_))) => ParamKind::Integer,
            (_, Some(Number::Real(_))) => ParamKind::Number,
            (Shape::Text, _) => ParamKind::Text,
            (Shape::Name, _) if matches!(item.name(self.text), Some("true" | "false")) => {
                ParamKind::Bool
            }
            (Shape::Name, _) => {
                let name = shown(item.name(self.text).unwrap_or_default());
                let message = format!("what `{name}` is chosen from is not stated");
                let help = format!("write `Choice(default: {name}, of: [{name}, ...])`");
                self.report("wrong_kind", &item.span, message, &help);
                return None;
            }
            _ => {
                let message = format!("a parameter cannot be {}", item.label(self.text));
                let help = "parameters are numbers, true or false, texts, paths and choices";
                self.report("wrong_kind", &item.span, message, help);
                return None;
            }
        };
        let mut param = self.empty(name, kind, item, Quantity::Number, (None, None));
        param.value = self.value(&param, item);
        param.value_span = Some(item.span.clone());
        Some(param)
    }

    fn empty(
        &self,
        name: &Spanned<String>,
        kind: ParamKind,
        item: &Item,
        quantity: Quantity,
        range: (Option<f64>, Option<f64>),
    ) -> Parameter {
        let scalar = if kind == ParamKind::Integer {
            Kind::Integer
        } else {
            Kind::Number
        };
        Parameter {
            kind,
            value: None,
            folder: None,
            choices: Vec::new(),
            target: Target::of_parameter(&name.value, scalar, quantity, self.units, range),
            span: item.span.clone(),
            value_span: None,
            limits: range,
            about: String::new(),
            name: name.clone(),
        }
    }

    /// `Number(default: 0.12, min: 0.02, max: 0.4, unit: Length, about: "...")`.
    fn declared(
        &mut self,
        name: &Spanned<String>,
        kind: ParamKind,
        item: &Item,
        default_needed: bool,
    ) -> Parameter {
        let fields = match &item.shape {
            Shape::Struct(fields) => fields.fields.as_slice(),
            Shape::Tuple(tuple) if !tuple.items.is_empty() => {
                let help = format!("write `{}(default: ...)`", kind.name());
                let message = "the fields of a parameter are named".to_owned();
                self.report("wrong_kind", &item.span, message, &help);
                return self.empty(name, kind, item, Quantity::Number, (None, None));
            }
            _ => &[],
        };
        let owner = format!("a {} parameter", kind.name());
        let fields = Fields::new(self.text, fields, kind.fields(), &owner, self.problems);
        let field = |name| {
            if kind.fields().contains(&name) {
                fields.get(name)
            } else {
                None
            }
        };
        let quantity = field("unit").map_or(Quantity::Number, |unit| self.quantity(unit));
        let range = self.range(field("min"), field("max"));
        let mut param = self.empty(name, kind, item, quantity, range);
        param.about = self.about(field("about")).unwrap_or_default();
        if kind == ParamKind::Choice {
            param.choices = self.choices(field("of"), item);
        }
        match field("default") {
            Some(default) => {
                param.value = self.value(&param, default);
                param.value_span = Some(default.span.clone());
            }
            None if default_needed => {
                let message = format!("the parameter `{}` has no default", shown(&name.value));
                self.report("missing_input", &item.span, message, "add `default: ...`");
            }
            None => {}
        }
        param
    }

    fn quantity(&mut self, item: &Item) -> Quantity {
        let name = item.name(self.text);
        let found = QUANTITIES.iter().find(|(other, _)| Some(*other) == name);
        if let Some((_, quantity)) = found {
            return *quantity;
        }
        let names: Vec<&str> = QUANTITIES.iter().map(|(name, _)| *name).collect();
        let message = match name {
            Some(name) => format!("there is no quantity `{}`", shown(name)),
            None => format!("`unit` takes a bare name, not {}", item.label(self.text)),
        };
        let help = format!(
            "`unit` is {}; its sign follows from the file's `units`",
            listing(&names, "or")
        );
        self.report("unknown_name", &item.span, message, &help);
        Quantity::Number
    }

    fn range(&mut self, min: Option<&Item>, max: Option<&Item>) -> (Option<f64>, Option<f64>) {
        let range = (self.limit(min, "min"), self.limit(max, "max"));
        if let (Some(low), Some(high), Some(item)) = (range.0, range.1, max)
            && low > high
        {
            let message = format!("`max` is {high}, below `min`, which is {low}");
            self.report("out_of_range", &item.span, message, "swap them");
            return (None, None);
        }
        range
    }

    fn limit(&mut self, item: Option<&Item>, name: &str) -> Option<f64> {
        let item = item?;
        let number = match item.number(self.text) {
            Some(Number::Whole(number)) => Some(number as f64),
            Some(Number::Real(number)) => Some(number).filter(|number| number.is_finite()),
            None => None,
        };
        if number.is_none() {
            let message = format!("`{name}` takes a finite number");
            self.report(
                "wrong_kind",
                &item.span,
                message,
                "leave it out where there is no limit",
            );
        }
        number
    }

    fn choices(&mut self, of: Option<&Item>, item: &Item) -> Vec<String> {
        let help = "write `Choice(default: A, of: [A, B])`";
        let Some(of) = of else {
            let message = "the choice does not say what it is of".to_owned();
            self.report("missing_input", &item.span, message, help);
            return Vec::new();
        };
        let Shape::List(items) = &of.shape else {
            let message = format!(
                "`of` takes a list of bare names, not {}",
                of.label(self.text)
            );
            self.report("wrong_kind", &of.span, message, help);
            return Vec::new();
        };
        let mut names = Vec::new();
        for item in items {
            match item.name(self.text) {
                Some(name) if !names.iter().any(|other| other == name) => {
                    names.push(name.to_owned());
                }
                Some(name) => {
                    let message = format!("`{}` is in the list twice", shown(name));
                    self.report("duplicate_name", &item.span, message, "remove one of them");
                }
                None => {
                    let label = item.label(self.text);
                    let message = format!("a choice is a bare name, not {label}");
                    self.report("wrong_kind", &item.span, message, help);
                }
            }
        }
        names
    }

    /// A literal as the parameter's value, in the file's units.
    fn value(&mut self, param: &Parameter, item: &Item) -> Option<Value> {
        let number = item.number(self.text);
        match (param.kind, &item.shape) {
            (ParamKind::Number | ParamKind::Integer, Shape::Number) => {
                match param.number(number?) {
                    Ok(value) => return Some(value),
                    Err(message) => {
                        self.report("out_of_range", &item.span, message, "give another default");
                    }
                }
            }
            (ParamKind::Bool, Shape::Name) if item.name(self.text) == Some("true") => {
                return Some(Value::Bool(true));
            }
            (ParamKind::Bool, Shape::Name) if item.name(self.text) == Some("false") => {
                return Some(Value::Bool(false));
            }
            (ParamKind::Text | ParamKind::Path, Shape::Text) => {
                return Some(Value::Text(item.text(self.text)?.value.into()));
            }
            // An empty list of names was reported already.
            (ParamKind::Choice, Shape::Name) if param.choices.is_empty() => {}
            (ParamKind::Choice, Shape::Name) => match param.choice(item.name(self.text)?) {
                Ok(value) => return Some(value),
                Err((message, help)) => {
                    self.report(
                        "unknown_name",
                        &item.span,
                        message,
                        &help.unwrap_or_default(),
                    );
                }
            },
            (kind, _) => {
                let (name, label) = (shown(&param.name.value), item.label(self.text));
                let message = format!("`{name}` is {}, not {label}", kind.label());
                let help = match kind {
                    ParamKind::Choice => "a choice is written without quotes",
                    ParamKind::Text | ParamKind::Path => "write it in quotes",
                    _ => "a default is a plain value; expressions belong to nodes",
                };
                self.report("wrong_kind", &item.span, message, help);
            }
        }
        None
    }
}
