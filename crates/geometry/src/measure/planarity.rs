//! How far faces are from planar, by each of the conventions in use.

use glam::DVec3;

use crate::math::{symmetric_axes, unit_or_zero};
use crate::{GeometryError, Mesh, Monitor, parallel};

/// How far one face is from planar; the conventions differ by up to four times
/// on one quad.
#[derive(Debug, Clone, Copy, PartialEq, Default, bytemuck::Zeroable)]
pub struct Planarity {
    /// Largest distance of a corner to the plane with the least squared
    /// distances, in metres.
    pub plane: f64,
    /// Distance between the lines of the two diagonals, in metres.
    pub diagonals: f64,
    /// The same as a share of the diagonals' mean length.
    pub diagonal_share: f64,
    /// Distance of a corner to the plane of the other three, in metres; the
    /// largest of the four.
    pub fourth_corner: f64,
    /// How far the bilinear patch of a quad lies from its two triangles, in metres:
    /// the most that a component at height 0 is off the surface. 0 for other faces.
    pub warp: f64,
}

impl Planarity {
    /// The larger of each.
    fn max(self, other: Self) -> Self {
        Self {
            plane: self.plane.max(other.plane),
            diagonals: self.diagonals.max(other.diagonals),
            diagonal_share: self.diagonal_share.max(other.diagonal_share),
            fourth_corner: self.fourth_corner.max(other.fourth_corner),
            warp: self.warp.max(other.warp),
        }
    }

    /// The largest of each over many faces; zero without any.
    pub fn largest(faces: &[Self]) -> Self {
        faces.iter().fold(Self::default(), |all, &one| all.max(one))
    }
}

/// The planarity of every face, one per face.
///
/// Triangles are planar. Of faces with more than four corners, each four that
/// follow one another are measured as a quad, and the largest counts; `plane`
/// is that of all corners together. The warp of a quad is half the distance
/// between its diagonals: along their common normal patch and triangles differ by
/// v (1 - u) |(p0 - p1 + p2 - p3) . n|, most in the middle, on either diagonal.
/// Cost: O(corners).
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored, measure::planarity};
/// let raised = Mesh::from_faces(
///     vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.4], [0., 1., 0.]],
///     &[[0, 1, 2, 3]],
/// )?;
/// let face = planarity(&raised, &Unmonitored)?[0];
/// assert!(face.plane < face.diagonals && face.diagonals < face.fourth_corner);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub fn planarity(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Vec<Planarity>, GeometryError> {
    parallel::map(mesh.face_count(), monitor, |face| {
        let vertices = mesh.face(face);
        let count = vertices.len();
        if count == 3 {
            return Planarity::default();
        }
        let at = |k: usize| mesh.positions()[vertices[k % count] as usize];
        let starts = if count == 4 { 1 } else { count };
        let quads = (0..starts).map(|k| of_quad([at(k), at(k + 1), at(k + 2), at(k + 3)]));
        let all = quads.fold(Planarity::default(), Planarity::max);
        Planarity {
            plane: to_best_plane(count, at),
            warp: if count == 4 { all.diagonals / 2.0 } else { 0.0 },
            ..all
        }
    })
}

/// All but the best plane.
fn of_quad(at: [DVec3; 4]) -> Planarity {
    let [one, two] = [at[2] - at[0], at[3] - at[1]];
    let (along, way) = (unit_or_zero(one), at[1] - at[0]);
    let across = unit_or_zero(along.cross(unit_or_zero(two)));
    let diagonals = if across == DVec3::ZERO {
        along.cross(way).length()
    } else {
        way.dot(across).abs()
    };
    let mean = (one.length() + two.length()) * 0.5;
    let corner = |k: usize| {
        let [a, b, c] = [1, 2, 3].map(|step| at[(k + step) % 4]);
        let normal = unit_or_zero(unit_or_zero(b - a).cross(unit_or_zero(c - a)));
        (at[k] - a).dot(normal).abs()
    };
    Planarity {
        plane: 0.0,
        warp: 0.0,
        diagonals,
        diagonal_share: if mean > 0.0 { diagonals / mean } else { 0.0 },
        fourth_corner: (0..4).map(corner).fold(0.0, f64::max),
    }
}

