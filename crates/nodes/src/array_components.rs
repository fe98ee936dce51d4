//! Components on every face.

use std::sync::Arc;

use tessgraph_geometry::subdivide::Parents;
use tessgraph_geometry::{Amount, Directions, Fit, GeometryError, Mesh, PatchGrids};
use tessgraph_geometry::{
    ArrayDomain, ArrayOptions, ArrayParts, Arrayed, Height, Interpolation, Join, PerVertexOptions,
    PerVertexReport, array_compensated, array_components, array_parts,
};
use tessgraph_graph::node::{Inputs as _, Preview};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

use crate::compensate_thickness::BorderChoice;
use crate::fit_component::{FitChoice, warn_of_outside, warn_of_shape};
use crate::support::arrayed::{ArrayedComponents, warn_of_heights};
use crate::support::choice_of_components::{Cells, Chooser, Per, first_of_source};

/// Maps a component to every face of a base surface (paper, figure 1).
///
/// A point of the component at (u, v) and height w goes to the point (u, v) of
/// the face, moved by w along the direction there; heights below 0 use the
/// inward directions. u runs from the first corner of a face to the second, v to
/// the last; a triangle is a quad whose edge v = 1 collapses.
///
/// The output holds the components face by face, with everything they carry;
/// the face attributes `base_face`, `component_face` and `panel` say where each
/// face comes from. With `join: Weld` neighbours are joined by topology: exactly,
/// without a distance.
///
/// With `compensate: PerVertex` every vertex of the component is brought to its own
/// height from the base surface, whatever the directions: what a fabricator uses.
/// The directions are then those before `CompensateThickness`; their lengths make
/// no difference. A vertex counts as unsolved where two walls leave no room for it, and
/// where it begins off the surface: on a warped quad a component follows the bilinear
/// patch, and one lower than the warp (`CheckPlanarity`) may be farther from the quad's
/// triangles than it shall be before it moves. It is then left at its height along the
/// direction; subdivide the base, or split its warped quads.
///
/// After `SubdivideQuad`, `domain: Parent` maps one component over all the small
/// faces of each coarse one: it follows the rounded surface inside a panel.
///
/// Several `components` are chosen per face with `choose`; faces at the border can
/// take a `border_component`, or one of `border_components` by how many of their edges
/// lie on it, turned so that the side v = 0 is on the border; `only` leaves faces out.
/// `per: Source` lets all triangles of a fan choose alike. Over parents, fields and materials of faces are read at
/// the first small face of each.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": Grid(cells: [4, 4], size: [4, 4]),
///     "normals": VertexNormals(mesh: "base"),
///     "brick": Cuboid(size: [1, 1, 0.2]),
///     "out": ArrayComponents(base: "base", component: "brick", directions: "normals"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ArrayComponents {
    /// Base surface of quads and triangles.
    base: Arc<Mesh>,
    /// The component; with several give `components` instead.
    component: Option<Arc<Mesh>>,
    /// Directions of the base's vertices.
    directions: Arc<Directions>,
    /// How x and y of the component become (u, v).
    #[input(default = Bounds)]
    fit: FitChoice,
    /// Name of the group, object or material that is the reference cell.
    #[input(only_with(fit = Cell))]
    cell: Option<String>,
    /// How heights are scaled.
    #[input(default = Absolute)]
    height: HeightChoice,
    /// Factor on heights, a number or one per vertex of the base.
    #[input(default = 1.0)]
    scale: Amount,
    /// How directions are interpolated inside a face.
    #[input(default = Unit)]
    interpolation: InterpolationChoice,
    /// Whether neighbours are joined.
    #[input(default = None)]
    join: JoinChoice,
    /// What one component is mapped over.
    #[input(default = Face)]
    domain: DomainChoice,
    /// Several components, counted from 0, in place of `component`.
    components: Option<Vec<Arc<Mesh>>>,
    /// Which of the components each face takes.
    #[input(default = First)]
    choose: ChooseChoice,
    /// Index of the component of each face, rounded down; below 0 for none. A number
    /// or one per face.
    #[input(only_with(choose = Index))]
    index: Option<Amount>,
    /// For each component the name of the material whose faces take it.
    #[input(only_with(choose = Material))]
    materials: Option<Vec<String>>,
    /// How often each component is to come up, relative to the others; left out,
    /// all the same.
    #[input(only_with(choose = Random))]
    weights: Option<Vec<f64>>,
    /// Value of each face: 0 takes the first component, 1 the last. A number or one
    /// per face.
    #[input(only_with(choose = Gradient))]
    gradient: Option<Amount>,
    /// How much chance blurs the bands of a gradient: 0 not at all, 1 over all of it.
    #[input(default = 0.0, min = 0, max = 1, only_with(choose = Gradient))]
    randomness: f64,
    /// Another seed, another choice; a face keeps its own while others come and go.
    #[input(default = 0, only_with(choose = Random | Gradient))]
    seed: u32,
    /// Whether faces that were made of one face choose alike.
    #[input(default = Face, only_with(choose = Index | Material | Random | Gradient))]
    per: Per,
    /// Component of faces with an edge on an open border.
    border_component: Option<Arc<Mesh>>,
    /// Components of border faces by the number of their border edges: the first for
    /// one, the second for two, as in a corner; the last for more. In place of
    /// `border_component`.
    border_components: Option<Vec<Arc<Mesh>>>,
    /// Whether border components are turned so that their side v = 0 lies on the
    /// border; at a corner the side u = 1 does, too.
    #[input(default = true)]
    turn_border: bool,
    /// Which faces take a component: 1 for yes, 0 for no, one number per face.
    #[input(default = 1.0, min = 0, max = 1)]
    only: Amount,
    /// Names of attributes of the base to bring onto the components; over parents
    /// those of vertices.
    carry: Option<Vec<String>>,
    /// Whether heights are kept as distances from the base.
    #[input(default = None)]
    compensate: CompensateChoice,
    /// How distances beyond open borders are measured.
    #[input(default = Extend, only_with(compensate = PerVertex))]
    border: BorderChoice,
    /// Largest error that counts as none, as a share of each vertex's height.
    #[input(default = 1e-4, above = 0, max = 0.1, only_with(compensate = PerVertex))]
    tolerance: f64,
    /// Longest way of a vertex, in its heights.
    #[input(default = 20.0, min = 1, max = 1000, only_with(compensate = PerVertex))]
    limit: f64,
}

