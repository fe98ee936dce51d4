//! Which corner of a face comes first.

use std::sync::Arc;

use tessgraph_geometry::domains::{self, Along, chosen_faces};
use tessgraph_geometry::glam::DVec2;
use tessgraph_geometry::{Amount, AttributeValues, Domain, Mesh, border_turns};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

use crate::support::choice_of_components::{Per, first_of_source};

/// Turns the components of faces by quarters, by choosing their first corner.
///
/// After one turn the corner (0, 0) is where (0, 1) was. The surface stays the
/// same; a triangle turns by thirds. Turns are fixed, random by a seed, along a
/// layer of texture coordinates, uphill on a field, or towards open borders.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "height": EvaluateField(mesh: "base", value: "x"),
///     "out": RotateFaces(mesh: "base", by: Gradient, field: "height"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct RotateFaces {
    /// Mesh whose faces are turned.
    mesh: Arc<Mesh>,
    /// What decides about the turns.
    #[input(default = Turns)]
    by: By,
    /// Quarter turns, a number or one per face, rounded down; with another `by`
    /// they are added to what it gives. Left out: 1 for `by: Turns`, else 0.
    turns: Option<Amount>,
    /// Which faces are turned: those where this is 0.5 or more.
    #[input(default = 1.0)]
    faces: Amount,
    /// Start of the random numbers.
    #[input(default = 0, only_with(by = Random))]
    seed: u32,
    /// Every random turn counts this many times: 2 turns by halves only.
    #[input(default = 1, min = 1, max = 1000, only_with(by = Random))]
    step: u32,
    /// Whether faces that were made of one face, the triangles of a fan, turn alike.
    #[input(default = Face, only_with(by = Random))]
    per: Per,
    /// Name of the layer of texture coordinates; left out, the first.
    #[input(only_with(by = UvLayer))]
    layer: Option<String>,
    /// The field, one number per vertex; a number is level and turns nothing.
    #[input(only_with(by = Gradient))]
    field: Option<Amount>,
    /// What of the component points uphill.
    #[input(default = Edges, only_with(by = Gradient))]
    along: AlongChoice,
    /// Whether it points downhill instead.
    #[input(default = false, only_with(by = Gradient))]
    downhill: bool,
}

/// What decides about turns.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum By {
    /// `turns` alone.
    Turns,
    /// A random number for each face, by its number and the seed.
    Random,
    /// u of the component runs along growing u of the layer.
    UvLayer,
    /// The component points to where the field grows.
    Gradient,
    /// The side v = 0 of quads at an open border lies on it; at a corner u = 1 does,
    /// too. Faces inside stay.
    Border,
}

/// What points uphill.
#[derive(Clone, Copy, Choice)]
#[choice(into = Along)]
pub(crate) enum AlongChoice {
    /// The v direction.
    Edges,
    /// The diagonal from (0, 0) to (1, 1).
    Diagonals,
}

impl Node for RotateFaces {
    type Output = Arc<Mesh>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let mesh = &self.mesh;
        let chosen = chosen_faces(mesh, &self.faces)
            .map_err(|error| NodeError::from(error).at_input("faces"))?;
        let mut turns = self.found()?;
        let fixed = match (&self.turns, self.by) {
            (Some(turns), _) => turns.clone(),
            (None, By::Turns) => Amount::Constant(1.0),
            (None, _) => Amount::Constant(0.0),
        };
        fixed
            .check(mesh, Domain::Face)
            .map_err(|error| NodeError::from(error).at_input("turns"))?;
        for (face, turn) in turns.iter_mut().enumerate() {
            *turn = if chosen[face] {
                *turn
                    + fixed
                        .at(face)
                        .rem_euclid(mesh.face(face).len() as f64)
                        .floor() as i64
            } else {
                0
            };
        }
        Ok(Arc::new(domains::rotate_faces(mesh, &turns)?))
    }
}

impl RotateFaces {
    /// The turns that `by` gives, one per face.
    fn found(&self) -> Result<Vec<i64>, NodeError> {
        let mesh = &self.mesh;
        match self.by {
            By::Turns => Ok(vec![0; mesh.face_count()]),
            By::Border => Ok(border_turns(mesh.topology())
                .into_iter()
                .map(i64::from)
                .collect()),
            By::Random => {
                let seed = u64::from(self.seed);
                let mut turns = match self.per {
                    Per::Face => domains::turns_random(mesh, seed),
                    Per::Source => {
                        let alike = first_of_source(mesh, "per")?;
                        domains::turns_random_as(mesh, &alike, seed)
                    }
                };
                turns
                    .iter_mut()
                    .for_each(|turn| *turn *= i64::from(self.step));
                Ok(turns)
            }
            By::UvLayer => Ok(domains::turns_by_uv(mesh, &self.uv()?)?),
            By::Gradient => {
                let field = self.field.as_ref().ok_or_else(|| {
                    NodeError::new("`by: Gradient` needs `field`: one number per vertex")
                        .at_input("by")
                })?;
                let along = self.along.into();
                field
                    .on(mesh, Domain::Vertex)
                    .and_then(|field| {
                        domains::turns_along_gradient(mesh, &field, along, self.downhill)
                    })
                    .map_err(|error| NodeError::from(error).at_input("field"))
            }
        }
    }

    /// The layer's values, one per corner.
    fn uv(&self) -> Result<Vec<DVec2>, NodeError> {
        let corners = self.mesh.topology().corners();
        let fits = |name: &str| self.layer.as_deref().is_none_or(|layer| layer == name);
        let found = self.mesh.attributes().iter().find_map(|attribute| {
            match (attribute.values(), attribute.domain()) {
                _ if !fits(attribute.name()) => None,
                (AttributeValues::Vector2(values), Domain::Corner) => Some(values.to_vec()),
                (AttributeValues::Vector2(values), Domain::Vertex) => {
                    Some(corners.iter().map(|&v| values[v as usize]).collect())
                }
                _ => None,
            }
        });
        found.ok_or_else(|| match &self.layer {
            Some(layer) => {
                NodeError::new(format!("there is no UV layer `{layer}`")).at_input("layer")
            }
            None => NodeError::new("the mesh has no texture coordinates")
                .with_help("read a mesh that has some, or turn faces by a gradient")
                .at_input("mesh"),
        })
    }
}
