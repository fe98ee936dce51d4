//! Open borders joined by strips of faces.

use std::sync::Arc;

use tessgraph_geometry::domains::{self, BridgeOptions, Bridged, LoopPairs};
use tessgraph_geometry::{Amount, Mesh, list_ids};
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::{Choice, Inputs, Outputs};

/// Joins open borders in pairs by strips of faces.
///
/// Two sheets become a shell, an array's two skins a hollow panel, two holes a
/// handle. Borders with equally many edges are joined by quads, others by quads
/// and triangles by arc length; of all ways to start, the one with the shortest
/// edges across is taken. Strips continue the orientation of both borders, so the
/// two sheets of a shell face opposite ways: turn one with `FlipFaces`.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "top": ParametricSurface(x: "4 * u", y: "4 * v", z: "1 + u * v", cells: [4, 4]),
///     "floor": Grid(cells: [3, 3], size: [4, 4], centre: false),
///     "bottom": FlipFaces(mesh: "floor"),
///     "sheets": JoinMeshes(meshes: ["top", "bottom"]),
///     "out": BridgeLoops(mesh: "sheets"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct BridgeLoops {
    /// Mesh whose borders are joined.
    mesh: Arc<Mesh>,
    /// Which borders are joined with which.
    #[input(default = Nearest)]
    pair: PairChoice,
    /// Borders farther apart than this stay open; left out, all find a partner.
    #[input(min = 0, unit = length, only_with(pair = Nearest))]
    within: Option<f64>,
    /// Which borders take part: those where this is 0.5 or more all along, a
    /// number or one per vertex or face.
    #[input(default = 1.0, only_with(pair = Nearest))]
    only: Amount,
    /// Numbers of borders, the first to be joined with the second, the third with
    /// the fourth. They count from 0 by their lowest faces.
    #[input(only_with(pair = Given))]
    loops: Option<Vec<u32>>,
    /// Edges by which the second border is turned on from its best place.
    #[input(default = 0)]
    twist: i64,
    /// Loops of new vertices between the borders.
    #[input(default = 0, min = 0, max = 1000)]
    cuts: u32,
    /// 0 for straight strips, 1 for strips that leave both borders in the
    /// direction of the surface; shows with `cuts`.
    #[input(default = 0.0, min = 0, max = 1)]
    smoothness: f64,
    /// Name of the material of the strips; left out, that of the faces along them.
    material: Option<String>,
    /// Sharpness of the edges where strips begin and end in `SubdivideQuad`: 0
    /// smooth, 10 and more sharp at every level.
    #[input(default = 0.0, min = 0)]
    crease: f64,
}

/// Which borders are joined with which.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum PairChoice {
    /// The two that are nearest to each other, then of the others, and so on.
    Nearest,
    /// Those named by `loops`.
    Given,
}

/// The joined borders.
#[derive(Outputs)]
pub(crate) struct BridgedLoops {
    /// The mesh with its strips.
    mesh: Arc<Mesh>,
    /// Pairs of borders joined.
    bridges: usize,
    /// Borders that took part and found no partner.
    open: usize,
}

impl Node for BridgeLoops {
    type Output = BridgedLoops;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let given = given(self.loops.as_deref().unwrap_or_default())?;
        let pairs = match self.pair {
            PairChoice::Nearest => LoopPairs::Nearest(self.within.unwrap_or(f64::INFINITY)),
            PairChoice::Given => LoopPairs::Given(&given),
        };
        let options = BridgeOptions {
            pairs,
            only: self.only,
            twist: self.twist,
            cuts: self.cuts,
            smoothness: self.smoothness,
            crease: self.crease,
            material: self.material.as_deref(),
        };
        let bridged = domains::bridge_loops(&self.mesh, &options, cx.monitor())?;
        warn(&bridged, cx);
        Ok(BridgedLoops {
            mesh: Arc::new(bridged.mesh),
            bridges: bridged.pairs.len(),
            open: bridged.alone.len(),
        })
    }
}

fn given(loops: &[u32]) -> Result<Vec<[u32; 2]>, NodeError> {
    let (pairs, rest) = loops.as_chunks::<2>();
    if let [single] = rest {
        return Err(
            NodeError::new(format!("loop {single} has no partner: loops come in pairs"))
                .with_help("name an even number of loops, each once")
                .at_input("loops"),
        );
    }
    Ok(pairs.to_vec())
}

fn warn(bridged: &Bridged, cx: &EvalCx<'_>) {
    if bridged.pairs.is_empty() {
        cx.warn("no border was joined: it takes two that are open, chosen and near enough");
    }
    for [a, b] in &bridged.turned {
        cx.warn(format!(
            "loops {a} and {b} run the same way round, so the strip between them crosses \
             itself; turn the faces of one sheet round with FlipFaces"
        ));
    }
    if !bridged.alone.is_empty() && !bridged.pairs.is_empty() {
        let count = bridged.alone.len();
        cx.warn(format!(
            "{count} borders stay open, without a partner: loops {}",
            list_ids(&bridged.alone)
        ));
    }
    if !bridged.broken.is_empty() {
        cx.warn(format!(
            "loops {} stay open: they do not return to where they start, because faces \
             there disagree in orientation or more than two share an edge",
            list_ids(&bridged.broken)
        ));
    }
}
