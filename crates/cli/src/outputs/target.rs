//! Where the outputs go, settled before anything runs.

use std::path::{Path, PathBuf};

use tessgraph_graph::names::listing;
use tessgraph_graph::node::NodeSpec;
use tessgraph_graph::plan::{Origin, PlanNode, PlanOutput, ResultRef};
use tessgraph_graph::value::Kind;
use tessgraph_graph::{Diagnostic, Plan, Value};

use super::format::{FileFormat, extensions_for};
use crate::places::{is_same_file, locate};
use crate::text::printable;

/// An output that can be written as far as can be known beforehand.
#[derive(Debug)]
pub(crate) struct Target {
    /// Its path as written in the graph.
    pub(crate) name: String,
    /// Where it is written.
    pub(crate) path: PathBuf,
    /// In which format.
    pub(crate) format: FileFormat,
    /// What is written.
    pub(crate) result: ResultRef,
    /// The place of its path in the graph's text.
    pub(crate) span: std::ops::Range<usize>,
}

impl Target {
    /// Where the material library of an OBJ file goes.
    pub(crate) fn material_library(&self) -> Option<PathBuf> {
        let obj = FileFormat::Mesh(tessgraph_io::Format::Obj);
        (self.format == obj).then(|| self.path.with_extension("mtl"))
    }
}

/// The folders that matter to outputs.
pub(crate) struct Folders<'a> {
    /// The folder of the graph, from which its inputs are named.
    pub(crate) graph: &'a Path,
    /// The folder from which outputs are named.
    pub(crate) out: &'a Path,
    /// Further folders that may be written to.
    pub(crate) allowed: &'a [PathBuf],
    /// The graph file itself.
    pub(crate) file: &'a Path,
}

/// The targets of `outputs`, or everything that stands against them.
///
/// Refused are formats that do not hold the value, places outside the folders,
/// folders, devices, read-only files, inputs of the graph and two outputs in
/// one place.
pub(crate) fn targets(
    plan: &Plan,
    outputs: &[&PlanOutput],
    folders: &Folders<'_>,
    registry: &[NodeSpec],
) -> Result<Vec<Target>, Vec<Diagnostic>> {
    let inputs = input_places(plan, folders);
    let mut targets: Vec<Target> = Vec::new();
    let mut problems = Vec::new();
    for output in outputs {
        let target = match target(plan, output, folders, registry) {
            Ok(target) => target,
            Err(problem) => {
                problems.push(*problem);
                continue;
            }
        };
        if let Some(input) = inputs
            .iter()
            .find(|(_, input)| is_same_file(input, &target.path))
        {
            problems.push(onto_input(plan, &target, &input.0));
        } else if let Some(first) = targets.iter().find(|first| collide(first, &target)) {
            let message = format!(
                "two outputs are written to `{}`",
                printable(&target.path.to_string_lossy())
            );
            let problem = error(
                plan,
                "same_output",
                &target.span,
                message,
                "this one would replace the other",
            )
            .with_label(first.span.clone(), "already written here")
            .with_help("give each output a path of its own");
            problems.push(problem);
        } else {
            targets.push(target);
        }
    }
    if problems.is_empty() {
        Ok(targets)
    } else {
        Err(problems)
    }
}

/// The error for an output on a file that the graph reads as `input`.
pub(crate) fn onto_input(plan: &Plan, target: &Target, input: &str) -> Diagnostic {
    let message = format!(
        "output `{}` would overwrite an input of the graph, {}",
        printable(&target.name),
        format_args!("`{}`", printable(input))
    );
    error(
        plan,
        "output_is_input",
        &target.span,
        message,
        "also read by the graph",
    )
    .with_help("write to another path; `--out DIR` moves all outputs")
}

fn collide(one: &Target, other: &Target) -> bool {
    if is_same_file(&one.path, &other.path) {
        return true;
    }
    one.material_library().is_some() && one.material_library() == other.material_library()
}

fn target(
    plan: &Plan,
    output: &PlanOutput,
    folders: &Folders<'_>,
    registry: &[NodeSpec],
) -> Result<Target, Box<Diagnostic>> {
    let format = format(plan, output, registry)?;
    let fail = |code, message: String, remark: &str| {
        let help = "name another file; `--out DIR` moves all outputs";
        Box::new(error(plan, code, &output.span, message, remark).with_help(help))
    };
    let name = printable(&output.path);
    let path = locate(folders.out, Path::new(&output.path)).map_err(|reason| {
        let message = format!("`{name}` cannot be written: {reason}");
        fail("output_path", message, "this path")
    })?;
    let may_write =
        |folder: &Path| locate(folder, Path::new("")).is_ok_and(|folder| path.starts_with(folder));
    let allowed = folders.allowed.iter().map(PathBuf::as_path);
    if !allowed.chain([folders.out]).any(may_write) {
        let message = format!("output `{name}` lies outside the folder of outputs");
        let mut problem = fail("output_outside", message, "leads elsewhere");
        problem.help = Some(format!(
            "name a path below {}, or allow this one with `--allow {}`",
            printable(&folders.out.to_string_lossy()),
            printable(&path.parent().unwrap_or(&path).to_string_lossy())
        ));
        return Err(problem);
    }
    if let Some(what) = obstacle(&path) {
        let message = format!("`{name}` cannot be written: it {what}");
        return Err(fail("output_path", message, what));
    }
    let (name, span) = (output.path.clone(), output.span.clone());
    let result = output.result;
    Ok(Target {
        name,
        path,
        format,
        result,
        span,
    })
}

