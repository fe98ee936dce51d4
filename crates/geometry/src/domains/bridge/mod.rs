//! Pairs of open borders joined by a strip of faces.

mod pairs;
mod rungs;
mod strip;
#[cfg(test)]
mod tests;

use glam::DVec3;

use super::closing::{chosen_walks, with_crease, with_material};
use super::pieces::Pieces;
use crate::topology::{BoundaryWalk, boundary_walks};
use crate::{Amount, GeometryError, Mesh, Monitor, Topology};
use rungs::Rungs;
use strip::Strip;

/// Which borders are joined with which.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoopPairs<'a> {
    /// The two that are nearest to each other, then the nearest of the others
    /// and so on, unless they are farther apart than this many metres. The
    /// distance of two loops is the mean over the vertices of both of the
    /// distance to the other loop.
    Nearest(f64),
    /// These, by their numbers in [`Topology::boundary_loops`].
    Given(&'a [[u32; 2]]),
}

/// Settings of [`bridge_loops`].
#[derive(Debug, Clone)]
pub struct BridgeOptions<'a> {
    /// Which borders are joined with which.
    pub pairs: LoopPairs<'a>,
    /// Which borders take part in [`LoopPairs::Nearest`]: those where this is 0.5
    /// or more all along; a number, or one per vertex or face.
    pub only: Amount,
    /// Edges by which the second loop is turned on from its best place.
    pub twist: i64,
    /// Loops of new vertices between the two.
    pub cuts: u32,
    /// 0 for straight strips, 1 for strips that leave both borders in the
    /// direction of the surface; needs cuts to show.
    pub smoothness: f64,
    /// Sharpness of the edges where the strip begins and ends, if they have not
    /// a higher one.
    pub crease: f64,
    /// Material of the strip; `None` for that of the faces along it.
    pub material: Option<&'a str>,
}

impl Default for BridgeOptions<'_> {
    fn default() -> Self {
        Self {
            pairs: LoopPairs::Nearest(f64::INFINITY),
            only: Amount::Constant(1.0),
            twist: 0,
            cuts: 0,
            smoothness: 0.0,
            crease: 0.0,
            material: None,
        }
    }
}

/// A mesh whose borders were joined.
#[derive(Debug, Clone)]
pub struct Bridged {
    /// The mesh; strips follow the old faces, pair by pair.
    pub mesh: Mesh,
    /// The pairs of loops that were joined, the lower number first.
    pub pairs: Vec<[u32; 2]>,
    /// Loops that took part and found no partner, ascending.
    pub alone: Vec<u32>,
    /// Pairs that run the same way round, so that their strip is turned over:
    /// the sheets face the same way.
    pub turned: Vec<[u32; 2]>,
    /// Borders that do not return to where they start, ascending.
    pub broken: Vec<u32>,
}

