//! Meshes and directions as buffers.

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use axum::body::Bytes;
use glam::DVec3;
use tessgraph_geometry::digest::{Digest, Hasher};
use tessgraph_geometry::{
    AttributeValues, BASE_FACE, Directions, Domain, Mesh, Topology, Triangles, Unmonitored,
    parallel,
};
use tessgraph_graph::Units;

use crate::buffers::{Buffers, bytes, source};
use crate::protocol::{BufferName, ShownDirections, ShownMesh};

/// A mesh as buffers; `is_fans` says whether all its faces are cut into fans.
pub(super) fn mesh(buffers: &Buffers, mesh: &Arc<Mesh>, units: Units, is_fans: bool) -> ShownMesh {
    let (low, high) = mesh.bounds().unwrap_or_default();
    let origin = origin(low, high);
    let mut named = BTreeMap::new();
    let mut name = |(name, bytes): (BufferName, usize)| {
        named.insert(name, bytes);
        name
    };
    let positions = name(positions(buffers, mesh, origin));
    let cut = Cut::new(mesh, is_fans);
    let triangles_buffer = name(buffers.made(cut.source("vertices"), || cut.vertices()));
    let triangle_faces = name(buffers.made(cut.source("faces"), || cut.faces()));
    let edges = name(buffers.made(cut.source("edges"), || cut.edges()));
    let base_faces = base_faces(buffers, mesh).map(&mut name);
    ShownMesh {
        vertices: mesh.vertex_count(),
        faces: mesh.face_count(),
        triangles: mesh.corner_count() - 2 * mesh.face_count(),
        origin: origin.to_array(),
        bounds: [low.to_array(), high.to_array()],
        scale: 1.0 / units.metres(),
        positions,
        triangles_buffer,
        triangle_faces,
        edges,
        base_faces,
        buffers: named,
    }
}

/// The positions of a mesh, which the thread pool begins to make: whoever draws the
/// mesh asks for them first.
pub(super) fn begin(buffers: &Buffers, mesh: &Mesh) -> BufferName {
    let (name, _) = positions(buffers, mesh, origin_of(mesh));
    buffers.prepare(name);
    name
}

/// Directions as a buffer.
pub(super) fn directions(buffers: &Buffers, directions: &Arc<Directions>) -> ShownDirections {
    let outward = directions.outward();
    let source = source("directions", &[outward.digest()]).finish();
    let vectors = outward.clone();
    let make = move || triples(&vectors, DVec3::ZERO);
    ShownDirections {
        per: "vertex",
        outward: buffers.awaited(source, 12 * outward.len(), make),
        on: "mesh",
    }
}

/// What the positions of a mesh are told relative to.
pub(crate) fn origin_of(mesh: &Mesh) -> DVec3 {
    let (low, high) = mesh.bounds().unwrap_or_default();
    origin(low, high)
}

/// A place near the middle of a box, so that numbers about it are no larger than
/// the box and keep their digits in an `f32`.
///
/// It stands on a grid as wide as the box, so that it stays where it is while
/// the mesh changes a little, and the camera with it.
fn origin(low: DVec3, high: DVec3) -> DVec3 {
    let size = (high - low).max_element();
    let exponent = size.to_bits() >> 52;
    // A power of two: a bare exponent, none of the digits.
    let step = f64::from_bits(exponent << 52);
    if step.is_normal() {
        let middle = low + (high - low) / 2.0;
        (middle / step).round() * step
    } else {
        low
    }
}

fn positions(buffers: &Buffers, mesh: &Mesh, origin: DVec3) -> (BufferName, usize) {
    let digest = mesh.positions().digest();
    let mut hasher: Hasher = source("positions", &[digest]);
    for part in origin.to_array() {
        hasher.float(part);
    }
    let (length, positions) = (12 * mesh.vertex_count(), mesh.positions().clone());
    let make = move || triples(&positions, origin);
    (buffers.awaited(hasher.finish(), length, make), length)
}

