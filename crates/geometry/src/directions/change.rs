//! Directions made of other directions: blended, scaled.

use glam::DVec3;

use crate::math::{lerp, unit_or_zero};
use crate::mesh::Domain;
use crate::normals::vertices_without_normal;
use crate::{Amount, DirectionSource, Directions, GeometryError, Mesh, Monitor, parallel};

/// Directions between `a` (amount 0) and `b` (amount 1), vertex by vertex.
///
/// Sense and length are blended apart: the sense is the normalised linear
/// blend of the two unit vectors, the length the linear blend of their
/// lengths, so that unit directions stay unit. The result counts as from a
/// target as soon as one of them is. Cost: O(vertices).
///
/// # Errors
/// [`GeometryError::OtherTopology`], [`GeometryError::Compensated`],
/// [`GeometryError::OutOfRange`] for amounts outside 0..=1;
/// [`GeometryError::ZeroDirection`] names vertices of faces whose two
/// directions cancel or have no length; [`GeometryError::Cancelled`].
pub fn blend_directions(
    mesh: &Mesh,
    a: &Directions,
    b: &Directions,
    amount: &Amount,
    monitor: &dyn Monitor,
) -> Result<Directions, GeometryError> {
    for directions in [a, b] {
        check_plain(mesh, directions, "BlendDirections")?;
    }
    amount.check(mesh, Domain::Vertex)?;
    let (low, high) = amount.range();
    if mesh.vertex_count() > 0 && !(low >= 0.0 && high <= 1.0) {
        return Err(GeometryError::OutOfRange {
            what: "the blend amount",
            value: if low >= 0.0 { high } else { low },
            requirement: "it must be from 0 to 1",
        });
    }
    let vectors = parallel::map(mesh.vertex_count(), monitor, |vertex| {
        let (a, b) = (a.outward()[vertex], b.outward()[vertex]);
        match amount.at(vertex) {
            share if share <= 0.0 => a,
            share if share >= 1.0 => b,
            share => {
                let sense = lerp(unit_or_zero(a), unit_or_zero(b), share);
                let length = a.length() * (1.0 - share) + b.length() * share;
                // Opposite unit vectors leave rounding only.
                if sense.length_squared() > 1e-24 {
                    unit_or_zero(sense) * length
                } else {
                    DVec3::ZERO
                }
            }
        }
    })?;
    let target = [a, b].iter().any(|d| d.source() == DirectionSource::Target);
    let source = if target {
        DirectionSource::Target
    } else {
        DirectionSource::Surface
    };
    finish(mesh, vectors, source)
}

/// Directions with x, y and z multiplied by `factors`: z = 0 levels them, the
/// others 0 set them upright. At unit length again if `unit`.
///
/// Each vertex takes part by its `amount`, one for all or one per vertex: it is
/// multiplied by 1 + amount (factor - 1), so 0 leaves it as it is. Cost:
/// O(vertices).
///
/// # Errors
/// [`GeometryError::OtherTopology`], [`GeometryError::Compensated`],
/// [`GeometryError::NonFiniteValue`]; those of [`Amount::check`]; [`GeometryError::ZeroDirection`] names
/// vertices of faces with nothing left; [`GeometryError::Cancelled`].
pub fn scale_directions(
    mesh: &Mesh,
    directions: &Directions,
    factors: DVec3,
    amount: &Amount,
    unit: bool,
    monitor: &dyn Monitor,
) -> Result<Directions, GeometryError> {
    check_plain(mesh, directions, "ScaleDirections")?;
    amount.check(mesh, Domain::Vertex)?;
    let vectors = parallel::map(mesh.vertex_count(), monitor, |vertex| {
        let share = amount.at(vertex);
        // Exactly the factors at 1, exactly the direction at 0.
        let factors = DVec3::splat(1.0 - share) + factors * share;
        let scaled = directions.outward()[vertex] * factors;
        if unit && scaled.is_finite() {
            unit_or_zero(scaled)
        } else {
            scaled
        }
    })?;
    finish(mesh, vectors, directions.source())
}

/// Changed lengths would undo a compensation, so compensated ones are refused.
fn check_plain(
    mesh: &Mesh,
    directions: &Directions,
    operation: &'static str,
) -> Result<(), GeometryError> {
    directions.check(mesh)?;
    if directions.is_compensated() {
        return Err(GeometryError::Compensated { operation });
    }
    Ok(())
}

