//! Which of several components goes where: the inputs of `ArrayComponents`
//! turned into one component index and one turn per cell.

use tessgraph_geometry::subdivide::Parents;
use tessgraph_geometry::{
    Amount, AttributeValues, Domain, Field, Mesh, NO_COMPONENT, PANEL, Quantity, border_faces,
    border_patch_turns, border_patches, border_turns, choose_along, choose_by_index,
    choose_by_material, choose_random,
};
use tessgraph_graph::NodeError;

/// The places that take a component each: faces, or patches of a subdivided base.
pub(crate) struct Cells<'a> {
    pub(crate) base: &'a Mesh,
    pub(crate) parents: Option<&'a Parents>,
}

/// How components are chosen, with all it takes.
pub(crate) enum Chooser<'a> {
    First,
    Index(&'a Field),
    Material(&'a [String]),
    Random {
        weights: Option<&'a [f64]>,
        seed: u64,
    },
    Gradient {
        field: &'a Field,
        randomness: f64,
        seed: u64,
    },
}

impl Cells<'_> {
    fn count(&self) -> usize {
        self.parents.map_or(self.base.face_count(), Parents::len)
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
                    .map(|cell| of_face[self.face(cell)])
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

    /// Gives cells at the border another component; the turns that bring the
    /// border to their side v = 0.
    pub(crate) fn take_border(&self, choice: &mut [u32], component: u32) -> Vec<u8> {
        let (border, mut turns) = match self.parents {
            Some(parents) => (border_patches(parents), border_patch_turns(parents)),
            None => {
                let topology = self.base.topology();
                (border_faces(topology), border_turns(topology))
            }
        };
        for ((choice, at_border), turns) in choice.iter_mut().zip(border).zip(&mut turns) {
            if at_border {
                *choice = component;
            } else {
                *turns = 0;
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
    fn values(&self, field: &Field, input: &'static str) -> Result<Field, NodeError> {
        field.check(self.base, Domain::Face).map_err(at(input))?;
        let values = (0..self.count()).map(|cell| field.values()[self.face(cell)]);
        Field::new(Domain::Face, Quantity::Number, values.collect()).map_err(at(input))
    }

    /// What a random choice holds on to: the panels' ids, or the cells' indices.
    fn ids(&self) -> Vec<i64> {
        let panels = self.base.attribute(PANEL, Domain::Face).map(|a| a.values());
        let id = |cell: usize| match panels {
            Some(AttributeValues::Integer(ids)) => ids[self.face(cell)],
            _ => cell as i64,
        };
        (0..self.count()).map(id).collect()
    }
}

fn at(input: &'static str) -> impl Fn(tessgraph_geometry::GeometryError) -> NodeError {
    move |error| NodeError::from(error).at_input(input)
}
