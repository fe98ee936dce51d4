//! Puts meshes into one.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::buffer::Buffer;
use crate::mesh::{Attribute, AttributeValues, Domain, Labels, Material, NO_LABEL};
use crate::subdivide::PARENT;
use crate::{GeometryError, Mesh, Topology};

/// All meshes in one, one after the other, not welded.
///
/// Vertices, faces and corners keep their order. An attribute that any mesh has
/// is in the result, in the order of first appearance; where a mesh lacks it
/// its elements get 0, and whole numbers join with decimal ones as decimals.
/// The `parent` of faces is shifted so that parents of different meshes stay
/// apart. Groups and objects of one name are one, and materials too if they
/// look alike; a material that differs from an earlier one of its name is kept
/// as "NAME 2" and so on. Faces without a label stay without. Cost: O(result).
///
/// # Errors
/// [`GeometryError::AttributeTypes`] when one name stands for different types;
/// [`GeometryError::TooMany`] before anything is allocated.
///
/// ```
/// use tessgraph_geometry::{glam::DVec3, join, primitives::cuboid};
/// let (a, b) = (cuboid(DVec3::ONE, [1; 3], false)?, cuboid(DVec3::ONE, [2; 3], true)?);
/// assert_eq!(join(&[&a, &b])?.vertex_count(), 8 + 26);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn join(meshes: &[&Mesh]) -> Result<Mesh, GeometryError> {
    check_counts(meshes)?;
    let mut positions = Vec::with_capacity(total(meshes, Domain::Vertex));
    let mut corners = Vec::with_capacity(total(meshes, Domain::Corner));
    let mut offsets = Vec::with_capacity(total(meshes, Domain::Face) + 1);
    offsets.push(0);
    for mesh in meshes {
        let (vertices, before) = (positions.len() as u32, corners.len() as u32);
        positions.extend_from_slice(mesh.positions());
        let topology = mesh.topology();
        corners.extend(topology.corners().iter().map(|corner| corner + vertices));
        offsets.extend(topology.offsets()[1..].iter().map(|offset| offset + before));
    }
    let topology = Topology::new(positions.len(), offsets, corners)?;
    let mut joined = Mesh::new(positions, Arc::new(topology))?
        .with_materials(join_labels(
            meshes,
            Mesh::materials,
            |m| m.name.clone(),
            numbered,
        )?)?
        .with_groups(join_labels(
            meshes,
            Mesh::groups,
            Vec::clone,
            |names, _| names.clone(),
        )?)?
        .with_objects(join_labels(
            meshes,
            Mesh::objects,
            String::clone,
            |name, _| name.clone(),
        )?)?;
    for (name, domain) in attribute_names(meshes) {
        let values = join_values(meshes, name, domain)?;
        joined = joined.with_attribute(Attribute::new(name, domain, values))?;
    }
    Ok(joined)
}

fn total(meshes: &[&Mesh], domain: Domain) -> usize {
    meshes.iter().map(|mesh| mesh.element_count(domain)).sum()
}

fn check_counts(meshes: &[&Mesh]) -> Result<(), GeometryError> {
    let limit = u128::from(u32::MAX - 1);
    for (what, domain) in [("vertices", Domain::Vertex), ("corners", Domain::Corner)] {
        let counts = meshes.iter().map(|mesh| mesh.element_count(domain) as u128);
        let count = counts.sum();
        if count > limit {
            return Err(GeometryError::TooMany { what, count, limit });
        }
    }
    Ok(())
}

/// Every attribute's name and domain once, in the order of first appearance.
fn attribute_names<'a>(meshes: &[&'a Mesh]) -> Vec<(&'a str, Domain)> {
    let mut names = Vec::new();
    for attribute in meshes.iter().flat_map(|mesh| mesh.attributes()) {
        let name = (attribute.name(), attribute.domain());
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// One attribute's values over all meshes.
fn join_values(
    meshes: &[&Mesh],
    name: &str,
    domain: Domain,
) -> Result<AttributeValues, GeometryError> {
    let all = Joining {
        meshes,
        name,
        domain,
    };
    Ok(match common_type(meshes, name, domain)? {
        "integer" if name == PARENT && domain == Domain::Face => join_parents(meshes),
        "integer" => AttributeValues::Integer(all.gather(|values, out| {
            if let AttributeValues::Integer(values) = values {
                out.extend_from_slice(values);
            }
        })),
        "number" => AttributeValues::Number(all.gather(|values, out| match values {
            AttributeValues::Number(values) => out.extend_from_slice(values),
            AttributeValues::Integer(values) => {
                out.extend(values.iter().map(|&value| value as f64));
            }
            _ => {}
        })),
        "2D vector" => AttributeValues::Vector2(all.gather(|values, out| {
            if let AttributeValues::Vector2(values) = values {
                out.extend_from_slice(values);
            }
        })),
        _ => AttributeValues::Vector3(all.gather(|values, out| {
            if let AttributeValues::Vector3(values) = values {
                out.extend_from_slice(values);
            }
        })),
    })
}

/// One attribute of all meshes.
struct Joining<'a> {
    meshes: &'a [&'a Mesh],
    name: &'a str,
    domain: Domain,
}

