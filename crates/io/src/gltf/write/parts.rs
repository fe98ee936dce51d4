//! Splitting a mesh into primitives with vertices as glTF has them.

use std::ops::Range;

use glam::{DVec2, DVec3};
use tessgraph_geometry::normals::{NormalWeights, newell, vertex_normals};
use tessgraph_geometry::{
    Attribute, AttributeValues, Domain, Mesh, Monitor, NO_LABEL, glam, math, parallel,
};

use super::colors::{Color, Of};
use super::{GlbNormals, y_up};
use crate::error::{FaultKind, IoError, Place};
use crate::intern::Interner;

/// What the vertices of primitives are made of.
pub(super) struct Source<'a> {
    mesh: &'a Mesh,
    origin: DVec3,
    /// One per vertex of the mesh where it looks round, else none.
    smooth: Option<Vec<DVec3>>,
    uvs: Option<&'a [DVec2]>,
    colors: &'a Of,
}

/// One primitive: all triangles of one material.
pub(super) struct Part {
    /// Label of its material, or [`NO_LABEL`].
    pub(super) material: u32,
    faces: Faces,
    vertices: Vertices,
}

/// The faces of a primitive.
enum Faces {
    /// All of so many.
    All(usize),
    /// Some of them, and how many corners come before each.
    Some { faces: Vec<u32>, starts: Vec<u32> },
}

/// The vertices of a primitive.
enum Vertices {
    /// Each corner of its faces is one, in order.
    Corners(usize),
    /// Corners share them: of each vertex a corner and its face.
    Shared(Vec<(u32, u32)>),
}

/// Primitives, and the numbers of the vertices in them.
pub(super) struct Parts {
    /// In the order in which faces name materials.
    pub(super) list: Vec<Part>,
    /// The vertex of each corner of the mesh; empty where each has its own.
    numbers: Vec<u32>,
}

impl<'a> Source<'a> {
    /// # Errors
    /// When a texture coordinate does not fit 32 bits; cancelled.
    pub(super) fn new(
        mesh: &'a Mesh,
        origin: DVec3,
        normals: GlbNormals,
        colors: &'a Of,
        monitor: &dyn Monitor,
    ) -> Result<Self, IoError> {
        let smooth = match normals {
            GlbNormals::Flat => None,
            GlbNormals::Smooth => Some(vertex_normals(mesh, NormalWeights::Angle, true, monitor)?),
        };
        let uvs = match mesh.attribute("uv", Domain::Corner).map(Attribute::values) {
            Some(AttributeValues::Vector2(uvs)) => Some(uvs.as_slice()),
            _ => None,
        };
        check_uvs(uvs.unwrap_or_default())?;
        Ok(Self {
            mesh,
            origin,
            smooth,
            uvs,
            colors,
        })
    }

    /// The primitives of the mesh.
    pub(super) fn split(&self, monitor: &dyn Monitor) -> Result<Parts, IoError> {
        let mut parts = Parts {
            list: Vec::new(),
            numbers: Vec::new(),
        };
        if self.smooth.is_some() {
            parts.numbers = vec![0; self.mesh.corner_count()];
        }
        for (material, faces) in faces_by_material(self.mesh) {
            monitor.check()?;
            let vertices = if self.smooth.is_some() {
                Vertices::Shared(self.share(&faces, &mut parts.numbers))
            } else {
                let count = |face| self.mesh.face(face).len();
                Vertices::Corners(match &faces {
                    Faces::All(_) => self.mesh.corner_count(),
                    Faces::Some { .. } => faces.between(0..faces.len()).map(count).sum(),
                })
            };
            parts.list.push(Part {
                material,
                faces,
                vertices,
            });
        }
        Ok(parts)
    }

    /// The vertices that corners of `faces` share, numbering the corners. They
    /// split where texture coordinates or face colours do.
    fn share(&self, faces: &Faces, numbers: &mut [u32]) -> Vec<(u32, u32)> {
        let mut seams = Interner::<4>::new();
        let mut vertices = Vec::new();
        for face in faces.between(0..faces.len()) {
            for corner in self.mesh.topology().corner_range(face) {
                let number = seams.number(self.seam_key(face, corner));
                if number as usize == vertices.len() {
                    vertices.push((face as u32, corner as u32));
                }
                numbers[corner] = number;
            }
        }
        vertices
    }

