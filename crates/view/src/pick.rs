//! What is known of a face or a vertex, and distances: from the exact numbers,
//! not from what is drawn.

use std::collections::BTreeMap;

use glam::DVec3;
use tessgraph_geometry::measure::{measure_mesh, planarity};
use tessgraph_geometry::surface::Surface;
use tessgraph_geometry::{AttributeValues, Domain, Mesh, Quantity, Unmonitored};

use crate::protocol::{Amount, MeasureEnd, Measured, Picked};
use crate::shown::Subject;
use crate::values::{amount, amount_beside};

/// What is known of a face, of a vertex, or of nothing.
///
/// Cost: O(corners of the face).
pub fn pick(subject: &Subject, request: u64, face: Option<usize>, vertex: Option<usize>) -> Picked {
    let face = face.filter(|&face| face < subject.mesh.face_count());
    let vertex = vertex.filter(|&vertex| vertex < subject.mesh.vertex_count());
    let mut lines = Vec::new();
    if let Some(vertex) = vertex {
        of_vertex(subject, vertex, &mut lines);
    }
    if let Some(face) = face {
        of_face(subject, face, &mut lines);
    }
    if !lines.is_empty() {
        lines.push(("made by".to_owned(), subject.node.clone().into()));
    }
    let outline = face.map(|face| {
        let corners = subject.mesh.face(face).iter();
        corners
            .map(|&vertex| subject.mesh.positions()[vertex as usize].to_array())
            .collect()
    });
    let place = vertex.map(|vertex| vec![subject.mesh.positions()[vertex].to_array()]);
    Picked {
        request,
        face,
        vertex,
        lines,
        vertices: outline.or(place),
    }
}

type Lines = Vec<(String, Amount)>;

/// Lengths of a mesh below this share of its size are rounding.
const DUST: f64 = 1e-6;

/// The diagonal of the mesh's box.
fn size(mesh: &Mesh) -> f64 {
    mesh.bounds().map_or(0.0, |(low, high)| low.distance(high))
}

fn of_vertex(subject: &Subject, vertex: usize, lines: &mut Lines) {
    let place = subject.mesh.positions()[vertex];
    lines.push(("vertex".to_owned(), vertex.to_string().into()));
    let size = size(&subject.mesh);
    for (axis, coordinate) in ["x", "y", "z"].into_iter().zip(place.to_array()) {
        let told = amount_beside(coordinate, size, Quantity::Length, subject.units);
        lines.push((axis.to_owned(), told));
    }
    values(subject, Domain::Vertex, vertex, lines);
}

fn of_face(subject: &Subject, face: usize, lines: &mut Lines) {
    let (mesh, units) = (&subject.mesh, subject.units);
    let size = size(mesh);
    let mut line = |label: &str, told: Amount| lines.push((label.to_owned(), told));
    line("face", face.to_string().into());
    line("corners", mesh.face(face).len().to_string().into());
    if let Some(single) = alone(mesh, face) {
        line(
            "area",
            amount(measure_mesh(&single).area, Quantity::Area, units),
        );
        if let Ok(found) = planarity(&single, &Unmonitored)
            && let [flatness] = found.as_slice()
        {
            let dust = flatness.plane.abs().max(DUST * size);
            line(
                "off its plane by",
                amount_beside(flatness.plane, dust, Quantity::Length, units),
            );
        }
    }
    if let Some(material) = mesh.materials().get(face) {
        line("material", material.name.clone().into());
    }
    if let Some(groups) = mesh.groups().get(face).filter(|groups| !groups.is_empty()) {
        line("groups", groups.join(", ").into());
    }
    if let Some(object) = mesh.objects().get(face) {
        line("object", object.clone().into());
    }
    values(subject, Domain::Face, face, lines);
}

/// The fields and attributes of an element.
fn values(subject: &Subject, domain: Domain, element: usize, lines: &mut Lines) {
    let size = size(&subject.mesh);
    for (label, field) in &subject.fields {
        if field.domain() == domain {
            let number = field.values()[element];
            let (quantity, units) = (field.quantity(), subject.units);
            let told = if quantity == Quantity::Length {
                amount_beside(number, number.abs().max(DUST * size), quantity, units)
            } else {
                amount(number, quantity, units)
            };
            lines.push((label.clone(), told));
        }
    }
    let plain = |number: f64| amount(number, Quantity::Number, subject.units);
    for attribute in subject.mesh.attributes() {
        if attribute.domain() != domain {
            continue;
        }
        let told = match attribute.values() {
            AttributeValues::Integer(values) => values[element].to_string().into(),
            AttributeValues::Number(values) => plain(values[element]),
            AttributeValues::Vector2(values) => several(values[element].to_array().map(plain)),
            AttributeValues::Vector3(values) => several(values[element].to_array().map(plain)),
        };
        lines.push((attribute.name().replace('_', " "), told));
    }
}

