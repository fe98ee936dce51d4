//! Finer quads.

use std::sync::Arc;

use tessgraph_geometry::Mesh;
use tessgraph_geometry::subdivide::{
    self, Boundary, CornerRule, MAX_LEVELS, Options, Positions, Scheme,
};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs};

/// Subdivides a mesh: each level makes four quads of one.
///
/// Any polygon mesh will do; after one level all faces are quads. Catmull-Clark
/// rounds the shape, Bilinear keeps it. Edges with an attribute `crease` and
/// vertices with `corner_sharpness` stay sharp for as many levels (see
/// `SetAttribute`). Texture coordinates, attributes, materials and groups are
/// carried along; the face attribute `parent` names the coarse face.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "cage": Cuboid(size: [2, 2, 2], centre: true),
///     "out": SubdivideQuad(mesh: "cage", levels: 3),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct SubdivideQuad {
    /// Mesh to subdivide; no edge may have more than two faces.
    mesh: Arc<Mesh>,
    /// How often; 0 gives the mesh back as it is.
    #[input(default = 1, min = 0, max = MAX_LEVELS)]
    levels: u32,
    /// How new vertices are placed.
    #[input(default = CatmullClark)]
    scheme: SchemeChoice,
    /// What happens where the mesh ends.
    #[input(default = EdgeAndCorner)]
    boundary: BoundaryChoice,
    /// Where the vertices end up.
    #[input(default = Refined)]
    positions: PositionsChoice,
    /// How texture coordinates follow.
    #[input(default = Linear, only_with(scheme = CatmullClark))]
    uv: CornerRuleChoice,
}

/// How texture coordinates follow.
#[derive(Clone, Copy, Choice)]
#[choice(into = CornerRule)]
pub(crate) enum CornerRuleChoice {
    /// Bilinear in each coarse face: patterns bend at its edges.
    Linear,
    /// Rounded like the surface, so that patterns run on; islands keep their corners.
    Smooth,
}

/// Subdivision schemes.
#[derive(Clone, Copy, Choice)]
#[choice(into = Scheme)]
pub(crate) enum SchemeChoice {
    /// Towards a smooth surface.
    CatmullClark,
    /// On the bilinear patch of each quad: more faces, same shape.
    Bilinear,
}

/// Boundary rules.
#[derive(Clone, Copy, Choice)]
#[choice(into = Boundary)]
pub(crate) enum BoundaryChoice {
    /// The border is a smooth curve; corners are rounded.
    EdgeOnly,
    /// As `EdgeOnly`, but a vertex of a single face stays where it is.
    EdgeAndCorner,
}

/// Final positions.
#[derive(Clone, Copy, Choice)]
#[choice(into = Positions)]
pub(crate) enum PositionsChoice {
    /// As the last refinement leaves them.
    Refined,
    /// On the surface that infinitely many refinements lead to.
    Limit,
}

impl Node for SubdivideQuad {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let options = Options {
            scheme: self.scheme.into(),
            levels: self.levels,
            boundary: self.boundary.into(),
            positions: self.positions.into(),
            uv: self.uv.into(),
        };
        let subdivision = subdivide::subdivide(&self.mesh, options, cx.monitor())
            .map_err(|error| NodeError::from(error).at_input("mesh"))?;
        Ok(Arc::new(subdivision.mesh))
    }
}
