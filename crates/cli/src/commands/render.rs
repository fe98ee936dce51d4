//! `render`: a picture of a mesh, without a window.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;
use tessgraph_geometry::{Domain, Field, Mesh, Quantity};
use tessgraph_graph::names::did_you_mean;
use tessgraph_graph::plan::ResultRef;
use tessgraph_graph::value::Kind;
use tessgraph_graph::{Evaluation, Plan, Units, Value};
use tessgraph_io::{Format, write_png};
use tessgraph_render::{DrawOptions, FieldPaint, LARGEST, Paint, View, draw};

use super::engine::EngineArgs;
use super::{Context, FAILED, OK, USAGE, status};
use crate::args::{Setting, setting};
use crate::atomic::write_if_changed;
use crate::diagnostics::print;
use crate::graph_file::GraphFile;
use crate::interrupt::{INTERRUPTED, UntilInterrupt};
use crate::mesh_file;
use crate::places::is_same_file;
use crate::progress::Progress;
use crate::text::printable;

/// Draws a mesh, or a mesh of a graph, as a PNG picture
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// The graph or mesh file
    file: PathBuf,
    /// Where the picture goes
    #[arg(short, long, value_name = "FILE.png")]
    output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1200x800", value_parser = size)]
    size: [u32; 2],
    /// iso, top, bottom, front, back, left, right, or a direction to the eye as 1,-2,0.5
    #[arg(
        long,
        value_name = "VIEW",
        default_value = "iso",
        allow_hyphen_values = true
    )]
    view: View,
    /// The mesh of the graph to draw, as `node` or `node.result`; by default the first output that is one
    #[arg(long, value_name = "NAME")]
    result: Option<String>,
    /// Shows a field in colours: an attribute of the mesh, or a result of the graph
    #[arg(long, value_name = "NAME")]
    field: Option<String>,
    /// The numbers at the ends of the colours, in the graph's units
    #[arg(long, value_name = "LOW,HIGH", requires = "field", allow_hyphen_values = true, value_parser = range)]
    range: Option<(f64, f64)>,
    /// Leaves out the edges of polygons
    #[arg(long)]
    no_edges: bool,
    /// Gives a parameter of the graph another value
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    set: Vec<Setting>,
    #[command(flatten)]
    engine: EngineArgs,
}

/// Reads "1200x800".
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(width, height)| {
        Some([width.trim().parse().ok()?, height.trim().parse().ok()?])
    });
    sides
        .filter(|sides| sides.iter().all(|side| (16..=LARGEST).contains(side)))
        .ok_or_else(|| format!("write it as 1200x800, with 16 to {LARGEST} pixels each way"))
}

/// Reads "0,1.5".
fn range(text: &str) -> Result<(f64, f64), String> {
    let ends = text.split_once(',').and_then(|(low, high)| {
        Some((
            low.trim().parse::<f64>().ok()?,
            high.trim().parse::<f64>().ok()?,
        ))
    });
    ends.filter(|(low, high)| low < high && (high - low).is_finite())
        .ok_or_else(|| "write two numbers as 0,1.5, the smaller first".to_owned())
}