/// Several numbers as one.
fn several<const N: usize>(numbers: [Amount; N]) -> Amount {
    let joined = |part: fn(&Amount) -> &str| numbers.each_ref().map(part).join(", ");
    Amount {
        text: joined(|number| &number.text),
        exact: joined(|number| &number.exact),
    }
}

/// A face as a mesh of its own.
fn alone(mesh: &Mesh, face: usize) -> Option<Mesh> {
    let mut own = BTreeMap::new();
    let mut places = Vec::new();
    let mut corners = Vec::new();
    for &vertex in mesh.face(face) {
        let corner = *own.entry(vertex).or_insert_with(|| {
            places.push(mesh.positions()[vertex as usize].to_array());
            places.len() as u32 - 1
        });
        corners.push(corner);
    }
    Mesh::from_faces(places, &[corners]).ok()
}

/// The shortest way between two elements; `None` where there are none.
///
/// Of a face all of its surface counts. Cost: O(corners²) of the two.
pub fn measure(
    subject: &Subject,
    request: u64,
    from: MeasureEnd,
    to: MeasureEnd,
) -> Option<Measured> {
    let (from, to) = (End::new(&subject.mesh, from)?, End::new(&subject.mesh, to)?);
    let (from, to) = shortest(&from, &to);
    let distance = from.distance(to);
    let length = |metres: f64| amount_beside(metres, distance, Quantity::Length, subject.units);
    Some(Measured {
        request,
        from: from.to_array(),
        to: to.to_array(),
        distance: length(distance),
        delta: (to - from).to_array().map(length),
    })
}

/// An end of a distance.
enum End {
    Place(DVec3),
    Face(Vec<DVec3>, Box<Surface>),
}

impl End {
    fn new(mesh: &Mesh, end: MeasureEnd) -> Option<Self> {
        if let Some(meant) = end.cut {
            return crate::section::place(mesh, meant).map(Self::Place);
        }
        if let Some(vertex) = end.vertex {
            return mesh.positions().get(vertex).copied().map(Self::Place);
        }
        let face = end.face.filter(|&face| face < mesh.face_count())?;
        let single = alone(mesh, face)?;
        let corners = mesh.face(face).iter();
        let corners = corners.map(|&vertex| mesh.positions()[vertex as usize]);
        let surface = Surface::new(&single, &Unmonitored).ok()?;
        Some(Self::Face(corners.collect(), Box::new(surface)))
    }
}

/// The two places that are closest to each other.
fn shortest(from: &End, to: &End) -> (DVec3, DVec3) {
    match (from, to) {
        (End::Place(from), End::Place(to)) => (*from, *to),
        (End::Place(from), End::Face(_, surface)) => (*from, surface.closest(*from).point),
        (End::Face(_, surface), End::Place(to)) => (surface.closest(*to).point, *to),
        (End::Face(corners, surface), End::Face(others, other)) => {
            between_faces((corners, surface), (others, other))
        }
    }
}

/// Faces are closest at a corner of one of them, or where a side of one comes
/// closest to a side of the other.
fn between_faces(
    (corners, surface): (&[DVec3], &Surface),
    (others, other): (&[DVec3], &Surface),
) -> (DVec3, DVec3) {
    let from_here = corners
        .iter()
        .map(|&place| (place, other.closest(place).point));
    let from_there = others
        .iter()
        .map(|&place| (surface.closest(place).point, place));
    let sides = |corners: &[DVec3]| -> Vec<(DVec3, DVec3)> {
        let next = corners.iter().cycle().skip(1);
        corners.iter().copied().zip(next.copied()).collect()
    };
    let (mine, theirs) = (sides(corners), sides(others));
    let across = mine.iter().flat_map(|one| {
        let closest = |two: &(DVec3, DVec3)| between_sides(*one, *two);
        theirs.iter().map(closest).collect::<Vec<_>>()
    });
    let all = from_here.chain(from_there).chain(across);
    let closer = |one: &(DVec3, DVec3), two: &(DVec3, DVec3)| {
        let squared = |(from, to): &(DVec3, DVec3)| from.distance_squared(*to);
        squared(one).total_cmp(&squared(two))
    };
    all.min_by(closer).unwrap_or_default()
}