/// What at the path is in the way of a file.
fn obstacle(path: &Path) -> Option<&'static str> {
    let found = path.metadata().ok()?;
    if found.is_dir() {
        Some("is a folder")
    } else if !found.is_file() {
        Some("is not a plain file")
    } else if found.permissions().readonly() {
        Some("is read-only")
    } else {
        None
    }
}

/// The format of an output, if it holds what is to be written.
fn format(
    plan: &Plan,
    output: &PlanOutput,
    registry: &[NodeSpec],
) -> Result<FileFormat, Box<Diagnostic>> {
    let kind = plan.result_spec(output.result).kind;
    let chosen = FileFormat::of_path(&output.path);
    if let Some(format) = chosen
        && format.holds(kind)
    {
        return Ok(format);
    }
    let (name, label) = (printable(&output.path), kind.label());
    let this = format!("this would be {label}");
    let extensions = extensions_for(kind);
    let (code, message, remark, help) = if extensions.is_empty() {
        let help = match way_to_mesh(kind, registry) {
            Some(node) => format!("make a mesh of it with `{node}`"),
            None => "write a mesh, a table, a report or a number made of it".to_owned(),
        };
        let message = format!("{label} cannot be written to a file");
        ("output_kind", message, this, help)
    } else {
        let (message, remark) = match chosen {
            Some(_) => (format!("`{name}` cannot hold {label}"), this),
            None => {
                let message = format!("`{name}` names no format that can be written");
                (message, "by its extension".to_owned())
            }
        };
        let help = format!("{label} is written as {}", listing(extensions, "or"));
        ("output_format", message, remark, help)
    };
    Err(Box::new(
        error(plan, code, &output.span, message, &remark).with_help(help),
    ))
}

/// A node that makes one mesh of such a value.
fn way_to_mesh(kind: Kind, registry: &[NodeSpec]) -> Option<&str> {
    let takes = |spec: &&NodeSpec| {
        let main = spec
            .inputs
            .first()
            .is_some_and(|input| input.kind.accepts(kind));
        main && spec
            .outputs
            .first()
            .is_some_and(|output| output.kind == Kind::Mesh)
    };
    registry.iter().find(takes).map(|spec| spec.name)
}

fn error(
    plan: &Plan,
    code: &'static str,
    span: &std::ops::Range<usize>,
    message: String,
    remark: &str,
) -> Diagnostic {
    Diagnostic::error(code, &plan.source, span.clone(), message, remark)
}

/// A file that a node reads.
pub(crate) struct InputFile<'p> {
    /// The node.
    pub(crate) node: &'p PlanNode,
    /// Where its input is written, if it is not a default.
    pub(crate) span: Option<std::ops::Range<usize>>,
    /// The path as written.
    pub(crate) path: String,
}

/// The files that the graph names, by literals and parameters, in the plan's
/// order.
pub(crate) fn input_files(plan: &Plan) -> Vec<InputFile<'_>> {
    let mut files = Vec::new();
    for node in &plan.nodes {
        for (spec, input) in node.spec.inputs.iter().zip(&node.inputs) {
            if matches!(spec.kind, Kind::Path | Kind::List(Kind::Path)) {
                let mut paths = Vec::new();
                collect_texts(&input.origin, &mut paths);
                files.extend(paths.into_iter().map(|path| InputFile {
                    node,
                    span: input.span.clone(),
                    path,
                }));
            }
        }
    }
    files
}

/// The files the graph names as inputs, the graphs it includes, and itself: as
/// they are written, and where they lie.
fn input_places(plan: &Plan, folders: &Folders<'_>) -> Vec<(String, PathBuf)> {
    let files = input_files(plan).into_iter().map(|file| file.path);
    let named = files
        .chain(plan.included.iter().cloned())
        .map(|name| (locate(folders.graph, Path::new(&name)), name));
    let graph = folders.file.to_string_lossy().into_owned();
    let all = named.chain([(locate(Path::new(""), folders.file), graph)]);
    all.filter_map(|(place, name)| Some((name, place.ok()?)))
        .collect()
}

fn collect_texts(origin: &Origin, names: &mut Vec<String>) {
    match origin {
        Origin::Constant(value) => collect_values(value, names),
        Origin::List(items) => items.iter().for_each(|item| collect_texts(item, names)),
        _ => {}
    }
}

fn collect_values(value: &Value, names: &mut Vec<String>) {
    match value {
        Value::Text(name) => names.push(name.to_string()),
        Value::List(items) => items.iter().for_each(|item| collect_values(item, names)),
        _ => {}
    }
}
