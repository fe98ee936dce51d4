//! Splitting a mesh into primitives with vertices as glTF has them.

use glam::{DVec2, DVec3};
use tessgraph_geometry::normals::{NormalWeights, face_normals, vertex_normals};
use tessgraph_geometry::{Attribute, AttributeValues, Domain, Mesh, Monitor, NO_LABEL, glam};

use super::colors::{Color, Colors, Of};
use super::{GlbNormals, y_up};
use crate::error::{FaultKind, IoError, Place};
use crate::intern::Interner;

/// One primitive: all triangles of one material.
pub(super) struct Part {
    /// Label of its material, or [`NO_LABEL`].
    pub(super) material: u32,
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    /// Empty if the mesh has none.
    pub(super) uvs: Vec<[f32; 2]>,
    /// Empty if there are none.
    pub(super) colors: Vec<Color>,
    pub(super) indices: Vec<u32>,
}

/// What a stored vertex is made of.
struct Source<'a> {
    mesh: &'a Mesh,
    origin: DVec3,
    normals: Vec<DVec3>,
    uvs: Option<&'a [DVec2]>,
    colors: &'a Of,
    flat: bool,
}

/// The primitives of `mesh`, in the order in which faces name materials.
///
/// # Errors
/// When a texture coordinate does not fit 32 bits; cancelled.
pub(super) fn split(
    mesh: &Mesh,
    origin: DVec3,
    normals: GlbNormals,
    colors: &Colors,
    monitor: &dyn Monitor,
) -> Result<Vec<Part>, IoError> {
    let flat = normals == GlbNormals::Flat;
    let normals = match normals {
        GlbNormals::Flat => face_normals(mesh, monitor)?,
        GlbNormals::Smooth => vertex_normals(mesh, NormalWeights::Angle, true, monitor)?,
    };
    let uvs = match mesh.attribute("uv", Domain::Corner).map(Attribute::values) {
        Some(AttributeValues::Vector2(uvs)) => Some(uvs.as_slice()),
        _ => None,
    };
    check_uvs(uvs.unwrap_or_default())?;
    let source = Source {
        mesh,
        origin,
        normals,
        uvs,
        colors: &colors.of,
        flat,
    };
    let triangles = mesh.triangles();
    let mut parts: Vec<(u32, Vec<u32>)> = Vec::new();
    let labels = mesh.materials();
    let mut of_label = vec![usize::MAX; labels.labels().len() + 1];
    for (triangle, &face) in triangles.faces.iter().enumerate() {
        let label = labels
            .of_face()
            .get(face as usize)
            .copied()
            .unwrap_or(NO_LABEL);
        let slot = (label as usize).min(labels.labels().len());
        if of_label[slot] == usize::MAX {
            of_label[slot] = parts.len();
            parts.push((label, Vec::new()));
        }
        parts[of_label[slot]].1.push(triangle as u32);
    }
    let mut remap = vec![
        u32::MAX;
        if flat {
            mesh.corner_count()
        } else {
            mesh.vertex_count()
        }
    ];
    parts
        .into_iter()
        .map(|(material, chosen)| {
            monitor.check()?;
            let corners = 3 * chosen.len();
            let triangles = chosen.iter().map(|&triangle| {
                let triangle = triangle as usize;
                (triangles.faces[triangle], triangles.corners[triangle])
            });
            Ok(source.part(material, triangles, corners, &mut remap))
        })
        .collect()
}

fn check_uvs(uvs: &[DVec2]) -> Result<(), IoError> {
    match uvs
        .iter()
        .position(|uv| uv.abs().max_element() > f64::from(f32::MAX))
    {
        None => Ok(()),
        Some(corner) => {
            let cause = format!("the uv of corner {corner} is beyond the reach of 32-bit numbers");
            Err(IoError::new(
                FaultKind::NotFinite,
                Place::File,
                cause,
                "correct or remove the uv",
            ))
        }
    }
}

impl Source<'_> {
    fn part(
        &self,
        material: u32,
        triangles: impl Iterator<Item = (u32, [u32; 3])>,
        corners: usize,
        remap: &mut [u32],
    ) -> Part {
        // At most so many; what is not used is never touched.
        let most = if self.flat || self.uvs.is_some() {
            corners
        } else {
            corners.min(remap.len())
        };
        let has_colors = !matches!(self.colors, Of::Nothing);
        let mut part = Part {
            material,
            positions: Vec::with_capacity(most),
            normals: Vec::with_capacity(most),
            uvs: Vec::with_capacity(if self.uvs.is_some() { most } else { 0 }),
            colors: Vec::with_capacity(if has_colors { most } else { 0 }),
            indices: Vec::with_capacity(corners),
        };
        // Smooth vertices split where texture coordinates or face colours do.
        let splits = !self.flat && (self.uvs.is_some() || matches!(self.colors, Of::Faces(_)));
        let mut seams = Interner::<4>::new();
        let mut touched = Vec::new();
        for (face, corners) in triangles {
            for corner in corners {
                let vertex = self.mesh.topology().corners()[corner as usize];
                let count = part.positions.len() as u32;
                let index = if splits {
                    seams.number(self.seam_key(vertex, face, corner))
                } else {
                    let slot = if self.flat { corner } else { vertex };
                    let known = &mut remap[slot as usize];
                    if *known == u32::MAX {
                        *known = count;
                        touched.push(slot);
                    }
                    *known
                };
                if index == count {
                    self.add_vertex(&mut part, vertex, face, corner);
                }
                part.indices.push(index);
            }
        }
        touched
            .into_iter()
            .for_each(|slot| remap[slot as usize] = u32::MAX);
        part
    }

    /// Corners of a vertex with equal keys share a stored vertex.
    fn seam_key(&self, vertex: u32, face: u32, corner: u32) -> [u64; 4] {
        let uv = self.uvs.map_or(DVec2::ZERO, |uvs| uvs[corner as usize]);
        let face = if matches!(self.colors, Of::Faces(_)) {
            face
        } else {
            0
        };
        [vertex.into(), face.into(), uv.x.to_bits(), uv.y.to_bits()]
    }

    fn add_vertex(&self, part: &mut Part, vertex: u32, face: u32, corner: u32) {
        // Adding zero turns -0 into 0, so that files compare equal.
        let stored = |p: DVec3| (y_up(p) + DVec3::ZERO).as_vec3().to_array();
        let place = self.mesh.positions()[vertex as usize] - self.origin;
        part.positions.push(stored(place));
        let normal = self.normals[if self.flat { face } else { vertex } as usize];
        // glTF wants unit normals; where there is none any will do.
        part.normals.push(stored(if normal == DVec3::ZERO {
            DVec3::Z
        } else {
            normal
        }));
        if let Some(uvs) = self.uvs {
            let uv = uvs[corner as usize];
            part.uvs
                .push([uv.x as f32 + 0.0, (1.0 - uv.y) as f32 + 0.0]);
        }
        match self.colors {
            Of::Nothing => {}
            Of::Vertices(colors) => part.colors.push(colors[vertex as usize]),
            Of::Faces(colors) => part.colors.push(colors[face as usize]),
        }
    }
}
