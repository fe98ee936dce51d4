//! Small parts that stick out of a component and shift the whole mapping.

use crate::normals::face_area_vectors;
use crate::{GeometryError, Mesh, Unmonitored};

/// Few small faces that make one side of a component's XY box.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxOutliers {
    /// The side of the box they set: "low x", "high x", "low y" or "high y".
    pub side: &'static str,
    /// The faces, ascending.
    pub faces: Vec<u32>,
    /// How much of the box's extent would go without them, in 0..=1.
    pub share: f64,
}

/// Most faces, and most area, that count as an outlier.
const FEW: f64 = 0.05;
/// Least share of the extent they must make.
const NOTABLE: f64 = 0.1;

/// Finds sides of the XY box that under 5 % of the faces set alone.
///
/// For each side in turn: without the faces that reach farthest, fewer than one
/// in twenty and of under 5 % of the area, the box would be more than a tenth
/// smaller. Such a part (a bolt, a stray face) shifts the mapping of
/// [`super::Fit::Bounds`]; [`super::Fit::Cell`] is the way out. Even grids are
/// never named: 5 % of their faces make at most 5 % of their extent.
/// Cost: O(corners + faces · log faces).
///
/// # Errors
/// [`GeometryError::Empty`] for a component without faces.
pub fn box_outliers(component: &Mesh) -> Result<Vec<BoxOutliers>, GeometryError> {
    let (low, high) = super::box_of_faces(component, 0..component.face_count())?;
    let areas: Vec<f64> = face_area_vectors(component, &Unmonitored)?
        .iter()
        .map(|area| area.length())
        .collect();
    let sides = [
        ("low x", 0, -1.0),
        ("high x", 0, 1.0),
        ("low y", 1, -1.0),
        ("high y", 1, 1.0),
    ];
    let found = sides.into_iter().filter_map(|(side, axis, sign)| {
        let extent = high[axis] - low[axis];
        outliers_on(component, &areas, |p| p[axis] * sign, extent)
            .map(|(faces, share)| BoxOutliers { side, faces, share })
    });
    Ok(found.collect())
}

fn outliers_on(
    mesh: &Mesh,
    areas: &[f64],
    along: impl Fn(glam::DVec3) -> f64,
    extent: f64,
) -> Option<(Vec<u32>, f64)> {
    let reach = |face: usize| {
        let places = mesh
            .face(face)
            .iter()
            .map(|&v| along(mesh.positions()[v as usize]));
        places.fold(f64::NEG_INFINITY, f64::max)
    };
    let mut faces: Vec<(f64, u32)> = (0..mesh.face_count())
        .map(|face| (reach(face), face as u32))
        .collect();
    faces.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let farthest = faces.first()?.0;
    let total: f64 = areas.iter().sum();
    let (mut area, mut best) = (0.0, None);
    for (count, pair) in (1..).zip(faces.windows(2)) {
        area += areas[pair[0].1 as usize];
        if f64::from(count) >= FEW * faces.len() as f64 || area >= FEW * total {
            break;
        }
        // The widest gap separates the outlier from the rest.
        let gap = pair[0].0 - pair[1].0;
        if farthest - pair[1].0 > NOTABLE * extent && best.is_none_or(|(_, _, widest)| gap > widest)
        {
            best = Some((count as usize, (farthest - pair[1].0) / extent, gap));
        }
    }
    let (count, share, _) = best?;
    let mut named: Vec<u32> = faces[..count].iter().map(|&(_, face)| face).collect();
    named.sort_unstable();
    Some((named, share))
}
