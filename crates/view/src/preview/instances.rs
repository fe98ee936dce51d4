//! The parts of an array as buffers.

use std::collections::BTreeMap;

use axum::body::Bytes;
use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::{ArrayParts, Mesh, PartPoint, PartVectors};

use crate::buffers::{Buffers, bytes};
use crate::protocol::Instances;
use crate::shown::{all, origin_of, triples};

/// The parts of the array that `mesh` is; positions are about its origin.
pub(super) fn instances(buffers: &Buffers, parts: &ArrayParts, mesh: &Mesh) -> Instances {
    let mut named = BTreeMap::new();
    let mut name = |content: Bytes| {
        let (name, bytes) = buffers.given(content);
        named.insert(name, bytes);
        name
    };
    let vertices = all(parts.vertices.len(), |vertex| {
        parts.vertices[vertex].map(u32::to_le)
    });
    let points = all(parts.points.len(), |point| {
        floats(texels(&parts.points[point]))
    });
    let ids = |ids: &[u32]| bytes(all(ids.len(), |index| ids[index].to_le()));
    Instances {
        vertices: name(bytes(vertices)),
        points: name(bytes(points)),
        grids: name(ids(&parts.grids)),
        grid_starts: name(ids(&parts.grid_starts)),
        positions: name(triples(&parts.positions, origin_of(mesh))),
        outward: name(vectors(&parts.outward)),
        inward: parts.inward.as_ref().map(|inward| name(vectors(inward))),
        is_unit: parts.outward.lengths.is_some(),
        factors: parts
            .factors
            .iter()
            .map(|values| name(bytes(all(values.len(), |index| floats([values[index]])))))
            .collect(),
        reach: reach(parts),
        buffers: named,
    }
}

/// No vertex is farther from the base.
fn reach(parts: &ArrayParts) -> f64 {
    let most = |numbers: &mut dyn Iterator<Item = f64>| {
        numbers.fold(0.0, |most: f64, number| most.max(number.abs()))
    };
    let height = most(&mut parts.points.iter().map(|point| point.height));
    let sides = [Some(&parts.outward), parts.inward.as_ref()];
    let lengths = sides.into_iter().flatten().map(|side| match &side.lengths {
        Some(lengths) => most(&mut lengths.iter().copied()),
        None => most(&mut side.directions.iter().map(|vector| vector.length())),
    });
    let factors = parts.factors.iter();
    let factors = factors.map(|values| most(&mut values.iter().copied()));
    factors.fold(height * most(&mut lengths.into_iter()), |reach, factor| {
        reach * factor
    })
}

/// Where a point and its direction lie in the grid, its height, and the grid's row.
fn texels(point: &PartPoint) -> [f64; 8] {
    let (place, direction) = (point.place, point.direction);
    [
        place.first.into(),
        place.fraction.x,
        place.fraction.y,
        point.height,
        direction.first.into(),
        direction.fraction.x,
        direction.fraction.y,
        point.row.into(),
    ]
}

/// Directions and their lengths.
fn vectors(vectors: &PartVectors) -> Bytes {
    let length = |index: usize| {
        vectors
            .lengths
            .as_ref()
            .map_or(1.0, |lengths| lengths[index])
    };
    bytes(all(vectors.directions.len(), |index| {
        let DVec3 { x, y, z } = vectors.directions[index];
        floats([x, y, z, length(index)])
    }))
}

/// Numbers as `f32`, little-endian.
fn floats<const N: usize>(numbers: [f64; N]) -> [u32; N] {
    numbers.map(|number| (number as f32).to_bits().to_le())
}
