//! The forms of the language that stand where nodes stand but are none.
//!
//! They include other graphs and are gone before anything is evaluated: what
//! they include is put in their place.

/// A form as data: reader, help and reference pages use this.
#[derive(Debug, Clone, Copy)]
pub struct FormSpec {
    /// Its name in a graph file.
    pub name: &'static str,
    /// Its reference page.
    pub doc: &'static str,
    /// Its fields in order.
    pub fields: &'static [FormField],
}

/// A field of a form.
#[derive(Debug, Clone, Copy)]
pub struct FormField {
    /// Its name in a graph file.
    pub name: &'static str,
    /// What stands there, in words.
    pub takes: &'static str,
    /// What it is when left out; `None` if it must be written.
    pub default: Option<&'static str>,
    /// What it means.
    pub doc: &'static str,
}

const PATH: FormField = FormField {
    name: "path",
    takes: "a file path",
    default: None,
    doc: "The graph file, from the folder of the file this is written in.",
};

const WITH: FormField = FormField {
    name: "with",
    takes: "a map from inputs of that graph to values",
    default: Some("no values"),
    doc: "What the inputs of that graph are given: references, numbers, expressions, names.",
};

/// All forms, in the order of the reference.
pub static FORMS: &[FormSpec] = &[
    FormSpec {
        name: "Subgraph",
        doc: r#"Puts another graph in this place.

The other graph says in `inputs` what it takes and in `results` what it gives.
`"panels"` is its first result, `"panels.facade"` the one of that name; its own
nodes are called `panels/name` in reports. Numbers are converted between the
units of the two files by what the input declares.

```ron
"panels": Subgraph(path: "parts/panels.ron", with: {"mesh": "surface", "thickness": "t / 2"}),
```"#,
        fields: &[PATH, WITH],
    },
    FormSpec {
        name: "ForEach",
        doc: r#"Puts another graph in this place once for each of several values.

Each axis in `over` names an input of that graph; with several axes every
combination is made, the last one varying fastest. `join: Mesh` joins the
meshes of each result into one; other results, and all of them with
`join: List`, become lists.

```ron
"family": ForEach(
    path: "parts/panel.ron",
    over: {"thickness": Linspace(from: 0.1, to: 0.3, count: 3)},
    with: {"mesh": "surface"},
),
```"#,
        fields: &[
            PATH,
            FormField {
                name: "over",
                takes: "a map from inputs of that graph to axes",
                default: None,
                doc: "The values: `Linspace(from:, to:, count:)`, `Values(of: [...])` or `Random(from:, to:, count:, seed:)`.",
            },
            WITH,
            FormField {
                name: "join",
                takes: "Mesh or List",
                default: Some("Mesh"),
                doc: "What becomes of the results.",
            },
        ],
    },
    FormSpec {
        name: "Repeat",
        doc: r#"Puts another graph in this place several times, each fed by the last.

The input that `carry` names is first given by `with`, then by the result of
the same name of the pass before, or by the first result if none has that
name. The bare name means the carried result of the last pass; with 0 passes
it is what `with` gave.

```ron
"cells": Repeat(path: "parts/tessellate.ron", times: 3, carry: "mesh", with: {"mesh": "roof"}),
```"#,
        fields: &[
            PATH,
            FormField {
                name: "times",
                takes: "a whole number, at least 0",
                default: None,
                doc: "How often; an expression over parameters.",
            },
            FormField {
                name: "carry",
                takes: "the name of an input in quotes",
                default: None,
                doc: "The input that takes the result of the pass before.",
            },
            WITH,
        ],
    },
];

/// The form of that name.
pub fn form(name: &str) -> Option<&'static FormSpec> {
    FORMS.iter().find(|form| form.name == name)
}
