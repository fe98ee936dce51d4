//! Joining the mesh instances of a scene into one mesh.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use serde::Deserialize;
use tessgraph_geometry::{
    Attribute, AttributeValues, Domain, Labels, Material, Mesh, Monitor, Topology, glam,
};

use super::accessor::Accessors;
use super::document::Document;
use super::geometry::{Corners, read_primitive};
use super::scene::Instance;
use super::{EXPORT, fault};
use crate::error::{FaultKind, IoError};
use crate::labels::Runs;

/// The parts of a material that are read. `f64`, so that 0.8 stays 0.8.
#[derive(Deserialize, Default)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct RawMaterial {
    name: Option<String>,
    pbr_metallic_roughness: RawPbr,
}

#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct RawPbr {
    base_color_factor: [f64; 4],
    metallic_factor: f64,
    roughness_factor: f64,
}

impl Default for RawPbr {
    /// glTF's defaults: white, rough metal.
    fn default() -> Self {
        Self {
            base_color_factor: [1.0; 4],
            metallic_factor: 1.0,
            roughness_factor: 1.0,
        }
    }
}

/// The most texture coordinate sets that are read.
const UV_SETS: u32 = 8;

/// The mesh as far as it has been put together.
#[derive(Default)]
pub(super) struct Assembly {
    pub(super) positions: Vec<DVec3>,
    pub(super) corners: Vec<u32>,
    /// One per vertex; shorter where the last have none.
    colors: Vec<DVec3>,
    /// One per corner; shorter where the last have none.
    normals: Vec<DVec3>,
    /// By set; one per corner; shorter where the last have none.
    uvs: BTreeMap<u32, Vec<DVec2>>,
    materials: Runs<Option<usize>>,
    objects: Runs<Option<String>>,
    notes: BTreeMap<&'static str, (usize, String)>,
}

impl Assembly {
    /// Counts something worth a warning.
    pub(super) fn note(&mut self, what: &'static str, pointer: &str) {
        let entry = self
            .notes
            .entry(what)
            .or_insert_with(|| (0, pointer.to_owned()));
        entry.0 += 1;
    }
}

/// Joins `instances` in order.
///
/// # Errors
/// When data is missing, out of range or not finite, or the memory limit would
/// be passed.
pub(super) fn assemble(
    document: &Document<'_>,
    mut accessors: Accessors<'_, '_>,
    instances: &[Instance],
    monitor: &dyn Monitor,
    warnings: &mut Vec<String>,
) -> Result<Mesh, IoError> {
    let mut assembly = Assembly::default();
    for (done, instance) in instances.iter().enumerate() {
        monitor.progress(done as u64, instances.len() as u64);
        let mesh = document
            .meshes
            .get(instance.mesh, &format!("{}/mesh", instance.pointer))?;
        let pointer = document.meshes.pointer(instance.mesh);
        let face = assembly.corners.len() / 3;
        let name = instance.name.clone().or_else(|| mesh.name.clone());
        assembly
            .objects
            .start(face, name.filter(|name| !name.is_empty()));
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            monitor.check()?;
            let pointer = format!("{pointer}/primitives/{index}");
            // Whatever it holds, a primitive costs time.
            accessors.budget.take(1024, &pointer)?;
            let face = assembly.corners.len() / 3;
            let material = primitive.material.map(|material| material.value());
            assembly.materials.start(face, material);
            let from = assembly.positions.len();
            let corners =
                read_primitive(primitive, instance, &mut accessors, &mut assembly, &pointer)?;
            if let Some(corners) = corners {
                attributes(
                    primitive,
                    instance,
                    &mut accessors,
                    &mut assembly,
                    &corners,
                    from,
                    &pointer,
                )?;
            }
        }
    }
    if assembly.positions.is_empty() {
        let cause = "the meshes of the default scene have no vertices";
        return Err(fault(FaultKind::Empty, "/meshes", cause, EXPORT));
    }
    finish(document, assembly, warnings)
}

