//! Where a ray leaves the neighbourhood of a convex piece.

use crate::compensate::solver::Path;
use crate::surface::Piece;

/// Newton steps at most; five are usual, and each is certain to come closer.
const STEPS: usize = 64;

/// The length at which `path` leaves the places less than `thickness` away
/// from `piece`, searched between `from`, inside, and `limit`; `None` if it
/// stays inside up to there.
///
/// The distance to a convex piece is a convex function of the length, so from
/// beyond the exit Newton's steps approach it without passing it.
pub(super) fn exit(
    path: &Path,
    piece: &Piece,
    thickness: f64,
    from: f64,
    limit: f64,
) -> Option<f64> {
    let mut length = limit;
    for step in 0..STEPS {
        let point = path.at(length);
        let arm = point - piece.closest(point);
        let distance = arm.length();
        let excess = distance - thickness;
        if step == 0 && excess < 0.0 {
            return None;
        }
        let slope = arm.dot(path.direction) / distance;
        if excess <= 1e-15 * thickness || slope <= 0.0 {
            break;
        }
        let next = length - excess / slope;
        if next >= length || next <= from {
            break;
        }
        length = next;
    }
    Some(length)
}
