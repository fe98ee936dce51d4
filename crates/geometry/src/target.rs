//! Directions from a base surface to a target surface (§3.1, figure 6).

use glam::DVec3;

use crate::math::unit_or_zero;
use crate::mesh::Domain;
use crate::normals::{NormalWeights, vertex_normals, vertices_without_normal};
use crate::{DirectionSource, Directions, GeometryError, Mesh, Monitor, parallel};

/// How long the directions towards a target are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TargetLength {
    /// As long as the way: height 1 reaches the target.
    #[default]
    Target,
    /// Of unit length: heights are distances along the way.
    Unit,
}

/// What happens where base and target coincide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ZeroPairs {
    /// An error names the vertices.
    #[default]
    Refuse,
    /// The base's unit vertex normal takes their place.
    Normal,
}

/// Directions D = T - P from each vertex of `base` to that of `target` (§3.1).
///
/// Both need the same faces with the same indices, corner by corner, because
/// vertices are paired by index. Pairs closer than the rounding of their
/// coordinates count as zero; those of isolated vertices stay zero. Cost:
/// O(vertices + corners).
///
/// ```
/// use tessgraph_geometry::target::{TargetLength, ZeroPairs, target_directions};
/// use tessgraph_geometry::{Mesh, Unmonitored, glam::DVec3};
/// let low = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let base = Mesh::from_faces(low.to_vec(), &[[0, 1, 2]])?;
/// let target = Mesh::from_faces(low.map(|[x, y, _]| [x, y, 2.0]).to_vec(), &[[0, 1, 2]])?;
/// let (length, zero) = (TargetLength::Target, ZeroPairs::Refuse);
/// let directions = target_directions(&base, &target, length, zero, &Unmonitored)?;
/// assert_eq!(directions.outward()[1], DVec3::new(0.0, 0.0, 2.0));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::TargetCounts`], [`GeometryError::TargetFace`] with the
/// first face that differs, [`GeometryError::ZeroDirection`],
/// [`GeometryError::NoNormal`] where a normal would be needed and there is
/// none, [`GeometryError::NonFiniteValue`] for vectors beyond the range of
/// numbers, [`GeometryError::Cancelled`].
pub fn target_directions(
    base: &Mesh,
    target: &Mesh,
    length: TargetLength,
    zero_pairs: ZeroPairs,
    monitor: &dyn Monitor,
) -> Result<Directions, GeometryError> {
    check_same_faces(base, target)?;
    let (from, to) = (base.positions(), target.positions());
    let mut vectors = parallel::map(base.vertex_count(), monitor, |vertex| {
        let (p, t) = (from[vertex], to[vertex]);
        let way = t - p;
        let rounding = 4.0 * f64::EPSILON * p.abs().max(t.abs()).max_element();
        if way.abs().max_element() <= rounding {
            DVec3::ZERO
        } else {
            way
        }
    })?;
    if let Some(index) = vectors.iter().position(|vector| !vector.is_finite()) {
        return Err(GeometryError::NonFiniteValue {
            what: "the way to the target",
            domain: Domain::Vertex,
            index,
        });
    }
    if length == TargetLength::Unit {
        parallel::fill(&mut vectors, monitor, |_, vector| {
            *vector = unit_or_zero(*vector);
        })?;
    }
    let vertices = vertices_without_normal(base, &vectors);
    if !vertices.is_empty() {
        match zero_pairs {
            ZeroPairs::Refuse => return Err(GeometryError::ZeroDirection { vertices }),
            ZeroPairs::Normal => replace(base, &vertices, &mut vectors, monitor)?,
        }
    }
    Directions::new(base, vectors, DirectionSource::Target)
}

/// Puts unit vertex normals at `vertices`.
fn replace(
    base: &Mesh,
    vertices: &[u32],
    vectors: &mut [DVec3],
    monitor: &dyn Monitor,
) -> Result<(), GeometryError> {
    let normals = vertex_normals(base, NormalWeights::Angle, true, monitor)?;
    for &vertex in vertices {
        vectors[vertex as usize] = normals[vertex as usize];
    }
    let vertices = vertices_without_normal(base, vectors);
    if vertices.is_empty() {
        Ok(())
    } else {
        Err(GeometryError::NoNormal { vertices })
    }
}

