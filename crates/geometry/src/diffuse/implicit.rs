//! The implicit scheme: one linear system instead of many passes.

use glam::DVec3;

use super::stencil::Stencil;
use crate::math::unit_or_zero;
use crate::monitor::Quiet;
use crate::{Amount, GeometryError, Mesh, Monitor, parallel};

/// Residual, relative to the right side in the preconditioned norm, at which
/// the solution is taken: directions are then good to about as many radians.
const TOLERANCE: f64 = 1e-8;

/// Iterations at most; their number grows as distance over edge length.
const ITERATIONS: usize = 20_000;

/// Weights below this hold a vertex fast; the system would lose its digits.
const FIXED: f64 = 1e-9;

/// Solves (M / w + distance² C) n = M / w n0.
///
/// Dividing row i by its weight w_i keeps the system symmetric and lets the
/// weight scale the diffusion at that vertex, as it does in the explicit
/// schemes; vertices of weight 0 are fixed values.
pub(super) fn solve(
    mesh: &Mesh,
    start: &[DVec3],
    distance: f64,
    weights: &Amount,
    monitor: &dyn Monitor,
) -> Result<Vec<DVec3>, GeometryError> {
    let stencil = Stencil::cotangent(mesh);
    let areas = barycentric_areas(mesh);
    let mass: Vec<f64> = (0..start.len())
        .map(|vertex| match weights.at(vertex) {
            weight if weight < FIXED || areas[vertex] <= 0.0 => f64::INFINITY,
            weight => areas[vertex] / weight,
        })
        .collect();
    let system = System {
        stencil: &stencil,
        mass: &mass,
        scale: distance * distance,
    };
    let mut field = system.conjugate_gradient(start, monitor)?;
    for vertex in 0..field.len() {
        if mass[vertex] == f64::INFINITY {
            field[vertex] = start[vertex];
        }
    }
    Ok(field)
}

/// Brings what was solved to unit length; where nothing is left, the unit vector it
/// started from. Fixed vertices are left as they are.
pub(super) fn to_unit(solved: Vec<DVec3>, start: &[DVec3]) -> Vec<DVec3> {
    let unit = |(solved, &start): (DVec3, &DVec3)| match unit_or_zero(solved) {
        _ if solved == start => start,
        DVec3::ZERO => start,
        unit => unit,
    };
    solved.into_iter().zip(start).map(unit).collect()
}

/// A third of the area of the triangles round each vertex.
fn barycentric_areas(mesh: &Mesh) -> Vec<f64> {
    let positions = mesh.positions();
    let mut areas = vec![0.0; mesh.vertex_count()];
    for triangle in mesh.triangle_vertices(&mesh.triangles()) {
        let [a, b, c] = triangle.map(|vertex| positions[vertex as usize]);
        let area = 0.5 * (b - a).cross(c - a).length();
        for vertex in triangle {
            areas[vertex as usize] += area / 3.0;
        }
    }
    areas
}

/// The matrix diag(mass) + scale · C, C the stiffness with the stencil's
/// weights; rows of infinite mass are the identity.
struct System<'a> {
    stencil: &'a Stencil,
    mass: &'a [f64],
    scale: f64,
}

impl System<'_> {
    fn is_fixed(&self, vertex: usize) -> bool {
        self.mass[vertex] == f64::INFINITY
    }

    /// Row `vertex` of the matrix times `x`; zero for fixed vertices.
    fn row(&self, vertex: usize, x: &[DVec3]) -> DVec3 {
        if self.is_fixed(vertex) {
            return DVec3::ZERO;
        }
        let (neighbours, weights) = self.stencil.row(vertex);
        let mut flow = DVec3::ZERO;
        for (&neighbour, &weight) in neighbours.iter().zip(weights) {
            flow += (x[vertex] - x[neighbour as usize]) * weight;
        }
        x[vertex] * self.mass[vertex] + flow * self.scale
    }

    /// 1 / diagonal; zero for fixed vertices, which keeps them out of the
    /// iteration.
    fn inverse_diagonal(&self, vertex: usize) -> f64 {
        if self.is_fixed(vertex) {
            return 0.0;
        }
        let (_, weights) = self.stencil.row(vertex);
        let sum: f64 = weights.iter().sum();
        1.0 / (self.mass[vertex] + self.scale * sum)
    }

    /// Conjugate gradients (Hestenes and Stiefel 1952) with the diagonal as
    /// preconditioner, x, y and z side by side, each with its own step.
    fn conjugate_gradient(
        &self,
        start: &[DVec3],
        monitor: &dyn Monitor,
    ) -> Result<Vec<DVec3>, GeometryError> {
        let count = start.len();
        let quiet = Quiet(monitor);
        let inverse = parallel::map(count, &quiet, |v| self.inverse_diagonal(v))?;
        let mut x = start.to_vec();
        // With x = n0 the residual M n0 - (M + s C) n0 is -s C n0.
        let mut residual = parallel::map(count, &quiet, |vertex| {
            if self.is_fixed(vertex) {
                DVec3::ZERO
            } else {
                start[vertex] * self.mass[vertex] - self.row(vertex, start)
            }
        })?;
        let right = dot(count, |v| {
            if self.is_fixed(v) {
                DVec3::ZERO
            } else {
                let side = start[v] * self.mass[v];
                side * side * inverse[v]
            }
        });
        let enough = (right.element_sum() * TOLERANCE * TOLERANCE).max(f64::MIN_POSITIVE);
        let mut direction = parallel::map(count, &quiet, |v| residual[v] * inverse[v])?;
        let mut product = vec![DVec3::ZERO; count];
        let mut size = dot(count, |v| residual[v] * residual[v] * inverse[v]);
        for iteration in 0..ITERATIONS {
            if size.element_sum() <= enough {
                return Ok(x);
            }
            parallel::fill(&mut product, &quiet, |v, out| {
                *out = self.row(v, &direction);
            })?;
            let step = ratio(size, dot(count, |v| direction[v] * product[v]));
            parallel::fill(&mut x, &quiet, |v, x| *x += direction[v] * step)?;
            parallel::fill(&mut residual, &quiet, |v, r| *r -= product[v] * step)?;
            let before = size;
            size = dot(count, |v| residual[v] * residual[v] * inverse[v]);
            let keep = ratio(size, before);
            parallel::fill(&mut direction, &quiet, |v, d| {
                *d = residual[v] * inverse[v] + *d * keep;
            })?;
            monitor.progress(iteration as u64 + 1, ITERATIONS as u64);
        }
        Err(GeometryError::NoConvergence {
            what: "the implicit diffusion",
            after: ITERATIONS,
            residual: (size.element_sum() / right.element_sum()).sqrt(),
            tolerance: TOLERANCE,
            advice: "shorten the distance, or remove faces much thinner than the others",
        })
    }
}

/// The sum of `term` over all vertices, in a fixed order.
fn dot(count: usize, term: impl Fn(usize) -> DVec3 + Sync) -> DVec3 {
    parallel::reduce(count, || DVec3::ZERO, |sum, v| sum + term(v), |a, b| a + b)
}

/// a / b in each component; 0 where b is 0, as that component is solved.
fn ratio(a: DVec3, b: DVec3) -> DVec3 {
    let one = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
    DVec3::new(one(a.x, b.x), one(a.y, b.y), one(a.z, b.z))
}
