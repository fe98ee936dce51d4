//! How far components were bent out of shape.

use glam::DVec3;

use super::inversion::inverted;
use crate::array::COMPONENT_FACE;
use crate::intersect::components;
use crate::math::angle_between;
use crate::mesh::{AttributeValues, Domain};
use crate::{Field, GeometryError, Mesh, Monitor, Quantity, parallel};

/// Changes of edge lengths and angles, component by component.
#[derive(Debug, Clone)]
pub struct Distortion {
    /// Largest relative change of an edge length in each component.
    pub length_changes: Vec<f64>,
    /// Largest change of a corner's angle in each component, in radians.
    pub angle_changes: Vec<f64>,
    /// Whether each component is folded over somewhere or inside out: an edge
    /// between two of its faces more than 30 degrees from flat spans, with their
    /// middles, a volume of the other sign than in the component.
    pub inverted: Vec<bool>,
    /// `length_changes` of each face's component.
    pub length_field: Field,
    /// `angle_changes` of each face's component.
    pub angle_field: Field,
}

/// Sums over the edges and corners of one component.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// Length after and before.
    lengths: [f64; 2],
    angle: f64,
}

/// Compares the components of an array with the undistorted `component`.
///
/// Each face is compared with the face of the component it is a copy of
/// (attribute [`COMPONENT_FACE`]), corner by corner. With `scaled`, lengths are
/// compared after each copy is brought to the component's size (equal sums of
/// edge lengths), so that a copy of other size but equal shape counts as
/// undistorted. Edges without length in the component are left out. Cost:
/// O(corners + faces · log faces).
///
/// # Errors
/// [`GeometryError::NoAttribute`] for a mesh that is no array,
/// [`GeometryError::Invalid`] naming the first face that matches no face of the
/// component, [`GeometryError::Cancelled`].
pub fn distortion(
    mesh: &Mesh,
    component: &Mesh,
    scaled: bool,
    monitor: &dyn Monitor,
) -> Result<Distortion, GeometryError> {
    let originals = originals(mesh, component)?;
    let (of_face, count) = components(mesh, monitor)?;
    let mut sums = vec![Sums::default(); count];
    for (face, &original) in originals.iter().enumerate() {
        let (after, before) = (corners(mesh, face), corners(component, original));
        let sums = &mut sums[of_face[face] as usize];
        for k in 0..mesh.face(face).len() {
            sums.lengths[0] += length(&after, k);
            sums.lengths[1] += length(&before, k);
            sums.angle = sums.angle.max((angle(&after, k) - angle(&before, k)).abs());
        }
        if face % parallel::CHUNK == 0 {
            monitor.check()?;
        }
    }
    let scale = |component: usize| match sums[component].lengths {
        [after, before] if scaled && after > 0.0 => before / after,
        _ => 1.0,
    };
    let mut length_changes = vec![0.0f64; count];
    for (face, &original) in originals.iter().enumerate() {
        let (after, before) = (corners(mesh, face), corners(component, original));
        let owner = of_face[face] as usize;
        for k in 0..mesh.face(face).len() {
            let wanted = length(&before, k);
            if wanted > 0.0 {
                let change = (length(&after, k) * scale(owner) / wanted - 1.0).abs();
                length_changes[owner] = length_changes[owner].max(change);
            }
        }
    }
    let inverted = inverted(mesh, component, &originals, &of_face, count);
    let angle_changes: Vec<f64> = sums.iter().map(|sums| sums.angle).collect();
    let field = |quantity, values: &[f64]| {
        let at = |face: usize| values[of_face[face] as usize];
        Field::new(
            Domain::Face,
            quantity,
            parallel::map(mesh.face_count(), monitor, at)?,
        )
    };
    Ok(Distortion {
        length_field: field(Quantity::Number, &length_changes)?,
        angle_field: field(Quantity::Angle, &angle_changes)?,
        length_changes,
        angle_changes,
        inverted,
    })
}

