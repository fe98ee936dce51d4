//! Where on a face each component vertex reads its direction (§3.3, figure 11).

use glam::{DVec2, DVec3};

use crate::fit::{Fit, component_frame};
use crate::math::lerp2;
use crate::naming::faces_named;
use crate::{Amount, Attribute, AttributeValues, Domain, GeometryError, Mesh};

/// Name of the vertex attribute that holds (u', v').
pub const NORMAL_UV: &str = "normal_uv";

/// Where (u', v') comes from.
#[derive(Debug, Clone)]
pub enum NormalUvSource<'a> {
    /// A UV layer of the component.
    UvLayer {
        /// The layer's name; `None` for the first corner attribute of 2D vectors.
        layer: Option<&'a str>,
    },
    /// A UV layer of another mesh with the same faces.
    UvLayerOf {
        /// The mesh that has the layer.
        mesh: &'a Mesh,
        /// The layer's name; `None` for the first.
        layer: Option<&'a str>,
    },
    /// All vertices of a part share one place: the part is moved by parallel
    /// translation and keeps its shape.
    Collapse {
        /// The part.
        part: Part<'a>,
        /// The place; `None` for the centroid of the part's vertices.
        to: Option<DVec2>,
    },
    /// Places are drawn towards a point.
    Scale {
        /// The point, in (u, v).
        about: DVec2,
        /// One per vertex: 0 puts it on the point, 1 leaves it.
        factor: &'a Amount,
    },
}

/// Some vertices of a component.
#[derive(Debug, Clone, Copy)]
pub enum Part<'a> {
    /// Every vertex.
    All,
    /// The vertices of the faces of a group, object or material.
    Named(&'a str),
    /// The vertices in a box in the component's own coordinates, its border
    /// included.
    Box {
        /// Lowest corner.
        low: DVec3,
        /// Highest corner.
        high: DVec3,
    },
}

/// Which of u' and v' may differ from u and v.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NormalUvAxes {
    /// Both, as the paper says.
    #[default]
    Both,
    /// u' only, and v' = v: what the paper's add-on does.
    U,
}

/// A component with its places of direction.
#[derive(Debug, Clone)]
pub struct NormalUv {
    /// The component with vertex attribute [`NORMAL_UV`].
    pub mesh: Mesh,
    /// Vertices where corners disagree about (u', v'), ascending: the UV layer
    /// has a seam there, and the last corner won.
    pub seams: Vec<u32>,
    /// Vertices whose (u', v') lies outside the unit square, ascending: their
    /// direction is extrapolated beyond the face.
    pub outside: Vec<u32>,
}

/// Gives a component the places (u', v') where its directions are read (§3.3).
///
/// A component vertex sits at X = P(u, v) + w D(u', v'); without this,
/// u' v' = u v. Where a portion shares one (u', v') its vertices are all moved
/// along the same direction, so it is not distorted (figure 11 D).
///
/// `fit` says how (u, v) follows from x and y, as for the array. A UV layer has
/// a value per corner: of the corners at one vertex the last in the order of
/// faces wins, and vertices where they disagree are reported. A vertex without
/// corners keeps its (u, v). Cost: O(corners).
///
/// # Errors
/// [`GeometryError::NoAttribute`] without such a layer,
/// [`GeometryError::OtherTopology`] for a layer of other faces,
/// [`GeometryError::Invalid`] for an unknown name, [`GeometryError::Empty`] for a
/// part without vertices, [`GeometryError::OutOfRange`] for a point or factor
/// that is not finite; those of [`component_frame`] and [`Amount::check`].
pub fn evaluate_normals_uv(
    component: &Mesh,
    source: &NormalUvSource<'_>,
    axes: NormalUvAxes,
    fit: &Fit,
) -> Result<NormalUv, GeometryError> {
    let frame = component_frame(component, fit)?;
    let place = |p: &DVec3| frame.uv(p.truncate());
    let uv: Vec<DVec2> = component.positions().iter().map(place).collect();
    let mut seams = Vec::new();
    let mut places = match source {
        NormalUvSource::UvLayer { layer } => from_layer(component, *layer, &uv, &mut seams)?,
        NormalUvSource::UvLayerOf { mesh, layer } => {
            component
                .topology()
                .check_same(mesh.topology(), "the texture coordinates")?;
            from_layer(mesh, *layer, &uv, &mut seams)?
        }
        NormalUvSource::Collapse { part, to } => collapse(component, *part, *to, &uv)?,
        NormalUvSource::Scale { about, factor } => scale(component, *about, factor, &uv)?,
    };
    if axes == NormalUvAxes::U {
        for (place, uv) in places.iter_mut().zip(&uv) {
            place.y = uv.y;
        }
    }
    let values = AttributeValues::Vector2(places.clone().into());
    let mesh =
        component
            .clone()
            .with_attribute(Attribute::new(NORMAL_UV, Domain::Vertex, values))?;
    Ok(NormalUv {
        mesh,
        seams,
        outside: outside(component, &places),
    })
}

