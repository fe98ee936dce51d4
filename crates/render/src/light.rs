//! How brightly things are seen.

use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::math::{pow, unit_or_zero};
use tessgraph_geometry::{GeometryError, Monitor, parallel};

use crate::raster::Drawn;
use crate::view::Frame;

/// How brightly a face with this normal is lit: by a lamp at the upper left of the
/// eye, by the sky, and a little from everywhere. Sides that are seen from behind
/// are a shade darker, so that a face turned over is noticed.
pub(crate) fn lit(normal: DVec3, frame: &Frame) -> f32 {
    let from_behind = normal.dot(frame.back) < 0.0;
    let seen = if from_behind { -normal } else { normal };
    let lamp = unit_or_zero(frame.back * 0.7 - frame.right * 0.5 + frame.up * 0.5);
    let sky = 0.5 + 0.5 * seen.z;
    let light = 0.12 + 0.3 * sky + 0.66 * seen.dot(lamp).max(0.0);
    (if from_behind { light * 0.8 } else { light }) as f32
}

/// Rings of pixels round each one that are asked how deep it lies, by radius.
const RINGS: [i32; 3] = [3, 9, 24];

/// Half of the directions of a ring; the others are opposite.
const DIRECTIONS: [(f64, f64); 4] = [
    (1.0, 0.0),
    (
        std::f64::consts::FRAC_1_SQRT_2,
        std::f64::consts::FRAC_1_SQRT_2,
    ),
    (0.0, 1.0),
    (
        -std::f64::consts::FRAC_1_SQRT_2,
        std::f64::consts::FRAC_1_SQRT_2,
    ),
];

/// The share of light that hollows lose at most.
const DEEPEST: f32 = 0.55;

/// For each pixel the share of light that reaches it.
///
/// A place that lies below the middle of two opposite ones is in a hollow; on a
/// plane, however it is tilted, nothing does.
pub(crate) fn hollows(
    drawn: &Drawn,
    [width, height]: [u32; 2],
    monitor: &dyn Monitor,
) -> Result<Vec<f32>, GeometryError> {
    let (width, height) = (width as i32, height as i32);
    // Pictures of other sizes are shaded alike.
    let unit = f64::from(height) / 800.0;
    let offsets: Vec<_> = { RINGS.iter() }
        .flat_map(|&radius| {
            DIRECTIONS.map(|(x, y)| {
                let length = (f64::from(radius) * unit).max(1.0);
                (
                    (x * length).round() as i32,
                    (y * length).round() as i32,
                    length as f32,
                )
            })
        })
        .collect();
    let depth = |x: i32, y: i32| {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        if inside {
            drawn.depth[(y * width + x) as usize]
        } else {
            f32::NEG_INFINITY
        }
    };
    parallel::map(drawn.depth.len(), monitor, |pixel| {
        let (x, y) = (pixel as i32 % width, pixel as i32 / width);
        let here = drawn.depth[pixel];
        if here == f32::NEG_INFINITY {
            return 1.0;
        }
        let mut hollow = 0.0;
        for &(dx, dy, radius) in &offsets {
            // What is far nearer or far behind says no more than what is near.
            let above = |depth: f32| (depth - here).clamp(-radius, radius);
            let middle = (above(depth(x + dx, y + dy)) + above(depth(x - dx, y - dy))) / 2.0;
            hollow += (middle / radius).max(0.0);
        }
        1.0 - DEEPEST * (hollow * 2.0 / offsets.len() as f32).min(1.0)
    })
}

/// Linear light as sRGB bytes (IEC 61966-2-1).
pub(crate) fn srgb(light: DVec3) -> [u8; 3] {
    light.to_array().map(|part| {
        let part = part.clamp(0.0, 1.0);
        let coded = if part <= 0.003_130_8 {
            part * 12.92
        } else {
            1.055 * pow(part, 1.0 / 2.4) - 0.055
        };
        (coded * 255.0).round() as u8
    })
}
