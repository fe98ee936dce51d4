//! Curvatures of a surface at its vertices.

use glam::DVec3;

use crate::math::{PI, angle_between};
use crate::mesh::Domain;
use crate::normals::{NormalWeights, vertex_normals};
use crate::parallel::in_order;
use crate::{Field, GeometryError, Mesh, Monitor, Quantity};

/// Which curvature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Curvature {
    /// The product of the principal curvatures, in 1/m².
    #[default]
    Gauss,
    /// Their mean, in 1/m.
    Mean,
    /// The larger principal curvature, in 1/m.
    Max,
    /// The smaller principal curvature, in 1/m.
    Min,
}

/// Sums round one vertex over the triangles of [`Mesh::triangles`].
#[derive(Clone, Copy, Default)]
struct Ring {
    angle: f64,
    area: f64,
    /// Sum of (cot a + cot b) (neighbour - vertex).
    pull: DVec3,
}

/// Curvature at each vertex, positive where the surface bends away from its
/// normals: 1/R on a sphere of radius R with normals outward.
///
/// K = (2π - sum of angles) / A and H = -n · Σ (cot α + cot β)(p_j - p_i) / (4 A),
/// A a third of the triangles' area round the vertex (Meyer et al. 2003); the
/// principal curvatures are H ± √(H² - K), and H where that root is not real.
/// At open borders neither is defined: a border vertex takes the mean of its
/// inner neighbours, one without any (a corner) that of its neighbours, 0 where
/// they have none either. Vertices without faces or area get 0.
/// Cost: O(corners).
///
/// # Errors
/// Those of [`Field::new`], [`GeometryError::Cancelled`].
pub fn curvature(
    mesh: &Mesh,
    kind: Curvature,
    monitor: &dyn Monitor,
) -> Result<Field, GeometryError> {
    mesh.topology().adjacency_with(monitor)?;
    let rings = rings(mesh, monitor)?;
    let normals = vertex_normals(mesh, NormalWeights::Angle, true, monitor)?;
    let adjacency = mesh.topology().adjacency();
    let inner = |vertex: usize| {
        let ring = rings[vertex];
        if ring.area <= 0.0 {
            return 0.0;
        }
        let gauss = (2.0 * PI - ring.angle) / ring.area;
        let mean = -normals[vertex].dot(ring.pull) / (4.0 * ring.area);
        let spread = (mean * mean - gauss).max(0.0).sqrt();
        match kind {
            Curvature::Gauss => gauss,
            Curvature::Mean => mean,
            Curvature::Max => mean + spread,
            Curvature::Min => mean - spread,
        }
    };
    let is_border = |vertex: usize| adjacency.is_boundary_vertex(vertex);
    let mean = |values: &mut dyn Iterator<Item = f64>| {
        let (mut sum, mut count) = (0.0, 0u32);
        for value in values {
            (sum, count) = (sum + value, count + 1);
        }
        (count > 0).then(|| sum / f64::from(count))
    };
    let from_inner = |vertex: usize| {
        let ring = adjacency.one_ring(vertex).map(|other| other as usize);
        mean(&mut ring.filter(|&other| !is_border(other)).map(inner))
    };
    let values = (0..mesh.vertex_count()).map(|vertex| {
        if !is_border(vertex) {
            return inner(vertex);
        }
        from_inner(vertex).unwrap_or_else(|| {
            let ring = adjacency.one_ring(vertex);
            mean(&mut ring.filter_map(|other| from_inner(other as usize))).unwrap_or(0.0)
        })
    });
    let values = values.collect();
    Field::new(Domain::Vertex, Quantity::Number, values)
}

fn rings(mesh: &Mesh, monitor: &dyn Monitor) -> Result<Vec<Ring>, GeometryError> {
    let mut rings = vec![Ring::default(); mesh.vertex_count()];
    let triangles = mesh.triangle_vertices(&mesh.triangles_with(monitor)?);
    in_order(triangles.len(), monitor, |index| {
        let triangle = triangles[index];
        let at = triangle.map(|vertex| mesh.positions()[vertex as usize]);
        let area2 = (at[1] - at[0]).cross(at[2] - at[0]).length();
        if area2 <= 0.0 {
            return;
        }
        for k in 0..3 {
            let (here, next, last) = (at[k], at[(k + 1) % 3], at[(k + 2) % 3]);
            let ring = &mut rings[triangle[k] as usize];
            ring.angle += angle_between(next - here, last - here);
            ring.area += area2 / 6.0;
            // The cotangent at a corner is dot over cross of its two sides; it
            // belongs to the edge opposite.
            let cot_last = (here - last).dot(next - last) / area2;
            let cot_next = (here - next).dot(last - next) / area2;
            ring.pull += (next - here) * cot_last + (last - here) * cot_next;
        }
    })?;
    Ok(rings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::test_shapes::{cylinder, sphere};
    use crate::test_support::{grid, torus};

    fn of(mesh: &Mesh, kind: Curvature) -> Vec<f64> {
        curvature(mesh, kind, &Unmonitored)
            .unwrap()
            .values()
            .to_vec()
    }

    #[test]
    fn total_gauss_curvature_is_that_of_the_topology() {
        for (mesh, expected) in [(sphere(24, 12), 4.0 * PI), (torus(24, 12, 3.0, 1.0), 0.0)] {
            let rings = rings(&mesh, &Unmonitored).unwrap();
            let gauss = of(&mesh, Curvature::Gauss);
            let total: f64 = gauss
                .iter()
                .zip(&rings)
                .map(|(k, ring)| k * ring.area)
                .sum();
            assert!((total - expected).abs() < 1e-12, "{total}");
        }
    }

    #[test]
    fn sphere_and_cylinder_have_their_radii() {
        let ball = sphere(64, 32);
        // Away from the poles, where the cells are regular.
        for kind in [Curvature::Mean, Curvature::Gauss] {
            let values = of(&ball, kind);
            let middle = 64 * 15 + 1;
            assert!((values[middle] - 1.0).abs() < 0.02, "{}", values[middle]);
        }
        let tube = cylinder(64, 4);
        let at = 64 * 2 + 5;
        assert!((of(&tube, Curvature::Max)[at] - 1.0).abs() < 2e-3);
        assert!(of(&tube, Curvature::Min)[at].abs() < 2e-3);
        assert!((of(&tube, Curvature::Mean)[at] - 0.5).abs() < 1e-3);
    }

    #[test]
    fn planes_are_flat_up_to_their_border() {
        let flat = grid(4, 4, |x, y| [x, y, 0.3 * x]);
        for kind in [
            Curvature::Gauss,
            Curvature::Mean,
            Curvature::Max,
            Curvature::Min,
        ] {
            assert!(
                of(&flat, kind).iter().all(|value| value.abs() < 1e-6),
                "{kind:?}"
            );
        }
    }
}