/// Adds the attributes of a primitive whose corners were just added.
fn attributes(
    primitive: &Primitive,
    instance: &Instance,
    accessors: &mut Accessors<'_, '_>,
    assembly: &mut Assembly,
    corners: &Corners,
    first_vertex: usize,
    pointer: &str,
) -> Result<(), IoError> {
    for (semantic, accessor) in &primitive.attributes {
        let Checked::Valid(semantic) = semantic else {
            continue;
        };
        let pointer = format!("{pointer}/attributes/{}", semantic.to_string());
        let expect = |accessors: &Accessors<'_, '_>, widths: &[usize]| {
            let layout = accessors.layout(accessor.value(), &pointer)?;
            if layout.count == corners.vertex_count && widths.contains(&layout.width) {
                return Ok(());
            }
            let cause = format!(
                "{} elements of {} components do not fit {} vertices",
                layout.count, layout.width, corners.vertex_count
            );
            Err(fault(FaultKind::OutOfRange, &pointer, cause, EXPORT))
        };
        let before = corners.first_corner;
        match semantic {
            Semantic::TexCoords(set) if *set < UV_SETS => {
                expect(accessors, &[2])?;
                accessors
                    .budget
                    .take(16 * (before + corners.vertices.len()) as u64, &pointer)?;
                let uvs = accessors.numbers::<2>(accessor.value(), &pointer)?;
                let out = assembly.uvs.entry(*set).or_default();
                out.resize(before, DVec2::ZERO);
                // glTF counts v from the top of the image, all else from below.
                let uv = |&vertex: &u32| {
                    let [u, v] = uvs[vertex as usize];
                    DVec2::new(u, 1.0 - v)
                };
                out.extend(corners.vertices.iter().map(uv));
            }
            Semantic::Normals => {
                expect(accessors, &[3])?;
                let normals = accessors.numbers::<3>(accessor.value(), &pointer)?;
                let turned = corners.turn_normals(&normals, &instance.scene_from_mesh);
                assembly.normals.resize(before, DVec3::ZERO);
                assembly
                    .normals
                    .extend(corners.vertices.iter().map(|&v| turned[v as usize]));
            }
            Semantic::Colors(0) => {
                expect(accessors, &[3, 4])?;
                let colors = accessors.numbers::<3>(accessor.value(), &pointer)?;
                assembly.colors.resize(first_vertex, DVec3::ONE);
                assembly.colors.extend(colors.into_iter().map(DVec3::from));
            }
            _ => {}
        }
    }
    if primitive.targets.is_some() {
        assembly.note(
            "primitive(s) have morph targets, which are not applied",
            pointer,
        );
    }
    Ok(())
}

/// Makes the mesh of what was collected.
fn finish(
    document: &Document<'_>,
    mut assembly: Assembly,
    warnings: &mut Vec<String>,
) -> Result<Mesh, IoError> {
    let (vertices, corners) = (assembly.positions.len(), assembly.corners.len());
    let topology = Topology::uniform(vertices, 3, std::mem::take(&mut assembly.corners))?;
    let mut mesh = Mesh::new(std::mem::take(&mut assembly.positions), Arc::new(topology))?;
    for (set, mut uvs) in std::mem::take(&mut assembly.uvs) {
        uvs.resize(corners, DVec2::ZERO);
        let name = if set == 0 {
            "uv".to_owned()
        } else {
            format!("uv{set}")
        };
        let values = AttributeValues::Vector2(uvs.into());
        mesh = mesh.with_attribute(Attribute::new(name, Domain::Corner, values))?;
    }
    if !assembly.normals.is_empty() {
        assembly.normals.resize(corners, DVec3::ZERO);
        let values = AttributeValues::Vector3(assembly.normals.into());
        mesh = mesh.with_attribute(Attribute::new("normal", Domain::Corner, values))?;
    }
    if !assembly.colors.is_empty() {
        assembly.colors.resize(vertices, DVec3::ONE);
        let values = AttributeValues::Vector3(assembly.colors.into());
        mesh = mesh.with_attribute(Attribute::new("color", Domain::Vertex, values))?;
    }
    let faces = mesh.face_count();
    mesh = mesh.with_objects(assembly.objects.finish(faces, Clone::clone)?)?;
    let labels = assembly.materials.finish(faces, |material| *material)?;
    let materials: Result<_, IoError> = labels
        .labels()
        .iter()
        .map(|&index| material(document, index))
        .collect();
    mesh = mesh.with_materials(Labels::new(materials?, labels.of_face().to_vec())?)?;
    for (what, (count, first)) in assembly.notes {
        warnings.push(format!("{count} {what}, first {first}"));
    }
    if mesh.face_count() == 0 {
        warnings.push("the file has no faces".to_owned());
    }
    Ok(mesh)
}

fn material(document: &Document<'_>, index: usize) -> Result<Material, IoError> {
    let raw = document.materials.get(index, "/meshes")?;
    let pbr = &raw.pbr_metallic_roughness;
    let unit = |value: f64| value.clamp(0.0, 1.0);
    Ok(Material {
        name: raw
            .name
            .clone()
            .unwrap_or_else(|| format!("material_{index}")),
        base_color: pbr.base_color_factor.map(unit),
        metallic: unit(pbr.metallic_factor),
        roughness: unit(pbr.roughness_factor),
    })
}
