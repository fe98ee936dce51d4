//! Positions and triangles of one primitive.

use glam::{DAffine3, DMat3, DVec3};
use gltf::json::accessor::ComponentType;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use tessgraph_geometry::glam;
use tessgraph_geometry::math::unit_or_zero;

use super::accessor::{Accessors, Layout};
use super::assemble::Assembly;
use super::scene::Instance;
use super::{EXPORT, fault};
use crate::error::{FaultKind, IoError};

/// The corners a primitive added.
pub(super) struct Corners {
    /// The primitive's own vertex at each of its corners.
    pub(super) vertices: Vec<u32>,
    /// Corners of the mesh before them.
    pub(super) first_corner: usize,
    /// Vertices of the primitive.
    pub(super) vertex_count: usize,
}

/// z up out of y up.
fn z_up(p: DVec3) -> DVec3 {
    DVec3::new(p.x, -p.z, p.y)
}

impl Corners {
    /// The primitive's normals in the scene, unit or zero, z up.
    pub(super) fn turn_normals(&self, normals: &[[f64; 3]], transform: &DAffine3) -> Vec<DVec3> {
        let [x, y, z] = transform.matrix3.to_cols_array_2d().map(DVec3::from);
        // The cofactor matrix turns normals even where there is no inverse;
        // mirroring turns them round, as it does the winding.
        let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        let sign = if x.cross(y).dot(z) < 0.0 { -1.0 } else { 1.0 };
        let turn = |&normal: &[f64; 3]| {
            // Adding zero turns -0 into 0.
            unit_or_zero(z_up(cofactors * DVec3::from(normal)) * sign) + DVec3::ZERO
        };
        normals.iter().map(turn).collect()
    }
}

/// Adds the vertices and triangles of `primitive`. `None` if it has no
/// positions.
pub(super) fn read_primitive(
    primitive: &Primitive,
    instance: &Instance,
    accessors: &mut Accessors<'_, '_>,
    assembly: &mut Assembly,
    pointer: &str,
) -> Result<Option<Corners>, IoError> {
    let Some(accessor) = primitive
        .attributes
        .get(&Checked::Valid(Semantic::Positions))
    else {
        assembly.note(
            "primitive(s) have no positions and were passed over",
            pointer,
        );
        return Ok(None);
    };
    let Checked::Valid(mode) = primitive.mode else {
        let pointer = format!("{pointer}/mode");
        return Err(fault(
            FaultKind::Syntax,
            &pointer,
            "this primitive mode does not exist",
            EXPORT,
        ));
    };
    let at = format!("{pointer}/attributes/POSITION");
    let first = assembly.positions.len();
    let vertex_count = add_positions(
        primitive,
        accessor.value(),
        instance,
        accessors,
        assembly,
        &at,
    )?;
    let indices = match primitive.indices {
        Some(index) => {
            accessors.indices(index.value(), vertex_count, &format!("{pointer}/indices"))?
        }
        None => (0..vertex_count as u32).collect(),
    };
    accessors.budget.take(16 * indices.len() as u64, pointer)?;
    let mirrored = instance.scene_from_mesh.matrix3.determinant() < 0.0;
    let vertices = triangles(mode, &indices, mirrored, assembly, pointer);
    let first_corner = assembly.corners.len();
    assembly
        .corners
        .extend(vertices.iter().map(|&vertex| first as u32 + vertex));
    Ok(Some(Corners {
        vertices,
        first_corner,
        vertex_count,
    }))
}

/// Adds the positions of `primitive` as they are in the scene; how many.
fn add_positions(
    primitive: &Primitive,
    accessor: usize,
    instance: &Instance,
    accessors: &mut Accessors<'_, '_>,
    assembly: &mut Assembly,
    at: &str,
) -> Result<usize, IoError> {
    let layout = accessors.layout(accessor, at)?;
    check_positions(layout, accessors, at)?;
    let extensions = primitive.extensions.as_ref();
    let draco = "KHR_draco_mesh_compression";
    let compressed = extensions.is_some_and(|extensions| extensions.others.contains_key(draco));
    let places = accessors
        .numbers::<3>(accessor, at)
        .map_err(|error| match error {
            IoError::Fault(mut fault) if compressed => {
                fault.cause = format!("the data is compressed with {draco}, which is not read");
                IoError::Fault(fault)
            }
            error => error,
        })?;
    accessors.budget.take(24 * places.len() as u64, at)?;
    if assembly.positions.len() + places.len() > u32::MAX as usize - 1 {
        let cause = "there are more than 4294967294 vertices";
        return Err(fault(FaultKind::TooLarge, at, cause, "split the file"));
    }
    let scene_from_mesh = &instance.scene_from_mesh;
    for (vertex, &place) in places.iter().enumerate() {
        let place = z_up(scene_from_mesh.transform_point3(DVec3::from(place)));
        if !place.is_finite() {
            let cause =
                format!("vertex {vertex} is not finite once its node's transform is applied");
            return Err(fault(FaultKind::NotFinite, at, cause, EXPORT));
        }
        assembly.positions.push(place);
    }
    Ok(places.len())
}

/// Positions are three floats; with KHR_mesh_quantization also small integers.
fn check_positions(layout: Layout, accessors: &Accessors<'_, '_>, at: &str) -> Result<(), IoError> {
    let quantized = matches!(
        layout.component,
        ComponentType::I8 | ComponentType::U8 | ComponentType::I16 | ComponentType::U16
    );
    let fits = layout.component == ComponentType::F32 || (quantized && accessors.quantized());
    if layout.width == 3 && fits {
        return Ok(());
    }
    let cause = "positions are VEC3 of 32-bit floats; other types need KHR_mesh_quantization";
    Err(fault(FaultKind::Syntax, at, cause, EXPORT))
}

/// The corners of the triangles that `indices` stand for, three for each.
fn triangles(
    mode: Mode,
    indices: &[u32],
    mirrored: bool,
    assembly: &mut Assembly,
    pointer: &str,
) -> Vec<u32> {
    let mut corners = Vec::new();
    // Mirroring turns a face inside out; its first corner stays.
    let mut add =
        |a: u32, b: u32, c: u32| corners.extend(if mirrored { [a, c, b] } else { [a, b, c] });
    match mode {
        Mode::Triangles => {
            for triangle in indices.chunks_exact(3) {
                add(triangle[0], triangle[1], triangle[2]);
            }
            if !indices.len().is_multiple_of(3) {
                assembly.note(
                    "triangle list(s) end within a triangle, which was dropped",
                    pointer,
                );
            }
        }
        Mode::TriangleStrip => {
            for (k, three) in indices.windows(3).enumerate() {
                let (b, c) = if k % 2 == 0 { (1, 2) } else { (2, 1) };
                add(three[0], three[b], three[c]);
            }
        }
        Mode::TriangleFan => {
            for pair in indices.get(1..).unwrap_or_default().windows(2) {
                add(indices[0], pair[0], pair[1]);
            }
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => {
            assembly.note(
                "primitive(s) are points or lines: their vertices have no faces",
                pointer,
            );
        }
    }
    corners
}
