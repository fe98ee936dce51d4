//! What the 3D view shows of a result: a mesh, what lies on it, and tables.

mod fields;
mod memo;
mod mesh;
mod tables;
mod told;

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use tessgraph_geometry::digest::Digest;
use tessgraph_geometry::{Directions, Field, Mesh, join};
use tessgraph_graph::node::OutputSpec;
use tessgraph_graph::plan::{Origin, ResultRef};
use tessgraph_graph::value::{Kind, Report, ReportEntry, Scalar};
use tessgraph_graph::{Evaluation, Plan, Units, Value};

use crate::buffers::Buffers;
use crate::document::kind_name;
use crate::protocol::{Coming, Shown, ShownField};
use crate::values::entries;
use fields::{Hanger, Ranges};
use memo::Memo;
use told::Told;

pub(crate) use mesh::{all, origin_of, triples};

/// Makes pictures of results.
pub struct Gallery {
    buffers: Arc<Buffers>,
    /// The topology's digest of each mesh seen, by the mesh's digest: whether a
    /// field fits is asked of many meshes that need not be loaded for it.
    topologies: Memo<Digest>,
    /// Whether the last mesh of each topology had all its faces cut into fans.
    fans: Memo<bool>,
    /// Smallest and largest of the numbers of each digest.
    ranges: Ranges,
    told: Mutex<Told>,
}

/// A picture of a result.
#[derive(Debug, Clone)]
pub struct Picture {
    /// What the page is told.
    pub shown: Shown,
    /// What it is told of, exactly.
    pub subject: Option<Subject>,
    /// Whether it takes for granted how faces are cut, see [`Gallery::holds`].
    pub is_guess: bool,
}

/// A mesh that is shown, and the fields on it.
#[derive(Debug, Clone)]
pub struct Subject {
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The node that made it.
    pub node: String,
    /// The unit in which people are told about it.
    pub units: Units,
    /// Fields of nodes that fit it, with what people call them.
    pub fields: Vec<(String, Arc<Field>)>,
}

/// What is shown unless somebody asks for something else: the first output that
/// is a mesh, else the first.
pub fn default_result(plan: &Plan) -> Option<ResultRef> {
    let mut outputs = plan.outputs.iter().map(|output| output.result);
    let is_mesh = |result: &ResultRef| plan.result_spec(*result).kind == Kind::Mesh;
    let first = plan.outputs.first().map(|output| output.result);
    outputs.find(is_mesh).or(first)
}

/// What has to be evaluated to show these results besides the graph's outputs, and to
/// tell what the graph checks: the outputs first, each result once.
pub fn wanted(plan: &Plan, shown: &[ResultRef]) -> Vec<ResultRef> {
    let mut wanted: Vec<ResultRef> = plan.outputs.iter().map(|output| output.result).collect();
    wanted.extend(shown);
    let needed = plan.needed(wanted.iter().copied());
    for (node, planned) in plan.nodes.iter().enumerate() {
        if !needed[node] {
            continue;
        }
        let is_rule = matches!(planned.spec.outputs, [only] if only.kind == Kind::Bool);
        for (result, spec) in planned.spec.outputs.iter().enumerate() {
            let result = ResultRef { node, result };
            match spec.kind {
                Kind::Field | Kind::Directions => {
                    wanted.push(result);
                    wanted.extend(mesh_inputs(plan, node));
                }
                Kind::Report => wanted.push(result),
                Kind::Bool if is_rule => wanted.push(result),
                _ => {}
            }
        }
    }
    for shown in shown {
        wanted.extend(mesh_inputs(plan, shown.node));
        wanted.extend(crate::preview::wanted(plan, *shown));
    }
    let mut seen = BTreeSet::new();
    wanted.retain(|result| seen.insert(*result));
    wanted
}

