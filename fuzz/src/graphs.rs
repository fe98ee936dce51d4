//! Small graphs of any nodes with any values, made from a fuzzer's bytes.

use std::fmt::Write as _;

use libfuzzer_sys::arbitrary::{Result, Unstructured};
use tessgraph_graph::node::{InputSpec, NodeSpec};
use tessgraph_graph::value::Kind;
use tessgraph_graph::world::MemoryWorld;
use tessgraph_nodes::NODES;

const QUADS: &str = "v 0 0 0\nv 1 0 0\nv 2 0 .5\nv 0 1 .2\nv 1 1 0\nv 2 1 1\nv 0 2 0\nv 1 2 1\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
    usemtl one\nf 1/1 2/2 5/3 4/4\nusemtl two\nf 2/1 3/2 6/3 5/4\ng top\nf 4/1 5/2 8/3 7/4\n";
const MIXED: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 1\nv .5 .5 -1\nv 3 3 3\n\
    f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 4 3 2 1\nf 1 2 6\nf 1 1 2\nf 1 3 2 4\n";
const BOX: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// The files that the graphs may read.
pub(crate) fn files() -> MemoryWorld {
    let mut world = MemoryWorld::default();
    for (name, text) in [
        ("quads.obj", QUADS),
        ("mixed.obj", MIXED),
        ("box.obj", BOX),
        ("numbers.csv", "value\n1\n0.5\n-2\n"),
        ("empty.obj", "v 0 0 0\n"),
    ] {
        world.insert(name, text.as_bytes());
    }
    world
}

const NUMBERS: [&str; 24] = [
    "0",
    "1",
    "-1",
    "0.5",
    "2",
    "3",
    "-0.5",
    "0.1",
    "1e-3",
    "1e-12",
    "1e-300",
    "5e-324",
    "1e12",
    "1e300",
    "-1e300",
    "90",
    "45",
    "0.999999",
    "1e6",
    "7",
    "-7.25",
    "\"1 / 3\"",
    "\"sqrt(2)\"",
    "100",
];
const INTEGERS: [&str; 12] = [
    "0",
    "1",
    "2",
    "3",
    "4",
    "5",
    "8",
    "-1",
    "17",
    "100",
    "1000000000",
    "4294967295",
];
const TEXTS: [&str; 8] = ["uv", "area", "one", "two", "top", "", "crease", "base_face"];
const PATHS: [&str; 5] = [
    "quads.obj",
    "mixed.obj",
    "box.obj",
    "numbers.csv",
    "empty.obj",
];
const FORMULAS: [&str; 12] = [
    "x",
    "z * y",
    "sin(u) + v",
    "1 / x",
    "ln(x)",
    "x ^ y",
    "sqrt(-z)",
    "if(x > 0.5, 1, 0)",
    "index",
    "exp(1000 * x)",
    "u * u - v",
    "atan2(y, x)",
];

/// A result that later nodes can use.
struct Given {
    name: String,
    kind: Kind,
}

/// A graph of two to nine nodes. Most are sound as far as checking goes: the
/// target is what happens then.
///
/// # Errors
/// When the bytes are used up.
pub fn random_graph(bytes: &mut Unstructured<'_>) -> Result<String> {
    let mut text = String::from("Graph(version: 1, ");
    let _ = write!(
        text,
        "units: {}, nodes: {{\n",
        bytes.choose(&["M", "Mm", "Ft"])?
    );
    let mut given = Vec::new();
    let count = bytes.int_in_range(2..=9)?;
    for index in 0..count {
        let name = format!("n{index}");
        let body = match index {
            0 => source(bytes)?,
            _ => {
                let spec = bytes.choose(NODES)?;
                match node(spec, &given, bytes)? {
                    Some(body) => {
                        give(&name, spec, &mut given);
                        let _ = writeln!(text, "  \"{name}\": {body},");
                        continue;
                    }
                    None => source(bytes)?,
                }
            }
        };
        let kind = body.split('(').next().unwrap_or_default();
        if let Some(spec) = NODES.iter().find(|spec| spec.name == kind) {
            give(&name, spec, &mut given);
        }
        let _ = writeln!(text, "  \"{name}\": {body},");
    }
    text.push_str("}, outputs: {\n");
    for (index, result) in given.iter().enumerate() {
        let ending = match result.kind {
            Kind::Mesh => "obj",
            Kind::Table => "csv",
            _ => "json",
        };
        let _ = writeln!(text, "  \"o{index}.{ending}\": \"{}\",", result.name);
    }
    text.push_str("})");
    Ok(text)
}

