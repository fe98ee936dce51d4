//! The smallest sheet that a panel can be cut from.

use glam::{DVec2, DVec3};

use crate::math::symmetric_axes;

/// Room for rounding: of rectangles as small as each other the first one counts.
const SLACK: f64 = 1.0 - 1e-12;

/// The second moments of a surface, gathered triangle by triangle.
#[derive(Clone, Copy, Default)]
pub(super) struct Moments {
    area: f64,
    first: DVec3,
    second: [[f64; 3]; 3],
}

impl Moments {
    /// Adds a triangle, its corners relative to a place near by.
    pub(super) fn add(&mut self, [a, b, c]: [DVec3; 3], area: f64) {
        let sum = a + b + c;
        self.area += area;
        self.first += sum * (area / 3.0);
        // ∫ x xᵀ over a triangle is A / 12 (Σ v vᵀ + s sᵀ), s the sum of its corners.
        for arm in [a, b, c, sum].map(|arm| arm.to_array()) {
            for (i, row) in self.second.iter_mut().enumerate() {
                for (j, cell) in row.iter_mut().enumerate() {
                    *cell += area / 12.0 * arm[i] * arm[j];
                }
            }
        }
    }

    /// Unit axes by falling spread; the last one is the normal of the plane that
    /// fits the surface best.
    fn axes(&self) -> [DVec3; 3] {
        let mut spread = self.second;
        if self.area > 0.0 {
            let mean = (self.first / self.area).to_array();
            let first = self.first.to_array();
            for (i, row) in spread.iter_mut().enumerate() {
                for (j, cell) in row.iter_mut().enumerate() {
                    *cell -= first[i] * mean[j];
                }
            }
        }
        let (sizes, axes) = symmetric_axes(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| sizes[b].total_cmp(&sizes[a]));
        order.map(|k| axes[k])
    }
}

/// Length, width and depth of the smallest sheet that holds `places`: in the
/// plane that fits the surface best the rectangle of least area, length not below
/// width, and across it the depth.
///
/// Some side of the rectangle lies along a side of the convex hull (Freeman and
/// Shapira 1975). Cost: O(n log n + hull²).
pub(super) fn blank(places: &[DVec3], moments: &Moments) -> [f64; 3] {
    let [one, _, normal] = moments.axes();
    let two = normal.cross(one);
    let flat: Vec<DVec2> = places
        .iter()
        .map(|p| DVec2::new(p.dot(one), p.dot(two)))
        .collect();
    let hull = hull(flat);
    let extent = |along: &dyn Fn(usize) -> f64, count: usize| {
        let values = (0..count).map(along);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        (high - low).max(0.0)
    };
    let depth = extent(&|k| places[k].dot(normal), places.len());
    let mut best = [f64::INFINITY; 2];
    for k in 0..hull.len() {
        let side = (hull[(k + 1) % hull.len()] - hull[k]).normalize_or(DVec2::X);
        let sizes = [side, side.perp()].map(|axis| extent(&|i| hull[i].dot(axis), hull.len()));
        if sizes[0] * sizes[1] < best[0] * best[1] * SLACK {
            best = sizes;
        }
    }
    // Places on one line leave no area to compare.
    if !best[0].is_finite() {
        best = [DVec2::X, DVec2::Y].map(|axis| extent(&|i| hull[i].dot(axis), hull.len()));
    }
    [best[0].max(best[1]), best[0].min(best[1]), depth]
}

/// The convex hull, counterclockwise (Andrew 1979).
fn hull(mut places: Vec<DVec2>) -> Vec<DVec2> {
    places.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    places.dedup();
    if places.len() < 3 {
        return places;
    }
    let mut hull: Vec<DVec2> = Vec::new();
    let half = |hull: &mut Vec<DVec2>, place: DVec2, floor: usize| {
        while let [.., a, b] = hull[..] {
            if hull.len() < floor + 2 || (b - a).perp_dot(place - b) > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(place);
    };
    for &place in &places {
        half(&mut hull, place, 0);
    }
    let floor = hull.len() - 1;
    for &place in places.iter().rev().skip(1) {
        half(&mut hull, place, floor);
    }
    hull.pop();
    hull
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{TAU, cos, sin};

    fn of_fan(places: &[DVec3]) -> [f64; 3] {
        let mut moments = Moments::default();
        for k in 1..places.len() - 1 {
            let triangle = [places[0], places[k], places[k + 1]];
            let [a, b, c] = triangle;
            moments.add(triangle, (b - a).cross(c - a).length() / 2.0);
        }
        blank(places, &moments)
    }

    fn check(found: [f64; 3], expected: [f64; 3]) {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }

    /// A plane turned and moved any way.
    fn tilted(x: f64, y: f64, z: f64) -> DVec3 {
        let turn = glam::DQuat::from_scaled_axis(DVec3::new(0.3, -1.1, 0.7));
        turn * DVec3::new(x, y, z) + DVec3::new(5.0, -2.0, 1.0)
    }

    #[test]
    fn flat_outlines_have_closed_forms() {
        let rectangle = [(0., 0.), (3., 0.), (3., 1.), (0., 1.)];
        check(
            of_fan(&rectangle.map(|(x, y)| tilted(x, y, 0.0))),
            [3.0, 1.0, 0.0],
        );
        let hexagon = |k: u32| {
            let angle = TAU * f64::from(k) / 6.0;
            tilted(cos(angle), sin(angle), 0.0)
        };
        let hexagon: Vec<_> = (0..6).map(hexagon).collect();
        check(of_fan(&hexagon), [2.0, 3f64.sqrt(), 0.0]);
        // A thin parallelogram lies along its long sides, not along x.
        let leaning = [(0., 0.), (4., 4.), (4., 5.), (0., 1.)];
        let expected = [4.5 * 2f64.sqrt(), 0.5f64.sqrt(), 0.0];
        check(of_fan(&leaning.map(|(x, y)| tilted(x, y, 0.0))), expected);
    }

    #[test]
    fn degenerate_panels_give_finite_numbers() {
        check(of_fan(&[DVec3::ONE; 4]), [0.0; 3]);
        let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
        let [length, width, depth] = of_fan(&line);
        assert!((length.max(depth) - 2.0).abs() < 1e-12 && width.abs() < 1e-12);
    }
}