/// Largest distance of `count` points to the plane through their mean with the
/// least squared distances.
fn to_best_plane(count: usize, at: impl Fn(usize) -> DVec3) -> f64 {
    let origin = at(0);
    let sum: DVec3 = (0..count).map(|k| at(k) - origin).sum();
    let mean = sum / count as f64;
    let arm = |k: usize| at(k) - origin - mean;
    let size = (0..count)
        .map(|k| arm(k).abs().max_element())
        .fold(0.0, f64::max);
    if size <= 0.0 {
        return 0.0;
    }
    let mut spread = [[0.0; 3]; 3];
    for k in 0..count {
        let arm = (arm(k) / size).to_array();
        for (i, row) in spread.iter_mut().enumerate() {
            for (j, cell) in row.iter_mut().enumerate() {
                *cell += arm[i] * arm[j];
            }
        }
    }
    let (sizes, axes) = symmetric_axes(spread);
    let least = (0..3).fold(
        0,
        |least, k| if sizes[k] < sizes[least] { k } else { least },
    );
    let normal = axes[least];
    (0..count)
        .map(|k| arm(k).dot(normal).abs())
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;

    fn of(places: &[[f64; 3]]) -> Planarity {
        let face: Vec<u32> = (0..places.len() as u32).collect();
        let mesh = Mesh::from_faces(places.to_vec(), &[face]).unwrap();
        planarity(&mesh, &Unmonitored).unwrap()[0]
    }

    #[test]
    fn a_square_with_corners_up_and_down_has_the_closed_form() {
        // Corners alternately h up and down: every convention in closed form.
        let (h, half) = (0.1, 1.0);
        let found = of(&[
            [-half, -half, h],
            [half, -half, -h],
            [half, half, h],
            [-half, half, -h],
        ]);
        assert!((found.plane - h).abs() < 1e-15);
        assert!((found.diagonals - 2.0 * h).abs() < 1e-15);
        // The patch passes through 0 in the middle, each diagonal h from it.
        assert!((found.warp - h).abs() < 1e-15);
        assert!((found.diagonal_share - 2.0 * h / 8f64.sqrt()).abs() < 1e-15);
        // Three corners span z = h + ... with slope 2h over half a diagonal each way.
        let expected = 4.0 * h / (1.0 + 2.0 * h * h).sqrt();
        assert!(
            (found.fourth_corner - expected).abs() < 1e-3 * expected,
            "{found:?}"
        );
    }

    #[test]
    fn the_warp_is_the_gap_between_patch_and_triangles() {
        let at = [
            DVec3::new(0.2, -0.1, 0.3),
            DVec3::new(2.1, 0.3, -0.2),
            DVec3::new(1.7, 1.9, 0.9),
            DVec3::new(-0.3, 1.2, 0.1),
        ];
        let found = of(&at.map(|p| p.to_array()));
        let normal = (at[2] - at[0]).cross(at[3] - at[1]).normalize();
        // Over a fine grid, along that normal, for both ways to split the quad.
        let gap = |u: f64, v: f64| {
            let patch = at[0].lerp(at[1], u).lerp(at[3].lerp(at[2], u), v);
            let one = match u >= v {
                true => at[0] + (at[1] - at[0]) * u + (at[2] - at[1]) * v,
                false => at[0] + (at[3] - at[0]) * v + (at[2] - at[3]) * u,
            };
            let other = match u + v <= 1.0 {
                true => at[0] + (at[1] - at[0]) * u + (at[3] - at[0]) * v,
                false => at[2] + (at[3] - at[2]) * (1.0 - u) + (at[1] - at[2]) * (1.0 - v),
            };
            [one, other].map(|flat| (patch - flat).dot(normal).abs())
        };
        let grid = (0..=40).flat_map(|i| (0..=40).map(move |j| (i, j)));
        let gaps = grid.map(|(i, j)| gap(f64::from(i) / 40.0, f64::from(j) / 40.0));
        let most = gaps.fold([0.0f64; 2], |most, gap| [0, 1].map(|k| most[k].max(gap[k])));
        for most in most {
            assert!((most - found.warp).abs() < 1e-14, "{most} {}", found.warp);
        }
    }

    #[test]
    fn planar_faces_are_planar_at_any_tilt_and_place() {
        let tilt = |x: f64, y: f64| [x + 1e3, y - 2e3, 0.3 * x - 0.7 * y + 5.0];
        for places in [
            vec![tilt(0., 0.), tilt(3., 0.), tilt(4., 2.), tilt(0., 1.)],
            vec![
                tilt(0., 0.),
                tilt(3., 0.),
                tilt(4., 2.),
                tilt(2., 4.),
                tilt(0., 1.),
            ],
            vec![tilt(0., 0.), tilt(3., 0.), tilt(4., 2.)],
        ] {
            let found = of(&places);
            assert!(
                found.plane < 1e-11 && found.fourth_corner < 1e-11,
                "{found:?}"
            );
            assert!(found.diagonals < 1e-11);
        }
    }

    #[test]
    fn degenerate_faces_give_finite_numbers() {
        for places in [
            [[1.0; 3]; 4],
            [[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [3., 0., 0.]],
        ] {
            assert_eq!(of(&places), Planarity::default());
        }
    }
}