/// A node that needs no other.
fn source(bytes: &mut Unstructured<'_>) -> Result<String> {
    Ok(match bytes.int_in_range(0..=4)? {
        0 => format!(
            "Grid(cells: ({}, {}))",
            bytes.int_in_range(1..=4)?,
            bytes.int_in_range(1..=4)?
        ),
        1 => "Cuboid()".to_owned(),
        2 => "ParametricSurface(x: \"cos(u * tau)\", y: \"sin(u * tau)\", z: \"v * v\", \
              cells: (6, 3), closed_u: true)"
            .to_owned(),
        _ => format!("ReadMesh(path: \"{}\")", bytes.choose(&PATHS)?),
    })
}

fn give(name: &str, spec: &NodeSpec, given: &mut Vec<Given>) {
    for output in spec.outputs {
        given.push(Given {
            name: format!("{name}.{}", output.name),
            kind: output.kind,
        });
    }
}

/// A node of that kind, or nothing if an input it needs cannot be had yet.
fn node(spec: &NodeSpec, given: &[Given], bytes: &mut Unstructured<'_>) -> Result<Option<String>> {
    let mut chosen: Vec<(&str, String)> = Vec::new();
    let mut body = format!("{}(", spec.name);
    for input in spec.inputs {
        let may_be_left_out = input.optional || input.default.is_some();
        if may_be_left_out && bytes.ratio(3, 5)? {
            continue;
        }
        // Refused unless that choice was made: not where the interest lies.
        if let Some((choice, values)) = input.only_with {
            let made = chosen.iter().find(|(name, _)| *name == choice);
            if !made.is_some_and(|(_, value)| values.contains(&value.as_str())) {
                continue;
            }
        }
        match value(input, input.kind, given, bytes)? {
            Some(value) => {
                let _ = write!(body, "{}: {value}, ", input.name);
                chosen.push((input.name, value));
            }
            None if may_be_left_out => {}
            None => return Ok(None),
        }
    }
    body.push(')');
    Ok(Some(body))
}

fn value(
    input: &InputSpec,
    kind: Kind,
    given: &[Given],
    bytes: &mut Unstructured<'_>,
) -> Result<Option<String>> {
    let quoted = |text: &str| Some(format!("\"{text}\""));
    Ok(match kind {
        Kind::Bool => Some(bytes.choose(&["true", "false"])?.to_string()),
        Kind::Integer => Some(bytes.choose(&INTEGERS)?.to_string()),
        Kind::Number => Some(number(input, bytes)?),
        Kind::Amount if bytes.ratio(1, 2)? => Some(number(input, bytes)?),
        Kind::Amount => reference(Kind::Field, given, bytes)?,
        Kind::Formula => quoted(bytes.choose(&FORMULAS)?),
        Kind::Text => quoted(bytes.choose(&TEXTS)?),
        Kind::Path => quoted(bytes.choose(&PATHS)?),
        Kind::Choice if input.choices.is_empty() => None,
        Kind::Choice => Some(bytes.choose(input.choices)?.name.to_owned()),
        Kind::Vector => {
            let (x, y, z) = (
                number(input, bytes)?,
                number(input, bytes)?,
                number(input, bytes)?,
            );
            Some(format!("({x}, {y}, {z})"))
        }
        Kind::List(item) => {
            let length = input.length.map_or_else(|| bytes.int_in_range(0..=3), Ok)?;
            let mut items = Vec::new();
            for _ in 0..length {
                match value(input, *item, given, bytes)? {
                    Some(item) => items.push(item),
                    None => return Ok(None),
                }
            }
            Some(format!("[{}]", items.join(", ")))
        }
        _ => reference(kind, given, bytes)?,
    })
}

/// A number, most often one that the input allows.
fn number(input: &InputSpec, bytes: &mut Unstructured<'_>) -> Result<String> {
    let number = *bytes.choose(&NUMBERS)?;
    if let Ok(value) = number.parse::<f64>() {
        let low = input.min.or(input.above);
        let outside =
            low.is_some_and(|low| value < low) || input.max.is_some_and(|max| value > max);
        if outside && bytes.ratio(9, 10)? {
            return Ok("0.5".to_owned());
        }
    }
    Ok(number.to_owned())
}

/// The name of an earlier result of that kind; late ones more often.
fn reference(kind: Kind, given: &[Given], bytes: &mut Unstructured<'_>) -> Result<Option<String>> {
    let fitting: Vec<_> = given.iter().rev().filter(|one| one.kind == kind).collect();
    if fitting.is_empty() {
        return Ok(None);
    }
    let first = bytes.choose_index(fitting.len())?;
    let second = bytes.choose_index(fitting.len())?;
    Ok(Some(format!("\"{}\"", fitting[first.min(second)].name)))
}
