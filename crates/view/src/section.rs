//! The cut of what is shown by a plane: drawn from single precision, told and
//! measured from the exact numbers.

use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::section::{CutSegment, Plane, Section};
use tessgraph_geometry::{AttributeValues, BASE_FACE, Domain, Mesh, Quantity, Unmonitored};

use crate::buffers::{Buffers, bytes, source};
use crate::protocol::{CutPlace, PlaneAsked, Sectioned};
use crate::shown::Subject;
use crate::values::amount;

/// The plane that is asked for; `None` if it is none.
fn plane(asked: PlaneAsked) -> Option<Plane> {
    let normal = DVec3::from_array(asked.normal);
    let length = normal.length();
    let plane = Plane {
        normal: normal / length,
        at: asked.at / length,
    };
    (plane.normal.is_finite() && plane.at.is_finite()).then_some(plane)
}

/// Cuts what is shown; `None` where the plane is none.
///
/// Cost: that of [`Section::cut`].
pub fn section(
    subject: &Subject,
    buffers: &Buffers,
    request: u64,
    asked: PlaneAsked,
) -> Option<Sectioned> {
    let (mesh, plane) = (&subject.mesh, plane(asked)?);
    let section = Section::cut(mesh, plane, &Unmonitored).ok()?;
    let told = |number, quantity| amount(number, quantity, subject.units);
    let (length, area) = (section.length(), section.area(plane.normal));
    let closed = section.segments.iter().filter(|piece| piece.is_closed);
    let open = section.segments.iter().filter(|piece| !piece.is_closed);
    let closed_count = closed.clone().count();
    let segments: Vec<CutSegment> = closed.chain(open).copied().collect();
    let origin = segments.first().map_or(DVec3::ZERO, |first| first.from);
    let mut of = source(
        "section",
        &[mesh.positions().digest(), mesh.topology().digest()],
    );
    for part in plane.normal.to_array().into_iter().chain([plane.at]) {
        of.float(part);
    }
    let of = of.finish();
    let ends = || {
        let places = segments.iter().flat_map(|piece| [piece.from, piece.to]);
        let numbers = places.flat_map(|place| (place - origin).as_vec3().to_array());
        bytes(numbers.map(|number| number.to_bits().to_le()).collect())
    };
    let panels = panels(mesh, &segments);
    let of_panels = panels
        .iter()
        .fold(source("panels", &[of]), |mut hasher, panel| {
            hasher.number(u64::from(*panel));
            hasher
        });
    Some(Sectioned {
        request,
        origin: origin.to_array(),
        segments: buffers.made(of, ends).0,
        panels: buffers.made(of_panels.finish(), || bytes(panels)).0,
        count: segments.len(),
        closed_count,
        closed: section.closed,
        open: section.open,
        length: told(length, Quantity::Length),
        area: told(area, Quantity::Area),
    })
}

/// The panel of each segment: the face of the base that its face came from, or its
/// face where there is no base.
fn panels(mesh: &Mesh, segments: &[CutSegment]) -> Vec<u32> {
    let base = mesh.attribute(BASE_FACE, Domain::Face);
    let base = base.map(tessgraph_geometry::Attribute::values);
    let panel = |piece: &CutSegment| match base {
        Some(AttributeValues::Integer(values)) => {
            u32::try_from(values[piece.face as usize]).unwrap_or(u32::MAX)
        }
        _ => piece.face,
    };
    segments.iter().map(|piece| panel(piece).to_le()).collect()
}

/// The place of a cut that is meant; `None` where nothing is cut.
pub(crate) fn place(mesh: &Mesh, meant: CutPlace) -> Option<DVec3> {
    let section = Section::cut(mesh, plane(meant.plane)?, &Unmonitored).ok()?;
    section.closest(DVec3::from_array(meant.near), meant.snap)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tessgraph_geometry::primitives::cuboid;
    use tessgraph_graph::Units;

    use super::*;
    use crate::pick::measure;
    use crate::protocol::MeasureEnd;

    fn subject() -> Subject {
        let body = cuboid(DVec3::new(2.0, 3.0, 4.0), [1, 1, 1], false);
        Subject {
            mesh: Arc::new(body.unwrap()),
            node: "box".to_owned(),
            units: Units::Cm,
            fields: Vec::new(),
        }
    }

    const ACROSS: PlaneAsked = PlaneAsked {
        normal: [0.0, 0.0, 2.0],
        at: 3.0,
    };

    #[test]
    fn a_cut_is_told_with_its_outline_length_and_area() {
        let buffers = Buffers::new(1000);
        let told = section(&subject(), &buffers, 9, ACROSS).unwrap();
        assert_eq!((told.closed, told.open), (1, 0));
        assert_eq!(
            (told.length.text.as_str(), told.area.text.as_str()),
            ("1000 cm", "60000 cm²")
        );
        let ends = buffers.get(told.segments.0).unwrap();
        assert_eq!(ends.len(), 24 * told.count);
        assert_eq!(buffers.get(told.panels.0).unwrap().len(), 4 * told.count);
        let places = ends.chunks_exact(12).map(|place| {
            let at = |k: usize| f32::from_le_bytes(place[4 * k..4 * k + 4].try_into().unwrap());
            (DVec3::new(at(0).into(), at(1).into(), at(2).into())) + DVec3::from_array(told.origin)
        });
        assert!({ places }.all(|place| (place.z - 1.5).abs() < 1e-6));
        let nowhere = PlaneAsked {
            normal: [0.0; 3],
            at: 1.0,
        };
        assert!(section(&subject(), &buffers, 9, nowhere).is_none());
    }

    #[test]
    fn distances_on_the_cut_are_exact() {
        let on_cut = |near: [f64; 3], snap: f64| MeasureEnd {
            cut: Some(CutPlace {
                plane: ACROSS,
                near,
                snap,
            }),
            ..MeasureEnd::default()
        };
        let (from, to) = (
            on_cut([0.01, 0.02, 1.5], 0.1),
            on_cut([2.0, 2.9999, 1.5], 0.1),
        );
        let measured = measure(&subject(), 1, from, to).unwrap();
        assert_eq!(DVec3::from_array(measured.from), DVec3::new(0.0, 0.0, 1.5));
        assert_eq!(DVec3::from_array(measured.to), DVec3::new(2.0, 3.0, 1.5));
        assert_eq!(measured.distance.text, "360.56 cm");
        let middle = measure(&subject(), 1, from, on_cut([2.0, 1.0, 1.5], 0.1)).unwrap();
        assert_eq!(DVec3::from_array(middle.to), DVec3::new(2.0, 1.0, 1.5));
        let past = PlaneAsked {
            normal: [0.0, 0.0, 1.0],
            at: 9.0,
        };
        let cut = Some(CutPlace {
            plane: past,
            near: [0.0; 3],
            snap: 1.0,
        });
        let nowhere = MeasureEnd {
            cut,
            ..MeasureEnd::default()
        };
        assert!(measure(&subject(), 1, from, nowhere).is_none());
    }
}