    /// Corners of a vertex with equal keys share a stored vertex.
    fn seam_key(&self, face: usize, corner: usize) -> [u64; 4] {
        let uv = self.uvs.map_or(DVec2::ZERO, |uvs| uvs[corner]);
        let face = match self.colors {
            Of::Faces(_) => face as u64,
            _ => 0,
        };
        let vertex = self.mesh.topology().corners()[corner];
        [vertex.into(), face, uv.x.to_bits(), uv.y.to_bits()]
    }

    pub(super) fn mesh(&self) -> &'a Mesh {
        self.mesh
    }

    pub(super) fn has_uvs(&self) -> bool {
        self.uvs.is_some()
    }

    pub(super) fn has_colors(&self) -> bool {
        !matches!(self.colors, Of::Nothing)
    }

    /// The stored position of a corner's vertex.
    #[inline]
    pub(super) fn position(&self, corner: usize) -> [f32; 3] {
        let vertex = self.mesh.topology().corners()[corner];
        stored(self.mesh.positions()[vertex as usize] - self.origin)
    }

    /// The stored normal of a vertex in the middle of a round surface, or of a face.
    #[inline]
    pub(super) fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        let normal = match &self.smooth {
            Some(normals) => normals[self.mesh.topology().corners()[corner] as usize],
            None => {
                let vertices = self.mesh.face(face).iter();
                let places = vertices.map(|&vertex| self.mesh.positions()[vertex as usize]);
                math::unit_or_zero(newell(places))
            }
        };
        // glTF wants unit normals; where there is none any will do.
        stored(if normal == DVec3::ZERO {
            DVec3::Z
        } else {
            normal
        })
    }

    /// The stored texture coordinates of a corner; v counts from the top.
    #[inline]
    pub(super) fn uv(&self, corner: usize) -> [f32; 2] {
        let uv = self.uvs.map_or(DVec2::ZERO, |uvs| uvs[corner]);
        [uv.x as f32 + 0.0, (1.0 - uv.y) as f32 + 0.0]
    }

    /// The stored colour of a corner.
    #[inline]
    pub(super) fn color(&self, face: usize, corner: usize) -> Color {
        match self.colors {
            Of::Nothing => Color::default(),
            Of::Vertices(colors) => colors[self.mesh.topology().corners()[corner] as usize],
            Of::Faces(colors) => colors[face],
        }
    }
}

/// Adding zero turns -0 into 0, so that files compare equal.
#[inline]
fn stored(p: DVec3) -> [f32; 3] {
    (y_up(p) + DVec3::ZERO).as_vec3().to_array()
}

impl Part {
    /// How many vertices there are.
    pub(super) fn vertex_count(&self) -> usize {
        match &self.vertices {
            Vertices::Corners(count) => *count,
            Vertices::Shared(vertices) => vertices.len(),
        }
    }

    /// How many triangles there are: a face of n corners gives n - 2.
    pub(super) fn triangle_count(&self, mesh: &Mesh) -> usize {
        let triangles = |face| mesh.face(face).len() - 2;
        match &self.faces {
            Faces::All(count) => mesh.corner_count() - 2 * count,
            some @ Faces::Some { .. } => some.between(0..some.len()).map(triangles).sum(),
        }
    }

    /// In how many runs its vertices come: those of a face together, or one by one.
    pub(super) fn run_count(&self) -> usize {
        match &self.vertices {
            Vertices::Corners(_) => self.faces.len(),
            Vertices::Shared(vertices) => vertices.len(),
        }
    }

    /// Calls `take` with the face and the corners of each run of vertices.
    #[inline]
    pub(super) fn for_runs(
        &self,
        mesh: &Mesh,
        runs: Range<usize>,
        mut take: impl FnMut(usize, Range<usize>),
    ) {
        match &self.vertices {
            Vertices::Corners(_) => {
                let faces = self.faces.between(runs);
                faces.for_each(|face| take(face, mesh.topology().corner_range(face)));
            }
            Vertices::Shared(vertices) => {
                for &(face, corner) in &vertices[runs] {
                    take(face as usize, corner as usize..corner as usize + 1);
                }
            }
        }
    }