/// Joins pairs of open borders by strips of faces.
///
/// Loops with equally many edges are joined by one quad per edge; the start on
/// the second loop is where the edges across are shortest in sum. Others are walked
/// by arc length, both from 0 to 1 and from the best of all starts: a step is a
/// quad where the next vertices lie within half the shorter edge of each other,
/// else a triangle. The strip runs against both borders, so it continues their
/// orientation, and quads (a', a, b, b') have u along the first loop and v across.
/// With cuts the edges across are cubic curves P(s) = A + s (B - A) + k (h_1(s)
/// (l o_A - B + A) + h_2(s) (-l o_B - B + A)), k the smoothness, l = |B - A|, o
/// the unit vector that continues the surface beyond the border and h Hermite's
/// s³ - 2 s² + s and s³ - s².
///
/// Faces take material, groups and values from the face at their edge of the
/// first loop (a triangle on the second loop from the face there); values on
/// vertices and corners are interpolated across. Cost: O(corners + n m) for
/// loops of n and m edges, and O(loops² ) with [`LoopPairs::Nearest`].
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored};
/// use tessgraph_geometry::domains::{BridgeOptions, bridge_loops};
/// let sheets = Mesh::from_faces(
///     vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [0., 1., 1.]],
///     &[[0, 2, 1], [3, 4, 5]],
/// )?;
/// let prism = bridge_loops(&sheets, &BridgeOptions::default(), &Unmonitored)?;
/// assert_eq!(prism.mesh.face_count(), 5);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::Invalid`] for loops that do not exist, are named twice or do
/// not close, by their numbers; [`GeometryError::OutOfRange`] for a smoothness
/// outside 0..=1, a crease that is negative or not finite, or more cuts than
/// indices; those of [`Amount::check`]; [`GeometryError::Cancelled`].
pub fn bridge_loops(
    mesh: &Mesh,
    options: &BridgeOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Bridged, GeometryError> {
    check(options)?;
    let walks = boundary_walks(mesh.topology());
    let closes = |walk: &BoundaryWalk| walk.closed && walk.corners.len() >= 3;
    let taken = match options.pairs {
        LoopPairs::Given(pairs) => {
            check_given(mesh.topology(), &walks, pairs)?;
            (0..walks.len() as u32)
                .map(|k| pairs.iter().flatten().any(|&of| of == k))
                .collect()
        }
        LoopPairs::Nearest(_) => chosen_walks(mesh, &walks, &options.only)?,
    };
    let part = |k: &u32| taken[*k as usize];
    let all = 0..walks.len() as u32;
    let (whole, broken): (Vec<u32>, Vec<u32>) =
        all.filter(part).partition(|&k| closes(&walks[k as usize]));
    let (pairs, alone) = match options.pairs {
        LoopPairs::Given(pairs) => (pairs.to_vec(), Vec::new()),
        LoopPairs::Nearest(reach) => pairs::nearest(mesh, &walks, &whole, reach, monitor)?,
    };
    let mut pieces = Pieces::new(mesh, 2 * mesh.corner_count());
    (0..mesh.face_count()).for_each(|face| pieces.keep(face));
    let mut turned = Vec::new();
    for &pair in &pairs {
        monitor.check()?;
        let [a, b] = pair.map(|k| &walks[k as usize]);
        let rungs = Rungs::new(mesh, a, b, options.twist, monitor)?;
        if rungs.turned {
            turned.push(pair);
        }
        Strip::new(mesh, a, b, options).add(&rungs, &mut pieces);
    }
    let out = with_material(pieces.finish(false)?, mesh.face_count(), options.material)?;
    let ends = pairs
        .iter()
        .flatten()
        .flat_map(|&k| &walks[k as usize].corners);
    Ok(Bridged {
        mesh: with_crease(out, ends.copied(), options.crease)?,
        pairs,
        alone,
        turned,
        broken,
    })
}

fn check(options: &BridgeOptions<'_>) -> Result<(), GeometryError> {
    if !(0.0..=1.0).contains(&options.smoothness) {
        return Err(GeometryError::OutOfRange {
            what: "the smoothness",
            value: options.smoothness,
            requirement: "it must be between 0 and 1",
        });
    }
    Ok(())
}

/// Checks that the loops of given pairs exist, close, and are named once each.
fn check_given(
    topology: &Topology,
    walks: &[BoundaryWalk],
    pairs: &[[u32; 2]],
) -> Result<(), GeometryError> {
    let mut named = vec![false; walks.len()];
    for &k in pairs.iter().flatten() {
        let Some(walk) = walks.get(k as usize) else {
            let message = match walks.len() {
                0 => format!("there is no loop {k}: the mesh has no open border"),
                1 => format!("there is no loop {k}: the mesh has one, loop 0"),
                count => format!(
                    "there is no loop {k}: the mesh has loops 0 to {}",
                    count - 1
                ),
            };
            return Err(GeometryError::Invalid(message));
        };
        let start = topology.corners()[walk.corners[0] as usize];
        let edges = walk.corners.len();
        if !walk.closed || edges < 3 {
            return Err(GeometryError::Invalid(format!(
                "loop {k} ({edges} edges from vertex {start}) does not close, because faces \
                 there disagree in orientation or more than two share an edge"
            )));
        }
        if std::mem::replace(&mut named[k as usize], true) {
            return Err(GeometryError::Invalid(format!(
                "loop {k} ({edges} edges from vertex {start}) is named twice; \
                 a border can be joined with one other"
            )));
        }
    }
    Ok(())
}

/// The places that a walk starts edges from.
fn places(mesh: &Mesh, walk: &BoundaryWalk) -> Vec<DVec3> {
    let corners = mesh.topology().corners();
    let place = |&corner: &u32| mesh.positions()[corners[corner as usize] as usize];
    walk.corners.iter().map(place).collect()
}
