//! What the tests share: running graphs in memory and looking at results.

pub(crate) mod page;
pub(crate) mod program;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use tessgraph_geometry::compensate::Errors;
use tessgraph_geometry::measure::{ThicknessOptions, measure_thickness};
use tessgraph_geometry::surface::Surface;
use tessgraph_geometry::{Mesh, Unmonitored};
use tessgraph_graph::check::LoadOptions;
use tessgraph_graph::plan::ResultRef;
use tessgraph_graph::world::{DiskWorld, MemoryWorld, World};
use tessgraph_graph::{Diagnostic, Engine, Evaluation, Plan, Silent, Value};
use tessgraph_io::{Format, ReadOptions, no_files};
use tessgraph_nodes::NODES;

/// The folder of the workspace.
pub(crate) fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests stand in the workspace")
        .into()
}

/// What is in a file that the test itself had written.
#[allow(clippy::disallowed_methods, reason = "tests read their own files")]
pub(crate) fn bytes_of(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// An OBJ file as a mesh.
pub(crate) fn read_obj(path: &Path) -> Result<Mesh, String> {
    #[allow(clippy::disallowed_methods, reason = "tests read their own files")]
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let name = path.file_name().map(|name| name.to_string_lossy());
    let loaded = tessgraph_io::read(
        Format::Obj,
        &name.unwrap_or_default(),
        &bytes,
        &mut no_files,
        &ReadOptions::default(),
        &Unmonitored,
    );
    loaded
        .map(|loaded| loaded.mesh)
        .map_err(|error| error.to_string())
}

/// A file of the workspace as text.
pub(crate) fn text_of(path: &Path) -> String {
    #[allow(clippy::disallowed_methods, reason = "tests read their own files")]
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Loads a graph, or shows what is wrong with it.
pub(crate) fn load(name: &str, text: &str) -> Plan {
    try_load(name, text).unwrap_or_else(|diagnostics| panic!("{}", shown(&diagnostics)))
}

/// The same with parameters set, as `--set name=value` does.
pub(crate) fn load_with(name: &str, text: &str, set: &[(&str, &str)]) -> Plan {
    let own = |&(name, value): &(&str, &str)| (name.to_owned(), value.to_owned());
    let options = LoadOptions {
        set: set.iter().map(own).collect(),
    };
    tessgraph_graph::load(name, text.as_bytes(), NODES, &options)
        .unwrap_or_else(|diagnostics| panic!("{}", shown(&diagnostics)))
}

pub(crate) fn try_load(name: &str, text: &str) -> Result<Plan, Vec<Diagnostic>> {
    tessgraph_graph::load(name, text.as_bytes(), NODES, &LoadOptions::default())
}

/// Loads a graph that includes others of `world`, or shows what is wrong.
pub(crate) fn load_in(name: &str, text: &str, world: &dyn World) -> Plan {
    try_load_in(name, text, world).unwrap_or_else(|diagnostics| panic!("{}", shown(&diagnostics)))
}

pub(crate) fn try_load_in(
    name: &str,
    text: &str,
    world: &dyn World,
) -> Result<Plan, Vec<Diagnostic>> {
    let options = LoadOptions::default();
    tessgraph_graph::load_with(name, text.as_bytes(), NODES, &options, world).plan
}

/// Diagnostics as text: code, position, message.
pub(crate) fn shown(diagnostics: &[Diagnostic]) -> String {
    let line = |diagnostic: &Diagnostic| {
        let place = diagnostic
            .labels
            .first()
            .map_or((0, 0), |label| diagnostic.source.position(label.span.start));
        let (code, message) = (diagnostic.code, &diagnostic.message);
        let help = diagnostic
            .help
            .as_deref()
            .map(|help| format!("\n    help: {help}"));
        format!(
            "{}:{}: [{code}] {message}{}",
            place.0,
            place.1,
            help.unwrap_or_default()
        )
    };
    diagnostics.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// A graph of nodes only, run in memory; `wanted` are node names.
pub(crate) struct Ran {
    pub(crate) plan: Plan,
    pub(crate) evaluation: Evaluation,
}

impl Ran {
    /// Runs all nodes of `body`, the inside of `nodes: { ... }`.
    pub(crate) fn nodes(body: &str, files: &[(&str, &str)]) -> Self {
        let outputs = last_node(body);
        let text = format!(
            "Graph(version: 1, nodes: {{\n{body}\n}}, outputs: {{\"out.json\": \"{outputs}\"}})"
        );
        Self::graph(&text, files)
    }

    /// Runs a whole graph text; everything in it is computed.
    pub(crate) fn graph(text: &str, files: &[(&str, &str)]) -> Self {
        let mut world = MemoryWorld::default();
        for (path, content) in files {
            world.insert(*path, content.as_bytes());
        }
        Self::run(load("test.ron", text), &world)
    }

    /// Runs everything in a plan.
    pub(crate) fn run(plan: Plan, world: &dyn World) -> Self {
        let wanted = everything(&plan);
        let evaluation = Engine::without_cache().evaluate(&plan, &wanted, world, &Silent);
        Self { plan, evaluation }
    }

    /// The value of "node" or "node.result".
    pub(crate) fn value(&self, name: &str) -> &Value {
        let (node, result) = name.split_once('.').unwrap_or((name, ""));
        let node = self
            .plan
            .node_index(node)
            .unwrap_or_else(|| panic!("no node {node}"));
        let outputs = self.plan.nodes[node].spec.outputs;
        let result = match result {
            "" => 0,
            name => outputs
                .iter()
                .position(|output| output.name == name)
                .unwrap_or_else(|| panic!("no result {name}")),
        };
        self.evaluation
            .value(ResultRef { node, result })
            .unwrap_or_else(|| panic!("{name}: {}", shown(&self.evaluation.diagnostics)))
    }

    pub(crate) fn mesh(&self, name: &str) -> Arc<Mesh> {
        match self.value(name) {
            Value::Mesh(mesh) => Arc::clone(mesh),
            other => panic!("{name} is {:?}", other.kind()),
        }
    }

    pub(crate) fn number(&self, name: &str) -> f64 {
        match self.value(name) {
            Value::Number(number) => *number,
            // Counts in tests stay far below 2^53.
            Value::Integer(number) => *number as f64,
            other => panic!("{name} is {:?}", other.kind()),
        }
    }

    pub(crate) fn count(&self, name: &str) -> i64 {
        match self.value(name) {
            Value::Integer(number) => *number,
            other => panic!("{name} is {:?}", other.kind()),
        }
    }

    /// Warnings of all nodes, "node: message".
    pub(crate) fn warnings(&self) -> Vec<String> {
        let of = |node: &tessgraph_graph::NodeRun| {
            let name = node.name.clone();
            node.warnings
                .clone()
                .into_iter()
                .map(move |warning| format!("{name}: {warning}"))
        };
        self.evaluation.nodes.iter().flat_map(of).collect()
    }

    /// What a person can judge: each output's summary, and all warnings.
    pub(crate) fn summary(&self, results: &[(String, ResultRef)]) -> String {
        let mut text = String::new();
        for (name, result) in results {
            text.push_str(&format!("== {name}\n"));
            match self.evaluation.value(*result) {
                Some(value) => text.push_str(value.summary().trim_end()),
                None => text.push_str("no value"),
            }
            text.push('\n');
        }
        for warning in self.warnings() {
            text.push_str(&format!("warning: {warning}\n"));
        }
        let errors = self.evaluation.diagnostics.iter();
        let errors: Vec<_> = errors
            .filter(|diagnostic| diagnostic.severity == tessgraph_graph::Severity::Error)
            .cloned()
            .collect();
        if !errors.is_empty() {
            text.push_str(&format!("errors:\n{}\n", shown(&errors)));
        }
        text
    }
}

/// All results of all nodes of a plan.
pub(crate) fn everything(plan: &Plan) -> Vec<ResultRef> {
    let results = |(node, planned): (usize, &tessgraph_graph::plan::PlanNode)| {
        (0..planned.spec.outputs.len()).map(move |result| ResultRef { node, result })
    };
    plan.nodes.iter().enumerate().flat_map(results).collect()
}

/// Errors of an array's vertices on one side of its base, each against its
/// height in the component, borders continued.
pub(crate) fn height_errors(mesh: &Mesh, base: &Surface, component: &Mesh, sign: f64) -> Errors {
    let options = ThicknessOptions::default();
    let measured = measure_thickness(mesh, base, &options, &Unmonitored).expect("a mesh");
    // An array holds the component's vertices in order, face by face.
    let heights = component.positions().iter().map(|p| p.z * sign).cycle();
    let distances = measured.field.values().iter();
    let side = distances.zip(heights).filter(|(_, height)| *height > 0.0);
    Errors::of(side.map(|(distance, height)| (distance / height - 1.0).abs()))
}

/// The files under a folder of the workspace.
pub(crate) fn world_of(folder: &Path) -> DiskWorld {
    DiskWorld::new(folder, &[]).unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
}

/// The name of the last node in the inside of `nodes: { ... }`.
fn last_node(body: &str) -> &str {
    let line = body
        .lines()
        .rev()
        .find(|line| line.trim_start().starts_with('"') && line.contains("\": "))
        .expect("a node per line");
    line.trim_start()
        .trim_start_matches('"')
        .split('"')
        .next()
        .expect("a name")
}