/// The meshes that a node takes.
pub(crate) fn mesh_inputs(plan: &Plan, node: usize) -> Vec<ResultRef> {
    let planned = &plan.nodes[node];
    let inputs = planned.spec.inputs.iter().zip(&planned.inputs);
    inputs
        .filter(|(spec, _)| spec.kind == Kind::Mesh)
        .filter_map(|(_, input)| match input.origin {
            Origin::Result(result) => Some(result),
            _ => None,
        })
        .collect()
}

/// For each node whether it leads to `node`, follows from it, or is it.
fn kin(plan: &Plan, node: usize) -> Vec<bool> {
    let leads = plan.needed([ResultRef { node, result: 0 }]);
    let mut follows = vec![false; plan.nodes.len()];
    follows[node] = true;
    // Each node comes after all that it depends on.
    for from in node + 1..plan.nodes.len() {
        let inputs = plan.nodes[from].inputs.iter();
        let mut needs = inputs.flat_map(|input| input.origin.results());
        follows[from] = needs.any(|result| follows[result.node]);
    }
    leads
        .iter()
        .zip(&follows)
        .map(|(&leads, &follows)| leads || follows)
        .collect()
}

/// A result of an evaluation, and what is known about it.
struct Exhibit<'a> {
    plan: &'a Plan,
    evaluation: &'a Evaluation,
    result: ResultRef,
}

impl Exhibit<'_> {
    fn name(&self) -> &str {
        &self.plan.nodes[self.result.node].name
    }

    fn spec(&self) -> &'static OutputSpec {
        self.plan.result_spec(self.result)
    }
}

impl Gallery {
    /// A gallery whose pictures lie in `buffers`.
    pub fn new(buffers: Arc<Buffers>) -> Self {
        Self {
            buffers,
            topologies: Memo::default(),
            fans: Memo::default(),
            ranges: Ranges::default(),
            told: Mutex::default(),
        }
    }

    /// What a picture of `value` will need, which is begun; `None` where that is
    /// nothing large.
    ///
    /// Cost: O(vertices) for the box of a mesh.
    pub fn foresee(&self, value: &Value) -> Option<Coming> {
        let Value::Mesh(mesh) = value else {
            return None;
        };
        let positions = mesh::begin(&self.buffers, mesh);
        Some(Coming { positions })
    }

    /// A picture of `result`; `None` if it could not be computed. [`wanted`] says
    /// what the evaluation must have been asked for. It may be a guess: then
    /// [`Gallery::holds`] says whether it is true.
    ///
    /// Cost: O(size of the mesh) for what is new about it; buffers that were made
    /// before are named again.
    pub fn picture(
        &self,
        plan: &Plan,
        evaluation: &Evaluation,
        result: ResultRef,
    ) -> Option<Picture> {
        let exhibit = Exhibit {
            plan,
            evaluation,
            result,
        };
        let value = evaluation.value(result)?;
        let mut shown = Shown {
            node: exhibit.name().to_owned(),
            result: exhibit.spec().name.to_owned(),
            kind: kind_name(exhibit.spec().kind),
            ..Shown::default()
        };
        match value {
            Value::Table(table) => shown.table = Some(tables::table(table, plan.units)),
            Value::Report(report) => shown.report = Some(entries(report, plan.units)),
            value => shown.report = self::single(exhibit.spec(), value, plan.units),
        }
        let mesh = self.mesh_of(&exhibit, value);
        let fans = mesh.as_ref().map(|mesh| self.fans(mesh));
        let fans = fans.unwrap_or_default();
        let subject = mesh.map(|mesh| self.hang(&exhibit, value, (mesh, fans.all), &mut shown));
        if subject.is_none() && shown.report.is_none() && shown.table.is_none() {
            shown.empty = Some(format!("`{}` gives nothing that can be drawn", shown.node));
        }
        Some(Picture {
            shown,
            subject,
            is_guess: fans.is_guess,
        })
    }

    /// How the faces of a mesh are cut. While corners move that seldom changes: it is
    /// looked at, which takes as long as all the rest, when the picture was told.
    fn fans(&self, mesh: &Mesh) -> Fans {
        let topology = mesh.topology().digest();
        if self.fans.look(topology) == Some(true) {
            return Fans {
                all: true,
                is_guess: true,
            };
        }
        let all = mesh.is_cut_into_fans();
        self.fans.put(topology, all);
        Fans {
            all,
            is_guess: false,
        }
    }

