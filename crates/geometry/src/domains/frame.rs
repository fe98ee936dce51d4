//! Faces as frames: a ring of quads round a hole.

use super::check_per_face;
use super::fan::{edge_weights, weighted_mean};
use super::inset::Insets;
use super::pieces::{Corner, NEW_EDGE, Pieces};
use crate::mesh::{Attribute, AttributeValues};
use crate::offset::PART;
use crate::topology::{BoundaryWalk, boundary_walks, next_in_face};
use crate::{Amount, Domain, GeometryError, Mesh, Monitor};

/// How far the hole's corners lie from the face's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Inset {
    /// Edges move by `width` metres, mitred at the corners.
    #[default]
    Constant,
    /// Edges move by `width` times 2 · mean of √area / sides over the faces at
    /// the vertex: about `width` times the distance from centre to edge.
    Relative,
    /// Corners move by the share `width` of the way to the centre: the mean of
    /// the corners, of a triangle the incentre.
    Centre,
}

/// What becomes of the hole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fill {
    /// It stays open.
    #[default]
    Open,
    /// A fan of triangles round its length-weighted centre.
    Fan,
    /// One polygon.
    Polygon,
}

/// Values of the face attribute [`PART`] of [`frame_faces`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FramePart {
    /// A quad of the ring inside a face.
    Ring = 0,
    /// A quad of the ring outside an open border.
    Border = 1,
    /// A face in the hole.
    Fill = 2,
    /// A face that was kept as it was.
    Kept = 3,
}

/// Settings of [`frame_faces`].
#[derive(Debug, Clone, PartialEq)]
pub struct FrameOptions {
    /// What `width` means.
    pub inset: Inset,
    /// Metres for [`Inset::Constant`], else a factor; a number, or one per
    /// vertex or per face. Not negative.
    pub width: Amount,
    /// What becomes of the holes.
    pub fill: Fill,
    /// Whether a ring is added outside open borders.
    pub border: bool,
    /// Metres that ring is wide; `None` takes the inset's width there, with
    /// [`Inset::Centre`] by the rule of [`Inset::Relative`].
    pub border_width: Option<Amount>,
    /// Whether faces with four corners are kept as they are.
    pub preserve_quads: bool,
}

impl Default for FrameOptions {
    fn default() -> Self {
        Self {
            inset: Inset::Constant,
            width: Amount::Constant(0.2),
            fill: Fill::Open,
            border: false,
            border_width: None,
            preserve_quads: false,
        }
    }
}

/// A mesh of frames.
#[derive(Debug, Clone)]
pub struct Framed {
    /// The mesh, with the face attributes [`PART`] (a [`FramePart`]) and
    /// [`super::SOURCE_FACE`].
    pub mesh: Mesh,
    /// Faces of the input whose hole is turned round because the width is more
    /// than fits in, ascending.
    pub overfull: Vec<u32>,
}

/// Replaces faces by frames: quads (v_k, v_k+1, inner_k+1, inner_k) along their
/// edges, with u along the edge and v towards the hole.
///
/// With [`Inset::Constant`] inner_k lies in the plane of the face's normal N
/// through v_k, at the distance width / sin(α/2) along N × (b - a), where a and b
/// are the unit vectors from v_k to the corner before and after it and α is the
/// angle between them. A corner sharper than 6 degrees is cut short; beside an
/// edge without length the other edge alone decides.
///
/// With `border` a ring of quads (v_k+1, v_k, outer_k, outer_k+1) goes outside
/// along open borders, by the same rule turned outwards along the loop, with the
/// normal of the face that the loop comes from. Border quads come first, then face by
/// face the ring and the fill; faces that are not `chosen` (one value per face)
/// are kept, and have no border ring.
///
/// Values at inner corners are interpolated from three corners of the face,
/// exactly for values that are linear over it. Values of outer corners are those
/// of the border vertex. Cost: O(corners).
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored, domains::{FrameOptions, frame_faces}, glam::DVec3};
/// let quad = Mesh::from_faces(
///     vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
///     &[&[0, 1, 2, 3]],
/// )?;
/// let framed = frame_faces(&quad, &[true], &FrameOptions::default(), &Unmonitored)?;
/// assert_eq!(framed.mesh.face(0), [0, 1, 5, 4]);
/// assert!((framed.mesh.positions()[4] - DVec3::new(0.2, 0.2, 0.0)).length() < 1e-15);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::OutOfRange`] for a negative width, or one above 1 with
/// [`Inset::Centre`]; [`GeometryError::FieldLength`];
/// [`GeometryError::AttributeLength`] unless `chosen` has one value per face;
/// [`GeometryError::NonManifold`] with `border`; [`GeometryError::Cancelled`].
pub fn frame_faces(
    mesh: &Mesh,
    chosen: &[bool],
    options: &FrameOptions,
    monitor: &dyn Monitor,
) -> Result<Framed, GeometryError> {
    check_per_face("chosen", mesh, chosen.len())?;
    mesh.topology().adjacency_with(monitor)?;
    let insets = Insets::new(mesh, options, monitor)?;
    let frames =
        |face: usize| chosen[face] && !(options.preserve_quads && mesh.face(face).len() == 4);
    let mut framing = Framing {
        mesh,
        pieces: Pieces::new(mesh, 6 * mesh.corner_count()),
        parts: Vec::with_capacity(mesh.corner_count()),
        inner: Vec::new(),
        shares: Vec::new(),
        weights: Vec::new(),
    };
    if options.border {
        mesh.topology().check_manifold()?;
        for walk in boundary_walks(mesh.topology()) {
            framing.border(&walk, &insets, chosen);
        }
    }
    let mut overfull = Vec::new();
    for face in 0..mesh.face_count() {
        if face % 4096 == 0 {
            monitor.check()?;
        }
        if !frames(face) {
            framing.pieces.keep(face);
            framing.parts.push(FramePart::Kept as i64);
            continue;
        }
        if framing.ring(face, &insets) {
            overfull.push(face as u32);
        }
        framing.fill(face, options.fill);
    }
    let values = AttributeValues::Integer(framing.parts.into());
    let mesh =
        framing
            .pieces
            .finish(true)?
            .with_attribute(Attribute::new(PART, Domain::Face, values))?;
    Ok(Framed { mesh, overfull })
}

