//! Moves vertices along directions.

use glam::DVec3;

use crate::mesh::Domain;
use crate::{Amount, DirectionSource, Directions, GeometryError, Mesh, Monitor, parallel};

/// Every vertex P moved to P + d D: `distance` d in model units, times the
/// direction D of its side (outward for d >= 0, inward for d < 0).
///
/// A distance is a signed height, as a component's w is: with unit normals it
/// is metres, with target directions 1 reaches the target, with compensated
/// ones it is the thickness they were compensated for (§3.2). Faces, attributes
/// and labels stay as they are. Cost: O(vertices).
///
/// # Errors
/// [`GeometryError::OtherTopology`] for directions of another mesh;
/// [`GeometryError::FieldLength`] or [`GeometryError::FieldDomain`] for a field
/// that is not one number per vertex; [`GeometryError::NonFiniteValue`] for a
/// distance that is not finite; [`GeometryError::ZeroDirection`] naming
/// vertices of faces that should move but have a surface direction of length
/// zero (target directions may well be zero: those vertices are there already);
/// [`GeometryError::NonFiniteVertex`] on overflow; [`GeometryError::Cancelled`].
///
/// ```
/// use tessgraph_geometry::{DirectionSource, Directions, Unmonitored, displace_vertices};
/// use tessgraph_geometry::{glam::{DVec2, DVec3}, primitives::grid};
/// let mesh = grid([2, 2], DVec2::ONE, false)?;
/// let up = Directions::new(&mesh, vec![DVec3::Z; 9], DirectionSource::Surface)?;
/// let raised = displace_vertices(&mesh, &up, &0.3.into(), &Unmonitored)?;
/// assert!(raised.positions().iter().all(|p| p.z == 0.3));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn displace_vertices(
    mesh: &Mesh,
    directions: &Directions,
    distance: &Amount,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    directions.check(mesh)?;
    distance.check(mesh, Domain::Vertex)?;
    check_finite(distance)?;
    check_directions(mesh, directions, distance)?;
    let positions = parallel::map(mesh.vertex_count(), monitor, |vertex| {
        let d = distance.at(vertex);
        mesh.positions()[vertex] + directions.side(d)[vertex] * d
    })?;
    mesh.with_positions(positions)
}

/// Fields are finite by construction; a constant may be anything.
fn check_finite(distance: &Amount) -> Result<(), GeometryError> {
    match distance {
        Amount::Constant(number) if !number.is_finite() => Err(GeometryError::NonFiniteValue {
            what: "the distance",
            domain: Domain::Vertex,
            index: 0,
        }),
        _ => Ok(()),
    }
}

fn check_directions(
    mesh: &Mesh,
    directions: &Directions,
    distance: &Amount,
) -> Result<(), GeometryError> {
    if directions.source() == DirectionSource::Target {
        return Ok(());
    }
    let adjacency = mesh.topology().adjacency();
    let stuck = |&vertex: &u32| {
        let index = vertex as usize;
        let d = distance.at(index);
        d != 0.0
            && directions.side(d)[index] == DVec3::ZERO
            && !adjacency.vertex_corners(index).is_empty()
    };
    let vertices: Vec<u32> = (0..mesh.vertex_count() as u32).filter(stuck).collect();
    if vertices.is_empty() {
        Ok(())
    } else {
        Err(GeometryError::ZeroDirection { vertices })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use proptest::prelude::*;

    use super::*;
    use crate::measure::measure_mesh;
    use crate::normals::{NormalWeights, vertex_normals};
    use crate::primitives::{cuboid, grid};
    use crate::{Field, Quantity, Unmonitored};
    use glam::DVec2;

    fn plane() -> (Mesh, Directions) {
        let mesh = grid([2, 1], DVec2::new(2.0, 1.0), false).expect("valid");
        let up = Directions::new(&mesh, vec![DVec3::Z; 6], DirectionSource::Surface);
        let directions = up.expect("finite");
        (mesh, directions)
    }

    fn field(values: Vec<f64>) -> Amount {
        let field = Field::new(Domain::Vertex, Quantity::Length, values);
        Amount::Field(Arc::new(field.expect("finite")))
    }

    #[test]
    fn each_side_has_its_own_vectors() {
        let (mesh, directions) = plane();
        let (out, inside) = (vec![DVec3::Z * 2.0; 6], vec![DVec3::Z * 3.0; 6]);
        let directions = directions.compensated(out, inside).expect("finite");
        let distance = field(vec![1.0, -1.0, 0.0, 0.5, -0.5, -0.0]);
        let moved = displace_vertices(&mesh, &directions, &distance, &Unmonitored).expect("moves");
        let heights: Vec<f64> = moved.positions().iter().map(|p| p.z).collect();
        assert_eq!(heights, [2.0, -3.0, 0.0, 1.0, -1.5, 0.0]);
    }

    #[test]
    fn a_box_grows_by_its_corners() {
        let mesh = cuboid(DVec3::splat(2.0), [1, 1, 1], true).expect("valid");
        let normals = vertex_normals(&mesh, NormalWeights::Angle, true, &Unmonitored);
        let directions = Directions::new(&mesh, normals.expect("done"), DirectionSource::Surface);
        let directions = directions.expect("finite");
        let distance = 3f64.sqrt().into();
        let moved = displace_vertices(&mesh, &directions, &distance, &Unmonitored).expect("moves");
        let volume = measure_mesh(&moved).volume.expect("closed");
        assert!((volume - 64.0).abs() < 1e-12);
    }

    #[test]
    fn vertices_that_cannot_move_are_named() {
        let (mesh, _) = plane();
        let mut vectors = vec![DVec3::Z; 6];
        vectors[2] = DVec3::ZERO;
        vectors[4] = DVec3::ZERO;
        let run = |source, distance: Amount| {
            let directions = Directions::new(&mesh, vectors.clone(), source).expect("finite");
            displace_vertices(&mesh, &directions, &distance, &Unmonitored).err()
        };
        let vertices = vec![2, 4];
        let expected = GeometryError::ZeroDirection { vertices };
        assert_eq!(run(DirectionSource::Surface, 1.0.into()), Some(expected));
        assert_eq!(run(DirectionSource::Surface, 0.0.into()), None);
        assert_eq!(run(DirectionSource::Target, 1.0.into()), None);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let (mesh, directions) = plane();
        let run = |mesh: &Mesh, distance: Amount| {
            displace_vertices(mesh, &directions, &distance, &Unmonitored).err()
        };
        let other = grid([3, 1], DVec2::ONE, false).expect("valid");
        assert!(matches!(
            run(&other, 1.0.into()),
            Some(GeometryError::OtherTopology { .. })
        ));
        assert!(matches!(
            run(&mesh, field(vec![1.0])),
            Some(GeometryError::FieldLength { .. })
        ));
        assert!(matches!(
            run(&mesh, f64::NAN.into()),
            Some(GeometryError::NonFiniteValue { .. })
        ));
        assert!(run(&mesh, 1e308.into()).is_none());
    }

    proptest! {
        #[test]
        fn there_and_back_is_where_it_was(distances in prop::collection::vec(-3.0..3.0f64, 6)) {
            let (mesh, directions) = plane();
            let back = field(distances.iter().map(|d| -d).collect());
            let there = displace_vertices(&mesh, &directions, &field(distances), &Unmonitored);
            let here = displace_vertices(&there.expect("moves"), &directions, &back, &Unmonitored);
            for (a, b) in here.expect("moves").positions().iter().zip(mesh.positions().iter()) {
                prop_assert!(a.distance(*b) < 1e-15);
            }
        }
    }
}