/// The closest places of two segments (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.9).
fn between_sides((p, p_end): (DVec3, DVec3), (q, q_end): (DVec3, DVec3)) -> (DVec3, DVec3) {
    let (along, other, apart) = (p_end - p, q_end - q, p - q);
    let (a, e) = (along.length_squared(), other.length_squared());
    let (b, c, f) = (along.dot(other), along.dot(apart), other.dot(apart));
    // Of a segment without length only its one end counts.
    let share = |number: f64, of: f64| {
        if of > 0.0 {
            (number / of).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let s = share(b * f - c * e, a * e - b * b);
    let t = share(b * s + f, e);
    let s = share(b * t - c, a);
    (p + along * s, q + other * t)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tessgraph_graph::Units;

    use super::*;

    /// Two unit squares, one 3 m above the other and 4 m aside.
    fn subject() -> Subject {
        let square = |x: f64, z: f64| {
            [
                [x, 0.0, z],
                [x + 1.0, 0.0, z],
                [x + 1.0, 1.0, z],
                [x, 1.0, z],
            ]
        };
        let places = [square(0.0, 0.0), square(5.0, 3.0)].concat();
        let faces = [[0, 1, 2, 3], [4, 5, 6, 7]];
        Subject {
            mesh: Arc::new(Mesh::from_faces(places, &faces).unwrap()),
            node: "roof".to_owned(),
            units: Units::Cm,
            fields: Vec::new(),
        }
    }

    fn at(face: Option<usize>, vertex: Option<usize>) -> MeasureEnd {
        MeasureEnd {
            vertex,
            face,
            cut: None,
        }
    }

    #[test]
    fn distances_are_exact_and_in_the_units_of_the_file() {
        let subject = subject();
        let told = |from, to| measure(&subject, 1, from, to).map(|found| found.distance.text);
        let far = told(at(None, Some(1)), at(None, Some(4)));
        assert_eq!(far.as_deref(), Some("500 cm"));
        let faces = told(at(Some(0), None), at(Some(1), None));
        assert_eq!(faces.as_deref(), Some("500 cm"));
        let mixed = measure(&subject, 1, at(Some(0), None), at(None, Some(7))).unwrap();
        assert_eq!(
            (mixed.distance.text.as_str(), mixed.from),
            ("500 cm", [1.0, 1.0, 0.0])
        );
        let delta = mixed.delta.map(|along| along.text);
        assert_eq!(delta, ["400 cm", "0 cm", "300 cm"]);
        assert_eq!(told(at(Some(2), None), at(Some(0), None)), None);
        assert_eq!(told(at(None, None), at(Some(0), None)), None);
    }

    #[test]
    fn sides_are_closest_inside_and_at_their_ends() {
        let x = (DVec3::ZERO, DVec3::X);
        let above = |y: f64| (DVec3::new(0.5, y, 2.0), DVec3::new(0.5, y + 1.0, 2.0));
        let (from, to) = between_sides(x, above(-0.5));
        assert_eq!((from, to), (DVec3::X * 0.5, DVec3::new(0.5, 0.0, 2.0)));
        let (from, to) = between_sides(x, above(3.0));
        assert_eq!((from, to), (DVec3::X * 0.5, DVec3::new(0.5, 3.0, 2.0)));
        // Parallel, and without length.
        let (from, to) = between_sides(x, (DVec3::Y, DVec3::Y + DVec3::X));
        assert!((from.distance(to) - 1.0).abs() < 1e-15);
        let (from, to) = between_sides((DVec3::X, DVec3::X), x);
        assert_eq!((from, to), (DVec3::X, DVec3::X));
    }

    #[test]
    fn faces_and_vertices_are_told_with_units() {
        let picked = pick(&subject(), 7, Some(1), Some(4));
        let line = |label: &str| {
            let found = picked.lines.iter().find(|(other, _)| other == label);
            found.map(|(_, told)| told.text.as_str())
        };
        assert_eq!(
            (picked.request, picked.face, picked.vertex),
            (7, Some(1), Some(4))
        );
        assert_eq!((line("x"), line("z")), (Some("500 cm"), Some("300 cm")));
        assert_eq!(
            (line("area"), line("corners")),
            (Some("10000 cm²"), Some("4"))
        );
        assert_eq!(line("off its plane by"), Some("0 cm"));
        assert_eq!(line("made by"), Some("roof"));
        assert_eq!(picked.vertices.map(|outline| outline.len()), Some(4));
        let nothing = pick(&subject(), 8, Some(2), Some(99));
        assert!(nothing.lines.is_empty() && nothing.face.is_none());
    }
}
