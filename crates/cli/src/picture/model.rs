//! What is drawn: read from a plan, without places.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use tessgraph_graph::eval::NodeCost;
use tessgraph_graph::plan::{PlanInput, PlanNode, ResultRef};
use tessgraph_graph::value::Kind;
use tessgraph_graph::{Plan, Value, six_digits};

use crate::text::{bytes_text, printable, time_text};

/// Characters of a line in a box; longer ones are cut, and whole in the tip.
const LONGEST: usize = 40;

/// Boxes and edges; every edge leads to a box further on.
#[derive(Debug)]
pub(crate) struct Picture {
    /// What the picture is called.
    pub(crate) title: String,
    pub(crate) boxes: Vec<Item>,
    pub(crate) edges: Vec<Edge>,
}

/// A box.
#[derive(Debug)]
pub(crate) struct Item {
    pub(crate) role: Role,
    /// Its lines of text, the name first.
    pub(crate) lines: Vec<String>,
    /// What is told of it besides.
    pub(crate) tip: String,
    /// Whether an output needs it.
    pub(crate) used: bool,
}

/// What a box stands for; nodes are told apart by what they give.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Parameter,
    Mesh,
    Directions,
    Field,
    /// Reports and tables.
    Report,
    /// Numbers, vectors, texts.
    Plain,
    Output,
}

impl Role {
    pub(crate) const ALL: [Self; 7] = [
        Self::Parameter,
        Self::Mesh,
        Self::Directions,
        Self::Field,
        Self::Report,
        Self::Plain,
        Self::Output,
    ];

    /// Its name: in the key of the picture, and as a class of its boxes.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::Mesh => "mesh",
            Self::Directions => "directions",
            Self::Field => "field",
            Self::Report => "report",
            Self::Plain => "value",
            Self::Output => "output",
        }
    }

    /// Fill and line on a light ground.
    pub(crate) fn light(self) -> (&'static str, &'static str) {
        match self {
            Self::Parameter => ("#f3e8fd", "#8e44ad"),
            Self::Mesh => ("#e3eefc", "#2f6fb7"),
            Self::Directions => ("#dff5f1", "#16857a"),
            Self::Field => ("#e6f5e1", "#4a8a2f"),
            Self::Report => ("#fdeede", "#b86a1b"),
            Self::Plain => ("#eeeeee", "#6b6b6b"),
            Self::Output => ("#ffffff", "#333333"),
        }
    }

    /// Fill and line on a dark ground.
    pub(crate) fn dark(self) -> (&'static str, &'static str) {
        match self {
            Self::Parameter => ("#3b2748", "#c08be0"),
            Self::Mesh => ("#1d3450", "#7fb2ec"),
            Self::Directions => ("#12403b", "#5fd0c3"),
            Self::Field => ("#233f1a", "#93d178"),
            Self::Report => ("#4a3015", "#eca860"),
            Self::Plain => ("#383838", "#b5b5b5"),
            Self::Output => ("#1b1b1b", "#dddddd"),
        }
    }

    fn of(kind: Kind) -> Self {
        match kind {
            Kind::Mesh => Self::Mesh,
            Kind::Directions => Self::Directions,
            Kind::Field | Kind::Amount => Self::Field,
            Kind::Report | Kind::Table => Self::Report,
            Kind::List(item) => Self::of(*item),
            _ => Self::Plain,
        }
    }
}

/// An edge between two boxes, by index.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Edge {
    pub(crate) from: usize,
    pub(crate) to: usize,
    /// The inputs at its end, with the result they take if it is not the main
    /// one: "mesh", "outward (area)".
    pub(crate) label: String,
}

impl Picture {
    /// The picture of a plan; `costs` are those of the last run, one per node.
    pub(crate) fn new(title: &str, plan: &Plan, costs: &[Option<NodeCost>]) -> Self {
        let needed = plan.needed(plan.outputs.iter().map(|output| output.result));
        let mut boxes = parameters(plan);
        let first = boxes.len();
        let mut labels: BTreeMap<(usize, usize), BTreeSet<String>> = BTreeMap::new();
        for (index, node) in plan.nodes.iter().enumerate() {
            let cost = costs.get(index).copied().flatten();
            boxes.push(node_box(node, cost, needed[index]));
            for (spec, input) in node.spec.inputs.iter().zip(&node.inputs) {
                for parameter in parameters_of(plan, node, spec.kind, input) {
                    boxes[parameter].used |= needed[index];
                    let label = labels.entry((parameter, first + index)).or_default();
                    label.insert(spec.name.to_owned());
                }
                for result in input.origin.results() {
                    let label = labels.entry((first + result.node, first + index));
                    let label = label.or_default();
                    label.insert(format!("{}{}", spec.name, of_result(plan, result)));
                }
            }
        }
        for output in &plan.outputs {
            let label = labels.entry((first + output.result.node, boxes.len()));
            label
                .or_default()
                .insert(of_result(plan, output.result).trim().to_owned());
            let name = printable(&output.path);
            boxes.push(Item {
                role: Role::Output,
                lines: vec![cut(&name)],
                tip: format!("output {name}"),
                used: true,
            });
        }
        let edge = |((from, to), names): ((usize, usize), BTreeSet<String>)| Edge {
            from,
            to,
            label: names.into_iter().collect::<Vec<_>>().join(", "),
        };
        Self {
            title: printable(title).into_owned(),
            boxes,
            edges: labels.into_iter().map(edge).collect(),
        }
    }
}