/// Vectors less `origin`, as `f32`.
pub(crate) fn triples(vectors: &[DVec3], origin: DVec3) -> Bytes {
    let numbers = |index: usize| {
        let vector = (vectors[index] - origin).as_vec3();
        vector.to_array().map(|number| number.to_bits().to_le())
    };
    bytes(all(vectors.len(), numbers))
}

/// `f(index)` for all indices, in parallel.
pub(crate) fn all<T: Send + bytemuck::Zeroable>(
    count: usize,
    f: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    parallel::map(count, &Unmonitored, f).unwrap_or_default()
}

/// A mesh cut into triangles, when somebody asks.
struct Cut<'a> {
    mesh: &'a Mesh,
    source: Digest,
    triangles: OnceCell<Triangles>,
}

impl<'a> Cut<'a> {
    fn new(mesh: &'a Mesh, is_fans: bool) -> Self {
        let topology: &Topology = mesh.topology();
        // How a polygon is cut depends on where its corners are, but seldom: then
        // buffers of an earlier mesh with the same faces are named again.
        let source = if is_fans {
            source("fans", &[topology.digest()])
        } else {
            let positions = mesh.positions().digest();
            source("triangles", &[topology.digest(), positions])
        };
        Self {
            mesh,
            source: source.finish(),
            triangles: OnceCell::new(),
        }
    }

    fn source(&self, what: &str) -> Digest {
        source(what, &[self.source]).finish()
    }

    fn triangles(&self) -> &Triangles {
        self.triangles.get_or_init(|| self.mesh.triangles())
    }

    fn vertices(&self) -> Bytes {
        let corners = self.mesh.topology().corners();
        let cut = &self.triangles().corners;
        let vertices =
            |triangle: usize| cut[triangle].map(|corner| corners[corner as usize].to_le());
        bytes(all(cut.len(), vertices))
    }

    fn faces(&self) -> Bytes {
        let faces = &self.triangles().faces;
        bytes(all(faces.len(), |triangle| faces[triangle].to_le()))
    }

    fn edges(&self) -> Bytes {
        let topology = self.mesh.topology();
        let Triangles { corners, faces } = self.triangles();
        let edges = |triangle: usize| {
            let face = topology.corner_range(faces[triangle] as usize);
            let triangle = corners[triangle];
            let is_side = |k: &usize| {
                let (from, to) = (triangle[*k] as usize, triangle[(*k + 1) % 3] as usize);
                let next = if from + 1 == face.end {
                    face.start
                } else {
                    from + 1
                };
                to == next
            };
            (0..3).filter(is_side).map(|k| 1u8 << k).sum::<u8>()
        };
        bytes(all(corners.len(), edges))
    }
}

