//! A few kinds of node, written by hand: enough to meet every kind of input.

use tessgraph_geometry::Quantity;

use crate::node::{FreeName, InputSpec, NodeSpec, OutputSpec};
use crate::value::{ChoiceSpec, Kind, Value};

const INPUT: InputSpec = InputSpec {
    name: "",
    doc: "An input.",
    kind: Kind::Mesh,
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

const fn input(name: &'static str, kind: Kind) -> InputSpec {
    InputSpec {
        name,
        kind,
        ..INPUT
    }
}

const fn output(name: &'static str, kind: Kind, quantity: Quantity) -> OutputSpec {
    OutputSpec {
        name,
        doc: "A result.",
        kind,
        quantity,
        faults: None,
    }
}

const fn node(
    name: &'static str,
    inputs: &'static [InputSpec],
    outputs: &'static [OutputSpec],
) -> NodeSpec {
    NodeSpec {
        name,
        doc: "A node.",
        version: 1,
        inputs,
        outputs,
        preview: crate::node::Preview::NONE,
        eval: |_, _| Ok(Vec::new()),
    }
}

const MESH: &[OutputSpec] = &[output("mesh", Kind::Mesh, Quantity::Number)];
const DIRECTIONS: &[OutputSpec] = &[output("directions", Kind::Directions, Quantity::Number)];
const FIELD: &[OutputSpec] = &[output("field", Kind::Field, Quantity::Length)];

const fn choice(name: &'static str) -> ChoiceSpec {
    ChoiceSpec {
        name,
        doc: "A choice.",
    }
}

const LENGTH: InputSpec = InputSpec {
    quantity: Quantity::Length,
    ..INPUT
};

/// The registry of the tests.
pub(super) static NODES: &[NodeSpec] = &[
    node("ReadMesh", &[input("path", Kind::Path)], MESH),
    node(
        "Grid",
        &[
            InputSpec {
                length: Some(2),
                min: Some(1.0),
                ..input("cells", Kind::List(&Kind::Integer))
            },
            InputSpec {
                name: "size",
                kind: Kind::Number,
                default: Some(|| Value::Number(1.0)),
                above: Some(0.0),
                max: Some(1000.0),
                ..LENGTH
            },
            InputSpec {
                name: "origin",
                kind: Kind::Vector,
                optional: true,
                ..LENGTH
            },
            InputSpec {
                default: Some(|| Value::Bool(false)),
                ..input("closed", Kind::Bool)
            },
        ],
        MESH,
    ),
    node(
        "SmoothNormals",
        &[
            input("mesh", Kind::Mesh),
            InputSpec {
                default: Some(|| Value::Integer(10)),
                min: Some(0.0),
                max: Some(100_000.0),
                ..input("iterations", Kind::Integer)
            },
        ],
        DIRECTIONS,
    ),
    node(
        "CompensateThickness",
        &[
            input("mesh", Kind::Mesh),
            input("directions", Kind::Directions),
            InputSpec {
                name: "thickness",
                kind: Kind::Amount,
                above: Some(0.0),
                ..LENGTH
            },
            InputSpec {
                choices: &[choice("Local"), choice("Global")],
                default: Some(|| Value::Choice("Global")),
                ..input("mode", Kind::Choice)
            },
            InputSpec {
                optional: true,
                above: Some(0.0),
                only_with: Some(("mode", &["Global"])),
                ..input("tolerance", Kind::Number)
            },
        ],
        &[
            output("directions", Kind::Directions, Quantity::Number),
            output("max_error", Kind::Number, Quantity::Length),
            output("solved", Kind::Integer, Quantity::Number),
            output("all_solved", Kind::Bool, Quantity::Number),
        ],
    ),
    node(
        "EvaluateField",
        &[
            input("mesh", Kind::Mesh),
            InputSpec {
                name: "value",
                kind: Kind::Formula,
                attributes: true,
                free: &[
                    FreeName {
                        name: "x",
                        quantity: Quantity::Length,
                    },
                    FreeName {
                        name: "y",
                        quantity: Quantity::Length,
                    },
                    FreeName {
                        name: "index",
                        quantity: Quantity::Number,
                    },
                ],
                ..LENGTH
            },
        ],
        FIELD,
    ),
    node(
        "Rotate",
        &[
            input("mesh", Kind::Mesh),
            InputSpec {
                quantity: Quantity::Angle,
                max: Some(tessgraph_geometry::math::PI),
                ..input("angle", Kind::Number)
            },
            InputSpec {
                optional: true,
                ..input("label", Kind::Text)
            },
        ],
        MESH,
    ),
    node(
        "JoinMeshes",
        &[input("meshes", Kind::List(&Kind::Mesh))],
        MESH,
    ),
    node(
        "SplitParts",
        &[input("mesh", Kind::Mesh)],
        &[output("parts", Kind::List(&Kind::Mesh), Quantity::Number)],
    ),
    node(
        "Require",
        &[
            input("condition", Kind::Bool),
            InputSpec {
                optional: true,
                ..input("weights", Kind::Field)
            },
        ],
        &[output("report", Kind::Report, Quantity::Number)],
    ),
];