    /// How many faces there are.
    pub(super) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Calls `take` with the vertices of each triangle of some of its faces.
    pub(super) fn for_triangles(
        &self,
        mesh: &Mesh,
        numbers: &[u32],
        chosen: Range<usize>,
        mut take: impl FnMut([u32; 3]),
    ) {
        let first = chosen.start;
        let faces = self.faces.between(chosen);
        let mut place = (first, self.faces.face(first));
        mesh.for_triangles(faces, |face, corners| {
            while place.1 != face {
                place = (place.0 + 1, self.faces.face(place.0 + 1));
            }
            take(match (numbers.is_empty(), &self.faces) {
                (false, _) => corners.map(|corner| numbers[corner as usize]),
                (true, Faces::All(_)) => corners,
                (true, Faces::Some { starts, .. }) => {
                    let start = mesh.topology().corner_range(face).start as u32;
                    corners.map(|corner| starts[place.0] + (corner - start))
                }
            });
        });
    }

    /// The smallest and the largest coordinates of its vertices as stored.
    pub(super) fn bounds(&self, source: &Source<'_>) -> [[f32; 3]; 2] {
        let wider = |[low, high]: [[f32; 3]; 2], [least, most]: [[f32; 3]; 2]| {
            let pick = |k: usize| (low[k].min(least[k]), high[k].max(most[k]));
            let [x, y, z] = [pick(0), pick(1), pick(2)];
            [[x.0, y.0, z.0], [x.1, y.1, z.1]]
        };
        let nothing = || [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        let fold = |mut found, run: usize| {
            self.for_runs(source.mesh, run..run + 1, |_, corners| {
                for corner in corners {
                    let place = source.position(corner);
                    found = wider(found, [place; 2]);
                }
            });
            found
        };
        parallel::reduce(self.run_count(), nothing, fold, wider)
    }
}

impl Parts {
    /// The vertex of each corner of the mesh; empty where each has its own.
    pub(super) fn numbers(&self) -> &[u32] {
        &self.numbers
    }
}

impl Faces {
    fn len(&self) -> usize {
        match self {
            Self::All(count) => *count,
            Self::Some { faces, .. } => faces.len(),
        }
    }

    #[inline]
    fn face(&self, at: usize) -> usize {
        match self {
            Self::All(_) => at,
            Self::Some { faces, .. } => faces[at] as usize,
        }
    }

    fn between(&self, range: Range<usize>) -> impl Iterator<Item = usize> + '_ {
        range.map(|at| self.face(at))
    }
}

/// The faces of each material, in the order in which faces name them.
fn faces_by_material(mesh: &Mesh) -> Vec<(u32, Faces)> {
    let (of_face, labels) = (mesh.materials().of_face(), mesh.materials().labels());
    let known = |label: u32| label.min(labels.len() as u32);
    let mut of_label = vec![usize::MAX; labels.len() + 1];
    let mut parts: Vec<(u32, Vec<u32>)> = Vec::new();
    if of_face.windows(2).all(|pair| pair[0] == pair[1]) {
        let label = of_face.first().copied().unwrap_or(NO_LABEL);
        let all = (label, Faces::All(mesh.face_count()));
        return if mesh.face_count() == 0 {
            Vec::new()
        } else {
            vec![all]
        };
    }
    for (face, &label) in of_face.iter().enumerate() {
        let slot = &mut of_label[known(label) as usize];
        if *slot == usize::MAX {
            *slot = parts.len();
            parts.push((label, Vec::new()));
        }
        parts[*slot].1.push(face as u32);
    }
    let placed = |(label, faces): (u32, Vec<u32>)| {
        let corners = |&face: &u32| mesh.face(face as usize).len() as u32;
        let before = faces.iter().scan(0, |sum, face| {
            let start = *sum;
            *sum += corners(face);
            Some(start)
        });
        let starts = before.collect();
        (label, Faces::Some { faces, starts })
    };
    parts.into_iter().map(placed).collect()
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