/// What one component is mapped over.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum DomainChoice {
    /// Each face of the base.
    Face,
    /// Each coarse face that a subdivided base was made from.
    Parent,
}

/// Which of several components a face takes.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum ChooseChoice {
    /// The only one.
    First,
    /// By number, from `index`.
    Index,
    /// By the face's material, from `materials`.
    Material,
    /// At random, by `weights` and `seed`.
    Random,
    /// In order along `gradient`.
    Gradient,
}

/// Whether heights are kept as distances.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum CompensateChoice {
    /// Heights are lengths along the directions.
    None,
    /// Each vertex of the component ends at its own height from the base (§5).
    PerVertex,
}

/// How heights become displacements.
#[derive(Clone, Copy, Choice)]
#[choice(into = Height)]
pub(crate) enum HeightChoice {
    /// As they are.
    Absolute,
    /// Scaled with the size of the faces, so that components keep their
    /// proportions; not with directions towards a target, which sets the size.
    Relative,
}

/// How directions are interpolated.
#[derive(Clone, Copy, Choice)]
#[choice(into = Interpolation)]
pub(crate) enum InterpolationChoice {
    /// Direction and length apart: thickness does not shrink inside curved faces.
    Unit,
    /// The vectors themselves, as the paper's add-on does.
    Linear,
}

