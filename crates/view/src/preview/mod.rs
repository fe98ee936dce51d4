//! How a picture follows a parameter before the graph is evaluated.
//!
//! A node says that its result is an array, of which parts, and by which of its
//! inputs heights are scaled. What a parameter drives is found by checking the graph
//! with other values of it: no expression is looked into.

mod drive;
mod instances;

use tessgraph_geometry::Mesh;
use tessgraph_graph::plan::{Origin, Plan, ResultRef};
use tessgraph_graph::value::Kind;
use tessgraph_graph::world::MemoryWorld;
use tessgraph_graph::{EvalCx, Evaluation, Value};

use crate::buffers::Buffers;
use crate::protocol::Previewed;
use crate::shown::{Subject, mesh_inputs};

/// What a page wants to follow: a parameter, while it shows something.
pub struct Following<'a> {
    /// The plan and the evaluation of the last run.
    pub plan: &'a Plan,
    /// The same.
    pub evaluation: &'a Evaluation,
    /// What is shown of it.
    pub subject: &'a Subject,
    /// Plans that differ in the parameter, with its values, ascending.
    pub samples: &'a [(f64, Plan)],
}

/// What has to be asked for so that a picture of `shown` can follow parameters.
pub(crate) fn wanted(plan: &Plan, shown: ResultRef) -> Vec<ResultRef> {
    let mut wanted = Vec::new();
    for node in line(plan, shown.node) {
        wanted.push(ResultRef { node, result: 0 });
        if is_array(plan, node) {
            let inputs = plan.nodes[node].inputs.iter();
            wanted.extend(inputs.flat_map(|input| input.origin.results()));
        }
    }
    wanted
}

/// A node, the one whose mesh it takes first, and so on to the first array.
fn line(plan: &Plan, node: usize) -> Vec<usize> {
    let mut line = vec![node];
    let mut last = node;
    while !is_array(plan, last)
        && let Some(above) = mesh_inputs(plan, last).first()
    {
        last = above.node;
        line.push(last);
    }
    // Without an array nothing of it is of use.
    if is_array(plan, last) {
        line
    } else {
        Vec::new()
    }
}

fn is_array(plan: &Plan, node: usize) -> bool {
    let spec = plan.nodes[node].spec;
    spec.preview.parts.is_some()
        && spec
            .outputs
            .first()
            .is_some_and(|main| main.kind == Kind::Mesh)
}

/// Whether the node's mesh has the vertices and faces of `mesh`.
fn has_shape(evaluation: &Evaluation, node: usize, mesh: &Mesh) -> bool {
    match evaluation.value(ResultRef { node, result: 0 }) {
        Some(Value::Mesh(other)) => {
            other.topology().digest() == mesh.topology().digest()
                && other.positions().digest() == mesh.positions().digest()
        }
        _ => false,
    }
}

/// The array whose vertices are shown, if they are those of one.
fn array_under(following: &Following<'_>) -> Option<usize> {
    let Following {
        plan,
        evaluation,
        subject,
        ..
    } = following;
    let node = plan.node_index(&subject.node)?;
    let node = *line(plan, node).last()?;
    has_shape(evaluation, node, &subject.mesh).then_some(node)
}

/// What a page needs to follow the parameter, or why it cannot. The evaluation must
/// have been asked for what [`crate::shown::wanted`] names.
///
/// Cost: O(vertices), for the array's parts.
pub fn preview(buffers: &Buffers, following: &Following<'_>) -> Previewed {
    match try_preview(buffers, following) {
        Ok(previewed) => previewed,
        Err(reason) => Previewed {
            reason: Some(reason),
            ..Previewed::default()
        },
    }
}

fn try_preview(buffers: &Buffers, following: &Following<'_>) -> Result<Previewed, String> {
    let array = array_under(following).ok_or("what is shown is no array of components")?;
    let Following {
        plan, evaluation, ..
    } = following;
    let drive = drive::drive(plan, following.samples, array)?;
    let planned = &plan.nodes[array];
    let arguments = evaluation.arguments(plan, array);
    let arguments = arguments.ok_or("what the array is made of is not at hand")?;
    let (world, monitor) = (MemoryWorld::default(), tessgraph_geometry::Unmonitored);
    let cx = EvalCx::new(&world, &monitor, planned.units, Vec::new());
    let parts = planned.spec.preview.parts;
    let parts = parts.map(|take_apart| take_apart(arguments, &cx));
    let parts = match parts {
        Some(Ok(Some(parts))) => parts,
        Some(Err(error)) => return Err(error.message().to_owned()),
        _ => return Err("every vertex of the array is compensated by itself".to_owned()),
    };
    let mesh = &following.subject.mesh;
    if parts.vertices.len() != mesh.vertex_count() {
        return Err("the array has lost vertices since it was made".to_owned());
    }
    Ok(Previewed {
        instances: Some(instances::instances(buffers, &parts, mesh)),
        factors: drive.factors,
        is_exact: drive.is_exact,
        ..Previewed::default()
    })
}

/// Whether both are the same before anything runs.
fn same(one: &Origin, other: &Origin) -> bool {
    match (one, other) {
        (Origin::Absent, Origin::Absent) => true,
        (Origin::Constant(one), Origin::Constant(other)) => one.digest() == other.digest(),
        (Origin::Result(one), Origin::Result(other)) => one == other,
        (Origin::Expression(one), Origin::Expression(other)) => one == other,
        (Origin::Formula(one), Origin::Formula(other)) => one == other,
        (Origin::List(one), Origin::List(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(one, other)| same(one, other))
        }
        (Origin::Vector(one), Origin::Vector(other)) => one
            .iter()
            .zip(other.iter())
            .all(|(one, other)| same(one, other)),
        _ => false,
    }
}