/// The frames made so far.
struct Framing<'a> {
    mesh: &'a Mesh,
    pieces: Pieces<'a>,
    parts: Vec<i64>,
    /// The hole's corners of the face at hand.
    inner: Vec<Corner>,
    /// For each of them its shares of three corners of the face.
    shares: Vec<[(usize, f64); 3]>,
    weights: Vec<f64>,
}

impl Framing<'_> {
    /// The ring of one face; whether its hole is turned round.
    fn ring(&mut self, face: usize, insets: &Insets<'_>) -> bool {
        let range = self.mesh.topology().corner_range(face);
        let vertices = self.mesh.face(face);
        let count = vertices.len();
        self.inner.clear();
        self.shares.clear();
        for k in 0..count {
            let position = insets.inner(face, k);
            let weights = insets.shares(face, k, position);
            self.shares.push(weights);
            let vertex = self
                .pieces
                .vertex(position, weights.iter().map(|&(k, w)| (vertices[k], w)));
            let corners = weights.iter().map(|&(k, w)| ((range.start + k) as u32, w));
            let values = self.pieces.blend(corners);
            self.inner.push(Corner {
                vertex,
                values,
                edge: NEW_EDGE,
            });
        }
        let mut turned = false;
        for k in 0..count {
            let next = (k + 1) % count;
            let quad = [
                self.pieces.old(range.start + k, true),
                self.pieces.old(range.start + next, false),
                self.inner[next],
                self.inner[k],
            ];
            let along = |from: Corner, to: Corner| {
                self.pieces.position(to.vertex) - self.pieces.position(from.vertex)
            };
            turned |= along(quad[0], quad[1]).dot(along(quad[3], quad[2])) < 0.0;
            self.pieces.face(face, quad);
            self.parts.push(FramePart::Ring as i64);
        }
        turned
    }

    /// The hole that `ring` left.
    fn fill(&mut self, face: usize, fill: Fill) {
        match fill {
            Fill::Open => {}
            Fill::Polygon => {
                self.pieces.face(face, self.inner.iter().copied());
                self.parts.push(FramePart::Fill as i64);
            }
            Fill::Fan => self.fan(face),
        }
    }

    fn fan(&mut self, face: usize) {
        let count = self.inner.len();
        let place = |k: usize| self.pieces.position(self.inner[k].vertex);
        edge_weights(count, place, &mut self.weights);
        let position = weighted_mean(count, place, &self.weights);
        let vertices = self.mesh.face(face);
        let start = self.mesh.topology().offsets()[face];
        let shares = || {
            let rows = self.shares.iter().zip(&self.weights);
            rows.flat_map(|(shares, of)| shares.map(|(k, share)| (k, share * of)))
        };
        let vertex = self
            .pieces
            .vertex(position, shares().map(|(k, share)| (vertices[k], share)));
        let corners = shares().map(|(k, share)| (start + k as u32, share));
        let values = self.pieces.blend(corners);
        let centre = Corner {
            vertex,
            values,
            edge: NEW_EDGE,
        };
        for k in 0..count {
            let triangle = [self.inner[k], self.inner[(k + 1) % count], centre];
            self.pieces.face(face, triangle);
            self.parts.push(FramePart::Fill as i64);
        }
    }

    /// The ring outside one open border.
    fn border(&mut self, walk: &BoundaryWalk, insets: &Insets<'_>, chosen: &[bool]) {
        let topology = self.mesh.topology();
        let faces = topology.adjacency().corner_faces();
        let count = walk.corners.len();
        let has_quad = |k: usize| chosen[faces[walk.corners[k] as usize] as usize];
        // An open walk has a vertex more than edges.
        let places = if walk.closed { count } else { count + 1 };
        let mut outer = vec![u32::MAX; places];
        for (k, outer) in outer.iter_mut().enumerate() {
            let before = (k + places - 1) % places;
            let before = (walk.closed || k > 0).then_some(before);
            let after = (k < count).then_some(k);
            if before.into_iter().chain(after).any(has_quad) {
                let corner = |k: Option<usize>| k.map(|k| walk.corners[k]);
                let (vertex, position) = insets.outer(corner(before), corner(after));
                *outer = self.pieces.vertex(position, std::iter::once((vertex, 1.0)));
            }
        }
        for k in (0..count).filter(|&k| has_quad(k)) {
            let corner = walk.corners[k];
            let next = next_in_face(topology, corner) as usize;
            let (a, b) = (
                self.pieces.old(corner as usize, true),
                self.pieces.old(next, false),
            );
            let outside = |of: Corner, vertex: u32| Corner {
                vertex,
                edge: NEW_EDGE,
                ..of
            };
            // Walked from b to a, so what the edge carries stands at b.
            let quad = [
                Corner { edge: a.edge, ..b },
                outside(a, a.vertex),
                outside(a, outer[k]),
                outside(b, outer[(k + 1) % places]),
            ];
            self.pieces.face(faces[corner as usize] as usize, quad);
            self.parts.push(FramePart::Border as i64);
        }
    }
}
