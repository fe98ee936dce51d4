//! Which corner of a face is (0, 0): quarter turns of its component.

use glam::DVec2;

use super::check_per_face;
use super::pieces::Pieces;
use crate::random::uniform;
use crate::{Domain, Field, GeometryError, Mesh};

/// What of the component points to where a field grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Along {
    /// Its v direction, from the edge v = 0 to the edge v = 1.
    #[default]
    Edges,
    /// Its diagonal, from (0, 0) to (1, 1).
    Diagonals,
}

/// Rolls the corner list of each face: after one turn the corner (0, 0) is
/// where (0, 1) was, so a component turns by a quarter.
///
/// `turns` has one number per face; negative ones turn the other way. A face of
/// n corners comes back after n turns: a triangle turns by thirds. The surface
/// and all values on it stay. Cost: O(corners).
///
/// ```
/// use tessgraph_geometry::{Mesh, domains::rotate_faces};
/// let quad = Mesh::from_faces(
///     vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
///     &[&[0, 1, 2, 3]],
/// )?;
/// assert_eq!(rotate_faces(&quad, &[1])?.face(0), [3, 0, 1, 2]);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::AttributeLength`] unless there is one number per face.
pub fn rotate_faces(mesh: &Mesh, turns: &[i64]) -> Result<Mesh, GeometryError> {
    check_per_face("turns", mesh, turns.len())?;
    let mut pieces = Pieces::new(mesh, mesh.corner_count());
    for (face, turns) in turns.iter().enumerate() {
        let range = mesh.topology().corner_range(face);
        let count = range.len();
        // New corner k was corner k - turns.
        let first = (-turns).rem_euclid(count as i64) as usize;
        for k in 0..count {
            pieces.push(pieces.old(range.start + (first + k) % count, true));
        }
        pieces.end(face);
    }
    pieces.finish(false)
}

/// Random turns, one number per face: 0 up to one less than its corners.
///
/// They depend on the seed and the face's number alone (SplitMix64, Steele et
/// al. 2014), not on the other faces, the platform or the number of threads.
pub fn turns_random(mesh: &Mesh, seed: u64) -> Vec<i64> {
    let own: Vec<usize> = (0..mesh.face_count()).collect();
    turns_random_as(mesh, &own, seed)
}

/// As [`turns_random`] with the number drawn for face `drawn[face]`, one per face:
/// equal ones turn alike.
pub fn turns_random_as(mesh: &Mesh, drawn: &[usize], seed: u64) -> Vec<i64> {
    let turns = |(face, &drawn): (usize, &usize)| {
        let count = mesh.face(face).len() as f64;
        (uniform(seed, drawn as i64) * count).floor() as i64
    };
    drawn.iter().enumerate().map(turns).collect()
}

/// Turns that make each component's u direction run as nearly as a corner
/// allows along growing u of a layer of texture coordinates.
///
/// `uv` has one value per corner. Of a quad's four turns the one with the
/// largest (u of (1,0) and (1,1)) - (u of (0,0) and (0,1)) is taken, ties to the
/// fewest turns; of a triangle's three the one whose first edge gains most.
///
/// # Errors
/// [`GeometryError::AttributeLength`] unless there is one value per corner.
pub fn turns_by_uv(mesh: &Mesh, uv: &[DVec2]) -> Result<Vec<i64>, GeometryError> {
    if uv.len() != mesh.corner_count() {
        return Err(GeometryError::AttributeLength {
            name: "uv".into(),
            domain: Domain::Corner,
            expected: mesh.corner_count(),
            actual: uv.len(),
        });
    }
    Ok(best_turns(mesh, |range, at| {
        let u = |k| uv[range.start + at(k)].x;
        let gain = u(1) - u(0);
        if range.len() == 4 {
            gain + (u(2) - u(3))
        } else {
            gain
        }
    }))
}

/// Turns that point each component to where `field` (one value per vertex) grows.
///
/// Along edges the turn with the largest (c(0,1) + c(1,1)) - (c(0,0) + c(1,0))
/// is taken, c the field at the turned corners: v runs uphill. Along diagonals
/// that with the largest c(1,1) - c(0,0). Ties go to the fewest turns. For a
/// triangle p0 p1 p2 and along edges the lowest edge becomes p0 p1; along
/// diagonals c(p2) - c(p0) counts. With `downhill` the field counts negative.
///
/// # Errors
/// As [`Field::check`].
pub fn turns_along_gradient(
    mesh: &Mesh,
    field: &Field,
    along: Along,
    downhill: bool,
) -> Result<Vec<i64>, GeometryError> {
    field.check(mesh, Domain::Vertex)?;
    let sign = if downhill { -1.0 } else { 1.0 };
    let corners = mesh.topology().corners();
    Ok(best_turns(mesh, |range, at| {
        let value = |k| sign * field.values()[corners[range.start + at(k)] as usize];
        let count = range.len();
        match along {
            Along::Edges if count == 4 => (value(2) - value(1)) + (value(3) - value(0)),
            Along::Edges => -(value(0) + value(1)),
            Along::Diagonals if count == 3 => value(2) - value(0),
            Along::Diagonals => value(count / 2) - value(0),
        }
    }))
}

/// For each face the first number of turns with the largest score. `score` gets
/// the face's corners and, for a turned corner, which corner of the face it was.
fn best_turns(
    mesh: &Mesh,
    score: impl Fn(&std::ops::Range<usize>, &dyn Fn(usize) -> usize) -> f64,
) -> Vec<i64> {
    let best = |face: usize| {
        let range = mesh.topology().corner_range(face);
        let count = range.len();
        let (mut best, mut turns) = (f64::NEG_INFINITY, 0);
        for turn in 0..count {
            let found = score(&range, &|k| (k + count - turn) % count);
            if found > best {
                (best, turns) = (found, turn);
            }
        }
        turns as i64
    };
    (0..mesh.face_count()).map(best).collect()
}
