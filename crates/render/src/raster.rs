//! Which face is seen at each place of a picture.
//!
//! The picture is cut into bands of rows. Each triangle is listed at the bands it
//! may touch, and each band is drawn by itself, in the order of triangles: so
//! threads share nothing, and their number makes no difference.

use rayon::prelude::*;
use tessgraph_geometry::glam::{DVec2, DVec3};
use tessgraph_geometry::normals::face_normals;
use tessgraph_geometry::{GeometryError, Mesh, Monitor, Triangles, parallel};

use crate::light;
use crate::paint::Colors;
use crate::view::Frame;

/// Places looked at in each pixel, each way.
const SAMPLES: usize = 3;

/// Rows of pixels in a band.
const BAND: usize = 8;

/// Half the width of a line in pixels; each of two faces draws half of it.
const HALF_LINE: f64 = 0.6;

/// The light that a line takes away.
const LINE: f32 = 0.82;

/// No triangle.
const NONE: u32 = u32::MAX;

/// What is seen in each pixel, row by row from the top.
pub(crate) struct Drawn {
    /// Linear red, green and blue of the covered part, times that part; and it.
    pub(crate) light: Vec<[f32; 4]>,
    /// How near it is to the eye in pixels; negative infinity where nothing is.
    pub(crate) depth: Vec<f32>,
}

/// A mesh as it is drawn.
struct Scene<'a> {
    mesh: &'a Mesh,
    triangles: Triangles,
    vertices: Vec<[u32; 3]>,
    /// Each vertex in the picture.
    places: Vec<DVec3>,
    /// How brightly each face is lit.
    lit: Vec<f32>,
    colors: &'a Colors<'a>,
    edges: bool,
}

/// Draws everything.
pub(crate) fn draw(
    mesh: &Mesh,
    frame: &Frame,
    colors: &Colors<'_>,
    edges: bool,
    monitor: &dyn Monitor,
) -> Result<Drawn, GeometryError> {
    let triangles = mesh.triangles_with(monitor)?;
    let normals = face_normals(mesh, monitor)?;
    let scene = Scene {
        mesh,
        vertices: mesh.triangle_vertices(&triangles),
        triangles,
        places: parallel::map(mesh.vertex_count(), monitor, |v| {
            frame.project(mesh.positions()[v])
        })?,
        lit: normals
            .iter()
            .map(|&normal| light::lit(normal, frame))
            .collect(),
        colors,
        edges,
    };
    let [width, height] = frame.size.map(|side| side as usize);
    let listed = scene.listed(height.div_ceil(BAND));
    let mut drawn = Drawn {
        light: vec![[0.0; 4]; width * height],
        depth: vec![f32::NEG_INFINITY; width * height],
    };
    let light = drawn.light.par_chunks_mut(BAND * width);
    let bands = light.zip(drawn.depth.par_chunks_mut(BAND * width));
    bands.enumerate().try_for_each(|(band, (light, depth))| {
        monitor.check()?;
        let mut samples = Samples::new(width, light.len() / width, band * BAND);
        for &triangle in listed.of(band) {
            samples.add(&scene, triangle);
        }
        samples.develop(&scene, light, depth);
        Ok::<_, GeometryError>(())
    })?;
    Ok(drawn)
}

/// The triangles of each band, in ascending order.
struct Listed {
    starts: Vec<usize>,
    triangles: Vec<u32>,
}

impl Listed {
    fn of(&self, band: usize) -> &[u32] {
        &self.triangles[self.starts[band]..self.starts[band + 1]]
    }
}

impl Scene<'_> {
    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.vertices[triangle as usize].map(|vertex| self.places[vertex as usize])
    }

    fn listed(&self, bands: usize) -> Listed {
        let range = |triangle: usize| {
            let heights = self
                .corners(triangle as u32)
                .map(|corner| corner.y / BAND as f64);
            let low = heights[0].min(heights[1]).min(heights[2]).max(0.0);
            let high = heights[0].max(heights[1]).max(heights[2]);
            // Beyond the picture there are no bands; casts saturate.
            low as usize..((high.floor() + 1.0).max(0.0) as usize).min(bands)
        };
        let mut starts = vec![0; bands + 1];
        for triangle in 0..self.vertices.len() {
            range(triangle).for_each(|band| starts[band + 1] += 1);
        }
        for band in 0..bands {
            starts[band + 1] += starts[band];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; starts[bands]];
        for triangle in 0..self.vertices.len() {
            for band in range(triangle) {
                triangles[next[band]] = triangle as u32;
                next[band] += 1;
            }
        }
        Listed { starts, triangles }
    }

    /// Which sides of a triangle are edges of its polygon: from corner k to the
    /// next. The others are where the polygon was cut.
    fn sides(&self, triangle: u32) -> [bool; 3] {
        if !self.edges {
            return [false; 3];
        }
        let face = self.triangles.faces[triangle as usize] as usize;
        let range = self.mesh.topology().corner_range(face);
        let corners = self.triangles.corners[triangle as usize];
        [0, 1, 2].map(|k| {
            let (from, to) = (corners[k] as usize, corners[(k + 1) % 3] as usize);
            let after = if from + 1 == range.end {
                range.start
            } else {
                from + 1
            };
            let before = if to + 1 == range.end {
                range.start
            } else {
                to + 1
            };
            to == after || from == before
        })
    }
}