impl Joining<'_> {
    /// All values in one array, so that many meshes cost no more than few:
    /// those that `add` appends, and zeros for a mesh that has none.
    fn gather<T: Clone + Default>(&self, add: impl Fn(&AttributeValues, &mut Vec<T>)) -> Buffer<T> {
        let mut all = Vec::with_capacity(total(self.meshes, self.domain));
        for mesh in self.meshes {
            let end = all.len() + mesh.element_count(self.domain);
            if let Some(attribute) = mesh.attribute(self.name, self.domain) {
                add(attribute.values(), &mut all);
            }
            all.resize(end, T::default());
        }
        all.into()
    }
}

/// The type that holds the values of all meshes.
fn common_type(
    meshes: &[&Mesh],
    name: &str,
    domain: Domain,
) -> Result<&'static str, GeometryError> {
    let attributes = meshes
        .iter()
        .filter_map(|mesh| mesh.attribute(name, domain));
    let mut types = attributes.map(|attribute| attribute.values().type_name());
    let first = types.next().unwrap_or("number");
    types.try_fold(first, |first, other| match (first, other) {
        _ if first == other => Ok(first),
        ("integer", "number") | ("number", "integer") => Ok("number"),
        _ => Err(GeometryError::AttributeTypes {
            name: name.into(),
            domain,
            first,
            other,
        }),
    })
}

/// Parents of later meshes follow those of earlier ones; the faces of a mesh
/// without parents are a parent each.
fn join_parents(meshes: &[&Mesh]) -> AttributeValues {
    let mut all: Vec<i64> = Vec::with_capacity(total(meshes, Domain::Face));
    let mut next = 0i64;
    for mesh in meshes {
        let start = all.len();
        match mesh.attribute(PARENT, Domain::Face).map(|a| a.values()) {
            Some(AttributeValues::Integer(values)) => {
                all.extend(values.iter().map(|parent| parent.saturating_add(next)));
            }
            _ => all.extend((0..mesh.face_count() as i64).map(|face| face + next)),
        }
        let highest = all[start..].iter().copied().max();
        next = highest.map_or(next, |highest| highest.saturating_add(1).max(next));
    }
    AttributeValues::Integer(all.into())
}

/// Labels of all faces; equal keys are one label, and `resolve` turns a label
/// whose key is taken by a different one into another.
fn join_labels<L: Clone + PartialEq, K: Ord>(
    meshes: &[&Mesh],
    of: impl Fn(&Mesh) -> &Labels<L>,
    key: impl Fn(&L) -> K,
    resolve: impl Fn(&L, usize) -> L,
) -> Result<Labels<L>, GeometryError> {
    if meshes.iter().all(|mesh| of(mesh).is_empty()) {
        return Ok(Labels::default());
    }
    let mut labels: Vec<L> = Vec::new();
    let mut places: BTreeMap<K, usize> = BTreeMap::new();
    let mut place = |label: &L| {
        let mut candidate = label.clone();
        let mut number = 1;
        loop {
            let next = labels.len();
            let place = *places.entry(key(&candidate)).or_insert(next);
            if place == next {
                labels.push(candidate);
            } else if labels[place] != candidate {
                number += 1;
                candidate = resolve(label, number);
                continue;
            }
            return place as u32;
        }
    };
    let mut of_face = Vec::with_capacity(total(meshes, Domain::Face));
    for mesh in meshes {
        let theirs = of(mesh);
        if theirs.is_empty() {
            of_face.resize(of_face.len() + mesh.face_count(), NO_LABEL);
            continue;
        }
        let ours: Vec<u32> = theirs.labels().iter().map(&mut place).collect();
        let rename = |&label: &u32| ours.get(label as usize).copied().unwrap_or(NO_LABEL);
        of_face.extend(theirs.of_face().iter().map(rename));
    }
    Labels::new(labels, of_face)
}