/// The face of the component that each face is a copy of.
fn originals(mesh: &Mesh, component: &Mesh) -> Result<Vec<usize>, GeometryError> {
    let stored = mesh
        .attribute(COMPONENT_FACE, Domain::Face)
        .map(|a| a.values());
    let Some(AttributeValues::Integer(stored)) = stored else {
        return Err(GeometryError::NoAttribute {
            name: COMPONENT_FACE.to_owned(),
            wanted: "integer face",
            available: mesh
                .attributes()
                .iter()
                .map(|a| a.name().to_owned())
                .collect(),
        });
    };
    let matching = |(face, &original): (usize, &i64)| {
        let original = usize::try_from(original).ok();
        original
            .filter(|&original| {
                original < component.face_count()
                    && component.face(original).len() == mesh.face(face).len()
            })
            .ok_or_else(|| {
                GeometryError::Invalid(format!(
                    "face {face} is no copy of a face of this component; \
                     give the component that was arrayed, fitted as it was"
                ))
            })
    };
    stored.iter().enumerate().map(matching).collect()
}

/// The place of corner k of a face, k counted round.
fn corners(mesh: &Mesh, face: usize) -> impl Fn(usize) -> DVec3 {
    let vertices = mesh.face(face);
    move |k: usize| mesh.positions()[vertices[k % vertices.len()] as usize]
}

fn length(at: &impl Fn(usize) -> DVec3, k: usize) -> f64 {
    (at(k + 1) - at(k)).length()
}

/// The angle at corner k + 1.
fn angle(at: &impl Fn(usize) -> DVec3, k: usize) -> f64 {
    angle_between(at(k) - at(k + 1), at(k + 2) - at(k + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{cuboid, grid};
    use crate::{Attribute, Unmonitored};

    fn copy(place: impl Fn(DVec3) -> DVec3) -> (Mesh, Mesh) {
        let component = cuboid(1.0, 1.0, 0.0, 0.5);
        let places = component.positions().iter().map(|&p| place(p)).collect();
        let faces = AttributeValues::Integer((0..6).collect());
        let mesh = component.with_positions(places).unwrap();
        let faces = Attribute::new(COMPONENT_FACE, Domain::Face, faces);
        (mesh.with_attribute(faces).unwrap(), component)
    }

    #[test]
    fn equal_shape_is_undistorted_and_shear_is_measured() {
        let (same, component) = copy(|p| DVec3::new(-p.y, p.x, p.z) * 3.0 + DVec3::ONE);
        let found = distortion(&same, &component, true, &Unmonitored).unwrap();
        assert!(found.length_changes[0] < 1e-14 && found.angle_changes[0] < 1e-7);
        let size = distortion(&same, &component, false, &Unmonitored).unwrap();
        assert!((size.length_changes[0] - 2.0).abs() < 1e-14);
        let (sheared, component) = copy(|p| DVec3::new(p.x + p.y, p.y, p.z));
        let found = distortion(&sheared, &component, false, &Unmonitored).unwrap();
        assert!((found.length_changes[0] - (2f64.sqrt() - 1.0)).abs() < 1e-14);
        assert!((found.angle_changes[0] - crate::math::PI / 4.0).abs() < 1e-14);
        assert_eq!(found.angle_field.values().len(), 6);
    }

    #[test]
    fn folded_and_mirrored_copies_are_inverted() {
        let is_inverted = |place: fn(DVec3) -> DVec3| {
            let (mesh, component) = copy(place);
            let found = distortion(&mesh, &component, true, &Unmonitored).unwrap();
            found.inverted[0]
        };
        // Turned, sheared until the top stands beside the bottom, tapered.
        assert!(!is_inverted(|p| DVec3::new(-p.y, p.x, p.z)));
        assert!(!is_inverted(|p| DVec3::new(p.x + 9.0 * p.z, p.y, p.z)));
        assert!(!is_inverted(|p| DVec3::new(p.x * (1.0 - p.z), p.y, p.z)));
        // Mirrored, put below the surface, and with a top narrower than nothing.
        assert!(is_inverted(|p| DVec3::new(p.y, p.x, p.z)));
        assert!(is_inverted(|p| DVec3::new(p.x, p.y, -p.z)));
        assert!(is_inverted(|p| DVec3::new(
            p.x * (1.0 - 3.0 * p.z),
            p.y,
            p.z
        )));
    }

    #[test]
    fn meshes_that_are_no_array_are_refused() {
        let (mesh, _) = copy(|p| p);
        let other = grid(1, 1, |x, y| [x, y, 0.0]);
        let refused = distortion(&mesh, &other, true, &Unmonitored).unwrap_err();
        assert!(refused.to_string().contains("face 1"), "{refused}");
        let plain = distortion(&other, &mesh, true, &Unmonitored).unwrap_err();
        assert!(matches!(plain, GeometryError::NoAttribute { .. }));
    }
}