fn finish(
    mesh: &Mesh,
    vectors: Vec<DVec3>,
    source: DirectionSource,
) -> Result<Directions, GeometryError> {
    let vertices = vertices_without_normal(mesh, &vectors);
    if vertices.is_empty() {
        Directions::new(mesh, vectors, source)
    } else {
        Err(GeometryError::ZeroDirection { vertices })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::test_shapes::{directions, grid};
    use crate::{Field, Quantity, Unmonitored};

    fn quad() -> Mesh {
        grid(1, 1, |x, y| [x, y, 0.0])
    }

    fn blend(a: DVec3, b: DVec3, amount: &Amount) -> Result<Directions, GeometryError> {
        let mesh = quad();
        let [a, b] = [a, b].map(|vector| directions(&mesh, vec![vector; 4]));
        blend_directions(&mesh, &a, &b, amount, &Unmonitored)
    }

    #[test]
    fn senses_and_lengths_are_blended_apart() {
        let halves = blend(DVec3::X * 3.0, DVec3::Z, &0.5.into()).unwrap();
        let expected = DVec3::new(1.0, 0.0, 1.0).normalize() * 2.0;
        assert!((halves.outward()[0] - expected).length() < 1e-15);
        let values = vec![0.0, 0.25, 0.5, 1.0];
        let field = Field::new(Domain::Vertex, Quantity::Number, values).unwrap();
        let (a, b) = (DVec3::new(0.6, 0.0, 0.8), DVec3::Z);
        let ramp = blend(a, b, &Amount::Field(Arc::new(field))).unwrap();
        assert_eq!((ramp.outward()[0], ramp.outward()[3]), (a, b));
        for vector in ramp.outward().iter() {
            assert!((vector.length() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn what_cannot_be_blended_is_named() {
        let opposite = blend(DVec3::Z, -DVec3::Z, &0.5.into()).unwrap_err();
        let vertices = vec![0, 1, 2, 3];
        assert_eq!(opposite, GeometryError::ZeroDirection { vertices });
        for wrong in [-0.1, 1.1, f64::NAN] {
            let refused = blend(DVec3::Z, DVec3::X, &wrong.into());
            assert!(matches!(refused, Err(GeometryError::OutOfRange { .. })));
        }
    }

    #[test]
    fn scaling_levels_directions() {
        let mesh = quad();
        let lean = directions(&mesh, vec![DVec3::new(0.6, 0.0, 0.8); 4]);
        let level = DVec3::new(1.0, 1.0, 0.0);
        let all = Amount::Constant(1.0);
        let scale = |unit| scale_directions(&mesh, &lean, level, &all, unit, &Unmonitored).unwrap();
        assert_eq!(scale(false).outward()[2], DVec3::new(0.6, 0.0, 0.0));
        assert_eq!(scale(true).outward()[2], DVec3::X);
        let nothing = scale_directions(&mesh, &lean, DVec3::Y, &all, true, &Unmonitored);
        assert!(matches!(nothing, Err(GeometryError::ZeroDirection { .. })));
        let vectors = || lean.outward().to_vec();
        let compensated = lean.compensated(vectors(), vectors()).unwrap();
        let refused = scale_directions(&mesh, &compensated, level, &all, true, &Unmonitored);
        assert!(matches!(refused, Err(GeometryError::Compensated { .. })));
    }

    #[test]
    fn a_field_says_how_much_each_vertex_is_scaled() {
        let mesh = quad();
        let lean = directions(&mesh, vec![DVec3::new(0.6, 0.0, 0.8); 4]);
        let shares = Field::new(Domain::Vertex, Quantity::Number, vec![0.0, 0.25, 0.5, 1.0]);
        let shares = Amount::Field(Arc::new(shares.unwrap()));
        let level = DVec3::new(1.0, 1.0, 0.0);
        let scaled = scale_directions(&mesh, &lean, level, &shares, false, &Unmonitored).unwrap();
        let heights: Vec<f64> = scaled.outward().iter().map(|vector| vector.z).collect();
        for (z, expected) in heights.iter().zip([0.8, 0.6, 0.4, 0.0]) {
            assert!((z - expected).abs() < 1e-15, "{heights:?}");
        }
        let faces = Field::new(Domain::Face, Quantity::Number, vec![1.0]).unwrap();
        let faces = Amount::Field(Arc::new(faces));
        let refused = scale_directions(&mesh, &lean, level, &faces, true, &Unmonitored);
        assert!(matches!(refused, Err(GeometryError::FieldDomain { .. })));
    }
}