/// What is drawn.
struct Subject {
    mesh: Arc<Mesh>,
    field: Option<Painted>,
    /// What it is and what it was made from, for the picture to carry.
    texts: Vec<(&'static str, String)>,
}

/// A field and how its numbers are told.
struct Painted {
    field: Arc<Field>,
    title: String,
    /// From SI units to those the title names.
    factor: f64,
}

/// Carries the command out.
pub(crate) fn render(args: &RenderArgs, cx: &mut Context<'_, '_>) -> u8 {
    if is_same_file(&args.file, &args.output) {
        let message = "the picture would replace what it is drawn from";
        return cx.fail(
            USAGE,
            "usage",
            message,
            Some("name another file".to_owned()),
        );
    }
    let is_mesh = Format::from_name(&args.file.to_string_lossy()).is_some();
    let subject = if is_mesh {
        of_mesh(args, cx)
    } else {
        of_graph(args, cx)
    };
    let subject = match subject {
        Ok(subject) => subject,
        Err(status) => return status,
    };
    let paint = subject.field.as_ref().map_or(Paint::Materials, |painted| {
        let of_range = |(low, high)| (low / painted.factor, high / painted.factor);
        Paint::Field(FieldPaint {
            field: &painted.field,
            title: &painted.title,
            range: args.range.map(of_range),
            factor: painted.factor,
        })
    });
    let options = DrawOptions {
        size: args.size,
        view: args.view,
        paint,
        edges: !args.no_edges,
    };
    let picture = match draw(&subject.mesh, &options, &UntilInterrupt) {
        Ok(picture) => picture,
        Err(error) if crate::interrupt::is_requested() => {
            drop(error);
            return INTERRUPTED;
        }
        Err(error) => return cx.fail(FAILED, "not_drawn", error.to_string(), None),
    };
    let bytes = write_png(picture.size(), picture.pixels(), &subject.texts);
    let shown = args.output.to_string_lossy();
    if let Err(error) = write_if_changed(&args.output, &bytes) {
        let message = format!("cannot write {}: {error}", printable(&shown));
        return cx.fail(FAILED, "output_failed", message, None);
    }
    OK
}

fn of_mesh(args: &RenderArgs, cx: &mut Context<'_, '_>) -> Result<Subject, u8> {
    if args.result.is_some() || !args.set.is_empty() {
        let message = "a mesh file has neither results nor parameters";
        let help = "leave out `--result` and `--set`, or name a graph".to_owned();
        return Err(cx.fail(USAGE, "usage", message, Some(help)));
    }
    let (_, loaded) = mesh_file::open(&args.file, cx)?;
    let mesh = Arc::new(loaded.mesh);
    let field = match &args.field {
        Some(name) => {
            Some(of_attribute(&mesh, name, None).ok_or_else(|| no_field(&mesh, name, &[], cx))?)
        }
        None => None,
    };
    let texts = texts(&args.file, None, None);
    Ok(Subject { mesh, field, texts })
}

fn of_graph(args: &RenderArgs, cx: &mut Context<'_, '_>) -> Result<Subject, u8> {
    let opened = GraphFile::open(&args.file, cx.registry, &args.set, &args.engine.allow);
    let file = opened.map_err(|diagnostics| {
        print(cx.console, &diagnostics);
        status(&diagnostics)
    })?;
    let shown = shown(&file.plan, args.result.as_deref(), cx)?;
    let field = args
        .field
        .as_deref()
        .and_then(|name| find(&file.plan, name, Kind::Field));
    let evaluation = evaluate(args, &file, [Some(shown), field], cx)?;
    let Some(Value::Mesh(mesh)) = evaluation.value(shown) else {
        return Err(FAILED);
    };
    let field = match (
        &args.field,
        field.and_then(|field| evaluation.value(field).zip(Some(field))),
    ) {
        (Some(name), Some((Value::Field(found), result))) => {
            let quantity = file.plan.result_spec(result).quantity;
            Some(painted(
                Arc::clone(found),
                name,
                quantity,
                Some(file.plan.units),
            ))
        }
        (Some(name), _) => {
            let names = names_of(&file.plan, Kind::Field);
            let units = Some(file.plan.units);
            Some(of_attribute(mesh, name, units).ok_or_else(|| no_field(mesh, name, &names, cx))?)
        }
        (None, _) => None,
    };
    let mesh = Arc::clone(mesh);
    let texts = texts(&args.file, Some(&file.plan), Some(shown));
    Ok(Subject { mesh, field, texts })
}

/// What a picture says of itself: the program, the file and the result, and every
/// parameter as written, in the file's units, a line each.
fn texts(
    file: &Path,
    plan: Option<&Plan>,
    shown: Option<ResultRef>,
) -> Vec<(&'static str, String)> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let node = plan
        .zip(shown)
        .map(|(plan, shown)| &plan.nodes[shown.node].name);
    let title = node.map_or_else(|| name.to_string(), |node| format!("{name} · {node}"));
    let program = format!("tessgraph {}", env!("CARGO_PKG_VERSION"));
    let mut texts = vec![("Software", program), ("Title", title)];
    if let Some(plan) = plan.filter(|plan| !plan.parameters.is_empty()) {
        let lines = plan.parameters.iter().map(|parameter| {
            let value = match &parameter.value {
                // With all digits, so that the picture can be made again.
                Value::Number(number) => number.to_string(),
                other => other.summary(),
            };
            format!("{} = {value}", parameter.name)
        });
        texts.push(("Parameters", lines.collect::<Vec<_>>().join("\n")));
    }
    texts
}

/// Computes what is wanted, and shows what is wrong.
fn evaluate(
    args: &RenderArgs,
    file: &GraphFile,
    wanted: [Option<ResultRef>; 2],
    cx: &mut Context<'_, '_>,
) -> Result<Evaluation, u8> {
    let pool = args
        .engine
        .pool()
        .map_err(|message| cx.fail(FAILED, "threads", message, None))?;
    let bytes = args.engine.cache_bytes();
    let engine = args.engine.caching(cx.cache.as_deref(), bytes);
    let wanted: Vec<_> = wanted.into_iter().flatten().collect();
    let names = file
        .plan
        .nodes
        .iter()
        .map(|node| node.name.clone())
        .collect();
    let never = AtomicBool::new(false);
    let progress = Progress::new(names, &never);
    let live = cx.console.is_live();
    let evaluation = pool.install(|| {
        progress.during(live, || {
            engine.evaluate(&file.plan, &wanted, &file.world, &progress)
        })
    });
    if evaluation.cancelled {
        return Err(INTERRUPTED);
    }
    print(cx.console, &evaluation.diagnostics);
    if evaluation.is_ok() {
        Ok(evaluation)
    } else {
        Err(FAILED)
    }
}

/// The mesh to draw: the one that is named, or the first that is an output.
fn shown(plan: &Plan, name: Option<&str>, cx: &mut Context<'_, '_>) -> Result<ResultRef, u8> {
    let found = match name {
        Some(name) => find(plan, name, Kind::Mesh),
        None => {
            let mut outputs = plan.outputs.iter().map(|output| output.result);
            outputs.find(|&result| plan.result_spec(result).kind == Kind::Mesh)
        }
    };
    found.ok_or_else(|| {
        let names = names_of(plan, Kind::Mesh);
        let message = match name {
            Some(name) => format!("the graph has no mesh `{}`", printable(name)),
            None => "no output of the graph is a mesh".to_owned(),
        };
        let near = name.and_then(|name| did_you_mean(name, names.iter().map(String::as_str)));
        let help = near.unwrap_or_else(|| format!("its meshes are {}", listed(&names)));
        cx.fail(USAGE, "unknown_result", message, Some(help))
    })
}

/// The result called `node` or `node.result`, if it is of that kind.
fn find(plan: &Plan, name: &str, kind: Kind) -> Option<ResultRef> {
    let is_fitting = |result: &ResultRef| plan.result_spec(*result).kind == kind;
    plan.result(name).filter(is_fitting)
}

/// All results of that kind.
fn results(plan: &Plan, kind: Kind) -> impl Iterator<Item = ResultRef> {
    plan.nodes
        .iter()
        .enumerate()
        .flat_map(move |(index, node)| {
            let outputs = node.spec.outputs.iter().enumerate();
            let fitting = outputs.filter(move |(_, output)| output.kind == kind);
            fitting.map(move |(result, _)| ResultRef {
                node: index,
                result,
            })
        })
}

fn names_of(plan: &Plan, kind: Kind) -> Vec<String> {
    let name = |result: ResultRef| {
        let node = &plan.nodes[result.node];
        match result.result {
            0 => node.name.clone(),
            index => format!("{}.{}", node.name, node.spec.outputs[index].name),
        }
    };
    results(plan, kind).map(name).collect()
}

fn listed(names: &[String]) -> String {
    let names: Vec<_> = names
        .iter()
        .map(|name| format!("`{}`", printable(name)))
        .collect();
    names.join(", ")
}

/// A numeric attribute of vertices or faces as a field.
fn of_attribute(mesh: &Mesh, name: &str, units: Option<Units>) -> Option<Painted> {
    let field = [Domain::Face, Domain::Vertex]
        .into_iter()
        .find_map(|domain| {
            let values = mesh.attribute(name, domain)?.values().numbers()?;
            Field::new(domain, Quantity::Number, values).ok()
        })?;
    Some(painted(Arc::new(field), name, Quantity::Number, units))
}

fn painted(field: Arc<Field>, name: &str, quantity: Quantity, units: Option<Units>) -> Painted {
    let sign = units
        .map(|units| units.quantity_sign(quantity))
        .unwrap_or_default();
    Painted {
        title: if sign.is_empty() {
            name.to_owned()
        } else {
            format!("{name} [{sign}]")
        },
        factor: units.map_or(1.0, |units| units.from_si(1.0, quantity)),
        field,
    }
}

fn no_field(mesh: &Mesh, name: &str, results: &[String], cx: &mut Context<'_, '_>) -> u8 {
    let message = format!("there is no field `{}` for this mesh", printable(name));
    let attributes = mesh.attributes().iter().filter(|attribute| {
        attribute.values().is_numeric() && attribute.domain() != Domain::Corner
    });
    let names: Vec<_> = { attributes.map(|attribute| attribute.name().to_owned()) }
        .chain(results.iter().cloned())
        .collect();
    let help = match names.as_slice() {
        [] => "it has no numeric attributes".to_owned(),
        names => did_you_mean(name, names.iter().map(String::as_str))
            .unwrap_or_else(|| format!("there are {}", listed(names))),
    };
    cx.fail(USAGE, "unknown_field", message, Some(help))
}