/// Whether neighbours are joined.
#[derive(Clone, Copy, Choice)]
#[choice(into = Join)]
pub(crate) enum JoinChoice {
    /// Every component is a piece of its own.
    None,
    /// Vertices on the sides of the square are joined with their neighbours'.
    Weld,
}

impl Node for ArrayComponents {
    type Output = ArrayedComponents;
    const VERSION: u32 = 2;
    const PREVIEW: Preview = Preview {
        heights: &["scale"],
        slight: &[],
        components: &[
            "component",
            "components",
            "border_component",
            "border_components",
        ],
        parts: Some(|mut args, cx| Self::bind(&mut args)?.parts(cx)),
    };

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let setting = self.setting()?;
        for component in &setting.components {
            warn_of_shape(component, &setting.fit, cx)?;
            warn_of_outside(component, &setting.fit, cx)?;
        }
        let (array, report) = self.array(&setting.components, &self.options(&setting), cx)?;
        if array.placed == 0 {
            cx.warn("no component was placed: no face of the base was chosen to take one");
        }
        if array.skipped_parents > 0 {
            cx.warn(format!(
                "{} coarse faces take no component: they have not four sides",
                array.skipped_parents
            ));
        }
        if let Some(report) = &report {
            warn_of_heights(report, cx);
        }
        Ok(ArrayedComponents::new(array, report.as_ref())?)
    }
}

/// What an array is made with besides the inputs as they are.
struct Setting<'a> {
    fit: Fit,
    components: Vec<&'a Mesh>,
    grids: Option<PatchGrids>,
    choice: Vec<u32>,
    turns: Option<Vec<u8>>,
}

