//! Formulas evaluated over the elements of a mesh.

use glam::{DVec2, DVec3};
use tessgraph_geometry::{AttributeValues, Domain, Mesh, NO_EDGE, parallel};
use tessgraph_graph::expr::Formula;
use tessgraph_graph::{EvalCx, NodeError};
use tessgraph_macros::Choice;

/// The elements a formula is evaluated on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum Elements {
    /// One value per vertex; x, y, z are its position.
    Vertices,
    /// One value per face; x, y, z are the mean of its corners.
    Faces,
    /// One value per corner; x, y, z are the position of its vertex.
    Corners,
    /// One value per edge, kept on the corners it leaves; x, y, z are its midpoint.
    Edges,
}

impl Elements {
    /// The domain the values are stored on.
    pub(crate) fn domain(self) -> Domain {
        match self {
            Self::Vertices => Domain::Vertex,
            Self::Faces => Domain::Face,
            Self::Corners | Self::Edges => Domain::Corner,
        }
    }
}

/// How many variables one formula may use; far more than anybody reads.
const MAX_VARIABLES: usize = 32;

/// Where a variable's value is found.
enum Variable {
    X,
    Y,
    Z,
    U(Vec<DVec2>),
    V(Vec<DVec2>),
    Index,
    Attribute(Vec<f64>),
}

/// The formula's value at every element, one per element of the domain.
///
/// # Errors
/// A variable the mesh does not have, or a value that is not finite.
pub(crate) fn evaluate(
    formula: &Formula,
    mesh: &Mesh,
    on: Elements,
    input: &'static str,
    cx: &EvalCx<'_>,
) -> Result<Vec<f64>, NodeError> {
    let names = formula.names();
    if names.len() > MAX_VARIABLES {
        let message = format!("a formula uses at most {MAX_VARIABLES} variables");
        return Err(NodeError::new(message).at_input(input));
    }
    let variables: Vec<Variable> = names
        .iter()
        .map(|name| variable(name, mesh, on).map_err(|error| error.at_input(input)))
        .collect::<Result<_, _>>()?;
    let count = mesh.element_count(on.domain());
    let values = parallel::map(count, cx.monitor(), |element| {
        let place = place(mesh, on, element);
        let mut inputs = [0.0; MAX_VARIABLES];
        for (slot, variable) in inputs.iter_mut().zip(&variables) {
            *slot = match variable {
                Variable::X => place.x,
                Variable::Y => place.y,
                Variable::Z => place.z,
                Variable::U(uv) => uv[element].x,
                Variable::V(uv) => uv[element].y,
                Variable::Index => element as f64,
                Variable::Attribute(values) => values[element],
            };
        }
        formula.evaluate(&inputs[..variables.len()])
    })?;
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(element) => {
            let (domain, value) = (on.domain(), values[element]);
            Err(
                NodeError::new(format!("the formula gives {value} at {domain} {element}"))
                    .with_help(
                        "guard divisions and roots with `if(...)`, `max(...)` or `clamp(...)`",
                    )
                    .at_input(input),
            )
        }
    }
}

fn variable(name: &str, mesh: &Mesh, on: Elements) -> Result<Variable, NodeError> {
    Ok(match name {
        "x" => Variable::X,
        "y" => Variable::Y,
        "z" => Variable::Z,
        "index" => Variable::Index,
        "u" => Variable::U(uv(mesh, on)?),
        "v" => Variable::V(uv(mesh, on)?),
        other => Variable::Attribute(attribute(other, mesh, on)?),
    })
}

/// The position that x, y and z stand for at an element.
fn place(mesh: &Mesh, on: Elements, element: usize) -> DVec3 {
    let positions = mesh.positions();
    let corners = mesh.topology().corners();
    match on {
        Elements::Vertices => positions[element],
        Elements::Corners => positions[corners[element] as usize],
        Elements::Faces => {
            let face = mesh.face(element);
            let sum: DVec3 = face.iter().map(|&vertex| positions[vertex as usize]).sum();
            sum / face.len() as f64
        }
        Elements::Edges => {
            let adjacency = mesh.topology().adjacency();
            match adjacency.corner_edges()[element] {
                NO_EDGE => positions[corners[element] as usize],
                edge => {
                    let [a, b] = adjacency.edge(edge as usize);
                    (positions[a as usize] + positions[b as usize]) * 0.5
                }
            }
        }
    }
}