/// The same look under the name "NAME 2", "NAME 3" and so on.
fn numbered(material: &Material, number: usize) -> Material {
    Material {
        name: format!("{} {number}", material.name),
        ..material.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unmonitored;
    use crate::measure::measure_mesh;
    use crate::primitives::{cuboid, grid};
    use crate::subdivide::{Options, Parents, subdivide};
    use glam::{DVec2, DVec3};
    use proptest::prelude::*;

    fn plate(cells: [usize; 2]) -> Mesh {
        grid(cells, DVec2::ONE, false).expect("valid")
    }

    fn bare(mesh: Mesh) -> Mesh {
        mesh.without_attributes()
    }

    fn with(mesh: Mesh, name: &str, domain: Domain, values: AttributeValues) -> Mesh {
        let attribute = Attribute::new(name, domain, values);
        mesh.with_attribute(attribute).expect("fits")
    }

    fn colored(name: &str, red: f64) -> Material {
        Material {
            base_color: [red, 0.0, 0.0, 1.0],
            ..Material::named(name)
        }
    }

    #[test]
    fn nothing_joins_to_nothing() {
        let nothing = join(&[]).expect("empty");
        assert_eq!((nothing.vertex_count(), nothing.face_count()), (0, 0));
    }

    #[test]
    fn one_mesh_joins_to_itself() {
        let mesh = cuboid(DVec3::ONE, [1, 2, 3], false).expect("valid");
        assert_eq!(join(&[&mesh]).expect("valid").digest(), mesh.digest());
    }

    #[test]
    fn faces_keep_their_own_vertices() {
        let (a, b) = (plate([2, 1]), plate([1, 1]));
        let joined = join(&[&a, &b]).expect("valid");
        assert_eq!(joined.face(2), [6, 7, 9, 8]);
        assert_eq!(joined.positions()[6..], b.positions()[..]);
    }

    #[test]
    fn missing_values_are_zero_and_whole_numbers_become_decimal() {
        let whole = AttributeValues::Integer(vec![3, 4].into());
        let decimal = AttributeValues::Number(vec![0.5].into());
        let a = with(bare(plate([2, 1])), "load", Domain::Face, whole);
        let b = bare(plate([1, 1]));
        let c = with(b.clone(), "load", Domain::Face, decimal);
        let joined = join(&[&a, &b, &c]).expect("same types");
        let load = joined.attribute("load", Domain::Face).expect("kept");
        let expected = AttributeValues::Number(vec![3.0, 4.0, 0.0, 0.5].into());
        assert_eq!(load.values(), &expected);
        let pair = AttributeValues::Vector2(vec![DVec2::ONE].into());
        let d = with(b, "load", Domain::Face, pair);
        let error = join(&[&a, &d]).expect_err("types differ");
        assert_eq!(
            error.to_string(),
            "attribute `load` of face elements holds integers in one mesh and 2D vectors in another"
        );
    }

    #[test]
    fn labels_of_one_name_are_one() {
        let materials = |list: Vec<Material>, of_face| Labels::new(list, of_face).expect("valid");
        let a = bare(plate([2, 1]))
            .with_materials(materials(
                vec![colored("glass", 0.1), colored("steel", 0.2)],
                vec![1, 0],
            ))
            .and_then(|mesh| {
                mesh.with_objects(Labels::new(vec!["roof".into()], vec![0, NO_LABEL])?)
            })
            .expect("valid");
        let b = bare(plate([1, 1]));
        let c = bare(plate([2, 1]))
            .with_materials(materials(
                vec![colored("steel", 0.2), colored("glass", 0.9)],
                vec![0, 1],
            ))
            .and_then(|mesh| {
                mesh.with_objects(Labels::new(vec!["wall".into(), "roof".into()], vec![0, 1])?)
            })
            .expect("valid");
        let joined = join(&[&a, &b, &c, &c]).expect("valid");
        let names = |face: usize| joined.materials().get(face).map(|m| m.name.as_str());
        let all: Vec<_> = (0..7).map(names).collect();
        let (glass, steel, other) = (Some("glass"), Some("steel"), Some("glass 2"));
        assert_eq!(all, [steel, glass, None, steel, other, steel, other]);
        assert_eq!(joined.materials().labels().len(), 3);
        let objects: Vec<_> = (0..7)
            .map(|f| joined.objects().get(f).map(String::as_str))
            .collect();
        let (roof, wall) = (Some("roof"), Some("wall"));
        assert_eq!(objects, [roof, None, None, wall, roof, wall, roof]);
    }

    #[test]
    fn parents_of_different_meshes_stay_apart() {
        let options = Options {
            levels: 1,
            ..Options::default()
        };
        let fine = subdivide(&plate([1, 1]), options, &Unmonitored)
            .expect("valid")
            .mesh;
        let joined = join(&[&fine, &fine, &plate([2, 1]), &fine]).expect("valid");
        let parents = Parents::of_mesh(&joined).expect("has parents");
        let numbers: Vec<_> = (0..parents.len())
            .map(|patch| parents.parent(patch))
            .collect();
        assert_eq!(numbers, [0, 1, 2, 3, 4]);
        let sides: Vec<_> = (0..5)
            .map(|p| parents.whole_grid(p).map(|g| g.side()))
            .collect();
        assert_eq!(sides, [Some(2), Some(2), Some(1), Some(1), Some(2)]);
    }

    proptest! {
        #[test]
        fn counts_and_area_add_up(sizes in prop::collection::vec((1usize..4, 1usize..4), 1..6)) {
            let meshes: Vec<_> = sizes.iter().map(|&(x, y)| plate([x, y])).collect();
            let list: Vec<_> = meshes.iter().collect();
            let whole = measure_mesh(&join(&list).expect("valid"));
            prop_assert_eq!(whole.components, meshes.len());
            prop_assert_eq!(whole.faces, sizes.iter().map(|(x, y)| x * y).sum::<usize>());
            prop_assert!((whole.area - meshes.len() as f64).abs() < 1e-12);
        }
    }
}
