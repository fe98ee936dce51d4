//! Pictures of meshes without a window: a z-buffer.
//!
//! A parallel view, as architects draw: what is equally long and lies the same
//! way is equally long in the picture. Faces are lit from the upper left, shaded
//! where the surface is hollow, and outlined by the edges of polygons, not of the
//! triangles they are drawn as. A field is shown in colours with a legend.
//!
//! The same mesh gives the same bytes for any number of threads and on every
//! machine.

mod legend;
mod light;
mod paint;
mod raster;
mod view;

use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::{GeometryError, Mesh, Monitor};

pub use paint::{FieldPaint, Paint};
pub use view::View;

use view::Frame;

/// How a mesh is drawn.
#[derive(Debug, Clone, Copy)]
pub struct DrawOptions<'a> {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// From where it is seen.
    pub view: View,
    /// What its colours mean.
    pub paint: Paint<'a>,
    /// Whether the edges of polygons are drawn; those of polygons that are too
    /// small to be told apart are left out in any case.
    pub edges: bool,
}

impl Default for DrawOptions<'_> {
    fn default() -> Self {
        Self {
            size: [1200, 800],
            view: View::Iso,
            paint: Paint::Materials,
            edges: true,
        }
    }
}

/// A picture, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    size: [u32; 2],
    /// Red, green and blue of each pixel, sRGB.
    pixels: Vec<u8>,
}

/// Why a picture was not drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// The picture would be empty or beyond [`LARGEST`] pixels a side.
    #[error("a picture of {0} x {1} pixels cannot be drawn; take 16 to {LARGEST} each way")]
    Size(u32, u32),
    /// A field belongs to another mesh, memory is short, or drawing was stopped.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
}

/// The longest side of a picture, in pixels.
pub const LARGEST: u32 = 16_384;

/// The shortest side of a picture, in pixels.
const SMALLEST: u32 = 16;

/// The background.
const PAPER: [u8; 3] = [255; 3];

/// Draws `mesh`, fitted into the picture.
///
/// Each pixel is looked at in nine places. An empty mesh gives an empty picture.
///
/// Cost: O(triangles + pixels); about 60 bytes per triangle and 30 per pixel.
///
/// # Errors
/// [`RenderError::Size`] for sides outside 16 ..= [`LARGEST`];
/// [`GeometryError`] when a painted field does not fit the mesh, when the memory
/// is not there, and when `monitor` asks to stop.
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored};
/// use tessgraph_render::{DrawOptions, draw};
///
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let square = Mesh::from_faces(corners, &[&[0, 1, 2, 3]])?;
/// let picture = draw(&square, &DrawOptions::default(), &Unmonitored)?;
/// assert_eq!(picture.size(), [1200, 800]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(
    mesh: &Mesh,
    options: &DrawOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Picture, RenderError> {
    let [width, height] = options.size;
    if !(SMALLEST..=LARGEST).contains(&width) || !(SMALLEST..=LARGEST).contains(&height) {
        return Err(RenderError::Size(width, height));
    }
    let pixels = u64::from(width) * u64::from(height);
    let triangles = mesh.corner_count().saturating_sub(2 * mesh.face_count()) as u64;
    monitor.afford(u128::from(60 * triangles + 30 * pixels))?;
    let colors = paint::Colors::of(mesh, &options.paint)?;
    let legend = colors.legend();
    let room = legend.as_ref().map_or(0, |_| legend::room(options.size));
    let inner = [width, height - room];
    let frame = Frame::fitting(mesh.positions(), options.view, inner);
    let drawn = raster::draw(mesh, &frame, &colors, options.edges, monitor)?;
    let shade = light::hollows(&drawn, inner, monitor)?;
    let mut picture = Picture {
        size: options.size,
        pixels: PAPER.repeat(pixels as usize),
    };
    picture.develop(&drawn, &shade);
    if let Some(legend) = legend {
        legend.draw(&mut picture, room);
    }
    Ok(picture)
}

impl Picture {
    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Red, green and blue of each pixel in sRGB, row by row from the top.
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// Puts drawn light onto the paper, from the top.
    fn develop(&mut self, drawn: &raster::Drawn, shade: &[f32]) {
        let seen = drawn.light.iter().zip(shade);
        for (pixel, (&[red, green, blue, cover], &shade)) in
            self.pixels.chunks_exact_mut(3).zip(seen)
        {
            if cover > 0.0 {
                let paper = DVec3::ONE * f64::from(1.0 - cover);
                let light = DVec3::new(red.into(), green.into(), blue.into());
                pixel.copy_from_slice(&light::srgb(light * f64::from(shade) + paper));
            }
        }
    }

    fn set(&mut self, x: i32, y: i32, color: [u8; 3]) {
        let [width, height] = self.size.map(|side| side as i32);
        if (0..width).contains(&x) && (0..height).contains(&y) {
            let at = 3 * (y * width + x) as usize;
            self.pixels[at..at + 3].copy_from_slice(&color);
        }
    }
}

#[cfg(test)]
mod tests;
