//! Colours for numbers.

use glam::DVec3;
use tessgraph_geometry::math::pow;
use tessgraph_geometry::{AttributeValues, Domain, Mesh, glam};

/// Nine colours of "viridis" (van der Walt and Smith 2015, CC0), evenly
/// spaced, as sRGB bytes. Its lightness rises evenly, so that equal steps of a
/// field look equal, to colour-blind readers and in print too.
const STOPS: [[u8; 3]; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2d, 0x7b],
    [0x3b, 0x52, 0x8b],
    [0x2c, 0x72, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x28, 0xae, 0x80],
    [0x5e, 0xc9, 0x62],
    [0xad, 0xdc, 0x30],
    [0xfd, 0xe7, 0x25],
];

/// The colour of `t` in 0..=1, from dark violet to yellow, as linear red,
/// green and blue; values beyond take the colour of the end.
///
/// Interpolates between nine colours in sRGB, where viridis is perceptually
/// even, and converts to linear light, which renderers expect.
///
/// ```
/// let (low, high) = (tessgraph_io::viridis(0.0), tessgraph_io::viridis(1.0));
/// assert!(low.element_sum() < high.element_sum());
/// ```
pub fn viridis(t: f64) -> DVec3 {
    let along = t.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    // A NaN stays NaN above and becomes 0 here; no caller has one.
    let lower = (along as usize).min(STOPS.len() - 2);
    let rest = along - lower as f64;
    let color = |k: usize| DVec3::from(STOPS[k].map(f64::from)) / 255.0;
    let srgb = color(lower) * (1.0 - rest) + color(lower + 1) * rest;
    DVec3::from(srgb.to_array().map(linear))
}

/// Where in a colour map a value of a field belongs whose colours begin at `low`
/// and end at `high`: 0 at `low`, 1 at `high`, and the middle, 0.5, of a range
/// without extent.
///
/// ```
/// assert_eq!(tessgraph_io::place_in_range(3.0, (1.0, 5.0)), 0.5);
/// assert_eq!(tessgraph_io::place_in_range(3.0, (3.0, 3.0)), 0.5);
/// ```
pub fn place_in_range(value: f64, (low, high): (f64, f64)) -> f64 {
    // Halved, so that the difference of huge numbers stays finite.
    match high * 0.5 - low * 0.5 {
        half if half > 0.0 => (value * 0.5 - low * 0.5) / half,
        _ => 0.5,
    }
}

/// The colours a mesh carries: its attribute `color` on vertices, else on faces,
/// as linear red, green and blue, one per element.
pub fn mesh_colors(mesh: &Mesh) -> Option<(Domain, &[DVec3])> {
    [Domain::Vertex, Domain::Face]
        .into_iter()
        .find_map(|domain| match mesh.attribute("color", domain)?.values() {
            AttributeValues::Vector3(colors) => Some((domain, colors.as_slice())),
            _ => None,
        })
}

/// Linear light of an sRGB component (IEC 61966-2-1).
fn linear(value: f64) -> f64 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        pow((value + 0.055) / 1.055, 2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_rises_all_the_way() {
        let luminance = |t: f64| viridis(t).dot(DVec3::new(0.2126, 0.7152, 0.0722));
        let steps: Vec<_> = (0..=100).map(|k| luminance(f64::from(k) / 100.0)).collect();
        assert!(steps.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn ends_are_the_published_colours() {
        let byte = |value: f64| {
            let srgb = if value <= 0.0031308 {
                value * 12.92
            } else {
                1.055 * pow(value, 1.0 / 2.4) - 0.055
            };
            (srgb * 255.0).round() as u8
        };
        assert_eq!(viridis(-1.0).to_array().map(byte), STOPS[0]);
        assert_eq!(viridis(0.5).to_array().map(byte), STOPS[4]);
        assert_eq!(viridis(2.0).to_array().map(byte), STOPS[8]);
    }
}
