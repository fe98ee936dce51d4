//! Nodes that forms of the language need and no registry has.
//!
//! They appear where a value crosses the border of a graph and has to be
//! computed or converted there, and where several results become one.

use std::sync::Arc;

use tessgraph_geometry::{Mesh, Quantity, join};

use crate::NodeError;
use crate::node::{Args, EvalCx, InputSpec, NodeSpec, OutputSpec, Preview};
use crate::value::{Kind, Value};

const INPUT: InputSpec = InputSpec {
    name: "value",
    doc: "What the graph that includes this one gives.",
    kind: Kind::Number,
    quantity: Quantity::Number,
    optional: false,
    default: None,
    min: None,
    above: None,
    max: None,
    choices: &[],
    length: None,
    free: &[],
    attributes: false,
    only_with: None,
};

/// One spec per line: the name its input has in keys, its kind and quantity.
macro_rules! inputs {
    ($($name:literal, $kind:ident, $quantity:ident;)*) => {
        &[$({
            const INPUTS: &[InputSpec] = &[InputSpec {
                name: $name,
                kind: Kind::$kind,
                quantity: Quantity::$quantity,
                ..INPUT
            }];
            const OUTPUTS: &[OutputSpec] = &[OutputSpec {
                name: "value",
                doc: "The value.",
                kind: Kind::$kind,
                quantity: Quantity::$quantity,
                faults: None,
            }];
            NodeSpec {
                name: "Input",
                doc: "An input of an included graph.",
                version: 1,
                inputs: INPUTS,
                outputs: OUTPUTS,
                preview: Preview::NONE,
                eval: unchanged,
            }
        }),*]
    };
}

/// An input of an included graph whose value a node of the other graph gives.
/// The name of its input is in its key and tells quantities apart.
static INPUTS: &[NodeSpec] = inputs! {
    "value", Bool, Number;
    "value", Integer, Number;
    "value", Number, Number;
    "length", Number, Length;
    "area", Number, Area;
    "volume", Number, Volume;
    "angle", Number, Angle;
    "value", Vector, Number;
    "length", Vector, Length;
    "area", Vector, Area;
    "volume", Vector, Volume;
    "angle", Vector, Angle;
    "length", Field, Length;
    "area", Field, Area;
    "volume", Field, Volume;
    "angle", Field, Angle;
};

fn unchanged(mut args: Args, _: &EvalCx<'_>) -> Result<Vec<Value>, NodeError> {
    args.next_value()
        .map(|value| vec![value])
        .ok_or_else(|| NodeError::new("an input was given no value"))
}

/// The node that gives an input of that kind and quantity its value.
pub(super) fn input(kind: Kind, quantity: Quantity) -> Option<&'static NodeSpec> {
    let fits = |output: &OutputSpec| output.kind == kind && output.quantity == quantity;
    INPUTS.iter().find(|spec| fits(&spec.outputs[0]))
}

/// Joins the meshes that a `ForEach` made.
pub(super) static JOIN: NodeSpec = NodeSpec {
    name: "ForEach",
    doc: "The meshes of a `ForEach` as one.",
    version: 1,
    inputs: &[InputSpec {
        name: "meshes",
        kind: Kind::List(&Kind::Mesh),
        ..INPUT
    }],
    outputs: &[OutputSpec {
        name: "mesh",
        doc: "All of them, one after the other.",
        kind: Kind::Mesh,
        quantity: Quantity::Number,
        faults: None,
    }],
    preview: Preview::NONE,
    eval: join_meshes,
};

fn join_meshes(mut args: Args, _: &EvalCx<'_>) -> Result<Vec<Value>, NodeError> {
    let Some(Value::List(items)) = args.next_value() else {
        return Err(NodeError::new("there is nothing to join"));
    };
    let meshes: Vec<&Mesh> = items
        .iter()
        .filter_map(|item| match item {
            Value::Mesh(mesh) => Some(mesh.as_ref()),
            _ => None,
        })
        .collect();
    Ok(vec![Value::Mesh(Arc::new(join(&meshes)?))])
}

/// One spec per line: lists of that kind and quantity as one value.
macro_rules! lists {
    ($($kind:ident, $quantity:ident;)*) => {
        &[$({
            const INPUTS: &[InputSpec] = &[InputSpec {
                name: "items",
                kind: Kind::List(&Kind::$kind),
                ..INPUT
            }];
            const OUTPUTS: &[OutputSpec] = &[OutputSpec {
                name: "list",
                doc: "The list.",
                kind: Kind::List(&Kind::$kind),
                quantity: Quantity::$quantity,
                faults: None,
            }];
            NodeSpec {
                name: "List",
                doc: "The results of a `ForEach` as a list.",
                version: 1,
                inputs: INPUTS,
                outputs: OUTPUTS,
                preview: Preview::NONE,
                eval: unchanged,
            }
        }),*]
    };
}

static LISTS: &[NodeSpec] = lists! {
    Bool, Number;
    Integer, Number;
    Number, Number;
    Number, Length;
    Number, Area;
    Number, Volume;
    Number, Angle;
    Text, Number;
    Vector, Number;
    Vector, Length;
    Report, Number;
    Table, Number;
    Field, Number;
    Mesh, Number;
    Directions, Number;
};

/// The node that makes one value of several of that kind and quantity.
pub(super) fn list(item: Kind, quantity: Quantity) -> Option<&'static NodeSpec> {
    let wanted = list_kind(item)?;
    let of_kind = || LISTS.iter().filter(|spec| spec.outputs[0].kind == wanted);
    of_kind()
        .find(|spec| spec.outputs[0].quantity == quantity)
        .or_else(|| of_kind().next())
}

/// The kind of a list of such values; `None` if there are no such lists.
pub(super) fn list_kind(item: Kind) -> Option<Kind> {
    let lists = LISTS.iter().map(|spec| spec.outputs[0].kind);
    lists
        .into_iter()
        .find(|list| matches!(list, Kind::List(part) if **part == item))
}