    /// Whether a picture that was a guess is true. If not, another one of the same
    /// mesh will be none: a face is cut otherwise, now that its corners have moved.
    ///
    /// Cost: O(corners).
    pub fn holds(&self, subject: &Subject) -> bool {
        let mesh = &subject.mesh;
        let is_fans = mesh.is_cut_into_fans();
        self.fans.put(mesh.topology().digest(), is_fans);
        is_fans
    }

    /// Puts the mesh and what fits it into the picture.
    fn hang(
        &self,
        exhibit: &Exhibit<'_>,
        value: &Value,
        (mesh, is_fans): (Arc<Mesh>, bool),
        shown: &mut Shown,
    ) -> Subject {
        let units = exhibit.plan.units;
        if mesh.face_count() == 0 {
            shown.empty = Some(empty(exhibit, &mesh));
        }
        // Not all results are foreseen.
        mesh::begin(&self.buffers, &mesh);
        shown.mesh = Some(mesh::mesh(&self.buffers, &mesh, units, is_fans));
        let found = self.laid_over(exhibit, &mesh);
        let directions = match value {
            Value::Directions(directions) => Some(directions),
            _ => found.directions.as_ref(),
        };
        shown.directions = directions.map(|directions| mesh::directions(&self.buffers, directions));
        let hanger = Hanger {
            buffers: &self.buffers,
            ranges: &self.ranges,
        };
        let mut fields = Vec::new();
        for (node, name, field) in &found.fields {
            fields.push(hanger.of_node(node, name, field, units));
        }
        let known = fields.iter().map(|field| field.label.clone());
        let exact = known.zip(&found.fields);
        let exact = exact.map(|(label, (_, _, field))| (label, Arc::clone(field)));
        let exact = exact.collect();
        fields.extend(hanger.attributes(&mesh, &shown.node));
        shown.fields = distinct(fields);
        self.prepare(&shown.fields);
        Subject {
            node: shown.node.clone(),
            units,
            fields: exact,
            mesh,
        }
    }

    /// The mesh that a result is, or lies on.
    fn mesh_of(&self, exhibit: &Exhibit<'_>, value: &Value) -> Option<Arc<Mesh>> {
        let inputs = mesh_inputs(exhibit.plan, exhibit.result.node);
        let mut inputs =
            inputs
                .into_iter()
                .filter_map(|input| match exhibit.evaluation.value(input) {
                    Some(Value::Mesh(mesh)) => Some(Arc::clone(mesh)),
                    _ => None,
                });
        match value {
            Value::Mesh(mesh) => Some(Arc::clone(mesh)),
            Value::List(items) => {
                let meshes = items.iter().filter_map(|item| match item {
                    Value::Mesh(mesh) => Some(mesh.as_ref()),
                    _ => None,
                });
                let meshes: Vec<&Mesh> = meshes.collect();
                let joined = (!meshes.is_empty()).then(|| join(&meshes).ok())?;
                joined.map(Arc::new)
            }
            Value::Directions(directions) => {
                inputs.find(|mesh| mesh.topology().digest() == directions.topology().digest())
            }
            Value::Field(field) => inputs.find(|mesh| fits(field, mesh)),
            _ => None,
        }
    }

