//! Smooth normals: directions diffused over the mesh (§3.1).

use std::sync::Arc;

use tessgraph_geometry::diffuse::{
    self, Anisotropy, DiffuseOptions, Grain, Laplacian, Lengths, Scheme,
};
use tessgraph_geometry::normals::{self, NormalWeights};
use tessgraph_geometry::{Amount, DirectionSource, Directions, Mesh, list_ids};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Diffuses directions over the mesh so that offset directions stop crossing.
///
/// Each pass moves every direction towards the mean of its neighbours' over
/// edges and brings it back to length 1, or to the length it had (`lengths: Keep`). Many passes make directions parallel;
/// then some may turn against a face, which is inverted thickness: they are
/// counted in a warning (paper §3.1 and §5).
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "base": ParametricSurface(x: "4 * u", y: "4 * v", z: "abs(u - 0.5)", cells: [8, 8]),
///     "out": SmoothNormals(mesh: "base", iterations: 20),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct SmoothNormals {
    /// Mesh over whose edges directions are diffused.
    mesh: Arc<Mesh>,
    /// Directions to start from; left out, the vertex normals.
    directions: Option<Arc<Directions>>,
    /// Number of passes; 0 leaves the directions as they are.
    #[input(default = 10, min = 0, max = 100000, only_with(scheme = Mean | EdgeSum))]
    iterations: u32,
    /// Share of the neighbours' mean in each pass. At 1 a checkerboard on a quad
    /// grid never fades.
    #[input(default = 0.5, min = 0, max = 1, only_with(scheme = Mean))]
    diffusion: f64,
    /// How much each vertex takes part: 0 keeps its direction, 1 diffuses it fully.
    #[input(default = 1.0, min = 0, max = 1)]
    weights: Amount,
    /// How directions are diffused.
    #[input(default = Mean)]
    scheme: SchemeChoice,
    /// Share of each difference that is added in a pass.
    #[input(default = 0.2, min = 0, max = 1, only_with(scheme = EdgeSum))]
    step: f64,
    /// Whether a direction that ends up against the surface normal is turned round.
    #[input(default = false, only_with(scheme = EdgeSum))]
    flip_inverted: bool,
    /// Length over which directions spread, whatever the density of the mesh.
    #[input(default = 1.0, min = 0, unit = length, only_with(scheme = Implicit))]
    distance: f64,
    /// Which neighbours count, and how much.
    #[input(default = Uniform, only_with(scheme = Mean))]
    laplacian: LaplacianChoice,
    /// Prefers neighbours along u (-1) or v (1) of a UV layer; 0 prefers none. It weighs
    /// mesh edges: with `scheme: Mean` and `laplacian: Uniform`, or `EdgeSum`, only.
    #[input(default = 0.0, min = -1, max = 1)]
    anisotropy: f64,
    /// UV layer that says where u and v run; `uv` is the name that files and the nodes
    /// that make meshes give theirs.
    #[input(default = "uv")]
    layer: String,
    /// Directions that say where u runs, instead of a UV layer.
    along: Option<Arc<Directions>>,
    /// How long the results are.
    #[input(default = Unit)]
    lengths: LengthsChoice,
    /// Whether every direction is kept in front of all faces round its vertex, so
    /// that none is inverted.
    #[input(default = false)]
    keep_side: bool,
}

/// How directions are diffused.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum SchemeChoice {
    /// Towards the mean of the neighbours, at length 1 after every pass: stable for
    /// every mesh.
    Mean,
    /// The paper's add-on's step, for comparison: the sum of differences to the
    /// neighbours, normalised at the end. Diverges at vertices of valence 10 and more.
    EdgeSum,
    /// One implicit step of heat flow over a length in model units: the same result
    /// on a coarse and on a fine mesh.
    Implicit,
}

/// How long diffused directions are.
#[derive(Clone, Copy, Choice)]
#[choice(into = Lengths)]
pub(crate) enum LengthsChoice {
    /// One.
    Unit,
    /// As long as at the start: directions towards a target still reach as far.
    Keep,
    /// Diffused together with their senses, so that a step in length fades, too.
    Diffuse,
}

/// Which neighbours count.
#[derive(Clone, Copy, Choice)]
#[choice(into = Laplacian)]
pub(crate) enum LaplacianChoice {
    /// Those over mesh edges, all alike.
    Uniform,
    /// Those over edges of triangles, by cotangent weights: depends less on how the
    /// mesh is cut.
    Cotangent,
}