/// " (pairs)" for a result that is not a node's main one.
fn of_result(plan: &Plan, result: ResultRef) -> String {
    match result.result {
        0 => String::new(),
        _ => format!(" ({})", plan.result_spec(result).name),
    }
}

fn parameters(plan: &Plan) -> Vec<Item> {
    let parameter = |parameter: &tessgraph_graph::plan::PlanParameter| {
        let name = printable(&parameter.name);
        let value = value_text(&parameter.value);
        Item {
            role: Role::Parameter,
            lines: vec![cut(&name), cut(&value)],
            tip: format!("parameter {name} = {value}"),
            used: false,
        }
    };
    plan.parameters.iter().map(parameter).collect()
}

fn value_text(value: &Value) -> String {
    let text = match value {
        Value::Number(number) => six_digits(*number),
        Value::Integer(number) => number.to_string(),
        Value::Bool(value) => value.to_string(),
        Value::Choice(name) => (*name).to_owned(),
        Value::Text(text) => text.to_string(),
        other => other.summary(),
    };
    printable(&text).replace('\n', " ")
}

fn node_box(node: &PlanNode, cost: Option<NodeCost>, used: bool) -> Item {
    let name = printable(&node.name).into_owned();
    let about = node.spec.doc.lines().next().unwrap_or_default().trim();
    let mut tip = format!("{name}: {}\n{about}", node.spec.name);
    for (spec, input) in node.spec.inputs.iter().zip(&node.inputs) {
        if let Some(text) = written(node, input) {
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            tip += &format!("\n{}: {}", spec.name, cut(&printable(&text)));
        }
    }
    let mut lines = vec![cut(&name), node.spec.name.to_owned()];
    if let Some(cost) = cost {
        let (time, size) = (time_text(cost.ms), bytes_text(cost.bytes));
        lines.push(format!("{time}, {size}"));
    }
    let main = node.spec.outputs.first();
    Item {
        role: main.map_or(Role::Plain, |output| Role::of(output.kind)),
        lines,
        tip,
        used,
    }
}

/// What is written at an input.
fn written<'p>(node: &'p PlanNode, input: &PlanInput) -> Option<&'p str> {
    let span = input.span.clone()?;
    node.source.text().get(span)
}

/// The parameters that an input's text names. They are gone from the plan,
/// which holds their values; a name in an expression is one of a parameter, a
/// node or a function, and these have names of their own.
fn parameters_of(plan: &Plan, node: &PlanNode, kind: Kind, input: &PlanInput) -> Vec<usize> {
    // Inside an included graph the same names are those of its own parameters.
    let own = Arc::ptr_eq(&node.source, &plan.source);
    let Some(text) = written(node, input).filter(|_| own) else {
        return Vec::new();
    };
    let is_text = matches!(
        kind,
        Kind::Text | Kind::Path | Kind::List(Kind::Text | Kind::Path)
    );
    let named = |name: &str| {
        let mut parameters = plan.parameters.iter();
        parameters.position(|parameter| parameter.name == name)
    };
    let mut found = BTreeSet::new();
    // Every second part stands within quotes.
    for quoted in text.split('"').skip(1).step_by(2) {
        if is_text {
            let quoted = quoted.replace("{{", "");
            let braces = quoted.split('{').skip(1);
            found.extend(braces.filter_map(|rest| named(rest.split('}').next()?.trim())));
        } else {
            found.extend(names_in(quoted).filter_map(named));
        }
    }
    found.into_iter().collect()
}

/// The names of values in an expression: `node.result` is one, and a name
/// before a parenthesis is that of a function.
fn names_in(expression: &str) -> impl Iterator<Item = &str> {
    let part = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let mut rest = expression;
    std::iter::from_fn(move || {
        rest = rest.trim_start_matches(|c| !part(c));
        let end = rest.find(|c| !part(c)).unwrap_or(rest.len());
        let name = &rest[..end];
        rest = &rest[end..];
        (!name.is_empty()).then_some((name, rest.trim_start().starts_with('(')))
    })
    .filter(|(_, is_function)| !is_function)
    .map(|(name, _)| name)
}

fn cut(text: &str) -> String {
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    let begin: String = text.chars().take(LONGEST - 1).collect();
    format!("{begin}…")
}
