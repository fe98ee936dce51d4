//! Components in the unit square: x and y become (u, v), z the height (figure 1).

mod cut;
mod outliers;
mod seams;
#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

pub use outliers::{BoxOutliers, box_outliers};

use crate::naming::faces_named;
use crate::rebuild::keep_faces;
use crate::{GeometryError, Mesh};

/// How a component's x and y become the place (u, v) on a face.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Fit {
    /// The component's XY box becomes the unit square.
    #[default]
    Bounds,
    /// x and y are (u, v) already.
    Unit,
    /// The XY box of a named part becomes the unit square; the part itself is
    /// not output, so that pieces may stick out of it.
    Cell {
        /// A group, object or material of the component.
        name: String,
    },
}

/// What happens to the part of a component beyond the unit square.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Beyond {
    /// It stays, and reaches beyond the face.
    #[default]
    Extend,
    /// It is cut off.
    Clip,
    /// It is cut off and moved back in by whole periods: a pattern that crosses
    /// the border of its cell comes in again at the other side.
    Cyclic,
}

/// Where the surface cuts through a component's depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Anchor {
    /// At the component's z = 0.
    #[default]
    Origin,
    /// At its top: all of it lies below the surface.
    Below,
    /// Half way.
    Centre,
    /// At its bottom: all of it lies above the surface.
    Above,
}

/// Settings of [`fit_component`]; the default maps the XY box and keeps z.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FitOptions {
    /// What becomes the unit square.
    pub fit: Fit,
    /// Depth of the result in metres; `None` keeps z as it is.
    pub height: Option<f64>,
    /// Which level of the component lies in the surface.
    pub anchor: Anchor,
    /// What happens beyond u = 0 and u = 1.
    pub x: Beyond,
    /// What happens beyond v = 0 and v = 1.
    pub y: Beyond,
}

/// The rectangle of a component's XY plane that becomes the unit square.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Corner that becomes (0, 0), in metres.
    pub low: DVec2,
    /// Extent in metres; 0 where the component has none.
    pub size: DVec2,
}

impl Frame {
    /// The place (u, v) of a point; 0.5 along an axis without extent.
    pub fn uv(&self, point: DVec2) -> DVec2 {
        let one = |x: f64, low: f64, size: f64| if size > 0.0 { (x - low) / size } else { 0.5 };
        DVec2::new(
            one(point.x, self.low.x, self.size.x),
            one(point.y, self.low.y, self.size.y),
        )
    }

    /// Its area in square metres.
    pub fn area(&self) -> f64 {
        self.size.x * self.size.y
    }
}

/// The rectangle that `fit` maps to the unit square: the XY box of all vertices
/// that faces use, or of the named part's; for [`Fit::Unit`] the square itself.
///
/// An extent below 10⁻¹² of the box's diagonal counts as none.
///
/// # Errors
/// [`GeometryError::Empty`] for a component without faces;
/// [`GeometryError::Invalid`] when no face has the cell's name.
pub fn component_frame(component: &Mesh, fit: &Fit) -> Result<Frame, GeometryError> {
    let (low, high) = match fit {
        Fit::Unit => (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)),
        Fit::Bounds => box_of_faces(component, 0..component.face_count())?,
        Fit::Cell { name } => {
            let faces = faces_named(component, name)?;
            box_of_faces(component, faces.iter().map(|&face| face as usize))?
        }
    };
    let least = 1e-12 * (high - low).length();
    let extent = |low: f64, high: f64| if high - low > least { high - low } else { 0.0 };
    Ok(Frame {
        low: low.truncate(),
        size: DVec2::new(extent(low.x, high.x), extent(low.y, high.y)),
    })
}