/// A triangle in the picture.
struct Flat {
    corners: [DVec3; 3],
    /// Twice its area, with sign.
    area: f64,
    /// Distance of each corner from the side opposite.
    heights: [f64; 3],
}

impl Flat {
    /// `None` for one seen from its edge.
    fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(DVec3::truncate);
        let area = (b - a).perp_dot(c - a);
        let lengths = [c - b, a - c, b - a].map(DVec2::length);
        let heights = lengths.map(|length| area.abs() / length);
        let sound = area != 0.0 && heights.iter().all(|height| height.is_finite());
        sound.then_some(Self {
            corners,
            area,
            heights,
        })
    }

    fn weights(&self, at: DVec2) -> [f64; 3] {
        let [a, b, c] = self.corners.map(DVec3::truncate);
        let first = (b - at).perp_dot(c - at) / self.area;
        let second = (c - at).perp_dot(a - at) / self.area;
        [first, second, 1.0 - first - second]
    }

    /// How strongly its sides are drawn: not at all if it is a pixel or two wide,
    /// or nothing but lines would be seen.
    fn strength(&self) -> f32 {
        let size = (self.area.abs() / 2.0).sqrt();
        ((size - 1.5) / 5.0).clamp(0.0, 1.0) as f32
    }
}

/// The places looked at in a band.
struct Samples {
    /// How many there are in a row, and of rows.
    width: usize,
    rows: usize,
    /// The row of pixels it begins at.
    top: usize,
    depth: Vec<f32>,
    triangle: Vec<u32>,
    /// What lines leave of the light.
    left: Vec<f32>,
}

impl Samples {
    fn new(width: usize, rows: usize, top: usize) -> Self {
        let (width, rows) = (width * SAMPLES, rows * SAMPLES);
        Self {
            width,
            rows,
            top,
            depth: vec![f32::NEG_INFINITY; width * rows],
            triangle: vec![NONE; width * rows],
            left: vec![1.0; width * rows],
        }
    }

    /// The middle of a sample in the picture.
    fn place(&self, row: usize, column: usize) -> DVec2 {
        let along = |index: usize| (index as f64 + 0.5) / SAMPLES as f64;
        DVec2::new(along(column), along(row) + self.top as f64)
    }

    /// The samples between two places along an axis, of `count`.
    fn span(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
        let first = (low * SAMPLES as f64 - 0.5).ceil().max(0.0) as usize;
        let end = ((high * SAMPLES as f64 - 0.5).floor() + 1.0).max(0.0) as usize;
        first..end.min(count)
    }

    fn add(&mut self, scene: &Scene<'_>, triangle: u32) {
        let Some(flat) = Flat::new(scene.corners(triangle)) else {
            return;
        };
        let sides = scene.sides(triangle);
        let strength = flat.strength();
        let [a, b, c] = flat.corners;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let top = self.top as f64;
        let columns = Self::span(low.x, high.x, self.width);
        for row in Self::span(low.y - top, high.y - top, self.rows) {
            for column in columns.clone() {
                let weights = flat.weights(self.place(row, column));
                if weights.iter().any(|&weight| weight < 0.0) {
                    continue;
                }
                let depth = (a.z * weights[0] + b.z * weights[1] + c.z * weights[2]) as f32;
                let at = row * self.width + column;
                if depth > self.depth[at] {
                    // The side from corner k is opposite the corner before it.
                    let on_line = (0..3).any(|k| {
                        let opposite = (k + 2) % 3;
                        sides[k] && weights[opposite] * flat.heights[opposite] < HALF_LINE
                    });
                    self.depth[at] = depth;
                    self.triangle[at] = triangle;
                    self.left[at] = if on_line { 1.0 - LINE * strength } else { 1.0 };
                }
            }
        }
    }

    /// The colour of a sample in linear light; `None` where nothing is seen.
    fn color(&self, scene: &Scene<'_>, row: usize, column: usize) -> Option<[f32; 3]> {
        let at = row * self.width + column;
        let triangle = self.triangle[at];
        if triangle == NONE {
            return None;
        }
        let face = scene.triangles.faces[triangle as usize];
        let weights = match Flat::new(scene.corners(triangle)) {
            Some(flat) if scene.colors.vary() => flat.weights(self.place(row, column)),
            _ => [1.0, 0.0, 0.0],
        };
        let color = scene
            .colors
            .at(face, scene.vertices[triangle as usize], weights);
        let light = scene.lit[face as usize] * self.left[at];
        Some(color.to_array().map(|part| part as f32 * light))
    }

    fn develop(&self, scene: &Scene<'_>, light: &mut [[f32; 4]], depth: &mut [f32]) {
        const SHARE: f32 = 1.0 / (SAMPLES * SAMPLES) as f32;
        let pixels = self.width / SAMPLES;
        for (pixel, (light, depth)) in light.iter_mut().zip(depth).enumerate() {
            let (row, column) = (pixel / pixels * SAMPLES, pixel % pixels * SAMPLES);
            for k in 0..SAMPLES * SAMPLES {
                let (row, column) = (row + k / SAMPLES, column + k % SAMPLES);
                if let Some([red, green, blue]) = self.color(scene, row, column) {
                    light[0] += red * SHARE;
                    light[1] += green * SHARE;
                    light[2] += blue * SHARE;
                    light[3] += SHARE;
                    *depth = depth.max(self.depth[row * self.width + column]);
                }
            }
        }
    }
}
