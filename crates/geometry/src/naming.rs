//! Faces found by the name of a group, object or material.

use crate::{GeometryError, Labels, Mesh};

/// Faces that carry `name` as a group, an object or a material, ascending.
///
/// OBJ files name parts with `g`, `o` or `usemtl` alike, so all three are
/// looked through. Cost: O(faces + names).
///
/// # Errors
/// [`GeometryError::Invalid`] with the names there are, when no face has `name`.
pub fn faces_named(mesh: &Mesh, name: &str) -> Result<Vec<u32>, GeometryError> {
    let in_groups = matching(mesh.groups(), |names| names.iter().any(|n| n == name));
    let in_objects = matching(mesh.objects(), |object| object == name);
    let in_materials = matching(mesh.materials(), |material| material.name == name);
    let found: Vec<u32> = (0..mesh.face_count())
        .filter(|&face| {
            has(mesh.groups(), &in_groups, face)
                || has(mesh.objects(), &in_objects, face)
                || has(mesh.materials(), &in_materials, face)
        })
        .map(|face| face as u32)
        .collect();
    if found.is_empty() {
        return Err(GeometryError::Invalid(format!(
            "no face is in a group, object or material `{name}`; {}",
            list_names(mesh)
        )));
    }
    Ok(found)
}

fn matching<L>(labels: &Labels<L>, wanted: impl Fn(&L) -> bool) -> Vec<bool> {
    labels.labels().iter().map(wanted).collect()
}

fn has<L>(labels: &Labels<L>, matching: &[bool], face: usize) -> bool {
    let label = labels.of_face().get(face).copied();
    label.is_some_and(|label| matching.get(label as usize) == Some(&true))
}

/// How many names a message lists before it only counts the rest.
const LISTED: usize = 8;

fn list_names(mesh: &Mesh) -> String {
    let groups = mesh.groups().labels().iter().flatten().map(String::as_str);
    let objects = mesh.objects().labels().iter().map(String::as_str);
    let materials = mesh.materials().labels().iter().map(|m| m.name.as_str());
    let mut names: Vec<&str> = Vec::new();
    for name in groups.chain(objects).chain(materials) {
        if !names.contains(&name) {
            names.push(name);
        }
        if names.len() > LISTED {
            break;
        }
    }
    let listed: Vec<_> = names
        .iter()
        .take(LISTED)
        .map(|n| format!("`{n}`"))
        .collect();
    match (listed.is_empty(), names.len() > LISTED) {
        (true, _) => "the mesh has no such names".to_owned(),
        (false, false) => format!("the mesh has {}", listed.join(", ")),
        (false, true) => format!("the mesh has {} and more", listed.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Material;

    fn two_quads() -> Mesh {
        let place = |k: u32| [f64::from(k % 3), f64::from(k / 3), 0.0];
        let mesh = Mesh::from_faces((0..6).map(place).collect(), &[[0, 1, 4, 3], [1, 2, 5, 4]]);
        let groups = Labels::new(
            vec![vec!["cell".to_owned(), "all".to_owned()]],
            vec![0, u32::MAX],
        );
        let materials = Labels::new(vec![Material::named("steel")], vec![u32::MAX, 0]);
        mesh.and_then(|mesh| mesh.with_groups(groups?)?.with_materials(materials?))
            .unwrap()
    }

    #[test]
    fn finds_groups_and_materials() {
        let mesh = two_quads();
        assert_eq!(faces_named(&mesh, "all").unwrap(), [0]);
        assert_eq!(faces_named(&mesh, "steel").unwrap(), [1]);
    }

    #[test]
    fn a_missing_name_lists_what_there_is() {
        let error = faces_named(&two_quads(), "box").unwrap_err().to_string();
        assert!(error.contains("`cell`, `all`, `steel`"), "{error}");
    }
}