/// Vertices of faces whose place is outside the unit square.
fn outside(component: &Mesh, places: &[DVec2]) -> Vec<u32> {
    let mut used = vec![false; places.len()];
    for &vertex in component.topology().corners().iter() {
        used[vertex as usize] = true;
    }
    // A hair of room, so that rounding at the border is not reported.
    let inside = |x: f64| (-1e-9..=1.0 + 1e-9).contains(&x);
    (0..places.len() as u32)
        .filter(|&v| used[v as usize])
        .filter(|&v| !(inside(places[v as usize].x) && inside(places[v as usize].y)))
        .collect()
}

fn from_layer(
    mesh: &Mesh,
    layer: Option<&str>,
    uv: &[DVec2],
    seams: &mut Vec<u32>,
) -> Result<Vec<DVec2>, GeometryError> {
    let values = find_layer(mesh, layer)?;
    let mut places = uv.to_vec();
    let mut seen = vec![false; uv.len()];
    for (&vertex, &place) in mesh.topology().corners().iter().zip(values) {
        let slot = vertex as usize;
        if seen[slot] && places[slot] != place {
            seams.push(vertex);
        }
        seen[slot] = true;
        places[slot] = place;
    }
    seams.sort_unstable();
    seams.dedup();
    Ok(places)
}

fn find_layer<'a>(mesh: &'a Mesh, layer: Option<&str>) -> Result<&'a [DVec2], GeometryError> {
    let layers = || {
        mesh.attributes()
            .iter()
            .filter_map(|attribute| match attribute.values() {
                AttributeValues::Vector2(values) if attribute.domain() == Domain::Corner => {
                    Some((attribute.name(), values.as_slice()))
                }
                _ => None,
            })
    };
    layers()
        .find(|(name, _)| layer.is_none_or(|wanted| wanted == *name))
        .map(|(_, values)| values)
        .ok_or_else(|| GeometryError::NoAttribute {
            name: layer.unwrap_or("uv").to_owned(),
            wanted: "2D vector corner (UV layer)",
            available: layers().map(|(name, _)| name.to_owned()).collect(),
        })
}

fn collapse(
    component: &Mesh,
    part: Part<'_>,
    to: Option<DVec2>,
    uv: &[DVec2],
) -> Result<Vec<DVec2>, GeometryError> {
    let vertices = vertices_of(component, part)?;
    let centroid = || {
        let first = uv[vertices[0] as usize];
        // About the first vertex, so that equal places have exactly that place as centroid.
        let sum: DVec2 = vertices.iter().map(|&v| uv[v as usize] - first).sum();
        first + sum / vertices.len() as f64
    };
    let to = check_finite(to.unwrap_or_else(centroid))?;
    let mut places = uv.to_vec();
    for &vertex in &vertices {
        places[vertex as usize] = to;
    }
    Ok(places)
}

/// The vertices of a part, ascending; at least one.
fn vertices_of(component: &Mesh, part: Part<'_>) -> Result<Vec<u32>, GeometryError> {
    let all = 0..component.vertex_count() as u32;
    let vertices: Vec<u32> = match part {
        Part::All => all.collect(),
        Part::Named(name) => {
            let mut inside = vec![false; component.vertex_count()];
            for face in faces_named(component, name)? {
                for &vertex in component.face(face as usize) {
                    inside[vertex as usize] = true;
                }
            }
            all.filter(|&v| inside[v as usize]).collect()
        }
        Part::Box { low, high } => all
            .filter(|&v| {
                let p = component.positions()[v as usize];
                p.cmpge(low).all() && p.cmple(high).all()
            })
            .collect(),
    };
    if vertices.is_empty() {
        return Err(GeometryError::Empty {
            what: "the part of the component to collapse",
            missing: "vertices",
        });
    }
    Ok(vertices)
}

fn scale(
    component: &Mesh,
    about: DVec2,
    factor: &Amount,
    uv: &[DVec2],
) -> Result<Vec<DVec2>, GeometryError> {
    check_finite(about)?;
    factor.check(component, Domain::Vertex)?;
    let places = uv.iter().enumerate();
    places
        .map(|(vertex, &uv)| check_finite(lerp2(about, uv, factor.at(vertex))))
        .collect()
}

