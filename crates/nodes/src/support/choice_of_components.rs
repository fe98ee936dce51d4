//! Which of several components goes where: the inputs of `ArrayComponents`
//! turned into one component index and one turn per cell.

use std::collections::BTreeMap;

use tessgraph_geometry::domains::SOURCE_FACE;
use tessgraph_geometry::subdivide::Parents;
use tessgraph_geometry::{
    Amount, AttributeValues, Domain, Field, Mesh, NO_COMPONENT, PANEL, Quantity,
    border_edge_counts, border_patch_turns, border_side_counts, border_turns, choose_along,
    choose_by_index, choose_by_material, choose_random,
};
use tessgraph_graph::NodeError;
use tessgraph_macros::Choice;

/// The places that take a component each: faces, or patches of a subdivided base.
pub(crate) struct Cells<'a> {
    pub(crate) base: &'a Mesh,
    pub(crate) parents: Option<&'a Parents>,
    /// For each cell the first one of those that choose alike, if not each for
    /// itself.
    pub(crate) alike: Option<&'a [usize]>,
}

/// What a choice is made for.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum Per {
    /// Each face for itself.
    Face,
    /// All faces made of one face alike, as the first of them: the triangles of a fan,
    /// the quads of a frame.
    Source,
}

/// How components are chosen, with all it takes.
pub(crate) enum Chooser<'a> {
    First,
    Index(&'a Amount),
    Material(&'a [String]),
    Random {
        weights: Option<&'a [f64]>,
        seed: u64,
    },
    Gradient {
        field: &'a Amount,
        randomness: f64,
        seed: u64,
    },
}

impl Cells<'_> {
    fn count(&self) -> usize {
        self.parents.map_or(self.base.face_count(), Parents::len)
    }

    /// The face a cell's choice is read from: itself, or a patch's first, or that of
    /// the first of those that choose alike.
    fn chooser(&self, cell: usize) -> usize {
        self.face(self.alike.map_or(cell, |first| first[cell]))
    }

    /// The face a cell's values are read from: itself, or a patch's first.
    fn face(&self, cell: usize) -> usize {
        self.parents
            .map_or(cell, |parents| parents.faces(cell).start)
    }

    /// The index of a component for each cell, out of `components`.
    pub(crate) fn choose(
        &self,
        chooser: &Chooser<'_>,
        components: usize,
    ) -> Result<Vec<u32>, NodeError> {
        match chooser {
            Chooser::First => Ok(vec![0; self.count()]),
            Chooser::Index(field) => {
                let values = self.values(field, "index")?;
                choose_by_index(&values, components).map_err(at("index"))
            }
            Chooser::Material(names) => {
                if names.len() != components {
                    let message = format!(
                        "{} materials for {components} components: each needs one",
                        names.len()
                    );
                    return Err(NodeError::new(message).at_input("materials"));
                }
                let of_face = choose_by_material(self.base, names);
                Ok((0..self.count())
                    .map(|cell| of_face[self.chooser(cell)])
                    .collect())
            }
            Chooser::Random { weights, seed } => {
                let equal = vec![1.0; components];
                let weights = weights.unwrap_or(&equal);
                if weights.len() != components {
                    let message = format!(
                        "{} weights for {components} components: each needs one",
                        weights.len()
                    );
                    return Err(NodeError::new(message).at_input("weights"));
                }
                choose_random(&self.ids(), weights, *seed).map_err(at("weights"))
            }
            Chooser::Gradient {
                field,
                randomness,
                seed,
            } => {
                let values = self.values(field, "gradient")?;
                choose_along(&values, &self.ids(), components, *randomness, *seed)
                    .map_err(at("gradient"))
            }
        }
    }

    /// Gives cells at the border other components, from `first` on one for each
    /// number of border edges, the last of `count` for all beyond; the turns that
    /// bring the border to their side v = 0.
    pub(crate) fn take_border(&self, choice: &mut [u32], first: u32, count: u32) -> Vec<u8> {
        let (edges, mut turns) = match self.parents {
            Some(parents) => (border_side_counts(parents), border_patch_turns(parents)),
            None => {
                let topology = self.base.topology();
                (border_edge_counts(topology), border_turns(topology))
            }
        };
        for ((choice, edges), turns) in choice.iter_mut().zip(edges).zip(&mut turns) {
            match edges {
                0 => *turns = 0,
                edges => *choice = first + edges.min(count) - 1,
            }
        }
        turns
    }

    /// Takes the component away where `only` is below a half.
    pub(crate) fn keep_only(&self, choice: &mut [u32], only: &Amount) -> Result<(), NodeError> {
        only.check(self.base, Domain::Face).map_err(at("only"))?;
        for (cell, choice) in choice.iter_mut().enumerate() {
            if only.at(self.face(cell)) < 0.5 {
                *choice = NO_COMPONENT;
            }
        }
        Ok(())
    }

    /// A field of faces as one value per cell.
    fn values(&self, field: &Amount, input: &'static str) -> Result<Field, NodeError> {
        field.check(self.base, Domain::Face).map_err(at(input))?;
        let values = (0..self.count()).map(|cell| field.at(self.chooser(cell)));
        Field::new(Domain::Face, Quantity::Number, values.collect()).map_err(at(input))
    }

    /// What a random choice holds on to: the panels' ids, or the cells' indices.
    fn ids(&self) -> Vec<i64> {
        let panels = self.base.attribute(PANEL, Domain::Face).map(|a| a.values());
        let id = |cell: usize| match panels {
            Some(AttributeValues::Integer(ids)) => ids[self.chooser(cell)],
            _ => self.alike.map_or(cell, |first| first[cell]) as i64,
        };
        (0..self.count()).map(id).collect()
    }
}

/// For each face the first one that was made of the same face, by the attribute
/// that `FanFaces` and others leave.
///
/// # Errors
/// A mesh without that attribute.
pub(crate) fn first_of_source(mesh: &Mesh, input: &'static str) -> Result<Vec<usize>, NodeError> {
    let sources = mesh
        .attribute(SOURCE_FACE, Domain::Face)
        .map(|a| a.values());
    let Some(AttributeValues::Integer(sources)) = sources else {
        let message = format!("the faces have no `{SOURCE_FACE}` that says what they were made of");
        return Err(NodeError::new(message)
            .with_help("`FanFaces`, `FrameFaces`, `TriangulateFaces` and `SplitIntoQuads` leave it")
            .at_input(input));
    };
    let mut first = BTreeMap::new();
    let of_face = |(face, source): (usize, &i64)| *first.entry(*source).or_insert(face);
    Ok(sources.iter().enumerate().map(of_face).collect())
}

fn at(input: &'static str) -> impl Fn(tessgraph_geometry::GeometryError) -> NodeError {
    move |error| NodeError::from(error).at_input(input)
}