impl Node for SmoothNormals {
    type Output = Arc<Directions>;
    const VERSION: u32 = 2;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let start = match &self.directions {
            Some(directions) => Arc::clone(directions),
            None => vertex_normals(&self.mesh, cx)?,
        };
        self.check_anisotropy()?;
        if self.scheme == SchemeChoice::EdgeSum {
            self.warn_of_divergence(cx);
        }
        let options = DiffuseOptions {
            scheme: self.diffusion_scheme(),
            weights: self.weights.clone(),
            anisotropy: self.preference(),
            keep_side: self.keep_side,
            lengths: self.lengths.into(),
        };
        let smooth = diffuse::diffuse(&self.mesh, &start, &options, cx.monitor())?;
        let inverted = diffuse::inverted(&self.mesh, &smooth, cx.monitor())?;
        if !inverted.vertices.is_empty() {
            cx.warn(format!(
                "directions turn against {} faces: {} (at vertices {}); thickness is inverted \
                 there: use fewer iterations or `keep_side: true`",
                inverted.faces.len(),
                list_ids(&inverted.faces),
                list_ids(&inverted.vertices),
            ));
        }
        Ok(Arc::new(smooth))
    }
}

impl SmoothNormals {
    fn diffusion_scheme(&self) -> Scheme {
        match self.scheme {
            SchemeChoice::Mean => Scheme::Mean {
                iterations: self.iterations,
                diffusion: self.diffusion,
                laplacian: self.laplacian.into(),
            },
            SchemeChoice::EdgeSum => Scheme::EdgeSum {
                iterations: self.iterations,
                step: self.step,
                flip_inverted: self.flip_inverted,
            },
            SchemeChoice::Implicit => Scheme::Implicit {
                distance: self.distance,
            },
        }
    }

    /// Refuses a preference among edges where no edges are weighed.
    fn check_anisotropy(&self) -> Result<(), NodeError> {
        let over_edges = match (self.scheme, self.laplacian) {
            (SchemeChoice::EdgeSum, _) | (SchemeChoice::Mean, LaplacianChoice::Uniform) => true,
            (SchemeChoice::Mean, LaplacianChoice::Cotangent) | (SchemeChoice::Implicit, _) => false,
        };
        if over_edges || self.anisotropy == 0.0 {
            return Ok(());
        }
        let what = match self.scheme {
            SchemeChoice::Implicit => "`scheme: Implicit`",
            _ => "`laplacian: Cotangent`",
        };
        let message = format!("{what} takes no anisotropy: it has weights of its own");
        Err(NodeError::new(message)
            .with_help("use `scheme: Mean` with `laplacian: Uniform`, or leave `anisotropy` out")
            .at_input("anisotropy"))
    }

    fn preference(&self) -> Option<Anisotropy<'_>> {
        let grain = match &self.along {
            Some(directions) => Grain::Along(directions),
            None => Grain::Layer(&self.layer),
        };
        let strength = self.anisotropy;
        (strength != 0.0).then_some(Anisotropy { grain, strength })
    }

    fn warn_of_divergence(&self, cx: &EvalCx<'_>) {
        let diverging = diffuse::diverging_vertices(&self.mesh);
        if !diverging.is_empty() && self.iterations > 0 {
            cx.warn(format!(
                "`scheme: EdgeSum` grows without bound at vertices {} of many edges; \
                 use `scheme: Mean`",
                list_ids(&diverging)
            ));
        }
    }
}

/// Unit vertex normals as directions, with a warning where there is none.
pub(crate) fn vertex_normals(mesh: &Mesh, cx: &EvalCx<'_>) -> Result<Arc<Directions>, NodeError> {
    let vectors = normals::vertex_normals(mesh, NormalWeights::Angle, true, cx.monitor())?;
    let without = normals::vertices_without_normal(mesh, &vectors);
    if !without.is_empty() {
        let ids = list_ids(&without);
        cx.warn(format!(
            "no normal at vertices {ids}: the faces there have no area or face opposite ways; \
             `FlipFaces` turns faces round"
        ));
    }
    Ok(Arc::new(Directions::new(
        mesh,
        vectors,
        DirectionSource::Surface,
    )?))
}