/// Maps a component to the unit square: x, y become (u, v), z the height.
///
/// Bounds and Cell: u = (x - x_min) / (x_max - x_min) of the box, v likewise;
/// 0.5 where the box has no extent. `height` scales z about 0 until the
/// component's box, or the cell's if that has depth, is so high (a flat
/// component stays flat); `anchor` then moves that box up or down. What lies
/// beyond the square is kept, cut at 0 and 1, or cut at whole numbers and moved
/// by whole periods. A coordinate within 10⁻⁹ of such a line is put on it.
///
/// Cuts interpolate attributes of vertices and corners along the cut edges,
/// faces keep their labels, and neighbours share the cut, so the result stays
/// connected. A concave polygon stays one polygon: its pieces remain joined
/// along the line. A face that lies in the line as a whole is kept. Vertices
/// that no face uses are dropped when faces are.
///
/// The result has its (u, v, w) as positions: use it with [`Fit::Unit`].
/// Cost: O(corners · periods crossed).
///
/// ```
/// use tessgraph_geometry::{Anchor, FitOptions, Mesh, fit_component};
/// let tile = Mesh::from_faces(
///     vec![[2.0, 1.0, 0.0], [6.0, 1.0, 0.0], [6.0, 3.0, 1.0], [2.0, 3.0, 1.0]],
///     &[&[0, 1, 2, 3]],
/// )?;
/// let options = FitOptions { height: Some(0.2), anchor: Anchor::Below, ..FitOptions::default() };
/// let fitted = fit_component(&tile, &options)?;
/// assert_eq!(fitted.positions()[2].to_array(), [1.0, 1.0, 0.0]);
/// assert_eq!(fitted.positions()[0].to_array(), [0.0, 0.0, -0.2]);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// As [`component_frame`]; [`GeometryError::OutOfRange`] for a negative or
/// non-finite height, or for Cyclic across more than 1000 periods;
/// [`GeometryError::Empty`] when nothing of the component is left.
pub fn fit_component(component: &Mesh, options: &FitOptions) -> Result<Mesh, GeometryError> {
    if let Some(height) = options.height.filter(|h| !(*h >= 0.0 && h.is_finite())) {
        return Err(GeometryError::OutOfRange {
            what: "the height",
            value: height,
            requirement: "it must be finite and not negative",
        });
    }
    let frame = component_frame(component, &options.fit)?;
    let (part, levels) = without_cell(component, &options.fit)?;
    let (scale, shift) = depth(levels, options);
    let place = |p: &DVec3| frame.uv(p.truncate()).extend(p.z * scale + shift);
    let fitted = part.with_positions(part.positions().iter().map(place).collect())?;
    if (options.x, options.y) == (Beyond::Extend, Beyond::Extend) {
        Ok(fitted)
    } else {
        cut::cut(&fitted, options.x, options.y)
    }
}

/// The faces to output, and the lowest and highest z of the box that `height`
/// and `anchor` mean: the cell's, unless that is flat.
fn without_cell(component: &Mesh, fit: &Fit) -> Result<(Mesh, (f64, f64)), GeometryError> {
    let Fit::Cell { name } = fit else {
        let (low, high) = box_of_faces(component, 0..component.face_count())?;
        return Ok((component.clone(), (low.z, high.z)));
    };
    let cell = faces_named(component, name)?;
    let mut keep = vec![true; component.face_count()];
    for &face in &cell {
        keep[face as usize] = false;
    }
    let kept: Vec<u32> = (0..keep.len() as u32)
        .filter(|&f| keep[f as usize])
        .collect();
    if kept.is_empty() {
        return Err(GeometryError::Empty {
            what: "the component",
            missing: "faces besides its cell",
        });
    }
    let part = keep_faces(component, kept)?;
    let (low, high) = box_of_faces(component, cell.iter().map(|&face| face as usize))?;
    if high.z > low.z {
        return Ok((part, (low.z, high.z)));
    }
    let (low, high) = box_of_faces(&part, 0..part.face_count())?;
    Ok((part, (low.z, high.z)))
}

/// z' = z * scale + shift.
fn depth((low, high): (f64, f64), options: &FitOptions) -> (f64, f64) {
    let scale = match options.height {
        Some(height) if high > low => height / (high - low),
        _ => 1.0,
    };
    let shift = match options.anchor {
        Anchor::Origin => 0.0,
        Anchor::Below => -high * scale,
        Anchor::Centre => -(low + high) / 2.0 * scale,
        Anchor::Above => -low * scale,
    };
    (scale, shift)
}

/// Box of all vertices of the given faces.
fn box_of_faces(
    mesh: &Mesh,
    faces: impl Iterator<Item = usize>,
) -> Result<(DVec3, DVec3), GeometryError> {
    let mut places = faces
        .flat_map(|face| mesh.face(face))
        .map(|&vertex| mesh.positions()[vertex as usize]);
    let first = places.next().ok_or(GeometryError::Empty {
        what: "the component",
        missing: "faces",
    })?;
    Ok(places.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
}