    /// The fields and directions that lie on the mesh: those of nodes that took
    /// it, or one with the same faces that it was made from or that was made of it.
    /// Variants side by side have the same faces, too, and are something else.
    fn laid_over(&self, exhibit: &Exhibit<'_>, mesh: &Arc<Mesh>) -> LaidOver {
        let (plan, evaluation) = (exhibit.plan, exhibit.evaluation);
        let topology = mesh.topology().digest();
        let kin = kin(plan, exhibit.result.node);
        let mut found = LaidOver::default();
        for (node, planned) in plan.nodes.iter().enumerate() {
            let results = planned.spec.outputs.iter().enumerate();
            let mut takes = None;
            for (result, spec) in results {
                if !matches!(spec.kind, Kind::Field | Kind::Directions) {
                    continue;
                }
                let takes = *takes.get_or_insert_with(|| {
                    let inputs = mesh_inputs(plan, node).into_iter();
                    let mut inputs = inputs.filter(|input| kin[input.node]);
                    inputs.any(|input| self.topology_of(evaluation, input) == Some(topology))
                });
                if !takes {
                    continue;
                }
                match evaluation.value(ResultRef { node, result }) {
                    Some(Value::Field(field)) if fits(field, mesh) => {
                        let (node, name) = (planned.name.clone(), spec.name);
                        found.fields.push((node, name, Arc::clone(field)));
                    }
                    Some(Value::Directions(directions))
                        if directions.topology().digest() == topology =>
                    {
                        found.directions = Some(Arc::clone(directions));
                    }
                    _ => {}
                }
            }
        }
        found
    }

    /// The digest of a mesh's topology; the mesh is loaded only if it is new.
    fn topology_of(&self, evaluation: &Evaluation, mesh: ResultRef) -> Option<Digest> {
        let digest = evaluation.digest(mesh)?;
        self.topologies
            .get(digest, || match evaluation.value(mesh) {
                Some(Value::Mesh(mesh)) => Some(mesh.topology().digest()),
                _ => None,
            })
    }

    /// Where pictures lie.
    pub fn buffers(&self) -> &Buffers {
        &self.buffers
    }
}

/// Whether all faces of a mesh are cut into fans.
#[derive(Debug, Clone, Copy, Default)]
struct Fans {
    all: bool,
    is_guess: bool,
}

/// What lies on a mesh.
#[derive(Default)]
struct LaidOver {
    /// The node, the name of its result, and the field.
    fields: Vec<(String, &'static str, Arc<Field>)>,
    /// The last of several.
    directions: Option<Arc<Directions>>,
}

fn fits(field: &Field, mesh: &Mesh) -> bool {
    field.check(mesh, field.domain()).is_ok()
}

/// Why there is nothing to draw: what the node warned of, if it did.
fn empty(exhibit: &Exhibit<'_>, mesh: &Mesh) -> String {
    let warnings = &exhibit.evaluation.nodes[exhibit.result.node].warnings;
    match (warnings.first(), mesh.vertex_count()) {
        (Some(warning), _) => warning.clone(),
        (None, 0) => format!("`{}` is empty", exhibit.name()),
        (None, count) => format!("`{}` has {count} vertices and no faces", exhibit.name()),
    }
}

/// A result that is a single value, as a report of one line.
fn single(spec: &OutputSpec, value: &Value, units: Units) -> Option<Vec<crate::protocol::Entry>> {
    let scalar = match value {
        Value::Bool(value) => Scalar::Bool(*value),
        Value::Integer(number) => Scalar::Integer(*number),
        Value::Number(number) => Scalar::Number(*number),
        Value::Text(text) => Scalar::Text(Arc::clone(text)),
        Value::Vector(vector) => {
            let parts = vector.to_array();
            let line = |(name, part): (&str, f64)| ReportEntry {
                name: name.to_owned(),
                quantity: spec.quantity,
                value: Scalar::Number(part),
            };
            let lines = ["x", "y", "z"].into_iter().zip(parts).map(line);
            return Some(entries(&Report::new(lines.collect()), units));
        }
        _ => return None,
    };
    let report = Report::new(vec![ReportEntry {
        name: spec.name.to_owned(),
        quantity: spec.quantity,
        value: scalar,
    }]);
    Some(entries(&report, units))
}

/// The same fields with names of which there is one each.
fn distinct(mut fields: Vec<ShownField>) -> Vec<ShownField> {
    let mut seen = BTreeSet::new();
    for field in &mut fields {
        if !seen.insert(field.name.clone()) {
            field.name = format!("{} ({})", field.name, field.on);
            seen.insert(field.name.clone());
        }
    }
    fields
}