fn check_same_faces(base: &Mesh, target: &Mesh) -> Result<(), GeometryError> {
    if base.topology().is_same(target.topology()) {
        return Ok(());
    }
    let counts = |mesh: &Mesh| (mesh.vertex_count(), mesh.face_count());
    let (base_counts, target_counts) = (counts(base), counts(target));
    let differs = |&face: &usize| base.face(face) != target.face(face);
    if base_counts == target_counts
        && let Some(face) = (0..base.face_count()).find(differs)
    {
        return Err(GeometryError::TargetFace {
            face,
            base: base.face(face).to_vec(),
            target: target.face(face).to_vec(),
        });
    }
    Err(GeometryError::TargetCounts {
        base_vertices: base_counts.0,
        base_faces: base_counts.1,
        target_vertices: target_counts.0,
        target_faces: target_counts.1,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::test_shapes::{case, grid};

    fn ways(base: &Mesh, target: &Mesh, zero: ZeroPairs) -> Result<Directions, GeometryError> {
        target_directions(base, target, TargetLength::Target, zero, &Unmonitored)
    }

    #[test]
    fn height_one_reaches_the_target() {
        let Some(base) = case("07_fold_target_constant/base.obj") else {
            return;
        };
        let Some(target) = case("07_fold_target_constant/target.obj") else {
            return;
        };
        let directions = ways(&base, &target, ZeroPairs::Refuse).unwrap();
        assert_eq!(directions.source(), DirectionSource::Target);
        let unit = target_directions(
            &base,
            &target,
            TargetLength::Unit,
            ZeroPairs::Refuse,
            &Unmonitored,
        );
        let unit = unit.unwrap();
        for vertex in 0..base.vertex_count() {
            let way = directions.outward()[vertex];
            assert!((base.positions()[vertex] + way - target.positions()[vertex]).length() < 1e-15);
            assert!((unit.outward()[vertex] * way.length() - way).length() < 1e-14);
        }
    }

    #[test]
    fn zero_pairs_are_named_or_take_the_normal() {
        let base = grid(2, 1, |x, y| [x, y, 0.0]);
        let target = grid(2, 1, |x, y| [x, y, if x > 0.7 { 0.0 } else { 2.0 }]);
        let refused = ways(&base, &target, ZeroPairs::Refuse).unwrap_err();
        let vertices = vec![2, 5];
        assert_eq!(refused, GeometryError::ZeroDirection { vertices });
        let replaced = ways(&base, &target, ZeroPairs::Normal).unwrap();
        assert_eq!(replaced.outward()[2], DVec3::Z);
        assert_eq!(replaced.outward()[0], DVec3::Z * 2.0);
    }

    #[test]
    fn the_first_differing_face_is_named() {
        let base = grid(2, 2, |x, y| [x, y, 0.0]);
        let positions = || base.positions().iter().map(|p| [p.x, p.y, 1.0]).collect();
        let mut faces: Vec<Vec<u32>> = base.topology().faces().map(<[u32]>::to_vec).collect();
        faces[2].rotate_left(1);
        faces[3].swap(0, 1);
        let target = Mesh::from_faces(positions(), &faces).unwrap();
        let expected = GeometryError::TargetFace {
            face: 2,
            base: base.face(2).to_vec(),
            target: faces[2].clone(),
        };
        assert_eq!(
            ways(&base, &target, ZeroPairs::Refuse).unwrap_err(),
            expected
        );
        let fewer = Mesh::from_faces(positions(), &faces[..3]).unwrap();
        let counts = ways(&base, &fewer, ZeroPairs::Refuse).unwrap_err();
        assert!(matches!(
            counts,
            GeometryError::TargetCounts {
                target_faces: 3,
                ..
            }
        ));
    }

    #[test]
    fn isolated_vertices_stay_zero_and_huge_ways_are_refused() {
        let place = |z: f64| vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z], [5.0; 3]];
        let base = Mesh::from_faces(place(0.0), &[[0, 1, 2]]).unwrap();
        let target = Mesh::from_faces(place(1.0), &[[0, 1, 2]]).unwrap();
        let directions = ways(&base, &target, ZeroPairs::Refuse).unwrap();
        assert_eq!(directions.outward()[3], DVec3::ZERO);
        let far = |z: f64| Mesh::from_faces(place(z), &[[0, 1, 2]]).unwrap();
        let refused = ways(&far(-1e308), &far(1e308), ZeroPairs::Refuse);
        assert!(matches!(refused, Err(GeometryError::NonFiniteValue { .. })));
    }
}
