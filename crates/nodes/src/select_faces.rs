//! Faces chosen by a rule.

use std::sync::Arc;

use tessgraph_geometry::domains;
use tessgraph_geometry::{Amount, Domain, Field, Mesh, Quantity, faces_named};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs, Outputs};

/// Chooses faces and gives a field: 1 on those chosen, 0 on the others.
///
/// By a field, by the name of a material, group or object, by nearness to an open
/// border, or by a pattern over the quads. Two choices combine through `with`. The
/// result fits the input `faces` of other nodes.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [6, 6], size: [6, 6]),
///     "rim": SelectFaces(mesh: "base", by: Border),
///     "out": SelectFaces(mesh: "base", by: Stripes, with: "rim", combine: Or),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct SelectFaces {
    /// Mesh whose faces are chosen.
    mesh: Arc<Mesh>,
    /// The rule.
    by: Rule,
    /// A number, or one per face, or per vertex: then a face's mean counts.
    #[input(only_with(by = Field))]
    field: Option<Amount>,
    /// Faces with at least this value are chosen.
    #[input(default = 0.5, only_with(by = Field))]
    at_least: f64,
    /// Name of a material, group or object.
    #[input(only_with(by = Named))]
    name: Option<String>,
    /// How many rings of faces beyond those at the border itself.
    #[input(default = 0, max = 1000000, only_with(by = Border))]
    rings: u32,
    /// Every how many rows a stripe comes.
    #[input(default = 2, min = 1, max = 1000000, only_with(by = Stripes))]
    period: u32,
    /// How many rows wide a stripe is.
    #[input(default = 1, max = 1000000, only_with(by = Stripes))]
    rows: u32,
    /// Whether stripes run along v instead of u of the first face.
    #[input(default = false, only_with(by = Stripes))]
    along_v: bool,
    /// Whether the others are chosen instead.
    #[input(default = false)]
    invert: bool,
    /// Another choice, which this one is combined with after `invert`: 0.5 and more
    /// for chosen, a number or one per face.
    with: Option<Amount>,
    /// How the two are combined.
    #[input(default = And)]
    combine: Combine,
}

/// A rule that chooses faces.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum Rule {
    /// Where a field is large enough.
    Field,
    /// By material, group or object.
    Named,
    /// At open borders.
    Border,
    /// Every second quad, as on a chess board.
    Checker,
    /// Rows of quads.
    Stripes,
}

/// How two choices are combined.
#[derive(Clone, Copy, Choice)]
pub(crate) enum Combine {
    /// Chosen by both.
    And,
    /// Chosen by at least one.
    Or,
    /// Chosen by exactly one.
    Xor,
}

/// The choice.
#[derive(Outputs)]
pub(crate) struct SelectedFaces {
    /// 1 on chosen faces, 0 on the others.
    field: Arc<Field>,
    /// How many are chosen.
    count: usize,
}

impl Node for SelectFaces {
    type Output = SelectedFaces;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let mut chosen = self.by_rule()?;
        chosen.iter_mut().for_each(|chosen| *chosen ^= self.invert);
        if let Some(with) = &self.with {
            with.check(&self.mesh, Domain::Face)
                .map_err(|error| NodeError::from(error).at_input("with"))?;
            for (face, chosen) in chosen.iter_mut().enumerate() {
                let other = with.at(face) >= 0.5;
                *chosen = match self.combine {
                    Combine::And => *chosen && other,
                    Combine::Or => *chosen || other,
                    Combine::Xor => *chosen != other,
                };
            }
        }
        let count = chosen.iter().filter(|chosen| **chosen).count();
        let values = chosen.into_iter().map(|c| f64::from(u8::from(c))).collect();
        let field = Field::new(Domain::Face, Quantity::Number, values)?;
        Ok(SelectedFaces {
            field: Arc::new(field),
            count,
        })
    }
}

impl SelectFaces {
    fn by_rule(&self) -> Result<Vec<bool>, NodeError> {
        let mesh = &self.mesh;
        Ok(match self.by {
            Rule::Field => self.by_field()?,
            Rule::Named => {
                let name = self.name.as_deref().ok_or_else(|| {
                    NodeError::new("`by: Named` needs `name`: a material, group or object")
                        .at_input("by")
                })?;
                let mut chosen = vec![false; mesh.face_count()];
                let named = faces_named(mesh, name)
                    .map_err(|error| NodeError::from(error).at_input("name"))?;
                named.iter().for_each(|&face| chosen[face as usize] = true);
                chosen
            }
            Rule::Border => domains::faces_within(mesh, self.rings),
            Rule::Checker => {
                let cells = domains::cells(mesh);
                cells.iter().map(|[i, j]| (i + j) % 2 != 0).collect()
            }
            Rule::Stripes => {
                let (period, rows) = (i64::from(self.period), i64::from(self.rows));
                let row = |[i, j]: [i64; 2]| if self.along_v { i } else { j };
                let cells = domains::cells(mesh).into_iter();
                cells
                    .map(|cell| row(cell).rem_euclid(period) < rows)
                    .collect()
            }
        })
    }

    fn by_field(&self) -> Result<Vec<bool>, NodeError> {
        let mesh = &self.mesh;
        let field = self.field.as_ref().ok_or_else(|| {
            NodeError::new("`by: Field` needs `field`: one number per face or vertex")
                .at_input("by")
        })?;
        let field = field
            .on(mesh, field.domain_or(Domain::Face))
            .map_err(|error| NodeError::from(error).at_input("field"))?;
        let values = field.values();
        let value = |face: usize| match field.domain() {
            Domain::Face => values[face],
            _ => {
                let corners = mesh.face(face);
                let sum: f64 = corners.iter().map(|&vertex| values[vertex as usize]).sum();
                sum / corners.len() as f64
            }
        };
        Ok((0..mesh.face_count())
            .map(|face| value(face) >= self.at_least)
            .collect())
    }
}
