//! `nodes`: what nodes there are, and how each is used.

use std::fmt::Write as _;

use clap::Args;
use serde_json::{Value as Json, json};
use tessgraph_graph::forms::{FORMS, FormField, FormSpec, form};
use tessgraph_graph::names::did_you_mean;
use tessgraph_graph::node::{InputSpec, NodeSpec, OutputSpec};
use tessgraph_graph::{Quantity, Units, Value, reference};

use super::{Context, OK, USAGE};
use crate::json::{number, pretty};
use crate::text::{Align, printable, table};

/// Lists the nodes, or shows how one is used
#[derive(Debug, Args)]
pub(crate) struct NodesArgs {
    /// The node to show
    name: Option<String>,
    /// Gives the reference in Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    /// Gives everything known about the nodes as JSON
    #[arg(long)]
    json: bool,
}

/// Carries the command out.
pub(crate) fn nodes(args: &NodesArgs, cx: &mut Context<'_, '_>) -> u8 {
    let registry = cx.registry;
    let Some(name) = &args.name else {
        let text = if args.markdown {
            reference::markdown(registry)
        } else if args.json {
            pretty(&registry.iter().map(node_json).collect())
        } else {
            listing(registry)
        };
        cx.console.data(&text);
        return OK;
    };
    if let Some(form) = form(name) {
        let text = if args.markdown {
            reference::form_markdown(form)
        } else if args.json {
            pretty(&form_json(form))
        } else {
            form_page(form)
        };
        cx.console.data(&text);
        return OK;
    }
    let Some(spec) = registry.iter().find(|spec| spec.name == *name) else {
        let names = registry.iter().map(|spec| spec.name);
        let names = names.chain(FORMS.iter().map(|form| form.name));
        let help = did_you_mean(name, names)
            .unwrap_or_else(|| "`tessgraph nodes` lists all nodes".to_owned());
        let message = format!("there is no node `{}`", printable(name));
        return cx.fail(USAGE, "unknown_node", message, Some(help));
    };
    let text = if args.markdown {
        reference::node_markdown(spec)
    } else if args.json {
        pretty(&node_json(spec))
    } else {
        page(spec)
    };
    cx.console.data(&text);
    OK
}

/// One line per node, then one per form of the language.
fn listing(registry: &[NodeSpec]) -> String {
    let row = |name: &str, doc| vec![name.to_owned(), reference::first_line(doc).to_owned()];
    let nodes = registry.iter().map(|spec| row(spec.name, spec.doc));
    let forms = FORMS.iter().map(|form| row(form.name, form.doc));
    let rows: Vec<_> = nodes.chain(forms).collect();
    table(&rows, &[Align::Left, Align::Left])
}

/// The page of one form of the language for the terminal.
fn form_page(form: &FormSpec) -> String {
    let mut text = format!("{}\n\n{}\n\nfields\n", form.name, without_fences(form.doc));
    for field in form.fields {
        let default = match field.default {
            Some(default) => format!("default {default}"),
            None => "required".to_owned(),
        };
        let _ = writeln!(text, "  {}: {}; {default}", field.name, field.takes);
        indent(&mut text, field.doc);
    }
    text
}

fn form_json(form: &FormSpec) -> Json {
    let field = |field: &FormField| {
        json!({
            "name": field.name,
            "takes": field.takes,
            "default": field.default,
            "doc": field.doc,
        })
    };
    json!({
        "name": form.name,
        "summary": reference::first_line(form.doc),
        "doc": form.doc,
        "fields": form.fields.iter().map(field).collect::<Json>(),
    })
}

/// The page of one node for the terminal.
fn page(spec: &NodeSpec) -> String {
    let mut text = format!("{}\n\n{}\n\ninputs\n", spec.name, without_fences(spec.doc));
    for input in spec.inputs {
        let (takes, default) = (reference::takes(input), reference::default_text(input));
        let default = match input.default {
            Some(_) => format!("default {}", default.replace('`', "")),
            None => default,
        };
        let _ = writeln!(text, "  {}: {takes}; {default}", input.name);
        indent(&mut text, input.doc);
        for choice in input.choices {
            indent(
                &mut text,
                &format!("{}: {}", choice.name, joined(choice.doc)),
            );
        }
        if !input.free.is_empty() {
            let names: Vec<_> = input.free.iter().map(|free| free.name).collect();
            let more = if input.attributes {
                ", and attributes of the mesh by name"
            } else {
                ""
            };
            indent(
                &mut text,
                &format!("Variables: {}{more}.", names.join(", ")),
            );
        }
        if let Some((choice, values)) = input.only_with {
            indent(
                &mut text,
                &format!("Only with {choice}: {}.", values.join(" or ")),
            );
        }
    }
    text.push_str("\nresults\n");
    for (index, output) in spec.outputs.iter().enumerate() {
        let main = if index == 0 { " (main)" } else { "" };
        let _ = writeln!(text, "  {}{main}: {}", output.name, output.kind.label());
        indent(&mut text, output.doc);
    }
    text
}