fn check_finite(place: DVec2) -> Result<DVec2, GeometryError> {
    if place.is_finite() {
        Ok(place)
    } else {
        Err(GeometryError::OutOfRange {
            what: "a place to read directions at",
            value: if place.x.is_finite() {
                place.y
            } else {
                place.x
            },
            requirement: "u' and v' must be finite",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Labels;

    /// Two unit quads side by side: [0, 2] x [0, 1]; the second is in group "head".
    fn strip() -> Mesh {
        let place = |k: u32| [f64::from(k % 3), f64::from(k / 3), 0.0];
        let faces = [[0, 1, 4, 3], [1, 2, 5, 4]];
        let groups = Labels::new(vec![vec!["head".to_owned()]], vec![u32::MAX, 0]).unwrap();
        Mesh::from_faces((0..6).map(place).collect(), &faces)
            .and_then(|mesh| mesh.with_groups(groups))
            .unwrap()
    }

    fn places(result: &NormalUv) -> Vec<DVec2> {
        match result
            .mesh
            .attribute(NORMAL_UV, Domain::Vertex)
            .unwrap()
            .values()
        {
            AttributeValues::Vector2(values) => values.to_vec(),
            other => panic!("{}", other.type_name()),
        }
    }

    fn run(source: NormalUvSource<'_>, axes: NormalUvAxes) -> Result<NormalUv, GeometryError> {
        evaluate_normals_uv(&strip(), &source, axes, &Fit::Bounds)
    }

    #[test]
    fn collapse_moves_a_part_to_its_centroid() {
        let part = Part::Named("head");
        let source = NormalUvSource::Collapse { part, to: None };
        let both = places(&run(source.clone(), NormalUvAxes::Both).unwrap());
        assert_eq!(both[2], DVec2::new(0.75, 0.5));
        assert_eq!(both[0], DVec2::ZERO);
        let u_only = places(&run(source, NormalUvAxes::U).unwrap());
        assert_eq!(u_only[2], DVec2::new(0.75, 0.0));
    }

    #[test]
    fn a_box_includes_its_border() {
        let (low, high) = (DVec3::new(1.0, 0.0, -1.0), DVec3::new(1.0, 1.0, 1.0));
        let to = Some(DVec2::new(0.1, 0.2));
        let part = Part::Box { low, high };
        let moved =
            places(&run(NormalUvSource::Collapse { part, to }, NormalUvAxes::Both).unwrap());
        let expected = [
            (0.0, 0.0),
            (0.1, 0.2),
            (1.0, 0.0),
            (0.0, 1.0),
            (0.1, 0.2),
            (1.0, 1.0),
        ];
        assert_eq!(moved, expected.map(DVec2::from));
    }

    #[test]
    fn scale_by_one_keeps_and_by_zero_collapses() {
        let about = DVec2::new(0.3, 0.4);
        for (factor, expected) in [(1.0, DVec2::new(0.5, 1.0)), (0.0, about)] {
            let factor = Amount::Constant(factor);
            let source = NormalUvSource::Scale {
                about,
                factor: &factor,
            };
            let result = run(source, NormalUvAxes::Both).unwrap();
            assert_eq!(places(&result)[4], expected);
            assert!(result.outside.is_empty());
        }
    }

    #[test]
    fn the_last_corner_wins_and_seams_are_named() {
        let mut uv = [
            (0, 0),
            (1, 0),
            (1, 1),
            (0, 1),
            (2, 0),
            (2, 0),
            (2, 1),
            (1, 1),
        ]
        .map(|(u, v)| DVec2::new(f64::from(u), f64::from(v)));
        uv[7] = uv[2];
        let layer = Attribute::new(
            "uv",
            Domain::Corner,
            AttributeValues::Vector2(uv.to_vec().into()),
        );
        let mesh = strip().with_attribute(layer).unwrap();
        let source = NormalUvSource::UvLayer { layer: None };
        let result = evaluate_normals_uv(&mesh, &source, NormalUvAxes::Both, &Fit::Bounds).unwrap();
        assert_eq!(result.seams, [1]);
        assert_eq!(places(&result)[1], DVec2::new(2.0, 0.0));
        assert_eq!(result.outside, [1, 2, 5]);
        let other = NormalUvSource::UvLayer {
            layer: Some("none"),
        };
        let error = evaluate_normals_uv(&mesh, &other, NormalUvAxes::Both, &Fit::Bounds);
        assert!(matches!(error, Err(GeometryError::NoAttribute { .. })));
    }

    #[test]
    fn unknown_parts_and_odd_numbers_are_refused() {
        let part = Part::Named("tail");
        assert!(
            run(
                NormalUvSource::Collapse { part, to: None },
                NormalUvAxes::Both
            )
            .is_err()
        );
        let factor = Amount::Constant(f64::NAN);
        let source = NormalUvSource::Scale {
            about: DVec2::ZERO,
            factor: &factor,
        };
        assert!(matches!(
            run(source, NormalUvAxes::Both),
            Err(GeometryError::OutOfRange { .. })
        ));
    }
}