/// The first texture coordinates at each element; a vertex or face takes the
/// mean of its corners.
pub(crate) fn uv(mesh: &Mesh, on: Elements) -> Result<Vec<DVec2>, NodeError> {
    let layer = mesh
        .attributes()
        .iter()
        .find_map(|attribute| match attribute.values() {
            AttributeValues::Vector2(values) if attribute.domain() != Domain::Face => {
                Some((attribute.domain(), values))
            }
            _ => None,
        });
    let Some((domain, values)) = layer else {
        return Err(
            NodeError::new("u and v are asked for, but the mesh has no UV layer")
                .with_help("read a mesh with texture coordinates, or use x, y and z"),
        );
    };
    let at_corners: Vec<DVec2> = match domain {
        Domain::Corner => values.to_vec(),
        _ => mesh
            .topology()
            .corners()
            .iter()
            .map(|&vertex| values[vertex as usize])
            .collect(),
    };
    Ok(from_corners(mesh, on, &at_corners))
}

/// A numeric attribute at each element: its own value where it is on that
/// domain, else the mean over the corners.
fn attribute(name: &str, mesh: &Mesh, on: Elements) -> Result<Vec<f64>, NodeError> {
    let own = mesh.attribute(name, on.domain());
    if let Some(values) = own.and_then(|attribute| attribute.values().numbers()) {
        return Ok(values);
    }
    let corners = mesh.topology().corners();
    let at_corners = [Domain::Vertex, Domain::Corner, Domain::Face]
        .iter()
        .find_map(|&domain| {
            let values = mesh.attribute(name, domain)?.values().numbers()?;
            Some(match domain {
                Domain::Vertex => corners
                    .iter()
                    .map(|&vertex| values[vertex as usize])
                    .collect(),
                Domain::Corner => values,
                Domain::Face => {
                    let faces = mesh.topology().adjacency().corner_faces();
                    faces.iter().map(|&face| values[face as usize]).collect()
                }
            })
        });
    match at_corners {
        Some(at_corners) => Ok(from_corners(mesh, on, &at_corners)),
        None => Err(unknown_variable(name, mesh)),
    }
}

fn unknown_variable(name: &str, mesh: &Mesh) -> NodeError {
    let names: Vec<_> = mesh
        .attributes()
        .iter()
        .filter(|attribute| attribute.values().is_numeric())
        .map(|attribute| format!("`{}`", attribute.name()))
        .collect();
    let has = if names.is_empty() {
        "the mesh has no numeric attributes".to_owned()
    } else {
        format!("the mesh has {}", names.join(", "))
    };
    let message = format!("`{name}` is neither a variable, a parameter nor a numeric attribute");
    NodeError::new(message).with_help(format!("{has}; variables are x, y, z, u, v and index"))
}

/// Means over the corners of each element; an element without corners gets the
/// default.
fn from_corners<T>(mesh: &Mesh, on: Elements, at_corners: &[T]) -> Vec<T>
where
    T: Copy + Default + std::ops::Add<Output = T> + std::ops::Div<f64, Output = T>,
{
    let mean = |corners: &mut dyn Iterator<Item = usize>| {
        let (mut sum, mut count) = (T::default(), 0usize);
        for corner in corners {
            (sum, count) = (sum + at_corners[corner], count + 1);
        }
        if count == 0 { sum } else { sum / count as f64 }
    };
    let adjacency = mesh.topology().adjacency();
    match on {
        Elements::Vertices => (0..mesh.vertex_count())
            .map(|v| mean(&mut adjacency.vertex_corners(v).iter().map(|&c| c as usize)))
            .collect(),
        Elements::Faces => (0..mesh.face_count())
            .map(|face| mean(&mut mesh.topology().corner_range(face)))
            .collect(),
        Elements::Corners => at_corners.to_vec(),
        Elements::Edges => (0..mesh.corner_count())
            .map(|corner| match adjacency.corner_edges()[corner] {
                NO_EDGE => at_corners[corner],
                edge => {
                    let range = adjacency.edge_corners(edge as usize).iter();
                    mean(&mut range.map(|&c| c as usize))
                }
            })
            .collect(),
    }
}