/// The doc comment with its code blocks indented instead of fenced.
fn without_fences(doc: &str) -> String {
    let mut inside = false;
    let mut lines = Vec::new();
    for line in doc.trim().lines() {
        if line.trim_start().starts_with("```") {
            inside = !inside;
        } else if inside {
            lines.push(format!("    {line}"));
        } else {
            lines.push(line.to_owned());
        }
    }
    lines.join("\n")
}

/// How wide a description may become.
const WIDTH: usize = 76;

/// Adds a paragraph below an entry.
fn indent(text: &mut String, doc: &str) {
    let mut line = String::new();
    for word in doc.split_whitespace() {
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(text, "      {line}");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    if !line.is_empty() {
        let _ = writeln!(text, "      {line}");
    }
}

fn joined(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Everything known about a node; numbers in metres and degrees.
fn node_json(spec: &NodeSpec) -> Json {
    json!({
        "name": spec.name,
        "summary": reference::first_line(spec.doc),
        "doc": spec.doc,
        "version": spec.version,
        "inputs": spec.inputs.iter().map(input_json).collect::<Json>(),
        "outputs": spec.outputs.iter().map(output_json).collect::<Json>(),
    })
}

fn input_json(input: &InputSpec) -> Json {
    let limit = |si: Option<f64>| si.map_or(Json::Null, |si| written(si, input.quantity));
    let choice = |choice: &tessgraph_graph::value::ChoiceSpec| json!({ "name": choice.name, "doc": joined(choice.doc) });
    let free = |free: &tessgraph_graph::node::FreeName| json!({ "name": free.name, "quantity": free.quantity.to_string() });
    json!({
        "name": input.name,
        "doc": joined(input.doc),
        "kind": format!("{:?}", input.kind),
        "quantity": input.quantity.to_string(),
        "required": input.default.is_none() && !input.optional,
        "default": input.default.map_or(Json::Null, |value| value_json(&value(), input.quantity)),
        "min": limit(input.min),
        "above": limit(input.above),
        "max": limit(input.max),
        "length": input.length,
        "choices": input.choices.iter().map(choice).collect::<Json>(),
        "variables": input.free.iter().map(free).collect::<Json>(),
        "attributes": input.attributes,
        "only_with": input.only_with.map(|(input, values)| json!({ "input": input, "values": values })),
    })
}

fn output_json(output: &OutputSpec) -> Json {
    json!({
        "name": output.name,
        "doc": joined(output.doc),
        "kind": format!("{:?}", output.kind),
        "quantity": output.quantity.to_string(),
    })
}

/// A number in SI units as a file in metres would say it.
fn written(si: f64, quantity: Quantity) -> Json {
    number(Units::M.from_si(si, quantity))
}

fn value_json(value: &Value, quantity: Quantity) -> Json {
    match value {
        Value::Bool(value) => json!(value),
        Value::Integer(value) => json!(value),
        Value::Number(value) => written(*value, quantity),
        Value::Text(text) => json!(text.as_ref()),
        Value::Choice(name) => json!(name),
        Value::Vector(v) => v
            .to_array()
            .iter()
            .map(|&part| written(part, quantity))
            .collect(),
        Value::List(items) => items
            .iter()
            .map(|item| value_json(item, quantity))
            .collect(),
        _ => Json::Null,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_is_indented_and_text_wrapped() {
        let doc = "First.\n\n```ron\nGraph(\n```\nLast.";
        assert_eq!(without_fences(doc), "First.\n\n    Graph(\nLast.");
        let mut text = String::new();
        indent(&mut text, &"word ".repeat(20));
        assert_eq!(text.lines().count(), 2);
        assert!(
            text.lines()
                .all(|line| line.starts_with("      word") && line.len() <= WIDTH + 6)
        );
    }
}