impl ArrayComponents {
    fn setting(&self) -> Result<Setting<'_>, NodeError> {
        let fit = self.fit.with_cell(self.cell.clone())?;
        let components = self.all_components()?;
        let parents = match self.domain {
            DomainChoice::Face => None,
            DomainChoice::Parent => Some(Parents::of_mesh(&self.base).map_err(at("base"))?),
        };
        let grids = parents.as_ref().map(PatchGrids::of_parents).transpose()?;
        let (choice, turns) = self.placements(parents.as_ref(), components.len())?;
        Ok(Setting {
            fit,
            components,
            grids,
            choice,
            turns,
        })
    }

    fn options<'a>(&'a self, setting: &'a Setting<'_>) -> ArrayOptions<'a> {
        let grids = setting.grids.as_ref();
        ArrayOptions {
            fit: Some(&setting.fit),
            height: self.height.into(),
            scale: Some(&self.scale),
            interpolation: self.interpolation.into(),
            domain: grids.map_or(ArrayDomain::Face, ArrayDomain::Parent),
            choose: Some(&setting.choice),
            turns: setting.turns.as_deref(),
            carry: self.carry.as_deref().unwrap_or_default(),
            join: self.join.into(),
            ..ArrayOptions::default()
        }
    }

    /// The parts of the array; none where every vertex is compensated by itself.
    fn parts(&self, cx: &EvalCx<'_>) -> Result<Option<ArrayParts>, NodeError> {
        if self.compensate != CompensateChoice::None {
            return Ok(None);
        }
        let setting = self.setting()?;
        let (base, components) = (&self.base, &setting.components);
        let options = self.options(&setting);
        let parts = array_parts(base, components, &self.directions, &options, cx.monitor())?;
        Ok(Some(parts))
    }

    /// The components in the order of their numbers, then those of the border.
    fn all_components(&self) -> Result<Vec<&Mesh>, NodeError> {
        let several = self.components.as_deref().unwrap_or_default();
        let mut all: Vec<&Mesh> = match (&self.component, several) {
            (Some(_), [_, ..]) => {
                let message = "give either `component` or `components`, not both";
                return Err(NodeError::new(message).at_input("components"));
            }
            (Some(one), []) => vec![one],
            (None, several) => several.iter().map(Arc::as_ref).collect(),
        };
        if all.is_empty() {
            let message = "there is no component: give `component`, or a list of `components`";
            return Err(NodeError::new(message).at_input("component"));
        }
        if all.len() > 1 && self.choose == ChooseChoice::First {
            let message = "say how to choose among the components: \
                           `choose: Index`, `Material`, `Random` or `Gradient`";
            return Err(NodeError::new(message).at_input("choose"));
        }
        all.extend(self.at_border()?);
        Ok(all)
    }

    /// The components of the border, by the number of border edges.
    fn at_border(&self) -> Result<Vec<&Mesh>, NodeError> {
        let several = self.border_components.as_deref().unwrap_or_default();
        match (&self.border_component, several) {
            (Some(_), [_, ..]) => {
                let message = "give either `border_component` or `border_components`, not both";
                Err(NodeError::new(message).at_input("border_components"))
            }
            (one, several) => Ok(one.iter().chain(several).map(Arc::as_ref).collect()),
        }
    }

    /// The component of each cell and, where borders turn, its quarter turns.
    /// `components` counts those of the border.
    fn placements(
        &self,
        parents: Option<&Parents>,
        components: usize,
    ) -> Result<(Vec<u32>, Option<Vec<u8>>), NodeError> {
        let alike = match self.per {
            Per::Face => None,
            Per::Source if parents.is_some() => {
                let message = "over parents nothing is made of one face: leave out `per`";
                return Err(NodeError::new(message).at_input("per"));
            }
            Per::Source => Some(first_of_source(&self.base, "per")?),
        };
        let cells = Cells {
            base: &self.base,
            parents,
            alike: alike.as_deref(),
        };
        let border = self.at_border()?.len();
        let inner = components - border;
        let mut choice = cells.choose(&self.chooser()?, inner)?;
        let mut turns = None;
        if border > 0 {
            let turned = cells.take_border(&mut choice, inner as u32, border as u32);
            turns = self.turn_border.then_some(turned);
        }
        cells.keep_only(&mut choice, &self.only)?;
        Ok((choice, turns))
    }

    fn chooser(&self) -> Result<Chooser<'_>, NodeError> {
        let missing = |input: &'static str, what: &str| {
            NodeError::new(format!("this choice needs `{input}`: {what}")).at_input("choose")
        };
        let seed = u64::from(self.seed);
        Ok(match self.choose {
            ChooseChoice::First => Chooser::First,
            ChooseChoice::Index => {
                let index = self.index.as_ref();
                Chooser::Index(index.ok_or_else(|| missing("index", "a field of faces"))?)
            }
            ChooseChoice::Material => {
                let names = self.materials.as_deref();
                let what = "a material's name for each component";
                Chooser::Material(names.ok_or_else(|| missing("materials", what))?)
            }
            ChooseChoice::Random => Chooser::Random {
                weights: self.weights.as_deref(),
                seed,
            },
            ChooseChoice::Gradient => {
                let field = self.gradient.as_ref();
                Chooser::Gradient {
                    field: field.ok_or_else(|| missing("gradient", "a field of faces"))?,
                    randomness: self.randomness,
                    seed,
                }
            }
        })
    }

    fn array(
        &self,
        components: &[&Mesh],
        options: &ArrayOptions<'_>,
        cx: &EvalCx<'_>,
    ) -> Result<(Arrayed, Option<PerVertexReport>), NodeError> {
        let (base, directions) = (self.base.as_ref(), self.directions.as_ref());
        if self.compensate == CompensateChoice::None {
            let array = array_components(base, components, directions, options, cx.monitor())?;
            return Ok((array, None));
        }
        let rule = PerVertexOptions {
            tolerance: self.tolerance,
            limit: self.limit,
            border: self.border.into(),
        };
        let monitor = cx.monitor();
        let (array, report) =
            array_compensated(base, components, directions, options, &rule, monitor)?;
        Ok((array, Some(report)))
    }
}

fn at(input: &'static str) -> impl Fn(GeometryError) -> NodeError {
    move |error| NodeError::from(error).at_input(input)
}
