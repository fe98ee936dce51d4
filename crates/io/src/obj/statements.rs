//! What the statements of an OBJ file say, part by part.

use glam::{DVec2, DVec3};
use tessgraph_geometry::glam;

use super::tags::Tags;
use crate::labels::Runs;
use crate::warnings::Counted;

/// Marks a corner without a texture coordinate or normal.
pub(super) const NONE: u32 = u32::MAX;

/// What was passed over, for one warning each.
#[derive(Debug, Default)]
pub(super) struct PassedOver {
    pub(super) lines_and_points: Counted,
    pub(super) free_form: Counted,
    pub(super) commands: Counted,
    pub(super) unknown: Counted,
    pub(super) extra_numbers: Counted,
    pub(super) bad_colors: Counted,
    pub(super) bad_normals: Counted,
    pub(super) bad_tags: Counted,
    pub(super) other_tags: Counted,
}

impl PassedOver {
    fn append(&mut self, part: &Self) {
        self.lines_and_points.append(part.lines_and_points);
        self.free_form.append(part.free_form);
        self.commands.append(part.commands);
        self.unknown.append(part.unknown);
        self.extra_numbers.append(part.extra_numbers);
        self.bad_colors.append(part.bad_colors);
        self.bad_normals.append(part.bad_normals);
        self.bad_tags.append(part.bad_tags);
        self.other_tags.append(part.other_tags);
    }
}

/// What statements have said, in the order of the file.
#[derive(Default)]
pub(super) struct Statements<'a> {
    pub(super) positions: Vec<DVec3>,
    /// One per vertex, or shorter where the last have none.
    pub(super) colors: Vec<DVec3>,
    pub(super) uvs: Vec<DVec2>,
    pub(super) normals: Vec<DVec3>,
    /// Where the corners of each face end.
    pub(super) ends: Vec<u32>,
    pub(super) corners: Vec<u32>,
    /// Texture coordinate of each corner; shorter where the last have none.
    pub(super) corner_uvs: Vec<u32>,
    /// Normal of each corner; shorter where the last have none.
    pub(super) corner_normals: Vec<u32>,
    pub(super) groups: Runs<&'a [u8]>,
    pub(super) objects: Runs<&'a [u8]>,
    pub(super) materials: Runs<&'a [u8]>,
    /// Names of material libraries, each with its place.
    pub(super) libraries: Vec<(&'a [u8], usize)>,
    pub(super) tags: Tags,
    pub(super) passed_over: PassedOver,
    /// Statements that OBJ knows.
    pub(super) known: usize,
    /// One more than the highest vertex a face names.
    pub(super) highest: usize,
}

impl<'a> Statements<'a> {
    /// Nothing, but with the memory there was.
    pub(super) fn clear(&mut self) {
        self.positions.clear();
        self.colors.clear();
        self.uvs.clear();
        self.normals.clear();
        self.ends.clear();
        self.corners.clear();
        self.corner_uvs.clear();
        self.corner_normals.clear();
        self.libraries.clear();
        self.groups = Runs::default();
        self.objects = Runs::default();
        self.materials = Runs::default();
        self.tags = Tags::default();
        self.passed_over = PassedOver::default();
        (self.known, self.highest) = (0, 0);
    }

    /// Adds what the part of the file behind this one says.
    pub(super) fn append(&mut self, part: &Self) {
        let (face, corner) = (self.ends.len(), self.corners.len());
        if !part.colors.is_empty() {
            self.colors.resize(self.positions.len(), DVec3::ONE);
            self.colors.extend_from_slice(&part.colors);
        }
        self.positions.extend_from_slice(&part.positions);
        self.uvs.extend_from_slice(&part.uvs);
        self.normals.extend_from_slice(&part.normals);
        let ends = part.ends.iter().map(|&end| end + corner as u32);
        self.ends.extend(ends);
        self.corners.extend_from_slice(&part.corners);
        let values = [
            (&mut self.corner_uvs, &part.corner_uvs),
            (&mut self.corner_normals, &part.corner_normals),
        ];
        for (values, of_part) in values {
            if !of_part.is_empty() {
                values.resize(corner, NONE);
                values.extend_from_slice(of_part);
            }
        }
        self.groups.append(face, &part.groups);
        self.objects.append(face, &part.objects);
        self.materials.append(face, &part.materials);
        self.libraries.extend_from_slice(&part.libraries);
        self.tags.append(&part.tags);
        self.passed_over.append(&part.passed_over);
        self.known += part.known;
        self.highest = self.highest.max(part.highest);
    }
}

/// How much there is of what faces count.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) vertices: usize,
    pub(super) uvs: usize,
    pub(super) normals: usize,
    pub(super) corners: usize,
}

impl Counts {
    /// With what `statements` add.
    pub(super) fn with(self, statements: &Statements<'_>) -> Self {
        Self {
            vertices: self.vertices + statements.positions.len(),
            uvs: self.uvs + statements.uvs.len(),
            normals: self.normals + statements.normals.len(),
            corners: self.corners + statements.corners.len(),
        }
    }
}
