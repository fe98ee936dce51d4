//! From where a mesh is seen.

use std::fmt;
use std::str::FromStr;

use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::math::unit_or_zero;

/// The direction from the mesh towards the eye. z is up, x to the right of a front
/// view, y into it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum View {
    /// From the right, the front and above alike.
    Iso,
    /// From above, y upwards.
    Top,
    /// From below.
    Bottom,
    /// Against y.
    Front,
    /// Along y.
    Back,
    /// From negative x.
    Left,
    /// From positive x.
    Right,
    /// From any direction; not zero.
    From(DVec3),
}

impl View {
    /// The names of the views that have one.
    pub const NAMES: [&'static str; 7] = ["iso", "top", "bottom", "front", "back", "left", "right"];

    /// Unit vector towards the eye.
    pub fn direction(self) -> DVec3 {
        match self {
            Self::Iso => unit_or_zero(DVec3::new(1.0, -1.0, 1.0)),
            Self::Top => DVec3::Z,
            Self::Bottom => DVec3::NEG_Z,
            Self::Front => DVec3::NEG_Y,
            Self::Back => DVec3::Y,
            Self::Left => DVec3::NEG_X,
            Self::Right => DVec3::X,
            Self::From(direction) => unit_or_zero(direction),
        }
    }
}

/// Why a text names no view.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownView(String);

impl fmt::Display for UnknownView {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = View::NAMES.join(", ");
        write!(
            f,
            "`{}` is no view; take {names}, or a direction such as 1,-2,0.5",
            self.0
        )
    }
}

impl std::error::Error for UnknownView {}

impl FromStr for View {
    type Err = UnknownView;

    /// One of [`View::NAMES`], or a direction as three numbers with commas.
    fn from_str(text: &str) -> Result<Self, UnknownView> {
        let unknown = || UnknownView(text.to_owned());
        Ok(match text {
            "iso" => Self::Iso,
            "top" => Self::Top,
            "bottom" => Self::Bottom,
            "front" => Self::Front,
            "back" => Self::Back,
            "left" => Self::Left,
            "right" => Self::Right,
            _ => {
                let parts: Result<Vec<f64>, _> =
                    text.split(',').map(|part| part.trim().parse()).collect();
                let parts: [f64; 3] = parts
                    .ok()
                    .and_then(|parts| parts.try_into().ok())
                    .ok_or_else(unknown)?;
                let direction = unit_or_zero(DVec3::from(parts));
                if direction == DVec3::ZERO || !direction.is_finite() {
                    return Err(unknown());
                }
                Self::From(direction)
            }
        })
    }
}

/// The axes of a picture and its scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    /// Towards the right of the picture, towards its top, and towards the eye.
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    pub(crate) back: DVec3,
    /// What is in the middle of the picture.
    middle: DVec3,
    /// Pixels per metre.
    pub(crate) scale: f64,
    /// Width and height in pixels.
    pub(crate) size: [u32; 2],
}

/// The share of a picture that stays free at its edges.
const MARGIN: f64 = 0.06;

impl Frame {
    /// The frame in which all of `places` is seen as large as it can be.
    pub(crate) fn fitting(places: &[DVec3], view: View, size: [u32; 2]) -> Self {
        let back = view.direction();
        // Seen along z there is no up; x is to the right then.
        let right = unit_or_zero(DVec3::Z.cross(back));
        let right = if right == DVec3::ZERO {
            DVec3::X
        } else {
            right
        };
        let up = back.cross(right);
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = places.iter().fold(none, |(low, high), place| {
            let seen = DVec3::new(place.dot(right), place.dot(up), place.dot(back));
            (low.min(seen), high.max(seen))
        });
        let [width, height] = size.map(f64::from);
        let (middle, extent) = if places.is_empty() {
            (DVec3::ZERO, DVec3::ONE)
        } else {
            (low / 2.0 + high / 2.0, high - low)
        };
        let fit = |pixels: f64, length: f64| pixels * (1.0 - MARGIN) / length;
        let scale = fit(width, extent.x).min(fit(height, extent.y));
        Self {
            right,
            up,
            back,
            middle,
            // A single point, or a line towards the eye, has no extent.
            scale: if scale.is_finite() { scale } else { 1.0 },
            size,
        }
    }

    /// Where a place is drawn: x to the right and y downwards in pixels, and how
    /// near it is to the eye, in pixels too.
    pub(crate) fn project(&self, place: DVec3) -> DVec3 {
        let seen = DVec3::new(
            place.dot(self.right),
            -place.dot(self.up),
            place.dot(self.back),
        );
        let middle = DVec3::new(self.middle.x, -self.middle.y, self.middle.z);
        let [width, height] = self.size.map(f64::from);
        (seen - middle) * self.scale + DVec3::new(width / 2.0, height / 2.0, 0.0)
    }
}
