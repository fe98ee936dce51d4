//! Texture coordinates refined as a surface of their own.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::refiner::Refiner;
use super::sharpness::CREASE;
use super::{Boundary, CornerRule, Options, Scheme};
use crate::mesh::{Attribute, AttributeValues, Domain, Mesh};
use crate::topology::Topology;
use crate::{GeometryError, Monitor};

/// Whether an attribute on corners is refined here.
pub(super) fn are_smooth(attribute: &Attribute, options: Options) -> bool {
    let pairs = matches!(attribute.values(), AttributeValues::Vector2(_));
    pairs && options.uv == CornerRule::Smooth && options.scheme == Scheme::CatmullClark
}

/// Pairs on corners, refined by the masks of positions on the mesh that corners of
/// equal value at one vertex share a vertex in: where values differ across an edge
/// it has a border, smooth along and with its corners kept. Creases of edges count.
pub(super) fn smooth(
    coarse: &Mesh,
    attribute: &Attribute,
    options: Options,
    monitor: &dyn Monitor,
) -> Result<AttributeValues, GeometryError> {
    let AttributeValues::Vector2(values) = attribute.values() else {
        return Ok(attribute.values().clone());
    };
    let (corners, places) = charts(coarse.topology(), values);
    let offsets = coarse.topology().offsets().to_vec();
    let topology = Topology::new(places.len(), offsets, corners)?;
    // Positions are not read: values are refined beside them.
    let mut islands = Mesh::new(vec![DVec3::ZERO; places.len()], Arc::new(topology))?;
    if let Some(crease) = coarse.attribute(CREASE, Domain::Corner) {
        islands = islands.with_attribute(crease.clone())?;
    }
    islands.topology().adjacency_with(monitor)?;
    let options = Options {
        boundary: Boundary::EdgeAndCorner,
        ..options
    };
    let refiner = Refiner::new(&islands, options, monitor)?;
    let fine = refiner.run(&places, monitor)?;
    let corners = refiner.blocks().corners(monitor)?;
    let at = |&vertex: &u32| fine[vertex as usize];
    Ok(AttributeValues::Vector2(corners.iter().map(at).collect()))
}

/// Vertices of the charts: for each corner its own, shared by the corners at one
/// vertex of the mesh with the same value, and the values in order.
fn charts(topology: &Topology, values: &[DVec2]) -> (Vec<u32>, Vec<DVec2>) {
    let adjacency = topology.adjacency();
    let mut of_corner = vec![0; values.len()];
    let mut places: Vec<DVec2> = Vec::new();
    let same = |a: DVec2, b: DVec2| (a - b).abs().max_element() <= 0.0;
    for vertex in 0..topology.vertex_count() {
        let first = places.len();
        for &corner in adjacency.vertex_corners(vertex) {
            let value = values[corner as usize];
            // Few corners meet at a vertex, and fewer values.
            let known = places[first..].iter().position(|&place| same(place, value));
            of_corner[corner as usize] = known.map_or(places.len(), |k| first + k) as u32;
            if known.is_none() {
                places.push(value);
            }
        }
    }
    (of_corner, places)
}