/// The face of the base that each face came from.
fn base_faces(buffers: &Buffers, mesh: &Mesh) -> Option<(BufferName, usize)> {
    let attribute = mesh.attribute(BASE_FACE, Domain::Face)?;
    let AttributeValues::Integer(values) = attribute.values() else {
        return None;
    };
    let source = source("ids", &[values.digest()]).finish();
    let length = 4 * values.len();
    let values = values.clone();
    let make = move || {
        let id = |face: usize| u32::try_from(values[face]).unwrap_or(u32::MAX).to_le();
        bytes(all(values.len(), id))
    };
    Some((buffers.awaited(source, length, make), length))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(buffers: &Buffers, shown: &Arc<Mesh>, units: Units) -> ShownMesh {
        mesh(buffers, shown, units, shown.is_cut_into_fans())
    }

    fn content(buffers: &Buffers, name: BufferName) -> Bytes {
        buffers.get(name.0).unwrap()
    }

    fn ids(content: &Bytes) -> Vec<u32> {
        let words = content.chunks_exact(4);
        words
            .map(|word| u32::from_le_bytes(word.try_into().unwrap()))
            .collect()
    }

    /// A square and a triangle, far away.
    fn house() -> Arc<Mesh> {
        let at = |x: f64, z: f64| [5_000_000.0 + x, 0.0, z];
        let places = vec![
            at(0.0, 0.0),
            at(1.0, 0.0),
            at(1.0, 1.0),
            at(0.0, 1.0),
            at(0.5, 1.5),
        ];
        let faces: [&[u32]; 2] = [&[0, 1, 2, 3], &[3, 2, 4]];
        Arc::new(Mesh::from_faces(places, &faces).unwrap())
    }

    #[test]
    fn triangles_know_their_faces_and_which_sides_are_real() {
        let buffers = Buffers::new(0);
        let told = told(&buffers, &house(), Units::Mm);
        assert_eq!((told.vertices, told.faces, told.triangles), (5, 2, 3));
        assert_eq!(told.scale.to_bits(), 1000f64.to_bits());
        let triangles = ids(&content(&buffers, told.triangles_buffer));
        assert_eq!(triangles, [0, 1, 2, 0, 2, 3, 3, 2, 4]);
        assert_eq!(ids(&content(&buffers, told.triangle_faces)), [0, 0, 1]);
        let edges = content(&buffers, told.edges);
        assert_eq!(edges[..], [0b011, 0b110, 0b111]);
        assert_eq!(told.buffers.len(), 4);
        for (name, bytes) in &told.buffers {
            assert_eq!(content(&buffers, *name).len(), *bytes);
        }
    }

    #[test]
    fn positions_far_away_keep_their_digits() {
        let buffers = Buffers::new(0);
        let told = told(&buffers, &house(), Units::M);
        let positions = content(&buffers, told.positions);
        let words = positions.chunks_exact(4);
        let numbers: Vec<f64> = words
            .map(|word| f32::from_le_bytes(word.try_into().unwrap()).into())
            .collect();
        let house = house();
        for (vertex, place) in house.positions().iter().enumerate() {
            for axis in 0..3 {
                let shown = told.origin[axis] + numbers[3 * vertex + axis];
                assert!((shown - place[axis]).abs() < 1e-6, "{shown} {place}");
            }
        }
    }

    #[test]
    fn moving_a_little_keeps_origin_and_triangles() {
        let buffers = Buffers::new(0);
        let house = house();
        let one = told(&buffers, &house, Units::M);
        let moved = house
            .positions()
            .iter()
            .map(|place| *place + DVec3::Z * 0.01);
        let moved = Arc::new(house.with_positions(moved.collect()).unwrap());
        let other = told(&buffers, &moved, Units::M);
        assert_eq!(DVec3::from(one.origin), DVec3::from(other.origin));
        assert_ne!(one.positions, other.positions);
        assert_eq!(one.triangles_buffer, other.triangles_buffer);
        assert_eq!(one.edges, other.edges);
    }

    #[test]
    fn a_face_that_is_cut_in_another_way_has_other_triangles() {
        let buffers = Buffers::new(0);
        let house = house();
        let one = told(&buffers, &house, Units::M);
        // The second corner of the square sinks into it.
        let mut places = house.positions().to_vec();
        places[1] = places[0] + DVec3::new(0.3, 0.0, 0.6);
        let dented = Arc::new(house.with_positions(places).unwrap());
        let other = told(&buffers, &dented, Units::M);
        assert_ne!(one.triangles_buffer, other.triangles_buffer);
        let triangles = ids(&content(&buffers, other.triangles_buffer));
        assert_eq!(triangles[..6], [1, 2, 3, 0, 1, 3]);
        assert_eq!(one.triangle_faces, other.triangle_faces);
    }

    #[test]
    fn nothing_and_a_single_place_have_an_origin() {
        let none = DVec3::ZERO;
        assert_eq!(origin(none, none), none);
        let place = DVec3::new(3.5, 0.0, -1e9);
        assert_eq!(origin(place, place), place);
    }
}
